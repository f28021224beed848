//! Files of accepted failures.

use serde::Deserialize;

use super::SourceFile;
use super::suite::check_language;
use crate::read::Reader;
use crate::waivers::Waivers;
use crate::{Diagnostic, yaml};

/// Reads a file of accepted failures. What its dates mean is left to who knows what day it is.
///
/// # Errors
/// What is wrong with it.
pub fn load_waivers(file: &SourceFile) -> Result<Waivers, Vec<Diagnostic>> {
    let root = yaml::read(&file.path, &file.text)?;
    let scope = crate::expand::Scope::default();
    let read = check_language(&root).and_then(|()| {
        Waivers::deserialize(Reader::new(&root, &scope, root.at)).map_err(|error| error.0)
    });
    read.map_err(|problem| vec![problem.into_diagnostic(&file.path)])
}
