//! Why a step ended before its end.

use std::fmt::Display;

use fieldproof_can::Frame;
use fieldproof_link::LinkError;

/// Why a step ended before its end. The four never mix: a wrong device, an open question, a broken bench, a user who
/// wants to stop.
#[derive(Debug)]
pub(crate) enum Stop {
    /// The device did something else than expected.
    Mismatch(Box<Mismatch>),
    /// It could not be decided.
    Undecided(Box<Mismatch>),
    /// The bench or the suite is at fault.
    Bench(String),
    /// A step uses a value that no step before it saved.
    NotSaved(String),
    /// The link failed.
    Link(LinkError),
    /// The user wants to stop.
    Interrupted,
}

/// What was expected and what came.
#[derive(Debug, Default)]
pub(crate) struct Mismatch {
    /// In one sentence.
    pub(crate) what: String,
    /// What was expected.
    pub(crate) expected: String,
    /// What came instead.
    pub(crate) actual: String,
    /// More to know.
    pub(crate) notes: Vec<String>,
    /// What came, for the comparison with a documented deviation.
    pub(crate) came: Came,
}

/// What came, in a form that a documented deviation can be compared with.
#[derive(Debug, Default, Clone)]
pub(crate) enum Came {
    /// Something that no deviation can describe.
    #[default]
    Other,
    /// Nothing.
    Silence,
    /// A CAN frame.
    Frame(Frame),
    /// An SDO abort.
    Abort(u32),
    /// A Modbus exception.
    Exception(u8),
    /// A value.
    Value(i128),
    /// A Modbus answer that is no exception.
    Answer,
}

impl From<LinkError> for Stop {
    fn from(error: LinkError) -> Stop {
        Stop::Link(error)
    }
}

impl Stop {
    pub(crate) fn mismatch(
        what: impl Into<String>,
        expected: impl Into<String>,
        actual: impl Into<String>,
        came: Came,
    ) -> Stop {
        Stop::Mismatch(Box::new(Mismatch {
            what: what.into(),
            expected: expected.into(),
            actual: actual.into(),
            notes: Vec::new(),
            came,
        }))
    }

    /// What it holds or says instead, in the first line too.
    pub(crate) fn differs(
        what: impl Display,
        expected: impl Display,
        actual: impl Display,
        came: Came,
    ) -> Stop {
        let (expected, actual) = (expected.to_string(), actual.to_string());
        let what = format!("{what}: {}, and not {}", cut(&actual), cut(&expected));
        Stop::mismatch(what, expected, actual, came)
    }

    pub(crate) fn undecided(
        what: impl Into<String>,
        expected: impl Into<String>,
        actual: impl Into<String>,
    ) -> Stop {
        Stop::Undecided(Box::new(Mismatch {
            what: what.into(),
            expected: expected.into(),
            actual: actual.into(),
            ..Mismatch::default()
        }))
    }

    pub(crate) fn with_note(mut self, note: impl Into<String>) -> Stop {
        if let Stop::Mismatch(mismatch) | Stop::Undecided(mismatch) = &mut self {
            mismatch.notes.push(note.into());
        }
        self
    }
}

/// So much of a value fits a line beside others.
const MOST_IN_A_LINE: usize = 96;

fn cut(text: &str) -> String {
    match text.char_indices().nth(MOST_IN_A_LINE) {
        Some((end, _)) => format!("{} ..", text.get(..end).unwrap_or_default()),
        None => text.to_owned(),
    }
}
