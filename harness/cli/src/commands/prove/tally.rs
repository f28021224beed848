//! What the cases of a round came to.

use std::collections::{BTreeMap, BTreeSet};

use fieldproof_record::{Direction, Event, Sink, Verdict, VerdictCounts};

/// What a round came to, by case as written, its rows taken together.
#[derive(Debug, Default)]
pub(super) struct Tally {
    case: String,
    /// Whether the tester has sent something in it.
    sent: bool,
    pub(super) cases: BTreeMap<String, CaseTally>,
    /// The ids of all cases that were tried.
    pub(super) tried: BTreeSet<String>,
    /// Why lanes ended before their last case.
    pub(super) stops: Vec<String>,
    /// Whether it had to be ended, for it took too long.
    pub(super) hung: bool,
}

#[derive(Debug, Default)]
pub(super) struct CaseTally {
    pub(super) counts: VerdictCounts,
    /// What the device was found to do wrong, in one sentence, in the first row in which it was: be it that more happened
    /// afterwards.
    pub(super) wrong: Option<String>,
    /// Whether a row passed in which the tester sent something.
    pub(super) sent_and_passed: bool,
}

impl Sink for Tally {
    fn emit(&mut self, event: Event) {
        match event {
            Event::CaseStarted(case) => {
                self.case = case.written_id;
                self.sent = false;
            }
            Event::Frame(frame) => self.sent |= frame.direction == Direction::Sent,
            Event::Serial(bytes) => self.sent |= bytes.direction == Direction::Sent,
            Event::CaseFinished(case) => {
                let tally = self.cases.entry(self.case.clone()).or_default();
                tally.counts.add(case.verdict);
                tally.sent_and_passed |= self.sent && case.verdict == Verdict::Pass;
                let mut failures = case.failures.into_iter();
                let wrong = failures.find(|failure| failure.verdict == Verdict::Fail);
                tally.wrong = tally.wrong.take().or(wrong.map(|failure| failure.what));
                self.tried.insert(case.id);
            }
            Event::LaneFinished(lane) => self.stops.extend(lane.stopped),
            _ => {}
        }
    }
}

impl Tally {
    /// The cases that had `verdict` in at least one row.
    pub(super) fn with(&self, verdict: Verdict) -> Vec<String> {
        self.those(|tally| tally.counts.of(verdict) > 0)
    }

    pub(super) fn those(&self, belongs: impl Fn(&CaseTally) -> bool) -> Vec<String> {
        let those = self.cases.iter().filter(|(_, tally)| belongs(tally));
        those.map(|(id, _)| id.clone()).collect()
    }
}
