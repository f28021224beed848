//! Typed values of keys, with a finding where a value is not of its type.

use super::finding::Finding;
use super::{Key, Section, rules};
use crate::integer::Integer;
use crate::{DataType, Default, Number};

/// The value of `name` in `section`; `None` if the key is missing or empty.
pub(super) fn key<'s>(section: &'s Section, name: &str) -> Option<&'s Key> {
    section.key(name).filter(|key| !key.value.is_empty())
}

pub(super) fn text(section: &Section, name: &str) -> Option<String> {
    key(section, name).map(|key| key.value.clone())
}

/// An unsigned number that fits `T`.
pub(super) fn unsigned<T: TryFrom<i128>>(
    section: &Section,
    name: &str,
    findings: &mut Vec<Finding>,
) -> Option<T> {
    let key = key(section, name)?;
    let number = Integer::parse(&key.value).and_then(|integer| T::try_from(integer.value).ok());
    if number.is_none() {
        findings.push(refused(key, "a number that fits"));
    }
    number
}

/// 0 or 1; any other number means 1.
pub(super) fn flag(section: &Section, name: &str, findings: &mut Vec<Finding>) -> Option<bool> {
    let key = key(section, name)?;
    let number = Integer::parse(&key.value).map(|integer| integer.value);
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
    section: &Section,
    name: &str,
    data_type: DataType,
    findings: &mut Vec<Finding>,
) -> Option<Number> {
    let key = key(section, name)?;
    let number = number(&key.value, data_type);
    if number.is_none() {
        findings.push(refused(key, "a whole number or $NODEID plus one"));
    }
    number
}

/// The value of `name` as a default of an entry of type `data_type`.
pub(super) fn default(
    section: &Section,
    name: &str,
    data_type: DataType,
    findings: &mut Vec<Finding>,
) -> Option<Default> {
    let key = key(section, name)?;
    let default = value(&key.value, data_type);
    match &default {
        None => findings.push(refused(key, "a value of its data type")),
        Some(value) if data_type.bits().is_some() && value.bytes(data_type, 1).is_none() => {
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

/// An integer, or a sum of one `$NODEID` and integers in any order.
fn number(text: &str, data_type: DataType) -> Option<Number> {
    let mut nodes = 0_u8;
    let mut offset = 0_i128;
    for term in text.split('+') {
        if term.trim().eq_ignore_ascii_case("$NODEID") {
            nodes = nodes.checked_add(1)?;
        } else {
            let integer = Integer::parse(term)?;
            offset = offset.checked_add(match data_type.bits() {
                Some(bits) if data_type.is_signed() => integer.as_signed(bits),
                _ => integer.value,
            })?;
        }
    }
    match nodes {
        0 if !text.trim_start_matches(['+', '-']).contains('+') => Some(Number::absolute(offset)),
        1 => Some(Number::relative(offset)),
        _ => None,
    }
}

fn refused(key: &Key, wanted: &str) -> Finding {
    Finding::losing(
        &rules::UNREADABLE_VALUE,
        key.line,
        format!("`{}` is not {wanted}", entry(key)),
        "the key is ignored",
    )
}

fn entry(key: &Key) -> String {
    format!("{}={}", key.name, key.value)
}
