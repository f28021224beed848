//! Accepted failures: which, on what, why, and until when.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::model::Located;

/// A file of accepted failures.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Waivers {
    /// The version of the language: 1.
    #[schemars(range(min = 1, max = 1))]
    pub language: u32,
    /// The accepted failures.
    pub waivers: Vec<Waiver>,
}

/// A failure that is accepted.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Waiver {
    /// The case, by its id, in which `*` stands for anything.
    pub case: Located<String>,
    /// Only on this device.
    #[serde(default)]
    pub device: Option<String>,
    /// Only with this firmware, in which `*` stands for anything.
    #[serde(default)]
    pub firmware: Option<String>,
    /// Why it is accepted.
    pub reason: String,
    /// The last day on which it is: `2027-03-31`.
    pub expires: Located<String>,
}
