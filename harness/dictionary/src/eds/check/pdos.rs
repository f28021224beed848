//! PDOs: their mappings, and what the rest of the file says of them.

use std::collections::BTreeMap;

use super::super::{Eds, Finding, rules};
use super::{at, has_sections, number, section_of, standard};
use crate::integer::Integer;
use crate::{Access, DataType, Entry, Object};

/// Which way a PDO goes, as the device sees it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Direction {
    Receive,
    Transmit,
}

pub(super) fn check(eds: &Eds, findings: &mut Vec<Finding>) {
    let mut received: BTreeMap<(u16, u8), usize> = BTreeMap::new();
    for object in eds.dictionary.objects() {
        if let Some(direction) = direction(object.index)
            && has_sections(object)
        {
            mapping(eds, object, direction, &mut received, findings);
        }
        for (sub, entry) in object.entries.iter() {
            unclear(eds, object, *sub, entry, findings);
        }
    }
    granularity(eds, findings);
    counts(eds, findings);
    pairs(eds, findings);
}

fn direction(index: u16) -> Option<Direction> {
    match index {
        0x1600..=0x17FF => Some(Direction::Receive),
        0x1A00..=0x1BFF => Some(Direction::Transmit),
        _ => None,
    }
}

/// One entry of a mapping: `60400010h` is 16 bits of 6040:00.
#[derive(Clone, Copy)]
struct Mapped {
    index: u16,
    sub: u8,
    bits: u32,
}

impl Mapped {
    fn from_value(value: i128) -> Option<Mapped> {
        let value = u32::try_from(value).ok()?;
        Some(Mapped {
            index: (value >> 16) as u16,
            sub: (value >> 8) as u8,
            bits: value & 0xFF,
        })
    }
}

fn mapping(
    eds: &Eds,
    object: &Object,
    direction: Direction,
    received: &mut BTreeMap<(u16, u8), usize>,
    findings: &mut Vec<Finding>,
) {
    let slots = object
        .entries
        .keys()
        .rev()
        .copied()
        .find(|sub| *sub < 0xFF)
        .unwrap_or(0);
    let count = match number(&eds.dictionary, object.index, 0) {
        // A multiplex PDO has no such entries.
        Some(0xFE | 0xFF) => return,
        Some(count) => u8::try_from(count).unwrap_or(0),
        None => 0,
    };
    if eds.device_info.granularity_bits == Some(0) && count < slots {
        let line = object
            .entries
            .get(&0)
            .map_or(object.line, |entry| entry.line);
        findings.push(Finding::new(
            &rules::FIXED_MAPPING_UNUSED,
            eds.line_of(line, "DefaultValue"),
            format!(
                "[{:04X}] has {slots} entries and maps {count}, but Granularity is 0",
                object.index
            ),
            "remove the entries that can never be used, or write the Granularity of the device",
        ));
    }
    let mut bits = 0;
    let used = object
        .entries
        .iter()
        .filter(|(sub, _)| (1..=count).contains(*sub));
    for (sub, entry) in used {
        let line = eds.line_of(entry.line, "DefaultValue");
        let value = number(&eds.dictionary, object.index, *sub).and_then(Mapped::from_value);
        if let Some(mapped) = value.filter(|mapped| mapped.index != 0) {
            bits += mapped.bits;
            target(eds, mapped, direction, line, findings);
            both_ways(eds, mapped, direction, line, received, findings);
        }
    }
    if bits > 64 {
        findings.push(Finding::new(
            &rules::PDO_TOO_LONG,
            object.line,
            format!("[{:04X}] maps {bits} bits", object.index),
            "a PDO has 64 bits: map less, or into another PDO",
        ));
    }
}

