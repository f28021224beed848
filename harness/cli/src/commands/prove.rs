//! `fieldproof prove`: are the suites themselves any good? Every fault of every reference device must be caught, and
//! without a fault, and in every legal variant, everything must pass.

mod show;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
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
use crate::{object_faults, select, stop};

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
    let tallies = play_all(&plan, &rounds, stop, shown)?;
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
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind", content = "name")]
enum Guise {
    AsItIs,
    Variant(&'static str),
    Fault(String),
}

/// One device in one guise, to be played with all suites.
struct Round {
    device: Arc<Device>,
    guise: Guise,
    breaks: &'static str,
    behaviour: Behaviour,
}

/// A fault that is not one of a single value shows in any row of a walk, or in none: so many are played.
const ROWS_OF_A_WALK: u16 = 8;

fn rounds(library: &Library, plan: &Plan, options: &ProveOptions) -> Result<Vec<Round>, Complaint> {
    let devices: Vec<&Device> = library
        .devices
        .iter()
        .filter(|device| !plan.suites(device).is_empty())
        .collect();
    if devices.is_empty() {
        return Err(select::nothing_selected());
    }
    select::must_be_simulated(&devices)?;
    faults_must_be_known(&devices, &options.faults)?;
    let mut rounds = Vec::new();
    for device in devices {
        let whole = Arc::new(device.clone());
        let sampled = Arc::new(device.with_some_of_each(&library.suites, ROWS_OF_A_WALK));
        let mut round = |guise, breaks, fault: Option<&str>, variant: Option<&str>| {
            let of_value = fault.is_some_and(|name| object_faults::of(device, name).is_some());
            let device = match fault.is_some() && !of_value {
                true => &sampled,
                false => &whole,
            };
            rounds.push(Round {
                device: Arc::clone(device),
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
        for variant in device.variants() {
            round(Guise::Variant(variant.name), "", None, Some(variant.name));
        }
        for (name, breaks) in faults(device, &options.faults) {
            round(Guise::Fault(name.clone()), breaks, Some(&name), None);
        }
    }
    Ok(rounds)
}

/// The faults that `device` is given, each with the clause it breaks: those asked for, or else all that have a name and
/// some of each kind that single values can have.
fn faults(device: &Device, asked: &[String]) -> Vec<(String, &'static str)> {
    let named = device.faults();
    let named = named.map(|fault| (fault.name.to_owned(), fault.breaks));
    if asked.is_empty() {
        let of_objects = object_faults::some(device).into_iter();
        return named
            .chain(of_objects.map(|fault| (fault.to_string(), fault.kind().breaks())))
            .collect();
    }
    let of_objects = asked
        .iter()
        .filter_map(|name| object_faults::of(device, name));
    named
        .filter(|(name, _)| asked.contains(name))
        .chain(of_objects.map(|fault| (fault.to_string(), fault.kind().breaks())))
        .collect()
}

fn faults_must_be_known(devices: &[&Device], asked: &[String]) -> Result<(), Complaint> {
    let known: BTreeSet<&str> = devices
        .iter()
        .flat_map(|device| device.faults().map(|it| it.name))
        .collect();
    let is_known = |name: &&String| {
        let of_object = |device: &&Device| object_faults::of(device, name).is_some();
        known.contains(name.as_str()) || devices.iter().any(of_object)
    };
    match asked.iter().find(|name| !is_known(name)) {
        None => Ok(()),
        Some(name) => {
            let known: Vec<&str> = known.iter().copied().collect();
            Err(Complaint::unknown("fault", name, &known))
        }
    }
}

/// What a round came to, by case as written, its rows taken together.
#[derive(Debug, Default)]
struct Tally {
    case: String,
    cases: BTreeMap<String, CaseTally>,
    /// The ids of all cases that were tried.
    tried: BTreeSet<String>,
    /// Why lanes ended before their last case.
    stops: Vec<String>,
}

#[derive(Debug, Default)]
struct CaseTally {
    counts: VerdictCounts,
    /// Whether the device was found wrong in at least one row, be it that more happened afterwards.
    found_wrong: bool,
}

impl Sink for Tally {
    fn emit(&mut self, event: Event) {
        match event {
            Event::CaseStarted(case) => self.case = case.written_id,
            Event::CaseFinished(case) => {
                let tally = self.cases.entry(self.case.clone()).or_default();
                tally.counts.add(case.verdict);
                tally.found_wrong |= case.verdict == Verdict::Fail
                    || case
                        .failures
                        .iter()
                        .any(|failure| failure.verdict == Verdict::Fail);
                self.tried.insert(case.id);
            }
            Event::LaneFinished(lane) => self.stops.extend(lane.stopped),
            _ => {}
        }
    }
}

impl Tally {
    /// The cases in which the device was found wrong.
    fn found_wrong(&self) -> Vec<String> {
        self.those(|tally| tally.found_wrong)
    }

    /// The cases that had `verdict` in at least one row.
    fn with(&self, verdict: Verdict) -> Vec<String> {
        self.those(|tally| tally.counts.of(verdict) > 0)
    }

    fn those(&self, belongs: impl Fn(&CaseTally) -> bool) -> Vec<String> {
        let those = self.cases.iter().filter(|(_, tally)| belongs(tally));
        those.map(|(id, _)| id.clone()).collect()
    }
}

/// Plays one round. A device that cannot be put back stops its lane; the cases after that one are played on a fresh
/// device, for each is to show what it catches.
fn play_round(plan: &Plan, round: &Round, stop: &AtomicBool) -> Result<Tally, Complaint> {
    let mut tally = Tally::default();
    let mut plan = Plan {
        behaviour: round.behaviour.clone(),
        ..plan.clone()
    };
    loop {
        let stops = tally.stops.len();
        let tried = tally.tried.len();
        player::play(&round.device, &plan, &mut tally, stop)
            .map_err(|error| Complaint::bench(error.to_string()))?;
        let whole = tally.stops.len() == stops;
        let nothing_new = tally.tried.len() == tried;
        if whole || nothing_new || stop.load(Ordering::Relaxed) {
            return Ok(tally);
        }
        plan.except.clone_from(&tally.tried);
    }
}

/// Plays all rounds, as many at once as there are processors.
fn play_all(
    plan: &Plan,
    rounds: &[Round],
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
            let tally = play_round(plan, round, stop)?;
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
    uncaught: Vec<(String, String)>,
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
    /// Why the device could not be used any more; the cases after that were played on a fresh one.
    stops: Vec<String>,
    /// Cases as written that were played or skipped.
    cases: usize,
}

impl Finding {
    fn passes(&self) -> bool {
        self.failed.is_empty()
            && self.inconclusive.is_empty()
            && self.error.is_empty()
            && self.stops.is_empty()
    }
}

fn judge(rounds: &[Round], tallies: &[Tally]) -> Proof {
    let mut findings: Vec<Finding> = Vec::new();
    let mut played: BTreeSet<String> = BTreeSet::new();
    let mut caught: BTreeSet<String> = BTreeSet::new();
    // Of the device as it is.
    let mut fails_anyway: Vec<String> = Vec::new();
    for (round, tally) in rounds.iter().zip(tallies) {
        let mut failed = tally.found_wrong();
        match round.guise {
            Guise::AsItIs => {
                fails_anyway.clone_from(&failed);
                played.extend(tally.those(|it| it.counts.total() > it.counts.skipped));
            }
            Guise::Variant(_) => {}
            Guise::Fault(_) => {
                failed.retain(|id| !fails_anyway.contains(id));
                caught.extend(failed.iter().cloned());
            }
        }
        findings.push(Finding {
            device: round.device.name().to_owned(),
            guise: round.guise.clone(),
            breaks: round.breaks,
            failed,
            inconclusive: tally.with(Verdict::Inconclusive),
            error: tally.with(Verdict::Error),
            stops: tally.stops.clone(),
            cases: tally.cases.len(),
        });
    }
    let uncaught: Vec<(String, String)> = findings
        .iter()
        .filter_map(|finding| match &finding.guise {
            Guise::Fault(name) if finding.failed.is_empty() => {
                Some((finding.device.clone(), name.clone()))
            }
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
