//! What the slave has in its tables, files and queues.

use std::collections::{BTreeMap, BTreeSet};

use fieldproof_link::{NotOffered, Parity, SerialSettings, State, StateName, StopBits};

use super::identification;
use crate::modbus::{Behaviour, Exception, Registers};

/// The address unless it is given another.
pub(super) const ADDRESS: u8 = 1;
/// How its line is set: the default of the serial-line specification.
pub(super) const LINE: SerialSettings = SerialSettings {
    baud: 19_200,
    parity: Parity::Even,
    stop_bits: StopBits::One,
};

const FUNCTIONS: &[u8] = &[
    0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x07, 0x08, 0x0B, 0x0C, 0x0F, 0x10, 0x11, 0x14, 0x15, 0x16,
    0x17, 0x18, 0x2B,
];
/// Functions that write.
const WRITES: &[u8] = &[0x05, 0x06, 0x0F, 0x10, 0x15, 0x16, 0x17];
/// Functions that reach files.
const FILES: &[u8] = &[0x14, 0x15];

/// Coils and discrete inputs below this, so that the most that one request may name fit.
const BITS: u16 = 2_048;
/// Input registers below this.
const INPUTS: u16 = 256;
/// Holding registers below this take any word.
const WORDS: u16 = 200;
/// Every table has the last eight addresses.
const LAST: u16 = 0xFFF8;

/// 0 to 100.
const LIMITED: u16 = 200;
/// -500 to 500.
const SIGNED: u16 = 201;
/// Three values of two registers: unsigned, signed with the low word first, floating point.
const LONG_FIRST: u16 = 202;
const LONG_LAST: u16 = 207;
/// 0, 1 and 2.
const MODE: u16 = 208;
const SERIAL_NUMBER: u16 = 210;
/// Taken and nowhere seen.
const COMMAND: u16 = 211;
/// Survives power-off.
const KEPT: u16 = 212;

/// Queues by their pointers; the last one holds more than an answer can.
const QUEUES: [(u16, u16); 3] = [(0x0300, 3), (0x0301, 0), (0x0302, 32)];
/// Files 1 and 2 have so many records.
const RECORDS: [(u16, u16); 2] = [(1, 10), (2, 200)];

/// Under which nothing, or not everything, can be done.
const CONDITIONS: [(&str, Exception, Option<&[u8]>); 6] = [
    ("hardware-fault", Exception::ServerDeviceFailure, None),
    ("long-work", Exception::Acknowledge, Some(WRITES)),
    ("busy", Exception::DeviceBusy, None),
    ("memory-fault", Exception::MemoryParity, Some(FILES)),
    ("no-path", Exception::GatewayPathUnavailable, None),
    ("target-silent", Exception::GatewayTargetSilent, None),
];

/// The tables as they are now; what is not said is as after power-on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct CompleteRegisters {
    address: u8,
    line: SerialSettings,
    coils: BTreeSet<u16>,
    holding: BTreeMap<u16, u16>,
    records: BTreeMap<(u16, u16), u16>,
    inputs: BTreeMap<u16, u16>,
    discrete_inputs: BTreeMap<u16, bool>,
    conditions: BTreeSet<&'static str>,
}

impl CompleteRegisters {
    /// As after power-on, with this address.
    pub(super) fn new(address: u8) -> CompleteRegisters {
        CompleteRegisters {
            address,
            line: LINE,
            coils: BTreeSet::new(),
            holding: BTreeMap::new(),
            records: BTreeMap::new(),
            inputs: BTreeMap::new(),
            discrete_inputs: BTreeMap::new(),
            conditions: BTreeSet::new(),
        }
    }

    /// What is lost at power-off is lost; files are memory.
    pub(super) fn power_on(&mut self) {
        self.coils.clear();
        self.holding.retain(|register, _| *register == KEPT);
    }

    /// What should survive power-off is lost, too.
    pub(super) fn forget(&mut self) {
        self.holding.clear();
    }

    /// Sets an input: `input register 0005`, `discrete input 0003`, the number in hexadecimal.
    ///
    /// # Errors
    /// [`NotOffered`]: no such input, or a value that it cannot have.
    pub(super) fn set_process_value(&mut self, name: &str, value: i64) -> Result<(), NotOffered> {
        let (kind, digits) = name.rsplit_once(' ').ok_or(NotOffered)?;
        let number = u16::from_str_radix(digits, 16).map_err(|_| NotOffered)?;
        match kind {
            "input register" => {
                self.read_input(number).map_err(|_| NotOffered)?;
                let value = u16::try_from(value).map_err(|_| NotOffered)?;
                self.inputs.insert(number, value);
            }
            "discrete input" => {
                self.read_discrete_input(number).map_err(|_| NotOffered)?;
                self.discrete_inputs.insert(number, value != 0);
            }
            _ => return Err(NotOffered),
        }
        Ok(())
    }

    /// Brings a condition about, or ends it.
    ///
    /// # Errors
    /// [`NotOffered`]: another condition.
    pub(super) fn set_condition(&mut self, name: &str, active: bool) -> Result<(), NotOffered> {
        let known = CONDITIONS.iter().find(|(known, _, _)| *known == name);
        let (name, _, _) = known.ok_or(NotOffered)?;
        match active {
            true => self.conditions.insert(name),
            false => self.conditions.remove(name),
        };
        Ok(())
    }

    /// Sets the own address as a switch would, `1..=247`.
    ///
    /// # Errors
    /// [`NotOffered`]: any other address.
    pub(super) fn set_address(&mut self, address: i64) -> Result<(), NotOffered> {
        let address = u8::try_from(address).ok();
        let unicast = address.filter(|address| (1..=247).contains(address));
        self.address = unicast.ok_or(NotOffered)?;
        Ok(())
    }

