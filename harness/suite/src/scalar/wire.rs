//! Objects, identifiers, frames, bytes.

use fieldproof_can::{BytePattern, Frame, Pattern};
use schemars::{Schema, json_schema};

use super::text::read_as_text;
use super::{BytePatternText, Bytes, FrameText, ObjectAddress, PatternText, Text};
use crate::code;
use crate::model::{Alternative, OtherBytes};
use crate::problem::Wrong;
use crate::read::ask;

impl Text for ObjectAddress {
    const EXPECTED: &'static str = "an object such as \"6041:00\"";

    fn parse(text: &str) -> Result<ObjectAddress, Wrong> {
        let hexadecimal = |digits: &str| digits.chars().all(|digit| digit.is_ascii_hexdigit());
        let parse = || {
            let (index, sub) = text.split_once(':')?;
            if index.len() != 4 || sub.len() != 2 || !hexadecimal(index) || !hexadecimal(sub) {
                return None;
            }
            Some(ObjectAddress {
                index: u16::from_str_radix(index, 16).ok()?,
                sub: u8::from_str_radix(sub, 16).ok()?,
            })
        };
        parse().ok_or_else(|| {
            Wrong::new(
                code::OBJECT,
                format!("`{text}` is not an object"),
                "expected index and sub-index in hexadecimal, such as \"6041:00\"",
            )
        })
    }

    fn schema() -> Schema {
        json_schema!({"type": "string", "pattern": "^[0-9A-Fa-f]{4}:[0-9A-Fa-f]{2}$"})
    }
}

/// An 11-bit identifier, always in hexadecimal: `581`, `0x581`, `581h`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct CanId(pub(crate) u16);

impl Text for CanId {
    const ASK: &'static str = ask::HEX;
    const EXPECTED: &'static str = "a CAN identifier such as 581";

    fn parse(text: &str) -> Result<CanId, Wrong> {
        let digits = text.strip_prefix("0x").or_else(|| text.strip_suffix('h'));
        let digits = digits.unwrap_or(text);
        let is_digits = digits.len() == 3 && digits.chars().all(|c| c.is_ascii_hexdigit());
        match u16::from_str_radix(digits, 16) {
            Ok(id) if is_digits && id <= 0x7FF => Ok(CanId(id)),
            _ => Err(Wrong::new(
                code::FRAME,
                format!("`{text}` is not a CAN identifier"),
                "expected three hexadecimal digits up to 7FF",
            )),
        }
    }

    fn schema() -> Schema {
        json_schema!({
            "type": ["integer", "string"],
            "pattern": "^(0x)?[0-7][0-9A-Fa-f]{2}h?$"
        })
    }
}

impl Text for FrameText {
    const ASK: &'static str = ask::HEX;
    const EXPECTED: &'static str = "a frame such as \"601#4063600000000000\"";

    fn parse(text: &str) -> Result<FrameText, Wrong> {
        text.parse::<Frame>().map(FrameText).map_err(|error| {
            Wrong::new(
                code::FRAME,
                format!("`{text}` is not a frame: {error}"),
                "expected a frame such as \"601#4063600000000000\"",
            )
        })
    }

    fn schema() -> Schema {
        json_schema!({"type": "string", "pattern": "^[0-9A-Fa-f]{3,8}#"})
    }
}

impl Text for PatternText {
    const ASK: &'static str = ask::HEX;
    const EXPECTED: &'static str = "a frame such as \"581#43636000????????\"";

    fn parse(text: &str) -> Result<PatternText, Wrong> {
        text.parse::<Pattern>().map(PatternText).map_err(|error| {
            Wrong::new(
                code::FRAME,
                format!("`{text}` is not a frame: {error}"),
                "expected a frame such as \"581#43636000????????\"",
            )
        })
    }

    fn schema() -> Schema {
        json_schema!({"type": "string", "pattern": "^[0-9A-Fa-f]{3,8}#"})
    }
}

