//! What SDO carries.

use std::fmt;

use super::RawSdo;

/// Between `LEAST` and `MOST` bytes.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct Data<const LEAST: usize, const MOST: usize> {
    bytes: [u8; MOST],
    len: u8,
}

/// The value of an expedited transfer whose size is given: 1 to 4 bytes.
pub type Expedited = Data<1, 4>;

/// The data of a segment: 0 to 7 bytes.
pub type SegmentData = Data<0, 7>;

impl<const LEAST: usize, const MOST: usize> Data<LEAST, MOST> {
    /// These bytes; `None` if there are too few or too many.
    pub fn new(bytes: &[u8]) -> Option<Self> {
        if bytes.len() < LEAST {
            return None;
        }
        let mut filled = [0; MOST];
        filled.get_mut(..bytes.len())?.copy_from_slice(bytes);
        Some(Data {
            bytes: filled,
            len: bytes.len() as u8,
        })
    }

    /// The bytes.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes[..usize::from(self.len)]
    }

    /// All of `bytes` but the last `unused`, of which there are at most `MOST - LEAST`.
    pub(super) fn without_last(bytes: [u8; MOST], unused: u8) -> Self {
        let len = (MOST - usize::from(unused).min(MOST - LEAST)) as u8;
        let mut data = Data { bytes, len };
        data.bytes[usize::from(len)..].fill(0);
        data
    }

    /// The bytes, filled up with zeros.
    pub(super) fn filled(&self) -> [u8; MOST] {
        self.bytes
    }

    /// How many bytes are filled up.
    pub(super) fn unused(&self) -> u8 {
        MOST as u8 - self.len
    }
}

impl<const LEAST: usize, const MOST: usize> fmt::Debug for Data<LEAST, MOST> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:02X?}", self.bytes())
    }
}

/// How an initiated transfer goes on.
///
/// | bits 3..2 of byte 0 | bit 1 | bit 0 | |
/// | --- | --- | --- | --- |
/// | unused bytes | 1 | 1 | [`Transfer::Expedited`] |
/// | 0 | 1 | 0 | [`Transfer::ExpeditedUnsized`] |
/// | 0 | 0 | 1 | [`Transfer::Segmented`], bytes 4..=7 are the size |
/// | 0 | 0 | 0 | [`Transfer::Segmented`], no size |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Transfer {
    /// The value is in this message.
    Expedited(Expedited),
    /// The value is in this message; how many of the four bytes it takes is not said.
    ExpeditedUnsized([u8; 4]),
    /// The value follows in segments.
    Segmented {
        /// How many bytes will follow, if said.
        size: Option<u32>,
    },
}

impl Transfer {
    pub(super) fn parse(raw: RawSdo) -> Transfer {
        let (expedited, sized) = (raw.flag(1), raw.flag(0));
        match (expedited, sized) {
            (true, true) => {
                let unused = raw.command() >> 2 & 3;
                Transfer::Expedited(Data::without_last(raw.data(), unused))
            }
            (true, false) => Transfer::ExpeditedUnsized(raw.data()),
            (false, true) => Transfer::Segmented {
                size: Some(raw.number()),
            },
            (false, false) => Transfer::Segmented { size: None },
        }
    }

    /// The low bits of byte 0, and bytes 4 to 7.
    pub(super) fn encode(&self) -> (u8, [u8; 4]) {
        match self {
            Transfer::Expedited(value) => (value.unused() << 2 | 0b11, value.filled()),
            Transfer::ExpeditedUnsized(bytes) => (0b10, *bytes),
            Transfer::Segmented { size: Some(size) } => (0b01, size.to_le_bytes()),
            Transfer::Segmented { size: None } => (0b00, [0; 4]),
        }
    }
}

/// A segment of a segmented transfer.
///
/// | byte 0 | |
/// | --- | --- |
/// | bit 4 | toggle |
/// | bits 3..1 | unused bytes at the end |
/// | bit 0 | the last segment |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Segment {
    /// Changes with every segment; clear in the first.
    pub toggle: bool,
    /// Whether no segment follows.
    pub last: bool,
    /// Its data.
    pub data: SegmentData,
}

impl Segment {
    pub(super) fn parse(raw: RawSdo) -> Segment {
        Segment {
            toggle: raw.flag(4),
            last: raw.flag(0),
            data: Data::without_last(raw.segment(), raw.command() >> 1 & 7),
        }
    }

    pub(super) fn encode(&self) -> RawSdo {
        let command = toggle_bit(self.toggle) | self.data.unused() << 1 | u8::from(self.last);
        let [a, b, c, d, e, f, g] = self.data.filled();
        RawSdo([command, a, b, c, d, e, f, g])
    }
}

/// Bit 4 of byte 0.
pub(super) const fn toggle_bit(toggle: bool) -> u8 {
    (toggle as u8) << 4
}
