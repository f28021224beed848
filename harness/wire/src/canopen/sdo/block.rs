//! What only the block protocol has.

use super::RawSdo;
use crate::{Rule, Violation};

bounded! {
    /// How many segments a block has at most, `1..=127`.
    pub struct BlockSize(u8) in 1..=127
}

bounded! {
    /// The number of a segment in its block, `1..=127`.
    pub struct SegmentNumber(u8) in 1..=127
}

bounded! {
    /// How many bytes at the end of the last segment are not data, `0..=7`.
    pub struct UnusedBytes(u8) in 0..=7
}

/// A segment of a block. How many of its bytes are data is only said when the transfer ends.
///
/// | byte | content |
/// | --- | --- |
/// | 0 | bit 7: the last segment of the transfer; bits 6..0: number |
/// | 1..=7 | data |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct BlockSegment {
    /// Whether it is the last of the transfer.
    pub last: bool,
    /// Its number in the block, counted from 1.
    pub number: SegmentNumber,
    /// Its data.
    pub data: [u8; 7],
}

impl BlockSegment {
    /// The 8 bytes.
    pub fn encode(&self) -> [u8; 8] {
        let [a, b, c, d, e, f, g] = self.data;
        let command = u8::from(self.last) << 7 | self.number.raw();
        [command, a, b, c, d, e, f, g]
    }

    /// Reads 8 bytes in the middle of a block.
    ///
    /// # Errors
    /// [`Violation`]: another length, or number 0 (80h in byte 0 is an abort).
    pub fn parse(data: &[u8]) -> Result<BlockSegment, Violation> {
        let raw = RawSdo::from_slice(data)?;
        let number = SegmentNumber::new(raw.command() & 0x7F).ok_or_else(|| {
            Violation::byte(
                Rule::Range,
                0,
                raw.command(),
                "a segment number from 1 to 127",
            )
        })?;
        Ok(BlockSegment {
            last: raw.flag(7),
            number,
            data: raw.segment(),
        })
    }
}

/// The number of the last segment received in order, 0 if none was.
pub(super) fn parse_acknowledged(raw: RawSdo) -> Result<Option<SegmentNumber>, Violation> {
    match raw.0[1] {
        0 => Ok(None),
        number => SegmentNumber::new(number)
            .map(Some)
            .ok_or_else(|| Violation::range(1, u64::from(number), 0, 127)),
    }
}

/// An acknowledge of a block: command, number, block size.
pub(super) fn acknowledge(
    command: u8,
    acknowledged: Option<SegmentNumber>,
    block_size: BlockSize,
) -> RawSdo {
    let number = acknowledged.map_or(0, SegmentNumber::raw);
    RawSdo([command, number, block_size.raw(), 0, 0, 0, 0, 0])
}

/// The end of a block transfer: command with the unused bytes in bits 4..2, CRC.
pub(super) fn end(command: u8, unused: UnusedBytes, crc: u16) -> RawSdo {
    let [low, high] = crc.to_le_bytes();
    RawSdo([command | unused.raw() << 2, low, high, 0, 0, 0, 0, 0])
}

/// The unused bytes and the CRC of an end of a block transfer.
pub(super) fn parse_end(raw: RawSdo) -> Result<(UnusedBytes, u16), Violation> {
    let unused = UnusedBytes::parse(raw.command() >> 2 & 7, 0)?;
    Ok((unused, raw.index()))
}

/// The size of a block transfer, if bit 1 of byte 0 says that it is given.
pub(super) fn parse_size(raw: RawSdo) -> Option<u32> {
    raw.flag(1).then(|| raw.number())
}

/// Bits 2 (CRC supported) and 1 (size given) of byte 0, and bytes 4 to 7.
pub(super) fn crc_and_size(crc: bool, size: Option<u32>) -> (u8, [u8; 4]) {
    let flags = u8::from(crc) << 2 | u8::from(size.is_some()) << 1;
    (flags, size.unwrap_or(0).to_le_bytes())
}

/// The CRC of a block transfer over its whole value: polynomial x^16 + x^12 + x^5 + 1, beginning with 0, most
/// significant bit first.
pub fn block_crc(value: &[u8]) -> u16 {
    let mut crc = 0_u16;
    for byte in value {
        crc ^= u16::from(*byte) << 8;
        for _ in 0..8 {
            let polynomial = if crc & 0x8000 == 0 { 0 } else { 0x1021 };
            crc = crc << 1 ^ polynomial;
        }
    }
    crc
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_segment_is_these_bytes() {
        let bytes = [0x83, 0x4A, 0x4E, 0x35, 0x2D, 0x43, 0x4D, 0x2D];
        let segment = BlockSegment {
            last: true,
            number: SegmentNumber::new(3).unwrap(),
            data: *b"JN5-CM-",
        };
        assert_eq!(BlockSegment::parse(&bytes), Ok(segment));
        assert_eq!(segment.encode(), bytes);
    }

    #[test]
    fn number_zero_is_none() {
        let violation = BlockSegment::parse(&[0x80, 0, 0, 0, 0, 0, 0, 0]).unwrap_err();
        assert_eq!(
            violation.to_string(),
            "range: found 80h at byte 0, expected a segment number from 1 to 127"
        );
    }

    #[test]
    fn the_crc_has_its_check_value() {
        assert_eq!(block_crc(b"123456789"), 0x31C3);
        assert_eq!(block_crc(b""), 0);
    }

    proptest! {
        #[test]
        fn any_segment_is_written_as_it_was_read(data in proptest::collection::vec(any::<u8>(), 0..10)) {
            if let Ok(segment) = BlockSegment::parse(&data) {
                prop_assert_eq!(segment.encode().to_vec(), data);
            }
        }
    }
}
