//! Frames and byte strings with wildcards: `581#43636000????????`.

use std::fmt;
use std::str::FromStr;

use crate::notation::{self, NotationError, Payload};
use crate::{Frame, Id};

/// One byte of a pattern: the bits under `mask` must be those of `value`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct MaskedByte {
    value: u8,
    mask: u8,
}

impl MaskedByte {
    /// Requires the bits of `value` under `mask`.
    pub const fn new(value: u8, mask: u8) -> MaskedByte {
        MaskedByte {
            value: value & mask,
            mask,
        }
    }

    /// Requires `value`.
    pub const fn exactly(value: u8) -> MaskedByte {
        MaskedByte::new(value, 0xFF)
    }

    /// The required bits; zero where the mask is.
    pub const fn value(self) -> u8 {
        self.value
    }

    /// Which bits are required.
    pub const fn mask(self) -> u8 {
        self.mask
    }

    /// Whether `byte` has the required bits.
    pub const fn matches(self, byte: u8) -> bool {
        byte & self.mask == self.value
    }

    /// The byte, if every bit is required.
    pub const fn exact(self) -> Option<u8> {
        match self.mask {
            0xFF => Some(self.value),
            _ => None,
        }
    }
}

impl fmt::Display for MaskedByte {
    /// A nibble of which not every bit is required is a `?`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for shift in [4, 0] {
            match self.mask >> shift & 0xF {
                0xF => write!(f, "{:X}", self.value >> shift & 0xF)?,
                _ => write!(f, "?")?,
            }
        }
        Ok(())
    }
}

/// Which frames are meant: the notation of a frame, in which `?` in the data stands for any nibble. Identifier, kind
/// and length are always exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Pattern {
    id: Id,
    remote: bool,
    len: u8,
    /// Bytes at and after `len` require nothing.
    bytes: [MaskedByte; 8],
}

impl Pattern {
    /// The identifier.
    pub fn id(&self) -> Id {
        self.id
    }

    /// Whether remote frames are meant.
    pub fn is_remote(&self) -> bool {
        self.remote
    }

    /// The data length code, `0..=8`.
    pub fn len(&self) -> usize {
        usize::from(self.len)
    }

    /// Whether the data length code is 0.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The data bytes; none for remote frames.
    pub fn bytes(&self) -> &[MaskedByte] {
        if self.remote {
            &[]
        } else {
            &self.bytes[..self.len()]
        }
    }

    /// The same pattern under another identifier.
    pub fn with_id(self, id: impl Into<Id>) -> Pattern {
        Pattern {
            id: id.into(),
            ..self
        }
    }

    /// Whether `frame` is meant.
    pub fn matches(&self, frame: &Frame) -> bool {
        self.id == frame.id()
            && self.remote == frame.is_remote()
            && self.len() == frame.len()
            && self.mismatches(frame).is_empty()
    }

    /// The positions of the data bytes that differ, those that only one of the two has among them. Identifier, kind
    /// and the length that a remote frame asks for are not looked at.
    pub fn mismatches(&self, frame: &Frame) -> Vec<usize> {
        mismatches(self.bytes(), frame.bytes())
    }

    /// The one frame that is meant; `None` if there is a wildcard.
    pub fn exact(&self) -> Option<Frame> {
        if self.remote {
            return Frame::remote(self.id, self.len);
        }
        let mut data = [0; 8];
        for (byte, masked) in data.iter_mut().zip(self.bytes()) {
            *byte = masked.exact()?;
        }
        Frame::data(self.id, &data[..self.len()])
    }
}

impl From<Frame> for Pattern {
    /// Means this frame only.
    fn from(frame: Frame) -> Pattern {
        let mut bytes = [MaskedByte::default(); 8];
        for (masked, byte) in bytes.iter_mut().zip(frame.bytes()) {
            *masked = MaskedByte::exactly(*byte);
        }
        Pattern {
            id: frame.id(),
            remote: frame.is_remote(),
            len: frame.len() as u8,
            bytes,
        }
    }
}

impl FromStr for Pattern {
    type Err = NotationError;

