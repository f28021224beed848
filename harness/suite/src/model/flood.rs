//! Many frames, drawn by chance.

use std::time::Duration;

use serde::Deserialize;

use crate::file::FloodFile;
use crate::scalar::{BytePatternText, PatternText};

/// Sends many frames with identifiers and data drawn by chance, the same for the same seed.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(try_from = "FloodFile")]
pub struct Flood {
    /// How many, 1 to 10,000.
    pub frames: u32,
    /// Their identifiers; at least one.
    pub ids: Vec<IdRange>,
    /// Whether they are remote frames.
    pub remote: bool,
    /// What their data are like; without one, anything of 0 to 8 bytes.
    pub data: Vec<BytePatternText>,
    /// From one to the next; none: as fast as the bus carries them.
    pub period: Option<Duration>,
    /// What chance begins with.
    pub seed: u64,
    /// What the device may answer, as often as it likes.
    pub answers: Vec<PatternText>,
}

/// Identifiers one after the other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct IdRange {
    /// The first.
    pub from: u32,
    /// The last.
    pub to: u32,
    /// Whether they have 29 bits.
    pub extended: bool,
}

impl IdRange {
    /// How many.
    pub const fn count(self) -> u32 {
        self.to - self.from + 1
    }

    /// Whether the standard identifier `id` is one of them.
    pub const fn has_standard(self, id: u32) -> bool {
        !self.extended && self.from <= id && id <= self.to
    }

    /// What is left of them without `other`, in order.
    pub(crate) fn without(self, other: IdRange) -> impl Iterator<Item = IdRange> {
        let apart = self.extended != other.extended || other.to < self.from || self.to < other.from;
        let below = (!apart && self.from < other.from).then(|| IdRange {
            to: other.from - 1,
            ..self
        });
        let above = (!apart && other.to < self.to).then(|| IdRange {
            from: other.to + 1,
            ..self
        });
        let whole = apart.then_some(self);
        whole.into_iter().chain(below).chain(above)
    }
}