fn target(
    eds: &Eds,
    mapped: Mapped,
    direction: Direction,
    line: usize,
    findings: &mut Vec<Finding>,
) {
    let place = at(mapped.index, mapped.sub);
    if mapped.index < 0x20 {
        dummy(eds, mapped, direction, line, findings);
        return;
    }
    let Some(entry) = eds.dictionary.entry(mapped.index, mapped.sub) else {
        findings.push(Finding::new(
            &rules::MAPPED_MISSING,
            line,
            format!("{place} is mapped, but the file does not describe it"),
            "describe it, or map another",
        ));
        return;
    };
    if !entry.pdo_mapping {
        findings.push(Finding::new(
            &rules::NOT_MAPPABLE,
            line,
            format!(
                "{place} is mapped, but line {} does not allow it",
                eds.line_of(entry.line, "PDOMapping")
            ),
            "write PDOMapping=1 there, or map another",
        ));
    }
    let forbidden = match direction {
        Direction::Receive => !entry.access.writable() || entry.access == Access::ReadWriteOnRead,
        Direction::Transmit => !entry.access.readable() || entry.access == Access::ReadWriteOnWrite,
    };
    if forbidden {
        findings.push(Finding::new(
            &rules::MAPPED_DIRECTION,
            line,
            format!("{place} is {} and mapped to {}", entry.access.word(), goal(direction)),
            "a PDO that the device receives needs wo, rw or rww; one that it sends needs ro, const, rw or rwr",
        ));
    }
    length(mapped, entry.data_type, line, findings);
    let text = entry.data_type.is_text();
    if let Some(default) = entry.default_bytes(1).filter(|_| text)
        && default.len() * 8 > mapped.bits as usize
    {
        findings.push(Finding::new(
            &rules::MAPPED_STRING,
            line,
            format!(
                "{place} is mapped with {} bits, but its default has {} bytes",
                mapped.bits,
                default.len()
            ),
            "map as many bits as the string has, or shorten the default",
        ));
    }
}

fn goal(direction: Direction) -> &'static str {
    match direction {
        Direction::Receive => "be received",
        Direction::Transmit => "be sent",
    }
}

fn length(mapped: Mapped, data_type: DataType, line: usize, findings: &mut Vec<Finding>) {
    let place = at(mapped.index, mapped.sub);
    if let Some(bits) = data_type.bits()
        && bits != mapped.bits
    {
        findings.push(Finding::new(
            &rules::MAPPED_LENGTH,
            line,
            format!(
                "{place} is mapped with {} bits, but {data_type:?} has {bits}",
                mapped.bits
            ),
            format!("write {:04X}{:02X}{bits:02X}h", mapped.index, mapped.sub),
        ));
    }
}

/// A gap in a received PDO, of the length of a data type.
fn dummy(
    eds: &Eds,
    mapped: Mapped,
    direction: Direction,
    line: usize,
    findings: &mut Vec<Finding>,
) {
    let name = format!("Dummy{:04X}", mapped.index);
    let enabled = eds
        .section("DummyUsage")
        .and_then(|section| section.key(&name))
        .and_then(|key| Integer::parse(key.value))
        .is_some_and(|flag| flag.value == 1);
    if !enabled || direction == Direction::Transmit {
        findings.push(Finding::new(
            &rules::NOT_MAPPABLE,
            line,
            format!("the data type {:04X} is mapped as a gap", mapped.index),
            format!("only a PDO that is received may have one, if [DummyUsage] says {name}=1"),
        ));
    }
    length(mapped, DataType::from_code(mapped.index), line, findings);
}

fn both_ways(
    eds: &Eds,
    mapped: Mapped,
    direction: Direction,
    line: usize,
    received: &mut BTreeMap<(u16, u8), usize>,
    findings: &mut Vec<Finding>,
) {
    let place = (mapped.index, mapped.sub);
    if direction == Direction::Receive {
        received.entry(place).or_insert(line);
        return;
    }
    let both = eds
        .dictionary
        .entry(mapped.index, mapped.sub)
        .is_some_and(|entry| entry.access == Access::ReadWrite);
    if let Some(first) = received.get(&place).filter(|_| both) {
        findings.push(Finding::new(
            &rules::MAPPED_BOTH_WAYS,
            line,
            format!(
                "{} is sent here and received in line {first}",
                at(mapped.index, mapped.sub)
            ),
            "map what the device measures or decides, or say what it means",
        ));
    }
}

