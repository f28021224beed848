//! What a slave counts of the line, and the log of its events: what functions 08h, 0Bh and 0Ch tell.

use std::collections::VecDeque;

use super::Exception;

/// The log holds so many events.
const LONGEST_LOG: usize = 64;

/// What an event in the log says, of a request that came.
const RECEIVED: u8 = 0x80;
const RECEIVED_BROADCAST: u8 = 0x40;
/// Of one that came, and of an answer that would have gone.
const LISTENING: u8 = 0x20;
/// Of an answer that went.
const SENT: u8 = 0x40;
const SENT_READ_EXCEPTION: u8 = 0x01;
const SENT_ABORT: u8 = 0x02;
const SENT_BUSY: u8 = 0x04;
/// Of the slave itself.
const LISTENS_ONLY: u8 = 0x04;
const RESTARTED: u8 = 0x00;

/// The counters, and whether the slave only listens.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Counters {
    /// Messages on the line whose CRC was right.
    pub(crate) bus_messages: u16,
    /// Messages that were spoilt.
    pub(crate) communication_errors: u16,
    /// Refusals, also of broadcasts.
    pub(crate) exceptions: u16,
    /// Messages for this slave, broadcasts among them.
    pub(crate) server_messages: u16,
    /// Messages for this slave that it did not answer.
    pub(crate) unanswered: u16,
    /// Refusals because it was busy.
    pub(crate) busy: u16,
    /// Messages that were done.
    pub(crate) events: u16,
    /// The newest first.
    log: VecDeque<u8>,
    /// Whether it does and answers nothing until it is restarted.
    pub(crate) listens_only: bool,
}

impl Counters {
    /// A spoilt message came.
    pub(crate) fn spoilt(&mut self) {
        self.communication_errors = self.communication_errors.wrapping_add(1);
    }

    /// A whole message came, for whomever.
    pub(crate) fn heard(&mut self) {
        self.bus_messages = self.bus_messages.wrapping_add(1);
    }

    /// A message for this slave came.
    pub(crate) fn received(&mut self, broadcast: bool) {
        self.server_messages = self.server_messages.wrapping_add(1);
        if broadcast || self.listens_only {
            self.unanswered = self.unanswered.wrapping_add(1);
        }
        let mut event = RECEIVED;
        if broadcast {
            event |= RECEIVED_BROADCAST;
        }
        if self.listens_only {
            event |= LISTENING;
        }
        self.note(event);
    }

    /// A message was done, or refused. What only fetches the counter does not count.
    pub(crate) fn done(&mut self, refused: Option<Exception>, counts: bool) {
        match refused {
            None if counts => self.events = self.events.wrapping_add(1),
            None => {}
            Some(exception) => {
                self.exceptions = self.exceptions.wrapping_add(1);
                if matches!(exception, Exception::DeviceBusy) {
                    self.busy = self.busy.wrapping_add(1);
                }
            }
        }
        self.note(
            SENT | match refused {
                None => 0,
                Some(Exception::ServerDeviceFailure) => SENT_ABORT,
                Some(Exception::Acknowledge | Exception::DeviceBusy) => SENT_BUSY,
                Some(_) => SENT_READ_EXCEPTION,
            },
        );
    }

    /// From now on it only listens.
    pub(crate) fn listen_only(&mut self) {
        self.listens_only = true;
        self.note(LISTENS_ONLY);
    }

    /// Everything from the beginning; the log only if it is told to.
    pub(crate) fn restart(&mut self, with_log: bool) {
        let log = match with_log {
            true => VecDeque::new(),
            false => std::mem::take(&mut self.log),
        };
        *self = Counters {
            log,
            ..Counters::default()
        };
        self.note(RESTARTED);
    }

    /// The counters from 0.
    pub(crate) fn clear(&mut self) {
        *self = Counters {
            log: std::mem::take(&mut self.log),
            listens_only: self.listens_only,
            ..Counters::default()
        };
    }

    /// The newest event first.
    pub(crate) fn log(&self) -> impl Iterator<Item = u8> + '_ {
        self.log.iter().copied()
    }

    fn note(&mut self, event: u8) {
        self.log.truncate(LONGEST_LOG - 1);
        self.log.push_front(event);
    }
}
