//! The raw level: CAN frames, bytes on a serial line, and what their bytes mean.

use std::num::NonZeroU16;
use std::time::Duration;

use schemars::JsonSchema;
use serde::Deserialize;

use super::Judge;
use crate::file::{DecodeFile, ExpectFile};
use crate::forms::OneOrMany;
use crate::read_with::{can_ids, decode_big_endian, one_or_many, optional_time, time};
use crate::scalar::{
    BytePatternText, Bytes, CanId, Decimal, FrameText, ObjectAddress, PatternText, Time, Tolerance,
};

/// Sends a CAN frame. Short form: the frame alone.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Send {
    /// The frame.
    pub frame: FrameText,
}

/// Expects a CAN frame. Short form: the frame alone.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(try_from = "ExpectFile")]
pub struct Expect {
    /// What must come.
    pub frame: PatternText,
    /// What may come in its place: other frames with this identifier, or `silence`.
    pub or: Vec<Alternative>,
    /// How long after the last send; else what the description promises.
    pub within: Option<Duration>,
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

/// What may come in the place of a frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Alternative {
    /// `silence`: nothing.
    Silence,
    /// Another frame.
    Frame(PatternText),
}

/// Expects that nothing arrives. Short form: the duration alone.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ExpectSilence {
    /// How long from now.
    #[serde(deserialize_with = "time")]
    #[schemars(with = "Time")]
    pub lasting: Duration,
    /// Only frames with these identifiers matter; else everything from the device on the suite's main port.
    #[serde(default, deserialize_with = "can_ids")]
    #[schemars(with = "OneOrMany<CanId>")]
    pub of: Vec<u16>,
    /// The port; else the suite's main port.
    #[serde(default)]
    pub port: Option<String>,
    /// The name of this check, for documented deviations.
    #[serde(default)]
    pub check: Option<String>,
}

/// Sends bytes on a serial port. Short form: the bytes alone, CRC given.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct SendBytes {
    /// The bytes.
    pub bytes: Bytes,
    /// What is done about the CRC.
    #[serde(default)]
    pub crc: Crc,
    /// What follows without a silence.
    #[serde(default, deserialize_with = "one_or_many")]
    #[schemars(with = "OneOrMany<Piece>")]
    pub then: Vec<Piece>,
    /// A silence among them; else they follow each other.
    #[serde(default)]
    pub pause: Option<Pause>,
    /// The character, from 0, whose parity bit is wrong.
    #[serde(default)]
    pub spoil: Option<u16>,
    /// The port, or a connection; else `serial`.
    #[serde(default)]
    pub port: Option<String>,
}

/// Bytes that follow others.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Piece {
    /// The bytes.
    pub bytes: Bytes,
    /// What is done about their CRC.
    #[serde(default)]
    pub crc: Crc,
}

/// A silence among bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Pause {
    /// After so many bytes.
    #[schemars(range(min = 1))]
    pub after: NonZeroU16,
    /// And again after as many.
    #[serde(default)]
    pub again: bool,
    /// How long.
    pub lasting: PauseLength,
}

/// `20 ms`, or `2.5 characters` of a serial line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PauseLength {
    /// A time.
    Time(Duration),
    /// So many thousandths of a character.
    Characters(u32),
}

/// Opens connections of Modbus TCP, which steps then name as `port`; closed after the case. Short form: the name alone.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Connect {
    /// What the case calls it.
    pub name: String,
}

/// Ends a connection. Short form: the name alone.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Disconnect {
    /// What the case calls it.
    pub name: String,
    /// With a reset, and not in order.
    #[serde(default)]
    pub reset: bool,
}

/// What is done about the CRC of bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
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

/// Expects bytes on a serial port. Short form: the bytes alone.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ExpectBytes {
    /// The whole frame with its CRC.
    pub bytes: BytePatternText,
    /// What may come in its place: other bytes, or `silence`.
    #[serde(default, deserialize_with = "one_or_many")]
    #[schemars(with = "OneOrMany<OtherBytes>")]
    pub or: Vec<OtherBytes>,
    /// How long after the last send; else what the description promises.
    #[serde(default, deserialize_with = "optional_time")]
    #[schemars(with = "Option<Time>")]
    pub within: Option<Duration>,
    /// The port, or a connection; else `serial`.
    #[serde(default)]
    pub port: Option<String>,
    /// What its bytes must mean.
    #[serde(default, deserialize_with = "decode_big_endian")]
    #[schemars(with = "OneOrMany<DecodeFile>")]
    pub decode: Vec<Decode>,
    /// The name of this check, for documented deviations.
    #[serde(default)]
    pub check: Option<String>,
}

/// What may come in the place of bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum OtherBytes {
    /// `silence`: nothing.
    Silence,
    /// Other bytes.
    Bytes(BytePatternText),
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

/// The type of a value on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
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
    #[serde(rename = "sign-magnitude-16")]
    SignMagnitude16,
    /// VISIBLE_STRING
    Text,
    /// Bytes of any number: DOMAIN, OCTET_STRING.
    Bytes,
}
