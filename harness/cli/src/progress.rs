//! How far a run has come, on a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// A line that moves, or nothing.
pub(crate) struct Progress(ProgressBar);

impl Progress {
    /// For so many cases; hidden unless `shown`.
    pub(crate) fn new(cases: u64, shown: bool) -> Progress {
        Progress::of(cases, "cases", shown)
    }

    /// For so many of what `unit` says; hidden unless `shown`.
    pub(crate) fn of(number: u64, unit: &'static str, shown: bool) -> Progress {
        let bar = ProgressBar::new(number);
        if !shown {
            bar.set_draw_target(ProgressDrawTarget::hidden());
        }
        if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len} {msg}  {elapsed}") {
            bar.set_style(style);
            bar.set_message(unit);
        }
        Progress(bar)
    }

    /// One more is finished.
    pub(crate) fn step(&self) {
        self.0.inc(1);
    }

    /// Takes the line away while `print` prints.
    pub(crate) fn suspend(&self, print: impl FnOnce()) {
        self.0.suspend(print);
    }

    /// The run is over.
    pub(crate) fn clear(&self) {
        self.0.finish_and_clear();
    }
}
