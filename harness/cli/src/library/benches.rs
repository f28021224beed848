//! Benches: every device that stands on one is found, and must be as the bench says.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use fieldproof_report::{Problem, Severity};
use fieldproof_suite::bench::{BenchDescription, BenchDevice, Link, LinkKind};
use fieldproof_suite::device::PortDescription;
use fieldproof_suite::model::Located;
use fieldproof_suite::{Position, SourceFile, load_bench};

use super::{Device, Folder, Place, Reader, source_file};
use crate::complaint::with_choice;
use crate::{embedded, input, problems};

/// The numbers of a medium that devices have so far, each with where the bench gives it.
type Taken = BTreeMap<(String, u8), Position>;

/// Whether a file is a bench, by its keys: it may have any name.
pub(super) fn is_bench(file: &SourceFile) -> bool {
    file.text.lines().any(|line| line.starts_with("bench:"))
}

/// A bench with what is needed to show what is wrong with it.
struct Shown<'a> {
    path: &'a str,
    text: Arc<str>,
}

impl Shown<'_> {
    fn problem(&self, severity: Severity, at: Position, message: String, label: &str) -> Problem {
        let problem = Problem::new(severity, message).in_file(self.path);
        problems::placed(problem, at, label, &self.text)
    }

    fn error(&self, at: Position, message: String, label: &str) -> Problem {
        self.problem(Severity::Error, at, message, label)
    }
}

impl Reader {
    /// The bench in the file at `path`.
    pub(super) fn bench(&mut self, path: &Path) {
        match input::read(path) {
            Ok(file) => {
                let folder = path.parent().unwrap_or(Path::new("")).to_owned();
                self.benches.push((file, Folder::OnDisk(folder)));
            }
            Err(problem) => self.problems.push(*problem),
        }
    }

    /// The benches that the program carries.
    pub(super) fn carried_benches(&mut self) {
        for (path, text) in embedded::files() {
            if let Some(folder) = path.strip_suffix("/bench.yaml") {
                let folder = Folder::Embedded(folder.to_owned());
                self.benches.push((source_file((path, text)), folder));
            }
        }
    }

    /// Reads the benches and gives back what stands on them, by name.
    pub(super) fn read_benches(&mut self) -> BTreeMap<String, Device> {
        let benches = std::mem::take(&mut self.benches);
        let mut devices = BTreeMap::new();
        for (file, folder) in &benches {
            match load_bench(file) {
                Ok(bench) => devices.extend(self.read_bench(&bench, file, folder)),
                Err(diagnostics) => self.diagnostics(&diagnostics, std::slice::from_ref(file)),
            }
        }
        self.benches = benches;
        devices
    }

    fn read_bench(
        &mut self,
        bench: &BenchDescription,
        file: &SourceFile,
        folder: &Folder,
    ) -> Vec<(String, Device)> {
        let shown = Shown {
            path: &file.path,
            text: Arc::from(file.text.as_str()),
        };
        let mut devices = Vec::new();
        let (mut nodes, mut addresses) = (Taken::new(), Taken::new());
        for on_bench in &bench.devices {
            let Some(mut device) = self.find_device(&on_bench.device, folder, &shown) else {
                continue;
            };
            self.check_ports(on_bench, &device, &shown);
            self.set_addresses(on_bench, &mut device, &shown);
            let description = &device.description;
            if let Some(canopen) = &description.canopen {
                let at = on_bench.node.as_ref().map(|node| node.at);
                let number = ("node-ID", canopen.node, at);
                self.check_alone(on_bench, LinkKind::carries_can, number, &mut nodes, &shown);
            }
            if let Some(modbus) = &description.modbus {
                let at = on_bench.address.as_ref().map(|address| address.at);
                let number = ("address", modbus.address, at);
                self.check_alone(
                    on_bench,
                    LinkKind::carries_serial,
                    number,
                    &mut addresses,
                    &shown,
                );
            }
            let links = on_bench.ports.iter();
            device.place = Some(Place {
                name: on_bench.name.value.clone(),
                links: links
                    .map(|(role, link)| (role.clone(), link.value.clone()))
                    .collect(),
                stimuli: on_bench.stimuli.clone(),
                stimulus_command: on_bench.stimulus_command.clone(),
                permits: on_bench.permits.clone(),
            });
            devices.push((on_bench.name.value.clone(), device));
        }
        devices
    }

