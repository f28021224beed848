//! One client of the hub, to which the hub is an adapter.

use std::collections::VecDeque;
use std::os::fd::BorrowedFd;

use fieldproof_can::Frame;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::termios::{FlushArg, tcflush};

use crate::Instant;
use crate::real::slcan::connection::{Connection, make_raw};
use crate::real::slcan::{Answer, Command, PACED_BUS, Stamp, Stamps, UNPACED_BUS};

/// More bytes than these do not wait for a client that does not read.
const MOST_UNSENT: usize = 1 << 20;

/// Once so many frames of a client wait for the bus, nothing more is read from it.
const MOST_WAITING: usize = 32;

/// Where a client is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// It comes and goes.
    Network,
    /// It is there while somebody has the pseudo-terminal open.
    Terminal,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Channel {
    Closed,
    Open,
    Listening,
}

/// A frame that waits for the bus.
#[derive(Debug, Clone, Copy)]
pub(super) struct Waiting {
    pub(super) frame: Frame,
    pub(super) since: Instant,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Presence {
    There,
    /// It has said its last; what it said is still done.
    Leaving,
    /// It does not read what it is sent.
    Dropped,
    /// Nobody has the pseudo-terminal open.
    Away,
}

pub(super) struct Client {
    connection: Connection,
    name: String,
    place: Place,
    presence: Presence,
    channel: Channel,
    bit_rate: u32,
    usual_bit_rate: u32,
    paced: bool,
    stamps: Stamps,
    waiting: VecDeque<Waiting>,
    /// A command that waits until the frames before it have left.
    held: Option<Command>,
}

impl Client {
    pub(super) fn new(
        connection: Connection,
        name: String,
        place: Place,
        bit_rate: u32,
        paced: bool,
    ) -> Client {
        Client {
            connection,
            name,
            place,
            presence: match place {
                Place::Network => Presence::There,
                Place::Terminal => Presence::Away,
            },
            channel: Channel::Closed,
            bit_rate,
            usual_bit_rate: bit_rate,
            paced,
            stamps: Stamps::None,
            waiting: VecDeque::new(),
            held: None,
        }
    }

    pub(super) fn descriptor(&self) -> BorrowedFd<'_> {
        self.connection.descriptor()
    }

    /// What to wait for.
    pub(super) fn wants(&self) -> PollFlags {
        let mut wants = PollFlags::empty();
        if self.presence == Presence::There && !self.is_full() {
            wants |= PollFlags::POLLIN;
        }
        if self.presence == Presence::There && self.connection.unsent() > 0 {
            wants |= PollFlags::POLLOUT;
        }
        wants
    }

    fn is_full(&self) -> bool {
        self.waiting.len() >= MOST_WAITING || self.held.is_some()
    }

    /// Takes some of what has arrived.
    pub(super) fn fill(&mut self) {
        if self.presence != Presence::There || self.is_full() {
            return;
        }
        if self.connection.fill().is_err() {
            self.presence = Presence::Leaving;
        }
    }

    /// Does what has arrived, as far as the frames that wait permit.
    pub(super) fn obey(&mut self, now: Instant) {
        while self.waiting.len() < MOST_WAITING {
            let command = self.held.take().or_else(|| {
                let (line, _) = self.connection.next_line()?;
                Some(Command::read(line))
            });
            match command {
                None => return,
                Some(Command::Transmit(frame)) if self.channel == Channel::Open => {
                    self.waiting.push_back(Waiting { frame, since: now });
                }
                // Answers come in the order of commands.
                Some(other) if !self.waiting.is_empty() => {
                    self.held = Some(other);
                    return;
                }
                Some(other) => {
                    let answer = self.answer(other);
                    answer.write(self.connection.outbox());
                }
            }
        }
    }

    fn answer(&mut self, command: Command) -> Answer {
        let is_closed = self.channel == Channel::Closed;
        match command {
            Command::Nothing => Answer::Done,
            Command::BitRate(code) if is_closed => {
                self.bit_rate = code.bit_rate();
                Answer::Done
            }
            Command::Registers(registers) if is_closed => {
                self.bit_rate = bit_rate_of(registers);
                Answer::Done
            }
            Command::Open if is_closed => self.set_channel(Channel::Open),
            Command::Listen if is_closed => self.set_channel(Channel::Listening),
            Command::Close if !is_closed => self.set_channel(Channel::Closed),
            Command::Stamps(stamps) => {
                self.stamps = stamps;
                Answer::Done
            }
            Command::Status if !is_closed => Answer::Status(0),
            Command::Version => Answer::Text(b"V1013".to_vec()),
            Command::FirmwareVersion => Answer::Text(b"v0100".to_vec()),
            Command::SerialNumber => {
                let text = if self.paced { PACED_BUS } else { UNPACED_BUS };
                Answer::Text(text.to_vec())
            }
            _ => Answer::Refused(Vec::new()),
        }
    }

