//! The notation of can-utils: `60A#4000100000000000`.
//!
//! | text | meaning |
//! | --- | --- |
//! | `60A#40.00.10` | 3 hexadecimal digits: an 11-bit identifier; one `.` may stand between two bytes |
//! | `0000060A#40` | 8 hexadecimal digits: a 29-bit identifier |
//! | `080#` | no data |
//! | `701#R`, `701#R1` | a remote frame that asks for 0 bytes, for 1 byte |

use std::fmt;
use std::str::FromStr;

use crate::pattern::MaskedByte;
use crate::{ExtendedId, Frame, Id, Pattern, StandardId};

/// Why a text is not a frame, or not a pattern. `offset` counts characters from 0.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum NotationError {
    /// No `#` between identifier and data.
    #[error("no '#' after the identifier at character {offset}")]
    NoSeparator {
        /// The end of the text.
        offset: usize,
    },
    /// The identifier has neither 3 nor 8 digits.
    #[error(
        "identifier of {found} digits at character {offset}, expected 3 (11 bits) or 8 (29 bits)"
    )]
    IdentifierDigits {
        /// The first digit.
        offset: usize,
        /// How many there are.
        found: usize,
    },
    /// The identifier needs more bits than its format has.
    #[error("identifier {found:X} at character {offset}, expected at most {highest:X}")]
    IdentifierTooHigh {
        /// The first digit.
        offset: usize,
        /// The number written.
        found: u32,
        /// The highest of this format.
        highest: u32,
    },
    /// Something else stands where a hexadecimal digit belongs.
    #[error("'{found}' at character {offset}, expected a hexadecimal digit")]
    NotHexadecimal {
        /// Where.
        offset: usize,
        /// What stands there.
        found: char,
    },
    /// A wildcard in a text that must be exact.
    #[error("wildcard '?' at character {offset}, expected a hexadecimal digit")]
    Wildcard {
        /// Where.
        offset: usize,
    },
    /// The last byte has one digit only.
    #[error("byte of one digit at character {offset}, expected two")]
    HalfByte {
        /// The digit.
        offset: usize,
        /// What it is.
        found: char,
    },
    /// A `.` that is not between two bytes.
    #[error("'.' at character {offset}, expected it only between two bytes")]
    StraySeparator {
        /// Where.
        offset: usize,
    },
    /// More data than a classic frame carries.
    #[error("{found} data bytes at character {offset}, expected at most 8")]
    TooManyBytes {
        /// The first byte too many.
        offset: usize,
        /// How many there are.
        found: usize,
    },
    /// What follows `R` is not one digit `0..=8`.
    #[error("remote length '{found}' at character {offset}, expected one digit from 0 to 8")]
    RemoteLength {
        /// After the `R`.
        offset: usize,
        /// What stands there.
        found: String,
    },
}

impl NotationError {
    /// Where, in characters from 0.
    pub fn offset(&self) -> usize {
        match self {
            NotationError::NoSeparator { offset }
            | NotationError::IdentifierDigits { offset, .. }
            | NotationError::IdentifierTooHigh { offset, .. }
            | NotationError::NotHexadecimal { offset, .. }
            | NotationError::Wildcard { offset }
            | NotationError::HalfByte { offset, .. }
            | NotationError::StraySeparator { offset }
            | NotationError::TooManyBytes { offset, .. }
            | NotationError::RemoteLength { offset, .. } => *offset,
        }
    }

    /// What should stand there.
    pub fn expected(&self) -> &'static str {
        match self {
            NotationError::NoSeparator { .. } => "'#' after the identifier",
            NotationError::IdentifierDigits { .. } => "3 or 8 hexadecimal digits",
            NotationError::IdentifierTooHigh { .. } => "an identifier of at most 11 or 29 bits",
            NotationError::NotHexadecimal { .. } | NotationError::Wildcard { .. } => {
                "a hexadecimal digit"
            }
            NotationError::HalfByte { .. } => "two digits a byte",
            NotationError::StraySeparator { .. } => "'.' only between two bytes",
            NotationError::TooManyBytes { .. } => "at most 8 data bytes",
            NotationError::RemoteLength { .. } => "one digit from 0 to 8",
        }
    }
}

impl FromStr for Frame {
    type Err = NotationError;

