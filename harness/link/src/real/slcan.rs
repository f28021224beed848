//! A CAN adapter that speaks SLCAN, the text protocol of Lawicel's adapters, over a serial port or TCP.

mod adapter_clock;
mod codec;
pub(super) mod connection;
mod open;

use std::collections::VecDeque;
use std::io;
use std::os::fd::BorrowedFd;
use std::time::Duration;

use fieldproof_can::Frame;

pub use codec::{Answer, BELL, BitRateCode, Command, END, Stamp, Stamps};

use self::adapter_clock::AdapterClock;
use self::connection::Connection;
use super::port::{Departure, News, Port, SendError, down};
use super::{Clock, OpenError};
use crate::signal::bits_in_nanos;
use crate::{BusError, Instant, Line, LinkError, PortProperties, Reception, Sent, Transmission};

/// How many frames an adapter may have taken without saying so; the least of them have room for eight.
const MOST_ASKED: usize = 8;

/// At 10 kbit/s eight frames take a tenth of a second, and others may go first; and a bus that is a program has to be
/// given the processor.
const PATIENCE: Duration = Duration::from_secs(1);

/// How often the adapter is asked for its status.
const STATUS_PERIOD: Duration = Duration::from_secs(1);

/// What our own bus without adapters says its serial number is: with bit times, and without.
pub(super) const PACED_BUS: &[u8] = b"NFPB1";
pub(super) const UNPACED_BUS: &[u8] = b"NFPB0";

/// A CAN adapter that speaks SLCAN. Frames carry the adapter's stamps where it gives them. When an own frame left is
/// taken from the adapter's acknowledge: most give it when they put the frame into their queue, our own
/// [bus](super::Hub) when the frame was on the bus, and with a stamp.
pub struct Slcan {
    connection: Connection,
    properties: PortProperties,
    clock: AdapterClock,
    /// What the adapter has not answered yet.
    asked: VecDeque<Asked>,
    /// Answers that came while another was waited for.
    held: VecDeque<Answer>,
    /// Nothing is told with an earlier instant: what came later was later.
    last: Instant,
    kind: Kind,
    /// The last status, and when it is asked for again; `None` if the adapter tells none.
    status: Option<(u8, Instant)>,
}

/// What the adapter can do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Kind {
    /// It answers to commands and to frames.
    acknowledges: bool,
    /// A frame takes time on the bus.
    has_bit_times: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Asked {
    Transmit(Frame),
    Status,
}

impl Slcan {
    /// Opens the adapter at `target` for `role`, and its channel at `bit_rate` bits a second. The target is the path of
    /// a serial port or of a pseudo-terminal, or `tcp://host:port`. `uncertainty` takes the place of what is known of
    /// such adapters: how far an instant may be off.
    ///
    /// # Errors
    /// [`OpenError`]: there is no such port, nothing there answers as an adapter does, or it has no such bit rate.
    pub fn open(
        role: &str,
        target: &str,
        bit_rate: u32,
        uncertainty: Option<Duration>,
    ) -> Result<Slcan, OpenError> {
        open::open(role, target, bit_rate, uncertainty)
    }

    fn wrong_kind(&self) -> LinkError {
        LinkError::WrongKind {
            port: self.properties.name.clone(),
        }
    }

    fn down(&self, error: &io::Error) -> LinkError {
        match error.kind() {
            io::ErrorKind::UnexpectedEof => down(&self.properties, "the other side closed it"),
            _ => down(&self.properties, error),
        }
    }

    /// The time that `frame` takes on the bus.
    fn frame_time(&self, frame: &Frame) -> Duration {
        match self.properties.line {
            Line::Can { bit_rate } if self.kind.has_bit_times => {
                Duration::from_nanos(bits_in_nanos(frame.bits().into(), bit_rate))
            }
            _ => Duration::ZERO,
        }
    }

    fn instant(&mut self, stamp: Option<Stamp>, arrived: Instant) -> Instant {
        let at = stamp.map_or(arrived, |stamp| self.clock.at(stamp, arrived));
        self.last = self.last.max(at);
        self.last
    }

    fn take_line(
        &mut self,
        arrived: Instant,
        news: &mut Vec<News>,
    ) -> Option<Result<(), LinkError>> {
        let answer = match self.held.pop_front() {
            Some(answer) => answer,
            None => {
                let (line, end) = self.connection.next_line()?;
                Answer::read(line, end)
            }
        };
        Some(self.hear(answer, arrived, news))
    }

    fn hear(
        &mut self,
        answer: Answer,
        arrived: Instant,
        news: &mut Vec<News>,
    ) -> Result<(), LinkError> {
        match answer {
            Answer::Received { frame, stamp } => {
                let at = self.instant(stamp, arrived);
                let what = Reception::Frame(frame);
                news.push(News::Arrived { at, what });
            }
            Answer::Taken { stamp, .. } => self.hear_taken(stamp, arrived, news),
            Answer::Done => self.hear_taken(None, arrived, news),
            Answer::Status(flags) => return self.hear_status(flags, arrived, news),
            Answer::Refused(_) => return self.hear_refused(),
            Answer::Other(line) if matches!(line.first(), Some(b't' | b'T' | b'r' | b'R')) => {
                let line = String::from_utf8_lossy(&line);
                let reason = format!(
                    "the adapter sent a spoilt frame, \"{}\"",
                    line.escape_debug()
                );
                return Err(down(&self.properties, reason));
            }
            // What is nothing of ours: CAN FD frames, events that only this adapter has.
            Answer::Text(_) | Answer::Other(_) => {}
        }
        Ok(())
    }

