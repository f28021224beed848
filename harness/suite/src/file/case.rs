//! A suite file and its cases.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::num::NonZeroU16;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{Deserializer, IgnoredAny};

use crate::device::{Feature, FunctionCode};
use crate::forms::{Either, OneOrMany, TwoForms};
use crate::model::{
    Depth, Effect, Forbidden, Located, Need, Protocol, Query, Source, Span, Step, StimulusName,
    WrittenFor,
};
use crate::scalar::ObjectAddress;

/// A fieldproof suite.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Suite")]
pub(crate) struct SuiteFile {
    /// The version of the language: 1.
    #[schemars(range(min = 1, max = 1))]
    pub(crate) language: Located<u32>,
    /// The id: `canopen.nmt`, `kinco-servo.worked-examples`.
    pub(crate) suite: Located<String>,
    /// One line for people.
    pub(crate) title: String,
    /// What the suite speaks; a device needs one of these ports to be tested.
    pub(crate) protocol: Protocol,
    /// The only device it is for, by the name of its description; without it the suite is for any device.
    #[serde(default)]
    pub(crate) device: Option<String>,
    /// The documents its cases cite, by short name.
    #[serde(default)]
    pub(crate) sources: BTreeMap<String, Source>,
    /// The cases.
    pub(crate) cases: ReadLater<Vec<CaseFile>>,
}

/// A test with one purpose.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Case")]
pub(crate) struct CaseFile {
    /// Its name: lower-case words.
    #[serde(rename = "case")]
    pub(crate) name: ReadLater<String>,
    /// One line for people.
    pub(crate) title: String,
    /// What it follows: sources by short name, or with a section: `{cia301: "7.3.2"}`.
    pub(crate) cite: OneOrMany<Located<Either<CiteFile>>>,
    /// The sources it decides against, when sources contradict each other.
    #[serde(default)]
    pub(crate) against: OneOrMany<Located<Either<CiteFile>>>,
    /// Why it follows one source against another.
    #[serde(default)]
    pub(crate) because: Option<String>,
    /// The worked examples it plays, by their ids.
    #[serde(default)]
    pub(crate) examples: OneOrMany<String>,
    /// What the device or the bench must offer.
    #[serde(default)]
    pub(crate) needs: OneOrMany<Either<Need>>,
    /// What it does to the device.
    #[serde(default)]
    pub(crate) effects: OneOrMany<Effect>,
    /// Only played with `--depth full`, for it takes long on real time.
    #[serde(default)]
    pub(crate) depth: Depth,
    /// The entries of catalogues that it realises: `{cct: "2.17"}`.
    #[serde(default)]
    pub(crate) covers: BTreeMap<String, OneOrMany<String>>,
    /// The node or address its frames are printed for.
    #[serde(default)]
    pub(crate) written_for: WrittenFor,
    /// What may not arrive during the case beside what steps expect.
    #[serde(default)]
    pub(crate) forbids: OneOrMany<Forbidden>,
    /// What must be put back that steps cannot put back by themselves.
    #[serde(default)]
    pub(crate) restore: RestoreFile,
    /// The table: one row, one case. What stands in a column is `{column}` in the case.
    #[serde(default)]
    pub(crate) each: ReadLater<Table>,
    /// What the description of the device gives: the first object or PDO that is so, by a name of your own.
    #[serde(default)]
    pub(crate) choose: ReadLater<BTreeMap<String, Query>>,
    /// The columns that name a case; else the first.
    #[serde(default)]
    pub(crate) key: ReadLater<OneOrMany<String>>,
    /// The positive check: if it does not pass, the case is inconclusive.
    #[serde(default)]
    pub(crate) control: ReadLater<Vec<Step>>,
    /// The test.
    pub(crate) steps: ReadLater<Vec<Step>>,
}