    /// Sets the rate of the line in bit/s; the slave that owns these registers is then to be restarted.
    ///
    /// # Errors
    /// [`NotOffered`]: zero, or more than any line has.
    pub(super) fn set_baud(&mut self, baud: i64) -> Result<(), NotOffered> {
        let baud = u32::try_from(baud).ok().filter(|baud| *baud > 0);
        self.line.baud = baud.ok_or(NotOffered)?;
        Ok(())
    }
}

/// What a register holds after power-on.
fn default(register: u16) -> u16 {
    match register {
        LIMITED => 50,
        SERIAL_NUMBER => 12_345,
        _ => 0,
    }
}

fn exists(there: bool) -> Result<(), Exception> {
    match there {
        true => Ok(()),
        false => Err(Exception::IllegalDataAddress),
    }
}

impl Registers for CompleteRegisters {
    fn address(&self) -> u8 {
        self.address
    }

    fn serial(&self) -> SerialSettings {
        self.line
    }

    fn functions(&self) -> &'static [u8] {
        FUNCTIONS
    }

    fn unable(&self, function: u8) -> Option<Exception> {
        let active = CONDITIONS
            .iter()
            .filter(|(name, _, _)| self.conditions.contains(name));
        active
            .filter(|(_, _, functions)| functions.is_none_or(|it| it.contains(&function)))
            .map(|(_, exception, _)| *exception)
            .next()
    }

    fn read(&self, register: u16, _: &Behaviour) -> Result<u16, Exception> {
        let there = matches!(register, 0..=MODE | SERIAL_NUMBER | KEPT | LAST..);
        exists(there)?;
        let held = self.holding.get(&register).copied();
        Ok(held.unwrap_or(default(register)))
    }

    fn check_write(&self, register: u16, value: u16) -> Result<(), Exception> {
        let allowed = match register {
            0..WORDS | LONG_FIRST..=LONG_LAST | COMMAND | KEPT | LAST.. => true,
            LIMITED => value <= 100,
            SIGNED => (-500..=500).contains(&value.cast_signed()),
            MODE => value <= 2,
            _ => return Err(Exception::IllegalDataAddress),
        };
        match allowed {
            true => Ok(()),
            false => Err(Exception::IllegalDataValue),
        }
    }

    fn write(&mut self, register: u16, value: u16) {
        if register == COMMAND {
            return;
        }
        match value == default(register) {
            true => self.holding.remove(&register),
            false => self.holding.insert(register, value),
        };
    }

    /// The number of the register in both bytes, so that every one of a row is another.
    fn read_input(&self, register: u16) -> Result<u16, Exception> {
        exists(matches!(register, 0..INPUTS | LAST..))?;
        let set = self.inputs.get(&register).copied();
        let [_, low] = register.to_be_bytes();
        Ok(set.unwrap_or(u16::from_be_bytes([low, !low])))
    }

    fn read_coil(&self, coil: u16) -> Result<bool, Exception> {
        exists(matches!(coil, 0..BITS | LAST..))?;
        Ok(self.coils.contains(&coil))
    }

    fn write_coil(&mut self, coil: u16, on: bool) {
        match on {
            true => self.coils.insert(coil),
            false => self.coils.remove(&coil),
        };
    }

    /// Every third is on.
    fn read_discrete_input(&self, input: u16) -> Result<bool, Exception> {
        exists(matches!(input, 0..BITS | LAST..))?;
        let set = self.discrete_inputs.get(&input).copied();
        Ok(set.unwrap_or(input.is_multiple_of(3)))
    }

    fn exception_status(&self) -> u8 {
        0b0110_1101
    }

    fn server_id(&self) -> (Vec<u8>, Vec<u8>) {
        (vec![0x4D], b"modbus-complete".to_vec())
    }

    fn read_record(&self, file: u16, record: u16) -> Result<u16, Exception> {
        let length = RECORDS.iter().find(|(number, _)| *number == file);
        exists(length.is_some_and(|(_, length)| record < *length))?;
        let written = self.records.get(&(file, record)).copied();
        Ok(written.unwrap_or(0x1000_u16.wrapping_mul(file) | record))
    }

    fn write_record(&mut self, file: u16, record: u16, value: u16) {
        let original = 0x1000_u16.wrapping_mul(file) | record;
        match value == original {
            true => self.records.remove(&(file, record)),
            false => self.records.insert((file, record), value),
        };
    }

    fn fifo(&self, pointer: u16) -> Result<Vec<u16>, Exception> {
        let queue = QUEUES.iter().find(|(known, _)| *known == pointer);
        let (_, length) = queue.ok_or(Exception::IllegalDataAddress)?;
        Ok((0..*length).map(|place| 0x01B8 + place).collect())
    }

    fn identification(&self) -> &'static [(u8, &'static str)] {
        identification::OBJECTS
    }

    /// Only what is not as after power-on.
    fn state(&self) -> State {
        let mut state = State::default();
        for coil in &self.coils {
            state.insert(StateName::Hexadecimal("coil ", *coil), true);
        }
        for (register, value) in &self.holding {
            state.insert(StateName::Hexadecimal("register ", *register), *value);
        }
        for ((file, record), value) in &self.records {
            state.insert(format!("record {file}:{record}"), *value);
        }
        for condition in &self.conditions {
            state.insert(*condition, true);
        }
        state.insert("modbus address", self.address);
        state.insert("baud", self.line.baud);
        state
    }
}
