//! A register map.

use std::collections::BTreeMap;

use fieldproof_dictionary::registers::{Holes, Kind, WordOrder, WriteEffect};
use schemars::JsonSchema;
use serde::Deserialize;

use super::WholeNumber;
use crate::forms::OneOrMany;
use crate::model::{Located, Source};
use crate::read_with::ten_thousand;
use crate::scalar::Scale;

/// What a device has in its Modbus tables.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Registers")]
pub(crate) struct RegistersFile {
    /// The version of the language: 1.
    #[schemars(range(min = 1, max = 1))]
    pub(crate) language: u32,
    /// The name of the map: that of the device, or of one of its families.
    pub(crate) registers: Located<String>,
    /// One line for people.
    pub(crate) title: String,
    /// The documents it is taken from.
    #[serde(default)]
    pub(crate) sources: BTreeMap<String, Source>,
    /// Which word of a 32-bit value has the lower address, where the value itself says nothing.
    #[serde(default)]
    pub(crate) word_order: Option<WordOrderFile>,
    /// What functions 03h, 06h and 10h reach.
    #[serde(default)]
    pub(crate) holding: Option<TableFile<RegisterFile>>,
    /// What function 04h reaches.
    #[serde(default)]
    pub(crate) input: Option<TableFile<RegisterFile>>,
    /// What functions 01h, 05h and 0Fh reach.
    #[serde(default)]
    pub(crate) coils: Option<TableFile<BitFile>>,
    /// What function 02h reaches.
    #[serde(default)]
    pub(crate) discrete_inputs: Option<TableFile<BitFile>>,
}

/// One of the four tables.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Table_{T}")]
pub(crate) struct TableFile<T> {
    /// What the documents say of addresses that are not listed: `answered`, `refused`, `unknown`.
    pub(crate) holes: HolesFile,
    /// What is listed, each with its address.
    pub(crate) ranges: Vec<Located<T>>,
}

/// What is known of addresses that are not listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "Holes")]
pub(crate) enum HolesFile {
    /// Reading them gives a value.
    Answered,
    /// They are refused.
    Refused,
    /// Nothing is known.
    Unknown,
}

impl HolesFile {
    pub(crate) fn lower(self) -> Holes {
        match self {
            HolesFile::Answered => Holes::Answered,
            HolesFile::Refused => Holes::Refused,
            HolesFile::Unknown => Holes::Unknown,
        }
    }
}

/// A register, or several that are alike: `{address: 324, count: 32, name: speed command, type: i16, low: -6000}`.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Register")]
pub(crate) struct RegisterFile {
    /// The address of the first register, as in the PDU: from 0.
    pub(crate) address: u16,
    /// So many of them follow each other; 1 where nothing is said. They are named by the name and a number.
    #[serde(default)]
    #[schemars(range(min = 1, max = 10000))]
    #[serde(deserialize_with = "ten_thousand")]
    pub(crate) count: Option<u16>,
    /// The number of the first of several; 0 where nothing is said.
    #[serde(default)]
    pub(crate) numbered_from: u16,
    /// What it is called.
    pub(crate) name: String,
    /// `u16` where nothing is said; `u32`, `i32` and `f32` take two registers.
    #[serde(default, rename = "type")]
    pub(crate) kind: KindFile,
    /// `r`, `w` or `rw`.
    pub(crate) access: AccessFile,
    /// The lowest value that may be written, or that can be read; that of the type where nothing is said.
    #[serde(default)]
    #[schemars(with = "Option<WholeNumber>")]
    pub(crate) low: Option<Located<WholeNumber>>,
    /// The highest value.
    #[serde(default)]
    #[schemars(with = "Option<WholeNumber>")]
    pub(crate) high: Option<Located<WholeNumber>>,
    /// The value after a reset to defaults.
    #[serde(default)]
    #[schemars(with = "Option<WholeNumber>")]
    pub(crate) default: Option<Located<WholeNumber>>,
    /// The unit of the value, once it is multiplied with `scale`.
    #[serde(default)]
    pub(crate) unit: String,
    /// What a count is multiplied with: `1/100`, `0.1`.
    #[serde(default)]
    pub(crate) scale: Option<Scale>,
    /// Which word of a 32-bit value has the lower address: `high-first`, `low-first`.
    #[serde(default)]
    pub(crate) word_order: Option<WordOrderFile>,
    /// Whether a value written survives power-off.
    #[serde(default)]
    pub(crate) persists: Option<bool>,
    /// What writing it does. Where nothing is said, or `unknown`, no walk through the map writes it.
    #[serde(default)]
    pub(crate) effect: OneOrMany<EffectFile>,
    /// What single values mean: `{0: off, 1: on}`.
    #[serde(default)]
    pub(crate) codes: BTreeMap<WholeNumber, String>,
    /// What single bits mean, bit 0 being the lowest: `{0: run, 1: reverse}`.
    #[serde(default)]
    pub(crate) bits: BTreeMap<WholeNumber, String>,
}

