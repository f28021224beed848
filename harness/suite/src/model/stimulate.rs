//! What the bench does to the device beside the bus.

use std::time::Duration;

use schemars::JsonSchema;
use serde::Deserialize;

use crate::file::StimulateFile;

/// What the bench does to the device.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(try_from = "StimulateFile")]
pub enum Stimulate {
    /// `{power: off}`, `{power: on}`, `{power: cycle}`
    Power(PowerAction),
    /// `{process-value: "6063:00", to: -12013}`
    ProcessValue {
        /// What.
        name: String,
        /// The raw value.
        to: i64,
        /// How long giving it may take, where what comes next depends on it.
        within: Option<Duration>,
    },
    /// `{condition: hardware-fault, active: true}`; ended after the case.
    Condition {
        /// What.
        name: String,
        /// Whether it holds from now on.
        active: bool,
    },
    /// `{setting: node, to: 5}`
    Setting {
        /// What.
        name: String,
        /// The value.
        to: i64,
    },
    /// `{companion: inverter, power: off}`; undone after the case.
    Companion {
        /// The port that the tester plays it on.
        port: String,
        /// What is done to it.
        stimulus: CompanionStimulus,
    },
}

/// What is done to something that the tester plays himself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CompanionStimulus {
    /// Its power goes off or on. With the power off it takes no part; after it, it is as new.
    Power(PowerAction),
    /// `{companion: inverter, process-value: "register 2520", to: 5}`
    ProcessValue {
        /// What.
        name: String,
        /// The raw value.
        to: i64,
    },
}

/// What is done to the power.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PowerAction {
    /// Off.
    Off,
    /// On.
    On,
    /// Off for a second, then on.
    Cycle,
}
