//! One action or expectation: the verbs.

use schemars::JsonSchema;
use serde::Deserialize;

use super::{
    Connect, Disconnect, DriveTarget, Expect, ExpectBootUp, ExpectBytes, ExpectDrive,
    ExpectHeartbeat, ExpectMapping, ExpectSilence, ExpectState, ExpectTpdo, Flood, Located, Modbus,
    Nmt, NmtState, SdoRead, SdoWrite, Send, SendBytes, SendRpdo, StartSync, Stimulate, Sync,
};
use crate::forms::{either, either_schema};
use crate::read_with::{bit_rate, read_later, times};
use crate::scalar::BitRate;

/// One action or expectation. In the file: a map with one key, the verb in kebab case.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Step {
    /// `send: "601#4063600000000000"`: a CAN frame, whatever it says.
    Send(
        #[serde(deserialize_with = "either")]
        #[schemars(schema_with = "either_schema::<Send>")]
        Send,
    ),
    /// `expect: "581#43636000????????"`: the next frame with this identifier must match.
    Expect(
        #[serde(deserialize_with = "either")]
        #[schemars(schema_with = "either_schema::<Expect>")]
        Expect,
    ),
    /// `expect-silence: 500 ms`: nothing arrives (of the given identifiers, or on the port).
    ExpectSilence(
        #[serde(deserialize_with = "either")]
        #[schemars(schema_with = "either_schema::<ExpectSilence>")]
        ExpectSilence,
    ),
    /// `nmt: start`: an NMT command to this node, or to `node: all`.
    Nmt(
        #[serde(deserialize_with = "either")]
        #[schemars(schema_with = "either_schema::<Nmt>")]
        Nmt,
    ),
    /// `nmt-enter: operational`: brings the node into a state and makes sure; if it cannot, the case is inconclusive.
    NmtEnter(NmtState),
    /// `expect-state: {is: stopped, within: 100 ms}`: by heartbeat, guarding, or what the state forbids and allows.
    ExpectState(ExpectState),
    /// `expect-boot-up: {within: 2 s}`: 700h + node, one byte 00.
    ExpectBootUp(
        #[serde(deserialize_with = "either")]
        #[schemars(schema_with = "either_schema::<ExpectBootUp>")]
        ExpectBootUp,
    ),
    /// `expect-heartbeat: {period: 100 ms ± 5 %, count: 10, state: operational}`.
    ExpectHeartbeat(ExpectHeartbeat),
    /// `sync:` or `sync: {count: 3, period: 100 ms}`: sends SYNC messages.
    Sync(
        #[serde(deserialize_with = "either")]
        #[schemars(schema_with = "either_schema::<Sync>")]
        Sync,
    ),
    /// `start-sync: {period: 100 ms}`: a SYNC producer beside the case until `stop-sync` or its end.
    StartSync(StartSync),
    /// `stop-sync:`.
    StopSync,
    /// `expect-tpdo: {number: 1, within: 100 ms, data: "D7C70000????????"}`.
    ExpectTpdo(ExpectTpdo),
    /// `expect-mapping: {of: "1A00:00"}`: what is mapped there is in the dictionary, with this length.
    ExpectMapping(ExpectMapping),
    /// `send-rpdo: {number: 1, data: "0F00"}`.
    SendRpdo(SendRpdo),
    /// `sdo-read: {object: "1000:00", as: u32, expect: 0x192}`.
    SdoRead(SdoRead),
    /// `sdo-write: {object: "1017:00", as: u16, value: 100 ms, unit: 1 ms}`; put back after the case.
    SdoWrite(SdoWrite),
    /// `drive-enter: operation-enabled`: brings a drive into a state by its controlword and makes sure; if it cannot, the
    /// case is inconclusive.
    DriveEnter(DriveTarget),
    /// `expect-drive: {is: ready-to-switch-on, within: 1 s}`: what the statusword says.
    ExpectDrive(ExpectDrive),
    /// `modbus: {read-holding: {address: 0, count: 1}, expect: {registers: [1]}}`; writes are put back after the case.
    Modbus(Modbus),
    /// `send-bytes: {bytes: "20 03 00 00 00 01", crc: append}`.
    SendBytes(
        #[serde(deserialize_with = "either")]
        #[schemars(schema_with = "either_schema::<SendBytes>")]
        SendBytes,
    ),
    /// `expect-bytes: "20 03 02 0F B4 01 C4"`: the next frame on the serial port must match.
    ExpectBytes(
        #[serde(deserialize_with = "either")]
        #[schemars(schema_with = "either_schema::<ExpectBytes>")]
        ExpectBytes,
    ),
    /// `connect: one`: opens a further connection of Modbus TCP, a port of this name until the case ends.
    Connect(
        #[serde(deserialize_with = "either")]
        #[schemars(schema_with = "either_schema::<Connect>")]
        Connect,
    ),
    /// `disconnect: one`, or `disconnect: {name: one, reset: true}`.
    Disconnect(
        #[serde(deserialize_with = "either")]
        #[schemars(schema_with = "either_schema::<Disconnect>")]
        Disconnect,
    ),
    /// `stimulate: {process-value: "6063:00", to: -12013}`.
    Stimulate(Stimulate),
    /// `set-bit-rate: 125 kbit/s`: the tester's own side of the CAN port.
    SetBitRate(
        #[serde(deserialize_with = "bit_rate")]
        #[schemars(with = "BitRate")]
        u32,
    ),
    /// `flood: {frames: 200, ids: [101-17F]}`: many frames drawn by chance, the same for the same seed.
    Flood(Flood),
    /// `repeat: {times: 128, steps: [...]}`: for what shows only the hundredth time.
    Repeat(Repeat),
}

/// See [`Step::Repeat`].
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Repeat {
    /// How many times, 1 to 1,000,000.
    #[serde(deserialize_with = "times")]
    #[schemars(range(min = 1, max = 1_000_000))]
    pub times: u32,
    /// The name under which a number stands that is one higher each time.
    #[serde(default)]
    pub count_as: Option<String>,
    /// What that number is the first time.
    #[serde(default)]
    pub from: u32,
    /// What is played each time.
    // Read apart from the rest, so that every wrong one is found.
    #[serde(deserialize_with = "read_later")]
    #[schemars(with = "Vec<Step>")]
    pub steps: Vec<Located<Step>>,
}
