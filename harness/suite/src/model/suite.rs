//! A suite and its cases, without their steps.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use super::Step;
use crate::identity::Claim;
use crate::read_with::{optional_address, optional_node};
use crate::scalar::ObjectAddress;
use crate::{Position, device};

/// A thing and its place in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Located<T> {
    /// The thing.
    pub value: T,
    /// Its place.
    pub at: Position,
}

/// The head of a suite file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SuiteHead {
    /// The version of the language: 1.
    pub language: u32,
    /// The id: `canopen.nmt`, `kinco-servo.worked-examples`.
    pub suite: String,
    /// One line for people.
    pub title: String,
    /// What the suite speaks; a device needs one of these ports to be tested.
    pub protocol: Protocol,
    /// The only device it is for, by the name of its description; without it the suite is for any device.
    pub device: Option<String>,
    /// The documents its cases cite, by short name.
    pub sources: BTreeMap<String, Source>,
}

/// What a suite speaks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Protocol {
    /// CANopen on CAN.
    Canopen,
    /// Modbus on a serial line.
    Modbus,
    /// Both, for a device with two ports.
    Gateway,
}

/// A document.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Source {
    /// Its title with the edition.
    pub document: String,
    /// The part the whole suite follows, if one.
    #[serde(default)]
    pub section: Option<String>,
}

/// A case that has been expanded (one row of its table) and read: ready to be played.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Case {
    /// `suite/case[key=value]`.
    pub id: String,
    /// `suite/case`: the case as written, before its table.
    pub written_id: String,
    /// One line for people.
    pub title: String,
    /// What it follows.
    pub cites: Vec<Citation>,
    /// What it decides against, when sources contradict each other.
    pub against: Vec<Citation>,
    /// Why it follows one source against another.
    pub because: Option<String>,
    /// The worked examples it plays, by their ids in the device's `worked-examples.txt`.
    pub examples: Vec<String>,
    /// What the device or the bench must offer.
    pub needs: Vec<Need>,
    /// The numbers of the device's identity that stand in it.
    pub claims: Vec<Claim>,
    /// What it does to the device.
    pub effects: Vec<Effect>,
    /// How thorough a run must be to play it.
    pub depth: Depth,
    /// The entries of catalogues that it realises: the catalogue and the entry.
    pub covers: Vec<(String, String)>,
    /// The node or address its frames are printed for.
    pub written_for: WrittenFor,
    /// What may not arrive during the case beside what steps expect.
    pub forbids: Vec<Forbidden>,
    /// What must be put back that steps cannot put back by themselves.
    pub restore: Restore,
    /// The positive check: if it does not pass, the case is inconclusive.
    pub control: Vec<Located<Step>>,
    /// The test.
    pub steps: Vec<Located<Step>>,
    /// Where the case stands in its file.
    pub at: Position,
}

/// A source with the section that matters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Citation {
    /// The short name of the source in the suite.
    pub source: String,
    /// The document's title.
    pub document: String,
    /// The section, from the case or else from the source.
    pub section: Option<String>,
}

/// What the device or the bench must offer for a case to make sense.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Need {
    /// A feature that the description claims.
    Feature(device::Feature),
    /// A stimulus that the bench offers: `stimulus: process-value`.
    Stimulus(StimulusName),
    /// Objects of the device's dictionary: `object: "1029:01"`.
    Objects(Vec<ObjectAddress>),
    /// Modbus functions that the description claims: `function: [3, 8/4]`.
    Functions(Vec<device::FunctionCode>),
    /// A node-ID that the device does not have: `another-node: 111`.
    AnotherNode(u8),
    /// A Modbus address that the device does not have: `another-address: 247`.
    AnotherAddress(u8),
}

/// How thorough a run is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Depth {
    /// As a matter of course.
    #[default]
    Default,
    /// With what takes long on real time.
    Full,
}

/// The kinds of stimulus by name: `power`, `process-value`, `condition`, `setting`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum StimulusName {
    /// Power off and on.
    Power,
    /// A value the device measures.
    ProcessValue,
    /// A condition of the device.
    Condition,
    /// A switch or front panel.
    Setting,
}

/// What a case does to the device. Only the bench permits it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Effect {
    /// Writes objects or registers, and puts them back.
    Writes,
    /// Writes non-volatile memory.
    Persists,
    /// Changes node-ID, address or bit rate.
    Readdresses,
    /// A motor may turn.
    Moves,
    /// Resets the device.
    Resets,
    /// Broadcasts, LSS global, floods: matters to others on the bus.
    DisturbsBus,
}

/// The node or address that the frames of a case are printed for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct WrittenFor {
    /// CANopen node-ID: CAN identifiers whose node part it is are moved to the bench's node, and byte 1 of an NMT
    /// command; unless `fixed`.
    #[serde(default, deserialize_with = "optional_node")]
    #[schemars(range(min = 1, max = 127))]
    pub node: Option<u8>,
    /// Modbus address: not moved, the device must have it.
    #[serde(default, deserialize_with = "optional_address")]
    #[schemars(range(min = 1, max = 247))]
    pub address: Option<u8>,
    /// The frames are not moved: the device must have this node-ID.
    #[serde(default)]
    pub fixed: bool,
}

/// A kind of traffic that a case does not allow beside what it expects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Forbidden {
    /// Process data objects.
    Pdo,
    /// Emergency messages.
    Emergency,
}

/// What is put back after a case beside what `sdo-write` and `modbus` steps put back by themselves.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Restore {
    /// Objects read before the case and written back after it.
    pub objects: Vec<ObjectAddress>,
    /// Holding registers read before the case and written back after it.
    pub registers: Vec<Span>,
    /// Coils read before the case and switched back after it.
    pub coils: Vec<Span>,
    /// Played at the end, whatever happened, before objects and registers are written back.
    pub steps: Vec<Located<Step>>,
}

/// Addresses in a row of one Modbus table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Span {
    /// The first of them.
    pub first: u16,
    /// How many; at least one.
    pub count: u16,
}
