//! The lines that people read while a run goes on.

use std::fmt::Write;

use fieldproof_record::{CaseFinished, CaseStarted, Event, Verdict};

use crate::case_text::case_text;
use crate::ink::Ink;
use crate::summary::{LaneSummary, SuiteSummary, short_seconds};

/// What is shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ConsoleOptions {
    /// Every case with its verdict and time, and deviations in full.
    pub verbose: bool,
    /// Only what did not pass.
    pub quiet: bool,
    /// Deviations are failures.
    pub strict: bool,
    /// Colours or none.
    pub ink: Ink,
}

/// Turns the events of several lanes into text in a fixed order: the first lane that is not finished is shown as it
/// goes, and the others are kept until it is.
#[derive(Debug)]
pub struct Console {
    options: ConsoleOptions,
    name_width: usize,
    lanes: Vec<Lane>,
    /// The first lane that is not finished.
    front: usize,
}

#[derive(Debug, Default)]
struct Lane {
    kept: String,
    finished: bool,
    case: Option<Box<CaseStarted>>,
    /// Whether the last thing shown was a case in full, which wants a blank line after it.
    after_case: bool,
    summary: LaneSummary,
}

impl Console {
    /// For lanes with these devices.
    pub fn new(devices: &[&str], options: ConsoleOptions) -> Console {
        let lane = |device: &&str| Lane {
            summary: LaneSummary {
                device: (*device).to_owned(),
                ..LaneSummary::default()
            },
            ..Lane::default()
        };
        Console {
            options,
            name_width: devices
                .iter()
                .map(|name| name.chars().count())
                .max()
                .unwrap_or(0),
            lanes: devices.iter().map(lane).collect(),
            front: 0,
        }
    }

    /// Whether `event` matters here; frames, the most frequent, do not.
    pub fn wants(event: &Event) -> bool {
        matches!(
            event,
            Event::LaneStarted(_)
                | Event::SuiteStarted(_)
                | Event::CaseStarted(_)
                | Event::CaseFinished(_)
                | Event::SuiteFinished(_)
                | Event::LaneFinished(_)
        )
    }

    /// One more event of the lane `lane`, and the text to be shown now. A lane that does not exist shows nothing.
    pub fn event(&mut self, lane: usize, event: &Event) -> String {
        let (options, name_width) = (self.options, self.name_width);
        let Some(state) = self.lanes.get_mut(lane) else {
            return String::new();
        };
        state.event(event, options, name_width);
        if lane == self.front {
            return self.release();
        }
        String::new()
    }

    /// The lane `lane` will give no more events, finished or not. The text to be shown now.
    pub fn end(&mut self, lane: usize) -> String {
        if let Some(state) = self.lanes.get_mut(lane) {
            state.finished = true;
        }
        self.release()
    }

    /// What the lanes came to.
    pub fn summaries(&self) -> Vec<LaneSummary> {
        self.lanes.iter().map(|lane| lane.summary.clone()).collect()
    }

    fn release(&mut self) -> String {
        let mut text = String::new();
        while let Some(lane) = self.lanes.get_mut(self.front) {
            text.push_str(&std::mem::take(&mut lane.kept));
            if !lane.finished {
                break;
            }
            self.front += 1;
        }
        text
    }
}

impl Lane {
    fn event(&mut self, event: &Event, options: ConsoleOptions, name_width: usize) {
        self.summary.event(event);
        match event {
            Event::LaneStarted(lane) if !options.quiet => {
                if let Some(fault) = &lane.fault {
                    say(
                        &mut self.kept,
                        format_args!("{} has the fault {fault}\n", lane.device),
                    );
                }
            }
            Event::CaseStarted(case) => self.case = Some(case.clone()),
            Event::CaseFinished(finished) => {
                if let Some(started) = self.case.take() {
                    self.case(&started, finished, options);
                }
            }
            Event::SuiteFinished(_) if !options.quiet => {
                if let Some(suite) = self.summary.suites.last() {
                    if std::mem::take(&mut self.after_case) {
                        self.kept.push('\n');
                    }
                    let line = suite_line(&self.summary.device, name_width, suite, options.ink);
                    self.kept.push_str(&line);
                }
            }
            _ => {}
        }
    }

    fn case(&mut self, started: &CaseStarted, finished: &CaseFinished, options: ConsoleOptions) {
        let in_full = match finished.verdict {
            Verdict::Pass | Verdict::Skipped => false,
            Verdict::Deviation => options.verbose || options.strict,
            Verdict::Inconclusive | Verdict::Fail | Verdict::Error => true,
        };
        let verdict = finished.verdict;
        if in_full {
            let heading = format!(
                "{} {} {}",
                verdict.name().to_uppercase(),
                self.summary.device,
                started.id
            );
            say(
                &mut self.kept,
                format_args!("\n{}\n", options.ink.verdict(verdict, heading)),
            );
            self.kept
                .push_str(&case_text(started, finished, options.ink));
            self.after_case = true;
        } else if options.verbose {
            if std::mem::take(&mut self.after_case) {
                self.kept.push('\n');
            }
            let word = options
                .ink
                .verdict(verdict, format_args!("{:<12}", verdict.name()));
            let time = short_seconds(finished.duration_ns);
            say(
                &mut self.kept,
                format_args!("  {word} {time:>12}  {}", started.id),
            );
            if let Some(reason) = &finished.reason {
                say(&mut self.kept, format_args!("  ({reason})"));
            }
            self.kept.push('\n');
        }
    }
}

fn suite_line(device: &str, name_width: usize, suite: &SuiteSummary, ink: Ink) -> String {
    let counts = suite.counts;
    let time = short_seconds(suite.lane_time_ns);
    let mut line = format!(
        "{device:<name_width$}  {:<36} {:>5} {:<5} {time:>13}",
        suite.suite,
        counts.total(),
        if counts.total() == 1 { "case" } else { "cases" },
    );
    let mut before = "  ";
    for verdict in Verdict::ALL {
        if counts.of(verdict) > 0 {
            let words = ink.verdict(verdict, format_args!("{:>5} {verdict}", counts.of(verdict)));
            say(&mut line, format_args!("{before}{words}"));
            before = ",";
        }
    }
    line.push('\n');
    line
}

fn say(text: &mut String, words: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = text.write_fmt(words);
}
