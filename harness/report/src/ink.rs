//! Colours, or none.

use std::fmt;

use anstyle::{AnsiColor, Style};
use fieldproof_record::Verdict;

/// Whether text carries ANSI colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Ink {
    /// Text alone.
    #[default]
    Plain,
    /// With ANSI escape codes.
    Coloured,
}

impl Ink {
    /// `text` in `style`.
    pub(crate) fn paint(self, style: Style, text: impl fmt::Display) -> String {
        match self {
            Ink::Plain => text.to_string(),
            Ink::Coloured => format!("{style}{text}{style:#}"),
        }
    }

    pub(crate) fn bold(self, text: impl fmt::Display) -> String {
        self.paint(Style::new().bold(), text)
    }

    pub(crate) fn faint(self, text: impl fmt::Display) -> String {
        self.paint(Style::new().dimmed(), text)
    }

    /// `text` in the colour of `verdict`.
    pub fn verdict(self, verdict: Verdict, text: impl fmt::Display) -> String {
        self.paint(verdict_style(verdict), text)
    }
}

pub(crate) fn verdict_style(verdict: Verdict) -> Style {
    match verdict {
        Verdict::Pass => AnsiColor::Green.on_default(),
        Verdict::Skipped => Style::new().dimmed(),
        Verdict::Deviation => AnsiColor::Cyan.on_default(),
        Verdict::Inconclusive => AnsiColor::Yellow.on_default().bold(),
        Verdict::Fail => AnsiColor::Red.on_default().bold(),
        Verdict::Error => AnsiColor::Magenta.on_default().bold(),
    }
}
