//! The events of a lane.

use schemars::JsonSchema;
use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::hex::{FrameLine, HexBytes};
use crate::{Verdict, VerdictCounts};

/// Takes events as they happen.
pub trait Sink {
    /// One more event, later than or at the same instant as the last.
    fn emit(&mut self, event: Event);
}

impl Sink for Vec<Event> {
    fn emit(&mut self, event: Event) {
        self.push(event);
    }
}

/// Something that happened.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "event", rename_all = "kebab-case")]
pub enum Event {
    /// The lane was opened; always the first line of a journal.
    LaneStarted(Box<LaneStarted>),
    /// A suite begins on this lane.
    SuiteStarted(Box<SuiteStarted>),
    /// A case begins. Skipped cases have this too.
    CaseStarted(Box<CaseStarted>),
    /// A step begins.
    StepStarted(StepStarted),
    /// What the device says of itself, read before the first case.
    Identity(Box<Identity>),
    /// The case is over, and what it changed is put back.
    PuttingBack(PuttingBack),
    /// A CAN frame was sent or received.
    Frame(FrameEvent),
    /// A serial frame (bytes between silences) was sent or received.
    Serial(Box<SerialEvent>),
    /// The tester's CAN controller told of trouble on the bus.
    BusError(Box<BusErrorEvent>),
    /// The bench did something to the device beside the bus.
    Stimulus(Box<StimulusEvent>),
    /// A time was measured and judged.
    Measurement(Box<Measurement>),
    /// A value was recorded without judging.
    Observation(Box<Observation>),
    /// Something worth a line that decides nothing: an EMCY, a PDO that nothing expected.
    Note(Box<Note>),
    /// A case ended.
    CaseFinished(Box<CaseFinished>),
    /// A suite ended on this lane.
    SuiteFinished(SuiteFinished),
    /// The lane was closed; a journal without this line is incomplete.
    LaneFinished(Box<LaneFinished>),
}

/// A port of the lane, as the link describes it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct PortInfo {
    /// `can`, `serial`.
    pub name: String,
    /// `sim:`, `socketcan:can0`.
    pub link: String,
    /// `250 kbit/s`, `9600 8N1`.
    pub line: String,
    /// Where instants come from.
    pub timestamps: String,
    /// How far an instant may be off, in nanoseconds.
    pub uncertainty_ns: u64,
}

/// See [`Event::LaneStarted`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct LaneStarted {
    /// `fieldproof 0.1.0`
    pub tool: String,
    /// The device's name in the bench.
    pub device: String,
    /// Its title.
    pub title: String,
    /// The fault switched on in a reference device, if any.
    pub fault: Option<String>,
    /// The legal variant that a reference device is, if any.
    pub variant: Option<String>,
    /// The seed of the run.
    pub seed: u64,
    /// The ports.
    pub ports: Vec<PortInfo>,
}

/// See [`Event::Identity`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Identity {
    /// When all was read.
    pub at_ns: u64,
    /// What was asked for.
    pub parts: Vec<IdentityPart>,
}

/// One thing that a device says of itself.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct IdentityPart {
    /// `vendor-id`, `software-version`.
    pub name: String,
    /// Where it is read: `1018h:01`, `identification object 02h`.
    pub object: String,
    /// What the device says.
    pub read: Option<String>,
    /// Why it said nothing: `refused with 06020000h`.
    pub unread: Option<String>,
    /// What its description claims.
    pub described: Option<String>,
}

impl IdentityPart {
    /// Whether the device says what its description claims; `None` where one of them says nothing.
    pub fn agrees(&self) -> Option<bool> {
        Some(self.read.as_ref()? == self.described.as_ref()?)
    }
}

/// See [`Event::SuiteStarted`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct SuiteStarted {
    /// Its id.
    pub suite: String,
    /// Its title.
    pub title: String,
    /// Its file.
    pub path: String,
}

/// A citation.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Cite {
    /// The document.
    pub document: String,
    /// The section.
    pub section: Option<String>,
}

/// See [`Event::CaseStarted`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct CaseStarted {
    /// `suite/case[key=value]`.
    pub id: String,
    /// `suite/case`.
    pub written_id: String,
    /// One line.
    pub title: String,
    /// When.
    pub at_ns: u64,
    /// Sources it follows.
    pub cites: Vec<Cite>,
    /// Sources it decides against.
    pub against: Vec<Cite>,
    /// Why it does.
    pub because: Option<String>,
    /// Worked examples it plays.
    pub examples: Vec<String>,
    /// What it does to the device.
    pub effects: Vec<String>,
    /// Its control and its steps, as the suite file has them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub steps: Vec<WrittenStep>,
    /// Where it stands.
    pub place: Place,
}

/// A step as the suite file has it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct WrittenStep {
    /// Its line.
    pub line: u32,
    /// Whether it belongs to the control.
    #[serde(default, skip_serializing_if = "is_false")]
    pub control: bool,
    /// Its text, without the indentation that it stands under.
    pub text: String,
}

fn is_false(value: &bool) -> bool {
    !value
}

/// A place in a suite file, with the text of its line, so that a report needs no suite at hand.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
pub struct Place {
    /// The file.
    pub path: String,
    /// Line, from 1; 0 for no place.
    pub line: u32,
    /// First column, from 1.
    pub column: u32,
    /// The column after the last.
    pub end_column: u32,
    /// The line's text.
    pub text: String,
}

