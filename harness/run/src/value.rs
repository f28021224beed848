//! Values of suites into bytes, and bytes into values.

use std::collections::BTreeMap;
use std::fmt;
use std::time::Duration;

use fieldproof_suite::model::{Decode, ValueType};
use fieldproof_suite::scalar::{Decimal, Number, Value};

use crate::modbus::show_bytes;
use crate::stop::Stop;

/// A value that came from the device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Actual {
    Number(i128),
    Text(String),
    Bytes(Vec<u8>),
}

/// The most bytes of a value that are shown.
const MOST_SHOWN: usize = 24;

impl fmt::Display for Actual {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Actual::Number(number) if *number < 10 && *number > -10 => write!(f, "{number}"),
            Actual::Number(number) if *number < 0 => write!(f, "{number}"),
            Actual::Number(number) => write!(f, "{number} ({number:X}h)"),
            Actual::Text(text) => write!(f, "{text:?}"),
            Actual::Bytes(bytes) => {
                let (shown, more) = match bytes.get(..MOST_SHOWN) {
                    Some(shown) if bytes.len() > MOST_SHOWN => (shown, " .."),
                    _ => (bytes.as_slice(), ""),
                };
                write!(f, "{} bytes: {}{more}", bytes.len(), show_bytes(shown))
            }
        }
    }
}

/// The values that earlier steps of a case saved.
pub(crate) type Saved = BTreeMap<String, Actual>;

/// Bytes of a type; `None` for texts.
pub(crate) const fn size(value_type: ValueType) -> Option<usize> {
    match value_type {
        ValueType::U8 | ValueType::I8 => Some(1),
        ValueType::U16 | ValueType::I16 | ValueType::SignMagnitude16 => Some(2),
        ValueType::U24 => Some(3),
        ValueType::U32 | ValueType::I32 => Some(4),
        ValueType::U64 | ValueType::I64 => Some(8),
        ValueType::Text | ValueType::Bytes => None,
    }
}

const fn is_signed(value_type: ValueType) -> bool {
    matches!(
        value_type,
        ValueType::I8 | ValueType::I16 | ValueType::I32 | ValueType::I64
    )
}

/// `bytes`, least significant first, as a value of a type; `None` if there are too few or too many.
pub(crate) fn decode(value_type: ValueType, bytes: &[u8]) -> Option<Actual> {
    if value_type == ValueType::Bytes {
        return Some(Actual::Bytes(bytes.to_vec()));
    }
    let Some(size) = size(value_type) else {
        let text: String = bytes.iter().map(|byte| char::from(*byte)).collect();
        return Some(Actual::Text(text.trim_end_matches('\0').to_owned()));
    };
    if bytes.len() != size {
        return None;
    }
    let unsigned = bytes
        .iter()
        .rev()
        .fold(0_i128, |value, byte| value << 8 | i128::from(*byte));
    let top = 1_i128 << (size * 8 - 1);
    Some(Actual::Number(match value_type {
        ValueType::SignMagnitude16 if unsigned & top != 0 => -(unsigned & (top - 1)),
        _ if is_signed(value_type) && unsigned & top != 0 => unsigned - (top << 1),
        _ => unsigned,
    }))
}

/// `value` as bytes of a type, least significant first.
pub(crate) fn encode(
    value_type: ValueType,
    value: &Value,
    unit: Option<Duration>,
    saved: &Saved,
) -> Result<Vec<u8>, Stop> {
    let number = match resolve(value, unit, saved)? {
        Actual::Text(text) => return Ok(text.into_bytes()),
        Actual::Bytes(bytes) => return Ok(bytes),
        Actual::Number(number) => number,
    };
    let Some(size) = size(value_type) else {
        return Err(Stop::Bench(format!(
            "the number {number} cannot be written as a text or as bytes"
        )));
    };
    let top = 1_i128 << (size * 8 - 1);
    let (low, high) = match value_type {
        ValueType::SignMagnitude16 => (1 - top, top - 1),
        _ if is_signed(value_type) => (-top, top - 1),
        _ => (0, (top << 1) - 1),
    };
    if number < low || number > high {
        return Err(Stop::Bench(format!(
            "{number} does not fit the type: it holds {low} to {high}"
        )));
    }
    let raw = match value_type {
        ValueType::SignMagnitude16 if number < 0 => -number | top,
        _ => number,
    };
    Ok(raw.to_le_bytes().into_iter().take(size).collect())
}

