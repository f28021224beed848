//! Faults of one holding register, named with its address in hexadecimal: `register-missing:00D4`.

use std::fmt;

use fieldproof_dictionary::Access;
use fieldproof_dictionary::registers::{Holes, Kind, Register, RegisterMap, Table, WriteEffect};

/// One register that is not as the map says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RegisterFault {
    kind: RegisterFaultKind,
    address: u16,
}

/// What is not as the map says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RegisterFaultKind {
    /// It is not there.
    Missing,
    /// It is there, where the map has nothing.
    Surplus,
    /// It has another value as long as nobody has written one.
    WrongDefault,
    /// A write is confirmed, though it is read-only.
    Writable,
    /// A write is refused, though it can be written.
    ReadOnly,
    /// It takes values outside its limits.
    Unlimited,
    /// A write is confirmed and not done.
    NotWritten,
}

impl RegisterFaultKind {
    /// All of them.
    pub const ALL: [RegisterFaultKind; 7] = [
        RegisterFaultKind::Missing,
        RegisterFaultKind::Surplus,
        RegisterFaultKind::WrongDefault,
        RegisterFaultKind::Writable,
        RegisterFaultKind::ReadOnly,
        RegisterFaultKind::Unlimited,
        RegisterFaultKind::NotWritten,
    ];

    /// What stands before the address.
    pub const fn word(self) -> &'static str {
        match self {
            RegisterFaultKind::Missing => "register-missing",
            RegisterFaultKind::Surplus => "register-surplus",
            RegisterFaultKind::WrongDefault => "register-wrong-default",
            RegisterFaultKind::Writable => "register-writable",
            RegisterFaultKind::ReadOnly => "register-read-only",
            RegisterFaultKind::Unlimited => "register-unlimited",
            RegisterFaultKind::NotWritten => "register-not-written",
        }
    }

    /// What it breaks.
    pub const fn breaks(self) -> &'static str {
        match self {
            RegisterFaultKind::Missing => "the register map: what there is can be read",
            RegisterFaultKind::Surplus => "the register map: what there is not is refused",
            RegisterFaultKind::WrongDefault => "the register map: default",
            RegisterFaultKind::Writable | RegisterFaultKind::ReadOnly => "the register map: access",
            RegisterFaultKind::Unlimited => "the register map: low and high",
            RegisterFaultKind::NotWritten => "the register map: what was written is read",
        }
    }
}

impl RegisterFault {
    /// The fault that `name` means: a word, and an address of four hexadecimal digits after a colon.
    pub fn parse(name: &str) -> Option<RegisterFault> {
        let (word, address) = name.split_once(':')?;
        let is_address =
            address.len() == 4 && address.chars().all(|digit| digit.is_ascii_hexdigit());
        let mut kinds = RegisterFaultKind::ALL.into_iter();
        Some(RegisterFault {
            kind: kinds.find(|kind| kind.word() == word)?,
            address: u16::from_str_radix(address, 16)
                .ok()
                .filter(|_| is_address)?,
        })
    }

    /// The fault of this kind that the register at `address` would have.
    pub const fn new(kind: RegisterFaultKind, address: u16) -> RegisterFault {
        RegisterFault { kind, address }
    }

    /// What is not as the map says.
    pub const fn kind(self) -> RegisterFaultKind {
        self.kind
    }

    /// Whether this register has it.
    pub(super) fn is(self, kind: RegisterFaultKind, address: u16) -> bool {
        self.kind == kind && self.address == address
    }

    /// Its register.
    pub(super) const fn address(self) -> u16 {
        self.address
    }

    /// Whether a device with this map can have it, so that it shows.
    pub fn fits(self, map: &RegisterMap) -> bool {
        let Some(table) = map.table(Table::Holding) else {
            return false;
        };
        let Some(register) = table.register(self.address) else {
            let refused = table.holes == Holes::Refused;
            let beside = table.holes_beside().contains(&self.address);
            return self.kind == RegisterFaultKind::Surplus && refused && beside;
        };
        let is_word = matches!(register.kind, Kind::U16 | Kind::I16);
        match self.kind {
            RegisterFaultKind::Missing => register.access.readable(),
            RegisterFaultKind::Surplus => false,
            RegisterFaultKind::WrongDefault => {
                let effects = register.effects.as_ref();
                let stays = effects.is_some_and(|it| !it.contains(&WriteEffect::Readdresses));
                register.default.is_some() && register.access.readable() && stays && is_word
            }
            RegisterFaultKind::Writable => register.access == Access::ReadOnly && is_word,
            RegisterFaultKind::ReadOnly | RegisterFaultKind::NotWritten => {
                has_limits(register) && only_writes(register) && is_word
            }
            RegisterFaultKind::Unlimited => {
                is_bounded(register) && only_writes(register) && is_word
            }
        }
    }
}

fn has_limits(register: &Register) -> bool {
    register.low.is_some() && register.high.is_some()
}

fn is_bounded(register: &Register) -> bool {
    let above = register.high.is_some_and(|it| it < register.kind.highest());
    let below = register.low.is_some_and(|it| it > register.kind.lowest());
    above || below
}

/// What is walked over is written only where that does nothing else.
fn only_writes(register: &Register) -> bool {
    let harmless = |effects: &std::collections::BTreeSet<WriteEffect>| {
        effects.iter().all(|it| *it == WriteEffect::Writes)
    };
    register.access == Access::ReadWrite && register.effects.as_ref().is_some_and(harmless)
}

impl fmt::Display for RegisterFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{:04X}", self.kind.word(), self.address)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_a_word_and_an_address() {
        let fault = RegisterFault::parse("register-missing:00D4").unwrap();
        assert_eq!(fault.kind(), RegisterFaultKind::Missing);
        assert_eq!(fault.to_string(), "register-missing:00D4");
        for name in [
            "register-missing",
            "register-missing:D4",
            "register-missing:+0D4",
            "missing:00D4",
            ":00D4",
            "",
        ] {
            assert_eq!(RegisterFault::parse(name), None, "{name}");
        }
        for kind in RegisterFaultKind::ALL {
            let fault = RegisterFault::new(kind, 0xFFFF);
            assert_eq!(RegisterFault::parse(&fault.to_string()), Some(fault));
        }
    }
}
