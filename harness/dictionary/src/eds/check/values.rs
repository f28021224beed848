//! Defaults and limits, against their types and against each other.

use super::super::object_keys::{ObjectKeys, Word};
use super::super::place::Place;
use super::super::{Eds, Finding, Section, rules};
use super::section_of;
use crate::value::octets;
use crate::{DataType, Default, Entry, Number, Object};

pub(super) fn check(eds: &Eds, findings: &mut Vec<Finding>) {
    for object in eds.dictionary.objects() {
        for (sub, entry) in object.entries.iter() {
            limits(eds, object, *sub, entry, findings);
            characters(eds, object, *sub, entry, findings);
            if matches!(object.index, 0x1400..=0x15FF | 0x1800..=0x19FF) && *sub == 2 {
                transmission_type(eds, entry, findings);
            }
        }
    }
    cycle_period(eds, findings);
}

/// How the numbers of an object or entry are written.
pub(super) fn spelling(
    eds: &Eds,
    section: Section<'_>,
    place: Place,
    keys: &ObjectKeys<'_>,
    findings: &mut Vec<Finding>,
) {
    let words = [
        Word::DefaultValue,
        Word::LowLimit,
        Word::HighLimit,
        Word::ParameterValue,
    ];
    for key in words.into_iter().filter_map(|word| keys.get(word)) {
        let (prefix, node) = (key.value.contains("0X"), key.value.contains('$'));
        if !(prefix || node) || is_text(eds, section, place) {
            continue;
        }
        if prefix {
            findings.push(Finding::new(
                &rules::UPPER_CASE_PREFIX,
                key.line,
                format!("`{}={}` starts with a capital 0X", key.name, key.value),
                "write 0x; other readers take the number for 0",
            ));
        }
        if node && !is_usual(key.value) {
            findings.push(Finding::new(
                &rules::NODE_ID,
                key.line,
                format!("`{}={}` is not as CiA 306 writes it", key.name, key.value),
                "write $NODEID first, in capitals, then + and the number, without blanks",
            ));
        }
    }
}

/// Whether a section is that of a text, or of nothing that has a value.
fn is_text(eds: &Eds, section: Section<'_>, place: Place) -> bool {
    let entry = match place {
        Place::Object(index) => eds.dictionary.object(index).and_then(|object| {
            let mut entries = object.entries.values();
            entries.rfind(|entry| entry.line == section.line)
        }),
        Place::Entry(index, sub) => eds.dictionary.entry(index, sub),
        _ => None,
    };
    entry.is_none_or(|entry| entry.line != section.line || entry.data_type.is_text())
}

fn is_usual(text: &str) -> bool {
    let rest = text.strip_prefix("$NODEID");
    let plain = |rest: &str| !rest.contains([' ', '\t', '$']);
    rest.is_some_and(|rest| rest.is_empty() || (rest.starts_with('+') && plain(rest)))
}

fn limits(eds: &Eds, object: &Object, sub: u8, entry: &Entry, findings: &mut Vec<Finding>) {
    let limits = [
        ("LowLimit", entry.low_limit),
        ("HighLimit", entry.high_limit),
    ];
    if entry.data_type.is_text() {
        for (name, _) in limits {
            if let Some(key) = eds.key_at(entry.line, name) {
                findings.push(Finding::new(
                    &rules::LIMIT_OF_TEXT,
                    key.line,
                    format!("{} is no number and has a {name}", section_of(object, sub)),
                    "remove it",
                ));
            }
        }
        return;
    }
    if entry.data_type.is_real() {
        return;
    }
    for (name, limit) in limits {
        if let (Some(limit), Some((low, high))) = (limit, range(entry.data_type))
            && !(low..=high).contains(&limit.value(1))
        {
            findings.push(Finding::new(
                &rules::LIMIT_NOT_OF_TYPE,
                eds.line_of(entry.line, name),
                format!(
                    "{name} of {} does not fit {:?}",
                    section_of(object, sub),
                    entry.data_type
                ),
                format!("{:?} goes from {low} to {high}", entry.data_type),
            ));
        }
    }
    inside(eds, object, sub, entry, findings);
}

