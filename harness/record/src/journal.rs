//! The journal: one event a line, as JSON.

use std::io::{self, Write};

use crate::{Event, FORMAT};

/// Why a text is not a journal.
#[derive(Debug)]
pub enum JournalError {
    /// A line is not an event.
    Line {
        /// The line, from 1.
        line: usize,
        /// What the JSON reader says.
        reason: String,
    },
    /// It does not start with the lane's start.
    NoStart,
    /// It was written in a format this version does not know.
    Format(u32),
}

/// Writes `event` as one line.
///
/// # Errors
/// What `out` says.
pub fn write_event(out: &mut impl Write, event: &Event) -> io::Result<()> {
    serde_json::to_writer(&mut *out, event)?;
    out.write_all(b"\n")
}

/// Reads a whole journal. A last line that was cut off in the middle is left out, as after a power failure.
///
/// # Errors
/// [`JournalError`]: another line is not an event, or the format is unknown.
pub fn read_journal(text: &str) -> Result<Vec<Event>, JournalError> {
    let mut events = Vec::new();
    let whole_lines = text.ends_with('\n');
    let count = text.lines().count();
    for (number, line) in text.lines().enumerate() {
        match serde_json::from_str::<Event>(line) {
            Ok(event) => events.push(event),
            Err(_) if number + 1 == count && !whole_lines => break,
            Err(error) => {
                return Err(JournalError::Line {
                    line: number + 1,
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
