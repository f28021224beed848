//! COB-IDs: what is restricted, and what must differ from node to node.

use super::super::{Eds, Finding, rules};
use super::at;
use crate::{Default, Entry};

const INVALID: i128 = 1 << 31;
const EXTENDED: i128 = 1 << 29;

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
