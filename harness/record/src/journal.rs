//! The journal: one event a line, as JSON.

use std::io::{self, Write};

use crate::{Event, FORMAT, Sink};

/// Why a text is not a journal.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum JournalError {
    /// A line is not an event.
    #[error("line {line} is not an event: {reason}")]
    Line {
        /// The line, from 1.
        line: usize,
        /// What the JSON reader says.
        reason: String,
    },
    /// It does not start with the lane's start.
    #[error("the first line is not the start of a lane")]
    NoStart,
    /// It was written in a format this version does not know.
    #[error("journal format {0} is not known, only {FORMAT}")]
    Format(u32),
}

/// Writes the events of one lane as they come. What goes wrong is kept until [`Journal::finish`], and nothing is
/// written after it.
#[derive(Debug)]
pub struct Journal<W: Write> {
    out: W,
    failed: Option<io::Error>,
}

impl<W: Write> Journal<W> {
    /// A journal on `out`, which is best buffered.
    pub fn new(out: W) -> Journal<W> {
        Journal { out, failed: None }
    }

    /// Writes `event` as one line.
    pub fn write(&mut self, event: &Event) {
        if self.failed.is_none() {
            self.failed = write_event(&mut self.out, event).err();
        }
    }

    /// Flushes, and gives the output back.
    ///
    /// # Errors
    /// The first thing that went wrong.
    pub fn finish(mut self) -> io::Result<W> {
        match self.failed {
            Some(error) => Err(error),
            None => self.out.flush().map(|()| self.out),
        }
    }
}

impl<W: Write> Sink for Journal<W> {
    fn emit(&mut self, event: Event) {
        self.write(&event);
    }
}

/// Writes `event` as one line.
///
/// # Errors
/// What `out` says.
pub fn write_event(out: &mut impl Write, event: &Event) -> io::Result<()> {
    serde_json::to_writer(&mut *out, event)?;
    out.write_all(b"\n")
}

/// Reads a whole journal. A last line that was cut off in the middle is left out, as after a power failure; whether
/// the lane came to its end is told by [`Event::LaneFinished`].
///
/// # Errors
/// [`JournalError`]: another line is not an event, or the format is unknown.
pub fn read_journal(journal: &[u8]) -> Result<Vec<Event>, JournalError> {
    let mut events = Vec::new();
    for (index, line) in journal.split_inclusive(|byte| *byte == b'\n').enumerate() {
        match serde_json::from_slice::<Event>(line) {
            Ok(event) => events.push(event),
            Err(_) if !line.ends_with(b"\n") => break,
            Err(error) => {
                return Err(JournalError::Line {
                    line: index + 1,
                    reason: error.to_string(),
                });
            }
        }
    }
    match events.first() {
        Some(Event::LaneStarted(start)) if start.format == FORMAT => Ok(events),
        Some(Event::LaneStarted(start)) => Err(JournalError::Format(start.format)),
        _ => Err(JournalError::NoStart),
    }
}
