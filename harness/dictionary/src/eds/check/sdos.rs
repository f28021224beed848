//! The parameters of SDOs, and the heartbeats that are monitored.

use std::collections::BTreeMap;

use super::super::{Eds, Finding, rules};
use super::cob_ids::{EXTENDED, INVALID};
use super::{at, number};
use crate::{Default, Object};

pub(super) fn check(eds: &Eds, findings: &mut Vec<Finding>) {
    default_sdo(eds, findings);
    for object in eds.dictionary.objects() {
        if let 0x1201..=0x12FF = object.index {
            channel(eds, object, findings);
        }
    }
    heartbeats(eds, findings);
}

/// CiA 301 fixes the identifiers of 1200h. Whether `$NODEID` is there at all is looked at elsewhere.
fn default_sdo(eds: &Eds, findings: &mut Vec<Finding>) {
    for (sub, wanted) in [(1, 0x600), (2, 0x580)] {
        let Some(entry) = eds.dictionary.entry(0x1200, sub) else {
            continue;
        };
        if let Some(Default::Number(default)) = entry.default
            && default.relative_to_node
            && default.offset != wanted
        {
            findings.push(Finding::new(
                &rules::DEFAULT_SDO,
                eds.line_of(entry.line, "DefaultValue"),
                format!(
                    "the default of {} is not {wanted:X}h plus the node-ID",
                    at(0x1200, sub)
                ),
                format!("write $NODEID+0x{wanted:X}"),
            ));
        }
    }
}

fn channel(eds: &Eds, object: &Object, findings: &mut Vec<Finding>) {
    if let Some(missing) = [1, 2].iter().find(|sub| object.entries.get(sub).is_none()) {
        findings.push(Finding::new(
            &rules::SDO_CHANNEL,
            object.line,
            format!("[{:04X}] has no sub-index {missing}", object.index),
            "describe both COB-IDs, sub-index 1 from client to server and 2 back",
        ));
    }
    let line = |sub: u8| {
        let entry = object.entries.get(&sub);
        entry.map_or(object.line, |entry| eds.line_of(entry.line, "DefaultValue"))
    };
    let cob_id = |sub| number(&eds.dictionary, object.index, sub);
    let in_use = |cob_id: i128| cob_id & INVALID == 0;
    if let (Some(there), Some(back)) = (cob_id(1), cob_id(2))
        && let Some(wrong) = match (in_use(there), in_use(back)) {
            (true, true) if (there ^ back) & (EXTENDED * 2 - 1) == 0 => Some("both are one"),
            (true, false) | (false, true) => Some("one of them is in use"),
            _ => None,
        }
    {
        findings.push(Finding::new(
            &rules::SDO_CHANNEL,
            line(2),
            format!("the COB-IDs of [{:04X}]: {wrong}", object.index),
            "an SDO needs one COB-ID each way, or bit 31 in both if it is not in use",
        ));
    }
    let used = cob_id(1).is_some_and(in_use);
    if let Some(node) = cob_id(3)
        && !(1..=127).contains(&node)
        && (node != 0 || used)
    {
        findings.push(Finding::new(
            &rules::SDO_NODE,
            line(3),
            format!("the node of [{:04X}] is {node}", object.index),
            "write 1 to 127, or 0 and bit 31 in both COB-IDs",
        ));
    }
}

/// Bits 16 to 23 of an entry of 1016h are the node, the lower 16 are the time; 0 in either means not in use.
fn heartbeats(eds: &Eds, findings: &mut Vec<Finding>) {
    let Some(object) = eds.dictionary.object(0x1016) else {
        return;
    };
    let mut nodes: BTreeMap<i128, u8> = BTreeMap::new();
    for (sub, entry) in object.entries.iter().filter(|(sub, _)| **sub > 0) {
        let value = number(&eds.dictionary, 0x1016, *sub).unwrap_or(0);
        let (node, time) = (value >> 16 & 0xFF, value & 0xFFFF);
        if node == 0 || time == 0 {
            continue;
        }
        let first = *nodes.entry(node).or_insert(*sub);
        if first != *sub {
            findings.push(Finding::new(
                &rules::HEARTBEAT_TWICE,
                eds.line_of(entry.line, "DefaultValue"),
                format!(
                    "{} monitors node {node}, as {} does",
                    at(0x1016, *sub),
                    at(0x1016, first)
                ),
                "remove one of the two",
            ));
        }
    }
}
