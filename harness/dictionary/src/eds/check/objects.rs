//! The sections of objects: names, types, sub-indices.

use super::super::object_keys::{ObjectKeys, Word};
use super::super::place::{Place, place};
use super::super::{Eds, Finding, Section, rules};
use super::{at, has_sections, section_of, standard, values};
use crate::integer::Integer;
use crate::{DataType, Entry, Object, ObjectKind};

pub(super) fn check(eds: &Eds, findings: &mut Vec<Finding>) {
    for section in eds.sections() {
        match place(section.name) {
            Some(place @ (Place::Object(_) | Place::Entry(..))) => {
                let keys = ObjectKeys::of(section);
                name(section, &keys, findings);
                object_type(section, place, &keys, findings);
                flags(&keys, findings);
                values::spelling(eds, section, place, &keys, findings);
            }
            Some(Place::Links(_)) => {
                links(eds, section, findings);
                list_of_object(section, "ObjectLinks", findings);
            }
            Some(Place::Names(_) | Place::Values(_) | Place::Denotations(_)) => {
                list_of_object(section, "NrOfEntries", findings);
            }
            None => {}
        }
    }
    let profile = standard::profile(&eds.dictionary);
    for object in eds.dictionary.objects() {
        if super::is_implied(eds, object) {
            continue;
        }
        match has_sections(object) {
            true => structure(eds, object, findings),
            false => single(eds, object, findings),
        }
        for (sub, entry) in object.entries.iter() {
            data_type(eds, object, *sub, entry, profile, findings);
        }
        reserved(object, findings);
        special_subs(eds, object, findings);
    }
}

fn flags(keys: &ObjectKeys<'_>, findings: &mut Vec<Finding>) {
    if let Some(key) = keys.get(Word::ObjFlags)
        && Integer::parse(key.value).is_none_or(|flags| !matches!(flags.value, 0..=3))
    {
        findings.push(Finding::new(
            &rules::OBJ_FLAGS,
            key.line,
            format!("`{}={}` has other bits than 0 and 1", key.name, key.value),
            "write 0, or the sum of 1 (not to be written by a tool) and 2 (not to be read)",
        ));
    }
}

/// The count of a list against its numbered keys.
fn list_of_object(section: Section<'_>, count: &str, findings: &mut Vec<Finding>) {
    let key = section.filled(count);
    let said = key.and_then(|key| Integer::parse(key.value));
    let present = section
        .keys()
        .filter(|key| key.name.parse::<u32>().is_ok())
        .count();
    if said.and_then(|said| usize::try_from(said.value).ok()) != Some(present) {
        findings.push(Finding::new(
            &rules::LIST_OF_OBJECT,
            key.map_or(section.line, |key| key.line),
            format!(
                "[{}] has {present} entries and says otherwise",
                section.name
            ),
            format!("write {count}={present}"),
        ));
    }
}

fn name(section: Section<'_>, keys: &ObjectKeys<'_>, findings: &mut Vec<Finding>) {
    let Some(key) = keys.get(Word::ParameterName) else {
        findings.push(Finding::new(
            &rules::NAME_MISSING,
            section.line,
            format!("[{}] has no ParameterName", section.name),
            "add it",
        ));
        return;
    };
    if key.value.ends_with(';') {
        findings.push(Finding::new(
            &rules::NAME_SEMICOLON,
            key.line,
            format!("the name `{}` ends in a semicolon", key.value),
            "remove it; a comment stands in a line of its own, and other readers keep the semicolon",
        ));
    }
    if key.value.contains("  ") {
        findings.push(Finding::new(
            &rules::NAME_BLANKS,
            key.line,
            format!("the name `{}` has two blanks in a row", key.value),
            "write one",
        ));
    }
}

