//! What a device's object dictionary has of what a case asks for.

mod absent;
mod bit_rate;
mod object;
mod pdo;
#[cfg(test)]
mod tests;

use std::collections::BTreeSet;

use fieldproof_dictionary::Dictionary;
use fieldproof_suite::model::{Except, Query, QueryKind};
use fieldproof_suite::{Columns, Suite};

/// What is known of a device beforehand.
#[derive(Debug, Clone, Copy)]
pub struct Described<'a> {
    /// Its object dictionary.
    pub dictionary: Option<&'a Dictionary>,
    /// Its node-ID.
    pub node: u8,
    /// The bit rate of its CAN port.
    pub bit_rate_kbit_per_s: Option<u32>,
    /// The bit rates that its EDS claims.
    pub bit_rates_kbit_per_s: &'a BTreeSet<u32>,
}

/// `suite` with its tables filled from what is known of a device.
pub fn fill(suite: &Suite, described: &Described<'_>) -> Suite {
    suite.filled(&|query| find(query, described))
}

/// As [`fill`], with at most `most` rows of every table that the device fills, spread over all there are.
pub fn fill_some(suite: &Suite, described: &Described<'_>, most: u16) -> Suite {
    suite.filled(&|query| spread(find(query, described), Some(most)))
}

/// Everything that is as `query` says, in the order of the dictionary.
fn find(query: &Query, described: &Described<'_>) -> Vec<Columns> {
    let Some(dictionary) = described.dictionary else {
        return Vec::new();
    };
    let node = described.node;
    let found = match query.is {
        QueryKind::Object => object::objects(query, dictionary, node),
        QueryKind::AbsentObject => absent::objects(query, dictionary),
        QueryKind::AbsentSubIndex => absent::sub_indices(query, dictionary),
        QueryKind::Tpdo | QueryKind::Rpdo => pdo::pdos(query, dictionary, node),
        QueryKind::BitRate => bit_rate::bit_rates(described, false),
        QueryKind::OtherBitRate => bit_rate::bit_rates(described, true),
    };
    spread(found, query.at_most)
}

/// As many of `all` as asked for, at even distances, the first and the last among them.
fn spread(all: Vec<Columns>, at_most: Option<u16>) -> Vec<Columns> {
    let most = at_most.map_or(usize::MAX, usize::from);
    let last = all.len().saturating_sub(1);
    if all.len() <= most {
        return all;
    }
    let steps = most.saturating_sub(1).max(1);
    let is_taken = |index: &usize| {
        // The multiple of last/steps that is nearest below.
        (0..most).any(|step| step * last / steps == *index)
    };
    all.into_iter()
        .enumerate()
        .filter(|(index, _)| is_taken(index))
        .map(|(_, columns)| columns)
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
