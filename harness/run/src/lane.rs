//! One lane: all cases that apply to one device, in order.

use std::sync::atomic::{AtomicBool, Ordering};

use fieldproof_dictionary::Dictionary;
use fieldproof_link::{Lane, State};
use fieldproof_record::{
    CaseFinished, Event, LaneFinished, Place, Sink, SuiteFinished, SuiteStarted, Verdict,
    VerdictCounts,
};
use fieldproof_suite::device::DeviceDescription;
use fieldproof_suite::model::Case;
use fieldproof_suite::{CaseRef, Diagnostic, Environment, Position, Suite};
use fieldproof_wire::canopen::NodeId;

use crate::applies::{Bench, skip_reason};
use crate::case::CaseOutcome;
use crate::entries;
use crate::found::Found;
use crate::history::History;
use crate::node::NodeWatch;
use crate::relocate::relocate;
use crate::session::Session;
use crate::steps::main_role;
use crate::tester::Tester;
use crate::undo::UndoStack;
use crate::value::Saved;
use crate::words::Explaining;

/// Everything about a lane that does not change while it is played.
pub struct LaneJob<'a> {
    /// The tool and its version.
    pub tool: &'a str,
    /// The lane's name: the device's name on the bench.
    pub name: &'a str,
    /// The device's claim.
    pub device: &'a DeviceDescription,
    /// Its object dictionary, if it is a CANopen device.
    pub dictionary: Option<&'a Dictionary>,
    /// What the bench has and permits.
    pub bench: &'a Bench,
    /// All suites, filled from the dictionary ([`crate::fill`]); those for other devices are left out.
    pub suites: &'a [Suite],
    /// Which cases are played, by id.
    pub selects: &'a (dyn Fn(&str) -> bool + Sync),
    /// Only the strict abort codes pass.
    pub strict: bool,
    /// Whether the device is opened after each case to see that it is as it was found, where a lane can do that
    /// ([`Lane::device_state`]).
    pub inspects_device: bool,
    /// Whether the record is to stand for itself: who the device says it is, the steps of each case, frames in words.
    pub explains: bool,
    /// The fault switched on in a reference device, for the record.
    pub fault: Option<&'a str>,
    /// The legal variant that a reference device is, for the record.
    pub variant: Option<&'a str>,
    /// The seed of the run, for the record.
    pub seed: u64,
}

/// How a lane ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LaneOutcome {
    /// The verdicts.
    pub counts: VerdictCounts,
    /// Why it ended before its last case.
    pub stopped: Option<String>,
}

/// The suites that a device is tested with: those for any device and those for it.
pub fn suites_for<'s>(
    suites: &'s [Suite],
    device: &'s DeviceDescription,
) -> impl Iterator<Item = &'s Suite> {
    suites.iter().filter(|suite| {
        suite
            .head
            .device
            .as_ref()
            .is_none_or(|name| *name == device.device)
    })
}

/// Plays every selected case on `lane`, in the order of the files, and tells `sink` what happens. Stops early when
/// `stop` is set, when the link fails, or when the device cannot be put back; it is put back even then.
pub fn play_lane(
    job: &LaneJob<'_>,
    lane: &mut dyn Lane,
    sink: &mut dyn Sink,
    stop: &AtomicBool,
) -> LaneOutcome {
    sink.emit(Event::LaneStarted(Box::new(entries::lane_started(
        job, lane,
    ))));
    let mut explaining;
    let sink: &mut dyn Sink = match job.explains {
        true => {
            explaining = Explaining::new(sink, job.dictionary, lane);
            &mut explaining
        }
        false => sink,
    };
    let mut player = Player::new(job, lane, sink, stop);
    player.found = player.tester.find_device();
    if job.explains {
        player.tester.read_identity();
    }
    for suite in suites_for(job.suites, job.device) {
        if player.outcome.stopped.is_some() {
            break;
        }
        player.play_suite(suite);
    }
    if let Some(found) = &player.found {
        player.tester.leave_device(found);
    }
    let outcome = player.outcome;
    let at_ns = player.tester.session.now().as_nanos();
    let finished = LaneFinished {
        at_ns,
        counts: outcome.counts,
        stopped: outcome.stopped.clone(),
    };
    player
        .tester
        .session
        .emit(Event::LaneFinished(Box::new(finished)));
    outcome
}

struct Player<'a> {
    job: &'a LaneJob<'a>,
    stop: &'a AtomicBool,
    tester: Tester<'a>,
    environment: Environment,
    /// How the node was found.
    found: Option<Found>,
    outcome: LaneOutcome,
    /// What the last look into the device showed.
    last_state: Option<State>,
}

