//! What of a library a command is about.

use fieldproof_report::{Problem, Severity};
use fieldproof_run::suites_for;
use fieldproof_suite::Suite;

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
    for pattern in &plan.cases {
        let ids = || {
            library
                .suites
                .iter()
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

/// Every device that stands on no real link must be one that can be simulated.
pub(crate) fn must_be_simulated(devices: &[&Device]) -> Result<(), Complaint> {
    let Some(device) = devices
        .iter()
        .find(|device| device.is_simulated() && device.kind.is_none())
    else {
        return Ok(());
    };
    let name = &device.description.device;
    let known: Vec<&str> = fieldproof_devices::kinds()
        .iter()
        .map(|kind| kind.name)
        .collect();
    let message = format!("there is no reference device \"{name}\" to simulate it");
    let problem = Problem::new(Severity::Error, message)
        .note("this version plays in simulation only; a device without a reference device can be described and checked")
        .note("`fieldproof run --dry-run` shows what would be played on it");
    Err(Complaint::input(with_choice(problem, name, &known)))
}

/// There is nothing to do.
pub(crate) fn nothing_selected() -> Complaint {
    let problem = Problem::new(Severity::Error, "nothing is selected")
        .note("none of the selected suites is for any of the selected devices, or none of their cases is selected")
        .help("`fieldproof list` shows the cases, `fieldproof devices` the devices");
    Complaint::input(problem)
}
