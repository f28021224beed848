//! The suites and devices of a command: what the program carries, or what the user gave in its place.

mod benches;
mod catalogues;
mod identity;
mod near;

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use fieldproof_devices::{DeviceKind, Fault, Medium, Variant};
use fieldproof_dictionary::Dictionary;
use fieldproof_dictionary::eds::{self, Eds};
use fieldproof_dictionary::registers::RegisterMap;
use fieldproof_record::UsedFile;
use fieldproof_report::{Problem, Severity, SourceText};
use fieldproof_run::{Known, fill, fill_some, suites_for};
use fieldproof_suite::bench::{Link, LinkKind};
use fieldproof_suite::catalogue::Catalogue;
use fieldproof_suite::device::{DeviceDescription, Feature, PortDescription};
use fieldproof_suite::model::{Effect, Located, StimulusName};
use fieldproof_suite::{Diagnostic, Position, SourceFile, Suite};

use crate::bench;
use crate::complaint::{Complaint, with_choice};
use crate::embedded;
use crate::input;
use crate::options::Selection;
use crate::problems;
use crate::reports::manifest::sha256;
use benches::is_bench;
use catalogues::is_catalogue;

/// Index and sub-index.
const SERIAL_NUMBER: (u16, u8) = (0x1018, 4);

/// A device with everything that is known of it.
#[derive(Clone)]
pub struct Device {
    /// What it claims.
    pub description: DeviceDescription,
    /// Its object dictionary, if it has a CANopen side.
    pub dictionary: Option<Dictionary>,
    /// Its register map, if it has a Modbus side of which that is known.
    pub registers: Option<RegisterMap>,
    /// The bit rates that its EDS claims.
    pub bit_rates_kbit_per_s: BTreeSet<u32>,
    /// The reference device of that name; without one, the device cannot be simulated.
    pub kind: Option<&'static DeviceKind>,
    /// The files it is described in.
    pub files: Vec<UsedFile>,
    /// Where a bench has it.
    pub place: Option<Place>,
    /// The suites it is tested with, of those that are asked for, filled from its dictionary.
    pub suites: Vec<Suite>,
}

/// What a bench says of a device.
#[derive(Debug, Clone)]
pub struct Place {
    /// What the bench calls it.
    pub name: String,
    /// What the ports that are connected are connected to, by role.
    pub links: BTreeMap<String, Link>,
    /// The stimuli there are; those that the links offer if nothing is said.
    pub stimuli: Option<BTreeSet<StimulusName>>,
    /// What gives them on real links; without it, an operator is asked.
    pub stimulus_command: Option<Vec<String>>,
    /// What is permitted.
    pub permits: BTreeSet<Effect>,
}

impl Device {
    /// Whether it is a reference device on simulated links, and not a real one.
    pub fn is_simulated(&self) -> bool {
        let links = self.place.as_ref().map(|place| &place.links);
        links.is_none_or(|links| links.values().all(|link| link.kind == LinkKind::Sim))
    }

    /// What is claimed of the unit that is tested: the serial number of a simulated one is that of its EDS.
    pub(crate) fn description_of_unit(&self) -> Cow<'_, DeviceDescription> {
        let serial_number = self.dictionary.as_ref().and_then(|dictionary| {
            let entry = dictionary.entry(SERIAL_NUMBER.0, SERIAL_NUMBER.1)?;
            let bytes = entry.default_bytes(0)?.try_into().ok()?;
            Some(u32::from_le_bytes(bytes))
        });
        if !self.is_simulated() || self.description.identity.serial_number.is_some() {
            return Cow::Borrowed(&self.description);
        }
        let mut description = self.description.clone();
        description.identity.serial_number = serial_number.map(|value| Located {
            value,
            at: Position::default(),
        });
        Cow::Owned(description)
    }

    /// The faults its reference device can have; nothing can be switched on in a real device.
    pub fn faults(&self) -> impl Iterator<Item = &'static Fault> + use<> {
        self.simulated().into_iter().flat_map(DeviceKind::faults)
    }

    /// The legal variants of its reference device; a real one is what it is.
    pub fn variants(&self) -> &'static [Variant] {
        self.simulated().map_or(&[], |kind| kind.variants)
    }

    /// The device with at most `most` rows of every table that its dictionary or register map fills.
    pub(crate) fn with_some_of_each(&self, suites: &[Suite], most: u16) -> Device {
        let known = self.known();
        let some = |suite| fill_some(suite, &self.description, known, most);
        Device {
            suites: suites_for(suites, &self.description).map(some).collect(),
            ..self.clone()
        }
    }

    /// The same with other numbers on its lines.
    pub(crate) fn numbered(&self, node: u8, address: u8) -> Device {
        let mut device = self.clone();
        if let Some(canopen) = &mut device.description.canopen {
            canopen.node = node;
        }
        if let Some(modbus) = &mut device.description.modbus {
            modbus.address = address;
        }
        device
    }

    /// One that was configured: its defaults hold no more.
    pub(crate) fn configured(&self) -> Device {
        let mut device = self.clone();
        let features = &mut device.description.features;
        features.retain(|feature| *feature != Feature::FactorySettings);
        device
    }

    fn fill(&mut self, suites: &[Suite]) {
        let known = self.known();
        self.suites = suites_for(suites, &self.description)
            .map(|suite| fill(suite, &self.description, known))
            .collect();
    }

    fn known(&self) -> Known<'_> {
        Known {
            dictionary: self.dictionary.as_ref(),
            registers: self.registers.as_ref(),
            bit_rates_kbit_per_s: Some(&self.bit_rates_kbit_per_s),
        }
    }

    fn simulated(&self) -> Option<&'static DeviceKind> {
        self.kind.filter(|_| self.is_simulated())
    }

    /// Its name on the bench, or else that of its description.
    pub fn name(&self) -> &str {
        match &self.place {
            Some(place) => &place.name,
            None => &self.description.device,
        }
    }
}

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

