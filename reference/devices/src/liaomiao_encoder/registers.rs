//! The Modbus side of the encoder: its nineteen registers.

use std::time::Duration;

use fieldproof_link::{NotOffered, Parity, SerialSettings, State, StateName, StopBits};

use super::model::EncoderModel;
use crate::modbus::{
    AddressChangeReply, Behaviour, Command, Departure, Exception, Registers, SpeedSign,
};

/// The address the encoder leaves the factory with.
pub(crate) const ADDRESS: u8 = 0x20;
/// How its line is set when it leaves the factory.
pub(crate) const LINE: SerialSettings = line(9_600);

const VERSION: u16 = 0x0000;
const SLAVE_ADDRESS: u16 = 0x0001;
const POSITION_HIGH: u16 = 0x0002;
const POSITION_LOW: u16 = 0x0003;
const SPEED: u16 = 0x0004;
const BAUD: u16 = 0x0005;
const DIRECTION: u16 = 0x0006;
const SET_ANGLE: u16 = 0x0007;
const TEMPERATURE: u16 = 0x0008;
const UNNAMED: u16 = 0x0009;
const ANGLE: u16 = 0x000B;
const SPEED_INTEGER: u16 = 0x000C;
const SPEED_FRACTION: u16 = 0x000D;
const FILTER: u16 = 0x000E;
const LOW_LATENCY: u16 = 0x000F;
const SINGLE_TURN_BITS: u16 = 0x0010;
const PRESET_HIGH: u16 = 0x0012;
const PRESET_LOW: u16 = 0x0013;
const RESTORE: u16 = 0x0016;

/// V4.020
const FACTORY_VERSION: u16 = 4_020;
const FACTORY_FILTER: u16 = 10;
const MOST_RPM: i32 = 15_000;
/// One rpm in the unit of the fraction.
const RPM: i32 = 10_000;

/// A change of address goes to this address, to function 10h and register 0001h, and carries `addr:` and the new one.
const ADDRESS_TEXT: usize = 5;
const ADDRESS_CHANGE: [u8; 12] = *b"\xFF\x10\x00\x01\x00\x03\x06addr:";

/// The codes of the baud register, in the order of the rates.
const BAUD_CODES: [(u16, u32); 9] = [
    (1_200, 1_200),
    (2_400, 2_400),
    (4_800, 4_800),
    (9_600, 9_600),
    (19_200, 19_200),
    (38_400, 38_400),
    (57_600, 57_600),
    (11_520, 115_200),
    // Not printed: by analogy with the code of 115200.
    (25_600, 256_000),
];

const fn line(baud: u32) -> SerialSettings {
    SerialSettings {
        baud,
        parity: Parity::None,
        stop_bits: StopBits::One,
    }
}

/// The registers, and the model that they show. Settings survive power-off.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct EncoderRegisters {
    /// What the encoder measures; the CAN side shows the same.
    pub(crate) model: EncoderModel,
    version: u16,
    address: u8,
    baud_code: u16,
    unnamed: u16,
    filter: u16,
    low_latency: bool,
}

impl Default for EncoderRegisters {
    fn default() -> EncoderRegisters {
        EncoderRegisters::new(ADDRESS)
    }
}

impl EncoderRegisters {
    /// As it leaves the factory, but with the address `address`.
    pub(crate) fn new(address: u8) -> EncoderRegisters {
        EncoderRegisters {
            model: EncoderModel::default(),
            version: FACTORY_VERSION,
            address,
            baud_code: 9_600,
            unnamed: 0,
            filter: FACTORY_FILTER,
            low_latency: false,
        }
    }

    /// Sets the own address as a switch would, `1..=247`.
    ///
    /// # Errors
    /// [`NotOffered`]: any other address.
    pub(crate) fn set_address(&mut self, address: i64) -> Result<(), NotOffered> {
        self.address = unicast(address).ok_or(NotOffered)?;
        Ok(())
    }

    /// Sets the rate of the line in bit/s; the slave that owns these registers is then to be restarted.
    ///
    /// # Errors
    /// [`NotOffered`]: not one of the nine rates.
    pub(crate) fn set_baud(&mut self, baud: i64) -> Result<(), NotOffered> {
        let code = BAUD_CODES
            .iter()
            .find(|(_, rate)| i64::from(*rate) == baud)
            .ok_or(NotOffered)?;
        self.baud_code = code.0;
        Ok(())
    }

