//! `fieldproof run`

use std::collections::BTreeSet;
use std::fmt::Write;
use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Instant;

use fieldproof_devices::UnknownFault;
use fieldproof_record::{Event, Sink};
use fieldproof_report::{Console, ConsoleOptions, LaneSummary, summary_text};
use fieldproof_suite::model::Effect;
use serde::Serialize;

use crate::bench::Behaviour;
use crate::complaint::Complaint;
use crate::exit::Exit;
use crate::library::{Device, Library};
use crate::options::{EFFECTS, Format, RunOptions};
use crate::player::{self, Plan};
use crate::progress::Progress;
use crate::reports::{LaneCases, LaneReports, Reports};
use crate::screen::{INK, Screen};
use crate::{select, stop};

/// Plays suites against devices.
pub(crate) fn run(options: &RunOptions, screen: &mut Screen) -> Result<Exit, Complaint> {
    let library = Library::load(&options.selection)?;
    let plan = plan(options);
    select::patterns_must_match(&library, &plan)?;
    let devices = devices(&library, &plan)?;
    if options.dry_run {
        return dry_run(&library, &devices, &plan, options, screen);
    }
    let stop = stop::on_interrupt()?;
    let started = Instant::now();
    let reports = Reports::open(&options.reports)?;
    let cases = devices
        .iter()
        .flat_map(|device| plan.suites(&library, device));
    let cases: usize = cases.map(|(_, ids)| ids.len()).sum();
    let text = options.format == Format::Text;
    let names: Vec<&str> = devices.iter().map(|device| device.name()).collect();
    let console = ConsoleOptions {
        verbose: options.verbose,
        quiet: options.quiet,
        strict: options.strict,
        ink: INK,
    };
    let stage = Stage {
        shown: Mutex::new(Shown {
            console: Console::new(&names, console),
            screen,
        }),
        progress: Progress::new(
            cases as u64,
            text && !options.quiet && Screen::shows_progress(),
        ),
        text,
    };
    let lanes = play_lanes(&library, &devices, &plan, &reports, &stage, stop);
    stage.progress.clear();
    let shown = stage
        .shown
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner);
    reports.junit(lanes?)?;
    let summaries = shown.console.summaries();
    let exit = Exit::of_run(&summaries, options.strict);
    match options.format {
        Format::Json => shown.screen.print_json(&RunOutcome {
            seed: options.seed,
            strict: options.strict,
            exit: exit.code(),
            lanes: &summaries,
        }),
        Format::Text => {
            let text = summary_text(&summaries, started.elapsed(), options.strict, INK);
            let folder = options.reports.display();
            shown
                .screen
                .print(&format!("{text}reports are in {folder}\n"));
        }
    }
    Ok(exit)
}

#[derive(Serialize)]
struct RunOutcome<'a> {
    seed: u64,
    strict: bool,
    exit: u8,
    lanes: &'a [LaneSummary],
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

/// What all lanes show themselves on.
struct Stage<'s> {
    shown: Mutex<Shown<'s>>,
    progress: Progress,
    text: bool,
}

struct Shown<'s> {
    console: Console,
    screen: &'s mut Screen,
}

impl Stage<'_> {
    fn show(&self, change: impl FnOnce(&mut Console) -> String) {
        let mut shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        let text = change(&mut shown.console);
        if self.text && !text.is_empty() {
            self.progress.suspend(|| shown.screen.print(&text));
        }
    }
}

/// Where the events of one lane go.
struct LaneSink<'a, 's> {
    stage: &'a Stage<'s>,
    lane: usize,
    reports: LaneReports,
}

impl Sink for LaneSink<'_, '_> {
    fn emit(&mut self, event: Event) {
        if Console::wants(&event) {
            if matches!(event, Event::CaseFinished(_)) {
                self.stage.progress.step();
            }
            self.stage.show(|console| console.event(self.lane, &event));
        }
        self.reports.emit(event);
    }
}

/// Plays every device in a thread of its own.
fn play_lanes(
    library: &Library,
    devices: &[&Device],
    plan: &Plan,
    reports: &Reports,
    stage: &Stage<'_>,
    stop: &AtomicBool,
) -> Result<Vec<LaneCases>, Complaint> {
    let play = |lane: usize, device: &Device| -> Result<LaneCases, Complaint> {
        let reports = reports.lane(device.name(), plan.strict)?;
        let mut sink = LaneSink {
            stage,
            lane,
            reports,
        };
        let played = player::play(library, device, plan, &mut sink, stop);
        stage.show(|console| console.end(lane));
        played.map_err(|error| no_such_behaviour(&error))?;
        sink.reports.finish()
    };
    thread::scope(|scope| {
        let play = &play;
        let lanes: Vec<_> = devices
            .iter()
            .enumerate()
            .map(|(lane, device)| scope.spawn(move || play(lane, device)))
            .collect();
        lanes
            .into_iter()
            .zip(devices)
            .map(|(lane, device)| match lane.join() {
                Ok(cases) => cases,
                Err(_) => Err(Complaint::bench(format!(
                    "the lane of {} broke down",
                    device.name()
                ))),
            })
            .collect()
    })
}

fn no_such_behaviour(error: &UnknownFault) -> Complaint {
    Complaint::bench(error.to_string())
}

#[derive(Serialize)]
struct Planned<'a> {
    device: &'a str,
    suite: &'a str,
    case: &'a str,
    skipped: Option<&'a str>,
}

/// Shows what would be played.
fn dry_run(
    library: &Library,
    devices: &[&Device],
    plan: &Plan,
    options: &RunOptions,
    screen: &mut Screen,
) -> Result<Exit, Complaint> {
    let mut text = String::new();
    let mut all = Vec::new();
    let mut previews = Vec::new();
    for device in devices {
        let preview =
            player::preview(library, device, plan).map_err(|it| no_such_behaviour(&it))?;
        previews.push((device, preview));
    }
    for (device, preview) in &previews {
        for (suite, cases) in preview {
            let skipped = cases.iter().filter(|case| case.skipped.is_some()).count();
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "{} on {}: {} to play, {skipped} to skip",
                suite.head.suite,
                device.name(),
                cases.len() - skipped,
            );
            for case in cases {
                match &case.skipped {
                    Some(reason) => {
                        let _ = writeln!(text, "  skip  {}\n        {reason}", case.id);
                    }
                    None if options.quiet => {}
                    None => {
                        let _ = writeln!(text, "  play  {}\n        {}", case.id, case.title);
                    }
                }
                all.push(Planned {
                    device: device.name(),
                    suite: &suite.head.suite,
                    case: &case.id,
                    skipped: case.skipped.as_deref(),
                });
            }
        }
    }
    match options.format {
        Format::Json => screen.print_json(&all),
        Format::Text => {
            let skipped = all.iter().filter(|case| case.skipped.is_some()).count();
            let played = all.len() - skipped;
            screen.print(&format!(
                "{text}\n{played} would be played, {skipped} skipped\n"
            ));
        }
    }
    Ok(Exit::Passed)
}