    fn set_channel(&mut self, channel: Channel) -> Answer {
        self.channel = channel;
        Answer::Done
    }

    /// The bit rate at which it sends, if it sends anything.
    pub(super) fn sends_at(&self) -> Option<(u32, Waiting)> {
        self.waiting.front().map(|first| (self.bit_rate, *first))
    }

    /// A frame of another client at `bit_rate` was on the bus until `at`.
    pub(super) fn hear(&mut self, frame: Frame, bit_rate: u32, at: Instant) {
        let hears = self.presence == Presence::There
            && self.channel != Channel::Closed
            && self.bit_rate == bit_rate;
        if hears {
            let stamp = self.stamp(at);
            let answer = Answer::Received { frame, stamp };
            answer.write(self.connection.outbox());
        }
    }

    /// Its own `frame` was on the bus until `at`.
    pub(super) fn hear_own(&mut self, frame: Frame, at: Instant) {
        if self
            .waiting
            .front()
            .is_none_or(|first| first.frame != frame)
        {
            return;
        }
        self.waiting.pop_front();
        let stamp = match self.stamps {
            // This one is ours only: no other program asks for it.
            Stamps::Microseconds => self.stamp(at),
            Stamps::None | Stamps::Milliseconds => None,
        };
        let extended = frame.id().is_extended();
        let answer = Answer::Taken { extended, stamp };
        answer.write(self.connection.outbox());
    }

    fn stamp(&self, at: Instant) -> Option<Stamp> {
        const HOUR_US: u64 = 3_600_000_000;
        let microseconds = at.as_nanos() / 1_000;
        match self.stamps {
            Stamps::None => None,
            Stamps::Milliseconds => {
                Some(Stamp::Milliseconds((microseconds / 1_000 % 60_000) as u16))
            }
            Stamps::Microseconds => Some(Stamp::Microseconds((microseconds % HOUR_US) as u32)),
        }
    }

    /// Sends what there is for it. Whether it is kept: a pseudo-terminal always is.
    pub(super) fn goes_on(&mut self, notice: &mut impl FnMut(&str)) -> bool {
        if self.presence == Presence::There {
            self.send();
        }
        match self.presence {
            Presence::There | Presence::Away => return true,
            Presence::Leaving if !self.waiting.is_empty() => return true,
            Presence::Leaving => {}
            Presence::Dropped => {
                notice(&format!("{} is dropped: it does not read", self.name));
            }
        }
        if self.place == Place::Network {
            return false;
        }
        self.reset();
        true
    }

    fn send(&mut self) {
        if self.connection.flush().is_err() {
            // It does not listen any more, but may have said something before.
            self.connection.forget_unsent();
        }
        if self.connection.unsent() > MOST_UNSENT {
            self.presence = Presence::Dropped;
        }
    }

    /// The next who opens the pseudo-terminal finds it as if it were new.
    fn reset(&mut self) {
        self.presence = Presence::Away;
        self.channel = Channel::Closed;
        self.bit_rate = self.usual_bit_rate;
        self.stamps = Stamps::None;
        self.waiting.clear();
        self.held = None;
        self.connection.forget();
        // What is left in there is for nobody; where it cannot be dropped, it is garbage to the next.
        let _ = tcflush(self.connection.descriptor(), FlushArg::TCIOFLUSH);
        let _ = make_raw(self.connection.descriptor());
    }

    pub(super) fn look_whether_opened(&mut self) {
        if self.presence != Presence::Away {
            return;
        }
        let mut descriptors = [PollFd::new(self.connection.descriptor(), PollFlags::POLLIN)];
        let polled = poll(&mut descriptors, PollTimeout::ZERO);
        let events = descriptors[0].revents().unwrap_or(PollFlags::POLLHUP);
        if polled.is_ok() && !events.contains(PollFlags::POLLHUP) {
            self.presence = Presence::There;
        }
    }
}

/// The bit rate of bus timing registers 0 and 1: prescaler in bits 5..0 of the first; bit segments before and after the
/// sample point in bits 3..0 and 6..4 of the second. All are one less than they mean, and a bit has one time quantum
/// more; of these there are 8 million a second before the prescaler.
fn bit_rate_of(registers: [u8; 2]) -> u32 {
    let prescaler = u32::from(registers[0] & 0x3F) + 1;
    let before = u32::from(registers[1] & 0x0F) + 1;
    let after = u32::from(registers[1] >> 4 & 0x07) + 1;
    8_000_000 / (prescaler * (1 + before + after))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn registers_are_a_bit_rate() {
        // 8 MHz / 1 / (1 + 13 + 2) and 8 MHz / 4 / 16, as SJA1000 tables have them.
        assert_eq!(bit_rate_of([0x00, 0x1C]), 500_000);
        assert_eq!(bit_rate_of([0x03, 0x1C]), 125_000);
    }
}