    /// A device that a bench names, or whose folder it gives.
    fn find_device(
        &mut self,
        name: &Located<String>,
        folder: &Folder,
        shown: &Shown<'_>,
    ) -> Option<Device> {
        let at = name.at;
        let name = name.value.as_str();
        if !(name.contains(['/', '\\']) || matches!(name, "." | "..")) {
            let device = self.devices.get(name).cloned();
            if device.is_none() {
                let known: Vec<&str> = self.devices.keys().map(String::as_str).collect();
                let message = format!("no device is called \"{name}\"");
                let problem = shown.error(at, message, "a folder is written `./folder`");
                self.problems.push(with_choice(problem, name, &known));
            }
            return device;
        }
        let folder = folder.below(name);
        match folder.file("device.yaml") {
            Ok(file) => self.read_device(&file, &folder),
            Err(problem) => {
                let message = format!("no description of a device is in \"{name}\"");
                let label = "expected a folder with a device.yaml, seen from this file";
                let why = format!("{}: {}", problem.path, problem.message);
                self.problems
                    .push(shown.error(at, message, label).note(why));
                None
            }
        }
    }

    /// A reference device in simulation has no port outside, and a real one none inside.
    fn check_all_or_none_simulated(&mut self, on_bench: &BenchDevice, shown: &Shown<'_>) {
        let is_simulated = |link: &&Located<Link>| link.value.kind == LinkKind::Sim;
        let links = on_bench.ports.values();
        let (simulated, real): (Vec<_>, Vec<_>) = links.partition(is_simulated);
        if let ([simulated, ..], [_, ..]) = (&simulated[..], &real[..]) {
            let message = "one device is both simulated and real".to_owned();
            let label = "`sim:` beside a real link";
            self.problems
                .push(shown.error(simulated.at, message, label));
        }
    }

    /// The ports must be those of the device, on links that carry them.
    fn check_ports(&mut self, on_bench: &BenchDevice, device: &Device, shown: &Shown<'_>) {
        self.check_all_or_none_simulated(on_bench, shown);
        let described = &device.description.ports;
        for (role, link) in &on_bench.ports {
            let kind = link.value.kind;
            let Some(port) = described.get(role) else {
                let known: Vec<&str> = described.keys().map(String::as_str).collect();
                let message = format!("the device has no port \"{role}\"");
                let problem = shown.error(link.at, message, "the link of this port");
                self.problems.push(with_choice(problem, role, &known));
                continue;
            };
            let (what, carried) = match port {
                PortDescription::Can { .. } => ("CAN", kind.carries_can()),
                PortDescription::Serial { .. } => ("serial", kind.carries_serial()),
                PortDescription::Tcp { .. } => ("TCP", kind.carries_tcp()),
            };
            if !carried {
                let message = format!("the port \"{role}\" is a {what} port");
                let label = format!("`{}:` carries no {what} port", kind.name());
                self.problems.push(shown.error(link.at, message, &label));
            }
        }
    }

    /// No other device on the same real bus has this number. In simulation each device has buses of its own.
    fn check_alone(
        &mut self,
        on_bench: &BenchDevice,
        carries: fn(LinkKind) -> bool,
        (what, number, at): (&str, u8, Option<Position>),
        taken: &mut Taken,
        shown: &Shown<'_>,
    ) {
        let at = at.unwrap_or(on_bench.name.at);
        for link in on_bench.ports.values().map(|link| &link.value) {
            if link.kind == LinkKind::Sim || !carries(link.kind) {
                continue;
            }
            let bus = format!("{}:{}", link.kind.name(), link.target);
            let Some(first) = taken.insert((bus.clone(), number), at) else {
                continue;
            };
            let message = format!("a second device with the {what} {number} on `{bus}`");
            let problem = shown.error(at, message, "here again");
            let problem = problems::also(problem, first, "first here");
            let key = if what == "address" { "address" } else { "node" };
            self.problems
                .push(problem.help(format!("give each its own `{key}` on this bench")));
        }
    }

    fn set_addresses(&mut self, on_bench: &BenchDevice, device: &mut Device, shown: &Shown<'_>) {
        let description = &mut device.description;
        if on_bench.serial_number.is_some() {
            description.identity.serial_number = on_bench.serial_number;
        }
        if let Some(node) = &on_bench.node {
            match &mut description.canopen {
                Some(canopen) => canopen.node = node.value,
                None => self.problems.push(shown.error(
                    node.at,
                    "the device has no CANopen side, and so no node-ID".to_owned(),
                    "expected no `node`",
                )),
            }
        }
        if let Some(address) = &on_bench.address {
            match &mut description.modbus {
                Some(modbus) => modbus.address = address.value,
                None => self.problems.push(shown.error(
                    address.at,
                    "the device has no Modbus side, and so no address".to_owned(),
                    "expected no `address`",
                )),
            }
        }
    }
}
