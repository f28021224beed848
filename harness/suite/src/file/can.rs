//! What is decoded, SYNC, PDO, whom an NMT command is for.

use std::time::Duration;

use schemars::{JsonSchema, Schema, json_schema};
use serde::Deserialize;

use super::pdo::{CarriedFile, carried, pdo_name};
use crate::code;
use crate::forms::OneOrMany;
use crate::model::{Alternative, Decode, Expect, ExpectTpdo, Judge, NmtAddress, Sync, ValueType};
use crate::problem::Wrong;
use crate::read_with::{optional_pdo_number, optional_time, ten};
use crate::scalar::{
    BytePatternText, CanId, Decimal, ObjectAddress, PatternText, Scale, Text, Time, Tolerance,
    read_as_text, whole_number,
};

/// What some bytes of a frame must mean: taken as a number, scaled, compared.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Decode")]
pub(crate) struct DecodeFile {
    /// For an SDO answer: the object it must name; the bytes are then its data.
    #[serde(default)]
    object: Option<ObjectAddress>,
    /// Where the bytes start in the frame's data; 4 with `object`, else 0.
    #[serde(default)]
    #[schemars(range(max = 255))]
    offset: Option<u8>,
    /// Their type.
    #[serde(rename = "as")]
    value_type: ValueType,
    /// Which byte comes first; `little` in CAN frames and `big` in Modbus bytes where nothing is said.
    #[serde(default)]
    byte_order: Option<ByteOrder>,
    /// What the number is multiplied with: `1/50`, `0.02`.
    #[serde(default)]
    scale: Option<Scale>,
    /// What must come out.
    equals: Decimal,
    /// How far off it may be; without it, exact.
    #[serde(default)]
    tolerance: Option<Decimal>,
    /// The unit, for people.
    #[serde(default)]
    unit: Option<String>,
    /// Of what, for people: `position`, `speed`.
    #[serde(default)]
    name: Option<String>,
}

/// Which byte comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum ByteOrder {
    /// The low byte.
    Little,
    /// The high byte.
    Big,
}

impl DecodeFile {
    pub(crate) fn lower(self, usually_big_endian: bool) -> Decode {
        let scale = self.scale.unwrap_or(Scale {
            multiply: 1,
            divide: 1,
        });
        Decode {
            object: self.object,
            offset: self.offset.map(usize::from),
            value_type: self.value_type,
            big_endian: match self.byte_order {
                Some(order) => order == ByteOrder::Big,
                None => usually_big_endian,
            },
            multiply: scale.multiply,
            divide: scale.divide,
            equals: self.equals,
            tolerance: self.tolerance,
            unit: self.unit,
            name: self.name,
        }
    }
}

/// Sends SYNC messages.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Sync")]
pub(crate) struct SyncFile {
    /// How many.
    count: u32,
    /// From one to the next; needed for more than one.
    #[serde(default, deserialize_with = "optional_time")]
    #[schemars(with = "Option<Time>")]
    period: Option<Duration>,
}

impl TryFrom<SyncFile> for Sync {
    type Error = Wrong;

    fn try_from(file: SyncFile) -> Result<Sync, Wrong> {
        match (file.count, file.period) {
            (0, _) => Err(Wrong::new(
                code::NUMBER,
                "no SYNC at all",
                "expected a count of 1 or more",
            )),
            (1, period) => Ok(Sync {
                count: 1,
                period: period.unwrap_or_default(),
            }),
            (count, Some(period)) if !period.is_zero() => Ok(Sync { count, period }),
            _ => Err(Wrong::new(
                code::KEYS_TOGETHER,
                "several SYNC messages without the time between them",
                "needs `period`",
            )),
        }
    }
}

/// Expects a CAN frame. Short form: the frame alone.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Expect")]
pub(crate) struct ExpectFile {
    /// What must come.
    frame: PatternText,
    /// What may come in its place: other frames with this identifier, or `silence`.
    #[serde(default)]
    or: OneOrMany<Alternative>,
    /// How long after the last send; else what the description promises.
    #[serde(default, deserialize_with = "optional_time")]
    #[schemars(with = "Option<Time>")]
    within: Option<Duration>,
    /// What its bytes must mean.
    #[serde(default)]
    decode: OneOrMany<DecodeFile>,
    /// If given, `count` periods between this and the following ones are measured.
    #[serde(default)]
    period: Option<Tolerance>,
    /// How many periods; 10 where nothing is said.
    #[serde(default)]
    count: Option<u32>,
    /// What of the periods must keep the limit.
    #[serde(default)]
    judge: Option<Judge>,
    /// The name of this check, for documented deviations.
    #[serde(default)]
    check: Option<String>,
}

impl TryFrom<ExpectFile> for Expect {
    type Error = Wrong;

    fn try_from(file: ExpectFile) -> Result<Expect, Wrong> {
        about_a_period(file.period, file.count, file.judge)?;
        let decode = file.decode.0.into_iter().map(|one| one.lower(false));
        Ok(Expect {
            frame: file.frame,
            or: file.or.0,
            within: file.within,
            decode: decode.collect(),
            period: file.period,
            count: file.count.unwrap_or_else(ten),
            judge: file.judge.unwrap_or_default(),
            check: file.check,
        })
    }
}