/// What is put back after a case.
#[derive(Debug, Clone, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Restore")]
pub(crate) struct RestoreFile {
    /// Objects read before the case and written back after it.
    #[serde(default)]
    pub(crate) objects: Vec<ObjectAddress>,
    /// Holding registers read before the case and written back after it.
    #[serde(default)]
    pub(crate) registers: Vec<Either<Span>>,
    /// Coils read before the case and switched back after it.
    #[serde(default)]
    pub(crate) coils: Vec<Either<Span>>,
    /// Played at the end, whatever happened, before objects and registers are written back.
    #[serde(default)]
    pub(crate) steps: ReadLater<Vec<Step>>,
}

/// Addresses in a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Span")]
pub(crate) struct SpanFile {
    /// The first address.
    first: u16,
    /// How many.
    count: NonZeroU16,
}

impl TwoForms for Span {
    type Short = u16;
    type Full = SpanFile;

    fn from_short(first: u16) -> Span {
        Span { first, count: 1 }
    }

    fn from_full(span: SpanFile) -> Span {
        Span {
            first: span.first,
            count: span.count.get(),
        }
    }
}

/// A row of a table; its cells may be anything.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Row {}

impl JsonSchema for Row {
    fn schema_name() -> Cow<'static, str> {
        "Row".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({"type": "object", "description": "A row: what stands in each column."})
    }
}

/// Rows, or one row for everything in the description of the device that is so.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Table {}

impl JsonSchema for Table {
    fn schema_name() -> Cow<'static, str> {
        "Table".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let rows = generator.subschema_for::<Vec<Row>>();
        let query = generator.subschema_for::<Query>();
        json_schema!({"anyOf": [
            rows,
            {"type": "object", "additionalProperties": query, "minProperties": 1, "maxProperties": 1},
        ]})
    }
}

/// Read from the tree by itself, so that each mistake in it is found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct ReadLater<T>(std::marker::PhantomData<T>);

impl<T> Default for ReadLater<T> {
    fn default() -> ReadLater<T> {
        ReadLater(std::marker::PhantomData)
    }
}

impl<'de, T> Deserialize<'de> for ReadLater<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<ReadLater<T>, D::Error> {
        IgnoredAny::deserialize(deserializer)?;
        Ok(ReadLater::default())
    }
}

impl<T: JsonSchema> JsonSchema for ReadLater<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }

    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}

/// A source by short name, or each short name with its sections.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum CiteFile {
    Source(String),
    Sections(BTreeMap<String, OneOrMany<String>>),
}

impl TwoForms for CiteFile {
    type Short = String;
    type Full = BTreeMap<String, OneOrMany<String>>;

    fn from_short(source: String) -> CiteFile {
        CiteFile::Source(source)
    }

    fn from_full(sections: BTreeMap<String, OneOrMany<String>>) -> CiteFile {
        CiteFile::Sections(sections)
    }
}

/// A need that is more than a word.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum FullNeed {
    /// A stimulus that the bench must offer.
    Stimulus(StimulusName),
    /// Objects that the device's dictionary must have.
    Object(OneOrMany<ObjectAddress>),
    /// Modbus functions that the device must claim: `3`, `8/4`.
    Function(OneOrMany<FunctionCode>),
    /// A node-ID that the device must not have.
    AnotherNode(u8),
    /// A Modbus address that the device must not have.
    AnotherAddress(u8),
}

impl TwoForms for Need {
    type Short = Feature;
    type Full = FullNeed;

    fn from_short(feature: Feature) -> Need {
        Need::Feature(feature)
    }

    fn from_full(need: FullNeed) -> Need {
        match need {
            FullNeed::Stimulus(stimulus) => Need::Stimulus(stimulus),
            FullNeed::Object(objects) => Need::Objects(objects.0),
            FullNeed::Function(functions) => Need::Functions(functions.0),
            FullNeed::AnotherNode(node) => Need::AnotherNode(node),
            FullNeed::AnotherAddress(address) => Need::AnotherAddress(address),
        }
    }
}
