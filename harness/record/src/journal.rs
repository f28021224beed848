//! The journal: one entry a line, as JSON.

use std::io::{self, BufRead, Write};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::event::{Event, FrameEvent, Measurement, Sink, StepStarted};
use crate::{FORMAT, RunFinished, RunStarted};

/// Why a text is not a journal.
#[derive(Debug, thiserror::Error)]
pub enum JournalError {
    /// A line is no entry.
    #[error("line {line} is no entry of a journal: {reason}")]
    Line {
        /// The line, from 1.
        line: usize,
        /// What the JSON reader says.
        reason: String,
    },
    /// It does not start with the run's start.
    #[error("the first line is not the start of a run")]
    NoStart,
    /// It was written in a format this version does not know.
    #[error("journal format {0} is not known, only {FORMAT}")]
    Format(u32),
    /// It cannot be read.
    #[error("cannot be read: {0}")]
    Io(#[from] io::Error),
}

/// One line of a journal.
#[derive(Debug, Clone, PartialEq)]
pub enum Entry {
    /// Always the first.
    RunStarted(Box<RunStarted>),
    /// Something that happened on a lane, which is named by its place in [`RunStarted::lanes`].
    Lane(u32, Event),
    /// Always the last, if the run came to its end.
    RunFinished(RunFinished),
}

/// What a line of a lane carries beside its event.
#[derive(Serialize, Deserialize, JsonSchema)]
pub(crate) struct OnLane {
    /// The lane, by its place in the run's start.
    #[allow(dead_code, reason = "only its schema is used")]
    lane: u32,
}

/// A line that belongs to no lane.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(tag = "event", rename_all = "kebab-case")]
pub(crate) enum OfRun {
    /// What is played, with what, and by whom; always the first line.
    RunStarted(Box<RunStarted>),
    /// The run came to its end; always the last line.
    RunFinished(RunFinished),
}

impl Entry {
    /// Writes it as one line.
    ///
    /// # Errors
    /// What `out` says.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        match self {
            Entry::RunStarted(start) => {
                serde_json::to_writer(&mut *out, &OfRun::RunStarted(start.clone()))?;
                out.write_all(b"\n")
            }
            Entry::RunFinished(end) => {
                serde_json::to_writer(&mut *out, &OfRun::RunFinished(end.clone()))?;
                out.write_all(b"\n")
            }
            Entry::Lane(lane, event) => write_event(out, *lane, event),
        }
    }

    /// The entry that `line` is.
    fn parse(line: &mut [u8]) -> Result<Entry, serde_json::Error> {
        let Some((lane, used)) = lane_of(line) else {
            return Entry::parse_any(line);
        };
        // What follows the comma is the event without its bracket.
        let rest = &mut line[used - 1..];
        rest[0] = b'{';
        parse_event(rest).map(|event| Entry::Lane(lane, event))
    }

    /// A line of the run, or one of a lane that another program has put in another order.
    fn parse_any(line: &[u8]) -> Result<Entry, serde_json::Error> {
        let mut members: serde_json::Map<String, serde_json::Value> = serde_json::from_slice(line)?;
        let Some(lane) = members.remove("lane") else {
            return Ok(match serde_json::from_slice::<OfRun>(line)? {
                OfRun::RunStarted(start) => Entry::RunStarted(start),
                OfRun::RunFinished(end) => Entry::RunFinished(end),
            });
        };
        let event = serde_json::from_value(members.into())?;
        Ok(Entry::Lane(serde_json::from_value(lane)?, event))
    }
}

/// Writes what happened on `lane` as one line.
///
/// # Errors
/// What `out` says.
pub fn write_event(out: &mut impl Write, lane: u32, event: &Event) -> io::Result<()> {
    write!(out, "{{\"lane\":{lane},")?;
    serde_json::to_writer(WithoutFirst { out, first: true }, event)?;
    out.write_all(b"\n")
}

/// Writes the events of one lane as they come. What goes wrong is kept until [`Journal::finish`], and nothing is written
/// after it.
#[derive(Debug)]
pub struct Journal<W: Write> {
    out: W,
    lane: u32,
    failed: Option<io::Error>,
}

impl<W: Write> Journal<W> {
    /// The lines of lane number `lane`, on `out`, which is best buffered.
    pub fn new(out: W, lane: u32) -> Journal<W> {
        Journal {
            out,
            lane,
            failed: None,
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
        if self.failed.is_none() {
            self.failed = write_event(&mut self.out, self.lane, &event).err();
        }
    }
}

/// Leaves out the first byte.
struct WithoutFirst<'a, W: Write> {
    out: &'a mut W,
    first: bool,
}

