//! Reading and writing objects.

use std::time::Duration;

use schemars::JsonSchema;
use serde::Deserialize;

use super::transfer::{Direction, TransferFile};
use super::value::{RawValue, counts};
use crate::code;
use crate::forms::{Either, OneOrMany, TwoForms};
use crate::identity::Claim;
use crate::model::{
    AbortExpectation, BlockMistake, Located, ReadExpectation, SdoObject, SdoRead, SdoWrite,
    Transfer, ValueType, WriteExpectation,
};
use crate::problem::Wrong;
use crate::read_with::optional_time;
use crate::scalar::{Time, TimeUnit, Value};

/// Reads an object.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "SdoRead")]
pub(crate) struct SdoReadFile {
    /// The object.
    object: SdoObject,
    /// By which protocol; without it, as the server chooses.
    #[serde(default)]
    transfer: Option<Located<Either<TransferFile>>>,
    /// Its type; the answer must have its size.
    #[serde(rename = "as")]
    value_type: ValueType,
    /// What must come; without it, any value.
    #[serde(default)]
    expect: Option<Located<Either<ReadExpectFile>>>,
    /// For an expected duration: what one count of the object is.
    #[serde(default)]
    unit: Option<TimeUnit>,
    /// How long after the request; else what the description promises.
    #[serde(default, deserialize_with = "optional_time")]
    #[schemars(with = "Option<Time>")]
    within: Option<Duration>,
    /// It is read again and again until it is what is expected, for so long at the most.
    #[serde(default, deserialize_with = "optional_time")]
    #[schemars(with = "Option<Time>")]
    settles: Option<Duration>,
    /// Keeps the value under this name for later steps.
    #[serde(default)]
    save: Option<String>,
    /// Records the value as an observation with these words.
    #[serde(default)]
    observe: Option<String>,
    /// The name of this check, for documented deviations.
    #[serde(default)]
    check: Option<String>,
}

/// What a read must give.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum ReadExpectFile {
    Value(RawValue),
    Map(ReadExpectMap),
}

impl TwoForms for ReadExpectFile {
    type Short = RawValue;
    type Full = ReadExpectMap;

    fn from_short(value: RawValue) -> ReadExpectFile {
        ReadExpectFile::Value(value)
    }

    fn from_full(map: ReadExpectMap) -> ReadExpectFile {
        ReadExpectFile::Map(map)
    }
}

/// What a read must give, beside one value: one of several, a range, what is claimed, or a refusal.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "ReadExpectation")]
pub(crate) struct ReadExpectMap {
    /// One of these.
    #[serde(default)]
    one_of: Option<Vec<Located<RawValue>>>,
    /// The lowest that passes.
    #[serde(default)]
    from: Option<Located<RawValue>>,
    /// The highest that passes.
    #[serde(default)]
    to: Option<Located<RawValue>>,
    /// What the description claims of the identity; the case is skipped where it claims nothing.
    #[serde(default)]
    claimed: Option<Located<Claim>>,
    /// The abort codes that pass.
    #[serde(default)]
    abort: Option<OneOrMany<u32>>,
    /// The one code that passes under `--strict`.
    #[serde(default)]
    strict: Option<u32>,
}

