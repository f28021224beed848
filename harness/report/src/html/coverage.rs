//! What was tested, by clause of the standard and by section of the manual.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use fieldproof_record::{CaseFinished, CaseStarted, VerdictCounts};

/// The verdicts of the cases that cite one section.
#[derive(Debug, Default)]
pub(super) struct Tally {
    pub(super) counts: VerdictCounts,
    /// Why cases were skipped.
    pub(super) reasons: BTreeMap<String, u32>,
}

impl Tally {
    fn add(&mut self, finished: &CaseFinished) {
        self.counts.add(finished.verdict);
        if let Some(reason) = &finished.reason {
            *self.reasons.entry(reason.clone()).or_default() += 1;
        }
    }
}

/// A section, ordered as in a table of contents: 7.2.10 after 7.2.9.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Section(pub(super) String);

impl Section {
    /// Pieces that are numbers, and pieces that are not.
    fn pieces(&self) -> impl Iterator<Item = (u64, &str)> {
        let mut rest = self.0.as_str();
        std::iter::from_fn(move || {
            let first = rest.chars().next()?;
            let is_digit = first.is_ascii_digit();
            let end = rest
                .find(|character: char| character.is_ascii_digit() != is_digit)
                .unwrap_or(rest.len());
            let (piece, after) = rest.split_at(end);
            rest = after;
            match is_digit {
                true => Some((piece.parse().unwrap_or(u64::MAX), "")),
                false => Some((0, piece)),
            }
        })
    }
}

impl Ord for Section {
    fn cmp(&self, other: &Section) -> Ordering {
        let by_pieces = self.pieces().cmp(other.pieces());
        by_pieces.then_with(|| self.0.cmp(&other.0))
    }
}

impl PartialOrd for Section {
    fn partial_cmp(&self, other: &Section) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// All documents that cases cite.
#[derive(Debug, Default)]
pub(super) struct Coverage {
    pub(super) documents: BTreeMap<String, BTreeMap<Section, Tally>>,
    /// Every case once, whatever it cites.
    pub(super) all: Tally,
}

impl Coverage {
    pub(super) fn case(&mut self, started: &CaseStarted, finished: &CaseFinished) {
        self.all.add(finished);
        let mut counted: Vec<(&str, &str)> = Vec::new();
        for cite in &started.cites {
            let section = cite.section.as_deref().unwrap_or("");
            let key = (cite.document.as_str(), section);
            if counted.contains(&key) {
                continue;
            }
            counted.push(key);
            let sections = self.documents.entry(cite.document.clone()).or_default();
            let tally = sections.entry(Section(section.to_owned())).or_default();
            tally.add(finished);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sections_stand_as_in_a_table_of_contents() {
        let mut sections = ["7.2.10", "slide 9", "7.2.9", "7.2", "slide 10", ""]
            .map(|text| Section(text.to_owned()));
        sections.sort();
        let texts = sections.iter().map(|it| it.0.as_str());
        let texts: Vec<&str> = texts.collect();
        assert_eq!(texts, ["", "slide 9", "slide 10", "7.2", "7.2.9", "7.2.10"]);
    }
}
