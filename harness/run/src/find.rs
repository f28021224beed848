//! What a device has of what a case asks for: by its object dictionary, its register map, its description.

mod absent;
mod bit_rate;
mod function;
mod object;
mod pdo;
mod register;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

use fieldproof_dictionary::Dictionary;
use fieldproof_dictionary::registers::RegisterMap;
use fieldproof_suite::device::DeviceDescription;
use fieldproof_suite::model::{Except, Query, QueryKind};
use fieldproof_suite::{Columns, Suite};

/// What is known of a device beside its description.
#[derive(Debug, Clone, Copy, Default)]
pub struct Known<'a> {
    /// Its object dictionary.
    pub dictionary: Option<&'a Dictionary>,
    /// Its register map.
    pub registers: Option<&'a RegisterMap>,
    /// The bit rates that its EDS claims.
    pub bit_rates_kbit_per_s: Option<&'a BTreeSet<u32>>,
}

/// `suite` with its tables filled from what is known of a device.
pub fn fill(suite: &Suite, device: &DeviceDescription, known: Known<'_>) -> Suite {
    suite.filled(&|query| find(query, device, known))
}

/// As [`fill`], with at most `most` rows of every table that is filled, spread over all there are.
pub fn fill_some(suite: &Suite, device: &DeviceDescription, known: Known<'_>, most: u16) -> Suite {
    suite.filled(&|query| spread(find(query, device, known), most.into()))
}

/// Everything that is as `query` says, in the order of the dictionary or of the addresses.
fn find(query: &Query, device: &DeviceDescription, known: Known<'_>) -> Vec<Columns> {
    let node = device.canopen.as_ref().map_or(1, |canopen| canopen.node);
    let found = match query.is {
        QueryKind::Object => known.dictionary.map(|it| object::objects(query, it, node)),
        QueryKind::AbsentObject => known.dictionary.map(|it| absent::objects(query, it)),
        QueryKind::AbsentSubIndex => known.dictionary.map(|it| absent::sub_indices(query, it)),
        QueryKind::Tpdo | QueryKind::Rpdo => known.dictionary.map(|it| pdo::pdos(query, it, node)),
        QueryKind::Register => known.registers.map(|it| register::registers(query, it)),
        QueryKind::Hole => known.registers.map(|it| register::holes(query, it)),
        QueryKind::BitRate => bit_rate::bit_rates(device, known, false),
        QueryKind::OtherBitRate => bit_rate::bit_rates(device, known, true),
        QueryKind::Function => device
            .modbus
            .as_ref()
            .map(|it| function::functions(query, it)),
    };
    let most = query.at_most.map_or(usize::MAX, usize::from);
    spread(found.unwrap_or_default(), most)
}

/// At most `most` of `all`, at even distances, the first and the last among them.
pub fn spread<T>(all: Vec<T>, most: usize) -> Vec<T> {
    let last = all.len().saturating_sub(1);
    if all.len() <= most {
        return all;
    }
    let steps = most.saturating_sub(1).max(1);
    // Each is the multiple of last/steps that is nearest below, so they are in order.
    let taken: Vec<usize> = (0..most).map(|step| step * last / steps).collect();
    all.into_iter()
        .enumerate()
        .filter(|(index, _)| taken.binary_search(index).is_ok())
        .map(|(_, one)| one)
        .collect()
}

/// Whether this place is one that `query` means.
fn is_meant(query: &Query, index: u16, sub: u8) -> bool {
    let in_range = query.index.is_empty() || query.index.iter().any(|range| range.contains(index));
    let at_sub = query.sub.is_empty() || query.sub.contains(&sub);
    let excepted = query.except.iter().any(|except| match except {
        Except::Object(object) => object.index == index && object.sub == sub,
        Except::Range(range) => range.contains(index),
    });
    in_range && at_sub && !excepted
}

/// Where it is: `1000:00`, and its parts as numbers.
fn place(index: u16, sub: u8) -> Columns {
    vec![
        ("", format!("{index:04X}:{sub:02X}")),
        ("-index", format!("0x{index:04X}")),
        ("-sub", sub.to_string()),
    ]
}