/// A coil or a discrete input, or several that are alike.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Bit")]
pub(crate) struct BitFile {
    /// The address of the first, as in the PDU: from 0.
    pub(crate) address: u16,
    /// So many of them follow each other; 1 where nothing is said. They are named by the name and a number.
    #[serde(default)]
    #[schemars(range(min = 1, max = 10000))]
    #[serde(deserialize_with = "ten_thousand")]
    pub(crate) count: Option<u16>,
    /// The number of the first of several; 0 where nothing is said.
    #[serde(default)]
    pub(crate) numbered_from: u16,
    /// What it is called.
    pub(crate) name: String,
    /// `r`, `w` or `rw`.
    pub(crate) access: AccessFile,
    /// The value after a reset to defaults.
    #[serde(default)]
    #[schemars(with = "Option<WholeNumber>")]
    pub(crate) default: Option<Located<WholeNumber>>,
    /// Whether a value written survives power-off.
    #[serde(default)]
    pub(crate) persists: Option<bool>,
    /// What writing it does. Where nothing is said, or `unknown`, no walk through the map writes it.
    #[serde(default)]
    pub(crate) effect: OneOrMany<EffectFile>,
}

impl From<BitFile> for RegisterFile {
    fn from(bit: BitFile) -> RegisterFile {
        RegisterFile {
            address: bit.address,
            count: bit.count,
            numbered_from: bit.numbered_from,
            name: bit.name,
            kind: KindFile::Bit,
            access: bit.access,
            low: None,
            high: None,
            default: bit.default,
            unit: String::new(),
            scale: None,
            word_order: None,
            persists: bit.persists,
            effect: bit.effect,
            codes: BTreeMap::new(),
            bits: BTreeMap::new(),
        }
    }
}

/// How the bits of a register are to be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "RegisterType")]
pub(crate) enum KindFile {
    /// 16 bits.
    #[default]
    U16,
    /// 16 bits in two's complement.
    I16,
    /// 32 bits in two registers.
    U32,
    /// 32 bits in two's complement, in two registers.
    I32,
    /// IEEE 754, in two registers.
    F32,
    /// Not a register.
    #[serde(skip)]
    Bit,
}

impl KindFile {
    pub(crate) fn lower(self) -> Kind {
        match self {
            KindFile::U16 => Kind::U16,
            KindFile::I16 => Kind::I16,
            KindFile::U32 => Kind::U32,
            KindFile::I32 => Kind::I32,
            KindFile::F32 => Kind::F32,
            KindFile::Bit => Kind::Bit,
        }
    }
}

/// What may be done with a register.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "RegisterAccess")]
pub(crate) enum AccessFile {
    /// It can be read.
    R,
    /// It can be written.
    W,
    /// It can be read and written.
    Rw,
}

/// Which word of a 32-bit value has the lower address.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "WordOrder")]
pub(crate) enum WordOrderFile {
    /// The high word.
    HighFirst,
    /// The low word.
    LowFirst,
}

impl WordOrderFile {
    pub(crate) fn lower(self) -> WordOrder {
        match self {
            WordOrderFile::HighFirst => WordOrder::HighFirst,
            WordOrderFile::LowFirst => WordOrder::LowFirst,
        }
    }
}

/// What writing a register does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
#[schemars(rename = "RegisterEffect")]
pub(crate) enum EffectFile {
    /// It changes its value, and nothing that writing it again does not put back.
    Writes,
    /// It writes non-volatile memory.
    Persists,
    /// It changes the address or the line.
    Readdresses,
    /// Something may move.
    Moves,
    /// The device is reset, or others of its values are.
    Resets,
    /// The documents do not say.
    Unknown,
}

impl EffectFile {
    pub(crate) fn lower(self) -> Option<WriteEffect> {
        match self {
            EffectFile::Writes => Some(WriteEffect::Writes),
            EffectFile::Persists => Some(WriteEffect::Persists),
            EffectFile::Readdresses => Some(WriteEffect::Readdresses),
            EffectFile::Moves => Some(WriteEffect::Moves),
            EffectFile::Resets => Some(WriteEffect::Resets),
            EffectFile::Unknown => None,
        }
    }
}
