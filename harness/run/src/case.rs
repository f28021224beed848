//! One case: bring the device there, control, steps, judge what nobody expected, put everything back.

use std::time::Duration;

use fieldproof_link::SerialSettings;
use fieldproof_record::{
    Event, ExcerptLine, Failure, Note, Place, PuttingBack, StepStarted, Verdict,
};
use fieldproof_suite::Position;
use fieldproof_suite::device::Instead;
use fieldproof_suite::model::{Case, Located, Step};

use crate::excerpt::excerpt;
use crate::steps::{check_of, is_precondition};
use crate::stop::{Came, Mismatch, Stop};
use crate::tester::{LATE_ANSWER, SERIAL, Tester};
use crate::undo::Undo;

/// How long after the last step an answer too many is waited for.
const SETTLE_TIME: Duration = Duration::from_millis(5);

/// How a case ended.
pub(crate) struct CaseOutcome {
    pub(crate) verdict: Verdict,
    pub(crate) failures: Vec<Failure>,
    pub(crate) excerpt: Vec<ExcerptLine>,
    /// Why the lane cannot go on.
    pub(crate) stops_lane: Option<String>,
}

impl CaseOutcome {
    pub(crate) fn skipped() -> CaseOutcome {
        CaseOutcome {
            verdict: Verdict::Skipped,
            failures: Vec::new(),
            excerpt: Vec::new(),
            stops_lane: None,
        }
    }
}

/// Which part of a case a step belongs to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Control,
    Steps,
}

/// What has gone wrong in a case so far.
#[derive(Default)]
struct Findings {
    failures: Vec<Failure>,
    excerpt: Vec<ExcerptLine>,
    stops_lane: Option<String>,
    link_is_down: bool,
}

impl Findings {
    /// Whether the case goes on after this.
    fn may_go_on(&self) -> bool {
        self.failures
            .iter()
            .all(|failure| failure.verdict == Verdict::Deviation)
    }
}

