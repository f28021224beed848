//! A device description.

use std::collections::BTreeMap;
use std::time::Duration;

use schemars::{JsonSchema, Schema, json_schema};
use serde::Deserialize;

use super::CiteFile;
use crate::code;
use crate::device::{
    CanopenDescription, Feature, Instead, ModbusDescription, Parity, PortDescription, Timing,
};
use crate::file::ModbusException;
use crate::forms::{Either, OneOrMany};
use crate::identity::Identity;
use crate::model::{Effect, Located, Source};
use crate::problem::Wrong;
use crate::read_with::time;
use crate::scalar::{BitRate, PatternText, Text, Time, read_as_text, whole_number};

/// What a device claims of itself.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Device")]
pub(crate) struct DeviceFile {
    /// The version of the language: 1.
    #[schemars(range(min = 1, max = 1))]
    pub(crate) language: u32,
    /// The name suites and the command line use: `kinco-servo`.
    pub(crate) device: Located<String>,
    /// One line for people.
    pub(crate) title: String,
    /// Documents it cites.
    #[serde(default)]
    pub(crate) sources: BTreeMap<String, Source>,
    /// Who it claims to be; what is not claimed is not asserted.
    #[serde(default)]
    pub(crate) identity: Identity,
    /// Its ports by role.
    pub(crate) ports: Located<BTreeMap<String, PortFile>>,
    /// The CANopen side.
    #[serde(default)]
    pub(crate) canopen: Option<Located<CanopenDescription>>,
    /// The Modbus side.
    #[serde(default)]
    pub(crate) modbus: Option<Located<ModbusDescription>>,
    /// What it claims to do.
    pub(crate) features: Vec<Feature>,
    /// How fast it promises to be.
    #[serde(default)]
    pub(crate) timing: TimingFile,
    /// What the effects of a case may do to things and people, in words.
    #[serde(default)]
    pub(crate) dangers: BTreeMap<Effect, String>,
    /// Where its documents depart from the standard.
    #[serde(default)]
    pub(crate) deviates: Vec<Located<DeviationFile>>,
}

/// A port: `{can: 250 kbit/s}` or `{serial: 9600, parity: none, stop-bits: 1}`.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Port")]
pub(crate) struct PortFile {
    /// The bit rate of a CAN port.
    #[serde(default)]
    can: Option<BitRate>,
    /// The bit rate of a serial port.
    #[serde(default)]
    serial: Option<BitRate>,
    /// Where a port of Modbus TCP listens.
    #[serde(default)]
    #[schemars(range(min = 1))]
    tcp: Option<u16>,
    /// Its parity; even where nothing is said, as the serial-line specification has it.
    #[serde(default)]
    parity: Option<Parity>,
    /// 1 or 2; 1 where nothing is said.
    #[serde(default)]
    #[schemars(range(min = 1, max = 2))]
    stop_bits: Option<u8>,
    /// What the tester plays on this port: `teco-inverter`.
    #[serde(default)]
    companion: Option<String>,
}

impl PortFile {
    pub(crate) fn lower(self) -> Result<PortDescription, Wrong> {
        let is_set = self.parity.is_some() || self.stop_bits.is_some() || self.companion.is_some();
        let alone = |what: &str, key: &str| {
            Err(Wrong::new(
                code::KEYS_TOGETHER,
                format!("a {what} port has no parity, no stop bits and no companion"),
                format!("expected `{key}` alone"),
            ))
        };
        match (self.can, self.serial, self.tcp) {
            (Some(_), None, None) if is_set => alone("CAN", "can"),
            (None, None, Some(_)) if is_set => alone("TCP", "tcp"),
            (Some(BitRate(bit_rate)), None, None) => Ok(PortDescription::Can { bit_rate }),
            (None, None, Some(port)) => Ok(PortDescription::Tcp { port }),
            (None, Some(BitRate(baud)), None) => {
                let stop_bits = self.stop_bits.unwrap_or(1);
                if !(1..=2).contains(&stop_bits) {
                    return Err(Wrong::new(
                        code::NUMBER,
                        format!("{stop_bits} stop bits"),
                        "expected 1 or 2",
                    ));
                }
                Ok(PortDescription::Serial {
                    baud,
                    parity: self.parity.unwrap_or(Parity::Even),
                    stop_bits,
                    companion: self.companion,
                })
            }
            _ => Err(Wrong::new(
                code::KEYS_TOGETHER,
                "a port is either CAN, serial or TCP",
                "expected `can`, `serial` or `tcp`",
            )),
        }
    }
}

