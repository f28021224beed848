//! The reader: keeps going, reports everything, loses nothing.

use std::collections::BTreeMap;

use super::finding::Finding;
use super::place::{Place, place};
use super::{Eds, Section, commissioning, compact, device_info, objects, rules};
use crate::ini::{self, Sections};

/// The text of a file: UTF-8 if it is that, else ISO 8859-1, in which every byte is a character.
pub fn decode(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|byte| char::from(*byte)).collect(),
    }
}

/// Reads an EDS or DCF file.
pub fn read(text: &str) -> Eds {
    let (sections, strays) = ini::parse(text);
    let mut findings: Vec<Finding> = strays
        .iter()
        .map(|stray| {
            Finding::losing(
                &rules::STRAY_LINE,
                stray.line,
                format!("`{}` is no section and no key of one", stray.text),
                "the line is ignored; a comment starts with `;`",
            )
        })
        .collect();
    repeated_keys(&sections, &mut findings);
    repeated_sections(&sections, &mut findings);
    let device_info = device_info::read(&sections, &mut findings);
    let commissioning = commissioning::read(&sections, &mut findings);
    let mut objects = objects::read(&sections, &mut findings);
    compact::apply_lists(&sections, &mut objects, &mut findings);
    compact::add_pdos(&sections, &device_info, &mut objects);
    findings.sort_by_key(|finding| finding.line);
    Eds {
        dictionary: objects.into_values().collect(),
        device_info,
        commissioning,
        findings,
        strays,
        sections,
    }
}

/// Objects and entries are looked at where they are read.
fn repeated_sections(sections: &Sections, findings: &mut Vec<Finding>) {
    let mut names: BTreeMap<String, usize> = BTreeMap::new();
    for section in sections.iter() {
        if let Some(Place::Object(_) | Place::Entry(..)) = place(section.name) {
            continue;
        }
        let name = section.name.to_ascii_lowercase();
        let first = *names.entry(name).or_insert(section.line);
        if first != section.line {
            findings.push(objects::repeated(section, first));
        }
    }
}

fn repeated_keys(sections: &Sections, findings: &mut Vec<Finding>) {
    for section in sections.iter().filter(|section| may_repeat(*section)) {
        let mut lines = BTreeMap::new();
        for key in section.keys() {
            let name = key.name.to_ascii_lowercase();
            let first = *lines.entry(name).or_insert(key.line);
            if first != key.line {
                findings.push(Finding::losing(
                    &rules::REPEATED_KEY,
                    key.line,
                    format!("`{}` is a second time in [{}]", key.name, section.name),
                    format!("the one in line {first} counts"),
                ));
            }
        }
    }
}

/// Few sections repeat a key, and most are so short that comparing all pairs is quicker than a map.
fn may_repeat(section: Section<'_>) -> bool {
    const SHORT: usize = 16;
    let keys = section.keys();
    keys.len() > SHORT
        || keys.clone().enumerate().any(|(at, key)| {
            let mut before = keys.clone().take(at);
            before.any(|before| before.name.eq_ignore_ascii_case(key.name))
        })
}