impl Text for Alternative {
    const ASK: &'static str = ask::HEX;
    const EXPECTED: &'static str = "a frame such as \"581#43636000????????\", or silence";

    fn parse(text: &str) -> Result<Alternative, Wrong> {
        match text {
            "silence" => Ok(Alternative::Silence),
            _ => PatternText::parse(text).map(Alternative::Frame),
        }
    }

    fn schema() -> Schema {
        json_schema!({"type": "string", "pattern": "^([0-9A-Fa-f]{3,8}#|silence$)"})
    }
}

impl Text for OtherBytes {
    const ASK: &'static str = ask::HEX;
    const EXPECTED: &'static str = "bytes such as \"20 03 ?? ??\", or silence";

    fn parse(text: &str) -> Result<OtherBytes, Wrong> {
        match text {
            "silence" => Ok(OtherBytes::Silence),
            _ => BytePatternText::parse(text).map(OtherBytes::Bytes),
        }
    }

    fn schema() -> Schema {
        json_schema!({"type": ["string", "integer"], "pattern": "^([0-9A-Fa-f?. ]*|silence)$"})
    }
}

impl Text for Bytes {
    const ASK: &'static str = ask::HEX;
    const EXPECTED: &'static str = "bytes such as \"20 03 00 00\"";

    fn parse(text: &str) -> Result<Bytes, Wrong> {
        let label = "expected bytes such as \"20 03 00 00\"";
        let pattern: BytePattern = text.parse().map_err(|error| {
            Wrong::new(
                code::BYTES,
                format!("`{text}` is not bytes: {error}"),
                label,
            )
        })?;
        pattern.exact().map(Bytes).ok_or_else(|| {
            Wrong::new(
                code::BYTES,
                format!("`{text}` has a wildcard, and what is sent cannot have one"),
                label,
            )
        })
    }

    fn schema() -> Schema {
        json_schema!({"type": ["string", "integer"], "pattern": "^[0-9A-Fa-f. ]*$"})
    }
}

impl Text for BytePatternText {
    const ASK: &'static str = ask::HEX;
    const EXPECTED: &'static str = "bytes such as \"20 03 ?? ??\"";

    fn parse(text: &str) -> Result<BytePatternText, Wrong> {
        text.parse().map(BytePatternText).map_err(|error| {
            Wrong::new(
                code::BYTES,
                format!("`{text}` is not bytes: {error}"),
                "expected bytes such as \"20 03 ?? ??\"",
            )
        })
    }

    fn schema() -> Schema {
        json_schema!({"type": ["string", "integer"], "pattern": "^[0-9A-Fa-f?. ]*$"})
    }
}

read_as_text!(
    ObjectAddress,
    CanId,
    FrameText,
    PatternText,
    Alternative,
    OtherBytes,
    Bytes,
    BytePatternText
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_are_index_and_sub_index() {
        let object = ObjectAddress::parse("60FF:0a").unwrap();
        assert_eq!((object.index, object.sub), (0x60FF, 0x0A));
        for text in ["6041", "6041:0", "6041h:00", "G041:00", "+041:00", ""] {
            assert_eq!(ObjectAddress::parse(text).unwrap_err().code, code::OBJECT);
        }
    }

    #[test]
    fn identifiers_are_hexadecimal() {
        for text in ["581", "0x581", "581h"] {
            assert_eq!(CanId::parse(text), Ok(CanId(0x581)));
        }
        for text in ["58", "0581", "800", "+58", ""] {
            assert_eq!(CanId::parse(text).unwrap_err().code, code::FRAME);
        }
    }

    #[test]
    fn what_is_sent_has_no_wildcard() {
        assert_eq!(Bytes::parse("20.03 00"), Ok(Bytes(vec![0x20, 3, 0])));
        assert_eq!(Bytes::parse("20 ??").unwrap_err().code, code::BYTES);
        assert!(BytePatternText::parse("20 ??").is_ok());
        assert_eq!(FrameText::parse("601#4?").unwrap_err().code, code::FRAME);
        assert!(PatternText::parse("601#4?").is_ok());
    }
}
