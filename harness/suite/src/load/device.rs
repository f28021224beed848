//! A device description.

use std::collections::{BTreeMap, BTreeSet};

use serde::Deserialize;

use super::SourceFile;
use super::case::citations;
use super::suite::{check_language, check_name};
use crate::device::{Deviation, DeviceDescription, PortDescription};
use crate::expand::Scope;
use crate::file::{DeviationFile, DeviceFile, PortFile};
use crate::model::{Located, Source};
use crate::node::Node;
use crate::problem::{Problem, with_nearest};
use crate::read::Reader;
use crate::yaml;
use crate::{Diagnostic, Position, code};

/// Reads a device description.
///
/// # Errors
/// Everything that is wrong with it.
pub fn load_device(file: &SourceFile) -> Result<DeviceDescription, Vec<Diagnostic>> {
    let root = yaml::read(&file.path, &file.text)?;
    let mut problems = Vec::new();
    match read(&root, &mut problems) {
        Some(device) if problems.is_empty() => Ok(device),
        _ => {
            problems.sort_by_key(|problem| problem.at);
            let problems = problems.into_iter();
            Err(problems
                .map(|problem| problem.into_diagnostic(&file.path))
                .collect())
        }
    }
}

/// The deviations of `device`, read from the file at `path`, from checks that are not among `known`. Warnings, for the
/// suite that has the check may lie elsewhere.
pub fn unknown_checks(
    device: &DeviceDescription,
    path: &str,
    known: &BTreeSet<String>,
) -> Vec<Diagnostic> {
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    let unknown = device
        .deviates
        .iter()
        .filter(|one| !known.contains(&one.check.as_str()));
    unknown
        .map(|one| {
            let message = format!("no suite has the check `{}`", one.check);
            let problem = Problem::new(
                code::UNKNOWN_CHECK,
                message,
                "this deviation will never be met",
            );
            with_nearest(problem, &one.check, &known)
                .at(one.at)
                .into_diagnostic(path)
        })
        .collect()
}

fn read(root: &Node, problems: &mut Vec<Problem>) -> Option<DeviceDescription> {
    if let Err(problem) = check_language(root) {
        problems.push(*problem);
        return None;
    }
    let scope = Scope::default();
    let file = match DeviceFile::deserialize(Reader::new(root, &scope, root.at)) {
        Ok(file) => file,
        Err(error) => {
            problems.push(*error.0);
            return None;
        }
    };
    if let Err(problem) = check_name(&file.device.value, file.device.at) {
        problems.push(*problem);
    }
    let ports_at = root.entry("ports").map_or(root.at, |entry| entry.key.at);
    let ports = read_ports(file.ports.value, root.get("ports"), ports_at, problems);
    if file.canopen.is_some() {
        side_has_port("canopen", "can", &ports, ports_at, problems);
    }
    if file.modbus.is_some() {
        let role = match ports.contains_key("tcp") && !ports.contains_key("serial") {
            true => "tcp",
            false => "serial",
        };
        side_has_port("modbus", role, &ports, ports_at, problems);
    }
    let deviates = file.deviates.into_iter();
    Some(DeviceDescription {
        language: file.language,
        device: file.device.value,
        title: file.title,
        identity: file.identity,
        ports,
        canopen: file.canopen.map(|side| side.value),
        modbus: file.modbus.map(|side| side.value),
        features: file.features,
        timing: file.timing.lower(),
        dangers: file.dangers,
        deviates: deviates
            .map(|one| read_deviation(one, &file.sources, problems))
            .collect(),
        sources: file.sources,
    })
}

/// Suites play on the ports of these names, whatever else a device has.
fn side_has_port(
    side: &str,
    role: &str,
    ports: &BTreeMap<String, PortDescription>,
    at: Position,
    problems: &mut Vec<Problem>,
) {
    let carries = |port: &PortDescription| match port {
        PortDescription::Can { .. } => side == "canopen",
        PortDescription::Serial { .. } => side == "modbus" && role == "serial",
        PortDescription::Tcp { .. } => side == "modbus" && role == "tcp",
    };
    if ports.get(role).is_some_and(carries) {
        return;
    }
    let message = format!("the device has a `{side}` side and no port `{role}` for it");
    let label = format!("expected `{role}: {{{role}: ..}}` here, the port that its suites play on");
    let mut problem = Problem::new(code::NO_PORT, message, label);
    if let Some((other, _)) = ports.iter().find(|(_, port)| carries(port)) {
        problem = problem.help(format!("is it `{other}`? Then call that `{role}`"));
    }
    problems.push(*problem.at(at));
}

fn read_ports(
    ports: BTreeMap<String, PortFile>,
    nodes: Option<&Node>,
    at: Position,
    problems: &mut Vec<Problem>,
) -> BTreeMap<String, PortDescription> {
    let mut lowered = BTreeMap::new();
    for (role, port) in ports {
        let at = nodes
            .and_then(|nodes| nodes.get(&role))
            .map_or(at, |port| port.at);
        match port.lower() {
            Ok(port) => {
                lowered.insert(role, port);
            }
            Err(wrong) => problems.push(*wrong.or_at(at).into_problem()),
        }
    }
    lowered
}

fn read_deviation(
    deviation: Located<DeviationFile>,
    sources: &BTreeMap<String, Source>,
    problems: &mut Vec<Problem>,
) -> Deviation {
    let DeviationFile {
        check,
        instead,
        cite,
    } = deviation.value;
    Deviation {
        check: check.value,
        instead: instead.lower(),
        cite: citations(sources, cite, problems),
        at: check.at,
    }
}