    /// The oldest frame that was not acknowledged yet has left.
    fn hear_taken(&mut self, stamp: Option<Stamp>, arrived: Instant, news: &mut Vec<News>) {
        let place = self.asked.iter().position(|it| *it != Asked::Status);
        if let Some(place) = place
            && let Some(Asked::Transmit(frame)) = self.asked.remove(place)
        {
            let end = self.instant(stamp, arrived);
            let start = end - self.frame_time(&frame);
            news.push(News::Left(Sent { start, end }));
        }
    }

    fn hear_refused(&mut self) -> Result<(), LinkError> {
        match self.asked.pop_front() {
            Some(Asked::Transmit(frame)) => {
                let reason = format!(
                    "the adapter did not take the frame {frame}: its queue is full, or it has left the bus"
                );
                Err(down(&self.properties, reason))
            }
            Some(Asked::Status) => {
                self.status = None;
                Ok(())
            }
            None => Ok(()),
        }
    }

    fn hear_status(
        &mut self,
        flags: u8,
        arrived: Instant,
        news: &mut Vec<News>,
    ) -> Result<(), LinkError> {
        const RECEIVE_QUEUE_FULL: u8 = 1 << 0;
        const FRAMES_LOST: u8 = 1 << 3;
        self.asked.retain(|it| *it != Asked::Status);
        let Some((before, _)) = self.status.replace((flags, arrived + STATUS_PERIOD)) else {
            return Ok(());
        };
        if flags & (RECEIVE_QUEUE_FULL | FRAMES_LOST) != 0 {
            let port = self.properties.name.clone();
            return Err(LinkError::Overflow { port, lost: 1 });
        }
        if let Some(error) = bus_error(flags).filter(|_| flags != before) {
            let at = self.instant(None, arrived);
            let what = Reception::BusError(error);
            news.push(News::Arrived { at, what });
        }
        Ok(())
    }

    /// From time to time the adapter is asked whether it lost something.
    fn ask_status(&mut self, now: Instant) -> Result<(), LinkError> {
        let is_due = self.status.is_some_and(|(_, at)| at <= now);
        if is_due && !self.asked.contains(&Asked::Status) {
            self.asked.push_back(Asked::Status);
            Command::Status.write(self.connection.outbox());
        }
        let flushed = self.connection.flush();
        flushed.map_err(|error| self.down(&error))
    }
}

/// The flags of the adapter as an error frame would tell them; `None` if there is no trouble.
fn bus_error(flags: u8) -> Option<BusError> {
    /// By flag: the class of the error, and the state of the controller.
    const MEANINGS: [(u8, u16, u8); 5] = [
        (1 << 1, 1 << 2, 0x02),
        (1 << 2, 1 << 2, 0x04 | 0x08),
        (1 << 5, 1 << 2, 0x10 | 0x20),
        (1 << 6, 1 << 1, 0),
        (1 << 7, 1 << 7, 0),
    ];
    let (mut class, mut controller) = (0, 0);
    for (flag, of_class, state) in MEANINGS {
        if flags & flag != 0 {
            class |= of_class;
            controller |= state;
        }
    }
    (class != 0).then(|| BusError::new(class, [0, controller, 0, 0, 0, 0, 0, 0]))
}

impl Port for Slcan {
    fn properties(&self) -> &PortProperties {
        &self.properties
    }

    fn readable(&self) -> BorrowedFd<'_> {
        self.connection.descriptor()
    }

    fn send(&mut self, clock: &mut Clock, what: &Transmission) -> Result<Departure, SendError> {
        let Transmission::Frame(frame) = what else {
            return Err(self.wrong_kind().into());
        };
        if self.connection.unsent() > 0 {
            let flushed = self.connection.flush();
            flushed.map_err(|error| self.down(&error))?;
        }
        if self.connection.unsent() > 0 || self.asked.len() >= MOST_ASKED {
            return Err(SendError::Busy);
        }
        Command::Transmit(*frame).write(self.connection.outbox());
        let flushed = self.connection.flush();
        flushed.map_err(|error| self.down(&error))?;
        if self.kind.acknowledges {
            self.asked.push_back(Asked::Transmit(*frame));
            return Ok(Departure::Told);
        }
        let start = clock.now();
        let end = start + self.frame_time(frame);
        Ok(Departure::At(Sent { start, end }))
    }

    fn take(&mut self, clock: &mut Clock, news: &mut Vec<News>) -> Result<(), LinkError> {
        loop {
            let filled = self.connection.fill();
            let arrived = clock.now();
            while let Some(heard) = self.take_line(arrived, news) {
                heard?;
            }
            match filled {
                Ok(true) => {}
                Ok(false) => return self.ask_status(arrived),
                Err(error) => return Err(self.down(&error)),
            }
        }
    }

    fn patience(&self) -> Duration {
        PATIENCE
    }

    fn set_line(&mut self, line: Line) -> Result<(), LinkError> {
        let Line::Can { bit_rate } = line else {
            return Err(self.wrong_kind());
        };
        let set = self.set_bit_rate(bit_rate);
        set.map_err(|reason| down(&self.properties, reason))?;
        self.properties.line = line;
        Ok(())
    }
}

impl Drop for Slcan {
    /// Takes the adapter off the bus.
    fn drop(&mut self) {
        Command::Close.write(self.connection.outbox());
        // Whether it is still there does not matter any more.
        let _ = self.connection.flush();
    }
}
