//! Frames as a raw CAN socket has them.

use fieldproof_can::{ExtendedId, Frame, Id, StandardId};

use crate::BusError;

/// The length of a classic frame, in bytes; a CAN FD frame is longer.
pub(super) const FRAME_LENGTH: usize = 16;

const EXTENDED: u32 = 1 << 31;
const REMOTE: u32 = 1 << 30;
const ERROR: u32 = 1 << 29;

/// What such a frame is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RawFrame {
    Frame(Frame),
    Error(BusError),
    Other,
}

/// Reads a frame (`linux/can.h`):
///
/// | bytes | what |
/// | --- | --- |
/// | 0..4 | identifier with flags, in the order of the machine: bit 31 extended, bit 30 remote, bit 29 error |
/// | 4 | length, `0..=8` |
/// | 5..8 | reserved |
/// | 8..16 | data |
pub(super) fn decode(bytes: &[u8; FRAME_LENGTH]) -> RawFrame {
    let [a, b, c, d, len, _, _, _, data @ ..] = *bytes;
    let flagged = u32::from_ne_bytes([a, b, c, d]);
    if flagged & ERROR != 0 {
        return RawFrame::Error(BusError::new((flagged & 0xFFFF) as u16, data));
    }
    let id = match flagged & EXTENDED != 0 {
        true => ExtendedId::new(flagged & ExtendedId::MAX.raw()).map(Id::from),
        false => StandardId::new((flagged & u32::from(StandardId::MAX.raw())) as u16).map(Id::from),
    };
    let frame = id.and_then(|id| match flagged & REMOTE != 0 {
        true => Frame::remote(id, len),
        false => Frame::data(id, data.get(..usize::from(len))?),
    });
    frame.map_or(RawFrame::Other, RawFrame::Frame)
}

/// Writes a frame; see [`decode`].
pub(super) fn encode(frame: &Frame) -> [u8; FRAME_LENGTH] {
    let mut flagged = frame.id().raw();
    if frame.id().is_extended() {
        flagged |= EXTENDED;
    }
    if frame.is_remote() {
        flagged |= REMOTE;
    }
    let mut bytes = [0; FRAME_LENGTH];
    bytes[..4].copy_from_slice(&flagged.to_ne_bytes());
    bytes[4] = frame.len() as u8;
    bytes[8..8 + frame.bytes().len()].copy_from_slice(frame.bytes());
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with_id(flagged: u32, rest: [u8; 12]) -> [u8; FRAME_LENGTH] {
        let mut bytes = [0; FRAME_LENGTH];
        bytes[..4].copy_from_slice(&flagged.to_ne_bytes());
        bytes[4..].copy_from_slice(&rest);
        bytes
    }

    #[test]
    fn frames_of_every_kind_are_read_and_written() {
        let cases = [
            (
                0x601,
                [3, 0, 0, 0, 0x40, 0x18, 0x10, 0, 0, 0, 0, 0],
                "601#401810",
            ),
            (0x8000_0601, [0; 12], "00000601#"),
            (0x4000_0701, [1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0], "701#R1"),
        ];
        for (flagged, rest, shown) in cases {
            let bytes = with_id(flagged, rest);
            let RawFrame::Frame(frame) = decode(&bytes) else {
                panic!("{shown} is no frame");
            };
            assert_eq!(frame.to_string(), shown);
            assert_eq!(encode(&frame), bytes, "{shown}");
        }
    }

    #[test]
    fn an_error_frame_is_told_apart() {
        let bytes = with_id(0x2000_0040, [8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(decode(&bytes), RawFrame::Error(BusError::new(0x40, [0; 8])));
    }

    #[test]
    fn a_length_that_no_classic_frame_has_is_no_frame() {
        let bytes = with_id(0x123, [12, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
        assert_eq!(decode(&bytes), RawFrame::Other);
    }
}
