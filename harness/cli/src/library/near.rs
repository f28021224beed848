//! What is asked for by folder, and what is looked at more closely.

use std::collections::BTreeSet;
use std::path::Path;

use fieldproof_suite::{Suite, unknown_checks};

use super::{Folder, Reader, source_file};
use crate::{embedded, input};

impl Reader {
    /// Reads the descriptions in the folders that are given where a name could stand. A name that there is comes first.
    pub(super) fn device_folders(&mut self, arguments: &[String]) {
        for argument in arguments {
            let path = Path::new(argument);
            let folder = match path.ends_with("device.yaml") {
                true => path.parent().unwrap_or(Path::new("")),
                false => path,
            };
            let is_path = argument.contains(['/', '\\']) || matches!(argument.as_str(), "." | "..");
            let file = folder.join("device.yaml");
            if self.devices.contains_key(argument) || !(is_path || file.is_file()) {
                continue;
            }
            match input::read(&file) {
                Ok(file) => {
                    let read = self.read_device(&file, &Folder::OnDisk(folder.to_owned()));
                    if let Some(device) = read {
                        let name = device.description.device.clone();
                        self.folders.insert(argument.clone(), name.clone());
                        self.description_files.insert(name.clone(), file);
                        self.devices.insert(name, device);
                    }
                }
                Err(problem) => self.problems.push(*problem),
            }
        }
    }

    /// Warns of deviations from checks that no suite has.
    pub(super) fn look_for_checks(&mut self) {
        let carried: Vec<_> = embedded::files()
            .filter(|(path, _)| path.starts_with("suites/"))
            .map(source_file)
            .collect();
        let carried = fieldproof_suite::load(&carried).suites;
        let known: BTreeSet<String> = carried
            .iter()
            .chain(&self.suites)
            .flat_map(Suite::checks)
            .collect();
        let files = std::mem::take(&mut self.description_files);
        for (name, file) in &files {
            if let Some(device) = self.devices.get(name) {
                let unknown = unknown_checks(&device.description, &file.path, &known);
                self.diagnostics(&unknown, std::slice::from_ref(file));
            }
        }
    }
}
