//! What a case asks of the description of a device: objects and PDOs that are so and so.

use std::fmt;

use fieldproof_dictionary::registers::{Table, WriteEffect};
use schemars::{JsonSchema, Schema, json_schema};
use serde::Deserialize;

use crate::code;
use crate::forms::OneOrMany;
use crate::problem::Wrong;
use crate::read_with::one_or_many;
use crate::scalar::{ObjectAddress, Text, read_as_text};

/// Things of a device's description, by what they are. All that is said must be true of them.
#[derive(Debug, Clone, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Query {
    /// What they are; objects, where nothing is said.
    pub is: QueryKind,
    /// Their indices: `1000-1FFF`.
    #[serde(deserialize_with = "one_or_many")]
    #[schemars(with = "OneOrMany<IndexRange>")]
    pub index: Vec<IndexRange>,
    /// Their sub-indices.
    #[serde(deserialize_with = "one_or_many")]
    #[schemars(with = "OneOrMany<u8>")]
    pub sub: Vec<u8>,
    /// What may be done with them: one of these. Of a PDO, with the number of its mapping's objects.
    #[serde(deserialize_with = "one_or_many")]
    #[schemars(with = "OneOrMany<AccessWord>")]
    pub access: Vec<AccessWord>,
    /// Their type: one of these.
    #[serde(rename = "type", deserialize_with = "one_or_many")]
    #[schemars(with = "OneOrMany<TypeWord>")]
    pub types: Vec<TypeWord>,
    /// Their size in bytes; of a text, that of its default.
    pub size: SizeRange,
    /// What the description says of them.
    #[serde(deserialize_with = "one_or_many")]
    #[schemars(with = "OneOrMany<Has>")]
    pub has: Vec<Has>,
    /// Into what they may be mapped.
    pub pdo: Option<MappableInto>,
    /// The tables of the register map that they are in: one of these.
    #[serde(deserialize_with = "one_or_many")]
    #[schemars(with = "OneOrMany<TableWord>")]
    pub table: Vec<TableWord>,
    /// What writing them does: nothing but what is said here.
    #[serde(deserialize_with = "one_or_many")]
    #[schemars(with = "OneOrMany<EffectWord>")]
    pub effect: Vec<EffectWord>,
    /// Registers whose limits let all values from the first to the last through.
    pub takes: Option<ValueRange>,
    /// So many of them must follow each other without a gap; the first is meant.
    #[schemars(range(min = 1))]
    pub row: Option<u16>,
    /// Whether a value written survives power-off.
    pub persists: Option<bool>,
    /// Of functions: whether the device claims them.
    pub claimed: Option<bool>,
    /// Those that are not meant: objects, indices and ranges of them.
    #[serde(deserialize_with = "one_or_many")]
    #[schemars(with = "OneOrMany<Except>")]
    pub except: Vec<Except>,
    /// How many of them at the most, spread over all there are.
    pub at_most: Option<u16>,
}

/// What is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum QueryKind {
    /// Values of the object dictionary: index and sub-index.
    #[default]
    Object,
    /// Indices beside those of the object dictionary.
    AbsentObject,
    /// Sub-indices that objects of the dictionary do not have.
    AbsentSubIndex,
    /// TPDOs, each with its communication and mapping objects.
    Tpdo,
    /// RPDOs.
    Rpdo,
    /// Bit rates that the EDS claims and LSS can name.
    BitRate,
    /// Those of them that are not the present one.
    OtherBitRate,
    /// Values of the register map: registers, coils, discrete inputs.
    Register,
    /// Addresses beside them that belong to none, in tables of which it is said that such are refused.
    Hole,
    /// Modbus functions, where it is said which the device has.
    Function,
}

/// One of the four Modbus tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TableWord {
    /// Bits that can be written.
    Coils,
    /// Bits that cannot.
    DiscreteInputs,
    /// Registers that can be written.
    Holding,
    /// Registers that cannot.
    Input,
}