/// What a value of the suite stands for: saved values are looked up, durations are counted in units.
pub(crate) fn resolve(
    value: &Value,
    unit: Option<Duration>,
    saved: &Saved,
) -> Result<Actual, Stop> {
    match value {
        Value::Number(number) => Ok(Actual::Number(*number)),
        Value::Text(text) => Ok(Actual::Text(text.clone())),
        Value::Bytes(bytes) => Ok(Actual::Bytes(bytes.clone())),
        Value::Saved(name) => lookup(name, saved).cloned(),
        Value::Duration(duration) => match unit {
            None => Err(Stop::Bench(
                "a duration needs the unit of the object".into(),
            )),
            Some(unit) if duration.as_nanos() % unit.as_nanos().max(1) != 0 => Err(Stop::Bench(
                "the duration is not a multiple of the object's unit".into(),
            )),
            Some(unit) => Ok(Actual::Number(
                (duration.as_nanos() / unit.as_nanos().max(1)) as i128,
            )),
        },
    }
}

/// A register value, 0 to FFFFh; negative numbers as two's complement.
pub(crate) fn register(number: &Number, saved: &Saved) -> Result<u16, Stop> {
    let value = match number {
        Number::Literal(value) => *value,
        Number::Saved(name) => match lookup(name, saved)? {
            Actual::Number(value) => *value,
            Actual::Text(text) => {
                return Err(Stop::Bench(format!(
                    "{name:?} was saved as the text {text:?}"
                )));
            }
            Actual::Bytes(bytes) => {
                return Err(Stop::Bench(format!(
                    "{name:?} was saved as {} bytes",
                    bytes.len()
                )));
            }
        },
    };
    u16::try_from(value)
        .or_else(|_| i16::try_from(value).map(|signed| signed as u16))
        .map_err(|_| Stop::Bench(format!("{value} does not fit a register")))
}

fn lookup<'s>(name: &str, saved: &'s Saved) -> Result<&'s Actual, Stop> {
    saved
        .get(name)
        .ok_or_else(|| Stop::NotSaved(name.to_owned()))
}

/// Whether the bytes of a frame mean what the suite says; else what they mean.
pub(crate) fn check_decode(decode_rule: &Decode, data: &[u8]) -> Result<(), Stop> {
    let name = decode_rule.name.as_deref().unwrap_or("the value");
    let default_offset = if decode_rule.object.is_some() { 4 } else { 0 };
    let offset = decode_rule.offset.unwrap_or(default_offset);
    let end = offset + size(decode_rule.value_type).unwrap_or(0);
    let Some(bytes) = data.get(offset..end) else {
        return Err(Stop::mismatch(
            format!("the frame is too short for {name}"),
            format!("bytes {offset} to {}", end.saturating_sub(1)),
            format!("{} bytes", data.len()),
            crate::stop::Came::Other,
        ));
    };
    let mut little_endian = bytes.to_vec();
    if decode_rule.big_endian {
        little_endian.reverse();
    }
    let Some(Actual::Number(raw)) = decode(decode_rule.value_type, &little_endian) else {
        return Err(Stop::Bench(
            "only numbers can be decoded from a frame".into(),
        ));
    };
    if is_close(raw, decode_rule) {
        return Ok(());
    }
    let unit = decode_rule.unit.as_deref().unwrap_or_default();
    let scaled = raw as f64 * decode_rule.multiply as f64 / decode_rule.divide as f64;
    Err(Stop::differs(
        format!("{name} is not what it should be"),
        format!("{} {unit}", show_decimal(decode_rule.equals))
            .trim_end()
            .to_owned(),
        format!("{scaled} {unit} (raw {raw})"),
        crate::stop::Came::Value(raw),
    ))
}

/// |raw * multiply / divide - equals| <= tolerance, in whole numbers.
fn is_close(raw: i128, rule: &Decode) -> bool {
    let decimals = rule.tolerance.map_or(rule.equals.decimals, |t| {
        t.decimals.max(rule.equals.decimals)
    });
    let divide = i128::from(rule.divide);
    let scale = 10_i128.pow(decimals.min(12));
    let measured = raw * i128::from(rule.multiply) * scale;
    let expected = scaled_to(rule.equals, decimals) * divide;
    let allowed = rule
        .tolerance
        .map_or(0, |tolerance| scaled_to(tolerance, decimals))
        * divide;
    (measured - expected).abs() <= allowed.abs()
}

