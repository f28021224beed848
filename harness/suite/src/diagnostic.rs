//! A problem in an input file, as data with a place. Made into text elsewhere.

/// A place in a text: a line and a range of columns on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Position {
    /// Line, from 1; 0 where the problem has no place.
    pub line: u32,
    /// First column in characters, from 1.
    pub column: u32,
    /// The column after the last, on the same line.
    pub end_column: u32,
}

/// The longest message, in characters. Messages repeat texts of the file, and those may be of any length.
const LONGEST_MESSAGE: usize = 300;

/// A message that is no longer than people read.
pub(crate) fn shorten(message: String) -> String {
    match message.char_indices().nth(LONGEST_MESSAGE) {
        Some((end, _)) => format!("{} ...", &message[..end]),
        None => message,
    }
}

/// How bad it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The file cannot be used.
    Error,
    /// The file can be used.
    Warning,
}

/// A problem in an input file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// `S001`: a section of docs/diagnostics.md.
    pub code: &'static str,
    /// How bad it is.
    pub severity: Severity,
    /// The file as the user named it.
    pub path: String,
    /// Where in it.
    pub at: Position,
    /// What is wrong, in one sentence without a full stop: `unknown verb "sdo-raed"`.
    pub message: String,
    /// What was expected there, beside the marked text: `expected one of the verbs`.
    pub label: String,
    /// Other places that matter, each with its words: `first defined here`.
    pub also: Vec<(Position, String)>,
    /// What to do: `did you mean "sdo-read"?`
    pub help: Option<String>,
}
