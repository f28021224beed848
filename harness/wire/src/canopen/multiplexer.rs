//! Index and sub-index.

use std::fmt;

/// An entry of the object dictionary: index and sub-index. On the wire three bytes, the index low byte first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Multiplexer {
    /// The index, `0000h..=FFFFh`.
    pub index: u16,
    /// The sub-index, `00h..=FFh`.
    pub sub: u8,
}

impl Multiplexer {
    /// The entry `index`, `sub`.
    pub const fn new(index: u16, sub: u8) -> Multiplexer {
        Multiplexer { index, sub }
    }
}

impl fmt::Display for Multiplexer {
    /// `6041h:00`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04X}h:{:02X}", self.index, self.sub)
    }
}