/// `count` and `judge` say nothing without a period.
fn about_a_period(
    period: Option<Tolerance>,
    count: Option<u32>,
    judge: Option<Judge>,
) -> Result<(), Wrong> {
    if period.is_none() && (count.is_some() || judge.is_some()) {
        return Err(Wrong::new(
            code::KEYS_TOGETHER,
            "`count` and `judge` are about a `period`, and there is none",
            "needs `period`",
        ));
    }
    Ok(())
}

/// Expects a transmit PDO.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "ExpectTpdo")]
pub(crate) struct ExpectTpdoFile {
    /// 1 to 4: its predefined identifier.
    #[serde(default, deserialize_with = "optional_pdo_number")]
    #[schemars(range(min = 1, max = 4))]
    number: Option<u8>,
    /// The identifier, in place of the number.
    #[serde(default)]
    identifier: Option<CanId>,
    /// How long after the last send (the last SYNC, say).
    #[serde(default, deserialize_with = "optional_time")]
    #[schemars(with = "Option<Time>")]
    within: Option<Duration>,
    /// What it must carry.
    #[serde(default)]
    data: Option<BytePatternText>,
    /// What it must carry, value after value, and nothing more.
    #[serde(default)]
    carries: OneOrMany<CarriedFile>,
    /// What its bytes must mean.
    #[serde(default)]
    decode: OneOrMany<DecodeFile>,
    /// If given, `count` periods between this and the following ones are measured.
    #[serde(default)]
    period: Option<Tolerance>,
    /// If given, so many SYNCs are between this and the next, and so on, `count` times.
    #[serde(default)]
    #[schemars(range(min = 1, max = 240))]
    syncs: Option<u32>,
    /// How many periods; 10 where nothing is said.
    #[serde(default)]
    count: Option<u32>,
    /// What of the periods must keep the limit.
    #[serde(default)]
    judge: Option<Judge>,
    /// The name of this check, for documented deviations.
    #[serde(default)]
    check: Option<String>,
}

impl TryFrom<ExpectTpdoFile> for ExpectTpdo {
    type Error = Wrong;

    fn try_from(file: ExpectTpdoFile) -> Result<ExpectTpdo, Wrong> {
        let counted = file.syncs.is_some() && file.count.is_some();
        if file.period.is_none() && (file.judge.is_some() || file.count.is_some()) && !counted {
            return Err(Wrong::new(
                code::KEYS_TOGETHER,
                "`count` and `judge` are about a `period`, and there is none",
                "needs `period`, or `syncs` and no `judge`",
            ));
        }
        if file.syncs.is_some() && (file.period.is_some() || file.judge.is_some()) {
            return Err(Wrong::new(
                code::KEYS_TOGETHER,
                "SYNCs are counted exactly, and no period is measured",
                "expected neither `period` nor `judge` beside `syncs`",
            ));
        }
        if file.syncs.is_some_and(|syncs| !(1..=240).contains(&syncs)) {
            return Err(Wrong::new(
                code::NUMBER,
                "a TPDO comes once in 1 to 240 SYNCs",
                "expected 1 to 240",
            ));
        }
        if file.data.as_ref().is_some_and(|data| data.0.len() > 8) {
            return Err(Wrong::new(
                code::BYTES,
                "a PDO has at most 8 bytes",
                "expected at most 8 bytes",
            ));
        }
        Ok(ExpectTpdo {
            pdo: pdo_name(file.number, file.identifier)?,
            within: file.within,
            data: file.data,
            carries: carried(file.carries)?,
            decode: file
                .decode
                .0
                .into_iter()
                .map(|one| one.lower(false))
                .collect(),
            period: file.period,
            syncs: file.syncs,
            count: file.count.unwrap_or_else(ten),
            judge: file.judge.unwrap_or_default(),
            check: file.check,
        })
    }
}

impl Text for NmtAddress {
    const EXPECTED: &'static str = "this, all or a node-ID";

    fn parse(text: &str) -> Result<NmtAddress, Wrong> {
        match (text, whole_number(text)) {
            ("this", _) => Ok(NmtAddress::This),
            ("all", _) => Ok(NmtAddress::All),
            (_, Some(node @ 1..=127)) => Ok(NmtAddress::Other(node as u8)),
            (_, Some(node)) => Err(Wrong::new(
                code::NUMBER,
                format!("{node} is out of range"),
                "expected 1 to 127",
            )),
            _ => Err(Wrong::new(
                code::UNKNOWN_WORD,
                format!("unknown word `{text}`"),
                "expected `this`, `all` or a node-ID",
            )),
        }
    }

    fn schema() -> Schema {
        json_schema!({"anyOf": [
            {"enum": ["this", "all"]},
            {"type": "integer", "minimum": 1, "maximum": 127}
        ]})
    }
}

read_as_text!(NmtAddress);
