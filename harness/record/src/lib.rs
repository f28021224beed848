//! What happened, as data: the events of a run, from which every report is made.
//!
//! A lane emits [`Event`]s in order. Written one a line as JSON they are the *journal*, format version
//! [`FORMAT`]; read back they give the same reports. Instants are nanoseconds since the lane was opened.

mod event;
mod hex;
mod journal;
mod verdict;

pub use event::{
    BusErrorEvent, CaseFinished, CaseStarted, Cite, Direction, Event, ExcerptLine, Failure,
    FrameEvent, LaneFinished, LaneStarted, Limits, Measurement, Note, Observation, Place, PortInfo,
    SerialEvent, Sink, StepStarted, StimulusEvent, SuiteFinished, SuiteStarted,
};
pub use journal::{Journal, JournalError, read_journal, write_event};
pub use verdict::{Verdict, VerdictCounts};

/// The JSON Schema of one line of the journal.
pub fn journal_schema() -> serde_json::Value {
    schemars::schema_for!(Event).to_value()
}

/// The version of the journal format that this crate writes.
pub const FORMAT: u32 = 1;
