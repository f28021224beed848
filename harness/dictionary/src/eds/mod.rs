//! EDS and DCF files (CiA 306), read liberally.
//!
//! Line ends, the case of keys and words, the base of numbers, the order of sections and blanks do not matter.
//! `SubNumber` and the object lists are not trusted: an entry exists if it has a section. What the reader cannot use
//! becomes a [`Finding`].

mod device_info;
mod field;
mod objects;

pub use device_info::DeviceInfo;

use crate::{Dictionary, ini};

/// What an EDS file says.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Eds {
    /// The objects.
    pub dictionary: Dictionary,
    /// The section `[DeviceInfo]`.
    pub device_info: DeviceInfo,
    /// What the reader stumbled over, in the order of the lines.
    pub findings: Vec<Finding>,
}

/// Something in the file that is not as it should be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// The line, from 1.
    pub line: usize,
    /// What is wrong, with the text in question.
    pub text: String,
    /// What was done about it, or what to write instead.
    pub help: String,
    /// Whether something that the file says did not get into the result.
    pub lost: bool,
}

/// Reads an EDS or DCF file.
pub fn read(text: &str) -> Eds {
    let (sections, strays) = ini::parse(text);
    let mut findings: Vec<Finding> = strays
        .iter()
        .map(|stray| Finding {
            line: stray.line,
            text: format!("`{}` is no section and no key of one", stray.text),
            help: "the line is ignored; a comment starts with `;`".to_owned(),
            lost: true,
        })
        .collect();
    repeated_keys(&sections, &mut findings);
    let device_info = device_info::read(&sections, &mut findings);
    let dictionary = objects::read(&sections, &mut findings);
    findings.sort_by_key(|finding| finding.line);
    Eds {
        dictionary,
        device_info,
        findings,
    }
}

fn repeated_keys(sections: &[ini::Section<'_>], findings: &mut Vec<Finding>) {
    for section in sections {
        let mut names = std::collections::BTreeMap::new();
        for key in &section.keys {
            let first = *names
                .entry(key.name.to_ascii_lowercase())
                .or_insert(key.line);
            if first != key.line {
                findings.push(Finding {
                    line: key.line,
                    text: format!("`{}` is a second time in [{}]", key.name, section.name),
                    help: format!("the one in line {first} counts"),
                    lost: true,
                });
            }
        }
    }
}
