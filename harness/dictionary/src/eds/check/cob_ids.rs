//! COB-IDs: what is restricted, and what must differ from node to node.

use std::collections::BTreeMap;

use super::super::{Eds, Finding, rules};
use super::at;
use crate::{Default, Entry, Number};

/// Bit 31 of a COB-ID: not in use.
pub(super) const INVALID: i128 = 1 << 31;
/// Bit 29 of a COB-ID: an identifier of 29 bits.
pub(super) const EXTENDED: i128 = 1 << 29;

pub(super) fn check(eds: &Eds, findings: &mut Vec<Finding>) {
    for (index, sub, entry) in eds.dictionary.entries() {
        let Some(Default::Number(default)) = entry.default else {
            continue;
        };
        let own = matches!(
            (index, sub),
            (0x1005 | 0x1012 | 0x1014, 0) | (0x1400..=0x15FF | 0x1800..=0x19FF, 1)
        );
        let values = [default.value(1), default.value(127)];
        if own && values.into_iter().any(is_restricted) {
            findings.push(restricted(eds, index, sub, entry));
        }
        let per_node = matches!((index, sub), (0x1014, 0) | (0x1200, 1 | 2));
        if per_node && !default.relative_to_node && values[0] & INVALID == 0 {
            findings.push(Finding::new(
                &rules::SAME_FOR_EVERY_NODE,
                eds.line_of(entry.line, "DefaultValue"),
                format!("{} is the same for every node", at(index, sub)),
                "write $NODEID+ and what is added to the node-ID",
            ));
        }
    }
    twice(eds, findings);
}

/// Who uses a COB-ID.
#[derive(Clone, Copy, PartialEq, Eq)]
struct User {
    index: u16,
    sub: u8,
}

impl User {
    /// Only frames that are received may have more than one taker.
    fn receives(self) -> bool {
        matches!(self.index, 0x1400..=0x15FF)
    }
}

fn twice(eds: &Eds, findings: &mut Vec<Finding>) {
    // 1200h is there even if no section describes it.
    let mut users: BTreeMap<(bool, i128), User> = BTreeMap::new();
    for (sub, offset) in [(1, 0x600), (2, 0x580)] {
        let key = identifier(eds, Number::relative(offset));
        users.insert(key, User { index: 0x1200, sub });
    }
    for (index, sub, entry) in eds.dictionary.entries() {
        let user = User { index, sub };
        let Some(cob_id) = cob_id_in_use(user, entry) else {
            continue;
        };
        let first = *users.entry(identifier(eds, cob_id)).or_insert(user);
        if first == user || (first.receives() && user.receives()) {
            continue;
        }
        let key = match entry.parameter_value {
            Some(_) => "ParameterValue",
            None => "DefaultValue",
        };
        findings.push(Finding::new(
            &rules::COB_ID_TWICE,
            eds.line_of(entry.line, key),
            format!(
                "{} has the COB-ID of {}",
                at(index, sub),
                at(first.index, first.sub)
            ),
            "write another, or set bit 31 if it is not in use",
        ));
    }
}

/// The COB-ID that an entry has and uses, unless it is found to be restricted.
fn cob_id_in_use(user: User, entry: &Entry) -> Option<Number> {
    /// Bits 31 and 30 of 1012h: the device takes TIME messages, or sends them.
    const TIME_IN_USE: i128 = 0b11 << 30;
    let Some(Default::Number(cob_id)) = entry.parameter_value.as_ref().or(entry.default.as_ref())
    else {
        return None;
    };
    let value = cob_id.value(1);
    let used = match (user.index, user.sub) {
        (0x1005, 0) => !is_restricted(value & !INVALID),
        (0x1012, 0) => value & TIME_IN_USE != 0 && !is_restricted(value & !INVALID),
        (0x1014, 0) | (0x1400..=0x15FF | 0x1800..=0x19FF, 1) => {
            value & INVALID == 0 && !is_restricted(value)
        }
        (0x1201..=0x12FF, 1 | 2) => value & INVALID == 0,
        _ => false,
    };
    used.then_some(*cob_id)
}

/// A COB-ID without its flags; with the node-ID where the file gives one.
fn identifier(eds: &Eds, cob_id: Number) -> (bool, i128) {
    const IDENTIFIER: i128 = EXTENDED * 2 - 1;
    match eds.node_id() {
        Some(node) => (false, cob_id.value(node) & IDENTIFIER),
        None => (cob_id.relative_to_node, cob_id.offset & IDENTIFIER),
    }
}

/// The CAN-IDs that CiA 301 keeps for its own services. Those that are not in use or have 29 bits are left alone.
fn is_restricted(cob_id: i128) -> bool {
    if cob_id & (INVALID | EXTENDED) != 0 {
        return false;
    }
    matches!(
        cob_id & 0x7FF,
        0..=0x7F | 0x101..=0x180 | 0x581..=0x5FF | 0x601..=0x67F | 0x6E0..=0x6FF | 0x701..=0x7FF
    )
}

fn restricted(eds: &Eds, index: u16, sub: u8, entry: &Entry) -> Finding {
    let line = eds.line_of(entry.line, "DefaultValue");
    let text = eds
        .key_at(entry.line, "DefaultValue")
        .map_or_else(String::new, |key| format!(" ({})", key.value));
    Finding::new(
        &rules::RESTRICTED_COB_ID,
        line,
        format!(
            "the default of {}{text} is a restricted CAN-ID",
            at(index, sub)
        ),
        "restricted are 000-07F, 101-180, 581-5FF, 601-67F, 6E0-6FF and 701-7FF; set bit 31 if it is not in use",
    )
}
