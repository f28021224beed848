//! Plays one lane: the only place that calls the engine.

use std::collections::BTreeSet;
use std::sync::atomic::AtomicBool;

use fieldproof_link::Lane;
use fieldproof_record::Sink;
use fieldproof_run::{Bench, LaneJob, LaneOutcome, play_lane, skip_reason};
use fieldproof_suite::model::{Depth, Effect, Protocol};
use fieldproof_suite::{CaseRef, Environment, Suite};

use crate::bench::{self, Behaviour, NotConnected};
use crate::glob;
use crate::library::Device;
use crate::operator::Operator;
use crate::options::EFFECTS;

/// The tool and its version, as journals name it.
pub(crate) const TOOL: &str = concat!("fieldproof ", env!("CARGO_PKG_VERSION"));

/// What is played on a lane, beside the device.
#[derive(Debug, Clone)]
pub struct Plan {
    /// Patterns for the ids of cases; none for all.
    pub cases: Vec<String>,
    /// Ids of cases that are left out nevertheless.
    pub except: BTreeSet<String>,
    /// What cases may do to the device.
    pub permits: BTreeSet<Effect>,
    /// How thorough the run is.
    pub depth: Depth,
    /// Only the strict abort codes pass.
    pub strict: bool,
    /// Whether the device is opened after each case to see that it is as it was found.
    pub inspects_device: bool,
    /// Whether the record is to stand for itself, for reports.
    pub explains: bool,
    /// How the reference device is built.
    pub behaviour: Behaviour,
    /// Who is asked for stimuli on real links.
    pub operator: Operator,
}

impl Default for Plan {
    /// All cases to the full depth, everything permitted, on a device as it is.
    fn default() -> Plan {
        Plan {
            cases: Vec::new(),
            except: BTreeSet::new(),
            permits: EFFECTS.into_iter().collect(),
            depth: Depth::Full,
            strict: false,
            inspects_device: true,
            explains: false,
            behaviour: Behaviour::default(),
            operator: Operator::none(),
        }
    }
}

impl Plan {
    /// Whether the case called `id` is played.
    pub fn selects(&self, id: &str) -> bool {
        let is_like = |pattern: &String| glob::matches(pattern, id);
        (self.cases.is_empty() || self.cases.iter().any(is_like)) && !self.except.contains(id)
    }

    /// The suites that `device` is tested with, each with the number of its selected cases.
    pub fn suites<'l>(&self, device: &'l Device) -> Vec<(&'l Suite, usize)> {
        device
            .suites
            .iter()
            .map(|suite| {
                (
                    suite,
                    suite
                        .cases()
                        .filter(|case| self.selects(&case.id()))
                        .count(),
                )
            })
            .filter(|(_, cases)| *cases > 0)
            .collect()
    }
}

/// Plays on `device` the suites it is tested with, as `plan` says; `sink` is told everything. Stops early once `stop` is
/// set.
///
/// # Errors
/// The device has no such fault or variant, or cannot be simulated, or its links cannot be opened.
pub fn play(
    device: &Device,
    plan: &Plan,
    sink: &mut dyn Sink,
    stop: &AtomicBool,
) -> Result<LaneOutcome, NotConnected> {
    let mut lane = bench::open(device, &plan.behaviour, &plan.operator)?;
    let lane = lane.as_mut();
    let bench = Bench {
        depth: plan.depth,
        ..bench::bench(device, lane, &plan.permits)
    };
    let description = device.description_of_unit();
    let behaviour = &plan.behaviour;
    let job = LaneJob {
        tool: TOOL,
        name: device.name(),
        device: &description,
        dictionary: device.dictionary.as_ref(),
        bench: &bench,
        suites: &device.suites,
        selects: &|id| plan.selects(id),
        strict: plan.strict,
        inspects_device: plan.inspects_device,
        explains: plan.explains,
        fault: behaviour.fault.as_deref(),
        variant: behaviour.variant.as_deref(),
        seed: behaviour.seed,
    };
    Ok(play_lane(&job, lane, sink, stop))
}

/// A case that would be played or skipped.
pub(crate) struct PlannedCase {
    pub(crate) id: String,
    pub(crate) title: String,
    /// The case as written that it is a row of.
    pub(crate) written_id: String,
    /// The catalogues and entries of them that it realises.
    pub(crate) covers: Vec<(String, String)>,
    /// Why it would be skipped.
    pub(crate) skipped: Option<String>,
}

/// What [`play`] would do, suite by suite, as far as it can be known beforehand.
///
/// # Errors
/// The device has no such fault or variant, or cannot be simulated.
pub(crate) fn preview<'l>(
    device: &'l Device,
    plan: &Plan,
) -> Result<Vec<(&'l Suite, Vec<PlannedCase>)>, NotConnected> {
    let bench = match device.kind {
        // A real device does what it does; nobody knows it before it is there.
        Some(_) if device.is_simulated() => {
            let lane = bench::connect(device, &plan.behaviour)?;
            bench::bench(device, &lane as &dyn Lane, &plan.permits)
        }
        _ => bench::described_bench(device, &plan.permits, &plan.operator),
    };
    let bench = Bench {
        depth: plan.depth,
        ..bench
    };
    let environment = Environment {
        node: bench.node,
        address: bench.address,
        identity: device.description_of_unit().identity.numbers(),
    };
    let planned = |suite: &'l Suite| {
        let cases = suite.cases().filter(|case| plan.selects(&case.id()));
        cases
            .map(|case| plan_case(&case, suite.head.protocol, device, &environment, &bench))
            .collect::<Vec<_>>()
    };
    Ok(device
        .suites
        .iter()
        .map(|suite| (suite, planned(suite)))
        .filter(|(_, cases)| !cases.is_empty())
        .collect())
}

fn plan_case(
    case: &CaseRef<'_>,
    protocol: Protocol,
    device: &Device,
    environment: &Environment,
    bench: &Bench,
) -> PlannedCase {
    let unread = |title: &str, why: Option<String>| PlannedCase {
        id: case.id(),
        title: title.to_owned(),
        written_id: case.written_id(),
        covers: Vec::new(),
        skipped: why,
    };
    if let Some(absent) = case.absent() {
        return unread(case.title_as_written(), Some(absent.to_owned()));
    }
    let lowered = match case.lower(environment) {
        Ok(lowered) => lowered,
        Err(diagnostics) => {
            let first = diagnostics.into_iter().next();
            return unread("", first.map(|first| first.message));
        }
    };
    let skipped = skip_reason(
        &lowered,
        protocol,
        &device.description_of_unit(),
        device.dictionary.as_ref(),
        bench,
    );
    PlannedCase {
        id: lowered.id,
        title: lowered.title,
        written_id: lowered.written_id,
        covers: lowered.covers,
        skipped,
    }
}
