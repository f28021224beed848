//! 03h, 04h, 06h, 10h, 16h, 17h: registers.

use super::{Extent, Service, counted, two_words};
use crate::modbus::{ByteCount, Departure, EchoedValue, Exception, RegisterFaultKind, Registers};

/// Most registers of one 03h, 04h or 17h.
const MOST_READ: u16 = 125;
/// Most registers of one 10h.
const MOST_WRITTEN: u16 = 123;
/// Most registers that one 17h writes.
const MOST_WRITTEN_WITH_READ: u16 = 121;

impl<R: Registers> Service<'_, R> {
    /// Start and quantity; answered by a byte count and the registers.
    pub(super) fn read_holding(&self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        let [start, quantity] = two_words(data)?;
        let extent = self.extent(start, quantity, MOST_READ)?;
        let mut answer =
            counted(self.words(extent, |service, register| service.holding(register))?);
        if self.behaviour.byte_count == ByteCount::Registers {
            answer[0] /= 2;
        }
        Ok(answer)
    }

    /// The same of input registers.
    pub(super) fn read_input(&self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        if self.behaviour.tables_mixed {
            return self.read_holding(data);
        }
        let [start, quantity] = two_words(data)?;
        let extent = self.extent(start, quantity, MOST_READ)?;
        let input =
            |service: &Self, register| service.or_hole(service.registers.read_input(register));
        Ok(counted(self.words(extent, input)?))
    }

    fn words(
        &self,
        extent: Extent,
        read: impl Fn(&Self, u16) -> Result<u16, Exception>,
    ) -> Result<Vec<u8>, Exception> {
        let mut bytes = Vec::new();
        for register in extent.addresses() {
            bytes.extend(read(self, register)?.to_be_bytes());
        }
        Ok(bytes)
    }

    fn holding(&self, register: u16) -> Result<u16, Exception> {
        if self.behaviour.spoils(RegisterFaultKind::Missing, register) {
            return Err(Exception::IllegalDataAddress);
        }
        if self.behaviour.spoils(RegisterFaultKind::Surplus, register) {
            return Ok(0);
        }
        let held = self.or_hole(self.registers.read(register, self.behaviour))?;
        let is_default = self.first_value == Some(held)
            && self
                .behaviour
                .spoils(RegisterFaultKind::WrongDefault, register);
        Ok(match is_default {
            true => held ^ 1,
            false => held,
        })
    }

    fn or_hole(&self, read: Result<u16, Exception>) -> Result<u16, Exception> {
        match read {
            Err(Exception::IllegalDataAddress) if self.behaviour.holes_answered => Ok(0),
            read => read,
        }
    }

    /// Whether a register takes a value; `false` if that is only pretended.
    fn check_write(&self, register: u16, value: u16) -> Result<bool, Exception> {
        let spoils = |kind| self.behaviour.spoils(kind, register);
        match self.registers.check_write(register, value) {
            Ok(()) if spoils(RegisterFaultKind::ReadOnly) => Err(Exception::IllegalDataAddress),
            Ok(()) if spoils(RegisterFaultKind::NotWritten) => Ok(false),
            Err(Exception::IllegalDataValue) if spoils(RegisterFaultKind::Unlimited) => Ok(true),
            Err(_) if spoils(RegisterFaultKind::Writable) => Ok(false),
            Err(Exception::IllegalDataValue) if self.behaviour.limits_ignored => Ok(true),
            Err(Exception::IllegalDataAddress)
                if self.behaviour.read_only_confirmed
                    && self.registers.read(register, self.behaviour).is_ok() =>
            {
                Ok(false)
            }
            checked => checked.map(|()| true),
        }
    }

    /// Register and value; answered by the same.
    pub(super) fn write_single(&mut self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        let [register, value] = two_words(data)?;
        if self.check_write(register, value)?
            && !self.behaviour.departs(Departure::SingleNotWritten)
        {
            self.registers.write(register, value);
        }
        let echoed = match self.behaviour.echoed_value {
            EchoedValue::Written => value,
            EchoedValue::OneMore => value.wrapping_add(1),
        };
        Ok([register.to_be_bytes(), echoed.to_be_bytes()].concat())
    }

    /// Start, quantity, byte count, values; answered by start and quantity. Writes all or none.
    pub(super) fn write_multiple(&mut self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        let write = self.read_write_request(data, MOST_WRITTEN)?;
        self.write_all(&write)?;
        Ok(self.written(&data[..4], data[4]))
    }

    /// Start and quantity of what was written.
    pub(super) fn written(&self, start_and_quantity: &[u8], byte_count: u8) -> Vec<u8> {
        let mut answer = start_and_quantity.to_vec();
        if self.behaviour.departs(Departure::MultipleEchoesBytes)
            && let Some(quantity) = answer.last_mut()
        {
            *quantity = byte_count;
        }
        answer
    }

    /// Start, quantity, byte count, values.
    fn read_write_request(&self, data: &[u8], most: u16) -> Result<Vec<(u16, u16)>, Exception> {
        let Some((&[start_high, start_low, high, low, byte_count], bytes)) =
            data.split_first_chunk::<5>()
        else {
            return Err(Exception::IllegalDataValue);
        };
        let start = u16::from_be_bytes([start_high, start_low]);
        let quantity = u16::from_be_bytes([high, low]);
        let counts = u16::from(byte_count) == quantity.saturating_mul(2)
            && bytes.len() == usize::from(byte_count);
        let extent = self.extent(start, quantity, most)?;
        if !counts && !self.behaviour.byte_count_unchecked {
            return Err(Exception::IllegalDataValue);
        }
        let (pairs, _) = bytes.as_chunks::<2>();
        let values = pairs.iter().map(|pair| u16::from_be_bytes(*pair));
        Ok(extent.addresses().zip(values).collect())
    }

    fn write_all(&mut self, values: &[(u16, u16)]) -> Result<(), Exception> {
        let mut checked = Ok(());
        let mut allowed = Vec::new();
        for (register, value) in values {
            match self.check_write(*register, *value) {
                Ok(true) => allowed.push((*register, *value)),
                Ok(false) => {}
                Err(exception) => {
                    checked = Err(exception);
                    break;
                }
            }
        }
        if checked.is_err() && !self.behaviour.writes_until_refused {
            return checked;
        }
        for (register, value) in allowed.into_iter().take(self.behaviour.most_written) {
            self.registers.write(register, value);
        }
        checked
    }

    /// Register, AND mask, OR mask; answered by the same.
    pub(super) fn mask_write(&mut self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        let &[register_high, register_low, ref masks @ ..] = data else {
            return Err(Exception::IllegalDataValue);
        };
        let [and_mask, or_mask] = two_words(masks)?;
        let register = u16::from_be_bytes([register_high, register_low]);
        let present = self.registers.read(register, self.behaviour)?;
        let value = match self.behaviour.masks_simply_joined {
            true => present & and_mask | or_mask,
            false => present & and_mask | or_mask & !and_mask,
        };
        let is_lost = self.behaviour.departs(Departure::MaskLost) && and_mask != 0;
        if self.check_write(register, value)? && !is_lost {
            self.registers.write(register, value);
        }
        Ok(data.to_vec())
    }

    /// What is read and what is written, as 03h and 10h have it; writes first.
    pub(super) fn read_write(&mut self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        let Some((read, write)) = data.split_first_chunk::<4>() else {
            return Err(Exception::IllegalDataValue);
        };
        let [start, quantity] = two_words(read)?;
        let values = self.read_write_request(write, MOST_WRITTEN_WITH_READ)?;
        let extent = self.extent(start, quantity, MOST_READ)?;
        let before = self.words(extent, Self::holding)?;
        match self.write_all(&values) {
            Err(_) if self.behaviour.departs(Departure::ReadsThoughRefused) => {}
            written => written?,
        }
        Ok(counted(match self.behaviour.reads_before_writes {
            true => before,
            false => self.words(extent, Self::holding)?,
        }))
    }
}