const EDS: &str = "EDS";

fn used(kind: &str, file: &SourceFile) -> UsedFile {
    UsedFile {
        kind: kind.to_owned(),
        path: file.path.clone(),
        sha256: sha256(file.text.as_bytes()),
    }
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

    /// A description that the user gave takes the place of the one the program carries.
    fn read_devices(&mut self) {
        for (path, text) in embedded::files() {
            if let Some(folder) = path.strip_suffix("/device.yaml") {
                let file = source_file((path, text));
                self.device(&file, &Folder::Embedded(folder.to_owned()));
            }
        }
        for (file, folder) in std::mem::take(&mut self.descriptions) {
            self.device(&file, &folder);
        }
    }

    fn device(&mut self, file: &SourceFile, folder: &Folder) {
        if let Some(device) = self.read_device(file, folder) {
            let name = device.description.device.clone();
            self.description_files.insert(name.clone(), file.clone());
            self.devices.insert(name, device);
        }
    }

    fn read_device(&mut self, file: &SourceFile, folder: &Folder) -> Option<Device> {
        let description = match fieldproof_suite::load_device(file) {
            Ok(description) => description,
            Err(diagnostics) => {
                self.diagnostics(&diagnostics, std::slice::from_ref(file));
                return None;
            }
        };
        let kind = fieldproof_devices::kind(&description.device);
        self.ports(&description, kind, &file.path);
        let mut files = vec![used("device description", file)];
        let (dictionary, bit_rates) = description
            .canopen
            .as_ref()
            .and_then(|canopen| self.eds(folder, &canopen.eds))
            .map(|(eds, it)| {
                let contradictions = identity::contradictions(&description, file, &eds, &it.path);
                self.problems.extend(contradictions);
                files.push(it);
                (eds.dictionary, eds.device_info.bit_rates_kbit_per_s)
            })
            .unzip();
        let map = description
            .modbus
            .as_ref()
            .and_then(|modbus| modbus.registers.as_ref());
        let registers = map.and_then(|map| self.register_map(folder, map, &mut files));
        self.described.insert(description.device.clone());
        Some(Device {
            description,
            dictionary,
            registers,
            bit_rates_kbit_per_s: bit_rates.unwrap_or_default(),
            kind,
            files,
            place: None,
            suites: Vec::new(),
        })
    }

    /// The ports that a description gives must be those of the reference device, if there is one.
    fn ports(
        &mut self,
        description: &DeviceDescription,
        kind: Option<&'static DeviceKind>,
        path: &str,
    ) {
        let fail = |message: String| Problem::new(Severity::Error, message).in_file(path);
        for (role, port) in &description.ports {
            if let PortDescription::Serial {
                companion: Some(name),
                ..
            } = port
                && !bench::COMPANIONS.contains(&name.as_str())
            {
                let problem = fail(format!("no companion is called \"{name}\""));
                self.problems
                    .push(with_choice(problem, name, &bench::COMPANIONS));
            }
            let Some(kind) = kind else { continue };
            let Some(simulated) = kind.ports.iter().find(|simulated| simulated.role == role) else {
                let known: Vec<&str> = kind.ports.iter().map(|port| port.role).collect();
                let problem = fail(format!("the reference device has no port \"{role}\""));
                self.problems.push(with_choice(problem, role, &known));
                continue;
            };
            match (port, simulated.medium) {
                (PortDescription::Can { .. }, Medium::Can { .. })
                | (PortDescription::Serial { .. }, Medium::Serial(_))
                | (PortDescription::Tcp { .. }, Medium::Tcp) => {}
                (_, Medium::Tcp) => {
                    self.problems
                        .push(fail(format!("the port \"{role}\" is one of Modbus TCP")));
                }
                (_, Medium::Can { .. }) => {
                    self.problems
                        .push(fail(format!("the port \"{role}\" is a CAN port")));
                }
                (_, Medium::Serial(_)) => {
                    self.problems
                        .push(fail(format!("the port \"{role}\" is a serial port")));
                }
            }
        }
    }

    /// The EDS beside a description, and which file it is.
    fn eds(&mut self, folder: &Folder, name: &str) -> Option<(Eds, UsedFile)> {
        let file = match folder {
            Folder::OnDisk(folder) => input::read_eds(&folder.join(name)),
            Folder::Embedded(_) => folder
                .file(name)
                .map(|file| (used(EDS, &file).sha256, file)),
        };
        match file {
            Ok((sha256, file)) => {
                let read = eds::read(&file.text);
                let text = Arc::from(file.text);
                let findings = read
                    .findings
                    .iter()
                    .map(|it| problems::of_used_finding(it, &file.path, &text));
                self.problems.extend(findings);
                let used = UsedFile {
                    kind: EDS.to_owned(),
                    path: file.path,
                    sha256,
                };
                Some((read, used))
            }
            Err(problem) => {
                self.problems.push(*problem);
                None
            }
        }
    }

    fn register_map(
        &mut self,
        folder: &Folder,
        name: &str,
        files: &mut Vec<UsedFile>,
    ) -> Option<RegisterMap> {
        match folder.file(name) {
            Ok(file) => {
                files.push(used("register map", &file));
                self.registers(&file)
            }
            Err(problem) => {
                self.problems.push(*problem);
                None
            }
        }
    }

    fn registers(&mut self, file: &SourceFile) -> Option<RegisterMap> {
        fieldproof_suite::load_registers(file)
            .map_err(|diagnostics| self.diagnostics(&diagnostics, std::slice::from_ref(file)))
            .ok()
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
