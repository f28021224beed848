//! What the dictionary does not have, beside what it has: where a device that answers too much is found.

use std::collections::BTreeSet;

use fieldproof_dictionary::{Dictionary, ObjectKind};
use fieldproof_suite::Columns;
use fieldproof_suite::model::Query;

use super::{is_meant, place};

/// The indices before and after those there are, in the middle of the gaps between, and at the ends of what is asked for.
pub(super) fn objects(query: &Query, dictionary: &Dictionary) -> Vec<Columns> {
    let indices: Vec<u16> = dictionary.objects().map(|object| object.index).collect();
    let middle = |pair: &[u16]| match pair {
        [low, high] => low + (high - low) / 2,
        _ => 0,
    };
    let middles = indices.windows(2).map(middle);
    let beside = indices
        .iter()
        .flat_map(|it| [it.saturating_sub(1), it.saturating_add(1)]);
    let ends = query.index.iter().flat_map(|range| [range.from, range.to]);
    let candidates: BTreeSet<u16> = beside.chain(middles).chain(ends).collect();
    candidates
        .into_iter()
        .filter(|index| (0x1000..=0xFFFE).contains(index))
        .filter(|index| dictionary.object(*index).is_none() && is_meant(query, *index, 0))
        .map(|index| place(index, 0))
        .collect()
}

/// Sub-index 1 of single values; of others the gaps, and the sub-index after the last.
pub(super) fn sub_indices(query: &Query, dictionary: &Dictionary) -> Vec<Columns> {
    let single = |kind| matches!(kind, ObjectKind::Variable | ObjectKind::Domain);
    let mut found = Vec::new();
    for object in dictionary.objects().filter(|object| object.index >= 0x1000) {
        let subs: Vec<u8> = object.entries.keys().copied().collect();
        let past = match single(object.kind) {
            true => 1,
            // FFh is the structure of the object, where a device has that.
            false => subs
                .iter()
                .filter(|sub| **sub < 0xFE)
                .max()
                .map_or(1, |it| it + 1),
        };
        let gaps = (0..past).filter(|sub| !subs.contains(sub));
        for sub in gaps.chain([past]) {
            if !subs.contains(&sub) && is_meant(query, object.index, sub) {
                found.push(place(object.index, sub));
            }
        }
    }
    found
}