/// How fast the device promises to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
#[schemars(rename = "Timing")]
pub(crate) struct TimingFile {
    /// From an SDO request to its answer; 500 ms where nothing is promised.
    #[serde(deserialize_with = "time")]
    #[schemars(with = "Option<Time>")]
    sdo_response: Duration,
    /// From a Modbus request to its answer; 1 s where nothing is promised.
    #[serde(deserialize_with = "time")]
    #[schemars(with = "Option<Time>")]
    modbus_response: Duration,
    /// From power-on or reset to the boot-up message; 5 s where nothing is promised.
    #[serde(deserialize_with = "time")]
    #[schemars(with = "Option<Time>")]
    boot_up: Duration,
    /// From an LSS request to its answer; 500 ms where nothing is promised.
    #[serde(deserialize_with = "time")]
    #[schemars(with = "Option<Time>")]
    lss_response: Duration,
    /// From an NMT command to the new state; 100 ms where nothing is promised.
    #[serde(deserialize_with = "time")]
    #[schemars(with = "Option<Time>")]
    nmt_transition: Duration,
}

impl Default for TimingFile {
    fn default() -> TimingFile {
        TimingFile {
            sdo_response: Duration::from_millis(500),
            modbus_response: Duration::from_secs(1),
            boot_up: Duration::from_secs(5),
            lss_response: Duration::from_millis(500),
            nmt_transition: Duration::from_millis(100),
        }
    }
}

impl TimingFile {
    pub(crate) fn lower(self) -> Timing {
        Timing {
            sdo_response: self.sdo_response,
            modbus_response: self.modbus_response,
            boot_up: self.boot_up,
            lss_response: self.lss_response,
            nmt_transition: self.nmt_transition,
        }
    }
}

/// A documented departure from what a named check expects.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Deviation")]
pub(crate) struct DeviationFile {
    /// The check, as the suite names it.
    pub(crate) check: Located<String>,
    /// What the device does instead.
    pub(crate) instead: InsteadFile,
    /// Where it says so: a source of this file by short name, or with a section.
    pub(crate) cite: OneOrMany<Located<Either<CiteFile>>>,
}

/// What a device does instead of what a check expects.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "Instead")]
pub(crate) enum InsteadFile {
    /// It answers with this Modbus exception.
    Exception(ModbusException),
    /// It aborts with this code.
    Abort(u32),
    /// A CAN frame like this comes.
    Frame(PatternText),
    /// The value is this.
    Value(WholeNumber),
    /// It stays silent.
    Silence,
    /// It does answer where silence was expected.
    Answer,
}

impl InsteadFile {
    pub(crate) fn lower(self) -> Instead {
        match self {
            InsteadFile::Exception(code) => Instead::Exception(code.0),
            InsteadFile::Abort(code) => Instead::Abort(code),
            InsteadFile::Frame(frame) => Instead::Frame(frame.0),
            InsteadFile::Value(value) => Instead::Value(value.0),
            InsteadFile::Silence => Instead::Silence,
            InsteadFile::Answer => Instead::Answer,
        }
    }
}

/// `17`, `0x11`, `11h`
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct WholeNumber(pub(crate) i128);

impl Text for WholeNumber {
    const EXPECTED: &'static str = "a whole number";

    fn parse(text: &str) -> Result<WholeNumber, Wrong> {
        whole_number(text).map(WholeNumber).ok_or_else(|| {
            Wrong::new(
                code::NUMBER,
                format!("`{text}` is not a whole number"),
                "expected a number such as 100, 0x64 or 64h",
            )
        })
    }

    fn schema() -> Schema {
        json_schema!({"type": ["integer", "string"]})
    }
}

read_as_text!(WholeNumber);
