//! `fieldproof run`

mod head;
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
use crate::history::History;
use crate::journal::RunJournal;
use crate::library::{Device, Library};
use crate::operator::Operator;
use crate::options::{EFFECTS, Format, RunOptions};
use crate::player::Plan;
use crate::progress::Progress;
use crate::screen::{INK, Screen};
use crate::{reports, select, stop, value_faults};
use lanes::Stage;

/// Plays suites against devices. Nothing is written before everything that can be wrong with the input is known.
pub(crate) fn run(options: &RunOptions, screen: &mut Screen) -> Result<Exit, Complaint> {
    let library = match &options.bench {
        Some(bench) => Library::load_on_bench(&options.selection, bench)?,
        None => Library::load(&options.selection)?,
    };
    let plan = plan(options);
    select::patterns_must_match(&library, &plan)?;
    let devices = devices(&library, &plan)?;
    if options.dry_run {
        return preview::show(&devices, &plan, options, screen);
    }
    select::must_be_simulated(&devices)?;
    let stop = stop::on_interrupt()?;
    let started = Instant::now();
    let start = head::run_started(&devices, &plan, options)?;
    let history = match Screen::shows_progress() && devices.iter().any(|it| !it.is_simulated()) {
        true => History::read(&options.reports),
        false => History::default(),
    };
    let journal = RunJournal::open(&options.reports, &start, stop)?;
    reports::clear(&options.reports)?;
    let stage = stage(&devices, &plan, options, history, screen);
    let played = lanes::play(&devices, &plan, &journal, &stage, stop);
    let (summaries, screen) = stage.leave();
    let written = played
        .and_then(|()| journal.finish(head::run_finished()))
        .and_then(|()| reports::make(&options.reports));
    let exit = match &written {
        Ok(_) => Exit::of_run(&summaries, options.strict),
        Err(complaint) => complaint.exit,
    };
    let outcome = RunOutcome {
        seed: options.seed,
        strict: options.strict,
        exit: exit.code(),
        not_played: not_played(&devices, &plan, &summaries),
        lanes: &summaries,
    };
    // What was seen is worth knowing also where it could not be kept.
    show_outcome(
        &outcome,
        started.elapsed(),
        written.is_ok(),
        options,
        screen,
    );
    written.map(|_| exit)
}

/// The cases that are played on `device`.
fn ids(device: &Device, plan: &Plan) -> Vec<String> {
    let ids = device.suites.iter().flat_map(|suite| suite.cases());
    let ids = ids.map(|case| case.id());
    ids.filter(|id| plan.selects(id)).collect()
}

fn planned(devices: &[&Device], plan: &Plan) -> usize {
    let suites = devices.iter().flat_map(|device| plan.suites(device));
    suites.map(|(_, cases)| cases).sum()
}

/// How many cases no lane came to, because it was stopped.
fn not_played(devices: &[&Device], plan: &Plan, lanes: &[LaneSummary]) -> usize {
    let finished = lanes.iter().map(|lane| lane.counts.total() as usize);
    planned(devices, plan).saturating_sub(finished.sum())
}

fn stage<'s>(
    devices: &[&Device],
    plan: &Plan,
    options: &RunOptions,
    history: History,
    screen: &'s mut Screen,
) -> Stage<'s> {
    let cases = planned(devices, plan);
    let text = options.format == Format::Text;
    let names: Vec<&str> = devices.iter().map(|device| device.name()).collect();
    let console = ConsoleOptions {
        verbose: options.verbose,
        quiet: options.quiet,
        strict: options.strict,
        ink: INK,
    };
    let moves = text && !options.quiet && Screen::shows_progress();
    let progress = Progress::of_run(cases as u64, moves, history);
    for (lane, device) in devices.iter().enumerate() {
        if moves && !device.is_simulated() {
            let ids: Vec<String> = ids(device, plan);
            progress.plan(lane, device.name(), ids.iter().map(String::as_str));
        }
    }
    Stage::new(&names, console, progress, text, screen)
}

#[derive(Serialize)]
struct RunOutcome<'a> {
    seed: u64,
    strict: bool,
    exit: u8,
    not_played: usize,
    lanes: &'a [LaneSummary],
}

fn show_outcome(
    outcome: &RunOutcome<'_>,
    wall: Duration,
    written: bool,
    options: &RunOptions,
    screen: &mut Screen,
) {
    if options.format == Format::Json {
        return screen.print_json(outcome);
    }
    screen.print(&summary_text(outcome.lanes, wall, options.strict, INK));
    match outcome.not_played {
        0 => {}
        1 => screen.print("1 case was not played\n"),
        cases => screen.print(&format!("{cases} cases were not played\n")),
    }
    if written {
        screen.print(&format!("reports are in {}\n", options.reports.display()));
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
        depth: options.depth.into(),
        strict: options.strict,
        inspects_device: true,
        explains: true,
        behaviour: Behaviour {
            fault: options.fault.clone(),
            variant: options.variant.clone(),
            seed: options.seed,
            line: None,
        },
        operator: match options.no_operator {
            true => Operator::none(),
            false => Operator::at_the_terminal(Duration::from_secs(options.operator_timeout)),
        },
    }
}

/// The devices that there is something to play on.
fn devices<'l>(library: &'l Library, plan: &Plan) -> Result<Vec<&'l Device>, Complaint> {
    let faults = |device: &Device| device.faults().map(|it| it.name).collect::<Vec<_>>();
    let variants = |device: &Device| {
        device
            .variants()
            .iter()
            .map(|it| it.name)
            .collect::<Vec<_>>()
    };
    let mut devices: Vec<&Device> = library.devices.iter().collect();
    if let Some(name) = &plan.behaviour.fault {
        let with_object = |device: &&&Device| value_faults::of(device, name).is_some();
        let with: Vec<&Device> = devices.iter().filter(with_object).copied().collect();
        devices = match with.is_empty() {
            true => having("fault", name, devices, faults)?,
            false => with,
        };
    }
    if let Some(name) = &plan.behaviour.variant {
        devices = having("variant", name, devices, variants)?;
    }
    devices.retain(|device| !plan.suites(device).is_empty());
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