impl Tester<'_> {
    /// Plays one case. `place` gives a place in the suite file the text of its line.
    pub(crate) fn play_case(
        &mut self,
        case: &Case,
        place: &dyn Fn(Position) -> Place,
    ) -> CaseOutcome {
        self.session.begin_case();
        self.watch.begin_case();
        self.saved.clear();
        self.history.clear();
        self.notes.clear();
        self.restores_by_steps = !case.restore.steps.is_empty();
        self.steps_begun = false;
        self.open_transfer = None;
        let mut findings = Findings::default();

        if let Err(stop) = self.prepare(case) {
            self.find(&mut findings, stop, None, place(case.at), Part::Control);
        }
        self.play_steps(&case.control, Part::Control, 0, &mut findings, place);
        self.play_steps(
            &case.steps,
            Part::Steps,
            case.control.len(),
            &mut findings,
            place,
        );
        if findings.may_go_on()
            && let Err(stop) = self.settle(case)
        {
            self.find(&mut findings, stop, None, place(case.at), Part::Steps);
        }
        if !findings.link_is_down {
            let at_ns = self.session.now().as_nanos();
            self.session.emit(Event::PuttingBack(PuttingBack { at_ns }));
            let put_back = self
                .let_late_answers_pass(&findings)
                .and_then(|()| self.session.disconnect_all())
                .and_then(|()| self.put_back(case))
                .and_then(|()| self.session.settle());
            if let Err(stop) = put_back {
                self.find_not_put_back(&mut findings, stop, place(case.at));
            }
        }
        for text in std::mem::take(&mut self.notes) {
            let at_ns = self.session.now().as_nanos();
            self.session
                .emit(Event::Note(Box::new(Note { at_ns, text })));
        }
        let verdict = findings
            .failures
            .iter()
            .map(|failure| failure.verdict)
            .max();
        CaseOutcome {
            verdict: verdict.unwrap_or(Verdict::Pass),
            failures: findings.failures,
            excerpt: findings.excerpt,
            stops_lane: findings.stops_lane,
        }
    }

    /// Brings the device to the address the case is printed for, and reads what will be put back.
    fn prepare(&mut self, case: &Case) -> Result<(), Stop> {
        if let Some(address) = case.written_for.address
            && self.address != Some(address)
        {
            self.readdress("address", i64::from(address), self.address.map(i64::from))?;
        }
        if let Some(node) = case.written_for.node
            && case.written_for.fixed
            && self.node.map(|present| present.raw()) != Some(node)
        {
            self.readdress(
                "node",
                i64::from(node),
                self.node.map(|present| i64::from(present.raw())),
            )?;
        }
        self.snapshot(case)
    }

    fn readdress(&mut self, setting: &str, to: i64, from: Option<i64>) -> Result<(), Stop> {
        if let Some(from) = from {
            self.undo.push(Undo::Setting(setting.to_owned(), from));
        }
        self.set(setting, to)
    }

    fn play_steps(
        &mut self,
        steps: &[Located<Step>],
        part: Part,
        first: usize,
        findings: &mut Findings,
        place: &dyn Fn(Position) -> Place,
    ) {
        for (number, step) in steps.iter().enumerate() {
            if !findings.may_go_on() {
                return;
            }
            let number = first + number;
            match &step.value {
                // Played from here, so that a failure points at the step inside.
                Step::Repeat(repeat) => {
                    for time in 0..repeat.times {
                        if !findings.may_go_on() {
                            return;
                        }
                        self.count(repeat, time);
                        self.play_steps(&repeat.steps, part, number, findings, place);
                    }
                }
                _ => self.play_step(step, part, number, findings, place),
            }
        }
    }

    fn play_step(
        &mut self,
        step: &Located<Step>,
        part: Part,
        number: usize,
        findings: &mut Findings,
        place: &dyn Fn(Position) -> Place,
    ) {
        self.steps_begun |= part == Part::Steps;
        let at_ns = self.session.now().as_nanos();
        self.session.emit(Event::StepStarted(StepStarted {
            step: number as u32,
            line: step.at.line,
            at_ns,
        }));
        // What a step sent has left before the next one begins, so that the record says whose it is.
        let played = self.step(&step.value).and_then(|()| self.session.settle());
        if let Err(stop) = played {
            let part = if is_precondition(&step.value) {
                Part::Control
            } else {
                part
            };
            self.find(findings, stop, check_of(&step.value), place(step.at), part);
        }
    }

    /// Waits for answers too many, and judges what nothing expected.
    fn settle(&mut self, case: &Case) -> Result<(), Stop> {
        let silence = self
            .session
            .port(SERIAL)
            .and_then(|port| self.session.serial_settings(port))
            .map_or(Duration::ZERO, SerialSettings::silence_3_5);
        let until = self.session.now() + SETTLE_TIME + silence * 2;
        self.session.collect_until(until)?;
        self.judge_unexpected(&case.forbids)
    }

    /// After a case that ended early an answer may still be on its way: it must not be taken for another's.
    fn let_late_answers_pass(&mut self, findings: &Findings) -> Result<(), Stop> {
        if findings.may_go_on() {
            return Ok(());
        }
        let timing = &self.device.timing;
        let longest = timing
            .sdo_response
            .max(timing.modbus_response)
            .min(LATE_ANSWER);
        let until = self.session.now() + longest;
        self.session.uninterruptible = true;
        self.watch.forget_state();
        self.session.collect_until(until)?;
        self.abort_open_transfer()
    }

    /// Writes down why a step did not pass.
    fn find(
        &mut self,
        findings: &mut Findings,
        stop: Stop,
        check: Option<&str>,
        place: Place,
        part: Part,
    ) {
        let (verdict, mismatch) = match stop {
            Stop::Mismatch(mismatch) => {
                let (verdict, note) = match self.documented(check, &mismatch) {
                    Some(words) => (Verdict::Deviation, Some(words)),
                    None if part == Part::Control => (
                        Verdict::Inconclusive,
                        Some("this is the control: without it nothing is judged".into()),
                    ),
                    None => (Verdict::Fail, None),
                };
                let mut mismatch = self.with_history(*mismatch);
                mismatch.notes.extend(note);
                (verdict, mismatch)
            }
            Stop::Undecided(mismatch) => (Verdict::Inconclusive, self.with_history(*mismatch)),
            Stop::NotSaved(name) => (
                Verdict::Error,
                Mismatch {
                    what: format!("no step saved {name:?}"),
                    ..Mismatch::default()
                },
            ),
            Stop::Bench(what) => (
                Verdict::Error,
                Mismatch {
                    what,
                    ..Mismatch::default()
                },
            ),
            Stop::Link(error) => {
                findings.link_is_down = true;
                findings.stops_lane = Some(error.to_string());
                (
                    Verdict::Error,
                    Mismatch {
                        what: format!("the link failed: {error}"),
                        ..Mismatch::default()
                    },
                )
            }
            Stop::Interrupted => {
                findings.stops_lane = Some("interrupted".into());
                let what = "the run was interrupted".into();
                (
                    Verdict::Inconclusive,
                    Mismatch {
                        what,
                        ..Mismatch::default()
                    },
                )
            }
        };
        findings
            .failures
            .push(self.failure(verdict, mismatch, place));
        findings.excerpt = excerpt(&self.session, self.dictionary);
    }

    /// Says after what the device did not do as it should.
    fn with_history(&self, mismatch: Mismatch) -> Mismatch {
        Mismatch {
            what: self.history.tell(&mismatch.what),
            ..mismatch
        }
    }

    fn find_not_put_back(&mut self, findings: &mut Findings, stop: Stop, place: Place) {
        let mismatch = match stop {
            Stop::Mismatch(mismatch) | Stop::Undecided(mismatch) => *mismatch,
            Stop::NotSaved(name) => Mismatch {
                what: format!("no step saved {name:?}"),
                ..Mismatch::default()
            },
            Stop::Bench(what) => Mismatch {
                what,
                ..Mismatch::default()
            },
            Stop::Link(error) => Mismatch {
                what: error.to_string(),
                ..Mismatch::default()
            },
            Stop::Interrupted => Mismatch {
                what: "interrupted".into(),
                ..Mismatch::default()
            },
        };
        let what = format!("the device could not be put back: {}", mismatch.what);
        findings.stops_lane.get_or_insert_with(|| what.clone());
        let failure = self.failure(Verdict::Error, Mismatch { what, ..mismatch }, place);
        findings.failures.push(failure);
        if findings.excerpt.is_empty() {
            findings.excerpt = excerpt(&self.session, self.dictionary);
        }
    }

    fn failure(&self, verdict: Verdict, mismatch: Mismatch, place: Place) -> Failure {
        Failure {
            verdict,
            place,
            at_ns: self.session.now().as_nanos(),
            what: mismatch.what,
            expected: mismatch.expected,
            actual: mismatch.actual,
            notes: mismatch.notes,
        }
    }

    /// Whether the device's documents say that it departs from this check in just this way; gives the words.
    fn documented(&self, check: Option<&str>, mismatch: &Mismatch) -> Option<String> {
        let check = check?;
        let deviation = self
            .device
            .deviates
            .iter()
            .find(|d| d.check == check && is_instead(&d.instead, &mismatch.came))?;
        let cites: Vec<String> = deviation
            .cite
            .iter()
            .map(|cite| match &cite.section {
                Some(section) => format!("{}, {section}", cite.document),
                None => cite.document.clone(),
            })
            .collect();
        Some(format!("documented for {check}: {}", cites.join("; ")))
    }
}

/// Whether what came is what the description says comes instead.
fn is_instead(instead: &Instead, came: &Came) -> bool {
    match (instead, came) {
        (Instead::Exception(code), Came::Exception(came)) => code == came,
        (Instead::Abort(code), Came::Abort(came)) => code == came,
        (Instead::Frame(pattern), Came::Frame(frame)) => pattern.with_id(frame.id()).matches(frame),
        (Instead::Value(value), Came::Value(came)) => value == came,
        (Instead::Silence, Came::Silence) => true,
        (Instead::Answer, Came::Answer | Came::Frame(_) | Came::Value(_)) => true,
        _ => false,
    }
}