impl ReadExpectFile {
    fn lower(
        self,
        value_type: ValueType,
        unit: Option<Duration>,
    ) -> Result<ReadExpectation, Wrong> {
        let in_counts = |raw: &RawValue| {
            let value = raw.lower(value_type, unit)?;
            Ok(match (value, unit) {
                (Value::Duration(time), Some(unit)) => Value::Number(counts(time, unit)),
                (value, _) => value,
            })
        };
        let located = |raw: &Located<RawValue>| {
            in_counts(&raw.value).map_err(|wrong: Wrong| wrong.at(raw.at))
        };
        let limit = |raw: &Located<RawValue>| match located(raw)? {
            Value::Number(number) => Ok(number),
            _ => {
                Err(Wrong::new(code::NUMBER, "a limit is a number", "expected a number").at(raw.at))
            }
        };
        let map = match self {
            ReadExpectFile::Value(value) => return in_counts(&value).map(ReadExpectation::Value),
            ReadExpectFile::Map(map) => map,
        };
        if let Some(claim) = map.claimed {
            let alone = map.one_of.is_none() && map.from.is_none() && map.to.is_none();
            if alone && map.abort.is_none() && map.strict.is_none() {
                return claimed(&claim, value_type).map(ReadExpectation::Claimed);
            }
            return Err(not_one_expectation());
        }
        match (map.one_of, map.from, map.to, map.abort, map.strict) {
            (Some(values), None, None, None, None) if !values.is_empty() => values
                .iter()
                .map(located)
                .collect::<Result<_, _>>()
                .map(ReadExpectation::OneOf),
            (None, Some(from), Some(to), None, None) => {
                let (low, high) = (limit(&from)?, limit(&to)?);
                if low > high {
                    let message = format!("no value lies between {low} and {high}");
                    return Err(Wrong::new(code::DOES_NOT_FIT, message, "too low").at(to.at));
                }
                Ok(ReadExpectation::Range {
                    from: low,
                    to: high,
                })
            }
            (None, None, None, Some(abort), strict) => {
                refusal(abort, strict).map(ReadExpectation::Abort)
            }
            _ => Err(not_one_expectation()),
        }
    }
}

fn not_one_expectation() -> Wrong {
    Wrong::new(
        code::KEYS_TOGETHER,
        "this is not one expectation",
        "expected `one-of`, or `from` and `to`, or `claimed`, or `abort` with `strict` if need be",
    )
}

fn claimed(claim: &Located<Claim>, value_type: ValueType) -> Result<Claim, Wrong> {
    let expected = match claim.value.is_text() {
        true => ValueType::Text,
        false => ValueType::U32,
    };
    if value_type == expected {
        return Ok(claim.value);
    }
    Err(Wrong::new(
        code::KEYS_TOGETHER,
        format!(
            "`{}` is read as `{}`, not as `{}`",
            claim.value.name(),
            expected.word(),
            value_type.word()
        ),
        "of another type",
    )
    .at(claim.at))
}

fn refusal(abort: OneOrMany<u32>, strict: Option<u32>) -> Result<AbortExpectation, Wrong> {
    if abort.0.is_empty() {
        return Err(Wrong::new(
            code::EMPTY,
            "no abort code passes",
            "expected an abort code",
        ));
    }
    if let Some(strict) = strict
        && !abort.0.contains(&strict)
    {
        return Err(Wrong::new(
            code::KEYS_TOGETHER,
            format!("`strict` is {strict:#010X}, which `abort` does not have"),
            "expected one of the codes of `abort`",
        ));
    }
    Ok(AbortExpectation {
        abort: abort.0,
        strict,
    })
}

impl TryFrom<SdoReadFile> for SdoRead {
    type Error = Wrong;

    fn try_from(file: SdoReadFile) -> Result<SdoRead, Wrong> {
        let unit = file.unit.map(|unit| unit.0);
        let expect = match file.expect {
            None => ReadExpectation::Any,
            Some(expect) => {
                let lowered = expect.value.0.lower(file.value_type, unit);
                lowered.map_err(|wrong| wrong.or_at(expect.at))?
            }
        };
        let transfer = transfer(file.transfer, Direction::Read)?;
        if gives_up(transfer) && (expect != ReadExpectation::Any || file.save.is_some()) {
            return Err(nothing_comes());
        }
        if matches!(expect, ReadExpectation::Abort(_)) && file.save.is_some() {
            return Err(Wrong::new(
                code::KEYS_TOGETHER,
                "a refused read has no value to save",
                "`save` and `abort` together",
            ));
        }
        Ok(SdoRead {
            object: file.object,
            transfer,
            value_type: file.value_type,
            expect,
            within: file.within,
            settles: file.settles,
            save: file.save,
            observe: file.observe,
            check: file.check,
        })
    }
}

