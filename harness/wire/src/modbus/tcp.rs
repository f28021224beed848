//! The ADU of Modbus TCP: the MBAP header and the PDU.
//!
//! | byte | content |
//! | --- | --- |
//! | 0, 1 | transaction, repeated in the answer |
//! | 2, 3 | protocol, 0 |
//! | 4, 5 | how many bytes follow: unit and PDU, 2 to 254 |
//! | 6 | unit |
//! | 7.. | PDU, 1 to 253 bytes |

use super::pdu::MAX_PDU_LEN;
use crate::violation::plural;
use crate::{Rule, Violation};

/// Bytes of the header, the unit among them.
pub const HEADER_LEN: usize = 7;

/// The longest ADU, in bytes.
pub const MAX_ADU_LEN: usize = HEADER_LEN + MAX_PDU_LEN;

/// Any bytes, as an ADU.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RawTcp<'a>(
    /// The bytes.
    pub &'a [u8],
);

impl<'a> RawTcp<'a> {
    /// The transaction.
    pub fn transaction(&self) -> Option<u16> {
        self.number(0)
    }

    /// The protocol.
    pub fn protocol(&self) -> Option<u16> {
        self.number(2)
    }

    /// How many bytes the header says follow its first six.
    pub fn length(&self) -> Option<u16> {
        self.number(4)
    }

    /// The unit.
    pub fn unit(&self) -> Option<u8> {
        self.0.get(6).copied()
    }

    /// What follows the header.
    pub fn pdu(&self) -> Option<&'a [u8]> {
        self.0.get(HEADER_LEN..)
    }

    /// How long the whole ADU is by its header: where the next one starts in a stream.
    pub fn claimed_len(&self) -> Option<usize> {
        self.length().map(|length| 6 + usize::from(length))
    }

    fn number(&self, at: usize) -> Option<u16> {
        let (number, _) = self.0.get(at..)?.split_first_chunk()?;
        Some(u16::from_be_bytes(*number))
    }
}

/// A well-formed ADU.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TcpAdu<'a> {
    transaction: u16,
    unit: u8,
    pdu: &'a [u8],
}

impl<'a> TcpAdu<'a> {
    /// An ADU; `None` unless `pdu` has 1 to 253 bytes.
    pub fn new(transaction: u16, unit: u8, pdu: &'a [u8]) -> Option<TcpAdu<'a>> {
        (1..=MAX_PDU_LEN).contains(&pdu.len()).then_some(TcpAdu {
            transaction,
            unit,
            pdu,
        })
    }

    /// The transaction.
    pub fn transaction(&self) -> u16 {
        self.transaction
    }

    /// The unit.
    pub fn unit(&self) -> u8 {
        self.unit
    }

    /// The PDU.
    pub fn pdu(&self) -> &'a [u8] {
        self.pdu
    }

    /// The bytes.
    pub fn encode(&self) -> Vec<u8> {
        let [high, low] = self.transaction.to_be_bytes();
        let [length_high, length_low] = (self.pdu.len() as u16 + 1).to_be_bytes();
        let mut bytes = vec![high, low, 0, 0, length_high, length_low, self.unit];
        bytes.extend(self.pdu);
        bytes
    }

    /// Checks the header.
    ///
    /// # Errors
    /// [`Violation`]: not 8 to 260 bytes, another protocol than 0, a length that is not that of what follows.
    pub fn parse(bytes: &'a [u8]) -> Result<TcpAdu<'a>, Violation> {
        let wrong_length = || {
            Violation::new(
                Rule::Length,
                bytes.len().min(MAX_ADU_LEN),
                plural(bytes.len(), "byte"),
                format!("{} to {MAX_ADU_LEN} bytes", HEADER_LEN + 1),
            )
        };
        let (header, pdu) = bytes
            .split_first_chunk::<HEADER_LEN>()
            .ok_or_else(wrong_length)?;
        let [t_high, t_low, p_high, p_low, l_high, l_low, unit] = *header;
        let transaction = u16::from_be_bytes([t_high, t_low]);
        let adu = TcpAdu::new(transaction, unit, pdu).ok_or_else(wrong_length)?;
        let protocol = u16::from_be_bytes([p_high, p_low]);
        if protocol != 0 {
            let found = format!("protocol {protocol}");
            return Err(Violation::new(Rule::Range, 2, found, "protocol 0"));
        }
        let length = usize::from(u16::from_be_bytes([l_high, l_low]));
        if length != pdu.len() + 1 {
            return Err(Violation::new(
                Rule::Count,
                4,
                length.to_string(),
                (pdu.len() + 1).to_string(),
            ));
        }
        Ok(adu)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const REQUEST: [u8; 12] = [0x15, 0x01, 0, 0, 0, 6, 0xFF, 0x04, 0, 0, 0, 1];

    #[test]
    fn an_adu_is_these_bytes() {
        let adu = TcpAdu::parse(&REQUEST).unwrap();
        assert_eq!(adu.transaction(), 0x1501);
        assert_eq!(adu.unit(), 0xFF);
        assert_eq!(adu.pdu(), [0x04, 0, 0, 0, 1]);
        assert_eq!(adu.encode(), REQUEST);
        let raw = RawTcp(&REQUEST[..7]);
        assert_eq!(raw.claimed_len(), Some(12));
        assert_eq!(raw.protocol(), Some(0));
        assert_eq!(raw.pdu(), Some(&[][..]));
        assert_eq!(RawTcp(&REQUEST[..5]).length(), None);
    }

    #[test]
    fn what_is_not_an_adu_says_why() {
        let with = |at: usize, byte: u8| {
            let mut bytes = REQUEST;
            bytes[at] = byte;
            bytes
        };
        let cases: [(&[u8], &str); 4] = [
            (
                &REQUEST[..7],
                "length: found 7 bytes, expected 8 to 260 bytes",
            ),
            (
                &[0; 261],
                "length: found 261 bytes, expected 8 to 260 bytes",
            ),
            (
                &with(3, 1),
                "range: found protocol 1 at byte 2, expected protocol 0",
            ),
            (&with(5, 7), "byte count: found 7 at byte 4, expected 6"),
        ];
        for (bytes, message) in cases {
            assert_eq!(TcpAdu::parse(bytes).unwrap_err().to_string(), message);
        }
    }

    proptest! {
        #[test]
        fn any_adu_is_read_as_it_was_written(
            transaction: u16,
            unit: u8,
            pdu in proptest::collection::vec(any::<u8>(), 1..=253),
        ) {
            let adu = TcpAdu::new(transaction, unit, &pdu).unwrap();
            let bytes = adu.encode();
            prop_assert_eq!(TcpAdu::parse(&bytes), Ok(adu));
        }

        #[test]
        fn any_bytes_are_written_as_they_were_read(bytes in proptest::collection::vec(0u8..8, 0..16)) {
            if let Ok(adu) = TcpAdu::parse(&bytes) {
                prop_assert_eq!(adu.encode(), bytes);
            }
        }
    }
}
