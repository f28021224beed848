//! The services of CANopen beside SDO.

use std::time::Duration;

use schemars::JsonSchema;
use serde::Deserialize;

use super::Decode;
use crate::file::{ExpectTpdoFile, SyncFile};
use crate::read_with::{optional_node, optional_time, pdo_data, pdo_number, ten, time};
use crate::scalar::{BytePatternText, Bytes, Time, Tolerance};

/// Sends an NMT command. Short form: the command alone.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Nmt {
    /// The command.
    pub command: NmtCommand,
    /// Whom it is for.
    #[serde(default)]
    pub node: NmtAddress,
}

/// NMT commands by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum NmtCommand {
    /// 01h
    Start,
    /// 02h
    Stop,
    /// 80h
    EnterPreOperational,
    /// 81h
    ResetNode,
    /// 82h
    ResetCommunication,
}

/// Whom an NMT command is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum NmtAddress {
    /// The device under test.
    #[default]
    This,
    /// 0: all nodes.
    All,
    /// This node-ID, whoever has it.
    Other(u8),
}

/// NMT states by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum NmtState {
    /// 7Fh
    PreOperational,
    /// 05h
    Operational,
    /// 04h
    Stopped,
}

/// Expects an NMT state.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ExpectState {
    /// The state.
    pub is: NmtState,
    /// How long after the last send.
    #[serde(default, deserialize_with = "optional_time")]
    #[schemars(with = "Option<Time>")]
    pub within: Option<Duration>,
    /// The name of this check, for documented deviations.
    #[serde(default)]
    pub check: Option<String>,
}

/// Expects the boot-up message. Short form: the duration alone.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ExpectBootUp {
    /// How long after the last send.
    #[serde(default, deserialize_with = "optional_time")]
    #[schemars(with = "Option<Time>")]
    pub within: Option<Duration>,
    /// The node-ID it comes from, if not the present one.
    #[serde(default, deserialize_with = "optional_node")]
    #[schemars(range(min = 1, max = 127))]
    pub node: Option<u8>,
}

/// Expects heartbeats and measures them.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ExpectHeartbeat {
    /// From one heartbeat to the next.
    pub period: Tolerance,
    /// What of the periods must keep it.
    #[serde(default)]
    pub judge: Judge,
    /// How many periods are measured.
    #[serde(default = "ten")]
    pub count: u32,
    /// The state they must carry.
    pub state: NmtState,
}

/// What of several measurements must keep the limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Judge {
    /// Every one.
    #[default]
    Each,
    /// The mean.
    Mean,
    /// The median.
    Median,
}

/// Sends SYNC messages. Short form: nothing, for one SYNC.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(try_from = "SyncFile")]
pub struct Sync {
    /// How many.
    pub count: u32,
    /// From one to the next.
    pub period: Duration,
}

/// Starts a SYNC producer.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct StartSync {
    /// From one to the next.
    #[serde(deserialize_with = "time")]
    #[schemars(with = "Time")]
    pub period: Duration,
}

/// Expects a transmit PDO.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(try_from = "ExpectTpdoFile")]
pub struct ExpectTpdo {
    /// 1 to 4: its predefined identifier.
    pub number: u8,
    /// How long after the last send (the last SYNC, say).
    pub within: Option<Duration>,
    /// What it must carry.
    pub data: Option<BytePatternText>,
    /// What its bytes must mean.
    pub decode: Vec<Decode>,
    /// If given, `count` periods between this and the following ones are measured.
    pub period: Option<Tolerance>,
    /// How many periods.
    pub count: u32,
    /// What of the periods must keep the limit.
    pub judge: Judge,
    /// The name of this check, for documented deviations.
    pub check: Option<String>,
}

/// Sends a receive PDO.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct SendRpdo {
    /// 1 to 4: its predefined identifier.
    #[serde(deserialize_with = "pdo_number")]
    #[schemars(range(min = 1, max = 4))]
    pub number: u8,
    /// What it carries, at most 8 bytes.
    #[serde(deserialize_with = "pdo_data")]
    pub data: Bytes,
}
