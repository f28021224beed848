//! Catalogues: those that the program carries, and those that the user gave.

use fieldproof_suite::{SourceFile, load_catalogue, unknown_entries};

use super::{Reader, source_file};
use crate::{embedded, problems};

/// Whether a file is a catalogue, by its keys: it may have any name.
pub(super) fn is_catalogue(file: &SourceFile) -> bool {
    file.text.lines().any(|line| line.starts_with("catalogue:"))
}

impl Reader {
    /// A catalogue that the user gave takes the place of the one the program carries.
    pub(super) fn read_catalogues(&mut self) {
        let carried = embedded::files().filter(|(path, _)| path.starts_with("catalogues/"));
        let mut files: Vec<SourceFile> = carried.map(source_file).collect();
        files.append(&mut self.catalogue_files);
        for file in &files {
            match load_catalogue(file) {
                Ok(catalogue) => {
                    let name = catalogue.catalogue.value.clone();
                    self.catalogues.insert(name, catalogue);
                }
                Err(diagnostics) => self.diagnostics(&diagnostics, std::slice::from_ref(file)),
            }
        }
    }

    /// What cases say they cover must be there.
    pub(super) fn look_for_entries(&mut self) {
        let catalogues: Vec<_> = self.catalogues.values().cloned().collect();
        for suite in &self.suites {
            for diagnostic in unknown_entries(suite, &catalogues) {
                let problem = problems::of_diagnostic(&diagnostic, suite.text());
                self.problems.push(problem);
            }
        }
    }
}
