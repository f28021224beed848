//! The services of CANopen beside SDO.

use std::time::Duration;

use schemars::JsonSchema;
use serde::Deserialize;

use super::{Decode, ValueType};
use crate::file::{ExpectTpdoFile, SendRpdoFile, SyncFile};
use crate::read_with::{optional_node, optional_time, ten, time};
use crate::scalar::{BytePatternText, Bytes, ObjectAddress, Time, Tolerance, Value};

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
    /// Which.
    pub pdo: PdoName,
    /// How long after the last send (the last SYNC, say).
    pub within: Option<Duration>,
    /// What it must carry.
    pub data: Option<BytePatternText>,
    /// What it must carry, value after value, and nothing more; empty: nothing is said.
    pub carries: Vec<Carried>,
    /// What its bytes must mean.
    pub decode: Vec<Decode>,
    /// If given, `count` periods between this and the following ones are measured.
    pub period: Option<Tolerance>,
    /// If given, so many SYNCs are between this and the next, and so on, `count` times.
    pub syncs: Option<u32>,
    /// How many periods.
    pub count: u32,
    /// What of the periods must keep the limit.
    pub judge: Judge,
    /// The name of this check, for documented deviations.
    pub check: Option<String>,
}

/// Sends a receive PDO.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(try_from = "SendRpdoFile")]
pub struct SendRpdo {
    /// Which.
    pub pdo: PdoName,
    /// What it carries, at most 8 bytes; else `carries`.
    pub data: Option<Bytes>,
    /// What it carries, value after value.
    pub carries: Vec<Carried>,
}

/// Which PDO.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PdoName {
    /// 1 to 4: its predefined identifier.
    Number(u8),
    /// That with this identifier.
    Identifier(u16),
}

/// A value in a PDO.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Carried {
    /// Its type.
    pub value_type: ValueType,
    /// The value.
    pub value: Value,
}

/// Expects that a PDO's mapping is right: what is mapped is in the dictionary, with this length, and fits a PDO.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ExpectMapping {
    /// The mapping parameter: `"1A00:00"`.
    pub of: ObjectAddress,
    /// The name of this check, for documented deviations.
    #[serde(default)]
    pub check: Option<String>,
}
