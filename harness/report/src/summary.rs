//! What a run came to: as data, and as the table at the end.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::time::Duration;

use fieldproof_record::{CaseFinished, Event, Verdict, VerdictCounts};
use serde::Serialize;

use crate::ink::Ink;

/// What one lane came to.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize)]
pub struct LaneSummary {
    /// The device's name.
    pub device: String,
    /// The fault that was switched on.
    pub fault: Option<String>,
    /// Its suites in the order they were played.
    pub suites: Vec<SuiteSummary>,
    /// All its cases.
    pub counts: VerdictCounts,
    /// How long it took on the lane's own clock.
    pub lane_time_ns: u64,
    /// Why cases were skipped, and how many.
    pub skipped: BTreeMap<String, u32>,
    /// The cases that did not simply pass, skipped ones left out.
    pub listed: Vec<ListedCase>,
    /// Why it ended before its last case.
    pub stopped: Option<String>,
    /// Whether the lane came to its end.
    pub complete: bool,
}

/// What one suite came to on one lane.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct SuiteSummary {
    /// Its id.
    pub suite: String,
    /// Its cases.
    pub counts: VerdictCounts,
    /// The time of its cases on the lane's clock.
    pub lane_time_ns: u64,
}

/// A case that did not simply pass.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ListedCase {
    /// Its id.
    pub id: String,
    /// Its verdict.
    pub verdict: Verdict,
    /// What was found first, in one sentence.
    pub what: String,
}

impl LaneSummary {
    /// One more event of the lane.
    pub fn event(&mut self, event: &Event) {
        match event {
            Event::LaneStarted(start) => {
                self.device.clone_from(&start.device);
                self.fault.clone_from(&start.fault);
            }
            Event::SuiteStarted(start) => self.suites.push(SuiteSummary {
                suite: start.suite.clone(),
                counts: VerdictCounts::default(),
                lane_time_ns: 0,
            }),
            Event::CaseFinished(case) => self.case(case),
            Event::LaneFinished(end) => {
                self.lane_time_ns = end.at_ns;
                self.stopped.clone_from(&end.stopped);
                self.complete = true;
            }
            _ => {}
        }
    }

    fn case(&mut self, case: &CaseFinished) {
        self.counts.add(case.verdict);
        if let Some(suite) = self.suites.last_mut() {
            suite.counts.add(case.verdict);
            suite.lane_time_ns = suite.lane_time_ns.saturating_add(case.duration_ns);
        }
        match case.verdict {
            Verdict::Pass => {}
            Verdict::Skipped => {
                let reason = case.reason.as_deref().unwrap_or("no reason given");
                *self.skipped.entry(reason.to_owned()).or_default() += 1;
            }
            verdict => {
                let first = case.failures.first().map(|failure| failure.what.as_str());
                self.listed.push(ListedCase {
                    id: case.id.clone(),
                    verdict,
                    what: first
                        .or(case.reason.as_deref())
                        .unwrap_or_default()
                        .to_owned(),
                });
            }
        }
    }
}

/// The columns of the table, in the order people look for them.
const COLUMNS: [Verdict; 6] = [
    Verdict::Pass,
    Verdict::Deviation,
    Verdict::Skipped,
    Verdict::Inconclusive,
    Verdict::Fail,
    Verdict::Error,
];

/// The end of a run: devices against verdicts, and what there is to say about the ones that did not pass. With
/// `strict`, a documented deviation counts as a failure.
pub fn summary_text(lanes: &[LaneSummary], wall: Duration, strict: bool, ink: Ink) -> String {
    text_of(lanes, Some(wall), strict, ink)
}

/// The same of a run that is read from its journal.
pub fn left_text(lanes: &[LaneSummary], strict: bool, ink: Ink) -> String {
    text_of(lanes, None, strict, ink)
}

fn text_of(lanes: &[LaneSummary], wall: Option<Duration>, strict: bool, ink: Ink) -> String {
    let mut text = "\n".to_owned();
    text.push_str(&table(lanes, ink));
    skipped(&mut text, lanes);
    let is_trouble = |verdict| match verdict {
        Verdict::Deviation => strict,
        Verdict::Fail | Verdict::Inconclusive | Verdict::Error => true,
        Verdict::Pass | Verdict::Skipped => false,
    };
    list(&mut text, lanes, "did not pass", ink, is_trouble);
    if !strict {
        let is_deviation = |verdict| verdict == Verdict::Deviation;
        list(
            &mut text,
            lanes,
            "deviate as their manual documents",
            ink,
            is_deviation,
        );
    }
    for lane in lanes {
        if let Some(reason) = &lane.stopped {
            say(
                &mut text,
                format_args!("\n{} was stopped: {reason}\n", lane.device),
            );
        } else if !lane.complete {
            say(
                &mut text,
                format_args!("\n{} did not come to its end\n", lane.device),
            );
        }
    }
    last_line(&mut text, lanes, wall, is_trouble, ink);
    text
}

