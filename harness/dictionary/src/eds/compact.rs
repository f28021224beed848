//! What a file says in short: `CompactSubObj` with its lists, and `CompactPDO`.

use std::collections::{BTreeMap, BTreeSet};

use super::place::{Place, place};
use super::{DeviceInfo, Finding, Key, field, rules};
use crate::ini::Sections;
use crate::{Access, DataType, Default, Entries, Entry, Number, Object, ObjectKind};

/// `CompactSubObj=N`: entries 1 to N are as the object's section says, entry 0 counts them.
pub(super) fn entries(every: &Entry, count: u8) -> Entries {
    let default = Default::Number(Number::absolute(i128::from(count)));
    let number = Entry {
        default: Some(default),
        ..implied(
            "NrOfObjects",
            DataType::Unsigned8,
            Access::ReadOnly,
            every.line,
        )
    };
    let each = (1..=count).map(|sub| {
        let name = format!("{}{sub}", every.name);
        let entry = Entry {
            name,
            ..every.clone()
        };
        (sub, entry)
    });
    std::iter::once((0, number)).chain(each).collect()
}

/// An entry without limits and default.
fn implied(name: &str, data_type: DataType, access: Access, line: usize) -> Entry {
    Entry {
        name: name.to_owned(),
        data_type,
        access,
        low_limit: None,
        high_limit: None,
        default: None,
        parameter_value: None,
        denotation: None,
        pdo_mapping: false,
        line,
    }
}

/// The sections `[XXXXName]`, `[XXXXValue]` and `[XXXXDenotation]`: what sets single entries of a compact object apart.
pub(super) fn apply_lists(
    sections: &Sections,
    objects: &mut BTreeMap<u16, Object>,
    findings: &mut Vec<Finding>,
) {
    // A section that is there a second time is found elsewhere, and does not count.
    let mut done: BTreeSet<Place> = BTreeSet::new();
    for section in sections.iter() {
        let place = place(section.name);
        let Some(list @ (Place::Names(index) | Place::Values(index) | Place::Denotations(index))) =
            place
        else {
            continue;
        };
        if !done.insert(list) {
            continue;
        }
        for key in section.keys().filter(|key| !key.is("NrOfEntries")) {
            match compact_entry(objects, index, key) {
                Some(entry) => apply(list, key, entry, findings),
                None => findings.push(Finding::losing(
                    &rules::COMPACT_LIST,
                    key.line,
                    format!(
                        "`{}={}` in [{}] is about no entry that CompactSubObj describes",
                        key.name, key.value, section.name
                    ),
                    "it is ignored; the keys are the sub-indices in decimal",
                )),
            }
        }
    }
}

/// The entry that the key of a list is about: one that has no section of its own.
fn compact_entry<'o>(
    objects: &'o mut BTreeMap<u16, Object>,
    index: u16,
    key: Key<'_>,
) -> Option<&'o mut Entry> {
    let sub = key.name.parse().ok().filter(|sub| *sub > 0)?;
    let object = objects.get_mut(&index)?;
    let line = object.line;
    let entry = object.entries.get_mut(sub)?;
    (entry.line == line).then_some(entry)
}

fn apply(list: Place, key: Key<'_>, entry: &mut Entry, findings: &mut Vec<Finding>) {
    if key.value.is_empty() {
        return;
    }
    match list {
        Place::Names(_) => key.value.clone_into(&mut entry.name),
        Place::Denotations(_) => entry.denotation = Some(key.value.to_owned()),
        _ => entry.parameter_value = field::default(Some(key), entry.data_type, findings),
    }
}

/// The sub-indices of a communication parameter that `CompactPDO` can name, by bit.
const PARAMETERS: [(u8, &str, DataType); 6] = [
    (1, "COB-ID", DataType::Unsigned32),
    (2, "Transmission type", DataType::Unsigned8),
    (3, "Inhibit time", DataType::Unsigned16),
    (4, "Compatibility entry", DataType::Unsigned8),
    (5, "Event timer", DataType::Unsigned16),
    (6, "SYNC start value", DataType::Unsigned8),
];

/// `CompactPDO`: the PDOs that `NrOfRXPDO` and `NrOfTXPDO` count and that have no sections. No defaults are claimed
/// for them, and as many mappings as `Granularity` lets into 64 bits.
pub(super) fn add_pdos(
    sections: &Sections,
    info: &DeviceInfo,
    objects: &mut BTreeMap<u16, Object>,
) {
    const PDOS: u16 = 512;
    const DISTANCE: u16 = 0x200;
    let mask = info.compact_pdo.unwrap_or(0);
    let Some(section) = sections.named("DeviceInfo").filter(|_| mask > 0) else {
        return;
    };
    for (first, count) in [(0x1400, info.receive_pdos), (0x1800, info.transmit_pdos)] {
        for index in (first..).take(usize::from(count.unwrap_or(0).min(PDOS))) {
            objects
                .entry(index)
                .or_insert_with(|| communication(index, mask, section.line));
            let mapping = index + DISTANCE;
            objects
                .entry(mapping)
                .or_insert_with(|| self::mapping(mapping, info.granularity_bits, section.line));
        }
    }
}

fn communication(index: u16, mask: u8, line: usize) -> Object {
    let used = PARAMETERS
        .iter()
        .filter(|(sub, ..)| mask & 1 << (sub - 1) != 0);
    let entries: Entries = used
        .map(|(sub, name, data_type)| (*sub, implied(name, *data_type, Access::ReadWrite, line)))
        .collect();
    record(
        index,
        "PDO communication parameter",
        Access::ReadOnly,
        entries,
        line,
    )
}

fn mapping(index: u16, granularity_bits: Option<u8>, line: usize) -> Object {
    let slots = match granularity_bits {
        Some(bits @ 1..=64) => 64 / bits,
        _ => 8,
    };
    let entries = (1..=slots).map(|sub| {
        let name = format!("Mapping {sub}");
        (
            sub,
            implied(&name, DataType::Unsigned32, Access::ReadWrite, line),
        )
    });
    record(
        index,
        "PDO mapping parameter",
        Access::ReadWrite,
        entries.collect(),
        line,
    )
}

/// A record with its sub-index 0.
fn record(index: u16, name: &str, count: Access, mut entries: Entries, line: usize) -> Object {
    entries.insert(0, implied("NrOfObjects", DataType::Unsigned8, count, line));
    Object {
        index,
        name: name.to_owned(),
        kind: ObjectKind::Record,
        entries,
        line,
    }
}