fn transfer(
    file: Option<Located<Either<TransferFile>>>,
    direction: Direction,
) -> Result<Option<Transfer>, Wrong> {
    file.map(|file| {
        let lowered = file.value.0.lower(direction);
        lowered.map_err(|wrong| wrong.or_at(file.at))
    })
    .transpose()
}

fn gives_up(transfer: Option<Transfer>) -> bool {
    matches!(transfer, Some(Transfer::Block(block)) if block.mistake.is_some_and(BlockMistake::gives_up))
}

fn nothing_comes() -> Wrong {
    Wrong::new(
        code::KEYS_TOGETHER,
        "a transfer that the tester gives up has no outcome",
        "expected neither `expect` nor `save` beside `mistake: abort` and `mistake: abandon`",
    )
}

/// Writes an object; put back after the case.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "SdoWrite")]
pub(crate) struct SdoWriteFile {
    /// The object.
    object: SdoObject,
    /// By which protocol; without it, expedited up to 4 bytes and else segmented.
    #[serde(default)]
    transfer: Option<Located<Either<TransferFile>>>,
    /// The type it is sent as.
    #[serde(rename = "as")]
    value_type: ValueType,
    /// The value.
    value: Located<RawValue>,
    /// For a duration: what one count of the object is.
    #[serde(default)]
    unit: Option<TimeUnit>,
    /// `ok` (the default) or `{abort: [...]}`.
    #[serde(default)]
    expect: Option<Located<Either<WriteExpectFile>>>,
    /// How long after the request; else what the description promises.
    #[serde(default, deserialize_with = "optional_time")]
    #[schemars(with = "Option<Time>")]
    within: Option<Duration>,
    /// The name of this check, for documented deviations.
    #[serde(default)]
    check: Option<String>,
}

/// What a write must give.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum WriteExpectFile {
    Ok,
    Refused(Refusal),
}

/// `ok`: it is accepted.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Accepted {
    /// It is accepted.
    Ok,
}

/// A refusal that is expected.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) struct Refusal {
    /// The abort codes that pass. The abort must name the object that was asked for.
    abort: OneOrMany<u32>,
    /// The one code that passes under `--strict`.
    #[serde(default)]
    strict: Option<u32>,
}

impl TwoForms for WriteExpectFile {
    type Short = Accepted;
    type Full = Refusal;

    fn from_short(_: Accepted) -> WriteExpectFile {
        WriteExpectFile::Ok
    }

    fn from_full(refusal: Refusal) -> WriteExpectFile {
        WriteExpectFile::Refused(refusal)
    }
}

impl TryFrom<SdoWriteFile> for SdoWrite {
    type Error = Wrong;

    fn try_from(file: SdoWriteFile) -> Result<SdoWrite, Wrong> {
        let unit = file.unit.map(|unit| unit.0);
        let value = file.value.value.lower(file.value_type, unit);
        let value = value.map_err(|wrong| wrong.or_at(file.value.at))?;
        let transfer = transfer(file.transfer, Direction::Write)?;
        if gives_up(transfer) && file.expect.is_some() {
            return Err(nothing_comes());
        }
        let expect = match file.expect {
            None => WriteExpectation::Ok,
            Some(expect) => match expect.value.0 {
                WriteExpectFile::Ok => WriteExpectation::Ok,
                WriteExpectFile::Refused(Refusal { abort, strict }) => refusal(abort, strict)
                    .map(WriteExpectation::Abort)
                    .map_err(|wrong| wrong.or_at(expect.at))?,
            },
        };
        Ok(SdoWrite {
            object: file.object,
            transfer,
            value_type: file.value_type,
            value,
            unit,
            expect,
            within: file.within,
            check: file.check,
        })
    }
}
