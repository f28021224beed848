//! PDOs of the dictionary.

use fieldproof_dictionary::Dictionary;
use fieldproof_suite::Columns;
use fieldproof_suite::model::{Query, QueryKind};

/// RPDO and TPDO n have their communication parameters at these indices and n - 1, and their mappings at the others.
const RPDO: (u16, u16) = (0x1400, 0x1600);
const TPDO: (u16, u16) = (0x1800, 0x1A00);

/// Those that have communication and mapping parameters; `index` and `except` are about the former.
pub(super) fn pdos(query: &Query, dictionary: &Dictionary, node: u8) -> Vec<Columns> {
    let (communication, mapping) = match query.is {
        QueryKind::Rpdo => RPDO,
        _ => TPDO,
    };
    (0..512)
        .filter(|offset| {
            let there = |index| dictionary.object(index).is_some();
            there(communication + offset) && there(mapping + offset)
        })
        .filter(|offset| super::is_meant(query, communication + offset, 0))
        .map(|offset| {
            columns(
                dictionary,
                node,
                offset,
                (communication + offset, mapping + offset),
            )
        })
        .collect()
}

fn columns(
    dictionary: &Dictionary,
    node: u8,
    offset: u16,
    (communication, mapping): (u16, u16),
) -> Columns {
    let default = |index, sub| {
        let bytes = dictionary.entry(index, sub)?.default_bytes(node)?;
        let mut little_endian = [0; 8];
        little_endian
            .get_mut(..bytes.len())?
            .copy_from_slice(&bytes);
        Some(u64::from_le_bytes(little_endian))
    };
    let mut columns = vec![
        ("", (offset + 1).to_string()),
        ("-communication", format!("{communication:04X}")),
        ("-mapping", format!("{mapping:04X}")),
    ];
    if let Some(identifier) = default(communication, 1) {
        columns.push(("-identifier", format!("{:03X}", identifier & 0x7FF)));
    }
    let count = default(mapping, 0).and_then(|count| u8::try_from(count).ok());
    let bits = count.map(|count| {
        let entries = (1..=count).map(|sub| default(mapping, sub).unwrap_or(0) & 0xFF);
        entries.sum::<u64>()
    });
    columns.extend(bits.map(|bits| ("-length", bits.div_ceil(8).to_string())));
    columns
}
