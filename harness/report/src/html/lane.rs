//! What the head of the report says of one lane.

use fieldproof_record::{Event, IdentityPart, LaneStarted, Verdict};

use super::bus_load::BusLoad;
use super::coverage::Coverage;
use super::exchange::{Exchange, place_of};
use super::failures::block;
use super::pack::{Finished, Listed};
use super::series::Measured;
use crate::summary::LaneSummary;

/// So many cases that did not pass are shown in full; the others are in the list.
const SHOWN_FINDINGS: usize = 200;

/// A lane as its events made it.
pub(super) struct Lane {
    /// Its place in the run.
    pub(super) number: usize,
    pub(super) started: Option<Box<LaneStarted>>,
    pub(super) identity: Vec<IdentityPart>,
    pub(super) summary: LaneSummary,
    pub(super) coverage: Coverage,
    pub(super) measured: Measured,
    pub(super) bus_load: Vec<(String, BusLoad)>,
    /// The cases that did not simply pass, in full.
    pub(super) findings: Vec<(Verdict, String)>,
    pub(super) findings_left_out: u64,
    suite: String,
    ports: Vec<String>,
    exchange: Option<Exchange>,
}

impl Lane {
    pub(super) fn new(device: &str, number: usize) -> Lane {
        Lane {
            number,
            started: None,
            identity: Vec::new(),
            summary: LaneSummary {
                device: device.to_owned(),
                ..LaneSummary::default()
            },
            coverage: Coverage::default(),
            measured: Measured::default(),
            bus_load: Vec::new(),
            findings: Vec::new(),
            findings_left_out: 0,
            suite: String::new(),
            ports: Vec::new(),
            exchange: None,
        }
    }

    /// One more event; `number` is that of the next case of the report. Gives back a case that is over.
    pub(super) fn event(&mut self, event: &Event, number: u64) -> Option<Finished> {
        self.summary.event(event);
        match event {
            Event::LaneStarted(started) => {
                self.ports = started.ports.iter().map(|it| it.name.clone()).collect();
                let loads = started.ports.iter().filter_map(|port| {
                    let load = BusLoad::new(&port.line)?;
                    Some((port.name.clone(), load))
                });
                self.bus_load = loads.collect();
                self.started = Some(started.clone());
            }
            Event::Identity(identity) => self.identity.clone_from(&identity.parts),
            Event::SuiteStarted(suite) => self.suite.clone_from(&suite.suite),
            Event::CaseStarted(case) => self.exchange = Some(Exchange::new(case)),
            Event::CaseFinished(finished) => {
                let exchange = self.exchange.take()?;
                let started = exchange.started.clone();
                self.coverage.case(&started, finished);
                if !matches!(finished.verdict, Verdict::Pass | Verdict::Skipped) {
                    match self.findings.len() < SHOWN_FINDINGS {
                        true => {
                            let block = block(number, &started, finished);
                            self.findings.push((finished.verdict, block));
                        }
                        false => self.findings_left_out += 1,
                    }
                }
                return Some(Finished {
                    listed: Listed {
                        name: name_in_suite(&started.id, &self.suite).to_owned(),
                        title: started.title.clone(),
                        verdict: place_of(finished.verdict),
                        duration_us: finished.duration_ns / 1_000,
                        reason: finished.reason.clone().unwrap_or_default(),
                    },
                    detail: exchange.finish(finished),
                });
            }
            _ => {}
        }
        if let Event::Measurement(measurement) = event {
            let case = self.exchange.as_ref();
            let case = case.map_or("", |exchange| exchange.started.id.as_str());
            self.measured.measurement(measurement, case);
        }
        if let Event::Frame(frame) = event {
            let port = self.ports.get(usize::from(frame.port));
            let load = self
                .bus_load
                .iter_mut()
                .find(|(name, _)| Some(name) == port);
            if let Some((_, load)) = load {
                load.frame(frame);
            }
        }
        if let Some(exchange) = &mut self.exchange {
            exchange.event(event, &self.ports);
        }
        None
    }
}

/// What follows the suite's name and the slash.
fn name_in_suite<'a>(id: &'a str, suite: &str) -> &'a str {
    let rest = id.strip_prefix(suite);
    rest.and_then(|rest| rest.strip_prefix('/')).unwrap_or(id)
}
