//! What a suite file may say: the words of the language as types. The JSON Schema is made from these, and the loader
//! reads into these.

use std::collections::BTreeMap;
use std::time::Duration;

use crate::scalar::{
    BytePatternText, Bytes, Decimal, FrameText, Number, ObjectAddress, PatternText, Tolerance,
    Value,
};
use crate::{Position, device};

/// A thing and its place in the file.
#[derive(Debug, Clone, PartialEq, Eq)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Protocol {
    /// CANopen on CAN.
    Canopen,
    /// Modbus on a serial line.
    Modbus,
    /// Both, for a device with two ports.
    Gateway,
}

/// A document.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// Its title with the edition.
    pub document: String,
    /// The part the whole suite follows, if one.
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
    /// What it does to the device.
    pub effects: Vec<Effect>,
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
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Need {
    /// A feature that the description claims.
    Feature(device::Feature),
    /// A stimulus that the bench offers: `stimulus: process-value`.
    Stimulus(StimulusName),
}

/// The kinds of stimulus by name: `power`, `process-value`, `condition`, `setting`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct WrittenFor {
    /// CANopen node-ID: CAN identifiers whose node part it is are moved to the bench's node, and byte 1 of an NMT
    /// command; unless `fixed`.
    pub node: Option<u8>,
    /// Modbus address: not moved, the device must have it.
    pub address: Option<u8>,
    /// The frames are not moved: the device must have this node-ID.
    pub fixed: bool,
}

/// A kind of traffic that a case does not allow beside what it expects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
    pub registers: Vec<u16>,
    /// Played at the end, whatever happened, before objects and registers are written back.
    pub steps: Vec<Located<Step>>,
}

/// One action or expectation. In the file: a map with one key, the verb in kebab case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// `send: "601#4063600000000000"`: a CAN frame, whatever it says.
    Send(Send),
    /// `expect: "581#43636000????????"`: the next frame with this identifier must match.
    Expect(Expect),
    /// `expect-silence: 500 ms`: nothing arrives (of the given identifiers, or on the port).
    ExpectSilence(ExpectSilence),
    /// `nmt: start`: an NMT command to this node, or to `node: all`.
    Nmt(Nmt),
    /// `nmt-enter: operational`: brings the node into a state and makes sure; if it cannot, the case is inconclusive.
    NmtEnter(NmtState),
    /// `expect-state: {is: stopped, within: 100 ms}`: by heartbeat, guarding, or what the state forbids and allows.
    ExpectState(ExpectState),
    /// `expect-boot-up: {within: 2 s}`: 700h + node, one byte 00.
    ExpectBootUp(ExpectBootUp),
    /// `expect-heartbeat: {period: 100 ms ± 5 %, count: 10, state: operational}`.
    ExpectHeartbeat(ExpectHeartbeat),
    /// `sync:` or `sync: {count: 3, period: 100 ms}`: sends SYNC messages.
    Sync(Sync),
    /// `start-sync: {period: 100 ms}`: a SYNC producer beside the case until `stop-sync` or its end.
    StartSync(StartSync),
    /// `stop-sync:`.
    StopSync,
    /// `expect-tpdo: {number: 1, within: 100 ms, data: "D7C70000????????"}`.
    ExpectTpdo(ExpectTpdo),
    /// `send-rpdo: {number: 1, data: "0F00"}`.
    SendRpdo(SendRpdo),
    /// `sdo-read: {object: "1000:00", as: u32, expect: 0x192}`.
    SdoRead(SdoRead),
    /// `sdo-write: {object: "1017:00", as: u16, value: 100 ms, unit: 1 ms}`; put back after the case.
    SdoWrite(SdoWrite),
    /// `modbus: {read-holding: {address: 0, count: 1}, expect: {registers: [1]}}`; writes are put back after the case.
    Modbus(Modbus),
    /// `send-bytes: {bytes: "20 03 00 00 00 01", crc: append}`.
    SendBytes(SendBytes),
    /// `expect-bytes: "20 03 02 0F B4 01 C4"`: the next frame on the serial port must match.
    ExpectBytes(ExpectBytes),
    /// `stimulate: {process-value: "6063:00", to: -12013}`.
    Stimulate(Stimulate),
    /// `set-bit-rate: 125 kbit/s`: the tester's own side of the CAN port.
    SetBitRate(u32),
}

/// See [`Step::Send`]. Short form: the frame alone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Send {
    /// The frame.
    pub frame: FrameText,
}

/// See [`Step::Expect`]. Short form: the frame alone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Expect {
    /// What must come.
    pub frame: PatternText,
    /// How long after the last send; else what the description promises.
    pub within: Option<Duration>,
    /// What its bytes must mean.
    pub decode: Vec<Decode>,
    /// The name of this check, for documented deviations.
    pub check: Option<String>,
}

