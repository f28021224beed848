//! What a device claims of itself: `device.yaml` (the PICS and what surrounds it).

use std::collections::BTreeMap;
use std::fmt;
use std::time::Duration;

use schemars::{JsonSchema, Schema, json_schema};
use serde::Deserialize;

use crate::Position;
use crate::code;
use crate::identity::Identity;
use crate::model::{Citation, Effect, Source};
use crate::problem::Wrong;
use crate::read_with::{address, node};
use crate::scalar::{Text, read_as_text, whole_number};

/// A device description.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeviceDescription {
    /// The version of the language: 1.
    pub language: u32,
    /// The name suites and the command line use: `kinco-servo`.
    pub device: String,
    /// One line for people.
    pub title: String,
    /// Documents it cites.
    pub sources: BTreeMap<String, Source>,
    /// Who it claims to be.
    pub identity: Identity,
    /// Its ports by role.
    pub ports: BTreeMap<String, PortDescription>,
    /// The CANopen side.
    pub canopen: Option<CanopenDescription>,
    /// The Modbus side.
    pub modbus: Option<ModbusDescription>,
    /// What it claims to do.
    pub features: Vec<Feature>,
    /// How fast it promises to be.
    pub timing: Timing,
    /// What the effects of a case may do to things and people, in words: `moves: the shaft turns`.
    pub dangers: BTreeMap<Effect, String>,
    /// Where its documents depart from the standard.
    pub deviates: Vec<Deviation>,
}

/// A port of the device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum PortDescription {
    /// `{can: 250 kbit/s}`
    Can {
        /// Bits a second.
        bit_rate: u32,
    },
    /// `{serial: 9600, parity: none, stop-bits: 1}`; with `companion`, the tester plays that participant there.
    Serial {
        /// Bits a second.
        baud: u32,
        /// `none`, `even`, `odd`.
        parity: Parity,
        /// 1 or 2.
        stop_bits: u8,
        /// What the tester plays on this port: `teco-inverter`.
        companion: Option<String>,
    },
    /// `{tcp: 502}`: Modbus TCP.
    Tcp {
        /// Where it listens.
        port: u16,
    },
}

/// Parity by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Parity {
    /// No parity bit.
    None,
    /// Even.
    Even,
    /// Odd.
    Odd,
}

/// The CANopen side of a device.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct CanopenDescription {
    /// Its node-ID out of the box.
    #[serde(deserialize_with = "node")]
    #[schemars(range(min = 1, max = 127))]
    pub node: u8,
    /// Its EDS, a file beside the description.
    pub eds: String,
}

/// The Modbus side of a device.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ModbusDescription {
    /// Its address out of the box.
    #[serde(deserialize_with = "address")]
    #[schemars(range(min = 1, max = 247))]
    pub address: u8,
    /// Its register map, a file beside the description.
    #[serde(default)]
    pub registers: Option<String>,
    /// The functions it has, with the sub-functions of 8 and 43: `[3, 6, 16, 8/0, 43/14]`. Where nothing is said,
    /// nothing is known.
    #[serde(default)]
    pub functions: Vec<FunctionCode>,
    /// How many connections of Modbus TCP it serves at once. Where nothing is said, nothing is known.
    #[serde(default)]
    pub connections: Option<u16>,
}

impl ModbusDescription {
    /// Whether it has a function, as far as the description says so.
    pub fn claims(&self, asked: FunctionCode) -> bool {
        self.functions.iter().any(|claimed| {
            claimed.function == asked.function
                && (asked.sub_function.is_none() || claimed.sub_function == asked.sub_function)
        })
    }
}

/// A Modbus function, or one sub-function of it: `3`, `0x10`, `8/4`, `43/14`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct FunctionCode {
    /// 1 to 127.
    pub function: u8,
    /// Of 08h the sub-function, of 2Bh the MEI type.
    pub sub_function: Option<u16>,
}

/// `08h`, `08h/04h`
impl fmt::Display for FunctionCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:02X}h", self.function)?;
        match self.sub_function {
            Some(sub) => write!(f, "/{sub:02X}h"),
            None => Ok(()),
        }
    }
}

impl Text for FunctionCode {
    const EXPECTED: &'static str = "a function such as 3 or 8/4";

    fn parse(text: &str) -> Result<FunctionCode, Wrong> {
        let (function, sub) = match text.split_once('/') {
            Some((function, sub)) => (function, Some(sub)),
            None => (text, None),
        };
        let sub = sub.map(|sub| whole_number(sub).and_then(|sub| u16::try_from(sub).ok()));
        let function = whole_number(function).and_then(|code| u8::try_from(code).ok());
        match (function.filter(|code| (1..=127).contains(code)), sub) {
            (Some(function), None) => Ok(FunctionCode {
                function,
                sub_function: None,
            }),
            (Some(function), Some(Some(sub))) => Ok(FunctionCode {
                function,
                sub_function: Some(sub),
            }),
            _ => Err(Wrong::new(
                code::NUMBER,
                format!("`{text}` is no function"),
                "expected 1 to 127, or a function and a sub-function such as 8/4",
            )),
        }
    }

