//! The suites and devices of a command: what the program carries, or what the user gave in its place.

mod benches;
mod catalogues;
mod descriptions;
mod device;
mod identity;
mod near;

pub use device::{Device, Place};

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use fieldproof_report::{Problem, Severity, SourceText};
use fieldproof_suite::catalogue::Catalogue;
use fieldproof_suite::{Diagnostic, SourceFile, Suite};

use crate::complaint::{Complaint, with_choice};
use crate::embedded;
use crate::input;
use crate::options::Selection;
use crate::problems;
use benches::is_bench;
use catalogues::is_catalogue;

/// Suites and devices, read and checked.
pub struct Library {
    /// The suites that are asked for, in the order they were named.
    pub suites: Vec<Suite>,
    /// The devices that are asked for, by name.
    pub devices: Vec<Device>,
    /// What should be tested, in the order of their names.
    pub catalogues: Vec<Catalogue>,
    /// How many benches were read.
    pub benches: usize,
    /// What is wrong with the files but does not keep them from being used.
    pub warnings: Vec<Problem>,
}

impl Library {
    /// Reads what `selection` asks for.
    ///
    /// # Errors
    /// [`Complaint`]: a file is wrong or cannot be read, or there is nothing of a name.
    pub fn load(selection: &Selection) -> Result<Library, Complaint> {
        let mut reader = Reader::of(selection);
        reader.read_benches();
        reader.finish(selection)
    }

    /// Reads what `selection` asks for, to be played on the bench in the file at `bench`: the devices are those that
    /// stand on it.
    ///
    /// # Errors
    /// As [`Library::load`]; or the bench has a link that cannot be opened, where `links` are to be.
    pub(crate) fn load_on_bench(selection: &Selection, bench: &Path) -> Result<Library, Complaint> {
        let mut reader = Reader::of(selection);
        reader.benches.clear();
        reader.bench(bench);
        reader.devices = reader.read_benches();
        reader.finish(selection)
    }

    /// Reads what `selection` asks for and looks at it more closely: at the benches that the program carries too, if
    /// nothing else is asked for, and for deviations from checks and entries of catalogues that there are not.
    ///
    /// # Errors
    /// As [`Library::load`].
    pub fn load_closely(selection: &Selection) -> Result<Library, Complaint> {
        let mut reader = Reader::of(selection);
        if selection.suites.is_empty() {
            reader.carried_benches();
        }
        reader.read_benches();
        reader.look_for_checks();
        reader.look_for_entries();
        reader.finish(selection)
    }
}

/// A folder that a description lies in, with the files beside it.
enum Folder {
    Embedded(String),
    OnDisk(PathBuf),
}

impl Folder {
    /// The folder that is called so from here.
    fn below(&self, name: &str) -> Folder {
        match self {
            Folder::OnDisk(folder) if name == "." => Folder::OnDisk(folder.clone()),
            Folder::OnDisk(folder) => Folder::OnDisk(folder.join(name)),
            Folder::Embedded(folder) if name == "." => Folder::Embedded(folder.clone()),
            Folder::Embedded(folder) => Folder::Embedded(format!("{folder}/{name}")),
        }
    }

    fn file(&self, name: &str) -> Result<SourceFile, Box<Problem>> {
        match self {
            Folder::OnDisk(folder) => input::read(&folder.join(name)),
            Folder::Embedded(folder) => {
                let path = format!("{folder}/{name}");
                match embedded::text(&path) {
                    Some(text) => Ok(source_file((path.as_str(), text))),
                    None => Err(Box::new(
                        Problem::new(Severity::Error, "there is no such file").in_file(path),
                    )),
                }
            }
        }
    }
}

fn source_file((path, text): (&str, &str)) -> SourceFile {
    SourceFile {
        path: path.to_owned(),
        text: text.to_owned(),
    }
}

/// Register maps lie beside the descriptions that name them.
fn is_register_map(file: &SourceFile) -> bool {
    file.text.lines().any(|line| line.starts_with("registers:"))
}

