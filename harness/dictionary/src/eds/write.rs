//! The writer.

use std::fmt::Write;

use super::place::{Place, place};
use super::{Eds, Key, Section};
use crate::{DataType, Default, Entry, Number, Object, ObjectKind};

const LISTS: [&str; 3] = ["MandatoryObjects", "OptionalObjects", "ManufacturerObjects"];

/// Keys that are written from the dictionary.
const TYPED: [&str; 10] = [
    "ParameterName",
    "ObjectType",
    "SubNumber",
    "CompactSubObj",
    "DataType",
    "AccessType",
    "LowLimit",
    "HighLimit",
    "DefaultValue",
    "PDOMapping",
];

/// An EDS file that reads to the same dictionary. Sections and keys that are not about the dictionary are written as
/// they were read; what is compact becomes long, and comments are not kept.
pub fn write(eds: &Eds) -> String {
    let mut text = String::new();
    for section in eds
        .sections
        .iter()
        .filter(|section| is_copied(&section.name))
    {
        head(&mut text, &section.name);
        section
            .keys
            .iter()
            .for_each(|key| line(&mut text, &key.name, &key.value));
    }
    for (at, list) in LISTS.iter().enumerate() {
        let indices: Vec<u16> = eds
            .dictionary
            .objects()
            .map(|object| object.index)
            .filter(|index| list_of(*index) == Some(at))
            .collect();
        head(&mut text, list);
        line(&mut text, "SupportedObjects", &indices.len().to_string());
        for (number, index) in indices.iter().enumerate() {
            line(
                &mut text,
                &(number + 1).to_string(),
                &format!("0x{index:04X}"),
            );
        }
    }
    for object in eds.dictionary.objects() {
        write_object(&mut text, eds, object);
    }
    text
}

/// Whether a section says nothing that the dictionary says.
fn is_copied(name: &str) -> bool {
    let list = LISTS.iter().any(|list| list.eq_ignore_ascii_case(name));
    !list && matches!(place(name), None | Some(Place::Links(_)))
}

fn list_of(index: u16) -> Option<usize> {
    match index {
        0..=0x0FFF => None,
        0x1000 | 0x1001 | 0x1018 => Some(0),
        0x2000..=0x5FFF => Some(2),
        _ => Some(1),
    }
}

fn write_object(text: &mut String, eds: &Eds, object: &Object) {
    let own = [
        ObjectKind::Variable,
        ObjectKind::Domain,
        ObjectKind::DefType,
    ]
    .contains(&object.kind);
    head(text, &format!("{:04X}", object.index));
    line(text, "ParameterName", &object.name);
    line(text, "ObjectType", &format!("0x{:X}", object.kind.code()));
    let value = object.entries.get(&0).filter(|_| own);
    match value {
        Some(entry) => write_entry(text, entry),
        None => line(text, "SubNumber", &object.entries.len().to_string()),
    }
    extras(text, eds, object.line, Place::Object(object.index));
    for (sub, entry) in &object.entries {
        // The name of a single value is that of its object, unless it has a section of its own.
        if *sub == 0 && value.is_some_and(|entry| entry.name == object.name) {
            continue;
        }
        head(text, &format!("{:04X}sub{sub:X}", object.index));
        line(text, "ParameterName", &entry.name);
        line(text, "ObjectType", "0x7");
        write_entry(text, entry);
        extras(text, eds, entry.line, Place::Entry(object.index, *sub));
    }
}

fn write_entry(text: &mut String, entry: &Entry) {
    if entry.data_type != DataType::Unknown(0) {
        line(
            text,
            "DataType",
            &format!("0x{:04X}", entry.data_type.code()),
        );
    }
    line(text, "AccessType", entry.access.word());
    for (name, limit) in [
        ("LowLimit", entry.low_limit),
        ("HighLimit", entry.high_limit),
    ] {
        if let Some(limit) = limit {
            line(text, name, &number(limit, entry.data_type));
        }
    }
    match &entry.default {
        Some(Default::Number(value)) => {
            line(text, "DefaultValue", &number(*value, entry.data_type))
        }
        Some(Default::Text(value)) => line(text, "DefaultValue", value),
        None => {}
    }
    line(
        text,
        "PDOMapping",
        if entry.pdo_mapping { "1" } else { "0" },
    );
}

/// Signed types in decimal, for in hexadecimal they would be bit patterns.
fn number(number: Number, data_type: DataType) -> String {
    let offset = match data_type.is_signed() || number.offset < 0 {
        true => number.offset.to_string(),
        false => format!("0x{:X}", number.offset),
    };
    match number.relative_to_node {
        true => format!("$NODEID+{offset}"),
        false => offset,
    }
}

/// Keys that nobody here has a type for, from the section that was read for `wanted`.
fn extras(text: &mut String, eds: &Eds, from: usize, wanted: Place) {
    let section = eds
        .section_at(from)
        .filter(|section| place(&section.name) == Some(wanted));
    let untyped = |key: &&Key| !TYPED.iter().any(|typed| key.is(typed));
    let keys = section.map_or(&[][..], |section: &Section| &section.keys);
    for key in keys.iter().filter(untyped) {
        line(text, &key.name, &key.value);
    }
}

fn head(text: &mut String, name: &str) {
    let gap = if text.is_empty() { "" } else { "\n" };
    let _ = writeln!(text, "{gap}[{name}]");
}

fn line(text: &mut String, name: &str, value: &str) {
    let _ = writeln!(text, "{name}={value}");
}
