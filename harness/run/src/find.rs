//! What a device's object dictionary has of what a case asks for.

mod absent;
mod object;
mod pdo;
#[cfg(test)]
mod tests;

use fieldproof_dictionary::Dictionary;
use fieldproof_suite::model::{Except, Query, QueryKind};
use fieldproof_suite::{Columns, Suite};

/// `suite` with its tables filled from the dictionary of the device with the node-ID `node`.
pub fn fill(suite: &Suite, dictionary: Option<&Dictionary>, node: u8) -> Suite {
    suite.filled(&|query| find(query, dictionary, node))
}

/// As [`fill`], with at most `most` rows of every table that the dictionary fills, spread over all there are.
pub fn fill_some(suite: &Suite, dictionary: Option<&Dictionary>, node: u8, most: u16) -> Suite {
    suite.filled(&|query| spread(find(query, dictionary, node), Some(most)))
}

/// Everything in `dictionary` that is as `query` says, in the order of the dictionary.
fn find(query: &Query, dictionary: Option<&Dictionary>, node: u8) -> Vec<Columns> {
    let Some(dictionary) = dictionary else {
        return Vec::new();
    };
    let found = match query.is {
        QueryKind::Object => object::objects(query, dictionary, node),
        QueryKind::AbsentObject => absent::objects(query, dictionary),
        QueryKind::AbsentSubIndex => absent::sub_indices(query, dictionary),
        QueryKind::Tpdo | QueryKind::Rpdo => pdo::pdos(query, dictionary, node),
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
