//! Frames that wait for the instant they leave.

use std::collections::VecDeque;

use fieldproof_can::{Frame, StandardId};
use fieldproof_link::{Instant, Outbox, Transmission};

/// What a frame belongs to; the NMT state permits it or not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Service {
    BootUp,
    ErrorControl,
    Sdo,
    Pdo,
    Sync,
    Time,
    Emergency,
    Lss,
}

#[derive(Debug, Clone, Copy)]
struct Pending {
    due: Instant,
    service: Service,
    frame: Frame,
}

/// Frames in the order in which they leave; those of one service never overtake each other.
#[derive(Debug, Default)]
pub(crate) struct Queue {
    pending: VecDeque<Pending>,
}

impl Queue {
    pub(crate) fn push(&mut self, due: Instant, service: Service, frame: Frame) {
        let earlier = self.pending.iter().rev();
        let due = earlier
            .filter(|pending| pending.service == service)
            .fold(due, |due, pending| due.max(pending.due));
        let behind = self.pending.iter().rev();
        let place = self.pending.len() - behind.take_while(|pending| pending.due > due).count();
        let pending = Pending {
            due,
            service,
            frame,
        };
        if place == self.pending.len() {
            self.pending.push_back(pending);
        } else {
            self.pending.insert(place, pending);
        }
    }

    pub(crate) fn next(&self) -> Option<Instant> {
        self.pending.front().map(|pending| pending.due)
    }

    /// Sends what is due.
    pub(crate) fn flush(&mut self, now: Instant, port: usize, out: &mut Outbox) {
        while let Some(pending) = self.pending.front().filter(|pending| pending.due <= now) {
            out.send(port, Transmission::Frame(pending.frame));
            self.pending.pop_front();
        }
    }

    /// Forgets what is due.
    pub(crate) fn drop_due(&mut self, now: Instant) {
        self.pending.retain(|pending| pending.due > now);
    }

    pub(crate) fn retain(&mut self, permitted: impl Fn(Service) -> bool) {
        self.pending.retain(|pending| permitted(pending.service));
    }

    /// Forgets the frames with this identifier.
    pub(crate) fn forget(&mut self, id: StandardId) {
        self.pending
            .retain(|pending| pending.frame.standard_id() != Some(id));
    }

    pub(crate) fn clear(&mut self) {
        self.pending.clear();
    }
}

/// The identifier `raw`; callers give 11 bits.
pub(crate) fn identifier(raw: u16) -> StandardId {
    StandardId::new(raw & 0x7FF).unwrap_or(StandardId::MAX)
}
