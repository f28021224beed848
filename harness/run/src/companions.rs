//! What the tester does on the bus beside a case: participants of the lane.

use std::time::Duration;

use fieldproof_can::{Frame, StandardId};
use fieldproof_link::{Instant, Line, Outbox, Participant, Reception, Transmission};

/// Sends SYNC (080h, no data) with a fixed period; the first one a period after it starts.
#[derive(Debug)]
pub(crate) struct SyncProducer {
    line: Line,
    next: Instant,
    period: Duration,
}

impl SyncProducer {
    pub(crate) fn new(line: Line, now: Instant, period: Duration) -> SyncProducer {
        SyncProducer {
            line,
            next: now + period,
            period,
        }
    }
}

impl Participant for SyncProducer {
    fn line(&self, _port: usize) -> Line {
        self.line
    }

    fn receive(&mut self, _now: Instant, _port: usize, _reception: Reception, _out: &mut Outbox) {}

    fn wake_at(&self) -> Option<Instant> {
        Some(self.next)
    }

    fn wake(&mut self, _now: Instant, out: &mut Outbox) {
        self.next = self.next + self.period;
        if let Some(frame) = StandardId::new(0x080).and_then(|id| Frame::data(id, &[])) {
            out.send(0, Transmission::Frame(frame));
        }
    }
}