    fn schema() -> Schema {
        json_schema!({"type": ["integer", "string"]})
    }
}

read_as_text!(FunctionCode);

/// How fast a device promises to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Timing {
    /// From an SDO request to its answer. Where nothing is promised: 500 ms.
    pub sdo_response: Duration,
    /// From a Modbus request to its answer. Where nothing is promised: 1 s.
    pub modbus_response: Duration,
    /// From power-on or reset to the boot-up message. Where nothing is promised: 5 s.
    pub boot_up: Duration,
    /// From an LSS request to its answer. Where nothing is promised: 500 ms.
    pub lss_response: Duration,
    /// From an NMT command to the new state. Where nothing is promised: 100 ms.
    pub nmt_transition: Duration,
}

/// A documented departure from what a named check expects.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Deviation {
    /// The check.
    pub check: String,
    /// What the device does instead.
    pub instead: Instead,
    /// Where it says so.
    pub cite: Vec<Citation>,
    /// Where the check is named.
    pub at: Position,
}

/// What a device does instead of what a check expects.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Instead {
    /// It answers with this Modbus exception: `{exception: illegal-data-address}`.
    Exception(u8),
    /// It aborts with this code: `{abort: 0x06010000}`.
    Abort(u32),
    /// A CAN frame like this comes: `{frame: "581#607A6000A0860100"}`.
    Frame(fieldproof_can::Pattern),
    /// The value is this: `{value: 17}`.
    Value(i128),
    /// It stays silent: `silence`.
    Silence,
    /// It does answer where silence was expected: `answer`.
    Answer,
}

/// What a device may claim, in the words of the standards.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Feature {
    /// NMT slave with the CiA 301 state machine.
    NmtSlave,
    /// Produces heartbeats (1017h).
    HeartbeatProducer,
    /// Answers node guarding (100Ch, 100Dh).
    NodeGuarding,
    /// SDO server, expedited.
    SdoServer,
    /// Segmented SDO transfer.
    SdoSegmented,
    /// SDO block transfer.
    SdoBlock,
    /// Sends PDOs.
    Tpdo,
    /// Has transmission type 0: a TPDO is sent with the SYNC after an event.
    AcyclicPdo,
    /// Sends an event-driven PDO when what it carries changes.
    EventTpdo,
    /// Receives PDOs.
    Rpdo,
    /// PDO mapping can be changed.
    DynamicMapping,
    /// Data types can be mapped as dummies.
    DummyMapping,
    /// Consumes SYNC.
    SyncConsumer,
    /// Consumes the counter of SYNC (1019h), and knows start values.
    SyncCounter,
    /// Produces SYNC.
    SyncProducer,
    /// Sends EMCY.
    Emergency,
    /// Takes TIME.
    TimeConsumer,
    /// Produces TIME.
    TimeProducer,
    /// LSS slave.
    Lss,
    /// LSS slaves that are asked for by their identity, or for having no node-ID, identify themselves.
    LssIdentify,
    /// A bit rate becomes active over LSS, with no reset.
    LssActivateBitTiming,
    /// LSS fastscan.
    LssFastscan,
    /// A remote frame fetches a TPDO whose COB-ID allows it.
    RemoteFrames,
    /// The state machine of drives, CiA 402.
    Cia402,
    /// Mode of operation 1 of CiA 402.
    ProfilePosition,
    /// Mode of operation 2 of CiA 402.
    Velocity,
    /// Mode of operation 3 of CiA 402.
    ProfileVelocity,
    /// Mode of operation 4 of CiA 402.
    TorqueProfile,
    /// Mode of operation 6 of CiA 402.
    Homing,
    /// Mode of operation 7 of CiA 402.
    InterpolatedPosition,
    /// Mode of operation 8 of CiA 402.
    CyclicSynchronousPosition,
    /// Mode of operation 9 of CiA 402.
    CyclicSynchronousVelocity,
    /// Mode of operation 10 of CiA 402.
    CyclicSynchronousTorque,
    /// An encoder profile device, CiA 406.
    Cia406,
    /// Modbus RTU slave.
    ModbusRtu,
    /// Modbus TCP server.
    ModbusTcp,
    /// It has never been configured: everything has the default of its dictionary.
    FactorySettings,
    /// SSI output.
    Ssi,
    /// CANopen on one side, Modbus master on the other.
    Gateway,
}
