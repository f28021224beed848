//! The one form of everything that is shown with its place.

use std::sync::Arc;

use fieldproof_record::{Failure, Verdict};
use serde::Serialize;

/// How bad it is; the word that the text starts with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// The input can be used.
    Warning,
    /// The device departs as its manual documents.
    Deviation,
    /// It could not be decided.
    Inconclusive,
    /// The device is wrong.
    Fail,
    /// The input cannot be used, or the bench broke.
    Error,
}

impl Severity {
    /// The word for it.
    pub const fn name(self) -> &'static str {
        match self {
            Severity::Note => "note",
            Severity::Warning => "warning",
            Severity::Deviation => "deviation",
            Severity::Inconclusive => "inconclusive",
            Severity::Fail => "fail",
            Severity::Error => "error",
        }
    }
}

impl From<Verdict> for Severity {
    /// What is no trouble at all (pass, skipped) counts as a warning.
    fn from(verdict: Verdict) -> Severity {
        match verdict {
            Verdict::Pass | Verdict::Skipped => Severity::Warning,
            Verdict::Deviation => Severity::Deviation,
            Verdict::Inconclusive => Severity::Inconclusive,
            Verdict::Fail => Severity::Fail,
            Verdict::Error => Severity::Error,
        }
    }
}

/// A place in a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize)]
pub struct Span {
    /// Line, from 1; 0 for no place.
    pub line: u32,
    /// First column in characters, from 1; 0 for the whole line.
    pub column: u32,
    /// The column after the last, on the same line.
    pub end_column: u32,
}

/// The text that a place is in.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum SourceText {
    /// It is not at hand.
    #[default]
    Missing,
    /// The line of the place.
    Line(String),
    /// The whole file.
    Whole(Arc<str>),
}

/// Another place that matters.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Also {
    /// Where, in the same file.
    pub at: Span,
    /// Why it matters: `first defined here`.
    pub words: String,
}

/// A place in another file that matters.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Elsewhere {
    /// The file as the user named it.
    pub path: String,
    /// Where in it.
    pub at: Span,
    /// The text it is in.
    #[serde(skip)]
    pub source: SourceText,
    /// Why it matters: `the manual`.
    pub words: String,
}

/// Something that is wrong, with its place.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Problem {
    /// How bad it is.
    pub severity: Severity,
    /// `S001`: a section of docs/diagnostics.md.
    pub code: Option<String>,
    /// In one sentence without a full stop.
    pub message: String,
    /// The file as the user named it; empty for none.
    pub path: String,
    /// Where in it.
    pub at: Span,
    /// The text it is in.
    #[serde(skip)]
    pub source: SourceText,
    /// Words beside the marked text; empty for none.
    pub label: String,
    /// Other places in the same file that matter.
    pub also: Vec<Also>,
    /// Places in other files that matter.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub elsewhere: Vec<Elsewhere>,
    /// What else there is to know; a note may have several lines.
    pub notes: Vec<String>,
    /// What to do.
    pub help: Option<String>,
}

impl Problem {
    /// A problem with no place.
    pub fn new(severity: Severity, message: impl Into<String>) -> Problem {
        Problem {
            severity,
            code: None,
            message: message.into(),
            path: String::new(),
            at: Span::default(),
            source: SourceText::Missing,
            label: String::new(),
            also: Vec::new(),
            elsewhere: Vec::new(),
            notes: Vec::new(),
            help: None,
        }
    }

    /// The same in the file `path`.
    #[must_use]
    pub fn in_file(mut self, path: impl Into<String>) -> Problem {
        self.path = path.into();
        self
    }

    /// The same with one more note.
    #[must_use]
    pub fn note(mut self, note: impl Into<String>) -> Problem {
        self.notes.push(note.into());
        self
    }

    /// The same with what to do.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Problem {
        self.help = Some(help.into());
        self
    }
}

impl From<&Failure> for Problem {
    /// Without what was expected and what came, which are shown side by side.
    fn from(failure: &Failure) -> Problem {
        Problem {
            severity: failure.verdict.into(),
            code: None,
            message: failure.what.clone(),
            path: failure.place.path.clone(),
            at: Span {
                line: failure.place.line,
                column: failure.place.column,
                end_column: failure.place.end_column,
            },
            source: SourceText::Line(failure.place.text.clone()),
            label: String::new(),
            also: Vec::new(),
            elsewhere: Vec::new(),
            notes: failure.notes.clone(),
            help: None,
        }
    }
}