    fn from_str(text: &str) -> Result<Pattern, NotationError> {
        let (id, payload) = notation::read(text)?;
        let mut bytes = [MaskedByte::default(); 8];
        let (remote, len) = match payload {
            Payload::Remote(len) => (true, len),
            Payload::Data(data) => {
                for (masked, read) in bytes.iter_mut().zip(&data) {
                    *masked = *read;
                }
                (false, data.len() as u8)
            }
        };
        Ok(Pattern {
            id,
            remote,
            len,
            bytes,
        })
    }
}

impl fmt::Display for Pattern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}#", self.id)?;
        match (self.remote, self.len) {
            (true, 0) => write!(f, "R"),
            (true, len) => write!(f, "R{len}"),
            (false, _) => self.bytes().iter().try_for_each(|byte| write!(f, "{byte}")),
        }
    }
}

/// Which byte strings are meant: `01 03 ?? 0?`. Spaces or a `.` may stand between bytes.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct BytePattern {
    bytes: Vec<MaskedByte>,
}

impl BytePattern {
    /// The bytes, in order.
    pub fn bytes(&self) -> &[MaskedByte] {
        &self.bytes
    }

    /// How many bytes.
    pub fn len(&self) -> usize {
        self.bytes.len()
    }

    /// Whether the empty string is meant.
    pub fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    /// Whether `bytes` is meant: as long, and every byte as required.
    pub fn matches(&self, bytes: &[u8]) -> bool {
        self.mismatches(bytes).is_empty()
    }

    /// The positions that differ, those that only one of the two has among them.
    pub fn mismatches(&self, bytes: &[u8]) -> Vec<usize> {
        mismatches(&self.bytes, bytes)
    }

    /// The one byte string that is meant; `None` if there is a wildcard.
    pub fn exact(&self) -> Option<Vec<u8>> {
        self.bytes.iter().map(|byte| byte.exact()).collect()
    }
}

impl From<&[u8]> for BytePattern {
    /// Means these bytes only.
    fn from(bytes: &[u8]) -> BytePattern {
        bytes.iter().copied().map(MaskedByte::exactly).collect()
    }
}

impl FromIterator<MaskedByte> for BytePattern {
    fn from_iter<I: IntoIterator<Item = MaskedByte>>(bytes: I) -> BytePattern {
        BytePattern {
            bytes: bytes.into_iter().collect(),
        }
    }
}

impl FromStr for BytePattern {
    type Err = NotationError;

    fn from_str(text: &str) -> Result<BytePattern, NotationError> {
        let characters: Vec<char> = text.chars().collect();
        let mut bytes = Vec::new();
        let mut dot = None;
        let mut at = 0;
        while let Some(&character) = characters.get(at) {
            match character {
                c if c.is_whitespace() => at += 1,
                '.' if dot.is_some() || bytes.is_empty() => {
                    return Err(NotationError::StraySeparator { offset: at });
                }
                '.' => {
                    dot = Some(at);
                    at += 1;
                }
                _ => {
                    bytes.push(notation::read_byte(&characters[at..], at)?);
                    dot = None;
                    at += 2;
                }
            }
        }
        match dot {
            Some(offset) => Err(NotationError::StraySeparator { offset }),
            None => Ok(BytePattern { bytes }),
        }
    }
}

impl fmt::Display for BytePattern {
    /// One space between bytes.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (position, byte) in self.bytes.iter().enumerate() {
            let space = if position == 0 { "" } else { " " };
            write!(f, "{space}{byte}")?;
        }
        Ok(())
    }
}

