//! Which PDO is meant, and the values that it carries.

use schemars::JsonSchema;
use serde::Deserialize;

use super::value::RawValue;
use crate::code;
use crate::forms::OneOrMany;
use crate::model::{Carried, Located, PdoName, SendRpdo, ValueType};
use crate::problem::Wrong;
use crate::read_with::{optional_pdo_data, optional_pdo_number};
use crate::scalar::{Bytes, CanId};

/// A value in a PDO.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "Carried")]
pub(crate) struct CarriedFile {
    /// Its type.
    #[serde(rename = "as")]
    value_type: ValueType,
    /// The value.
    value: Located<RawValue>,
}

impl CarriedFile {
    pub(super) fn lower(self) -> Result<Carried, Wrong> {
        let value = self.value.value.lower(self.value_type, None);
        Ok(Carried {
            value_type: self.value_type,
            value: value.map_err(|wrong| wrong.or_at(self.value.at))?,
        })
    }
}

/// Sends a receive PDO.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "SendRpdo")]
pub(crate) struct SendRpdoFile {
    /// 1 to 4: its predefined identifier.
    #[serde(default, deserialize_with = "optional_pdo_number")]
    #[schemars(range(min = 1, max = 4))]
    number: Option<u8>,
    /// The identifier, in place of the number.
    #[serde(default)]
    identifier: Option<CanId>,
    /// What it carries, at most 8 bytes.
    #[serde(default, deserialize_with = "optional_pdo_data")]
    #[schemars(with = "Option<Bytes>")]
    data: Option<Bytes>,
    /// What it carries, value after value.
    #[serde(default)]
    carries: OneOrMany<CarriedFile>,
}

impl TryFrom<SendRpdoFile> for SendRpdo {
    type Error = Wrong;

    fn try_from(file: SendRpdoFile) -> Result<SendRpdo, Wrong> {
        if file.data.is_some() != file.carries.0.is_empty() {
            return Err(Wrong::new(
                code::KEYS_TOGETHER,
                "a PDO carries either bytes or values",
                "expected `data` or `carries`",
            ));
        }
        Ok(SendRpdo {
            pdo: pdo_name(file.number, file.identifier)?,
            data: file.data,
            carries: carried(file.carries)?,
        })
    }
}

pub(super) fn pdo_name(number: Option<u8>, identifier: Option<CanId>) -> Result<PdoName, Wrong> {
    match (number, identifier) {
        (Some(number), None) => Ok(PdoName::Number(number)),
        (None, Some(identifier)) => Ok(PdoName::Identifier(identifier.0)),
        _ => Err(Wrong::new(
            code::KEYS_TOGETHER,
            "a PDO is meant by its number or by its identifier",
            "expected `number` or `identifier`",
        )),
    }
}

pub(super) fn carried(carries: OneOrMany<CarriedFile>) -> Result<Vec<Carried>, Wrong> {
    carries.0.into_iter().map(CarriedFile::lower).collect()
}
