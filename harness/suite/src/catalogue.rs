//! Numbered lists of what should be tested: the cases of a certification, the rows of a manual's table.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::model::{Located, Source};

/// A catalogue.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Catalogue {
    /// The version of the language: 1.
    #[schemars(range(min = 1, max = 1))]
    pub language: u32,
    /// What `covers` calls it: `cct`.
    pub catalogue: Located<String>,
    /// One line for people.
    pub title: String,
    /// Where the list is from.
    pub source: Source,
    /// What should be tested.
    #[schemars(length(min = 1))]
    pub entries: Located<Vec<CatalogueEntry>>,
}

/// One thing that should be tested.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct CatalogueEntry {
    /// Its number in the list: `2.17`.
    pub id: Located<String>,
    /// One line for people.
    pub title: String,
    /// What tests it that is no case.
    #[serde(default)]
    pub elsewhere: Option<String>,
    /// Why nothing tests it.
    #[serde(default)]
    pub not_covered: Option<String>,
}
