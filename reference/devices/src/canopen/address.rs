//! Index and sub-index.

use std::fmt;

/// Where a value is in the object dictionary; in order of index, then sub-index.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Address(u32);

impl Address {
    pub(crate) const fn new(index: u16, sub: u8) -> Address {
        Address((index as u32) << 8 | sub as u32)
    }

    /// As bytes 1 to 3 of an SDO carry it: index low, index high, sub-index.
    pub(crate) const fn from_multiplexer(bytes: [u8; 3]) -> Address {
        Address::new(u16::from_le_bytes([bytes[0], bytes[1]]), bytes[2])
    }

    /// Bytes 1 to 3 of an SDO.
    pub(crate) const fn multiplexer(self) -> [u8; 3] {
        let [low, high] = self.index().to_le_bytes();
        [low, high, self.sub()]
    }

    /// The address that `6040:00` names.
    pub(crate) fn parse(text: &str) -> Option<Address> {
        let (index, sub) = text.split_once(':')?;
        if index.len() != 4 || sub.len() != 2 {
            return None;
        }
        let index = u16::from_str_radix(index, 16).ok()?;
        Some(Address::new(index, u8::from_str_radix(sub, 16).ok()?))
    }

    pub(crate) const fn index(self) -> u16 {
        (self.0 >> 8) as u16
    }

    pub(crate) const fn sub(self) -> u8 {
        (self.0 & 0xFF) as u8
    }
}

impl fmt::Display for Address {
    /// `6040:00`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04X}:{:02X}", self.index(), self.sub())
    }
}

impl fmt::Debug for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}
