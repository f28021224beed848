//! What an EDS file says.

use super::{Commissioning, DeviceInfo, Finding, Key, Section, Stray};
use crate::Dictionary;
use crate::ini::Sections;

/// What an EDS file says: typed where this crate knows a type, and every key as it stands there.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Eds {
    /// The objects.
    pub dictionary: Dictionary,
    /// The section `[DeviceInfo]`.
    pub device_info: DeviceInfo,
    /// The section `[DeviceComissioning]`, which makes the file a DCF.
    pub commissioning: Option<Commissioning>,
    /// What the reader stumbled over, in the order of the lines.
    pub findings: Vec<Finding>,
    /// The lines that are neither section nor key nor comment.
    pub strays: Vec<Stray>,
    pub(super) sections: Sections,
}

impl Eds {
    /// Every section of the file, in its order; those that nobody knows too.
    pub fn sections(&self) -> impl Iterator<Item = Section<'_>> {
        self.sections.iter()
    }

    /// The first section called `name`, in any case.
    pub fn section(&self, name: &str) -> Option<Section<'_>> {
        self.sections.named(name)
    }

    /// The node-ID that a DCF gives, for which `$NODEID` stands in it.
    pub fn node_id(&self) -> Option<u8> {
        self.commissioning.as_ref()?.node_id
    }

    /// The section that starts in `line`.
    pub(super) fn section_at(&self, line: usize) -> Option<Section<'_>> {
        self.sections.at(line)
    }

    /// The line of the key `name` of the section that starts in `line`; that line itself if there is no such key.
    pub(super) fn line_of(&self, line: usize, name: &str) -> usize {
        self.key_at(line, name).map_or(line, |key| key.line)
    }

    /// The key `name` of the section that starts in `line`, if it is not empty.
    pub(super) fn key_at(&self, line: usize, name: &str) -> Option<Key<'_>> {
        self.section_at(line)?.filled(name)
    }
}
