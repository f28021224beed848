//! A value whose meaning depends on the type beside it.

use std::time::Duration;

use schemars::{Schema, json_schema};

use crate::code;
use crate::expand::whole;
use crate::model::ValueType;
use crate::problem::Wrong;
use crate::read::ask;
use crate::scalar::{Bytes, Text, Time, Value, read_as_text, whole_number};

/// The most bytes that a value is made of by their number.
const MOST_BYTES: usize = 1 << 16;

/// A value as it is written, before its type is known.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct RawValue(String);

impl Text for RawValue {
    const ASK: &'static str = ask::SAVEABLE;
    const EXPECTED: &'static str = "a value";

    fn parse(text: &str) -> Result<RawValue, Wrong> {
        Ok(RawValue(text.to_owned()))
    }

    fn schema() -> Schema {
        json_schema!({"type": ["integer", "number", "string"]})
    }
}

read_as_text!(RawValue);

impl RawValue {
    /// The value as `value_type`; a duration in counts of `unit`, if one is given.
    pub(super) fn lower(
        &self,
        value_type: ValueType,
        unit: Option<Duration>,
    ) -> Result<Value, Wrong> {
        if let Some(name) = whole(&self.0) {
            return Ok(Value::Saved(name.to_owned()));
        }
        if value_type == ValueType::Bytes {
            return bytes(&self.0).map(Value::Bytes);
        }
        let Some((low, high)) = value_type.limits() else {
            return Ok(Value::Text(self.0.clone()));
        };
        if let Some(number) = whole_number(&self.0) {
            return fits(number, low, high, value_type).map(Value::Number);
        }
        let is_time = self.0.starts_with(|first: char| first.is_ascii_digit());
        if !is_time {
            return Err(Wrong::new(
                code::NUMBER,
                format!("`{}` is not a whole number", self.0),
                "expected a number such as 100, 0x64 or 64h",
            ));
        }
        let time = Time::parse(&self.0)?.0;
        let Some(unit) = unit else {
            return Err(Wrong::new(
                code::DURATION,
                format!(
                    "`{}` is a duration, and the object's unit is not said",
                    self.0
                ),
                "expected a number, or `unit` beside it",
            )
            .help("say what one count of the object is: `unit: ms`, `unit: 100 us`"));
        };
        if time.as_nanos() % unit.as_nanos().max(1) != 0 {
            let message = format!("`{}` is not a whole number of the object's unit", self.0);
            return Err(Wrong::new(
                code::DOES_NOT_FIT,
                message,
                "between two counts",
            ));
        }
        fits(counts(time, unit), low, high, value_type)?;
        Ok(Value::Duration(time))
    }
}

pub(super) fn counts(time: Duration, unit: Duration) -> i128 {
    (time.as_nanos() / unit.as_nanos().max(1)) as i128
}

/// `00 11 AA FF`, or `889 bytes` of a fixed sequence.
fn bytes(text: &str) -> Result<Vec<u8>, Wrong> {
    let Some(count) = text.strip_suffix(" bytes") else {
        return Bytes::parse(text).map(|bytes| bytes.0);
    };
    match count.parse() {
        Ok(count) if count <= MOST_BYTES => Ok(sequence(count)),
        _ => Err(Wrong::new(
            code::NUMBER,
            format!("`{text}` is not a number of bytes"),
            format!("expected 0 to {MOST_BYTES} bytes"),
        )),
    }
}

/// The first bytes of a sequence in which a part that is missing, doubled or moved shows.
fn sequence(count: usize) -> Vec<u8> {
    let mut state = 0_u32;
    let next = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state.to_be_bytes()[0]
    };
    std::iter::repeat_with(next).take(count).collect()
}

fn fits(number: i128, low: i128, high: i128, value_type: ValueType) -> Result<i128, Wrong> {
    if (low..=high).contains(&number) {
        return Ok(number);
    }
    Err(Wrong::new(
        code::DOES_NOT_FIT,
        format!("{number} does not fit `{}`", value_type.word()),
        format!("expected {low} to {high}"),
    ))
}

impl ValueType {
    /// As it is written after `as`.
    pub(super) fn word(self) -> &'static str {
        match self {
            ValueType::U8 => "u8",
            ValueType::U16 => "u16",
            ValueType::U24 => "u24",
            ValueType::U32 => "u32",
            ValueType::U64 => "u64",
            ValueType::I8 => "i8",
            ValueType::I16 => "i16",
            ValueType::I32 => "i32",
            ValueType::I64 => "i64",
            ValueType::SignMagnitude16 => "sign-magnitude-16",
            ValueType::Text => "text",
            ValueType::Bytes => "bytes",
        }
    }

    /// The lowest and the highest number it holds; `None` for a text.
    pub(crate) fn limits(self) -> Option<(i128, i128)> {
        let unsigned = |bits: u32| Some((0, (1i128 << bits) - 1));
        let signed = |bits: u32| Some((-(1i128 << (bits - 1)), (1i128 << (bits - 1)) - 1));
        match self {
            ValueType::U8 => unsigned(8),
            ValueType::U16 => unsigned(16),
            ValueType::U24 => unsigned(24),
            ValueType::U32 => unsigned(32),
            ValueType::U64 => unsigned(64),
            ValueType::I8 => signed(8),
            ValueType::I16 => signed(16),
            ValueType::I32 => signed(32),
            ValueType::I64 => signed(64),
            ValueType::SignMagnitude16 => Some((-0x7FFF, 0x7FFF)),
            ValueType::Text | ValueType::Bytes => None,
        }
    }
}
