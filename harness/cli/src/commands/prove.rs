//! `fieldproof prove`: are the suites themselves any good? Every fault of every reference device must be caught, and
//! without a fault, and in every legal variant, everything must pass.

mod show;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use fieldproof_record::{Event, Sink, Verdict, VerdictCounts};
use serde::Serialize;

use crate::bench::Behaviour;
use crate::complaint::Complaint;
use crate::exit::Exit;
use crate::library::{Device, Library};
use crate::options::{Format, ProveOptions};
use crate::player::{self, Plan};
use crate::progress::Progress;
use crate::screen::Screen;
use crate::{select, stop};

/// Plays every suite against every fault and shows which case catches which.
pub(crate) fn prove(options: &ProveOptions, screen: &mut Screen) -> Result<Exit, Complaint> {
    let library = Library::load(&options.selection)?;
    let plan = Plan {
        cases: options.selection.cases.clone(),
        ..Plan::default()
    };
    select::patterns_must_match(&library, &plan)?;
    let rounds = rounds(&library, &plan, options)?;
    let stop = stop::on_interrupt()?;
    let shown = options.format == Format::Text && Screen::shows_progress();
    let tallies = play_all(&library, &plan, &rounds, stop, shown)?;
    if stop.load(Ordering::Relaxed) {
        return Err(Complaint::bench("interrupted"));
    }
    let proof = judge(&rounds, &tallies);
    match options.format {
        Format::Json => screen.print_json(&proof),
        Format::Text => screen.print(&show::text(&proof)),
    }
    Ok(match proof.holds {
        true => Exit::Passed,
        false => Exit::Failed,
    })
}

/// What a device is made to be.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind", content = "name")]
enum Guise {
    AsItIs,
    Variant(&'static str),
    Fault(&'static str),
}

/// One device in one guise, to be played with all suites.
struct Round<'l> {
    device: &'l Device,
    guise: Guise,
    breaks: &'static str,
    behaviour: Behaviour,
}

fn rounds<'l>(
    library: &'l Library,
    plan: &Plan,
    options: &ProveOptions,
) -> Result<Vec<Round<'l>>, Complaint> {
    let devices: Vec<&Device> = library
        .devices
        .iter()
        .filter(|device| !plan.suites(library, device).is_empty())
        .collect();
    if devices.is_empty() {
        return Err(select::nothing_selected());
    }
    let known: BTreeSet<&str> = devices
        .iter()
        .flat_map(|device| device.kind.faults.iter().map(|it| it.name))
        .collect();
    if let Some(name) = options
        .faults
        .iter()
        .find(|name| !known.contains(name.as_str()))
    {
        let known: Vec<&str> = known.into_iter().collect();
        return Err(Complaint::unknown("fault", name, &known));
    }
    let mut rounds = Vec::new();
    for device in devices {
        let mut round = |guise, breaks, fault: Option<&str>, variant: Option<&str>| {
            rounds.push(Round {
                device,
                guise,
                breaks,
                behaviour: Behaviour {
                    fault: fault.map(str::to_owned),
                    variant: variant.map(str::to_owned),
                    seed: options.seed,
                },
            });
        };
        round(Guise::AsItIs, "", None, None);
        for variant in device.kind.variants {
            round(Guise::Variant(variant.name), "", None, Some(variant.name));
        }
        for fault in device.kind.faults {
            if options.faults.is_empty() || options.faults.iter().any(|name| name == fault.name) {
                round(
                    Guise::Fault(fault.name),
                    fault.breaks,
                    Some(fault.name),
                    None,
                );
            }
        }
    }
    Ok(rounds)
}

/// The verdicts of a round by case as written, its rows taken together.
#[derive(Debug, Default)]
struct Tally {
    case: String,
    cases: BTreeMap<String, VerdictCounts>,
    stopped: Option<String>,
}

impl Sink for Tally {
    fn emit(&mut self, event: Event) {
        match event {
            Event::CaseStarted(case) => self.case = case.written_id,
            Event::CaseFinished(case) => {
                self.cases
                    .entry(self.case.clone())
                    .or_default()
                    .add(case.verdict);
            }
            Event::LaneFinished(lane) => self.stopped = lane.stopped,
            _ => {}
        }
    }
}

impl Tally {
    /// The cases that had `verdict` in at least one row.
    fn with(&self, verdict: Verdict) -> Vec<String> {
        let had = self
            .cases
            .iter()
            .filter(|(_, counts)| counts.of(verdict) > 0);
        had.map(|(id, _)| id.clone()).collect()
    }
}

