//! The ADU of a serial line: address, PDU, CRC.
//!
//! | byte | content |
//! | --- | --- |
//! | 0 | address of the server: 0 all, 1 to 247 one, 248 to 255 reserved |
//! | 1.. | PDU, 1 to 253 bytes |
//! | the last two | CRC-16 of all before it, low byte first |

use super::crc::{crc16, crc16_bytes};
use super::pdu::MAX_PDU_LEN;
use crate::violation::plural;
use crate::{Rule, Violation};

/// The shortest ADU, in bytes.
pub const MIN_ADU_LEN: usize = 4;

/// The longest ADU, in bytes.
pub const MAX_ADU_LEN: usize = MAX_PDU_LEN + 3;

/// The address that all servers listen to and none answers.
pub const BROADCAST: u8 = 0;

/// Any bytes, as an ADU.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RawRtu<'a>(
    /// The bytes.
    pub &'a [u8],
);

impl<'a> RawRtu<'a> {
    /// The address, if there is a byte.
    pub fn address(&self) -> Option<u8> {
        self.0.first().copied()
    }

    /// What stands between address and CRC, if there is room for both.
    pub fn pdu(&self) -> Option<&'a [u8]> {
        let end = self.0.len().checked_sub(2)?;
        self.0.get(1..end)
    }

    /// The CRC that the bytes carry: their last two.
    pub fn crc(&self) -> Option<u16> {
        let (_, crc) = self.0.split_last_chunk()?;
        Some(u16::from_le_bytes(*crc))
    }

    /// The CRC that they should carry.
    pub fn expected_crc(&self) -> Option<u16> {
        let (covered, _) = self.0.split_last_chunk::<2>()?;
        Some(crc16(covered))
    }
}

/// A well-formed ADU. Addresses from 248 on are let pass: devices use them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RtuAdu<'a> {
    address: u8,
    pdu: &'a [u8],
}

impl<'a> RtuAdu<'a> {
    /// An ADU; `None` unless `pdu` has 1 to 253 bytes.
    pub fn new(address: u8, pdu: &'a [u8]) -> Option<RtuAdu<'a>> {
        (1..=MAX_PDU_LEN)
            .contains(&pdu.len())
            .then_some(RtuAdu { address, pdu })
    }

    /// The address.
    pub fn address(&self) -> u8 {
        self.address
    }

    /// The PDU.
    pub fn pdu(&self) -> &'a [u8] {
        self.pdu
    }

    /// The bytes, CRC included.
    pub fn encode(&self) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(self.pdu.len() + 3);
        bytes.push(self.address);
        bytes.extend(self.pdu);
        bytes.extend(crc16_bytes(&bytes));
        bytes
    }

    /// Checks length and CRC.
    ///
    /// # Errors
    /// [`Violation`]: not 4 to 256 bytes, or another CRC.
    pub fn parse(bytes: &'a [u8]) -> Result<RtuAdu<'a>, Violation> {
        if !(MIN_ADU_LEN..=MAX_ADU_LEN).contains(&bytes.len()) {
            return Err(Violation::new(
                Rule::Length,
                bytes.len().min(MAX_ADU_LEN),
                plural(bytes.len(), "byte"),
                format!("{MIN_ADU_LEN} to {MAX_ADU_LEN} bytes"),
            ));
        }
        let (covered, crc) = bytes.split_at(bytes.len() - 2);
        let expected = crc16_bytes(covered);
        if crc != expected {
            return Err(Violation::new(
                Rule::Checksum,
                covered.len(),
                hexadecimal(crc),
                hexadecimal(&expected),
            ));
        }
        Ok(RtuAdu {
            address: covered[0],
            pdu: &covered[1..],
        })
    }
}

/// The bytes in the order of the wire.
fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02X}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const REQUEST: [u8; 8] = [0x02, 0x03, 0x00, 0xD4, 0x00, 0x02, 0x84, 0x00];

    #[test]
    fn an_adu_is_these_bytes() {
        let adu = RtuAdu::parse(&REQUEST).unwrap();
        assert_eq!(adu.address(), 2);
        assert_eq!(adu.pdu(), [0x03, 0x00, 0xD4, 0x00, 0x02]);
        assert_eq!(adu.encode(), REQUEST);
    }

    #[test]
    fn what_is_not_an_adu_says_why() {
        let mut stale = REQUEST;
        stale[5] = 3;
        let cases: [(&[u8], &str); 4] = [
            (&[], "length: found 0 bytes, expected 4 to 256 bytes"),
            (
                &REQUEST[..3],
                "length: found 3 bytes, expected 4 to 256 bytes",
            ),
            (
                &[0; 257],
                "length: found 257 bytes, expected 4 to 256 bytes",
            ),
            (&stale, "checksum: found 8400 at byte 6, expected 45C0"),
        ];
        for (bytes, message) in cases {
            assert_eq!(RtuAdu::parse(bytes).unwrap_err().to_string(), message);
        }
    }

    #[test]
    fn raw_bytes_are_named_as_far_as_they_go() {
        assert_eq!(RawRtu(&[]).address(), None);
        assert_eq!(RawRtu(&[1]).address(), Some(1));
        assert_eq!(RawRtu(&[1]).crc(), None);
        assert_eq!(RawRtu(&[1, 2]).pdu(), None);
        assert_eq!(RawRtu(&[1, 2, 3]).pdu(), Some(&[][..]));
        assert_eq!(RawRtu(&[1, 2, 3]).crc(), Some(0x0302));
        assert_eq!(RawRtu(&REQUEST).crc(), RawRtu(&REQUEST).expected_crc());
    }

    proptest! {
        #[test]
        fn any_adu_is_read_as_it_was_written(address: u8, pdu in proptest::collection::vec(any::<u8>(), 0..300)) {
            match RtuAdu::new(address, &pdu) {
                Some(adu) => {
                    let bytes = adu.encode();
                    prop_assert_eq!(RtuAdu::parse(&bytes), Ok(adu));
                }
                None => prop_assert!(pdu.is_empty() || pdu.len() > MAX_PDU_LEN),
            }
        }

        #[test]
        fn any_bytes_are_written_as_they_were_read(bytes in proptest::collection::vec(any::<u8>(), 0..12)) {
            if let Ok(adu) = RtuAdu::parse(&bytes) {
                prop_assert_eq!(adu.encode(), bytes);
            }
        }

        #[test]
        fn any_single_wrong_bit_is_found(bit in 0..64usize) {
            let mut bytes = REQUEST;
            bytes[bit / 8] ^= 1 << (bit % 8);
            prop_assert_eq!(RtuAdu::parse(&bytes).unwrap_err().rule, Rule::Checksum);
        }
    }
}
