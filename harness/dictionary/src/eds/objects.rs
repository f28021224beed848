//! The sections `[XXXX]` and `[XXXXsubY]`: objects and their entries.

use std::collections::BTreeMap;

use super::place::{Place, place};
use super::{Finding, Section, field, rules};
use crate::{Access, DataType, Default, Dictionary, Entry, Number, Object, ObjectKind};

pub(super) fn read(sections: &[Section], findings: &mut Vec<Finding>) -> Dictionary {
    let mut objects: BTreeMap<u16, Object> = BTreeMap::new();
    for section in sections {
        if let Some(Place::Object(index)) = place(&section.name) {
            match objects.get(&index) {
                Some(first) => findings.push(repeated(section, first.line)),
                None => {
                    objects.insert(index, object(index, section, findings));
                }
            }
        }
    }
    let mut lines: BTreeMap<(u16, u8), usize> = BTreeMap::new();
    for section in sections {
        if let Some(Place::Entry(index, sub)) = place(&section.name) {
            let first = *lines.entry((index, sub)).or_insert(section.line);
            if first != section.line {
                findings.push(repeated(section, first));
                continue;
            }
            let object = objects
                .entry(index)
                .or_insert_with(|| orphan(index, section, findings));
            // An entry of its own says more than what the object's section implies.
            object.entries.insert(sub, entry(section, findings));
        }
    }
    objects.into_values().collect()
}

fn object(index: u16, section: &Section, findings: &mut Vec<Finding>) -> Object {
    let code = field::unsigned(section, "ObjectType", findings).unwrap_or(7);
    let kind = ObjectKind::from_code(code);
    let mut entries = BTreeMap::new();
    let compact: Option<u8> = field::unsigned(section, "CompactSubObj", findings);
    match (kind, compact) {
        (ObjectKind::Array | ObjectKind::Record, Some(count)) if count > 0 => {
            entries = compact_entries(section, count, findings);
        }
        (ObjectKind::Variable | ObjectKind::Domain | ObjectKind::DefType, _) => {
            entries.insert(0, entry(section, findings));
        }
        _ => {}
    }
    Object {
        index,
        name: field::text(section, "ParameterName").unwrap_or_default(),
        kind,
        entries,
        line: section.line,
    }
}

/// An object whose entries have sections while it has none.
fn orphan(index: u16, section: &Section, findings: &mut Vec<Finding>) -> Object {
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
        entries: BTreeMap::new(),
        line: section.line,
    }
}

/// `CompactSubObj=N`: entries 1 to N are as the object's section says, entry 0 counts them.
fn compact_entries(
    section: &Section,
    count: u8,
    findings: &mut Vec<Finding>,
) -> BTreeMap<u8, Entry> {
    let number = Entry {
        name: "NrOfObjects".to_owned(),
        data_type: DataType::Unsigned8,
        access: Access::ReadOnly,
        low_limit: None,
        high_limit: None,
        default: Some(Default::Number(Number::absolute(i128::from(count)))),
        pdo_mapping: false,
        line: section.line,
    };
    let every = entry(section, findings);
    let each = (1..=count).map(|sub| {
        let name = format!("{}{sub}", every.name);
        (
            sub,
            Entry {
                name,
                ..every.clone()
            },
        )
    });
    std::iter::once((0, number)).chain(each).collect()
}

fn entry(section: &Section, findings: &mut Vec<Finding>) -> Entry {
    let data_type = data_type(section, findings);
    Entry {
        name: field::text(section, "ParameterName").unwrap_or_default(),
        data_type,
        access: access(section, findings),
        low_limit: field::limit(section, "LowLimit", data_type, findings),
        high_limit: field::limit(section, "HighLimit", data_type, findings),
        default: field::default(section, "DefaultValue", data_type, findings),
        pdo_mapping: field::flag(section, "PDOMapping", findings).unwrap_or(false),
        line: section.line,
    }
}

fn data_type(section: &Section, findings: &mut Vec<Finding>) -> DataType {
    match field::unsigned(section, "DataType", findings) {
        Some(code) => DataType::from_code(code),
        None => {
            let domain = field::key(section, "ObjectType").is_some_and(|key| {
                crate::integer::Integer::parse(&key.value).is_some_and(|code| code.value == 2)
            });
            if domain {
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

fn access(section: &Section, findings: &mut Vec<Finding>) -> Access {
    let key = field::key(section, "AccessType");
    key.and_then(|key| Access::from_word(&key.value))
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

pub(super) fn repeated(section: &Section, first: usize) -> Finding {
    Finding::losing(
        &rules::REPEATED_SECTION,
        section.line,
        format!("[{}] is there a second time", section.name),
        format!("the one in line {first} counts"),
    )
}