/// See [`Step::ExpectSilence`]. Short form: the duration alone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExpectSilence {
    /// How long from now.
    pub lasting: Duration,
    /// Only frames with these identifiers matter; else everything from the device on the suite's main port.
    pub of: Vec<u16>,
    /// The port; else the suite's main port.
    pub port: Option<String>,
    /// The name of this check, for documented deviations.
    pub check: Option<String>,
}

/// See [`Step::Nmt`]. Short form: the command alone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Nmt {
    /// The command.
    pub command: NmtCommand,
    /// Whom it is for.
    pub node: NmtAddress,
}

/// NMT commands by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NmtState {
    /// 7Fh
    PreOperational,
    /// 05h
    Operational,
    /// 04h
    Stopped,
}

/// See [`Step::ExpectState`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExpectState {
    /// The state.
    pub is: NmtState,
    /// How long after the last send.
    pub within: Option<Duration>,
    /// The name of this check, for documented deviations.
    pub check: Option<String>,
}

/// See [`Step::ExpectBootUp`]. Short form: the duration alone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExpectBootUp {
    /// How long after the last send.
    pub within: Option<Duration>,
    /// The node-ID it comes from, if not the present one.
    pub node: Option<u8>,
}

/// See [`Step::ExpectHeartbeat`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExpectHeartbeat {
    /// From one heartbeat to the next.
    pub period: Tolerance,
    /// What of the periods must keep it.
    pub judge: Judge,
    /// How many periods are measured.
    pub count: u32,
    /// The state they must carry.
    pub state: NmtState,
}

/// What of several measurements must keep the limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Judge {
    /// Every one.
    #[default]
    Each,
    /// The mean.
    Mean,
    /// The median.
    Median,
}

/// See [`Step::Sync`]. Short form: nothing, for one SYNC.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sync {
    /// How many.
    pub count: u32,
    /// From one to the next.
    pub period: Duration,
}

/// See [`Step::StartSync`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StartSync {
    /// From one to the next.
    pub period: Duration,
}

/// See [`Step::ExpectTpdo`].
#[derive(Debug, Clone, PartialEq, Eq)]
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

/// See [`Step::SendRpdo`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SendRpdo {
    /// 1 to 4: its predefined identifier.
    pub number: u8,
    /// What it carries.
    pub data: Bytes,
}

/// The type of a value on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ValueType {
    /// UNSIGNED8
    U8,
    /// UNSIGNED16
    U16,
    /// UNSIGNED24
    U24,
    /// UNSIGNED32
    U32,
    /// UNSIGNED64
    U64,
    /// INTEGER8
    I8,
    /// INTEGER16
    I16,
    /// INTEGER32
    I32,
    /// INTEGER64
    I64,
    /// Bit 15 is the sign, bits 14 to 0 the magnitude.
    SignMagnitude16,
    /// VISIBLE_STRING
    Text,
}

/// See [`Step::SdoRead`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SdoRead {
    /// The object.
    pub object: ObjectAddress,
    /// Its type; the answer must have its size.
    pub value_type: ValueType,
    /// What must come; without it, any value.
    pub expect: ReadExpectation,
    /// How long after the request; else what the description promises.
    pub within: Option<Duration>,
    /// Keeps the value under this name for later steps.
    pub save: Option<String>,
    /// Records the value as an observation with these words.
    pub observe: Option<String>,
    /// The name of this check, for documented deviations.
    pub check: Option<String>,
}

/// What a read must give.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum ReadExpectation {
    /// Any value of the right size.
    #[default]
    Any,
    /// This value: `expect: 5`, `expect: "JN5-CM-CAN"`, `expect: "{device_type}"`.
    Value(Value),
    /// One of these: `expect: {one-of: [1, 2]}`.
    OneOf(Vec<Value>),
    /// Between, limits included: `expect: {from: 5, to: 10}`.
    Range {
        /// Lower limit.
        from: i128,
        /// Upper limit.
        to: i128,
    },
    /// `expect: {abort: [0x06010002, 0x06010000], strict: 0x06010002}`
    Abort(AbortExpectation),
}

/// A refusal that is expected.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AbortExpectation {
    /// The abort codes that pass. The abort must name the object that was asked for.
    pub abort: Vec<u32>,
    /// The one code that passes under `--strict`.
    pub strict: Option<u32>,
}

/// See [`Step::SdoWrite`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SdoWrite {
    /// The object.
    pub object: ObjectAddress,
    /// The type it is sent as.
    pub value_type: ValueType,
    /// The value.
    pub value: Value,
    /// For a duration: what one count of the object is.
    pub unit: Option<Duration>,
    /// `ok` (the default) or `{abort: [...]}`.
    pub expect: WriteExpectation,
    /// How long after the request; else what the description promises.
    pub within: Option<Duration>,
    /// The name of this check, for documented deviations.
    pub check: Option<String>,
}