fn unclear(eds: &Eds, object: &Object, sub: u8, entry: &Entry, findings: &mut Vec<Finding>) {
    if entry.pdo_mapping && entry.access == Access::ReadWrite {
        findings.push(Finding::new(
            &rules::DIRECTION_UNCLEAR,
            eds.line_of(entry.line, "AccessType"),
            format!(
                "{} is rw and mappable: to be received or to be sent?",
                section_of(object, sub)
            ),
            "write rww if a PDO may write it, rwr if a PDO may read it",
        ));
    }
}

/// 0 says that mappings cannot be changed.
fn granularity(eds: &Eds, findings: &mut Vec<Finding>) {
    let Some(granularity) = eds.device_info.granularity_bits else {
        return;
    };
    let writable: Vec<String> = eds
        .dictionary
        .objects()
        .filter(|object| standard::is_mapping(object.index))
        .filter(|object| object.entries.values().any(|entry| entry.access.writable()))
        .map(|object| format!("{:04X}", object.index))
        .collect();
    let line = eds
        .section("DeviceInfo")
        .map_or(1, |section| eds.line_of(section.line, "Granularity"));
    if granularity == 0 && !writable.is_empty() {
        findings.push(Finding::new(
            &rules::GRANULARITY,
            line,
            format!(
                "Granularity is 0, but the mappings {} are writable",
                writable.join(", ")
            ),
            "write the Granularity of the device in bits, or make the mappings ro",
        ));
    } else if granularity > 64 {
        findings.push(Finding::new(
            &rules::GRANULARITY,
            line,
            format!("Granularity is {granularity}"),
            "write 0 to 64",
        ));
    }
}

fn counts(eds: &Eds, findings: &mut Vec<Finding>) {
    // With CompactPDO the sections of PDOs may be left out.
    if eds
        .device_info
        .compact_pdo
        .is_some_and(|compact| compact > 0)
    {
        return;
    }
    for (name, said, first, last) in [
        ("NrOfRXPDO", eds.device_info.receive_pdos, 0x1400, 0x15FF),
        ("NrOfTXPDO", eds.device_info.transmit_pdos, 0x1800, 0x19FF),
    ] {
        let present = eds
            .dictionary
            .objects()
            .filter(|object| (first..=last).contains(&object.index))
            .count();
        if let Some(said) = said
            && usize::from(said) != present
        {
            let line = eds
                .section("DeviceInfo")
                .map_or(1, |section| eds.line_of(section.line, name));
            findings.push(Finding::new(
                &rules::PDO_COUNT,
                line,
                format!(
                    "{name} is {said}, but {present} are described in {first:04X} to {last:04X}"
                ),
                format!("write {name}={present}, or describe the others"),
            ));
        }
    }
}

fn pairs(eds: &Eds, findings: &mut Vec<Finding>) {
    const DISTANCE: u16 = 0x200;
    if eds
        .device_info
        .compact_pdo
        .is_some_and(|compact| compact > 0)
    {
        return;
    }
    for object in eds.dictionary.objects() {
        let partner = match object.index {
            0x1400..=0x15FF | 0x1800..=0x19FF => object.index + DISTANCE,
            0x1600..=0x17FF | 0x1A00..=0x1BFF => object.index - DISTANCE,
            _ => continue,
        };
        if eds.dictionary.object(partner).is_none() {
            findings.push(Finding::new(
                &rules::PDO_PAIR,
                object.line,
                format!("[{:04X}] has no [{partner:04X}]", object.index),
                "a PDO needs both: describe the other, or remove this",
            ));
        }
    }
}
