//! The power state machine of drives, CiA 402.

use std::time::Duration;

use schemars::JsonSchema;
use serde::Deserialize;

use crate::forms::OneOrMany;
use crate::read_with::{one_or_many, optional_pdo_number, optional_time};
use crate::scalar::Time;

/// A state of a drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DriveState {
    /// x0xx 0000
    NotReadyToSwitchOn,
    /// x1xx 0000
    SwitchOnDisabled,
    /// x01x 0001
    ReadyToSwitchOn,
    /// x01x 0011
    SwitchedOn,
    /// x01x 0111
    OperationEnabled,
    /// x00x 0111
    QuickStopActive,
    /// x0xx 1111
    FaultReactionActive,
    /// x0xx 1000
    Fault,
}

/// A state that a controlword leads to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DriveTarget {
    /// A fault is reset for it.
    SwitchOnDisabled,
    /// By shutdown.
    ReadyToSwitchOn,
    /// By switch on.
    SwitchedOn,
    /// By enable operation: the motor may turn.
    OperationEnabled,
}

/// A bit of the statusword beside those that name the state.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum StatusBit {
    /// Bit 4.
    VoltageEnabled,
    /// Bit 9: the controlword is obeyed.
    Remote,
    /// Bit 10.
    TargetReached,
    /// Bit 12 of profile position.
    SetPointAcknowledge,
    /// Bit 12 of profile velocity: the speed is zero.
    SpeedZero,
}

/// Expects what the statusword says.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ExpectDrive {
    /// The state, or several of which it must be one.
    #[serde(deserialize_with = "one_or_many")]
    #[schemars(with = "OneOrMany<DriveState>")]
    pub is: Vec<DriveState>,
    /// Bits that must be 1.
    #[serde(default, deserialize_with = "one_or_many")]
    #[schemars(with = "OneOrMany<StatusBit>")]
    pub with: Vec<StatusBit>,
    /// Bits that must be 0.
    #[serde(default, deserialize_with = "one_or_many")]
    #[schemars(with = "OneOrMany<StatusBit>")]
    pub without: Vec<StatusBit>,
    /// How long the drive may take; 2 s where nothing is said.
    #[serde(default, deserialize_with = "optional_time")]
    #[schemars(with = "Option<Time>")]
    pub within: Option<Duration>,
    /// How long it must stay so, once it is.
    #[serde(default, deserialize_with = "optional_time")]
    #[schemars(with = "Option<Time>")]
    pub lasting: Option<Duration>,
    /// It must be so already, and stay so for so long.
    #[serde(default, deserialize_with = "optional_time")]
    #[schemars(with = "Option<Time>")]
    pub stays: Option<Duration>,
    /// The statusword is what this TPDO begins with, and is not read by SDO.
    #[serde(default, deserialize_with = "optional_pdo_number")]
    #[schemars(range(min = 1, max = 4))]
    pub in_tpdo: Option<u8>,
    /// The name of this check, for documented deviations.
    #[serde(default)]
    pub check: Option<String>,
}