    /// Sets what is measured: `position` in counts, `speed` in 1/10000 rpm, `temperature` in 1/100 °C, or `register` and
    /// the number of a read-only register in hexadecimal, in the unit of that register. A whole number of rpm (000Ch)
    /// sets the fraction (000Dh) to zero, so it is to be set first.
    ///
    /// # Errors
    /// [`NotOffered`]: no such name, or a value that it cannot have.
    pub(crate) fn set_process_value(&mut self, name: &str, value: i64) -> Result<(), NotOffered> {
        match name {
            "position" => self.model.position = narrow(value)?,
            "speed" => self.model.set_shown_speed(narrow(value)?),
            "temperature" => self.model.temperature_hundredths = narrow(value)?,
            _ => {
                let digits = name.strip_prefix("register ").ok_or(NotOffered)?;
                let register = u16::from_str_radix(digits, 16).map_err(|_| NotOffered)?;
                self.set_measured(register, value)?;
            }
        }
        Ok(())
    }

    fn set_measured(&mut self, register: u16, value: i64) -> Result<(), NotOffered> {
        match register {
            VERSION => self.version = narrow(value)?,
            POSITION_HIGH => self.set_position_high(narrow(value)?),
            POSITION_LOW => self.set_position_low(narrow(value)?),
            SPEED | SPEED_INTEGER => {
                let rpm = i32::from(narrow::<i16>(value)?);
                self.model.set_shown_speed(rpm * RPM);
            }
            SPEED_FRACTION => {
                let fraction = i32::from(narrow::<i16>(value)?);
                let rpm = self.model.shown_speed() / RPM;
                self.model.set_shown_speed(rpm * RPM + fraction);
            }
            TEMPERATURE => self.model.temperature_hundredths = narrow(value)?,
            UNNAMED => self.unnamed = narrow(value)?,
            ANGLE => self.model.set_angle(narrow(value)?),
            _ => return Err(NotOffered),
        }
        Ok(())
    }

    fn set_position_high(&mut self, high: u16) {
        self.model.position = u32::from(high) << 16 | self.model.position & 0xFFFF;
    }

    fn set_position_low(&mut self, low: u16) {
        self.model.position = self.model.position & 0xFFFF_0000 | u32::from(low);
    }

    /// Everything but address and rate as it left the factory: the master that asked for it can go on.
    fn restore(&mut self) {
        self.model.counter_clockwise = false;
        self.model.set_single_turn_bits(16);
        self.filter = FACTORY_FILTER;
        self.low_latency = false;
    }
}

impl Registers for EncoderRegisters {
    fn address(&self) -> u8 {
        self.address
    }

    fn serial(&self) -> SerialSettings {
        line(baud(self.baud_code).unwrap_or(LINE.baud))
    }

    fn read(&self, register: u16, behaviour: &Behaviour) -> Result<u16, Exception> {
        let speed = match behaviour.speed_sign {
            SpeedSign::Kept => self.model.shown_speed(),
            SpeedSign::Lost => self.model.shown_speed().saturating_abs(),
        };
        Ok(match register {
            VERSION => self.version,
            SLAVE_ADDRESS => u16::from(self.address),
            POSITION_HIGH => low_word(self.model.position >> 16),
            POSITION_LOW => low_word(self.model.position),
            SPEED => low_word((speed / RPM).clamp(-MOST_RPM, MOST_RPM).cast_unsigned()),
            BAUD => self.baud_code,
            DIRECTION => u16::from(self.model.counter_clockwise),
            TEMPERATURE => self.model.temperature_hundredths.cast_unsigned(),
            UNNAMED => self.unnamed,
            ANGLE => self.model.angle(),
            SPEED_INTEGER => {
                let rpm = (speed / RPM).clamp(i32::from(i16::MIN), i32::from(i16::MAX));
                low_word(rpm.cast_unsigned())
            }
            SPEED_FRACTION => low_word((speed % RPM).cast_unsigned()),
            FILTER => self.filter,
            LOW_LATENCY => u16::from(self.low_latency),
            SINGLE_TURN_BITS => u16::from(self.model.single_turn_bits),
            _ => return Err(Exception::IllegalDataAddress),
        })
    }