fn object_type(
    section: Section<'_>,
    place: Place,
    keys: &ObjectKeys<'_>,
    findings: &mut Vec<Finding>,
) {
    // CiA 306 lets an entry without ObjectType be a variable.
    let Some(key) = keys.get(Word::ObjectType) else {
        return;
    };
    let Some(code) = Integer::parse(key.value) else {
        return;
    };
    let legal = matches!(code.value, 0 | 2 | 5..=9);
    let entry = matches!(place, Place::Entry(..));
    if !legal || (entry && !matches!(code.value, 0 | 2 | 5 | 7)) {
        findings.push(Finding::new(
            &rules::OBJECT_TYPE,
            key.line,
            format!(
                "`ObjectType={}` is no object type for [{}]",
                key.value, section.name
            ),
            match entry {
                true => "a sub-index is a variable (7) or a domain (2)",
                false => "a variable is 7, an array 8, a record 9, a domain 2",
            },
        ));
    }
}

fn links(eds: &Eds, section: Section<'_>, findings: &mut Vec<Finding>) {
    for key in section.keys() {
        let index = Integer::parse(key.value).and_then(|number| u16::try_from(number.value).ok());
        if key.name.parse::<u32>().is_ok()
            && index.is_none_or(|index| eds.dictionary.object(index).is_none())
        {
            findings.push(Finding::new(
                &rules::OBJECT_LINK,
                key.line,
                format!("`{}={}` links to no object", key.name, key.value),
                "write the index of an object that the file describes",
            ));
        }
    }
}

fn single(eds: &Eds, object: &Object, findings: &mut Vec<Finding>) {
    if let Some(key) = eds.key_at(object.line, "CompactSubObj")
        && Integer::parse(key.value).is_some_and(|count| count.value > 0)
    {
        findings.push(Finding::new(
            &rules::COMPACT_KIND,
            key.line,
            format!("[{:04X}] is compact, but no array or record", object.index),
            "write ObjectType=8 or 9, or remove CompactSubObj",
        ));
    }
    if let Some((sub, entry)) = object.entries.iter().find(|(sub, _)| **sub > 0) {
        findings.push(Finding::new(
            &rules::OBJECT_TYPE,
            entry.line,
            format!(
                "[{:04X}] has sub-index {sub:X}h, but is no array or record",
                object.index
            ),
            "write ObjectType=9 for the object, or remove the sub-index",
        ));
    }
}

fn structure(eds: &Eds, object: &Object, findings: &mut Vec<Finding>) {
    let compact = eds
        .key_at(object.line, "CompactSubObj")
        .and_then(|key| Integer::parse(key.value))
        .is_some_and(|count| count.value > 0);
    let section = eds.section_at(object.line);
    if section.is_some_and(|section| place(section.name) == Some(Place::Object(object.index))) {
        sub_number(eds, object, compact, findings);
    }
    let Some(count) = object.entries.get(&0) else {
        findings.push(Finding::new(
            &rules::SUB_0,
            object.line,
            format!("[{:04X}] has no sub-index 0", object.index),
            format!("add [{:04X}sub0] with DataType=0x0005", object.index),
        ));
        return;
    };
    if count.data_type != DataType::Unsigned8 {
        findings.push(Finding::new(
            &rules::SUB_0,
            eds.line_of(count.line, "DataType"),
            format!("sub-index 0 of [{:04X}] is no UNSIGNED8", object.index),
            "write DataType=0x0005",
        ));
    }
    highest_sub(eds, object, count, findings);
}

fn sub_number(eds: &Eds, object: &Object, compact: bool, findings: &mut Vec<Finding>) {
    let key = eds.key_at(object.line, "SubNumber");
    let said = key
        .and_then(|key| Integer::parse(key.value))
        .map(|number| number.value);
    let present = object.entries.len();
    if compact {
        if said.is_some_and(|said| said > 0) {
            findings.push(Finding::new(
                &rules::COMPACT_AND_SUB_NUMBER,
                eds.line_of(object.line, "SubNumber"),
                format!("[{:04X}] has SubNumber and CompactSubObj", object.index),
                "remove SubNumber",
            ));
        }
        return;
    }
    let text = match (said, key) {
        (Some(said), _) if usize::try_from(said) == Ok(present) => return,
        (_, Some(key)) => format!(
            "SubNumber={}, but [{:04X}] has {present} sub-indices",
            key.value, object.index
        ),
        // Nothing is there to be counted by a section that another key would have brought.
        (_, None) => format!("[{:04X}] has no SubNumber", object.index),
    };
    findings.push(Finding::new(
        &rules::SUB_NUMBER,
        eds.line_of(object.line, "SubNumber"),
        text,
        format!("write SubNumber={present}; sub-index 0 counts, and section names are hexadecimal"),
    ));
}