/// What a write must give.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum WriteExpectation {
    /// It is accepted.
    #[default]
    Ok,
    /// It is refused.
    Abort(AbortExpectation),
}

/// See [`Step::Modbus`]: one request and what must come back.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Modbus {
    /// The request; in the file the name of the function is a key beside `expect`.
    pub request: ModbusRequest,
    /// The answer.
    pub expect: ModbusExpectation,
    /// Whom it is sent to, if not the device's address.
    pub to: Option<u8>,
    /// How long after the request; else what the description promises.
    pub within: Option<Duration>,
    /// Keeps the first register under this name for later steps.
    pub save: Option<String>,
    /// Records the registers as an observation with these words.
    pub observe: Option<String>,
    /// The name of this check, for documented deviations.
    pub check: Option<String>,
}

/// A Modbus request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ModbusRequest {
    /// 03h `read-holding: {address: 0, count: 2}`
    ReadHolding {
        /// First register.
        address: u16,
        /// How many.
        count: u16,
    },
    /// 04h `read-input: {address: 0, count: 2}`
    ReadInput {
        /// First register.
        address: u16,
        /// How many.
        count: u16,
    },
    /// 06h `write-single: {address: 325, value: 1000}`
    WriteSingle {
        /// The register.
        address: u16,
        /// Its value.
        value: Number,
    },
    /// 10h `write-multiple: {address: 325, values: [1000, 2000]}`
    WriteMultiple {
        /// First register.
        address: u16,
        /// Their values.
        values: Vec<Number>,
    },
    /// `pdu: "2B 0E 01 00"`: any bytes.
    Pdu(Bytes),
}

/// What must come back.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum ModbusExpectation {
    /// A normal answer of the right shape, whatever it carries.
    #[default]
    Normal,
    /// `{registers: [500, 1000]}`
    Registers(Vec<Number>),
    /// `{exception: illegal-data-value}` or a list of them or of numbers.
    Exception(Vec<u8>),
    /// `{pdu: "83 02"}`
    Pdu(BytePatternText),
    /// `silence`
    Silence,
}

/// See [`Step::SendBytes`]. Short form: the bytes alone, CRC given.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SendBytes {
    /// The bytes.
    pub bytes: Bytes,
    /// What is done about the CRC.
    pub crc: Crc,
    /// The port; else `serial`.
    pub port: Option<String>,
}

/// What is done about the CRC of bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Crc {
    /// `given`: the bytes are sent as they stand.
    #[default]
    Given,
    /// `append`: the right CRC follows them.
    Append,
    /// `swapped`: the right CRC follows them, high byte first.
    Swapped,
    /// `{flip-bit: 3}`: the right CRC follows them, then this bit of the whole frame is turned over (bit 0 is the
    /// least significant of the first byte).
    FlipBit(u32),
}

/// See [`Step::ExpectBytes`]. Short form: the bytes alone.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ExpectBytes {
    /// The whole frame with its CRC.
    pub bytes: BytePatternText,
    /// How long after the last send; else what the description promises.
    pub within: Option<Duration>,
    /// The port; else `serial`.
    pub port: Option<String>,
    /// What its bytes must mean.
    pub decode: Vec<Decode>,
    /// The name of this check, for documented deviations.
    pub check: Option<String>,
}

/// What some bytes of a frame must mean: taken as a number, scaled, compared.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Decode {
    /// For an SDO answer: the object it must name; the bytes are then its data.
    pub object: Option<ObjectAddress>,
    /// Where the bytes start in the frame's data; 4 with `object`, else 0.
    pub offset: Option<usize>,
    /// Their type.
    pub value_type: ValueType,
    /// Byte order: `little` (CANopen, the default) or `big` (Modbus).
    pub big_endian: bool,
    /// Times this.
    pub multiply: i64,
    /// Through this.
    pub divide: i64,
    /// What must come out.
    pub equals: Decimal,
    /// How far off it may be; without it, exact.
    pub tolerance: Option<Decimal>,
    /// The unit, for people.
    pub unit: Option<String>,
    /// Of what, for people: `position`, `speed`.
    pub name: Option<String>,
}

/// See [`Step::Stimulate`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Stimulate {
    /// `{power: off}`, `{power: on}`, `{power: cycle}`
    Power(PowerAction),
    /// `{process-value: "6063:00", to: -12013}`
    ProcessValue {
        /// What.
        name: String,
        /// The raw value.
        to: i64,
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
}

/// What is done to the power.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PowerAction {
    /// Off.
    Off,
    /// On.
    On,
    /// Off for a second, then on.
    Cycle,
}
