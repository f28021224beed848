//! The writer.

use std::fmt::Write;

use super::Eds;
use super::object_keys::Word;
use super::objects::has_value;
use super::place::{Place, place};
use crate::{DataType, Default, Entry, Number, Object};

const LISTS: [&str; 3] = ["MandatoryObjects", "OptionalObjects", "ManufacturerObjects"];

/// An EDS file that reads to the same dictionary. Sections and keys that are not about the dictionary are written as
/// they were read; what is compact becomes long, and comments are not kept.
pub fn write(eds: &Eds) -> String {
    let mut text = String::new();
    for section in eds.sections().filter(|section| is_copied(section.name)) {
        head(&mut text, section.name);
        for key in section.keys() {
            line(&mut text, key.name, key.value);
        }
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
    head(text, &format!("{:04X}", object.index));
    line(text, "ParameterName", &object.name);
    line(text, "ObjectType", &format!("0x{:X}", object.kind.code()));
    let value = object.entries.get(&0).filter(|_| has_value(object.kind));
    match value {
        Some(entry) => write_entry(text, entry),
        None => line(text, "SubNumber", &object.entries.len().to_string()),
    }
    extras(text, eds, object.line, Place::Object(object.index));
    for (sub, entry) in object.entries.iter() {
        // The name of a single value is that of its object, unless it has a section of its own.
        if *sub == 0 && value.is_some_and(|it| it.name == object.name && it.line == object.line) {
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
    for (name, value) in [
        ("DefaultValue", &entry.default),
        ("ParameterValue", &entry.parameter_value),
    ] {
        match value {
            Some(Default::Number(value)) => line(text, name, &number(*value, entry.data_type)),
            Some(Default::Text(value)) => line(text, name, value),
            None => {}
        }
    }
    if let Some(denotation) = &entry.denotation {
        line(text, "Denotation", denotation);
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

/// The keys of the section that was read for `wanted` that are not written from the dictionary.
fn extras(text: &mut String, eds: &Eds, from: usize, wanted: Place) {
    let section = eds
        .section_at(from)
        .filter(|section| place(section.name) == Some(wanted));
    let Some(section) = section else { return };
    // Where the entries have sections of their own, nothing is read from what this one says of a value.
    let head = match wanted {
        Place::Object(index) => eds.dictionary.object(index).is_some_and(|object| {
            let mut entries = object.entries.values();
            !has_value(object.kind) && entries.all(|entry| entry.line != from)
        }),
        _ => false,
    };
    for key in section.keys() {
        let written = match Word::of(key) {
            None | Some(Word::ObjFlags) => false,
            Some(
                Word::ParameterName | Word::ObjectType | Word::SubNumber | Word::CompactSubObj,
            ) => true,
            Some(_) => !head,
        };
        if !written {
            line(text, key.name, key.value);
        }
    }
}

fn head(text: &mut String, name: &str) {
    let gap = if text.is_empty() { "" } else { "\n" };
    let _ = writeln!(text, "{gap}[{name}]");
}

fn line(text: &mut String, name: &str, value: &str) {
    let _ = writeln!(text, "{name}={value}");
}
