//! The reader: keeps going, reports everything, loses nothing.

use std::collections::BTreeMap;

use super::finding::Finding;
use super::{Eds, Section, device_info, objects, rules};
use crate::ini;

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
    let dictionary = objects::read(&sections, &mut findings);
    findings.sort_by_key(|finding| finding.line);
    Eds {
        dictionary,
        device_info,
        findings,
        sections,
        strays,
    }
}

/// Objects and entries are looked at where they are read.
fn repeated_sections(sections: &[Section], findings: &mut Vec<Finding>) {
    let mut names: BTreeMap<String, usize> = BTreeMap::new();
    for section in sections {
        if super::place::place(&section.name).is_some() {
            continue;
        }
        let name = section.name.to_ascii_lowercase();
        let first = *names.entry(name).or_insert(section.line);
        if first != section.line {
            findings.push(objects::repeated(section, first));
        }
    }
}

fn repeated_keys(sections: &[Section], findings: &mut Vec<Finding>) {
    for section in sections.iter().filter(|section| may_repeat(section)) {
        let mut lines = BTreeMap::new();
        for key in &section.keys {
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
fn may_repeat(section: &Section) -> bool {
    const SHORT: usize = 16;
    section.keys.len() > SHORT
        || section.keys.iter().enumerate().any(|(at, key)| {
            let mut before = section.keys.iter().take(at);
            before.any(|before| before.name.eq_ignore_ascii_case(&key.name))
        })
}
