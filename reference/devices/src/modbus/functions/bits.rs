//! 01h, 02h, 05h, 0Fh: coils and discrete inputs.

use super::{Service, counted, two_words};
use crate::modbus::{Departure, Exception, Registers};

/// Most bits of one 01h or 02h.
const MOST_READ: u16 = 2_000;
/// Most coils of one 0Fh.
const MOST_WRITTEN: u16 = 1_968;
const ON: u16 = 0xFF00;
const OFF: u16 = 0x0000;

impl<R: Registers> Service<'_, R> {
    /// Start and quantity; answered by a byte count and the coils, eight a byte, the first in the lowest bit.
    pub(super) fn read_coils(&self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        self.read_bits(data, |registers, coil| registers.read_coil(coil))
    }

    /// The same of discrete inputs.
    pub(super) fn read_discrete_inputs(&self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        if self.behaviour.tables_mixed {
            return self.read_coils(data);
        }
        self.read_bits(data, |registers, input| {
            registers.read_discrete_input(input)
        })
    }

    fn read_bits(
        &self,
        data: &[u8],
        read: fn(&R, u16) -> Result<bool, Exception>,
    ) -> Result<Vec<u8>, Exception> {
        let [start, quantity] = two_words(data)?;
        let extent = self.extent(start, quantity, MOST_READ)?;
        let mut bits = Vec::new();
        for address in extent.addresses() {
            bits.push(match read(self.registers, address) {
                Err(Exception::IllegalDataAddress) if self.behaviour.holes_answered => false,
                bit => bit?,
            });
        }
        let padding = self.behaviour.padding_bits_set;
        let bytes = bits.chunks(8).map(|eight| {
            let bit_of = |place: usize| eight.get(place).copied().unwrap_or(padding);
            (0..8).fold(0, |byte: u8, place| {
                let shift = match self.behaviour.bit_order_reversed {
                    true => 7 - place,
                    false => place,
                };
                byte | u8::from(bit_of(place)) << shift
            })
        });
        Ok(counted(bytes.collect()))
    }

    /// Coil and FF00h or 0000h; answered by the same.
    pub(super) fn write_coil(&mut self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        let [coil, value] = two_words(data)?;
        let known = matches!(value, ON | OFF) || self.behaviour.coil_value_unchecked;
        if !known {
            return Err(Exception::IllegalDataValue);
        }
        self.registers.read_coil(coil)?;
        if !self.behaviour.departs(Departure::CoilNotWritten) {
            self.registers.write_coil(coil, value != OFF);
        }
        Ok(data.to_vec())
    }

    /// Start, quantity, byte count, coils; answered by start and quantity. Writes all or none.
    pub(super) fn write_coils(&mut self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        let Some((&[start_high, start_low, high, low, byte_count], bytes)) =
            data.split_first_chunk::<5>()
        else {
            return Err(Exception::IllegalDataValue);
        };
        let start = u16::from_be_bytes([start_high, start_low]);
        let quantity = u16::from_be_bytes([high, low]);
        let counts =
            usize::from(byte_count) == bytes.len() && u16::from(byte_count) == quantity.div_ceil(8);
        let extent = self.extent(start, quantity, MOST_WRITTEN)?;
        if !counts && !self.behaviour.byte_count_unchecked {
            return Err(Exception::IllegalDataValue);
        }
        for coil in extent.addresses() {
            self.registers.read_coil(coil)?;
        }
        let bits = bytes
            .iter()
            .flat_map(|byte| (0..8).map(move |place| byte >> place & 1 == 1));
        let written = extent.addresses().zip(bits);
        for (coil, on) in written.take(self.behaviour.most_written) {
            self.registers.write_coil(coil, on);
        }
        Ok(self.written(&data[..4], byte_count))
    }
}
