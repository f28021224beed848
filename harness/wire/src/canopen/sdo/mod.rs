//! SDO: the 8 bytes of a request and of a response, in the expedited, the segmented and the block protocol.
//!
//! | byte | initiate | segment | block segment |
//! | --- | --- | --- | --- |
//! | 0 | command | command | sequence number |
//! | 1..=2 | index, low byte first | data | data |
//! | 3 | sub-index | data | data |
//! | 4..=7 | data, size or abort code | data | data |
//!
//! The upper three bits of the command say which service it is: [`Request`] and [`Response`] list them. Which of the
//! two protocols is running cannot be seen in a frame, so a block segment is a type of its own: [`BlockSegment`].
//!
//! `parse` passes over what a receiver passes over, the reserved bits and bytes; `check_reserved` looks at them.

mod block;
mod data;
mod request;
mod response;

pub use block::{BlockSegment, BlockSize, SegmentNumber, UnusedBytes, block_crc};
pub use data::{Data, Expedited, Segment, SegmentData, Transfer};
pub use request::Request;
pub use response::Response;

use super::Multiplexer;
use crate::Violation;
use crate::violation::exactly;

/// Any 8 bytes, as SDO sees them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct RawSdo(
    /// The bytes.
    pub [u8; 8],
);

impl RawSdo {
    /// The 8 bytes of `data`.
    ///
    /// # Errors
    /// [`Violation`]: another length.
    pub fn from_slice(data: &[u8]) -> Result<RawSdo, Violation> {
        exactly(data).map(RawSdo)
    }

    /// Byte 0.
    pub const fn command(&self) -> u8 {
        self.0[0]
    }

    /// Bits 7..5 of byte 0, right-aligned: which service it is.
    pub const fn specifier(&self) -> u8 {
        self.0[0] >> 5
    }

    /// Bytes 1 and 2.
    pub const fn index(&self) -> u16 {
        u16::from_le_bytes([self.0[1], self.0[2]])
    }

    /// Byte 3.
    pub const fn sub(&self) -> u8 {
        self.0[3]
    }

    /// Bytes 1 to 3.
    pub const fn multiplexer(&self) -> Multiplexer {
        Multiplexer::new(self.index(), self.sub())
    }

    /// Bytes 4 to 7.
    pub const fn data(&self) -> [u8; 4] {
        let [_, _, _, _, data @ ..] = self.0;
        data
    }

    /// Bytes 4 to 7 as a number: a size or an abort code.
    pub const fn number(&self) -> u32 {
        u32::from_le_bytes(self.data())
    }

    /// Bytes 1 to 7: the data of a segment.
    pub const fn segment(&self) -> [u8; 7] {
        let [_, segment @ ..] = self.0;
        segment
    }

    /// Whether bit `bit` of byte 0 is set.
    const fn flag(&self, bit: u8) -> bool {
        self.0[0] >> bit & 1 == 1
    }

    /// A message with a command, a multiplexer and four bytes.
    const fn with_object(command: u8, object: Multiplexer, data: [u8; 4]) -> RawSdo {
        let [low, high] = object.index.to_le_bytes();
        let [a, b, c, d] = data;
        RawSdo([command, low, high, object.sub, a, b, c, d])
    }

    /// A message with a command and nothing else.
    const fn bare(command: u8) -> RawSdo {
        RawSdo([command, 0, 0, 0, 0, 0, 0, 0])
    }
}

/// The command of an abort, in both directions.
const ABORT: u8 = 0x80;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_field_has_its_place() {
        let raw = RawSdo([0x43, 0x63, 0x60, 0x01, 0x13, 0xD1, 0xFF, 0xFF]);
        assert_eq!(raw.command(), 0x43);
        assert_eq!(raw.specifier(), 2);
        assert_eq!(raw.index(), 0x6063);
        assert_eq!(raw.sub(), 1);
        assert_eq!(raw.data(), [0x13, 0xD1, 0xFF, 0xFF]);
        assert_eq!(raw.number() as i32, -12013);
        assert_eq!(raw.multiplexer().to_string(), "6063h:01");
        assert!(RawSdo::from_slice(&[0; 7]).is_err());
    }
}