impl TableWord {
    /// The table.
    pub const fn table(self) -> Table {
        match self {
            TableWord::Coils => Table::Coils,
            TableWord::DiscreteInputs => Table::DiscreteInputs,
            TableWord::Holding => Table::Holding,
            TableWord::Input => Table::Input,
        }
    }
}

/// What writing a register does, as a register map says it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum EffectWord {
    /// It changes its value.
    Writes,
    /// It writes non-volatile memory.
    Persists,
    /// It changes the address or the line.
    Readdresses,
    /// Something may move.
    Moves,
    /// The device is reset, or others of its values are.
    Resets,
}

impl EffectWord {
    /// The effect.
    pub const fn effect(self) -> WriteEffect {
        match self {
            EffectWord::Writes => WriteEffect::Writes,
            EffectWord::Persists => WriteEffect::Persists,
            EffectWord::Readdresses => WriteEffect::Readdresses,
            EffectWord::Moves => WriteEffect::Moves,
            EffectWord::Resets => WriteEffect::Resets,
        }
    }

    const fn word(self) -> &'static str {
        match self {
            EffectWord::Writes => "writes",
            EffectWord::Persists => "persists",
            EffectWord::Readdresses => "readdresses",
            EffectWord::Moves => "moves",
            EffectWord::Resets => "resets",
        }
    }
}

/// A range of indices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct IndexRange {
    /// The first.
    pub from: u16,
    /// The last.
    pub to: u16,
}

impl IndexRange {
    /// Whether `index` is one of them.
    pub fn contains(self, index: u16) -> bool {
        (self.from..=self.to).contains(&index)
    }
}

/// What is left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Except {
    /// One value.
    Object(ObjectAddress),
    /// Whole objects.
    Range(IndexRange),
}

/// Access as an EDS writes it, or what it comes to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AccessWord {
    /// Read only.
    Ro,
    /// Write only.
    Wo,
    /// Read and write.
    Rw,
    /// Read and write; a PDO may only send it.
    Rwr,
    /// Read and write; a PDO may only receive it.
    Rww,
    /// Read only, and always the same.
    Const,
    /// All but `wo`.
    Readable,
    /// All but `ro` and `const`.
    Writable,
}

/// The basic data types of CiA 301.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TypeWord {
    /// BOOLEAN
    Boolean,
    /// INTEGER8
    I8,
    /// INTEGER16
    I16,
    /// INTEGER24
    I24,
    /// INTEGER32
    I32,
    /// INTEGER40
    I40,
    /// INTEGER48
    I48,
    /// INTEGER56
    I56,
    /// INTEGER64
    I64,
    /// UNSIGNED8
    U8,
    /// UNSIGNED16
    U16,
    /// UNSIGNED24
    U24,
    /// UNSIGNED32
    U32,
    /// UNSIGNED40
    U40,
    /// UNSIGNED48
    U48,
    /// UNSIGNED56
    U56,
    /// UNSIGNED64
    U64,
    /// REAL32
    Real32,
    /// REAL64
    Real64,
    /// VISIBLE_STRING
    Text,
    /// OCTET_STRING
    Octets,
    /// UNICODE_STRING
    Unicode,
    /// TIME_OF_DAY
    TimeOfDay,
    /// TIME_DIFFERENCE
    TimeDifference,
    /// DOMAIN
    Domain,
}

/// A range of sizes in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct SizeRange {
    /// At least so many.
    pub from: Option<u32>,
    /// At most so many.
    pub to: Option<u32>,
}

/// A range of values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct ValueRange {
    /// The lowest.
    pub from: i64,
    /// The highest.
    pub to: i64,
}

/// What a description says of an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Has {
    /// A default.
    Default,
    /// A lowest value.
    Low,
    /// A highest value.
    High,
    /// A lowest value above the lowest of the type.
    Below,
    /// A highest value below the highest of the type.
    Above,
    /// Of sub-index FFh: the object code and the data type, as the standard has them in there.
    Structure,
    /// Meanings of single values.
    Codes,
    /// Meanings of single bits.
    Bits,
}

