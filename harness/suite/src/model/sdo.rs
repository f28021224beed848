//! Reading and writing objects.

use std::time::Duration;

use serde::Deserialize;

use super::ValueType;
use crate::file::{SdoReadFile, SdoWriteFile};
use crate::identity::Claim;
use crate::scalar::{ObjectAddress, Value};

/// Reads an object.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(try_from = "SdoReadFile")]
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
    /// What the description claims: `expect: {claimed: vendor-id}`. A case is skipped where nothing is claimed.
    Claimed(Claim),
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

/// Writes an object.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(try_from = "SdoWriteFile")]
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
