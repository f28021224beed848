//! What of a library a command is about.

use fieldproof_report::{Problem, Severity};
use fieldproof_run::suites_for;
use fieldproof_suite::Suite;
use fieldproof_suite::device::PortDescription;

use crate::complaint::{Complaint, with_choice};
use crate::library::{Device, Library};
use crate::player::Plan;

/// Whether `device` is tested with `suite`.
pub(crate) fn is_for(suite: &Suite, device: &Device) -> bool {
    suites_for(std::slice::from_ref(suite), &device.description)
        .next()
        .is_some()
}

/// Every pattern must be like at least one case of the selected suites.
pub(crate) fn patterns_must_match(library: &Library, plan: &Plan) -> Result<(), Complaint> {
    let of_devices = || library.devices.iter().flat_map(|device| &device.suites);
    for pattern in &plan.cases {
        let ids = || {
            library
                .suites
                .iter()
                .chain(of_devices())
                .flat_map(Suite::cases)
                .map(|case| case.id())
        };
        if ids().any(|id| crate::glob::matches(pattern, &id)) {
            continue;
        }
        let written: std::collections::BTreeSet<String> = library
            .suites
            .iter()
            .flat_map(Suite::cases)
            .map(|case| case.written_id())
            .collect();
        let known: Vec<&str> = written.iter().map(String::as_str).collect();
        let problem = Problem::new(Severity::Error, format!("no case is like \"{pattern}\""));
        // All the ids there are would be no help.
        let mut problem = with_choice(problem, pattern, &known);
        problem.notes = vec!["`fieldproof list` shows the ids of all cases".to_owned()];
        return Err(Complaint::input(problem));
    }
    Ok(())
}

/// Every device that is to be simulated must be one that can be.
pub(crate) fn must_be_simulated(devices: &[&Device]) -> Result<(), Complaint> {
    let cannot_be = |device: &&&Device| device.kind.is_none() && device.is_simulated();
    let Some(device) = devices.iter().find(cannot_be) else {
        return Ok(());
    };
    let name = &device.description.device;
    let message = format!("there is no reference device \"{name}\" to simulate it");
    let links = device.description.ports.iter().map(|(role, port)| {
        let link = match port {
            PortDescription::Can { .. } => "socketcan:can0",
            PortDescription::Serial { .. } => "serial:/dev/ttyUSB0",
            PortDescription::Tcp { port } => &format!("tcp:192.168.1.10:{port}"),
        };
        format!("{role}: \"{link}\"")
    });
    let ports = format!("ports: {{{}}}", links.collect::<Vec<_>>().join(", "));
    let note = match &device.place {
        Some(_) => {
            format!("on this bench it stands on `sim:`; name the link it is connected to:\n{ports}")
        }
        None => format!(
            "a bench says which link it is connected to: a bench.yaml beside its device.yaml\n\
             (`new-device` has written one, in which the link is `sim:`)\n\
             language: 1\n\
             bench: mine\n\
             devices:\n  - {{name: {name}, device: ., {ports}}}"
        ),
    };
    let known: Vec<&str> = fieldproof_devices::kinds()
        .iter()
        .map(|kind| kind.name)
        .collect();
    let problem = Problem::new(Severity::Error, message)
        .note(note)
        .note("then: fieldproof run --bench FOLDER/bench.yaml")
        .note("`--dry-run` shows what would be played, without a device");
    Err(Complaint::input(with_choice(problem, name, &known)))
}

/// There is nothing to do.
pub(crate) fn nothing_selected() -> Complaint {
    let problem = Problem::new(Severity::Error, "nothing is selected")
        .note("none of the selected suites is for any of the selected devices, or none of their cases is selected")
        .help("`fieldproof list` shows the cases, `fieldproof devices` the devices");
    Complaint::input(problem)
}
