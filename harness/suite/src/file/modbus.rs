//! A Modbus request with its function as a key beside `expect`.

use std::time::Duration;

use schemars::{JsonSchema, Schema, json_schema};
use serde::Deserialize;

use crate::code;
use crate::model::{Modbus, ModbusExpectation, ModbusRequest};
use crate::problem::{Wrong, nearest};
use crate::read_with::optional_time;
use crate::scalar::{Bytes, Number, Text, Time, read_as_text, whole_number};

/// One request and what must come back. One of `read-holding`, `read-input`, `write-single`, `write-multiple`, `pdu`.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Modbus")]
pub(crate) struct ModbusFile {
    /// 03h
    #[serde(default)]
    read_holding: Option<ReadRegisters>,
    /// 04h
    #[serde(default)]
    read_input: Option<ReadRegisters>,
    /// 06h
    #[serde(default)]
    write_single: Option<WriteSingle>,
    /// 10h
    #[serde(default)]
    write_multiple: Option<WriteMultiple>,
    /// Any function code with its data.
    #[serde(default)]
    pdu: Option<Bytes>,
    /// The answer: `normal` (the default), `silence`, `{registers: [..]}`, `{exception: ..}` or `{pdu: ..}`.
    #[serde(default)]
    expect: ModbusExpectation,
    /// Whom it is sent to, if not the device's address; 0 is everybody.
    #[serde(default)]
    to: Option<u8>,
    /// The connection it goes over; else the device's own port.
    #[serde(default)]
    port: Option<String>,
    /// How long after the request; else what the description promises.
    #[serde(default, deserialize_with = "optional_time")]
    #[schemars(with = "Option<Time>")]
    within: Option<Duration>,
    /// Keeps the first register under this name for later steps.
    #[serde(default)]
    save: Option<String>,
    /// Records the registers as an observation with these words.
    #[serde(default)]
    observe: Option<String>,
    /// The name of this check, for documented deviations.
    #[serde(default)]
    check: Option<String>,
}

/// Registers to read.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) struct ReadRegisters {
    /// First register.
    address: u16,
    /// How many.
    count: u16,
}

/// A register to write.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) struct WriteSingle {
    /// The register.
    address: u16,
    /// Its value.
    value: Number,
}

/// Registers to write.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) struct WriteMultiple {
    /// First register.
    address: u16,
    /// Their values.
    values: Vec<Number>,
}

impl ModbusFile {
    /// The one request of the step.
    fn request(&self) -> Result<ModbusRequest, Wrong> {
        let read_holding = self.read_holding.as_ref();
        let read_input = self.read_input.as_ref();
        let write_single = self.write_single.as_ref();
        let write_multiple = self.write_multiple.as_ref();
        let requests = [
            read_holding.map(|read| ModbusRequest::ReadHolding {
                address: read.address,
                count: read.count,
            }),
            read_input.map(|read| ModbusRequest::ReadInput {
                address: read.address,
                count: read.count,
            }),
            write_single.map(|write| ModbusRequest::WriteSingle {
                address: write.address,
                value: write.value.clone(),
            }),
            write_multiple.map(|write| ModbusRequest::WriteMultiple {
                address: write.address,
                values: write.values.clone(),
            }),
            self.pdu.clone().map(ModbusRequest::Pdu),
        ];
        let mut requests = requests.into_iter().flatten();
        match (requests.next(), requests.next()) {
            (Some(request), None) => Ok(request),
            _ => Err(Wrong::new(
                code::KEYS_TOGETHER,
                "a `modbus` step has one request",
                "expected one of `read-holding`, `read-input`, `write-single`, `write-multiple`, `pdu`",
            )),
        }
    }
}

impl TryFrom<ModbusFile> for Modbus {
    type Error = Wrong;

    fn try_from(file: ModbusFile) -> Result<Modbus, Wrong> {
        let request = file.request()?;
        check_registers(&request)?;
        if let ModbusExpectation::Registers(values) = &file.expect {
            check_words(values)?;
        }
        let has_registers = matches!(
            file.expect,
            ModbusExpectation::Normal | ModbusExpectation::Registers(_)
        );
        if file.save.is_some() && !has_registers {
            return Err(Wrong::new(
                code::KEYS_TOGETHER,
                "this answer has no register to save",
                "`save` beside an answer without registers",
            ));
        }
        Ok(Modbus {
            request,
            expect: file.expect,
            to: file.to,
            port: file.port,
            within: file.within,
            save: file.save,
            observe: file.observe,
            check: file.check,
        })
    }
}

fn check_registers(request: &ModbusRequest) -> Result<(), Wrong> {
    match request {
        ModbusRequest::WriteSingle { value, .. } => check_words(std::slice::from_ref(value)),
        ModbusRequest::WriteMultiple { values, .. } => check_words(values),
        _ => Ok(()),
    }
}

/// Whether each fits a register, as a signed or an unsigned number.
fn check_words(values: &[Number]) -> Result<(), Wrong> {
    for value in values {
        if let Number::Literal(number) = value
            && !(-0x8000..=0xFFFF).contains(number)
        {
            return Err(Wrong::new(
                code::DOES_NOT_FIT,
                format!("{number} does not fit a register"),
                "expected -32768 to 65535",
            ));
        }
    }
    Ok(())
}

/// An exception code, by name or number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct ModbusException(pub(crate) u8);

/// The names of the Modbus application protocol.
const EXCEPTIONS: [(&str, u8); 9] = [
    ("illegal-function", 0x01),
    ("illegal-data-address", 0x02),
    ("illegal-data-value", 0x03),
    ("server-device-failure", 0x04),
    ("acknowledge", 0x05),
    ("server-device-busy", 0x06),
    ("memory-parity-error", 0x08),
    ("gateway-path-unavailable", 0x0A),
    ("gateway-target-failed-to-respond", 0x0B),
];

impl Text for ModbusException {
    const EXPECTED: &'static str = "an exception such as illegal-data-value";

    fn parse(text: &str) -> Result<ModbusException, Wrong> {
        let named = EXCEPTIONS.iter().find(|(name, _)| *name == text);
        let numbered = whole_number(text).and_then(|number| u8::try_from(number).ok());
        if let Some(exception) = named.map(|(_, code)| *code).or(numbered) {
            return Ok(ModbusException(exception));
        }
        let names = EXCEPTIONS.map(|(name, _)| name);
        let wrong = Wrong::new(
            code::UNKNOWN_WORD,
            format!("unknown exception `{text}`"),
            crate::problem::expected_one_of(&names),
        );
        Err(match nearest(text, &names) {
            Some(name) => wrong.help(format!("did you mean `{name}`?")),
            None => wrong,
        })
    }

    fn schema() -> Schema {
        json_schema!({"anyOf": [
            {"enum": EXCEPTIONS.map(|(name, _)| name)},
            {"type": "integer", "minimum": 0, "maximum": 255}
        ]})
    }
}

read_as_text!(ModbusException);
