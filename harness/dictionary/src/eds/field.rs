//! Typed values of keys, with a finding where a value is not of its type.

use super::finding::Finding;
use super::{Key, rules};
use crate::integer::Integer;
use crate::value::integer_fits;
use crate::{DataType, Default, Number};

pub(super) fn text(key: Option<Key<'_>>) -> Option<String> {
    key.map(|key| key.value.to_owned())
}

/// An unsigned number that fits `T`.
pub(super) fn unsigned<T: TryFrom<i128>>(
    key: Option<Key<'_>>,
    findings: &mut Vec<Finding>,
) -> Option<T> {
    let key = key?;
    let number = Integer::parse(key.value).and_then(|integer| T::try_from(integer.value).ok());
    if number.is_none() {
        findings.push(refused(key, "a number that fits"));
    }
    number
}

/// 0 or 1; any other number means 1.
pub(super) fn flag(key: Option<Key<'_>>, findings: &mut Vec<Finding>) -> Option<bool> {
    let key = key?;
    let number = Integer::parse(key.value).map(|integer| integer.value);
    match number {
        Some(0 | 1) => {}
        Some(_) => findings.push(Finding::new(
            &rules::FLAG,
            key.line,
            format!("`{}` is neither 0 nor 1", entry(key)),
            "read as 1",
        )),
        None => findings.push(refused(key, "0 or 1")),
    }
    number.map(|number| number != 0)
}

/// A limit of an entry of type `data_type`.
pub(super) fn limit(
    key: Option<Key<'_>>,
    data_type: DataType,
    findings: &mut Vec<Finding>,
) -> Option<Number> {
    let key = key?;
    let number = match data_type.is_real() {
        true => pattern(key.value, data_type),
        false => number(key.value, data_type),
    };
    if number.is_none() {
        findings.push(refused(
            key,
            "a number of its data type, or $NODEID plus one",
        ));
    }
    number
}

/// The default, or the value in one device, of an entry of type `data_type`.
pub(super) fn default(
    key: Option<Key<'_>>,
    data_type: DataType,
    findings: &mut Vec<Finding>,
) -> Option<Default> {
    let key = key?;
    let default = value(key.value, data_type);
    match &default {
        None => findings.push(refused(key, "a value of its data type")),
        Some(value) if !fits(value, data_type) => {
            findings.push(Finding::new(
                &rules::DEFAULT_NOT_OF_TYPE,
                key.line,
                format!("`{}` does not fit its data type {data_type:?}", entry(key)),
                "correct the value or the DataType",
            ));
        }
        Some(_) => {}
    }
    default
}

/// Whether `value` can be had in `data_type`, where that has a size.
fn fits(value: &Default, data_type: DataType) -> bool {
    match (value, data_type.bytes()) {
        (_, None) => true,
        (Default::Number(number), Some(size)) => integer_fits(number.value(1), size),
        (Default::Text(_), Some(_)) => value.bytes(data_type, 1).is_some(),
    }
}

/// `text` as a default of an entry of type `data_type`.
pub(super) fn value(text: &str, data_type: DataType) -> Option<Default> {
    if data_type.is_text() {
        return Some(Default::Text(text.to_owned()));
    }
    if data_type.is_real() {
        return real(text, data_type);
    }
    number(text, data_type).map(Default::Number).or_else(|| {
        matches!(data_type, DataType::Unknown(_)).then(|| Default::Text(text.to_owned()))
    })
}

/// A real number: a bit pattern in hexadecimal, or a decimal fraction.
fn real(text: &str, data_type: DataType) -> Option<Default> {
    match Integer::parse(text) {
        Some(pattern) if pattern.hexadecimal => {
            Some(Default::Number(Number::absolute(pattern.value)))
        }
        _ => {
            let fraction = Default::Text(text.to_owned());
            fraction.bytes(data_type, 1).is_some().then_some(fraction)
        }
    }
}

/// The bit pattern of a real number.
fn pattern(text: &str, data_type: DataType) -> Option<Number> {
    match real(text, data_type)? {
        Default::Number(pattern) => Some(pattern),
        fraction @ Default::Text(_) => {
            let bytes = fraction.bytes(data_type, 1)?;
            let bits = bytes.iter().rev();
            Some(Number::absolute(
                bits.fold(0, |bits, byte| bits << 8 | i128::from(*byte)),
            ))
        }
    }
}

/// An integer, or a sum of one `$NODEID` and integers in any order.
fn number(text: &str, data_type: DataType) -> Option<Number> {
    if let Some(integer) = Integer::parse(text) {
        return Some(Number::absolute(in_type(integer, data_type)));
    }
    let mut nodes = 0_u8;
    let mut offset = 0_i128;
    for term in text.split('+') {
        if term.trim().eq_ignore_ascii_case("$NODEID") {
            nodes = nodes.checked_add(1)?;
        } else {
            let integer = Integer::parse(term)?;
            offset = offset.checked_add(in_type(integer, data_type))?;
        }
    }
    // What needs more than 64 bits could not be written back.
    let writable = offset.unsigned_abs() <= u128::from(u64::MAX);
    (nodes == 1 && writable).then(|| Number::relative(offset))
}

/// The value of `integer`, which may be the bit pattern of a negative number of a signed type.
fn in_type(integer: Integer, data_type: DataType) -> i128 {
    match data_type.bits() {
        Some(bits) if data_type.is_signed() => integer.as_signed(bits),
        _ => integer.value,
    }
}

fn refused(key: Key<'_>, wanted: &str) -> Finding {
    Finding::losing(
        &rules::UNREADABLE_VALUE,
        key.line,
        format!("`{}` is not {wanted}", entry(key)),
        "the key is ignored",
    )
}

fn entry(key: Key<'_>) -> String {
    format!("{}={}", key.name, key.value)
}
