//! The registers of group 25: control 2500h to 251Fh, monitor 2520h to 252Fh.

use fieldproof_link::{NotOffered, Parity, SerialSettings, State, StateName, StopBits};

use crate::modbus::{Behaviour, Exception, Registers};

/// The station the inverter is set to.
pub const STATION: u8 = 1;
/// How its line is set; a gateway of this family expects nothing else.
pub const LINE: SerialSettings = SerialSettings {
    baud: 19_200,
    parity: Parity::None,
    stop_bits: StopBits::One,
};

const FIRST: u16 = 0x2500;
const OPERATION_SIGNAL: u16 = 0x2501;
const FREQUENCY_COMMAND: u16 = 0x2502;
const FIRST_MONITOR: u16 = 0x2520;
const STATE_SIGNAL: u16 = 0x2520;
const ERROR_DESCRIPTION: u16 = 0x2521;
const FREQUENCY_COMMAND_MONITOR: u16 = 0x2523;
const OUTPUT_FREQUENCY: u16 = 0x2524;
const MODEL_CHECK: u16 = 0x252F;

/// 400.00 Hz
const HIGHEST_FREQUENCY: u16 = 40_000;
/// 5.00 Hz
const DEFAULT_FREQUENCY: u16 = 500;
const A510: u16 = 300;

/// Bits of the operation signal and, the first two, of the state signal.
const RUN: u16 = 1 << 0;
const REVERSE: u16 = 1 << 1;
const EXTERNAL_FAULT: u16 = 1 << 2;
const FAULT_RESET: u16 = 1 << 3;
/// Further bits of the state signal.
const READY: u16 = 1 << 2;
const FAULT: u16 = 1 << 3;
/// The error code of an external fault that came over Modbus.
const MODBUS_EXTERNAL_FAULT: u16 = 53;

/// The registers and how they hang together.
///
/// The bits *run* and *reverse* of 2501h show in 2520h, with *ready* unless there is a fault; 2502h (0.01 Hz) shows in
/// 2523h, and in 2524h while the motor runs. The bit *external fault* of 2501h stops it until *fault reset*.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InverterRegisters {
    address: u8,
    values: [u16; 48],
}

impl Default for InverterRegisters {
    /// Stopped, ready, 5.00 Hz commanded.
    fn default() -> InverterRegisters {
        InverterRegisters::at(STATION)
    }
}

impl InverterRegisters {
    /// Stopped, ready, 5.00 Hz commanded, with this address.
    pub fn at(address: u8) -> InverterRegisters {
        let mut registers = InverterRegisters {
            address,
            values: [0; 48],
        };
        registers.set(FREQUENCY_COMMAND, DEFAULT_FREQUENCY);
        registers.set(FREQUENCY_COMMAND_MONITOR, DEFAULT_FREQUENCY);
        registers.set(STATE_SIGNAL, READY);
        registers.set(MODEL_CHECK, A510);
        registers
    }

    /// Sets the own address as parameter 09-00 would, `1..=247`.
    ///
    /// # Errors
    /// [`NotOffered`]: any other address.
    pub fn set_address(&mut self, address: i64) -> Result<(), NotOffered> {
        let address = u8::try_from(address).ok();
        let unicast = address.filter(|address| (1..=247).contains(address));
        self.address = unicast.ok_or(NotOffered)?;
        Ok(())
    }

    /// Sets a register as if the inverter had come to hold it: `register 2520`, the number in hexadecimal.
    ///
    /// # Errors
    /// [`NotOffered`]: no such register, or not a word.
    pub fn set_process_value(&mut self, name: &str, value: i64) -> Result<(), NotOffered> {
        let digits = name.strip_prefix("register ").ok_or(NotOffered)?;
        let register = u16::from_str_radix(digits, 16).map_err(|_| NotOffered)?;
        let value = u16::try_from(value).map_err(|_| NotOffered)?;
        self.get(register).ok_or(NotOffered)?;
        self.set(register, value);
        if register == STATE_SIGNAL {
            self.show_frequency();
        }
        Ok(())
    }

    fn get(&self, register: u16) -> Option<u16> {
        let place = register.checked_sub(FIRST)?;
        self.values.get(usize::from(place)).copied()
    }

    /// Sets a register; none if it does not exist.
    fn set(&mut self, register: u16, value: u16) {
        let place = register.checked_sub(FIRST).map(usize::from);
        if let Some(held) = place.and_then(|place| self.values.get_mut(place)) {
            *held = value;
        }
    }

    fn value(&self, register: u16) -> u16 {
        self.get(register).unwrap_or_default()
    }

    /// Does what the operation signal says.
    fn operate(&mut self) {
        let signal = self.value(OPERATION_SIGNAL);
        if signal & EXTERNAL_FAULT != 0 {
            self.set(ERROR_DESCRIPTION, MODBUS_EXTERNAL_FAULT);
        } else if signal & FAULT_RESET != 0 {
            self.set(ERROR_DESCRIPTION, 0);
        }
        let others = self.value(STATE_SIGNAL) & !(RUN | REVERSE | READY | FAULT);
        let state = if self.value(ERROR_DESCRIPTION) == 0 {
            READY | signal & (RUN | REVERSE)
        } else {
            FAULT | signal & REVERSE
        };
        self.set(STATE_SIGNAL, others | state);
    }

    fn show_frequency(&mut self) {
        let frequency = self.value(FREQUENCY_COMMAND);
        let running = self.value(STATE_SIGNAL) & RUN != 0;
        self.set(FREQUENCY_COMMAND_MONITOR, frequency);
        self.set(OUTPUT_FREQUENCY, if running { frequency } else { 0 });
    }
}

impl Registers for InverterRegisters {
    fn address(&self) -> u8 {
        self.address
    }

    fn serial(&self) -> SerialSettings {
        LINE
    }

    fn read(&self, register: u16, _: &Behaviour) -> Result<u16, Exception> {
        self.get(register).ok_or(Exception::IllegalDataAddress)
    }

    fn check_write(&self, register: u16, value: u16) -> Result<(), Exception> {
        if !(FIRST..FIRST_MONITOR).contains(&register) {
            return Err(Exception::IllegalDataAddress);
        }
        if register == FREQUENCY_COMMAND && value > HIGHEST_FREQUENCY {
            return Err(Exception::IllegalDataValue);
        }
        Ok(())
    }

    fn write(&mut self, register: u16, value: u16) {
        self.set(register, value);
        if register == OPERATION_SIGNAL {
            self.operate();
        }
        if matches!(register, OPERATION_SIGNAL | FREQUENCY_COMMAND) {
            self.show_frequency();
        }
    }

    /// `register 2501` and so on, the values in decimal.
    fn state(&self) -> State {
        (FIRST..)
            .zip(self.values)
            .map(|(register, value)| (StateName::Hexadecimal("register ", register), value.into()))
            .collect()
    }
}
