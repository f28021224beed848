//! The lists of objects against the sections, both ways.

use std::collections::{BTreeMap, BTreeSet};

use super::super::{Eds, Finding, Section, rules};
use crate::integer::Integer;

const LISTS: [&str; 3] = ["MandatoryObjects", "OptionalObjects", "ManufacturerObjects"];
const MANDATORY: [u16; 3] = [0x1000, 0x1001, 0x1018];

/// Which list an index belongs to; `None` for the data types below 1000h.
fn list_of(index: u16) -> Option<&'static str> {
    match index {
        0..=0x0FFF => None,
        0x1000 | 0x1001 | 0x1018 => Some("MandatoryObjects"),
        0x2000..=0x5FFF => Some("ManufacturerObjects"),
        _ => Some("OptionalObjects"),
    }
}

pub(super) fn check(eds: &Eds, findings: &mut Vec<Finding>) {
    let mut listed: BTreeMap<u16, usize> = BTreeMap::new();
    for name in LISTS {
        match eds.section(name) {
            Some(section) => {
                let indices = indices(section, findings);
                for (index, line) in indices {
                    entry(eds, name, index, line, &mut listed, findings);
                }
            }
            None => missing(eds, name, findings),
        }
    }
    let line = eds
        .section("MandatoryObjects")
        .map_or(1, |section| section.line);
    for index in MANDATORY {
        if eds.dictionary.object(index).is_none() {
            findings.push(Finding::new(
                &rules::MANDATORY_OBJECT,
                line,
                format!("{index:04X} is mandatory and has no section"),
                format!("describe it in [{index:04X}] and list it in [MandatoryObjects]"),
            ));
        }
    }
    for object in eds.dictionary.objects() {
        // A list that is missing is found once, not for each of its objects.
        if let Some(list) = list_of(object.index)
            && eds.section(list).is_some()
            && !listed.contains_key(&object.index)
            && !super::is_implied(eds, object)
        {
            findings.push(Finding::new(
                &rules::NOT_LISTED,
                object.line,
                format!("[{:04X}] is in no list", object.index),
                format!("add it to [{list}]"),
            ));
        }
    }
}

fn missing(eds: &Eds, name: &str, findings: &mut Vec<Finding>) {
    let first = eds
        .dictionary
        .objects()
        .find(|object| list_of(object.index) == Some(name) && !super::is_implied(eds, object));
    let what = match first {
        Some(object) => format!(
            "[{name}] is missing, but [{:04X}] belongs there",
            object.index
        ),
        None if name == "MandatoryObjects" => format!("[{name}] is missing"),
        None => return,
    };
    findings.push(Finding::new(
        &rules::MISSING_LIST,
        first.map_or(1, |object| object.line),
        what,
        format!("add [{name}] with SupportedObjects and the indices"),
    ));
}

/// The indices of a list with their lines.
fn indices(section: Section<'_>, findings: &mut Vec<Finding>) -> Vec<(u16, usize)> {
    let mut indices = Vec::new();
    let mut numbers = BTreeSet::new();
    let mut entries = 0;
    for key in section.keys() {
        let Ok(number) = key.name.parse::<u32>() else {
            continue;
        };
        entries += 1;
        numbers.insert(number);
        match Integer::parse(key.value).and_then(|number| u16::try_from(number.value).ok()) {
            Some(index) => indices.push((index, key.line)),
            None => findings.push(Finding::losing(
                &rules::LIST_ENTRY,
                key.line,
                format!("`{}={}` is no index", key.name, key.value),
                "write an index such as 0x1000",
            )),
        }
    }
    count(section, entries, &numbers, findings);
    indices
}

fn count(
    section: Section<'_>,
    entries: i128,
    numbers: &BTreeSet<u32>,
    findings: &mut Vec<Finding>,
) {
    let key = section.key("SupportedObjects");
    let said = key.and_then(|key| Integer::parse(key.value));
    let line = key.map_or(section.line, |key| key.line);
    let text = match (said, key) {
        (Some(said), _) if said.value == entries => {
            // The numbers 1 to N must be there, each of them.
            let gap = (1..)
                .zip(numbers)
                .find(|(wanted, number)| wanted != *number);
            match gap {
                Some((gap, _)) => format!("[{}] has no entry {gap}", section.name),
                None => return,
            }
        }
        (Some(said), Some(key)) => format!(
            "SupportedObjects={} is {}, but [{}] has {entries} entries",
            key.value, said.value, section.name
        ),
        (_, Some(key)) => format!("SupportedObjects={} is no number", key.value),
        (_, None) => format!("[{}] has no SupportedObjects", section.name),
    };
    findings.push(Finding::new(
        &rules::LIST_COUNT,
        line,
        text,
        format!("number the entries from 1 and write SupportedObjects={entries}"),
    ));
}

fn entry(
    eds: &Eds,
    name: &str,
    index: u16,
    line: usize,
    listed: &mut BTreeMap<u16, usize>,
    findings: &mut Vec<Finding>,
) {
    let first = *listed.entry(index).or_insert(line);
    if first != line {
        findings.push(Finding::new(
            &rules::LISTED_TWICE,
            line,
            format!("{index:04X} is listed in line {first} already"),
            "remove one of the two",
        ));
    }
    if let Some(right) = list_of(index)
        && right != name
    {
        findings.push(Finding::new(
            &rules::WRONG_LIST,
            line,
            format!("{index:04X} does not belong in [{name}]"),
            format!("move it to [{right}]"),
        ));
    }
    if eds.dictionary.object(index).is_none() {
        findings.push(Finding::new(
            &rules::LISTED_WITHOUT_SECTION,
            line,
            format!("{index:04X} is listed, but there is no [{index:04X}]"),
            "describe it, or remove it from the list",
        ));
    }
}