    fn from_str(text: &str) -> Result<Frame, NotationError> {
        let pattern: Pattern = text.parse()?;
        pattern.exact().ok_or_else(|| NotationError::Wildcard {
            offset: text.chars().position(|c| c == '?').unwrap_or(0),
        })
    }
}

impl fmt::Display for Frame {
    /// Upper-case digits, no separators between bytes: `60A#4000100000000000`, `701#R1`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", Pattern::from(*self))
    }
}

impl fmt::Display for Id {
    /// 3 digits for 11 bits, 8 for 29: `60A`, `0000060A`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Id::Standard(id) => write!(f, "{:03X}", id.raw()),
            Id::Extended(id) => write!(f, "{:08X}", id.raw()),
        }
    }
}

/// What follows the `#`.
pub(crate) enum Payload {
    Data(Vec<MaskedByte>),
    Remote(u8),
}

/// Reads a whole text.
pub(crate) fn read(text: &str) -> Result<(Id, Payload), NotationError> {
    let characters: Vec<char> = text.chars().collect();
    let separator =
        characters
            .iter()
            .position(|c| *c == '#')
            .ok_or(NotationError::NoSeparator {
                offset: characters.len(),
            })?;
    let id = read_id(&characters[..separator])?;
    let payload_start = separator + 1;
    let payload = &characters[payload_start..];
    let payload = match payload {
        ['R' | 'r', length @ ..] => Payload::Remote(read_remote(length, payload_start + 1)?),
        data => Payload::Data(read_data(data, payload_start)?),
    };
    Ok((id, payload))
}

fn read_id(digits: &[char]) -> Result<Id, NotationError> {
    let mut raw: u32 = 0;
    for (offset, &found) in digits.iter().enumerate() {
        let digit = found
            .to_digit(16)
            .ok_or(NotationError::NotHexadecimal { offset, found })?;
        raw = raw << 4 | digit;
    }
    let too_high = |highest| NotationError::IdentifierTooHigh {
        offset: 0,
        found: raw,
        highest,
    };
    match digits.len() {
        3 => u16::try_from(raw)
            .ok()
            .and_then(Id::standard)
            .ok_or_else(|| too_high(u32::from(StandardId::MAX.raw()))),
        8 => Id::extended(raw).ok_or_else(|| too_high(ExtendedId::MAX.raw())),
        found => Err(NotationError::IdentifierDigits { offset: 0, found }),
    }
}

fn read_remote(length: &[char], offset: usize) -> Result<u8, NotationError> {
    match length {
        [] => Ok(0),
        [digit @ '0'..='8'] => Ok(*digit as u8 - b'0'),
        other => Err(NotationError::RemoteLength {
            offset,
            found: other.iter().collect(),
        }),
    }
}

fn read_data(characters: &[char], start: usize) -> Result<Vec<MaskedByte>, NotationError> {
    let mut bytes = Vec::with_capacity(8);
    let mut first_too_many = None;
    let mut at = 0;
    while at < characters.len() {
        if characters[at] == '.' {
            let between =
                !bytes.is_empty() && characters[at - 1] != '.' && at + 1 < characters.len();
            if !between {
                return Err(NotationError::StraySeparator { offset: start + at });
            }
            at += 1;
            continue;
        }
        if bytes.len() == 8 {
            first_too_many = Some(start + at);
        }
        bytes.push(read_byte(&characters[at..], start + at)?);
        at += 2;
    }
    match first_too_many {
        Some(offset) => Err(NotationError::TooManyBytes {
            offset,
            found: bytes.len(),
        }),
        None => Ok(bytes),
    }
}

/// Reads the two digits at the start of `characters`, which is not empty; `offset` is their place in the text.
pub(crate) fn read_byte(characters: &[char], offset: usize) -> Result<MaskedByte, NotationError> {
    let (high_value, high_mask) = read_nibble(characters[0], offset)?;
    let low = characters
        .get(1)
        .filter(|c| **c != '.' && !c.is_whitespace());
    let Some(&low) = low else {
        return Err(NotationError::HalfByte {
            offset,
            found: characters[0],
        });
    };
    let (low_value, low_mask) = read_nibble(low, offset + 1)?;
    Ok(MaskedByte::new(
        high_value << 4 | low_value,
        high_mask << 4 | low_mask,
    ))
}

