//! What holds for a whole run, beside the lanes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The first line of a journal: what is played, with what, and by whom.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub struct RunStarted {
    /// The journal's format version.
    pub format: u32,
    /// `fieldproof 0.1.0`
    pub tool: String,
    /// The date and time of day, UTC: `2026-11-22T21:36:29Z`. Instants of lanes count from here.
    pub started: String,
    /// The arguments the program was given.
    pub arguments: Vec<String>,
    /// What was said about the run with `--set`, in that order.
    pub settings: Vec<Setting>,
    /// The bench file.
    pub bench: Option<String>,
    /// Documented deviations are failures, and only the strict abort codes pass.
    pub strict: bool,
    /// How thorough it is: `default`, `full`.
    pub depth: String,
    /// The seed of everything that is drawn by lot.
    pub seed: u64,
    /// Every file that was used.
    pub files: Vec<UsedFile>,
    /// The lanes, in the order that the numbers of the other lines mean.
    pub lanes: Vec<PlannedLane>,
}

/// Something said about a run: operator, order number, firmware.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Setting {
    /// `operator`
    pub key: String,
    /// `A. Smith`
    pub value: String,
}

/// A file that a run was played from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct UsedFile {
    /// What it is: `suite`, `device description`, `EDS`, `register map`, `bench`.
    pub kind: String,
    /// Its path.
    pub path: String,
    /// The SHA-256 of its bytes, hexadecimal.
    pub sha256: String,
}

/// A lane that is to be played.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct PlannedLane {
    /// The device's name.
    pub device: String,
    /// Its cases, skipped ones included.
    pub cases: u64,
    /// Whether it is a reference device in simulation.
    pub simulated: bool,
    /// The files that belong to this device alone, by path.
    pub files: Vec<String>,
}

/// The last line of a journal; without it, the run did not come to its end.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct RunFinished {
    /// The date and time of day, UTC.
    pub finished: String,
}
