//! The Modbus side of the drive: its parameters, each at the register of its number.

use std::collections::BTreeMap;

use fieldproof_link::{NotOffered, Parity, SerialSettings, State, StateName, StopBits};

use crate::modbus::{Behaviour, Exception, ExceptionCodes, Registers};

/// The address of the drive unless it is given another: P000 to P045, which set it, are not in the manual's text.
pub(crate) const ADDRESS: u8 = 1;
/// How its line is set: the Modbus default, for the same reason.
pub(crate) const LINE: SerialSettings = SerialSettings {
    baud: 19_200,
    parity: Parity::Even,
    stop_bits: StopBits::One,
};

/// How the manual says the drive behaves: exception 02 is for a value and 03 for an address.
pub(crate) const DOCUMENTED: Behaviour = Behaviour {
    exception_codes: ExceptionCodes::ADDRESS_AND_VALUE_SWAPPED,
    ..Behaviour::CONFORMING
};

/// Registers that are alike.
#[derive(Debug, Clone, Copy)]
struct Group {
    first: u16,
    last: u16,
    takes: Takes,
    default: i16,
}

/// What registers take when they are written.
#[derive(Debug, Clone, Copy)]
enum Takes {
    /// They are read only.
    Nothing,
    /// Any word: no range is printed, it is one half of a 32-bit value, or the range is not legible.
    AnyWord,
    /// A signed value from the first to the second.
    Between(i16, i16),
}

use Takes::{AnyWord, Between, Nothing};

const fn group(first: u16, last: u16, takes: Takes, default: i16) -> Group {
    Group {
        first,
        last,
        takes,
        default,
    }
}

const fn one(number: u16, takes: Takes, default: i16) -> Group {
    group(number, number, takes, default)
}

/// P046 to P389 by number. What is missing is reserved.
const GROUPS: &[Group] = &[
    one(49, AnyWord, 3),
    one(58, Between(0, 13), 0),
    one(59, Between(0, 30), 0),
    one(60, Between(0, 1), 1),
    one(61, Between(0, 2), 0),
    one(70, Between(0, 3_000), 300),
    one(71, AnyWord, 0),
    one(72, AnyWord, 0),
    one(73, Between(0, 4), 1),
    group(74, 78, AnyWord, 0),
    one(80, AnyWord, 0),
    one(81, Between(0, 3), 3),
    one(82, AnyWord, 1),
    group(86, 87, Between(0, 32_767), 1),
    one(88, Between(1, 32_767), 1),
    one(89, Between(0, 7), 1),
    one(90, AnyWord, 0),
    one(91, AnyWord, 0),
    one(92, AnyWord, 500),
    one(93, Between(0, 2), 0),
    one(94, Between(-2_047, 2_047), 0),
    group(95, 96, Between(-3_000, 3_000), 0),
    one(97, AnyWord, 500),
    one(98, AnyWord, 500),
    group(99, 100, Between(-3_000, 3_000), 0),
    group(101, 102, AnyWord, 0),
    one(112, AnyWord, 1_000),
    one(113, Between(0, 10_000), 100),
    one(114, AnyWord, 100),
    one(115, Between(0, 1), 0),
    one(116, Between(0, 1_520), 0),
    one(117, Between(100, 1_000), 500),
    one(118, AnyWord, 0),
    one(119, Between(0, 3_000), 2_000),
    one(120, AnyWord, 0),
    one(121, AnyWord, 0),
    group(122, 123, AnyWord, 10),
    one(124, Between(0, 2), 0),
    one(126, Between(0, 1), 1),
    group(128, 129, AnyWord, 0),
    one(132, Between(0, 3), 0),
    group(133, 137, AnyWord, 0),
    one(138, Between(0, 2_000), 50),
    one(139, Between(0, 20_000), 0),
    // Alarm history, identification, monitors.
    group(140, 149, Nothing, 0),
    one(180, Nothing, 0),
    one(181, Nothing, 0),
    one(182, Between(1, 100), 3),
    group(200, 208, Nothing, 0),
    group(210, 213, Nothing, 0),
    group(216, 227, Nothing, 0),
    one(235, Nothing, 0),
    // Control words and triggers.
    group(279, 282, AnyWord, 0),
    // The banks of internal commands: sixteen positions of two registers, speeds, torques.
    group(290, 321, AnyWord, 0),
    group(324, 355, Between(-6_000, 6_000), 0),
    group(358, 389, Between(-3_500, 3_500), 0),
];

