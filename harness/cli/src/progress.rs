//! How far a run has come, on a terminal.

use std::collections::HashMap;
use std::sync::Mutex;
use std::sync::PoisonError;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::history::History;

/// A line that moves, or nothing.
pub(crate) struct Progress {
    bar: ProgressBar,
    /// What each lane has still to play, where that is known.
    remaining: Mutex<Remaining>,
}

/// How long the lanes will take, by how long their cases took before.
#[derive(Default)]
struct Remaining {
    history: History,
    /// The time of each lane, in nanoseconds, and the cases that nothing is known of.
    lanes: HashMap<usize, (u64, u64)>,
}

impl Progress {
    /// For so many cases; hidden unless `shown`.
    pub(crate) fn new(cases: u64, shown: bool) -> Progress {
        Progress::of(cases, "cases", shown)
    }

    /// For so many of what `unit` says; hidden unless `shown`.
    pub(crate) fn of(number: u64, unit: &'static str, shown: bool) -> Progress {
        Progress::with_template(
            number,
            shown,
            "{wide_bar} {pos}/{len} {msg}  {elapsed}",
            unit,
        )
    }

    /// For so many cases, with the one that is played; hidden unless `shown`.
    pub(crate) fn of_run(cases: u64, shown: bool, history: History) -> Progress {
        let template = "{pos}/{len}  {elapsed}{prefix}  {wide_msg}";
        let progress = Progress::with_template(cases, shown, template, "");
        if shown {
            progress.bar.enable_steady_tick(Duration::from_millis(200));
        }
        progress.lock().history = history;
        progress
    }

    fn with_template(number: u64, shown: bool, template: &str, message: &'static str) -> Progress {
        let bar = ProgressBar::new(number);
        if !shown {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
            bar.set_message(message);
        }
        Progress {
            bar,
            remaining: Mutex::default(),
        }
    }

    fn lock(&self) -> std::sync::MutexGuard<'_, Remaining> {
        self.remaining
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    /// Lane number `lane` will play these cases in real time.
    pub(crate) fn plan<'i>(&self, lane: usize, device: &str, ids: impl Iterator<Item = &'i str>) {
        let mut remaining = self.lock();
        let (mut known_ns, mut unknown) = (0_u64, 0_u64);
        for id in ids {
            match remaining.history.of(device, id) {
                Some(time_ns) => known_ns = known_ns.saturating_add(time_ns),
                None => unknown += 1,
            }
        }
        remaining.lanes.insert(lane, (known_ns, unknown));
    }

    /// A case begins.
    pub(crate) fn begins(&self, device: &str, id: &str) {
        if !self.bar.is_hidden() {
            self.bar.set_message(format!("{device}  {id}"));
        }
    }

    /// One more is finished.
    pub(crate) fn step(&self) {
        self.bar.inc(1);
    }

    /// A case of lane number `lane` is finished.
    pub(crate) fn finished(&self, lane: usize, device: &str, id: &str) {
        self.step();
        if self.bar.is_hidden() {
            return;
        }
        let mut remaining = self.lock();
        let took = remaining.history.of(device, id);
        let Some((known_ns, unknown)) = remaining.lanes.get_mut(&lane) else {
            return;
        };
        match took {
            Some(time_ns) => *known_ns = known_ns.saturating_sub(time_ns),
            None => *unknown = unknown.saturating_sub(1),
        }
        let words = remaining.words();
        drop(remaining);
        self.bar.set_prefix(words);
    }

    /// Takes the line away while `print` prints.
    pub(crate) fn suspend(&self, print: impl FnOnce()) {
        self.bar.suspend(print);
    }

    /// The run is over.
    pub(crate) fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

impl Remaining {
    /// `, about 4 min left`: what the slowest lane needs, if more is known than not.
    fn words(&self) -> String {
        let mean_ns = self.history.mean_ns();
        let of_lane = |(known_ns, unknown): &(u64, u64)| {
            known_ns.saturating_add(unknown.saturating_mul(mean_ns))
        };
        match self.lanes.values().map(of_lane).max() {
            Some(left_ns) if mean_ns > 0 => format!(", {} left", about(left_ns)),
            _ => String::new(),
        }
    }
}

/// `about 4 min`, `about 20 s`
fn about(nanoseconds: u64) -> String {
    let seconds = nanoseconds.div_ceil(1_000_000_000);
    match seconds {
        0..=90 => format!("about {seconds} s"),
        _ => format!("about {} min", seconds.div_ceil(60)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_left_is_what_the_slowest_lane_needs() {
        let mut history = History::default();
        history.add("one", "a/slow", 60_000_000_000);
        history.add("one", "a/quick", 2_000_000_000);
        history.add("two", "a/quick", 4_000_000_000);
        let progress = Progress::of_run(4, false, history);
        progress.plan(0, "one", ["a/slow", "a/quick"].into_iter());
        progress.plan(1, "two", ["a/quick", "a/new"].into_iter());
        assert_eq!(progress.lock().words(), ", about 62 s left");
        progress.lock().lanes.insert(0, (0, 0));
        // The mean of all stands for a case that is new.
        assert_eq!(progress.lock().words(), ", about 26 s left");
    }

    #[test]
    fn without_history_nothing_is_promised() {
        let progress = Progress::of_run(1, false, History::default());
        progress.plan(0, "one", ["a/new"].into_iter());
        assert_eq!(progress.lock().words(), "");
        assert_eq!(about(91_000_000_000), "about 2 min");
    }
}
