//! A bench.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::SourceFile;
use super::suite::{check_language, check_name};
use crate::bench::{BenchDescription, BenchDevice, Link, LinkKind};
use crate::expand::Scope;
use crate::file::{BenchDeviceFile, BenchFile};
use crate::model::Located;
use crate::node::Node;
use crate::problem::Problem;
use crate::read::Reader;
use crate::yaml;
use crate::{Diagnostic, Position, code};

/// Reads a bench.
///
/// # Errors
/// Everything that is wrong with it.
pub fn load_bench(file: &SourceFile) -> Result<BenchDescription, Vec<Diagnostic>> {
    let root = yaml::read(&file.path, &file.text)?;
    let mut problems = Vec::new();
    match read(&root, &mut problems) {
        Some(bench) if problems.is_empty() => Ok(bench),
        _ => {
            problems.sort_by_key(|problem| problem.at);
            let problems = problems.into_iter();
            Err(problems
                .map(|problem| problem.into_diagnostic(&file.path))
                .collect())
        }
    }
}

fn read(root: &Node, problems: &mut Vec<Problem>) -> Option<BenchDescription> {
    if let Err(problem) = check_language(root) {
        problems.push(*problem);
        return None;
    }
    let scope = Scope::default();
    let file = match BenchFile::deserialize(Reader::new(root, &scope, root.at)) {
        Ok(file) => file,
        Err(error) => {
            problems.push(*error.0);
            return None;
        }
    };
    if let Err(problem) = check_name(&file.bench.value, file.bench.at) {
        problems.push(*problem);
    }
    if file.devices.value.is_empty() {
        let problem = Problem::new(
            code::EMPTY,
            "nothing stands on the bench",
            "needs at least one device",
        );
        problems.push(*problem.at(file.devices.at));
    }
    let mut names = BTreeMap::new();
    let devices = file.devices.value.into_iter();
    let devices: Vec<BenchDevice> = devices
        .map(|device| read_device(device, &mut names, problems))
        .collect();
    links_in_use(&devices, problems);
    Some(BenchDescription {
        language: file.language,
        bench: file.bench.value,
        devices,
    })
}

/// What one process can open once only carries one port.
fn links_in_use(devices: &[BenchDevice], problems: &mut Vec<Problem>) {
    let mut opened: BTreeMap<(LinkKind, &str), Position> = BTreeMap::new();
    let mut links: Vec<&Located<Link>> = devices.iter().flat_map(|it| it.ports.values()).collect();
    links.sort_by_key(|link| link.at);
    for link in links {
        let Link { kind, target, .. } = &link.value;
        if !matches!(kind, LinkKind::Slcan | LinkKind::Serial) {
            continue;
        }
        if let Some(first) = opened.get(&(*kind, target.as_str())) {
            let message = format!("`{}:{target}` is connected to a port already", kind.name());
            let problem = Problem::new(code::LINK_IN_USE, message, "can be opened once only");
            problems.push(*problem.at(link.at).also(*first, "first here"));
        } else {
            opened.insert((*kind, target), link.at);
        }
    }
}

fn read_device(
    device: Located<BenchDeviceFile>,
    names: &mut BTreeMap<String, Position>,
    problems: &mut Vec<Problem>,
) -> BenchDevice {
    let at = device.at;
    let device = device.value;
    let name = &device.name;
    if let Err(problem) = check_name(&name.value, name.at) {
        problems.push(*problem);
    }
    if let Some(first) = names.get(&name.value) {
        let message = format!("`{}` stands on this bench already", name.value);
        let problem = Problem::new(code::DUPLICATE_DEVICE, message, "a second time");
        problems.push(*problem.at(name.at).also(*first, "first here"));
    } else {
        names.insert(name.value.clone(), name.at);
    }
    if device.ports.value.is_empty() {
        let problem = Problem::new(
            code::EMPTY,
            "no port of the device is connected",
            "needs at least one port with its link",
        );
        problems.push(*problem.at(device.ports.at));
    }
    if let Some(command) = &device.stimulus_command
        && command.value.is_empty()
    {
        let problem = Problem::new(
            code::EMPTY,
            "the stimulus command names no program",
            "needs at least the program",
        );
        problems.push(*problem.at(command.at));
    }
    BenchDevice {
        name: device.name,
        device: device.device,
        ports: device.ports.value,
        node: device.node,
        address: device.address,
        serial_number: device.serial_number,
        stimuli: device.stimuli.map(|stimuli| stimuli.into_iter().collect()),
        stimulus_command: device.stimulus_command.map(|command| command.value),
        permits: device.permits.into_iter().collect(),
        at,
    }
}
