//! Services that only some slaves have, at a reset, and the second SDO server.

use fieldproof_can::{Frame, Id};
use fieldproof_link::Instant;

use super::consumers::Consumers;
use super::emergency::Errors;
use super::queue::identifier;
use super::sdo::Server;
use super::time::Clock;
use super::write::SECOND_SDO_SERVER;
use super::{Address, Slave};
use super::{emergency, pdo, sync, time};

impl Slave {
    /// What only some slaves have begins as after power-on.
    pub(super) fn initialise_services(&mut self, now: Instant) {
        self.errors = Errors::default();
        self.consumers = Consumers::default();
        self.clock = Clock::default();
        self.set_clock(now);
        self.consequence = None;
        self.switch = None;
        self.identified = 0;
        self.scanned = 0;
        self.second_sdo = (None, Server::default());
        if self.profile.complete {
            self.consumers = Consumers::read(&self.objects);
            self.reconfigure_second_sdo();
        }
    }

    /// COB-IDs that a wrong slave begins with.
    pub(super) fn lose_identifiers(&mut self) {
        let departs = &self.behaviour.departs;
        let lost = [
            (departs.sync_identifier_lost, sync::COB_ID, 0),
            (departs.time_identifier_lost, time::COB_ID, 0),
            (
                departs.emergency_identifier_without_node,
                emergency::COB_ID,
                0x80,
            ),
        ];
        for (_, address, value) in lost.into_iter().filter(|(lost, ..)| *lost) {
            self.objects.set_number(address, value);
        }
    }

    /// `frame` with 11 bits of its identifier, where a slave sees no others.
    pub(super) fn cut(&self, frame: &Frame) -> Option<Frame> {
        let Id::Extended(id) = frame.id() else {
            return None;
        };
        if !self.behaviour.departs.extended_frames_cut || frame.is_remote() {
            return None;
        }
        let low = u16::try_from(id.raw() & 0x7FF).ok()?;
        Frame::data(identifier(low), frame.bytes())
    }

    /// Whether a remote frame counts as SYNC.
    pub(super) fn takes_for_sync(&self, raw: u16) -> bool {
        self.behaviour.departs.sync_by_remote_frame && self.sync.identifier == Some(raw)
    }

    /// Reads 1201h again: the server works where both COB-IDs are valid.
    pub(super) fn reconfigure_second_sdo(&mut self) {
        let cob_id = |sub| {
            let cob_id = self.objects.number(Address::new(SECOND_SDO_SERVER, sub))?;
            let valid = cob_id & pdo::INVALID == 0;
            u16::try_from(cob_id & 0x7FF).ok().filter(|_| valid)
        };
        let (request, response) = (cob_id(1), cob_id(2));
        let used = request.filter(|_| response.is_some());
        self.second_sdo = (used, Server::answering_on(response));
    }

    /// Lets the second SDO server do what `work` says in the place of the first.
    pub(super) fn with_second_sdo(&mut self, work: impl FnOnce(&mut Slave)) {
        std::mem::swap(&mut self.sdo, &mut self.second_sdo.1);
        work(self);
        std::mem::swap(&mut self.sdo, &mut self.second_sdo.1);
    }
}
