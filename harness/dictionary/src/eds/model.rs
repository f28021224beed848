//! What an EDS file says.

use super::{DeviceInfo, Finding, Key, Section, Stray};
use crate::Dictionary;

/// What an EDS file says: typed where this crate knows a type, and every key as it stands there.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Eds {
    /// The objects.
    pub dictionary: Dictionary,
    /// The section `[DeviceInfo]`.
    pub device_info: DeviceInfo,
    /// What the reader stumbled over, in the order of the lines.
    pub findings: Vec<Finding>,
    /// Every section of the file, in its order; those that nobody knows too.
    pub sections: Vec<Section>,
    /// The lines that are neither section nor key nor comment.
    pub strays: Vec<Stray>,
}

impl Eds {
    /// The first section called `name`, in any case.
    pub fn section(&self, name: &str) -> Option<&Section> {
        self.sections.iter().find(|section| section.is(name))
    }

    /// The section that starts in `line`.
    pub(super) fn section_at(&self, line: usize) -> Option<&Section> {
        let at = self
            .sections
            .binary_search_by_key(&line, |section| section.line)
            .ok()?;
        self.sections.get(at)
    }

    /// The line of the key `name` of the section that starts in `line`; that line itself if there is no such key.
    pub(super) fn line_of(&self, line: usize, name: &str) -> usize {
        self.key_at(line, name).map_or(line, |key| key.line)
    }

    /// The key `name` of the section that starts in `line`, if it is not empty.
    pub(super) fn key_at(&self, line: usize, name: &str) -> Option<&Key> {
        let key = self.section_at(line)?.key(name)?;
        (!key.value.is_empty()).then_some(key)
    }
}