/// The default of sub-index 0, except where it counts what is in use: mappings, the error field, a program's data.
fn highest_sub(eds: &Eds, object: &Object, count: &Entry, findings: &mut Vec<Finding>) {
    let Some(default) = count.default.as_ref().and_then(|default| default.value(1)) else {
        return;
    };
    let highest = object
        .entries
        .keys()
        .rev()
        .copied()
        .find(|sub| *sub < 0xFF)
        .unwrap_or(0);
    let in_use = object.index == 0x1003 || standard::is_mapping(object.index);
    let wrong = match in_use {
        // FEh and FFh in a mapping say that it is a multiplex PDO.
        true => default > i128::from(highest) && !matches!(default, 0xFE | 0xFF),
        false => default != i128::from(highest),
    };
    if wrong {
        findings.push(Finding::new(
            &rules::HIGHEST_SUB,
            eds.line_of(count.line, "DefaultValue"),
            format!(
                "sub-index 0 of [{:04X}] is {default}, but the highest sub-index is {highest} ({highest:X}h)",
                object.index
            ),
            format!("write DefaultValue={highest}, or describe the sub-indices that are missing"),
        ));
    }
}

fn data_type(
    eds: &Eds,
    object: &Object,
    sub: u8,
    entry: &Entry,
    profile: Option<u16>,
    findings: &mut Vec<Finding>,
) {
    let line = || eds.line_of(entry.line, "DataType");
    if let DataType::Unknown(code @ (1..=0x1F | 0x1000..)) = entry.data_type {
        findings.push(Finding::new(
            &rules::DATA_TYPE,
            line(),
            format!(
                "{} has data type {code:#06X}, which is none",
                section_of(object, sub)
            ),
            "write the index of a data type of CiA 301",
        ));
    }
    if let Some(wanted) = standard::data_type(object.index, sub, profile)
        && entry.data_type != wanted
        && entry.data_type != DataType::Unknown(0)
    {
        findings.push(Finding::new(
            &rules::STANDARD_TYPE,
            line(),
            format!(
                "{} is {:?}, but the standard has {wanted:?} there",
                at(object.index, sub),
                entry.data_type
            ),
            format!(
                "write DataType={:#06X} if the device does as the standard says",
                wanted.code()
            ),
        ));
    }
}

fn special_subs(eds: &Eds, object: &Object, findings: &mut Vec<Finding>) {
    let structure = object.entries.get(&0xFF).filter(|_| has_sections(object));
    if let Some(entry) = structure
        && (entry.data_type != DataType::Unsigned32 || entry.access.writable())
    {
        findings.push(Finding::new(
            &rules::SUB_FF,
            entry.line,
            format!(
                "{} is {:?} and {}",
                at(object.index, 0xFF),
                entry.data_type,
                entry.access.word()
            ),
            "write DataType=0x0007 and AccessType=const, or ro",
        ));
    }
    if object.index == 0x1018
        && eds.device_info.lss_supported == Some(true)
        && let Some(missing) = (1..=4).find(|sub| object.entries.get(sub).is_none())
    {
        findings.push(Finding::new(
            &rules::LSS_ADDRESS,
            object.line,
            format!("the device has LSS, but no {}", at(0x1018, missing)),
            "describe vendor, product, revision and serial number, or write LSS_Supported=0",
        ));
    }
}

fn reserved(object: &Object, findings: &mut Vec<Finding>) {
    let parameters = matches!(object.index, 0x1400..=0x15FF | 0x1800..=0x19FF);
    if parameters
        && object.kind == ObjectKind::Record
        && let Some(entry) = object.entries.get(&4)
    {
        findings.push(Finding::new(
            &rules::RESERVED_SUB,
            entry.line,
            format!("{} is reserved", at(object.index, 4)),
            "remove it; reading it should give abort code 06090011h",
        ));
    }
}
