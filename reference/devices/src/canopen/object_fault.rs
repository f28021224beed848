//! Faults of one value of the object dictionary, named with its address: `wrong-default:6040:00`.

use std::fmt;

use fieldproof_dictionary::{Access, Dictionary, Entry};

use super::Address;
use super::emergency::ERROR_HISTORY;

/// One value that is not as the dictionary says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ObjectFault {
    kind: ObjectFaultKind,
    address: Address,
}

/// What is not as the dictionary says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ObjectFaultKind {
    /// It is not there.
    Missing,
    /// It is there, and the dictionary has nothing of it.
    Surplus,
    /// It has another value after a reset.
    WrongDefault,
    /// It is a byte longer than its type.
    WrongSize,
    /// It can be written, though it is read-only.
    Writable,
    /// It cannot be written, though it is writable.
    ReadOnly,
    /// It can be read, though it is write-only.
    Readable,
    /// It takes values above its highest.
    TooHigh,
    /// It takes values below its lowest.
    TooLow,
}

impl ObjectFaultKind {
    /// All of them.
    pub const ALL: [ObjectFaultKind; 9] = [
        ObjectFaultKind::Missing,
        ObjectFaultKind::Surplus,
        ObjectFaultKind::WrongDefault,
        ObjectFaultKind::WrongSize,
        ObjectFaultKind::Writable,
        ObjectFaultKind::ReadOnly,
        ObjectFaultKind::Readable,
        ObjectFaultKind::TooHigh,
        ObjectFaultKind::TooLow,
    ];

    /// What stands before the address.
    pub const fn word(self) -> &'static str {
        match self {
            ObjectFaultKind::Missing => "missing",
            ObjectFaultKind::Surplus => "surplus",
            ObjectFaultKind::WrongDefault => "wrong-default",
            ObjectFaultKind::WrongSize => "wrong-size",
            ObjectFaultKind::Writable => "writable",
            ObjectFaultKind::ReadOnly => "read-only",
            ObjectFaultKind::Readable => "readable",
            ObjectFaultKind::TooHigh => "too-high",
            ObjectFaultKind::TooLow => "too-low",
        }
    }

    /// The clause that it breaks.
    pub const fn breaks(self) -> &'static str {
        match self {
            ObjectFaultKind::Missing | ObjectFaultKind::Surplus => {
                "CiA 306: the EDS describes every object of the device"
            }
            ObjectFaultKind::WrongDefault => "CiA 306: DefaultValue",
            ObjectFaultKind::WrongSize => "CiA 306: DataType",
            ObjectFaultKind::Writable | ObjectFaultKind::ReadOnly | ObjectFaultKind::Readable => {
                "CiA 306: AccessType"
            }
            ObjectFaultKind::TooHigh => "CiA 306: HighLimit",
            ObjectFaultKind::TooLow => "CiA 306: LowLimit",
        }
    }
}

impl ObjectFault {
    /// The fault that `name` means: a word, and an address after a colon.
    pub fn parse(name: &str) -> Option<ObjectFault> {
        let (word, address) = name.split_once(':')?;
        let mut kinds = ObjectFaultKind::ALL.into_iter();
        Some(ObjectFault {
            kind: kinds.find(|kind| kind.word() == word)?,
            address: Address::parse(address)?,
        })
    }

    /// The fault of this kind that the value at `index` and `sub` would have.
    pub const fn new(kind: ObjectFaultKind, index: u16, sub: u8) -> ObjectFault {
        ObjectFault {
            kind,
            address: Address::new(index, sub),
        }
    }

    /// What is not as the dictionary says.
    pub const fn kind(self) -> ObjectFaultKind {
        self.kind
    }

    pub(super) const fn address(self) -> Address {
        self.address
    }

    /// The index of the value.
    pub const fn index(self) -> u16 {
        self.address.index()
    }

    /// Whether a device with this dictionary can have it, so that it shows.
    pub fn fits(self, dictionary: &Dictionary) -> bool {
        let entry = dictionary.entry(self.address.index(), self.address.sub());
        let Some(entry) = entry else {
            return self.kind == ObjectFaultKind::Surplus;
        };
        let access = entry.access;
        match self.kind {
            ObjectFaultKind::Missing => true,
            ObjectFaultKind::Surplus => false,
            // What is read-only may change by itself, and 1003h tells what has happened.
            ObjectFaultKind::WrongDefault => {
                let changes = access == Access::ReadOnly || self.address.index() == ERROR_HISTORY;
                let stays = !changes && access.readable();
                entry.default.is_some() && stays
            }
            ObjectFaultKind::WrongSize => entry.data_type.bytes().is_some() && access.readable(),
            ObjectFaultKind::Writable => !access.writable(),
            ObjectFaultKind::ReadOnly => access.writable() && self.is_plain(),
            ObjectFaultKind::Readable => !access.readable(),
            ObjectFaultKind::TooHigh => {
                let bounded = entry
                    .high_limit
                    .is_some_and(|high| high.value(1) < highest(entry));
                bounded && access.writable() && self.is_plain() && !self.has_own_limits()
            }
            ObjectFaultKind::TooLow => {
                let bounded = entry
                    .low_limit
                    .is_some_and(|low| low.value(1) > lowest(entry));
                bounded && access.writable() && self.is_plain() && !self.has_own_limits()
            }
        }
    }

    /// Whether the application checks what is written by itself, so that the dictionary's limits make no difference: the
    /// encoder's node-ID and bit rate, the registers behind the gateway.
    const fn has_own_limits(self) -> bool {
        matches!(self.address.index(), 0x2025 | 0x3000 | 0x3001)
    }

    /// Whether nothing but its type and limits says what may be written: no service has rules of its own for it.
    const fn is_plain(self) -> bool {
        !matches!(
            self.address.index(),
            0x1003 | 0x1010 | 0x1011 | 0x1019 | 0x1020 | 0x1200..=0x1BFF
        )
    }
}

/// The highest value that the type can hold.
fn highest(entry: &Entry) -> i128 {
    let bits = entry.data_type.bits().unwrap_or(0);
    match entry.data_type.is_signed() {
        true => (1 << bits.saturating_sub(1)) - 1,
        false => (1 << bits) - 1,
    }
}

/// The lowest value that the type can hold.
fn lowest(entry: &Entry) -> i128 {
    let bits = entry.data_type.bits().unwrap_or(0);
    match entry.data_type.is_signed() {
        true => -(1 << bits.saturating_sub(1)),
        false => 0,
    }
}

impl fmt::Display for ObjectFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.kind.word(), self.address)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_a_word_and_an_address() {
        let fault = ObjectFault::parse("wrong-default:6040:00").unwrap();
        assert_eq!(fault.kind(), ObjectFaultKind::WrongDefault);
        assert_eq!(fault.to_string(), "wrong-default:6040:00");
        for name in [
            "wrong-default",
            "wrong-default:6040",
            "wrong:6040:00",
            ":6040:00",
            "",
        ] {
            assert_eq!(ObjectFault::parse(name), None, "{name}");
        }
        for kind in ObjectFaultKind::ALL {
            let fault = ObjectFault::new(kind, 0x1A00, 3);
            assert_eq!(ObjectFault::parse(&fault.to_string()), Some(fault));
        }
    }
}
