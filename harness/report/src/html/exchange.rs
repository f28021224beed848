//! What happened in one case, in the order of time.

use std::collections::VecDeque;

use fieldproof_record::{CaseFinished, CaseStarted, Direction, Event, Verdict};
use serde::Serialize;
use serde_json::{Value, json};

use super::failures::failure_markup;
use crate::capture::{notation, spaced};
use crate::case_text::cite;

/// So many lines of an exchange are shown from its beginning, and from its end; what is between is in the capture.
const FIRST: usize = 90;
const LAST: usize = 50;
/// And so many of what puts the device back.
const PUTTING_BACK: usize = 6;

/// Everything about a case but what the list shows. The names are short, for there are many of it.
#[derive(Debug, Serialize)]
pub(super) struct Detail {
    /// Sources it follows.
    #[serde(rename = "c", skip_serializing_if = "Vec::is_empty")]
    cites: Vec<String>,
    /// Sources it decides against, and why.
    #[serde(rename = "a", skip_serializing_if = "Vec::is_empty")]
    against: Vec<String>,
    #[serde(rename = "b", skip_serializing_if = "Option::is_none")]
    because: Option<String>,
    #[serde(rename = "x", skip_serializing_if = "Vec::is_empty")]
    examples: Vec<String>,
    #[serde(rename = "e", skip_serializing_if = "Vec::is_empty")]
    effects: Vec<String>,
    /// File and line.
    #[serde(rename = "p")]
    place: String,
    /// Line, whether of the control, text.
    #[serde(rename = "s", skip_serializing_if = "Vec::is_empty")]
    steps: Vec<(u32, u8, String)>,
    /// What kept it from passing, as markup.
    #[serde(rename = "f", skip_serializing_if = "String::is_empty")]
    failures: String,
    /// Nanoseconds since the line before, what kind of line, and what belongs to that.
    #[serde(rename = "t", skip_serializing_if = "Vec::is_empty")]
    lines: Vec<Value>,
}

struct Line {
    at_ns: u64,
    /// Only frames can be what a failure rests on.
    is_frame: bool,
    /// Kind and what belongs to it.
    cells: Vec<Value>,
}

/// The kinds of lines, as the script knows them.
mod kind {
    pub(super) const FRAME: u8 = 0;
    pub(super) const STEP: u8 = 1;
    pub(super) const MEASUREMENT: u8 = 2;
    pub(super) const OBSERVATION: u8 = 3;
    pub(super) const NOTE: u8 = 4;
    pub(super) const STIMULUS: u8 = 5;
    pub(super) const BUS_ERROR: u8 = 6;
    pub(super) const PUTTING_BACK: u8 = 7;
    pub(super) const LEFT_OUT: u8 = 8;
}

/// Collects what happens in a case.
pub(super) struct Exchange {
    pub(super) started: Box<CaseStarted>,
    first: Vec<Line>,
    last: VecDeque<Line>,
    left_out: u64,
    putting_back: bool,
    back: Vec<Line>,
    back_left_out: u64,
}

impl Exchange {
    pub(super) fn new(started: &CaseStarted) -> Exchange {
        Exchange {
            started: Box::new(started.clone()),
            first: Vec::new(),
            last: VecDeque::new(),
            left_out: 0,
            putting_back: false,
            back: Vec::new(),
            back_left_out: 0,
        }
    }

