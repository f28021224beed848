//! Coils are read before a case and switched back after it: on a real device they may be outputs.

use fieldproof_suite::model::Span;

use crate::modbus::show_bytes;
use crate::restore::not_put_back;
use crate::stop::Stop;
use crate::tester::Tester;

const READ_COILS: u8 = 0x01;
const WRITE_SINGLE_COIL: u8 = 0x05;
const WRITE_MULTIPLE_COILS: u8 = 0x0F;

impl Tester<'_> {
    /// How coils stand, the first in the lowest bit of the first byte, if they can be read.
    pub(crate) fn coils_before(&mut self, span: Span) -> Result<Option<Vec<u8>>, Stop> {
        let Some(answer) = self.read_row(READ_COILS, span.first, span.count)? else {
            return Ok(None);
        };
        let length = usize::from(span.count).div_ceil(8);
        Ok(match answer.pdu.split_first_chunk::<2>() {
            Some(([READ_COILS, count], bytes))
                if usize::from(*count) == length && bytes.len() == length =>
            {
                Some(bytes.to_vec())
            }
            _ => None,
        })
    }

    pub(crate) fn switch_coils_back(&mut self, span: Span, bytes: &[u8]) -> Result<(), Stop> {
        if self.coils_before(span)?.as_deref() == Some(bytes) {
            return Ok(());
        }
        let Some(address) = self.address else {
            return Ok(());
        };
        let request = switching(span, bytes);
        self.modbus_exchange(address, &request, self.device.timing.modbus_response)?;
        match self.coils_before(span)? {
            Some(present) if present == bytes => Ok(()),
            present => Err(not_put_back(
                &format!("coil {:04X}h", span.first),
                &show_bytes(bytes),
                &present.map_or_else(|| "no value".to_owned(), |present| show_bytes(&present)),
            )),
        }
    }
}

/// The request that makes coils stand so. One alone is switched by the function that is for one.
fn switching(span: Span, bytes: &[u8]) -> Vec<u8> {
    let mut pdu = Vec::with_capacity(bytes.len() + 6);
    match (span.count, bytes) {
        (1, [bit, ..]) => {
            pdu.push(WRITE_SINGLE_COIL);
            pdu.extend(span.first.to_be_bytes());
            pdu.extend(if bit & 1 != 0 { [0xFF, 0x00] } else { [0, 0] });
        }
        _ => {
            pdu.push(WRITE_MULTIPLE_COILS);
            pdu.extend(span.first.to_be_bytes());
            pdu.extend(span.count.to_be_bytes());
            // What was read fitted a frame.
            pdu.push(bytes.len() as u8);
            pdu.extend_from_slice(bytes);
        }
    }
    pdu
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_coil_and_many() {
        let span = |first, count| Span { first, count };
        assert_eq!(switching(span(0x00AC, 1), &[1]), [0x05, 0, 0xAC, 0xFF, 0]);
        assert_eq!(switching(span(0x00AC, 1), &[0]), [0x05, 0, 0xAC, 0, 0]);
        let ten = [0x0F, 0, 0x13, 0, 10, 2, 0xCD, 0x01];
        assert_eq!(switching(span(0x13, 10), &[0xCD, 0x01]), ten);
    }
}
