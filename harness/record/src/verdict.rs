//! Verdicts.

use std::fmt;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The outcome of a case, best first. ISO/IEC 9646 has pass, fail and inconclusive; the rest keeps apart what is not
/// the device's doing, and what its manual says.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The device does what is asked.
    Pass,
    /// Not played: does not apply, is not permitted, or the bench lacks something.
    Skipped,
    /// The device departs from the standard exactly as its manual documents.
    Deviation,
    /// The precondition could not be reached, or the measurement cannot decide.
    Inconclusive,
    /// The device is wrong.
    Fail,
    /// The bench broke, or the device could not be put back.
    Error,
}

impl Verdict {
    /// All of them, best first.
    pub const ALL: [Verdict; 6] = [
        Verdict::Pass,
        Verdict::Skipped,
        Verdict::Deviation,
        Verdict::Inconclusive,
        Verdict::Fail,
        Verdict::Error,
    ];

    /// The word for it.
    pub const fn name(self) -> &'static str {
        match self {
            Verdict::Pass => "pass",
            Verdict::Skipped => "skipped",
            Verdict::Deviation => "deviation",
            Verdict::Inconclusive => "inconclusive",
            Verdict::Fail => "fail",
            Verdict::Error => "error",
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// How many cases had which verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub struct VerdictCounts {
    /// Passed.
    pub pass: u32,
    /// Skipped.
    pub skipped: u32,
    /// Deviated as documented.
    pub deviation: u32,
    /// Inconclusive.
    pub inconclusive: u32,
    /// Failed.
    pub fail: u32,
    /// Error.
    pub error: u32,
}

impl VerdictCounts {
    /// Counts one more.
    pub fn add(&mut self, verdict: Verdict) {
        let count = self.of_mut(verdict);
        *count = count.saturating_add(1);
    }

    /// Adds all of `other`.
    pub fn merge(&mut self, other: VerdictCounts) {
        for verdict in Verdict::ALL {
            let count = self.of_mut(verdict);
            *count = count.saturating_add(other.of(verdict));
        }
    }

    /// How many had `verdict`.
    pub fn of(&self, verdict: Verdict) -> u32 {
        match verdict {
            Verdict::Pass => self.pass,
            Verdict::Skipped => self.skipped,
            Verdict::Deviation => self.deviation,
            Verdict::Inconclusive => self.inconclusive,
            Verdict::Fail => self.fail,
            Verdict::Error => self.error,
        }
    }

    /// How many in all.
    pub fn total(&self) -> u32 {
        Verdict::ALL.iter().fold(0, |total: u32, verdict| {
            total.saturating_add(self.of(*verdict))
        })
    }

    fn of_mut(&mut self, verdict: Verdict) -> &mut u32 {
        match verdict {
            Verdict::Pass => &mut self.pass,
            Verdict::Skipped => &mut self.skipped,
            Verdict::Deviation => &mut self.deviation,
            Verdict::Inconclusive => &mut self.inconclusive,
            Verdict::Fail => &mut self.fail,
            Verdict::Error => &mut self.error,
        }
    }
}
