//! The small words of the language, each read from one scalar: durations, rates, objects, frames, numbers.

mod number;
mod text;
mod time;
mod wire;

use std::time::Duration;

use fieldproof_can as can;

pub(crate) use number::{Scale, whole_number};
pub(crate) use text::{OneText, Text, read_as_text};
pub(crate) use time::{BitRate, Time, TimeUnit};
pub(crate) use wire::CanId;

/// A point in the object dictionary: `6041:00`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ObjectAddress {
    /// Index.
    pub index: u16,
    /// Sub-index.
    pub sub: u8,
}

/// A limit with its tolerance: `100 ms ± 5 %` (`+-` is the same), `100 ms ± 2 ms`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tolerance {
    /// The nominal value.
    pub nominal: Duration,
    /// How far off it may be.
    pub tolerance: Duration,
}

/// A frame that is sent: can-utils notation without wildcards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FrameText(pub can::Frame);

/// A frame that is expected: can-utils notation, `??` any byte.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PatternText(pub can::Pattern);

/// Bytes that are sent: `20 03 00 00`, spaces and dots between bytes allowed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Bytes(pub Vec<u8>);

/// Bytes that are expected, `??` any byte.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BytePatternText(pub can::BytePattern);

/// A whole number: `100`, `0x1018`, `1018h`, or one that an earlier step saved: `"{device_type}"`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Number {
    /// Written in the suite.
    Literal(i128),
    /// The value saved under this name.
    Saved(String),
}

/// What is written or expected as a value: a number, a duration (with the object's `unit`), a text, or a saved value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Value {
    /// A whole number.
    Number(i128),
    /// A duration; the step says the unit of the object.
    Duration(Duration),
    /// A text, for string objects.
    Text(String),
    /// Bytes in the order in which they travel.
    Bytes(Vec<u8>),
    /// The value saved under this name.
    Saved(String),
}

/// A decimal number, exact: `281.0248` is 2810248 / 10^4.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Decimal {
    /// All digits with the sign.
    pub digits: i64,
    /// How many of them stand after the point.
    pub decimals: u32,
}
