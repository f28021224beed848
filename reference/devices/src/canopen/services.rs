//! Services that only some slaves have, at a reset, and the second SDO server.

use fieldproof_link::Instant;

use super::consumers::Consumers;
use super::emergency::Errors;
use super::lss::LssWork;
use super::pdo;
use super::sdo::Server;
use super::time::Clock;
use super::write::SECOND_SDO_SERVER;
use super::{Address, Slave};

impl Slave {
    /// What only some slaves have begins as after power-on.
    pub(super) fn initialise_services(&mut self, now: Instant) {
        self.errors = Errors::default();
        self.consumers = Consumers::default();
        self.clock = Clock::default();
        self.set_clock(now);
        self.consequence = None;
        self.switch = None;
        self.lss_work = LssWork::default();
        self.second_sdo = (None, Server::default());
        if self.profile.complete {
            self.consumers = Consumers::read(&self.objects);
            self.reconfigure_second_sdo();
        }
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