impl<W: Write> Write for WithoutFirst<'_, W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.first && !bytes.is_empty() {
            self.first = false;
            self.out.write_all(&bytes[1..])?;
            return Ok(bytes.len());
        }
        self.out.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

const LANE: &[u8] = b"{\"lane\":";

/// The lane that a line is of, and how many bytes that takes, the comma included.
fn lane_of(line: &[u8]) -> Option<(u32, usize)> {
    let rest = line.strip_prefix(LANE)?;
    let digits = rest.iter().take_while(|byte| byte.is_ascii_digit()).count();
    let number = std::str::from_utf8(&rest[..digits]).ok()?.parse().ok()?;
    (rest.get(digits) == Some(&b',')).then_some((number, LANE.len() + digits + 1))
}

/// Most lines are frames, steps and measurements: these are read without looking for their kind first.
fn parse_event(text: &mut [u8]) -> Result<Event, serde_json::Error> {
    const FRAME: &[u8] = b"{\"event\":\"frame\"";
    const STEP: &[u8] = b"{\"event\":\"step-started\"";
    const MEASUREMENT: &[u8] = b"{\"event\":\"measurement\"";
    let known = [FRAME, STEP, MEASUREMENT]
        .into_iter()
        .find(|head| text.starts_with(head) && text.get(head.len()) == Some(&b','));
    let Some(head) = known else {
        return serde_json::from_slice(text);
    };
    let rest = &mut text[head.len()..];
    rest[0] = b'{';
    match head {
        FRAME => serde_json::from_slice::<FrameEvent>(rest).map(Event::Frame),
        STEP => serde_json::from_slice::<StepStarted>(rest).map(Event::StepStarted),
        _ => serde_json::from_slice::<Box<Measurement>>(rest).map(Event::Measurement),
    }
}

/// Reads a journal entry by entry. A last line that was cut off in the middle is left out, as after a power failure.
#[derive(Debug)]
pub struct JournalReader<R: BufRead> {
    input: R,
    line: Vec<u8>,
    number: usize,
    start: RunStarted,
}

impl<R: BufRead> JournalReader<R> {
    /// Reads the first line.
    ///
    /// # Errors
    /// [`JournalError`]: it is not the start of a run, or of another format.
    pub fn new(input: R) -> Result<JournalReader<R>, JournalError> {
        let mut reader = JournalReader {
            input,
            line: Vec::new(),
            number: 0,
            start: RunStarted::default(),
        };
        match reader.entry(None) {
            Ok(Some(Entry::RunStarted(start))) if start.format == FORMAT => {
                reader.start = *start;
                Ok(reader)
            }
            Ok(Some(Entry::RunStarted(start))) => Err(JournalError::Format(start.format)),
            Err(JournalError::Io(error)) => Err(JournalError::Io(error)),
            _ => Err(JournalError::NoStart),
        }
    }

    /// What stands in the first line.
    pub fn start(&self) -> &RunStarted {
        &self.start
    }

    /// The next entry that is of `lane`, or of the run; without `lane`, the next one.
    ///
    /// # Errors
    /// [`JournalError`]: a line that is not the last is no entry, or nothing can be read.
    pub fn entry(&mut self, lane: Option<u32>) -> Result<Option<Entry>, JournalError> {
        loop {
            self.line.clear();
            if self.input.read_until(b'\n', &mut self.line)? == 0 {
                return Ok(None);
            }
            self.number += 1;
            if let (Some(wanted), Some((of, _))) = (lane, lane_of(&self.line))
                && of != wanted
            {
                continue;
            }
            return match Entry::parse(&mut self.line) {
                Ok(Entry::Lane(of, _)) if lane.is_some_and(|wanted| wanted != of) => continue,
                Ok(entry) => Ok(Some(entry)),
                Err(_) if self.is_last()? => Ok(None),
                Err(error) => Err(JournalError::Line {
                    line: self.number,
                    reason: error.to_string(),
                }),
            };
        }
    }

    /// Whether nothing follows the line that was read.
    fn is_last(&mut self) -> Result<bool, JournalError> {
        Ok(self.input.fill_buf()?.is_empty())
    }
}

/// Reads a whole journal: the start of the run, and what followed.
///
/// # Errors
/// [`JournalError`]
pub fn read_journal(journal: &[u8]) -> Result<(RunStarted, Vec<Entry>), JournalError> {
    let mut reader = JournalReader::new(journal)?;
    let mut entries = Vec::new();
    while let Some(entry) = reader.entry(None)? {
        entries.push(entry);
    }
    Ok((reader.start, entries))
}