/// Plays all rounds, as many at once as there are processors.
fn play_all(
    library: &Library,
    plan: &Plan,
    rounds: &[Round<'_>],
    stop: &AtomicBool,
    shown: bool,
) -> Result<Vec<Tally>, Complaint> {
    let next = AtomicUsize::new(0);
    let progress = Progress::new(rounds.len() as u64, shown);
    let done: Mutex<BTreeMap<usize, Tally>> = Mutex::default();
    let work = || -> Result<(), Complaint> {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(round) = rounds.get(index) else {
                return Ok(());
            };
            let mut tally = Tally::default();
            let plan = Plan {
                behaviour: round.behaviour.clone(),
                ..plan.clone()
            };
            player::play(library, round.device, &plan, &mut tally, stop)
                .map_err(|error| Complaint::bench(error.to_string()))?;
            done.lock()
                .unwrap_or_else(PoisonError::into_inner)
                .insert(index, tally);
            progress.step();
        }
    };
    let processors = thread::available_parallelism().map_or(1, usize::from);
    let worked: Vec<_> = thread::scope(|scope| {
        let workers: Vec<_> = (0..processors).map(|_| scope.spawn(work)).collect();
        workers
            .into_iter()
            .map(thread::ScopedJoinHandle::join)
            .collect()
    });
    progress.clear();
    for worked in worked {
        worked.unwrap_or_else(|_| Err(Complaint::bench("a lane broke down")))?;
    }
    Ok(done
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner)
        .into_values()
        .collect())
}

/// What the rounds show.
#[derive(Debug, Serialize)]
struct Proof {
    /// Whether every fault is caught and everything else passes.
    holds: bool,
    rounds: Vec<Finding>,
    /// Faults that no case caught: device and name.
    uncaught: Vec<(String, &'static str)>,
    /// Cases that were played and caught nothing on any device.
    idle_cases: Vec<String>,
}

/// What one round shows.
#[derive(Debug, Serialize)]
struct Finding {
    device: String,
    guise: Guise,
    /// The clause that a fault breaks.
    #[serde(skip_serializing_if = "str::is_empty")]
    breaks: &'static str,
    /// Cases that failed. For a fault: only those that do not fail without it.
    failed: Vec<String>,
    inconclusive: Vec<String>,
    error: Vec<String>,
    /// Why the lane ended before its last case.
    stopped: Option<String>,
    played: usize,
}

impl Finding {
    fn passes(&self) -> bool {
        self.failed.is_empty()
            && self.inconclusive.is_empty()
            && self.error.is_empty()
            && self.stopped.is_none()
    }
}

fn judge(rounds: &[Round<'_>], tallies: &[Tally]) -> Proof {
    let mut findings: Vec<Finding> = Vec::new();
    let mut played: BTreeSet<String> = BTreeSet::new();
    let mut caught: BTreeSet<String> = BTreeSet::new();
    // Of the device as it is.
    let mut fails_anyway: Vec<String> = Vec::new();
    for (round, tally) in rounds.iter().zip(tallies) {
        let mut failed = tally.with(Verdict::Fail);
        match round.guise {
            Guise::AsItIs => {
                fails_anyway.clone_from(&failed);
                let was_played = |counts: &VerdictCounts| counts.total() > counts.skipped;
                let cases = tally.cases.iter().filter(|(_, counts)| was_played(counts));
                played.extend(cases.map(|(id, _)| id.clone()));
            }
            Guise::Variant(_) => {}
            Guise::Fault(_) => {
                failed.retain(|id| !fails_anyway.contains(id));
                caught.extend(failed.iter().cloned());
            }
        }
        findings.push(Finding {
            device: round.device.name().to_owned(),
            guise: round.guise,
            breaks: round.breaks,
            failed,
            inconclusive: tally.with(Verdict::Inconclusive),
            error: tally.with(Verdict::Error),
            stopped: tally.stopped.clone(),
            played: tally.cases.len(),
        });
    }
    let uncaught: Vec<(String, &'static str)> = findings
        .iter()
        .filter_map(|finding| match finding.guise {
            Guise::Fault(name) if finding.failed.is_empty() => Some((finding.device.clone(), name)),
            _ => None,
        })
        .collect();
    let others_pass = findings
        .iter()
        .filter(|finding| !matches!(finding.guise, Guise::Fault(_)))
        .all(Finding::passes);
    Proof {
        holds: uncaught.is_empty() && others_pass,
        uncaught,
        idle_cases: played.difference(&caught).cloned().collect(),
        rounds: findings,
    }
}