/// In so many lines the head of a suite is looked for.
const HEAD_LINES: u32 = 100;

#[derive(Default)]
struct Reader {
    problems: Vec<Problem>,
    /// Suite files in the order they were named.
    files: Vec<SourceFile>,
    seen: BTreeSet<PathBuf>,
    descriptions: Vec<(SourceFile, Folder)>,
    /// Names of embedded suites, or the beginnings of such.
    names: Vec<String>,
    suites: Vec<Suite>,
    devices: BTreeMap<String, Device>,
    /// The files of the descriptions, where deviations from unknown checks are shown.
    description_files: BTreeMap<String, SourceFile>,
    benches: Vec<(SourceFile, Folder)>,
    catalogues: BTreeMap<String, Catalogue>,
    catalogue_files: Vec<SourceFile>,
    /// The names of all devices that there is a description of, also of those that are not played on.
    described: BTreeSet<String>,
    /// The names of the devices whose folders were given for names.
    folders: BTreeMap<String, String>,
}

impl Reader {
    fn of(selection: &Selection) -> Reader {
        let mut reader = Reader::default();
        reader.arguments(&selection.suites);
        reader.read_suites();
        reader.read_devices();
        reader.read_catalogues();
        reader.device_folders(&selection.devices);
        reader
    }

    fn arguments(&mut self, arguments: &[String]) {
        for argument in arguments {
            // It would be the beginning of every id.
            if argument.is_empty() {
                let problem = Problem::new(Severity::Error, "the name of a suite is empty");
                self.problems.push(problem);
                continue;
            }
            let path = Path::new(argument);
            let looks_like_a_path =
                argument.contains(['/', '\\']) || input::is_yaml(path) || argument == ".";
            if path.is_dir() {
                self.folder(path);
            } else if looks_like_a_path || path.exists() {
                self.file(path);
            } else {
                self.names.push(argument.clone());
            }
        }
    }

    fn folder(&mut self, folder: &Path) {
        match input::yaml_below(folder) {
            Ok(files) if files.is_empty() => {
                let problem = Problem::new(Severity::Error, "no suite (*.yaml) in this folder");
                self.problems
                    .push(problem.in_file(folder.display().to_string()));
            }
            Ok(files) => files.iter().for_each(|file| self.file(file)),
            Err(problem) => self.problems.push(*problem),
        }
    }

    fn file(&mut self, path: &Path) {
        let identity = path.canonicalize().unwrap_or_else(|_| path.to_owned());
        if !self.seen.insert(identity) {
            return;
        }
        match input::read(path) {
            Err(problem) => self.problems.push(*problem),
            Ok(file) if path.file_name().is_some_and(|name| name == "device.yaml") => {
                let folder = path.parent().unwrap_or(Path::new("")).to_owned();
                self.descriptions.push((file, Folder::OnDisk(folder)));
            }
            Ok(file) if is_bench(&file) => {
                let folder = path.parent().unwrap_or(Path::new("")).to_owned();
                self.benches.push((file, Folder::OnDisk(folder)));
            }
            Ok(file) if is_catalogue(&file) => self.catalogue_files.push(file),
            Ok(file) if is_register_map(&file) => drop(self.registers(&file)),
            Ok(file) => self.files.push(file),
        }
    }

    fn read_suites(&mut self) {
        let given = std::mem::take(&mut self.files);
        if given.is_empty() && self.names.is_empty() || !self.names.is_empty() {
            let carried: Vec<SourceFile> = embedded::files()
                .filter(|(path, _)| path.starts_with("suites/"))
                .map(source_file)
                .collect();
            self.carried_suites(&carried);
        }
        let suites = self.load(&given);
        suites.into_iter().for_each(|suite| self.add(suite));
    }