fn read_nibble(found: char, offset: usize) -> Result<(u8, u8), NotationError> {
    match found {
        '?' => Ok((0, 0)),
        _ => found
            .to_digit(16)
            .map(|digit| (digit as u8, 0xF))
            .ok_or(NotationError::NotHexadecimal { offset, found }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn standard(id: u16, data: &[u8]) -> Frame {
        Frame::data(StandardId::new(id).unwrap(), data).unwrap()
    }

    #[test]
    fn frames_are_read() {
        let upload = standard(0x60A, &[0x40, 0x00, 0x10, 0, 0, 0, 0, 0]);
        for text in [
            "60A#4000100000000000",
            "60a#40.00.10.00.00.00.00.00",
            "60A#400010.0000000000",
        ] {
            assert_eq!(text.parse(), Ok(upload), "{text}");
        }
        assert_eq!("080#".parse(), Ok(standard(0x080, &[])));
        let extended = Id::extended(0x60A).unwrap();
        assert_eq!(
            "0000060A#4F".parse(),
            Ok(Frame::data(extended, &[0x4F]).unwrap())
        );
        let guard = Id::standard(0x701).unwrap();
        assert_eq!("701#R".parse(), Ok(Frame::remote(guard, 0).unwrap()));
        assert_eq!("701#R1".parse(), Ok(Frame::remote(guard, 1).unwrap()));
    }

    #[test]
    fn what_is_not_a_frame_is_refused_with_its_place() {
        let cases = [
            ("", "no '#' after the identifier at character 0"),
            ("60A4000", "no '#' after the identifier at character 7"),
            (
                "60#40",
                "identifier of 2 digits at character 0, expected 3 (11 bits) or 8 (29 bits)",
            ),
            (
                "000000000#40",
                "identifier of 9 digits at character 0, expected 3 (11 bits) or 8 (29 bits)",
            ),
            (
                "800#40",
                "identifier 800 at character 0, expected at most 7FF",
            ),
            (
                "20000000#40",
                "identifier 20000000 at character 0, expected at most 1FFFFFFF",
            ),
            ("6G0#40", "'G' at character 1, expected a hexadecimal digit"),
            ("6é0#4x", "'é' at character 1, expected a hexadecimal digit"),
            ("601#4x", "'x' at character 5, expected a hexadecimal digit"),
            ("601##1", "'#' at character 4, expected a hexadecimal digit"),
            ("601#400", "byte of one digit at character 6, expected two"),
            ("601#4.00", "byte of one digit at character 4, expected two"),
            (
                "601#.40",
                "'.' at character 4, expected it only between two bytes",
            ),
            (
                "601#40.",
                "'.' at character 6, expected it only between two bytes",
            ),
            (
                "601#40..00",
                "'.' at character 7, expected it only between two bytes",
            ),
            (
                "601#00.0102030405060708",
                "9 data bytes at character 21, expected at most 8",
            ),
            (
                "601#R9",
                "remote length '9' at character 5, expected one digit from 0 to 8",
            ),
            (
                "601#R10",
                "remote length '10' at character 5, expected one digit from 0 to 8",
            ),
            (
                "601#4?",
                "wildcard '?' at character 5, expected a hexadecimal digit",
            ),
        ];
        for (text, message) in cases {
            let error = text.parse::<Frame>().unwrap_err();
            assert_eq!(error.to_string(), message, "{text}");
        }
    }

    #[test]
    fn frames_are_written() {
        assert_eq!(standard(0x60A, &[0x40, 0, 0x10]).to_string(), "60A#400010");
        let id = Id::extended(0x1ABC).unwrap();
        assert_eq!(Frame::remote(id, 0).unwrap().to_string(), "00001ABC#R");
        assert_eq!(Frame::remote(id, 8).unwrap().to_string(), "00001ABC#R8");
    }

    proptest! {
        #[test]
        fn any_frame_survives_its_notation(frame in crate::frame::any_frame()) {
            prop_assert_eq!(frame.to_string().parse(), Ok(frame));
        }

        #[test]
        fn any_text_is_read_or_refused_inside_it(text in "[0-9A-Fa-f#R?. é]{0,24}|\\PC{0,12}") {
            match text.parse::<Frame>() {
                Ok(frame) => prop_assert_eq!(frame.to_string().parse(), Ok(frame)),
                Err(error) => prop_assert!(error.offset() <= text.chars().count()),
            }
        }
    }
}