impl<'a> Player<'a> {
    fn new(
        job: &'a LaneJob<'a>,
        lane: &'a mut dyn Lane,
        sink: &'a mut dyn Sink,
        stop: &'a AtomicBool,
    ) -> Player<'a> {
        let heartbeat_by_default = job
            .dictionary
            .and_then(|dictionary| dictionary.entry(0x1017, 0)?.default_bytes(0))
            .is_some_and(|bytes| bytes.iter().any(|byte| *byte != 0));
        let tester = Tester {
            session: Session::new(lane, sink, stop),
            device: job.device,
            dictionary: job.dictionary,
            node: job.bench.node.and_then(NodeId::new),
            address: job.bench.address,
            main_role: crate::tester::CAN,
            sync_producer: None,
            sync_period: None,
            restores_by_steps: false,
            steps_begun: false,
            history: History::default(),
            sdo_request: None,
            open_transfer: None,
            strict: job.strict,
            watch: NodeWatch::new(heartbeat_by_default),
            saved: Saved::new(),
            undo: UndoStack::default(),
            notes: Vec::new(),
        };
        Player {
            job,
            stop,
            tester,
            // A case that names the node of a device that has none is skipped for want of a port, not refused.
            environment: Environment {
                node: job.bench.node.or(Some(1)),
                address: job.bench.address.or(Some(1)),
                identity: job.device.identity.numbers(),
            },
            found: None,
            last_state: None,
            outcome: LaneOutcome {
                counts: VerdictCounts::default(),
                stopped: None,
            },
        }
    }

    fn play_suite(&mut self, suite: &Suite) {
        let mut counts = VerdictCounts::default();
        let mut begun = false;
        self.tester.main_role = main_role(suite.head.protocol);
        for case in suite.cases() {
            if self.outcome.stopped.is_some() {
                break;
            }
            if self.stop.load(Ordering::Relaxed) {
                self.outcome.stopped = Some("interrupted".into());
                break;
            }
            if !(self.job.selects)(&case.id()) {
                continue;
            }
            if !begun {
                begun = true;
                self.tester
                    .session
                    .emit(Event::SuiteStarted(Box::new(SuiteStarted {
                        suite: suite.head.suite.clone(),
                        title: suite.head.title.clone(),
                        path: suite.path.clone(),
                    })));
            }
            counts.add(self.play(suite, &case));
        }
        self.outcome.counts.merge(counts);
        if begun {
            let at_ns = self.tester.session.now().as_nanos();
            let suite = suite.head.suite.clone();
            self.tester
                .session
                .emit(Event::SuiteFinished(SuiteFinished {
                    suite,
                    at_ns,
                    counts,
                }));
        }
    }

    fn play(&mut self, suite: &Suite, case: &CaseRef<'_>) -> Verdict {
        let place = |at: Position| Place {
            path: suite.path.clone(),
            line: at.line,
            column: at.column,
            end_column: at.end_column,
            text: suite.line_text(at.line).to_owned(),
        };
        if let Some(absent) = case.absent() {
            return self.pass_over(case, place(case.at()), absent);
        }
        let written = case;
        let mut case = match written.lower(&self.environment) {
            Ok(case) => case,
            Err(diagnostics) => return self.refuse(written, place(case.at()), &diagnostics),
        };
        if let Some(node) = self.tester.node {
            relocate(&mut case, node);
        }
        let started_ns = self.tester.session.now().as_nanos();
        let skipped = skip_reason(
            &case,
            suite.head.protocol,
            self.job.device,
            self.job.dictionary,
            self.job.bench,
        )
        .or_else(|| self.found.as_ref()?.skip_reason(&case));
        let steps = match self.job.explains && skipped.is_none() {
            true => entries::written_steps(written, &self.environment, &case),
            false => Vec::new(),
        };
        let started = entries::case_started(&case, started_ns, place(case.at), steps);
        self.tester
            .session
            .emit(Event::CaseStarted(Box::new(started)));
        let outcome = match &skipped {
            Some(_) => CaseOutcome::skipped(),
            None => self.play_and_inspect(&case, &place),
        };
        let at_ns = self.tester.session.now().as_nanos();
        self.tester
            .session
            .emit(Event::CaseFinished(Box::new(CaseFinished {
                id: case.id,
                at_ns,
                duration_ns: at_ns - started_ns,
                verdict: outcome.verdict,
                reason: skipped,
                failures: outcome.failures,
                excerpt: outcome.excerpt,
            })));
        self.outcome.stopped = outcome.stops_lane;
        outcome.verdict
    }

    /// Plays a case, and looks into the device before and after where the lane can.
    fn play_and_inspect(&mut self, case: &Case, place: &dyn Fn(Position) -> Place) -> CaseOutcome {
        if !self.job.inspects_device {
            return self.tester.play_case(case, place);
        }
        let before = match self.last_state.take() {
            Some(state) => state,
            None => self.tester.session.lane().device_state(),
        };
        let mut outcome = self.tester.play_case(case, place);
        let after = self.tester.session.lane().device_state();
        let differences = before.differences(&after);
        if !differences.is_empty() && outcome.stops_lane.is_none() {
            outcome.verdict = outcome.verdict.max(Verdict::Error);
            let at_ns = self.tester.session.now().as_nanos();
            outcome
                .failures
                .push(entries::left_changed(&differences, at_ns, place(case.at)));
        }
        self.last_state = Some(after);
        outcome
    }

    /// There is nothing in this device that the case could be played with.
    fn pass_over(&mut self, case: &CaseRef<'_>, place: Place, absent: &str) -> Verdict {
        let at_ns = self.tester.session.now().as_nanos();
        let (started, finished) = entries::passed_over(case, place, absent, at_ns);
        self.tester
            .session
            .emit(Event::CaseStarted(Box::new(started)));
        self.tester
            .session
            .emit(Event::CaseFinished(Box::new(finished)));
        Verdict::Skipped
    }

    /// The loader has read the case before: only the bench's node or address can have made the difference.
    fn refuse(&mut self, case: &CaseRef<'_>, place: Place, diagnostics: &[Diagnostic]) -> Verdict {
        let at_ns = self.tester.session.now().as_nanos();
        let words: Vec<&str> = diagnostics.iter().map(|d| d.message.as_str()).collect();
        let (started, finished) = entries::refused(case, place, &words.join("; "), at_ns);
        self.tester
            .session
            .emit(Event::CaseStarted(Box::new(started)));
        self.tester
            .session
            .emit(Event::CaseFinished(Box::new(finished)));
        Verdict::Error
    }
}