impl Has {
    /// What stands behind a dash in the column that this gives a case; none if it gives none.
    pub(crate) const fn column(self) -> Option<&'static str> {
        match self {
            Has::Default => Some("-default"),
            Has::Low => Some("-low"),
            Has::High => Some("-high"),
            Has::Below => Some("-below"),
            Has::Above => Some("-above"),
            Has::Structure => Some("-structure"),
            Has::Codes | Has::Bits => None,
        }
    }
}

/// Where an object may be mapped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MappableInto {
    /// Into an RPDO.
    Rpdo,
    /// Into a TPDO.
    Tpdo,
    /// Nowhere.
    No,
}

impl Text for IndexRange {
    const EXPECTED: &'static str = "indices such as 1000-1FFF";

    fn parse(text: &str) -> Result<IndexRange, Wrong> {
        let index = |digits: &str| {
            let hexadecimal = digits.len() == 4 && digits.chars().all(|it| it.is_ascii_hexdigit());
            hexadecimal
                .then(|| u16::from_str_radix(digits, 16).ok())
                .flatten()
        };
        let (from, to) = text.split_once('-').unwrap_or((text, text));
        match (index(from), index(to)) {
            (Some(from), Some(to)) if from <= to => Ok(IndexRange { from, to }),
            _ => Err(Wrong::new(
                code::OBJECT,
                format!("`{text}` is no range of indices"),
                "expected one or two indices of four hexadecimal digits, such as 1000-1FFF",
            )),
        }
    }

    fn schema() -> Schema {
        json_schema!({"type": ["string", "integer"], "pattern": "^[0-9A-Fa-f]{4}(-[0-9A-Fa-f]{4})?$"})
    }
}

impl Text for Except {
    const EXPECTED: &'static str = "an object such as \"6041:00\", or indices such as 1000-1FFF";

    fn parse(text: &str) -> Result<Except, Wrong> {
        match text.contains(':') {
            true => ObjectAddress::parse(text).map(Except::Object),
            false => IndexRange::parse(text).map(Except::Range),
        }
    }

    fn schema() -> Schema {
        json_schema!({
            "type": ["string", "integer"],
            "pattern": "^[0-9A-Fa-f]{4}(-[0-9A-Fa-f]{4}|:[0-9A-Fa-f]{2})?$"
        })
    }
}

read_as_text!(IndexRange, Except);

impl AccessWord {
    const fn word(self) -> &'static str {
        match self {
            AccessWord::Ro => "ro",
            AccessWord::Wo => "wo",
            AccessWord::Rw => "rw",
            AccessWord::Rwr => "rwr",
            AccessWord::Rww => "rww",
            AccessWord::Const => "const",
            AccessWord::Readable => "readable",
            AccessWord::Writable => "writable",
        }
    }
}

impl TypeWord {
    /// The word of the language.
    pub const fn word(self) -> &'static str {
        match self {
            TypeWord::Boolean => "boolean",
            TypeWord::I8 => "i8",
            TypeWord::I16 => "i16",
            TypeWord::I24 => "i24",
            TypeWord::I32 => "i32",
            TypeWord::I40 => "i40",
            TypeWord::I48 => "i48",
            TypeWord::I56 => "i56",
            TypeWord::I64 => "i64",
            TypeWord::U8 => "u8",
            TypeWord::U16 => "u16",
            TypeWord::U24 => "u24",
            TypeWord::U32 => "u32",
            TypeWord::U40 => "u40",
            TypeWord::U48 => "u48",
            TypeWord::U56 => "u56",
            TypeWord::U64 => "u64",
            TypeWord::Real32 => "real32",
            TypeWord::Real64 => "real64",
            TypeWord::Text => "text",
            TypeWord::Octets => "octets",
            TypeWord::Unicode => "unicode",
            TypeWord::TimeOfDay => "time-of-day",
            TypeWord::TimeDifference => "time-difference",
            TypeWord::Domain => "domain",
        }
    }

    /// The word of `as` that reads and writes values of this type: bit patterns of REALn as a number, and as bytes
    /// what `as` has no word for.
    pub const fn as_word(self) -> &'static str {
        match self {
            TypeWord::Boolean => "u8",
            TypeWord::Real32 => "u32",
            TypeWord::Real64 => "u64",
            TypeWord::I8
            | TypeWord::I16
            | TypeWord::I32
            | TypeWord::I64
            | TypeWord::U8
            | TypeWord::U16
            | TypeWord::U24
            | TypeWord::U32
            | TypeWord::U64
            | TypeWord::Text => self.word(),
            _ => "bytes",
        }
    }
}