/// The parameters as the drive holds them now. What is written is lost at power-off: nothing here stores it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct DriveRegisters {
    address: u8,
    line: SerialSettings,
    /// What departs from the default.
    values: BTreeMap<u16, u16>,
}

impl Default for DriveRegisters {
    fn default() -> DriveRegisters {
        DriveRegisters::new(ADDRESS, LINE)
    }
}

impl DriveRegisters {
    /// As after power-on, with this address on a line set so.
    pub(crate) fn new(address: u8, line: SerialSettings) -> DriveRegisters {
        DriveRegisters {
            address,
            line,
            values: BTreeMap::new(),
        }
    }

    /// Every parameter as after power-on.
    pub(crate) fn power_on(&mut self) {
        self.values.clear();
    }

    /// Sets the own address as the front panel would, `1..=247`.
    ///
    /// # Errors
    /// [`NotOffered`]: any other address.
    pub(crate) fn set_address(&mut self, address: i64) -> Result<(), NotOffered> {
        self.address = u8::try_from(address)
            .ok()
            .filter(|address| (1..=247).contains(address))
            .ok_or(NotOffered)?;
        Ok(())
    }

    /// Sets the rate of the line in bit/s; the slave that owns these registers is then to be restarted.
    ///
    /// # Errors
    /// [`NotOffered`]: zero, or more than any line has.
    pub(crate) fn set_baud(&mut self, baud: i64) -> Result<(), NotOffered> {
        self.line.baud = u32::try_from(baud)
            .ok()
            .filter(|baud| *baud > 0)
            .ok_or(NotOffered)?;
        Ok(())
    }

    /// Sets what the drive measures or holds: `P212`, or `register` and the number in hexadecimal (`register 00D4`), as
    /// a signed or an unsigned word.
    ///
    /// # Errors
    /// [`NotOffered`]: no such parameter, or not a word.
    pub(crate) fn set_process_value(&mut self, name: &str, value: i64) -> Result<(), NotOffered> {
        let number = match name.strip_prefix("register ") {
            Some(digits) => u16::from_str_radix(digits, 16).ok(),
            None => name
                .strip_prefix('P')
                .and_then(|digits| digits.parse().ok()),
        };
        let number = number.ok_or(NotOffered)?;
        let unsigned = u16::try_from(value).ok();
        let signed = i16::try_from(value).ok().map(i16::cast_unsigned);
        let word = unsigned.or(signed).ok_or(NotOffered)?;
        find(number).ok_or(NotOffered)?;
        self.values.insert(number, word);
        Ok(())
    }
}

impl Registers for DriveRegisters {
    fn address(&self) -> u8 {
        self.address
    }

    fn serial(&self) -> SerialSettings {
        self.line
    }

    fn read(&self, register: u16, _: &Behaviour) -> Result<u16, Exception> {
        let group = find(register).ok_or(Exception::IllegalDataAddress)?;
        let value = self.values.get(&register).copied();
        Ok(value.unwrap_or(group.default.cast_unsigned()))
    }

    fn check_write(&self, register: u16, value: u16) -> Result<(), Exception> {
        let group = find(register).ok_or(Exception::IllegalDataAddress)?;
        match group.takes {
            Nothing => Err(Exception::IllegalDataAddress),
            Between(low, high) if !(low..=high).contains(&value.cast_signed()) => {
                Err(Exception::IllegalDataValue)
            }
            Between(..) | AnyWord => Ok(()),
        }
    }

    fn write(&mut self, register: u16, value: u16) {
        self.values.insert(register, value);
    }

    fn state(&self) -> State {
        let parameters = GROUPS
            .iter()
            .filter(|group| !matches!(group.takes, Nothing))
            .flat_map(|group| (group.first..=group.last).map(|number| (number, group.default)))
            .map(|(number, default)| {
                let value = self.values.get(&number).copied();
                let value = value.unwrap_or(default.cast_unsigned());
                (StateName::Decimal("P", number), value.into())
            });
        let address = ("modbus address".into(), self.address.into());
        parameters.chain([address]).collect()
    }
}

fn find(number: u16) -> Option<&'static Group> {
    GROUPS
        .iter()
        .find(|group| (group.first..=group.last).contains(&number))
}

#[cfg(test)]
mod tests;
