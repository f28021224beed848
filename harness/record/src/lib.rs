//! What happened, as data: the events of a run, from which every report is made.
//!
//! A lane emits [`Event`]s in order. Written one a line as JSON, with the number of their lane, they are the *journal*,
//! format version [`FORMAT`]; read back they give the same reports. Instants are nanoseconds since the lane was opened.

mod event;
mod hex;
mod journal;
mod run;
mod verdict;

pub use event::{
    BusErrorEvent, CaseFinished, CaseStarted, Cite, Direction, Event, ExcerptLine, Failure,
    FrameEvent, Identity, IdentityPart, LaneFinished, LaneStarted, Limits, Measurement, Note,
    Observation, Place, PortInfo, PuttingBack, SerialEvent, Sink, StepStarted, StimulusEvent,
    SuiteFinished, SuiteStarted, WrittenStep,
};
pub use journal::{Entry, Journal, JournalError, JournalReader, read_journal, write_event};
pub use run::{PlannedLane, RunFinished, RunStarted, Setting, UsedFile};
pub use verdict::{Verdict, VerdictCounts};

/// The JSON Schema of one line of the journal.
pub fn journal_schema() -> serde_json::Value {
    /// An event of a lane, with the lane's number.
    #[derive(schemars::JsonSchema)]
    #[allow(dead_code, reason = "only its schema is used")]
    struct LaneLine {
        #[schemars(flatten)]
        on: journal::OnLane,
        #[schemars(flatten)]
        event: Event,
    }
    /// A line of the journal.
    #[derive(schemars::JsonSchema)]
    #[schemars(untagged)]
    #[allow(dead_code, reason = "only its schema is used")]
    enum Line {
        OfRun(journal::OfRun),
        OnLane(LaneLine),
    }
    schemars::schema_for!(Line).to_value()
}

/// The version of the journal format that this crate writes.
pub const FORMAT: u32 = 2;