/// See [`Event::StepStarted`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct StepStarted {
    /// Its place in the case, from 0, control first.
    pub step: u32,
    /// Its line in the suite file.
    pub line: u32,
    /// When.
    pub at_ns: u64,
}

/// See [`Event::PuttingBack`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct PuttingBack {
    /// When.
    pub at_ns: u64,
}

/// From where to where.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Direction {
    /// By the tester.
    Sent,
    /// By the device, or another on the bus.
    Received,
    /// By one of the tester's participants.
    Companion,
}

/// See [`Event::Frame`]. The bytes at and after `len` are zero. In the journal `data` is hexadecimal, and only a remote
/// frame gives its length by itself.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(into = "FrameLine", try_from = "FrameLine")]
pub struct FrameEvent {
    /// The end of its last bit.
    pub at_ns: u64,
    /// The port, by its place in [`LaneStarted::ports`].
    pub port: u8,
    /// From where to where.
    pub direction: Direction,
    /// The identifier.
    pub id: u32,
    /// Whether the identifier has 29 bits.
    pub extended: bool,
    /// Whether it is a remote frame.
    pub remote: bool,
    /// The data length code, `0..=8`.
    pub len: u8,
    /// The data.
    pub data: [u8; 8],
    /// What it means, with the names that the device's dictionary gives.
    pub decoded: Option<Box<str>>,
}

/// See [`Event::Serial`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct SerialEvent {
    /// The end of its last character.
    pub at_ns: u64,
    /// The start of its first character.
    pub start_ns: u64,
    /// The port.
    pub port: u8,
    /// From where to where.
    pub direction: Direction,
    /// The bytes; hexadecimal in the journal.
    #[serde(with = "HexBytes")]
    #[schemars(with = "HexBytes")]
    pub bytes: Vec<u8>,
    /// Whether a character was spoilt (parity, framing).
    pub spoilt: bool,
    /// What it means.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub decoded: Option<Box<str>>,
}

/// See [`Event::BusError`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct BusErrorEvent {
    /// When.
    pub at_ns: u64,
    /// The port.
    pub port: u8,
    /// `controller: transmit error passive; transmit errors 136, receive errors 0`
    pub what: String,
    /// Whether the controller has left the bus.
    pub bus_off: bool,
    /// Transmit and receive errors as the controller counts them, where its driver tells.
    pub counters: Option<(u8, u8)>,
}

/// See [`Event::Stimulus`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct StimulusEvent {
    /// When.
    pub at_ns: u64,
    /// `power off`, `process value 6063:00 = -12013`.
    pub what: String,
}

/// Limits in nanoseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Limits {
    /// Not below, if limited.
    pub min_ns: Option<u64>,
    /// Not above, if limited.
    pub max_ns: Option<u64>,
}

/// See [`Event::Measurement`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Measurement {
    /// When it was complete.
    pub at_ns: u64,
    /// `SDO response time`, `heartbeat period (mean of 10)`.
    pub name: Cow<'static, str>,
    /// What was measured.
    pub value_ns: u64,
    /// How far off it may be.
    pub uncertainty_ns: u64,
    /// The limits.
    pub limits: Limits,
    /// Inside is a pass, outside a fail, across a limit inconclusive.
    pub verdict: Verdict,
}

/// See [`Event::Observation`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Observation {
    /// When.
    pub at_ns: u64,
    /// What.
    pub name: String,
    /// The value, for people.
    pub value: String,
}

/// See [`Event::Note`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Note {
    /// When.
    pub at_ns: u64,
    /// The line.
    pub text: String,
}

/// Something that kept a case from passing.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Failure {
    /// What it amounts to: fail, deviation, inconclusive or error.
    pub verdict: Verdict,
    /// The step.
    pub place: Place,
    /// When.
    pub at_ns: u64,
    /// In one sentence: `the abort names another object`.
    pub what: String,
    /// What was expected: `581#8041600011000906  SDO abort 6041h:01 06090011h`.
    pub expected: String,
    /// What came instead: `nothing within 50 ms`.
    pub actual: String,
    /// More to know: which bytes differ, what the deviation's source says.
    pub notes: Vec<String>,
}

/// A line of the frames around a failure.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct ExcerptLine {
    /// When.
    pub at_ns: u64,
    /// The port's name.
    pub port: String,
    /// From where to where.
    pub direction: Direction,
    /// The frame: can-utils notation, or bytes in hex.
    pub raw: String,
    /// What it means.
    pub decoded: String,
    /// Whether the failure rests on this line.
    pub marked: bool,
}

/// See [`Event::CaseFinished`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct CaseFinished {
    /// Its id.
    pub id: String,
    /// When.
    pub at_ns: u64,
    /// How long it took on the lane's clock.
    pub duration_ns: u64,
    /// The verdict.
    pub verdict: Verdict,
    /// Why it was skipped.
    pub reason: Option<String>,
    /// What kept it from passing; the first one decides what is shown first.
    pub failures: Vec<Failure>,
    /// The frames around the failures; empty for a pass.
    pub excerpt: Vec<ExcerptLine>,
}

/// See [`Event::SuiteFinished`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct SuiteFinished {
    /// Its id.
    pub suite: String,
    /// When.
    pub at_ns: u64,
    /// The verdicts of its cases.
    pub counts: VerdictCounts,
}

/// See [`Event::LaneFinished`].
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct LaneFinished {
    /// When.
    pub at_ns: u64,
    /// All verdicts.
    pub counts: VerdictCounts,
    /// Why it ended before its last case: interrupted, the link failed, the device could not be put back.
    pub stopped: Option<String>,
}
