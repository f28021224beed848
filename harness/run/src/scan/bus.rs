//! The CAN port of a scan: what is sent, and what comes.

use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::{
    Arrival, Instant, Lane, LinkError, Origin, PortIndex, Reception, Transmission,
};

use super::traffic::Traffic;

/// Frames that may wait to leave: adapters have little room.
const MOST_WAITING: usize = 8;

/// A CAN port.
pub(super) struct Bus<'l> {
    lane: &'l mut dyn Lane,
    port: PortIndex,
    /// Frames handed over that have not left as far as the port has told.
    waiting: usize,
    pub(super) traffic: Traffic,
}

/// What came.
#[derive(Debug, Clone, Copy)]
pub(super) enum News {
    /// A frame of the tester's left.
    Left(Instant, Frame),
    /// A frame of another's.
    Came(Frame),
}

impl Bus<'_> {
    pub(super) fn new(lane: &mut dyn Lane, port: PortIndex) -> Bus<'_> {
        Bus {
            lane,
            port,
            waiting: 0,
            traffic: Traffic::default(),
        }
    }

    pub(super) fn now(&self) -> Instant {
        self.lane.now()
    }

    /// Whether another frame can be handed over.
    pub(super) fn has_room(&self) -> bool {
        self.waiting < MOST_WAITING
    }

    /// Sends `frame` at once, and gives when it left, or was handed over.
    pub(super) fn send(&mut self, frame: Frame) -> Result<Instant, LinkError> {
        let now = self.lane.now();
        let sent = self.lane.send(self.port, now, Transmission::Frame(frame))?;
        let ports = self.lane.ports();
        if ports
            .get(self.port.0)
            .is_some_and(|port| port.tells_departure)
        {
            self.waiting += 1;
        }
        Ok(sent.end)
    }

    /// The next frame until `until`.
    pub(super) fn receive(&mut self, until: Instant) -> Result<Option<News>, LinkError> {
        while let Some(arrival) = self.lane.receive(until)? {
            let Arrival {
                at, origin, what, ..
            } = arrival;
            match (what, origin) {
                (Reception::Frame(frame), Origin::Tester) => {
                    self.waiting = self.waiting.saturating_sub(1);
                    return Ok(Some(News::Left(at, frame)));
                }
                (Reception::Frame(frame), Origin::Bus) => {
                    self.traffic.hear(at, &frame);
                    return Ok(Some(News::Came(frame)));
                }
                (Reception::BusError(_), _) => self.traffic.bus_errors += 1,
                (Reception::Character(_) | Reception::Connected | Reception::Closed, _)
                | (_, Origin::Companion(_)) => {}
            }
        }
        Ok(None)
    }

    /// Listens for so long.
    pub(super) fn listen(&mut self, time: Duration) -> Result<(), LinkError> {
        let until = self.now() + time;
        while self.receive(until)?.is_some() {}
        Ok(())
    }

    /// Nothing left within a time in which something should have: room is made, for a port may have lost count.
    pub(super) fn make_room(&mut self) {
        self.waiting = 0;
    }
}
