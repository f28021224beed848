//! What a comparison needs of a run.

use std::collections::BTreeMap;

use fieldproof_record::{CaseStarted, Event, Verdict};

/// A case as it came out.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CollectedCase {
    /// One line.
    pub title: String,
    /// Its verdict.
    pub verdict: Verdict,
    /// What was found first, or why it was skipped.
    pub what: String,
}

/// What was measured under one name.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CollectedSeries {
    /// The median of each case, by its id.
    pub medians: BTreeMap<String, u64>,
    /// The largest uncertainty.
    pub uncertainty_ns: u64,
    /// The largest share of its limit that a value took.
    pub of_limit: Option<f64>,
}

/// A device as it came out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CollectedLane {
    /// Its name.
    pub device: String,
    /// The firmware that it named when it was asked.
    pub firmware: Option<String>,
    /// Its cases, by id.
    pub cases: BTreeMap<String, CollectedCase>,
    /// What was measured, by name.
    pub measured: BTreeMap<String, CollectedSeries>,
    /// Whether it came to its end.
    pub complete: bool,
}

/// Takes the events of one lane.
#[derive(Debug, Default)]
pub struct Collector {
    lane: CollectedLane,
    case: Option<Box<CaseStarted>>,
    /// What the case has measured.
    values: BTreeMap<String, Vec<u64>>,
}

impl Collector {
    /// For the lane of `device`.
    pub fn new(device: &str) -> Collector {
        Collector {
            lane: CollectedLane {
                device: device.to_owned(),
                ..CollectedLane::default()
            },
            ..Collector::default()
        }
    }

    /// One more event.
    pub fn event(&mut self, event: &Event) {
        match event {
            Event::Identity(identity) => {
                let part = identity
                    .parts
                    .iter()
                    .find(|part| matches!(part.name.as_str(), "software-version" | "revision"));
                self.lane.firmware = part.and_then(|part| part.read.clone());
            }
            Event::CaseStarted(case) => {
                self.values.clear();
                self.case = Some(case.clone());
            }
            Event::Measurement(it) => {
                let name: &str = &it.name;
                if !self.lane.measured.contains_key(name) {
                    let series = CollectedSeries::default();
                    self.lane.measured.insert(name.to_owned(), series);
                }
                if let Some(series) = self.lane.measured.get_mut(name) {
                    series.uncertainty_ns = series.uncertainty_ns.max(it.uncertainty_ns);
                    if let Some(max) = it.limits.max_ns.filter(|max| *max > 0) {
                        let share = it.value_ns as f64 / max as f64;
                        series.of_limit = Some(series.of_limit.map_or(share, |it| it.max(share)));
                    }
                }
                match self.values.get_mut(name) {
                    Some(values) => values.push(it.value_ns),
                    None => drop(self.values.insert(name.to_owned(), vec![it.value_ns])),
                }
            }
            Event::CaseFinished(finished) => {
                let Some(started) = self.case.take() else {
                    return;
                };
                let first = finished.failures.first().map(|it| it.what.clone());
                let what = first.or_else(|| finished.reason.clone());
                let case = CollectedCase {
                    title: started.title.clone(),
                    verdict: finished.verdict,
                    what: what.unwrap_or_default(),
                };
                self.lane.cases.insert(finished.id.clone(), case);
                // What a failing case measured says little of how fast the device is.
                if finished.verdict == Verdict::Pass {
                    for (name, mut values) in std::mem::take(&mut self.values) {
                        values.sort_unstable();
                        let median = values[values.len() / 2];
                        if let Some(series) = self.lane.measured.get_mut(&name) {
                            series.medians.insert(finished.id.clone(), median);
                        }
                    }
                }
            }
            Event::LaneFinished(end) => self.lane.complete = end.stopped.is_none(),
            _ => {}
        }
    }

    /// The lane.
    pub fn finish(self) -> CollectedLane {
        self.lane
    }
}
