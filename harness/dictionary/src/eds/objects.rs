//! The sections `[XXXX]` and `[XXXXsubY]`: objects and their entries.

use std::collections::BTreeMap;

use super::object_keys::{ObjectKeys, Word};
use super::place::{Place, place};
use super::{Finding, Section, compact, field, rules};
use crate::ini::Sections;
use crate::integer::Integer;
use crate::{Access, DataType, Entries, Entry, Object, ObjectKind};

pub(super) fn read(sections: &Sections, findings: &mut Vec<Finding>) -> BTreeMap<u16, Object> {
    let mut objects: BTreeMap<u16, Object> = BTreeMap::new();
    let mut later = Vec::new();
    for section in sections.iter() {
        match place(section.name) {
            Some(Place::Object(index)) => match objects.get(&index) {
                Some(first) => findings.push(repeated(section, first.line)),
                None => {
                    objects.insert(index, object(index, section, findings));
                }
            },
            // Its object may come after it.
            Some(Place::Entry(index, sub)) => later.push((index, sub, section)),
            _ => {}
        }
    }
    let mut lines: BTreeMap<(u16, u8), usize> = BTreeMap::new();
    for (index, sub, section) in later {
        let first = *lines.entry((index, sub)).or_insert(section.line);
        if first != section.line {
            findings.push(repeated(section, first));
            continue;
        }
        let object = objects
            .entry(index)
            .or_insert_with(|| orphan(index, section, findings));
        // An entry of its own says more than what the object's section implies.
        let keys = ObjectKeys::of(section);
        let name = field::text(keys.get(Word::ParameterName)).unwrap_or_default();
        object
            .entries
            .insert(sub, entry(section, &keys, name, findings));
    }
    objects
}

fn object(index: u16, section: Section<'_>, findings: &mut Vec<Finding>) -> Object {
    let keys = ObjectKeys::of(section);
    let name = field::text(keys.get(Word::ParameterName)).unwrap_or_default();
    let code = field::unsigned(keys.get(Word::ObjectType), findings).unwrap_or(7);
    let kind = ObjectKind::from_code(code);
    let mut entries = Entries::default();
    let count: Option<u8> = field::unsigned(keys.get(Word::CompactSubObj), findings);
    if has_value(kind) {
        entries.insert(0, entry(section, &keys, name.clone(), findings));
    } else if let (ObjectKind::Array | ObjectKind::Record, Some(count @ 1..)) = (kind, count) {
        entries = compact::entries(&entry(section, &keys, name.clone(), findings), count);
    }
    Object {
        index,
        name,
        kind,
        entries,
        line: section.line,
    }
}

/// Whether the section of an object of this kind describes a value.
pub(super) fn has_value(kind: ObjectKind) -> bool {
    matches!(
        kind,
        ObjectKind::Variable | ObjectKind::Domain | ObjectKind::DefType
    )
}

/// An object whose entries have sections while it has none.
fn orphan(index: u16, section: Section<'_>, findings: &mut Vec<Finding>) -> Object {
    findings.push(Finding::new(
        &rules::ORPHAN,
        section.line,
        format!("[{}] belongs to an object without a section", section.name),
        format!("taken as a record; add [{index:04X}]"),
    ));
    Object {
        index,
        name: String::new(),
        kind: ObjectKind::Record,
        entries: Entries::default(),
        line: section.line,
    }
}

fn entry(
    section: Section<'_>,
    keys: &ObjectKeys<'_>,
    name: String,
    findings: &mut Vec<Finding>,
) -> Entry {
    let data_type = data_type(section, keys, findings);
    Entry {
        name,
        data_type,
        access: access(section, keys, findings),
        low_limit: field::limit(keys.get(Word::LowLimit), data_type, findings),
        high_limit: field::limit(keys.get(Word::HighLimit), data_type, findings),
        default: field::default(keys.get(Word::DefaultValue), data_type, findings),
        parameter_value: field::default(keys.get(Word::ParameterValue), data_type, findings),
        denotation: field::text(keys.get(Word::Denotation)),
        pdo_mapping: field::flag(keys.get(Word::PdoMapping), findings).unwrap_or(false),
        line: section.line,
    }
}

fn data_type(section: Section<'_>, keys: &ObjectKeys<'_>, findings: &mut Vec<Finding>) -> DataType {
    match field::unsigned(keys.get(Word::DataType), findings) {
        Some(code) => DataType::from_code(code),
        None => {
            let kind = keys.get(Word::ObjectType);
            let kind = kind.and_then(|key| Integer::parse(key.value));
            if kind.is_some_and(|code| code.value == 2) {
                return DataType::Domain;
            }
            findings.push(Finding::new(
                &rules::DATA_TYPE,
                section.line,
                format!("[{}] has no DataType that can be read", section.name),
                "its values have no size; add the DataType",
            ));
            DataType::Unknown(0)
        }
    }
}

fn access(section: Section<'_>, keys: &ObjectKeys<'_>, findings: &mut Vec<Finding>) -> Access {
    let key = keys.get(Word::AccessType);
    key.and_then(|key| Access::from_word(key.value))
        .unwrap_or_else(|| {
            findings.push(Finding {
                rule: &rules::ACCESS_TYPE,
                line: key.map_or(section.line, |key| key.line),
                text: match key {
                    Some(key) => format!("`{}` is no access type", key.value),
                    None => format!("[{}] has no AccessType", section.name),
                },
                help: "read as rw; the words are ro, wo, rw, rwr, rww and const".to_owned(),
                lost: key.is_some(),
            });
            Access::ReadWrite
        })
}

pub(super) fn repeated(section: Section<'_>, first: usize) -> Finding {
    Finding::losing(
        &rules::REPEATED_SECTION,
        section.line,
        format!("[{}] is there a second time", section.name),
        format!("the one in line {first} counts"),
    )
}
