//! Descriptions of devices, with the EDS and the register map that they name.

use std::sync::Arc;

use fieldproof_devices::{DeviceKind, Medium};
use fieldproof_dictionary::eds::{self, Eds};
use fieldproof_dictionary::registers::RegisterMap;
use fieldproof_record::UsedFile;
use fieldproof_report::{Problem, Severity};
use fieldproof_suite::SourceFile;
use fieldproof_suite::device::{DeviceDescription, PortDescription};

use super::{Device, Folder, Reader, identity, source_file};
use crate::complaint::with_choice;
use crate::reports::manifest::sha256;
use crate::{bench, embedded, input, problems};

const EDS: &str = "EDS";

fn used(kind: &str, file: &SourceFile) -> UsedFile {
    UsedFile {
        kind: kind.to_owned(),
        path: file.path.clone(),
        sha256: sha256(file.text.as_bytes()),
    }
}

impl Reader {
    /// A description that the user gave takes the place of the one the program carries.
    pub(super) fn read_devices(&mut self) {
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

    pub(super) fn read_device(&mut self, file: &SourceFile, folder: &Folder) -> Option<Device> {
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

    pub(super) fn registers(&mut self, file: &SourceFile) -> Option<RegisterMap> {
        fieldproof_suite::load_registers(file)
            .map_err(|diagnostics| self.diagnostics(&diagnostics, std::slice::from_ref(file)))
            .ok()
    }
}