fn mismatches(expected: &[MaskedByte], found: &[u8]) -> Vec<usize> {
    (0..expected.len().max(found.len()))
        .filter(
            |&position| match (expected.get(position), found.get(position)) {
                (Some(expected), Some(found)) => !expected.matches(*found),
                _ => true,
            },
        )
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::any_frame;
    use proptest::prelude::*;

    fn pattern(text: &str) -> Pattern {
        text.parse().unwrap()
    }

    fn frame(text: &str) -> Frame {
        text.parse().unwrap()
    }

    #[test]
    fn wildcards_match_any_nibble() {
        let any_value = pattern("581#43636000.????????");
        assert!(any_value.matches(&frame("581#4363600013D1FFFF")));
        assert!(any_value.matches(&frame("581#4363600000000000")));
        assert!(!any_value.matches(&frame("581#436360000000")));
        assert!(!any_value.matches(&frame("582#4363600000000000")));
        assert!(!any_value.matches(&frame("00000581#4363600000000000")));
        assert!(pattern("701#?5").matches(&frame("701#85")));
        assert!(!pattern("701#?5").matches(&frame("701#84")));
        assert!(!pattern("701#?5").matches(&frame("701#R1")));
        assert!(pattern("701#R1").matches(&frame("701#R1")));
        assert!(!pattern("701#R1").matches(&frame("701#R")));
    }

    #[test]
    fn mismatches_name_the_positions() {
        let read = pattern("581#4B41600031?2");
        assert_eq!(read.mismatches(&frame("581#4B4160003102")), []);
        assert_eq!(read.mismatches(&frame("581#804160000111")), [0, 4, 5]);
        assert_eq!(read.mismatches(&frame("581#4B41600031020000")), [6, 7]);
        assert_eq!(read.mismatches(&frame("581#4B416000")), [4, 5]);
    }

    #[test]
    fn a_pattern_without_wildcards_is_a_frame() {
        assert_eq!(pattern("080#").exact(), Some(frame("080#")));
        assert_eq!(pattern("701#R1").exact(), Some(frame("701#R1")));
        assert_eq!(pattern("701#0?").exact(), None);
        assert_eq!(pattern("701#0?").to_string(), "701#0?");
        let moved = pattern("601#40????").with_id(Id::standard(0x620).unwrap());
        assert_eq!(moved.to_string(), "620#40????");
    }

    #[test]
    fn byte_patterns_are_read() {
        for text in ["01 03 ?? 0?", "0103??0?", "01.03.??.0?", " 01  03??.0? "] {
            let pattern: BytePattern = text.parse().unwrap();
            assert_eq!(pattern.to_string(), "01 03 ?? 0?", "{text}");
            assert!(pattern.matches(&[1, 3, 0xAA, 0x0F]));
            assert_eq!(pattern.mismatches(&[1, 3, 0xAA, 0x10, 9]), [3, 4]);
            assert_eq!(pattern.exact(), None);
        }
        let exact: BytePattern = "20 03 00 00".parse().unwrap();
        assert_eq!(exact.exact(), Some(vec![0x20, 3, 0, 0]));
        assert_eq!("".parse(), Ok(BytePattern::default()));
    }

    #[test]
    fn what_is_not_a_byte_pattern_is_refused_with_its_place() {
        let cases = [
            ("01 0", "byte of one digit at character 3, expected two"),
            ("0 1", "byte of one digit at character 0, expected two"),
            ("01 0x", "'x' at character 4, expected a hexadecimal digit"),
            (
                "01..02",
                "'.' at character 3, expected it only between two bytes",
            ),
            (
                "01 02.",
                "'.' at character 5, expected it only between two bytes",
            ),
        ];
        for (text, message) in cases {
            let error = text.parse::<BytePattern>().unwrap_err();
            assert_eq!(error.to_string(), message, "{text}");
        }
    }

    proptest! {
        #[test]
        fn a_frame_matches_itself_and_no_other(one in any_frame(), other in any_frame()) {
            prop_assert!(Pattern::from(one).matches(&one));
            prop_assert_eq!(Pattern::from(one).matches(&other), one == other);
            prop_assert_eq!(Pattern::from(one).exact(), Some(one));
        }

        #[test]
        fn any_pattern_survives_its_notation(text in "[0-7][0-9A-F]{2}#([0-9A-F?]{2}){0,8}") {
            prop_assert_eq!(text.parse::<Pattern>().unwrap().to_string(), text);
        }

        #[test]
        fn any_byte_pattern_survives_its_notation(text in "([0-9A-F?]{2}( [0-9A-F?]{2}){0,40})?") {
            prop_assert_eq!(text.parse::<BytePattern>().unwrap().to_string(), text);
        }

        #[test]
        fn any_text_is_read_or_refused_inside_it(text in "[0-9A-F?. é]{0,24}|\\PC{0,12}") {
            match text.parse::<BytePattern>() {
                Ok(pattern) => prop_assert_eq!(pattern.to_string().parse(), Ok(pattern)),
                Err(error) => prop_assert!(error.offset() <= text.chars().count()),
            }
        }
    }
}
