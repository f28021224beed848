//! Modbus requests and answers.

use std::time::Duration;

use schemars::JsonSchema;
use serde::Deserialize;

use crate::file::{ModbusException, ModbusFile};
use crate::forms::OneOrMany;
use crate::read_with::exceptions;
use crate::scalar::{BytePatternText, Bytes, Number};

/// A Modbus request and what must come back.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(try_from = "ModbusFile")]
pub struct Modbus {
    /// The request; in the file the name of the function is a key beside `expect`.
    pub request: ModbusRequest,
    /// The answer.
    pub expect: ModbusExpectation,
    /// Whom it is sent to, if not the device's address.
    pub to: Option<u8>,
    /// The connection it goes over; else the device's own port.
    pub port: Option<String>,
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
#[derive(Debug, Clone, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ModbusExpectation {
    /// A normal answer of the right shape, whatever it carries.
    #[default]
    Normal,
    /// `{registers: [500, 1000]}`
    Registers(Vec<Number>),
    /// `{exception: illegal-data-value}` or a list of them or of numbers.
    Exception(
        #[serde(deserialize_with = "exceptions")]
        #[schemars(with = "OneOrMany<ModbusException>")]
        Vec<u8>,
    ),
    /// `{pdu: "83 02"}`
    Pdu(BytePatternText),
    /// `silence`
    Silence,
}