    fn check_write(&self, register: u16, value: u16) -> Result<(), Exception> {
        let allowed = match register {
            SLAVE_ADDRESS => unicast(i64::from(value)).is_some(),
            BAUD => baud(value).is_some(),
            DIRECTION | LOW_LATENCY | RESTORE => value <= 1,
            SET_ANGLE | PRESET_HIGH | PRESET_LOW => true,
            FILTER => value <= 10,
            SINGLE_TURN_BITS => (8..=16).contains(&value),
            _ => return Err(Exception::IllegalDataAddress),
        };
        if allowed {
            Ok(())
        } else {
            Err(Exception::IllegalDataValue)
        }
    }

    fn write(&mut self, register: u16, value: u16) {
        // The values are those that `check_write` allowed, so the low byte is all of them where a byte is wanted.
        let [_, byte] = value.to_be_bytes();
        match register {
            SLAVE_ADDRESS => self.address = byte,
            BAUD => self.baud_code = value,
            DIRECTION => self.model.counter_clockwise = value == 1,
            SET_ANGLE => self.model.set_angle(value),
            FILTER => self.filter = value,
            LOW_LATENCY => self.low_latency = value == 1,
            SINGLE_TURN_BITS => self.model.set_single_turn_bits(byte),
            PRESET_HIGH => self.set_position_high(value),
            PRESET_LOW => self.set_position_low(value),
            RESTORE if value == 1 => self.restore(),
            _ => {}
        }
    }

    /// The change of address: `FF 10 00 01 00 03 06 61 64 64 72 3A nn`, answered by `nn 10 00 01 00 03`.
    fn command(&mut self, request: &[u8], behaviour: &Behaviour) -> Option<Command> {
        let unchecked = behaviour.departs(Departure::AddressTextIgnored);
        let (head, text) = ADDRESS_CHANGE.split_at(ADDRESS_CHANGE.len() - ADDRESS_TEXT);
        let rest = request.strip_prefix(head)?;
        let address = match rest {
            [words @ .., address] if words == text || unchecked && words.len() == text.len() => {
                *address
            }
            _ => return None,
        };
        let Some(address) = unicast(i64::from(address)) else {
            return Some(Command::Silent);
        };
        let old = std::mem::replace(&mut self.address, address);
        let from = match behaviour.address_change_reply {
            AddressChangeReply::FromNew => address,
            AddressChangeReply::FromOld => old,
            AddressChangeReply::None => return Some(Command::Silent),
        };
        Some(Command::Answer(vec![from, 0x10, 0x00, 0x01, 0x00, 0x03]))
    }

    fn processing_delay(&self, behaviour: &Behaviour) -> Duration {
        if self.low_latency {
            behaviour.processing_delay.min(Duration::from_micros(500))
        } else {
            behaviour.processing_delay
        }
    }

    fn state(&self) -> State {
        [
            (SLAVE_ADDRESS, u16::from(self.address)),
            (BAUD, self.baud_code),
            (DIRECTION, u16::from(self.model.counter_clockwise)),
            (FILTER, self.filter),
            (LOW_LATENCY, u16::from(self.low_latency)),
            (SINGLE_TURN_BITS, u16::from(self.model.single_turn_bits)),
        ]
        .into_iter()
        .map(|(register, value)| (StateName::Hexadecimal("register ", register), value.into()))
        .collect()
    }
}

/// The rate a code of the baud register stands for.
fn baud(code: u16) -> Option<u32> {
    let found = BAUD_CODES.iter().find(|(known, _)| *known == code)?;
    Some(found.1)
}

/// An address of a single slave.
fn unicast(address: i64) -> Option<u8> {
    u8::try_from(address)
        .ok()
        .filter(|address| (1..=247).contains(address))
}

fn narrow<T: TryFrom<i64>>(value: i64) -> Result<T, NotOffered> {
    T::try_from(value).map_err(|_| NotOffered)
}

fn low_word(value: u32) -> u16 {
    let [_, _, high, low] = value.to_be_bytes();
    u16::from_be_bytes([high, low])
}

#[cfg(test)]
mod tests;
