//! `fieldproof run`

mod lanes;
mod preview;

use std::collections::BTreeSet;
use std::time::{Duration, Instant};

use fieldproof_report::{ConsoleOptions, LaneSummary, summary_text};
use fieldproof_suite::model::Effect;
use serde::Serialize;

use crate::bench::Behaviour;
use crate::complaint::Complaint;
use crate::exit::Exit;
use crate::library::{Device, Library};
use crate::options::{EFFECTS, Format, RunOptions};
use crate::player::Plan;
use crate::progress::Progress;
use crate::reports::Reports;
use crate::screen::{INK, Screen};
use crate::{select, stop};
use lanes::Stage;

/// Plays suites against devices. Nothing is written before everything that can be wrong with the input is known.
pub(crate) fn run(options: &RunOptions, screen: &mut Screen) -> Result<Exit, Complaint> {
    let library = Library::load(&options.selection)?;
    let plan = plan(options);
    select::patterns_must_match(&library, &plan)?;
    let devices = devices(&library, &plan)?;
    if options.dry_run {
        return preview::show(&library, &devices, &plan, options, screen);
    }
    let stop = stop::on_interrupt()?;
    let started = Instant::now();
    let reports = Reports::open(&options.reports)?;
    let stage = stage(&library, &devices, &plan, options, screen);
    let lanes = lanes::play(&library, &devices, &plan, &reports, &stage, stop);
    let (summaries, screen) = stage.leave();
    reports.junit(lanes?)?;
    let exit = Exit::of_run(&summaries, options.strict);
    show_outcome(&summaries, started.elapsed(), exit, options, screen);
    Ok(exit)
}

fn stage<'s>(
    library: &Library,
    devices: &[&Device],
    plan: &Plan,
    options: &RunOptions,
    screen: &'s mut Screen,
) -> Stage<'s> {
    let suites = devices
        .iter()
        .flat_map(|device| plan.suites(library, device));
    let cases: usize = suites.map(|(_, cases)| cases).sum();
    let text = options.format == Format::Text;
    let names: Vec<&str> = devices.iter().map(|device| device.name()).collect();
    let console = ConsoleOptions {
        verbose: options.verbose,
        quiet: options.quiet,
        strict: options.strict,
        ink: INK,
    };
    let moves = text && !options.quiet && Screen::shows_progress();
    Stage::new(
        &names,
        console,
        Progress::new(cases as u64, moves),
        text,
        screen,
    )
}

#[derive(Serialize)]
struct RunOutcome<'a> {
    seed: u64,
    strict: bool,
    exit: u8,
    lanes: &'a [LaneSummary],
}

fn show_outcome(
    lanes: &[LaneSummary],
    wall: Duration,
    exit: Exit,
    options: &RunOptions,
    screen: &mut Screen,
) {
    match options.format {
        Format::Json => screen.print_json(&RunOutcome {
            seed: options.seed,
            strict: options.strict,
            exit: exit.code(),
            lanes,
        }),
        Format::Text => {
            let text = summary_text(lanes, wall, options.strict, INK);
            let folder = options.reports.display();
            screen.print(&format!("{text}reports are in {folder}\n"));
        }
    }
}

fn plan(options: &RunOptions) -> Plan {
    let mut permits: BTreeSet<Effect> = match options.allow.is_empty() {
        true => EFFECTS.into_iter().collect(),
        false => options.allow.iter().map(|effect| effect.0).collect(),
    };
    options.deny.iter().for_each(|effect| {
        permits.remove(&effect.0);
    });
    Plan {
        cases: options.selection.cases.clone(),
        except: BTreeSet::new(),
        permits,
        strict: options.strict,
        inspects_device: true,
        behaviour: Behaviour {
            fault: options.fault.clone(),
            variant: options.variant.clone(),
            seed: options.seed,
        },
    }
}

/// The devices that there is something to play on.
fn devices<'l>(library: &'l Library, plan: &Plan) -> Result<Vec<&'l Device>, Complaint> {
    let faults = |device: &Device| {
        device
            .kind
            .faults
            .iter()
            .map(|it| it.name)
            .collect::<Vec<_>>()
    };
    let variants = |device: &Device| {
        device
            .kind
            .variants
            .iter()
            .map(|it| it.name)
            .collect::<Vec<_>>()
    };
    let mut devices: Vec<&Device> = library.devices.iter().collect();
    if let Some(name) = &plan.behaviour.fault {
        devices = having("fault", name, devices, faults)?;
    }
    if let Some(name) = &plan.behaviour.variant {
        devices = having("variant", name, devices, variants)?;
    }
    devices.retain(|device| !plan.suites(library, device).is_empty());
    match devices.is_empty() {
        true => Err(select::nothing_selected()),
        false => Ok(devices),
    }
}

/// Those of `devices` that have something called `name`.
fn having<'l>(
    what: &str,
    name: &str,
    devices: Vec<&'l Device>,
    names: impl Fn(&Device) -> Vec<&'static str>,
) -> Result<Vec<&'l Device>, Complaint> {
    let having: Vec<&Device> = devices
        .iter()
        .copied()
        .filter(|device| names(device).contains(&name))
        .collect();
    if having.is_empty() {
        let known: BTreeSet<&str> = devices.iter().flat_map(|device| names(device)).collect();
        let known: Vec<&str> = known.into_iter().collect();
        return Err(Complaint::unknown(what, name, &known));
    }
    Ok(having)
}