    fn carried_suites(&mut self, files: &[SourceFile]) {
        let suites = self.load(files);
        let names = self.names.clone();
        let known: Vec<&str> = suites
            .iter()
            .map(|suite| suite.head.suite.as_str())
            .collect();
        for name in &names {
            if !known.iter().any(|id| id.starts_with(name.as_str())) {
                let message = format!("no suite, file or folder is called \"{name}\"");
                let problem = Problem::new(Severity::Error, message);
                self.problems.push(with_choice(problem, name, &known));
            }
        }
        for suite in suites {
            let id = &suite.head.suite;
            if names.is_empty() || names.iter().any(|name| id.starts_with(name.as_str())) {
                self.add(suite);
            }
        }
    }

    fn load(&mut self, files: &[SourceFile]) -> Vec<Suite> {
        let loaded = fieldproof_suite::load(files);
        self.diagnostics(&loaded.diagnostics, files);
        loaded.suites
    }

    /// The problems of one file share its text.
    fn diagnostics(&mut self, diagnostics: &[Diagnostic], files: &[SourceFile]) {
        let mut shared: (&str, Arc<str>) = ("", Arc::default());
        for diagnostic in diagnostics {
            if shared.0 != diagnostic.path {
                let file = files.iter().find(|file| file.path == diagnostic.path);
                let text = file.map(|file| file.text.as_str()).unwrap_or_default();
                shared = (&diagnostic.path, Arc::from(text));
            }
            self.problems
                .push(problems::of_diagnostic(diagnostic, &shared.1));
        }
    }

    fn add(&mut self, suite: Suite) {
        let id = &suite.head.suite;
        match self.suites.iter().find(|other| other.head.suite == *id) {
            Some(other) => {
                let message = format!("a second suite with the id \"{id}\"");
                let problem = Problem::new(Severity::Error, message)
                    .in_file(suite.path.clone())
                    .note(format!("the first is in {}", other.path));
                self.problems.push(problem);
            }
            None => self.suites.push(suite),
        }
    }

    /// A suite may be for one device only, and that must be one there is.
    fn check_devices_of_suites(&mut self) {
        let known: Vec<&str> = self.described.iter().map(String::as_str).collect();
        for suite in &self.suites {
            let Some(name) = suite
                .head
                .device
                .as_deref()
                .filter(|name| !known.contains(name))
            else {
                continue;
            };
            let message = format!("no device is called \"{name}\"");
            let mut problem = Problem::new(Severity::Error, message).in_file(suite.path.clone());
            // The head stands at the top of its file.
            let line = (1..=HEAD_LINES).find(|line| suite.line_text(*line).starts_with("device:"));
            if let Some(line) = line {
                problem.at.line = line;
                problem.source = SourceText::Line(suite.line_text(line).to_owned());
            }
            self.problems.push(with_choice(problem, name, &known));
        }
    }

    fn finish(mut self, selection: &Selection) -> Result<Library, Complaint> {
        self.check_devices_of_suites();
        // A description that is named twice, by itself and on a bench, is wrong once.
        let mut told = Vec::new();
        self.problems.retain(|problem| {
            let is_new = !told.contains(problem);
            told.extend(is_new.then(|| problem.clone()));
            is_new
        });
        if self
            .problems
            .iter()
            .any(|problem| problem.severity >= Severity::Error)
        {
            return Err(Complaint::inputs(self.problems));
        }
        let known: Vec<&str> = self.devices.keys().map(String::as_str).collect();
        let asked: Vec<&str> = selection
            .devices
            .iter()
            .map(|name| self.folders.get(name).unwrap_or(name).as_str())
            .collect();
        for name in &asked {
            if !self.devices.contains_key(*name) {
                return Err(Complaint::unknown("device", name, &known));
            }
        }
        let mut devices: Vec<Device> = self
            .devices
            .into_values()
            .filter(|device| asked.is_empty() || asked.contains(&device.name()))
            .collect();
        for device in &mut devices {
            device.fill(&self.suites);
        }
        Ok(Library {
            suites: self.suites,
            devices,
            catalogues: self.catalogues.into_values().collect(),
            benches: self.benches.len(),
            warnings: self.problems,
        })
    }
}
