//! Bytes in the journal: hexadecimal, as people read them.

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

use crate::{Direction, FrameEvent};

/// Bytes as an even number of hexadecimal digits: `"4363600000000000"`.
#[derive(JsonSchema)]
#[schemars(transparent)]
pub(crate) struct HexBytes(
    #[schemars(regex(pattern = r"^([0-9A-F]{2})*$"))]
    #[allow(dead_code, reason = "only its schema is used")]
    String,
);

impl HexBytes {
    pub(crate) fn serialize<S: Serializer>(bytes: &[u8], serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&text(bytes))
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<u8>, D::Error> {
        let text = String::deserialize(deserializer)?;
        bytes(&text).ok_or_else(|| de::Error::custom("expected pairs of hexadecimal digits"))
    }
}

/// A CAN frame as the journal writes it.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct FrameLine {
    /// The end of its last bit, in nanoseconds.
    at_ns: u64,
    /// The port.
    port: u8,
    /// From where to where.
    direction: Direction,
    /// The identifier.
    id: u32,
    /// Whether the identifier has 29 bits.
    #[serde(default, skip_serializing_if = "is_false")]
    extended: bool,
    /// How many bytes a remote frame asks for; only a remote frame has this.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    remote: Option<u8>,
    /// The data, hexadecimal.
    #[serde(with = "HexBytes")]
    #[schemars(with = "HexBytes")]
    data: Vec<u8>,
    /// What it means.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    decoded: Option<Box<str>>,
}

impl From<FrameEvent> for FrameLine {
    fn from(frame: FrameEvent) -> FrameLine {
        let used = usize::from(frame.len).min(frame.data.len());
        FrameLine {
            at_ns: frame.at_ns,
            port: frame.port,
            direction: frame.direction,
            id: frame.id,
            extended: frame.extended,
            remote: frame.remote.then_some(frame.len),
            data: match frame.remote {
                true => Vec::new(),
                false => frame.data[..used].to_vec(),
            },
            decoded: frame.decoded,
        }
    }
}

impl TryFrom<FrameLine> for FrameEvent {
    type Error = &'static str;

    fn try_from(line: FrameLine) -> Result<FrameEvent, &'static str> {
        let len = match line.remote {
            Some(_) if !line.data.is_empty() => return Err("a remote frame has no data"),
            Some(len) => usize::from(len),
            None => line.data.len(),
        };
        if len > 8 {
            return Err("a CAN frame has at most 8 bytes");
        }
        let mut data = [0; 8];
        data[..line.data.len()].copy_from_slice(&line.data);
        Ok(FrameEvent {
            at_ns: line.at_ns,
            port: line.port,
            direction: line.direction,
            id: line.id,
            extended: line.extended,
            remote: line.remote.is_some(),
            len: u8::try_from(len).unwrap_or(8),
            data,
            decoded: line.decoded,
        })
    }
}

fn is_false(value: &bool) -> bool {
    !value
}

const DIGITS: [u8; 16] = *b"0123456789ABCDEF";

fn text(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(2 * bytes.len());
    // Not `write!`: every frame of a run comes by here.
    for byte in bytes {
        for nibble in [byte >> 4, byte & 0xF] {
            text.push(char::from(DIGITS[usize::from(nibble)]));
        }
    }
    text
}

fn bytes(text: &str) -> Option<Vec<u8>> {
    let digits: Option<Vec<u8>> = text
        .chars()
        .map(|digit| {
            digit
                .to_digit(16)
                .and_then(|value| u8::try_from(value).ok())
        })
        .collect();
    let digits = digits?;
    match digits.len() % 2 {
        0 => Some(
            digits
                .chunks(2)
                .map(|pair| pair[0] << 4 | pair[1])
                .collect(),
        ),
        _ => None,
    }
}