fn table(lanes: &[LaneSummary], ink: Ink) -> String {
    let names = lanes.iter().map(|lane| lane.device.chars().count());
    let width = names.max().unwrap_or(0).max("device".len());
    let mut text = format!("{:<width$}  {:>7}", "device", "cases");
    for verdict in COLUMNS {
        say(
            &mut text,
            format_args!("  {:>1$}", verdict.name(), column_width(verdict)),
        );
    }
    say(&mut text, format_args!("  {:>15}\n", "lane time"));
    let mut row = |name: &str, counts: VerdictCounts, time: u64| {
        say(
            &mut text,
            format_args!("{name:<width$}  {:>7}", counts.total()),
        );
        for verdict in COLUMNS {
            let number = format!("{:>1$}", counts.of(verdict), column_width(verdict));
            let number = match counts.of(verdict) {
                0 => ink.faint(number),
                _ => ink.verdict(verdict, number),
            };
            say(&mut text, format_args!("  {number}"));
        }
        say(&mut text, format_args!("  {:>15}\n", short_seconds(time)));
    };
    for lane in lanes {
        row(&lane.device, lane.counts, lane.lane_time_ns);
    }
    if lanes.len() > 1 {
        row("all", total(lanes), lane_time(lanes));
    }
    text
}

fn column_width(verdict: Verdict) -> usize {
    verdict.name().len().max(7)
}

fn total(lanes: &[LaneSummary]) -> VerdictCounts {
    let mut all = VerdictCounts::default();
    lanes.iter().for_each(|lane| all.merge(lane.counts));
    all
}

fn lane_time(lanes: &[LaneSummary]) -> u64 {
    lanes
        .iter()
        .fold(0, |sum: u64, lane| sum.saturating_add(lane.lane_time_ns))
}

fn skipped(text: &mut String, lanes: &[LaneSummary]) {
    let mut reasons: BTreeMap<&str, u32> = BTreeMap::new();
    for (reason, count) in lanes.iter().flat_map(|lane| &lane.skipped) {
        *reasons.entry(reason).or_default() += count;
    }
    if reasons.is_empty() {
        return;
    }
    let mut reasons: Vec<_> = reasons.into_iter().collect();
    reasons.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    text.push_str("\nskipped:\n");
    for (reason, count) in reasons {
        say(text, format_args!("{count:>7}  {reason}\n"));
    }
}

fn list(
    text: &mut String,
    lanes: &[LaneSummary],
    heading: &str,
    ink: Ink,
    belongs: impl Fn(Verdict) -> bool,
) {
    let mut heading = Some(heading);
    for lane in lanes {
        for case in lane.listed.iter().filter(|case| belongs(case.verdict)) {
            if let Some(heading) = heading.take() {
                say(text, format_args!("\n{heading}:\n"));
            }
            let verdict = ink.verdict(case.verdict, format_args!("{:<12}", case.verdict));
            say(
                text,
                format_args!("  {verdict}  {}  {}\n", lane.device, case.id),
            );
            if !case.what.is_empty() {
                say(text, format_args!("                {}\n", case.what));
            }
        }
    }
}

fn last_line(
    text: &mut String,
    lanes: &[LaneSummary],
    wall: Option<Duration>,
    is_trouble: impl Fn(Verdict) -> bool,
    ink: Ink,
) {
    let all = total(lanes);
    let bad: u32 = COLUMNS
        .into_iter()
        .filter(|verdict| is_trouble(*verdict))
        .map(|verdict| all.of(verdict))
        .sum();
    let whole = lanes
        .iter()
        .all(|lane| lane.complete && lane.stopped.is_none());
    let words = match (bad, whole) {
        (0, true) if all.total() == all.skipped => {
            ink.verdict(Verdict::Inconclusive, "nothing was played")
        }
        (0, true) => ink.verdict(Verdict::Pass, "all passed"),
        (0, false) => ink.verdict(Verdict::Error, "not finished"),
        (bad, _) => ink.verdict(
            Verdict::Fail,
            format_args!("{bad} of {} did not pass", all.total()),
        ),
    };
    let lane_time = short_seconds(lane_time(lanes));
    say(
        text,
        format_args!("\n{words}: {lane_time} on the lanes' clocks"),
    );
    if let Some(wall) = wall {
        say(
            text,
            format_args!(", played in {:.2} s", wall.as_secs_f64()),
        );
    }
    text.push('\n');
}

/// Milliseconds are enough for people.
pub(crate) fn short_seconds(nanoseconds: u64) -> String {
    format!(
        "{}.{:03} s",
        nanoseconds / 1_000_000_000,
        nanoseconds / 1_000_000 % 1_000
    )
}

fn say(text: &mut String, words: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = text.write_fmt(words);
}
