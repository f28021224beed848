//! The checker: holds a file against CiA 306, CiA 301 and itself.

mod cob_ids;
mod commissioning;
mod file;
mod file_name;
mod lists;
mod modules;
mod objects;
mod pdos;
mod sdos;
mod standard;
mod values;
mod words;

pub use file_name::check_file_name;

use super::{Eds, Finding};
use crate::{Dictionary, Object};

/// Everything that is wrong with a file, what the reader found included, in the order of the lines.
pub fn check(eds: &Eds) -> Vec<Finding> {
    let mut findings = eds.findings.clone();
    file::check(eds, &mut findings);
    lists::check(eds, &mut findings);
    objects::check(eds, &mut findings);
    values::check(eds, &mut findings);
    pdos::check(eds, &mut findings);
    cob_ids::check(eds, &mut findings);
    sdos::check(eds, &mut findings);
    modules::check(eds, &mut findings);
    commissioning::check(eds, &mut findings);
    words::check(eds, &mut findings);
    findings.sort_by_key(|finding| (finding.line, finding.rule.code));
    findings
}

/// The default of an entry for node 1, if it is a number.
fn number(dictionary: &Dictionary, index: u16, sub: u8) -> Option<i128> {
    let entry = dictionary.entry(index, sub)?;
    entry.default.as_ref()?.value(1)
}

/// How an entry is written: `6040:00`.
fn at(index: u16, sub: u8) -> String {
    format!("{index:04X}:{sub:02X}")
}

/// How the section of an entry is called.
fn section_of(object: &Object, sub: u8) -> String {
    match has_sections(object) {
        true => format!("[{:04X}sub{sub:X}]", object.index),
        false => format!("[{:04X}]", object.index),
    }
}

/// Whether it has no section, for `CompactPDO` describes it.
fn is_implied(eds: &Eds, object: &Object) -> bool {
    let compact = eds.device_info.compact_pdo.unwrap_or(0) > 0;
    compact
        && eds
            .section_at(object.line)
            .is_some_and(|section| section.is("DeviceInfo"))
}

/// Whether its entries are described in sections of their own.
fn has_sections(object: &Object) -> bool {
    use crate::ObjectKind::{Array, DefStruct, Record};
    matches!(object.kind, Array | Record | DefStruct)
}