fn scaled_to(decimal: Decimal, decimals: u32) -> i128 {
    i128::from(decimal.digits) * 10_i128.pow(decimals.saturating_sub(decimal.decimals).min(12))
}

fn show_decimal(decimal: Decimal) -> String {
    let text = format!(
        "{:0width$}",
        decimal.digits.unsigned_abs(),
        width = decimal.decimals as usize + 1
    );
    let (whole, fraction) = text.split_at(text.len() - decimal.decimals as usize);
    let sign = if decimal.digits < 0 { "-" } else { "" };
    if fraction.is_empty() {
        format!("{sign}{whole}")
    } else {
        format!("{sign}{whole}.{fraction}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rule(value_type: ValueType, multiply: i64, divide: i64, equals: (i64, u32)) -> Decode {
        Decode {
            object: None,
            offset: None,
            value_type,
            big_endian: false,
            multiply,
            divide,
            equals: Decimal {
                digits: equals.0,
                decimals: equals.1,
            },
            tolerance: None,
            unit: None,
            name: None,
        }
    }

    #[test]
    fn values_go_both_ways() {
        let saved = Saved::new();
        for (value_type, number, bytes) in [
            (ValueType::I32, -12013, vec![0x13, 0xD1, 0xFF, 0xFF]),
            (ValueType::U16, 0x0231, vec![0x31, 0x02]),
            (ValueType::SignMagnitude16, -9298, vec![0x52, 0xA4]),
            (ValueType::U24, 0x303156, vec![0x56, 0x31, 0x30]),
            (ValueType::I8, -1, vec![0xFF]),
        ] {
            assert_eq!(
                encode(value_type, &Value::Number(number), None, &saved).ok(),
                Some(bytes.clone())
            );
            assert_eq!(decode(value_type, &bytes), Some(Actual::Number(number)));
        }
        assert!(encode(ValueType::U8, &Value::Number(256), None, &saved).is_err());
        assert!(encode(ValueType::I8, &Value::Number(-129), None, &saved).is_err());
        assert_eq!(decode(ValueType::U16, &[1, 2, 3]), None);
    }

    #[test]
    fn a_duration_is_counted_in_the_units_of_the_object() {
        let saved = Saved::new();
        let ten_ms = Value::Duration(Duration::from_millis(10));
        let in_tenths = encode(
            ValueType::U16,
            &ten_ms,
            Some(Duration::from_micros(100)),
            &saved,
        );
        assert_eq!(in_tenths.ok(), Some(vec![100, 0]));
        assert!(
            encode(
                ValueType::U16,
                &ten_ms,
                Some(Duration::from_millis(3)),
                &saved
            )
            .is_err()
        );
        assert!(encode(ValueType::U16, &ten_ms, None, &saved).is_err());
    }

    #[test]
    fn scaled_values_are_compared_exactly() {
        // TPDO1 of the encoder: 22153012 / 10000 = 2215.3012 rpm.
        let speed = [0x34, 0x07, 0x52, 0x01];
        assert!(check_decode(&rule(ValueType::I32, 1, 10_000, (22_153_012, 4)), &speed).is_ok());
        assert!(check_decode(&rule(ValueType::I32, 1, 10_000, (22_153_013, 4)), &speed).is_err());
        // 51159 / 65536 * 360 = 281.0248 degrees, printed as 281.024.
        let angle = [0xD7, 0xC7];
        let mut printed = rule(ValueType::U16, 360, 65_536, (281_024, 3));
        assert!(check_decode(&printed, &angle).is_err());
        printed.tolerance = Some(Decimal {
            digits: 1,
            decimals: 3,
        });
        assert!(check_decode(&printed, &angle).is_ok());
        assert_eq!(
            show_decimal(Decimal {
                digits: -362_115,
                decimals: 4
            }),
            "-36.2115"
        );
        assert_eq!(
            show_decimal(Decimal {
                digits: 5,
                decimals: 3
            }),
            "0.005"
        );
    }
}