/// `object that is rw, of type u16, within 1000h to 1FFFh`
impl fmt::Display for Query {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self.is {
            QueryKind::Object => "object",
            QueryKind::AbsentObject => "index without an object",
            QueryKind::AbsentSubIndex => "object without a sub-index",
            QueryKind::Tpdo => "TPDO",
            QueryKind::Rpdo => "RPDO",
            QueryKind::Register => "register",
            QueryKind::Hole => "address that is said to be refused",
            QueryKind::Function => match self.claimed {
                Some(true) => "function that is claimed",
                Some(false) => "function that is known not to be there",
                None => "function that is known to be there or not",
            },
            QueryKind::BitRate => "bit rate in its EDS that LSS can name",
            QueryKind::OtherBitRate => "second bit rate in its EDS that LSS can name",
        })?;
        let mut said: Vec<String> = Vec::new();
        let or = |words: Vec<String>| words.join(" or ");
        if !self.access.is_empty() {
            let words = self.access.iter().map(|it| it.word().to_owned());
            said.push(format!("that is {}", or(words.collect())));
        }
        if !self.types.is_empty() {
            let words = self.types.iter().map(|it| it.word().to_owned());
            said.push(format!("of type {}", or(words.collect())));
        }
        match (self.size.from, self.size.to) {
            (Some(from), Some(to)) => said.push(format!("of {from} to {to} bytes")),
            (Some(from), None) => said.push(format!("of at least {from} bytes")),
            (None, Some(to)) => said.push(format!("of at most {to} bytes")),
            (None, None) => {}
        }
        said.extend(self.has.iter().map(|has| {
            match has {
                Has::Default => "with a default",
                Has::Low => "with a lowest value",
                Has::High => "with a highest value",
                Has::Below => "with a value below its lowest",
                Has::Above => "with a value above its highest",
                Has::Structure => "with a structure that the description tells",
                Has::Codes => "with meanings of single values",
                Has::Bits => "with meanings of single bits",
            }
            .to_owned()
        }));
        if !self.table.is_empty() {
            let words = self.table.iter().map(|it| it.table().name().to_owned());
            said.push(format!("in the table {}", or(words.collect())));
        }
        if !self.effect.is_empty() {
            let words = self.effect.iter().map(|it| it.word().to_owned());
            said.push(format!(
                "that is known to do nothing but {}",
                or(words.collect())
            ));
        }
        said.extend(
            self.takes
                .map(|values| format!("that takes {} to {}", values.from, values.to)),
        );
        said.extend(self.row.map(|row| format!("in a row of {row}")));
        said.extend(self.persists.map(|persists| {
            match persists {
                true => "that survives power-off",
                false => "that does not survive power-off",
            }
            .to_owned()
        }));
        said.extend(self.pdo.map(|pdo| {
            match pdo {
                MappableInto::Rpdo => "that an RPDO may carry",
                MappableInto::Tpdo => "that a TPDO may carry",
                MappableInto::No => "that no PDO may carry",
            }
            .to_owned()
        }));
        if !self.sub.is_empty() {
            let words = self.sub.iter().map(u8::to_string);
            said.push(format!("at sub-index {}", or(words.collect())));
        }
        if !self.index.is_empty() {
            let words = self.index.iter().map(|range| match range.from == range.to {
                true => format!("{:04X}h", range.from),
                false => format!("{:04X}h to {:04X}h", range.from, range.to),
            });
            said.push(format!("at {}", or(words.collect())));
        }
        match said.is_empty() {
            true => Ok(()),
            false => write!(f, " {}", said.join(", ")),
        }
    }
}