    /// One more event of the case; `ports` are the names of the lane's ports.
    pub(super) fn event(&mut self, event: &Event, ports: &[String]) {
        let port = |index: u8| -> &str {
            let name = ports.get(usize::from(index));
            name.map_or("?", String::as_str)
        };
        let (at_ns, cells) = match event {
            Event::Frame(frame) => (
                frame.at_ns,
                vec![
                    json!(kind::FRAME),
                    json!(port(frame.port)),
                    json!(direction(frame.direction)),
                    json!(notation(frame)),
                    json!(frame.decoded),
                ],
            ),
            Event::Serial(serial) => (
                serial.at_ns,
                vec![
                    json!(kind::FRAME),
                    json!(port(serial.port)),
                    json!(direction(serial.direction)),
                    json!(spaced(&serial.bytes)),
                    json!(serial.decoded),
                ],
            ),
            Event::StepStarted(step) => (step.at_ns, vec![json!(kind::STEP), json!(step.step)]),
            Event::Measurement(it) => (
                it.at_ns,
                vec![
                    json!(kind::MEASUREMENT),
                    json!(it.name),
                    json!(it.value_ns),
                    json!(it.uncertainty_ns),
                    json!(it.limits.min_ns),
                    json!(it.limits.max_ns),
                    json!(place_of(it.verdict)),
                ],
            ),
            Event::Observation(it) => (
                it.at_ns,
                vec![json!(kind::OBSERVATION), json!(it.name), json!(it.value)],
            ),
            Event::Note(it) => (it.at_ns, vec![json!(kind::NOTE), json!(it.text)]),
            Event::Stimulus(it) => (it.at_ns, vec![json!(kind::STIMULUS), json!(it.what)]),
            Event::BusError(it) => (it.at_ns, vec![json!(kind::BUS_ERROR), json!(it.what)]),
            Event::PuttingBack(it) => {
                self.putting_back = true;
                (it.at_ns, vec![json!(kind::PUTTING_BACK)])
            }
            _ => return,
        };
        let is_frame = matches!(event, Event::Frame(_) | Event::Serial(_));
        self.push(Line {
            at_ns,
            is_frame,
            cells,
        });
    }

    fn push(&mut self, line: Line) {
        if self.putting_back {
            match self.back.len() > PUTTING_BACK {
                true => self.back_left_out += u64::from(line.is_frame),
                false => self.back.push(line),
            }
            return;
        }
        if self.first.len() < FIRST {
            return self.first.push(line);
        }
        self.last.push_back(line);
        if self.last.len() > LAST {
            let left_out = self.last.pop_front();
            self.left_out += u64::from(left_out.is_some_and(|line| line.is_frame));
        }
    }

    /// The case is over.
    pub(super) fn finish(self, finished: &CaseFinished) -> Detail {
        let started = self.started;
        let marked: Vec<u64> = finished
            .excerpt
            .iter()
            .filter(|line| line.marked)
            .map(|line| line.at_ns)
            .collect();
        let mut lines = Vec::new();
        let mut before = started.at_ns;
        let mut write = |line: Line| {
            let mut cells = line.cells;
            if line.is_frame && marked.contains(&line.at_ns) {
                cells.push(json!(1));
            }
            cells.insert(0, json!(line.at_ns as i64 - before as i64));
            before = line.at_ns;
            lines.push(Value::Array(cells));
        };
        let left_out = |at_ns: u64, count: u64| Line {
            at_ns,
            is_frame: false,
            cells: vec![json!(kind::LEFT_OUT), json!(count)],
        };
        let last_at = self.first.last().map_or(started.at_ns, |line| line.at_ns);
        self.first.into_iter().for_each(&mut write);
        if self.left_out > 0 {
            write(left_out(last_at, self.left_out));
        }
        self.last.into_iter().for_each(&mut write);
        let back_at = self.back.last().map_or(last_at, |line| line.at_ns);
        // To say that nothing had to be put back would say nothing.
        if self.back.len() > 1 {
            self.back.into_iter().for_each(&mut write);
        }
        if self.back_left_out > 0 {
            write(left_out(back_at, self.back_left_out));
        }
        let failures = match finished.failures.is_empty() {
            true => String::new(),
            false => failure_markup(finished),
        };
        let CaseStarted {
            cites,
            against,
            because,
            examples,
            effects,
            steps,
            place,
            ..
        } = *started;
        Detail {
            cites: cites.iter().map(cite).collect(),
            against: against.iter().map(cite).collect(),
            because,
            examples,
            effects,
            place: format!("{}:{}", place.path, place.line),
            steps: steps
                .into_iter()
                .map(|step| (step.line, u8::from(step.control), step.text))
                .collect(),
            failures,
            lines,
        }
    }
}

const fn direction(direction: Direction) -> u8 {
    match direction {
        Direction::Sent => 0,
        Direction::Received => 1,
        Direction::Companion => 2,
    }
}

/// The place of `verdict` in [`Verdict::ALL`].
pub(super) fn place_of(verdict: Verdict) -> usize {
    Verdict::ALL
        .iter()
        .position(|it| *it == verdict)
        .unwrap_or(0)
}