fn inside(eds: &Eds, object: &Object, sub: u8, entry: &Entry, findings: &mut Vec<Finding>) {
    let crossed = |low: Number, high: Number| {
        [1, 127]
            .iter()
            .any(|node| low.value(*node) > high.value(*node))
    };
    if let (Some(low), Some(high)) = (entry.low_limit, entry.high_limit)
        && crossed(low, high)
    {
        findings.push(Finding::new(
            &rules::LIMITS_CROSSED,
            eds.line_of(entry.line, "LowLimit"),
            format!(
                "LowLimit of {} is above its HighLimit",
                section_of(object, sub)
            ),
            "exchange or correct them",
        ));
        return;
    }
    let Some(Default::Number(default)) = entry.default else {
        return;
    };
    let outside = entry.low_limit.is_some_and(|low| crossed(low, default))
        || entry.high_limit.is_some_and(|high| crossed(default, high));
    if outside {
        findings.push(Finding::new(
            &rules::DEFAULT_OUTSIDE,
            eds.line_of(entry.line, "DefaultValue"),
            format!(
                "the default of {} is outside its limits",
                section_of(object, sub)
            ),
            "correct the default or the limits",
        ));
    }
}

/// What a string can hold.
fn characters(eds: &Eds, object: &Object, sub: u8, entry: &Entry, findings: &mut Vec<Finding>) {
    let Some(Default::Text(text)) = &entry.default else {
        return;
    };
    let (right, wanted) = match entry.data_type {
        DataType::VisibleString => (
            text.bytes().all(|byte| matches!(byte, b' '..=b'~')),
            "a VISIBLE_STRING has the characters 20h to 7Eh; UNICODE_STRING has all",
        ),
        DataType::OctetString => (
            octets(text).is_some(),
            "write two hexadecimal digits for each byte, as in 0A FF",
        ),
        _ => return,
    };
    if !right {
        findings.push(Finding::new(
            &rules::CHARACTERS,
            eds.line_of(entry.line, "DefaultValue"),
            format!(
                "the default `{text}` of {} is no {:?}",
                section_of(object, sub),
                entry.data_type
            ),
            wanted,
        ));
    }
}

/// The lowest and the highest value of an integer type.
fn range(data_type: DataType) -> Option<(i128, i128)> {
    let bits = data_type.bits()?;
    Some(match data_type.is_signed() {
        true => (-(1_i128 << (bits - 1)), (1_i128 << (bits - 1)) - 1),
        false => (0, (1_i128 << bits) - 1),
    })
}

/// 241 to 251 are reserved.
fn transmission_type(eds: &Eds, entry: &Entry, findings: &mut Vec<Finding>) {
    let default = entry.default.as_ref().and_then(|default| default.value(1));
    if matches!(default, Some(241..=251)) {
        findings.push(Finding::new(
            &rules::TRANSMISSION_TYPE,
            eds.line_of(entry.line, "DefaultValue"),
            "the transmission types 241 to 251 are reserved",
            "write 0 to 240, or 252 to 255",
        ));
    }
    let low = entry.low_limit.map(|limit| limit.value(1));
    let high = entry.high_limit.map(|limit| limit.value(1));
    if let (Some(..=241), Some(251..)) = (low, high) {
        findings.push(Finding::new(
            &rules::TRANSMISSION_LIMITS,
            eds.line_of(entry.line, "HighLimit"),
            "the limits take in the transmission types 241 to 251, which are reserved",
            "limits cannot leave out a part: remove them, or end below 241",
        ));
    }
}

/// A SYNC message takes 47 bits at least, and the next one cannot start before.
fn cycle_period(eds: &Eds, findings: &mut Vec<Finding>) {
    const SYNC_BITS: u32 = 47;
    let Some(entry) = eds.dictionary.entry(0x1006, 0) else {
        return;
    };
    let default = entry.default.as_ref().and_then(|default| default.value(1));
    let fastest = eds
        .device_info
        .bit_rates_kbit_per_s
        .last()
        .copied()
        .unwrap_or(1000);
    let shortest_us = u64::from(SYNC_BITS) * 1000 / u64::from(fastest.max(1));
    if let Some(period) = default
        && period > 0
        && period < i128::from(shortest_us)
    {
        findings.push(Finding::new(
            &rules::CYCLE_PERIOD,
            eds.line_of(entry.line, "DefaultValue"),
            format!("1006:00 is {period} us, but a SYNC message takes {shortest_us} us at {fastest} kbit/s"),
            "1006h counts microseconds: write what the device has after a reset",
        ));
    }
}
