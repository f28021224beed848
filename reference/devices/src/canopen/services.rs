//! Services that only some slaves have, at a reset, and the SDO servers beside the default one.

use fieldproof_can::{Frame, Id};
use fieldproof_link::{Instant, StateName, StateValue};

use super::consumers::Consumers;
use super::emergency::Errors;
use super::lss::LssWork;
use super::queue::identifier;
use super::sdo::Server;
use super::time::Clock;
use super::{Address, Slave};
use super::{emergency, pdo, sync, time};

/// The parameters of the SDO servers beside the default one.
pub(super) const ADDITIONAL_SERVERS: std::ops::RangeInclusive<u16> = 0x1201..=0x127F;

/// An SDO server beside the default one.
#[derive(Debug)]
pub(super) struct AdditionalServer {
    /// The index of its parameters.
    index: u16,
    /// The identifier of its requests, if it works.
    request: Option<u16>,
    server: Server,
}

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
        self.servers.clear();
        if self.profile.consumes_heartbeats {
            self.consumers = Consumers::read(&self.objects, &self.behaviour, now);
        }
        if self.profile.complete {
            self.read_servers();
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

    /// Reads what servers there are; each works where both its COB-IDs are valid.
    fn read_servers(&mut self) {
        let parameters = self.objects.iter().map(|(address, _)| address);
        let parameters = parameters.filter(|address| address.sub() == 0);
        let indexes: Vec<u16> = parameters
            .map(Address::index)
            .filter(|index| ADDITIONAL_SERVERS.contains(index))
            .collect();
        self.servers = indexes
            .into_iter()
            .map(|index| self.read_server(index))
            .collect();
    }

    fn read_server(&self, index: u16) -> AdditionalServer {
        let cob_id = |sub| {
            let cob_id = self.objects.number(Address::new(index, sub))?;
            let valid = cob_id & pdo::INVALID == 0 || !self.behaviour.sdo.servers_off;
            u16::try_from(cob_id & 0x7FF).ok().filter(|_| valid)
        };
        let (request, response) = (cob_id(1), cob_id(2));
        AdditionalServer {
            index,
            request: request.filter(|_| response.is_some()),
            server: Server::answering_on(response),
        }
    }

    /// The parameters at `index` have changed.
    pub(super) fn reconfigure_server(&mut self, index: u16) {
        if !self.behaviour.sdo.servers_follow {
            return;
        }
        let read = self.read_server(index);
        let mut servers = self.servers.iter_mut();
        if let Some(server) = servers.find(|server| server.index == index) {
            *server = read;
        }
    }

    /// The place of the server that is asked under this identifier.
    pub(super) fn server_of(&self, raw: u16) -> Option<usize> {
        let mut servers = self.servers.iter();
        servers.position(|server| server.request == Some(raw))
    }

    pub(super) fn servers_state(&self) -> impl Iterator<Item = (StateName, StateValue)> {
        self.servers.iter().map(|one| {
            let name = StateName::Hexadecimal("sdo ", one.index);
            (name, one.server.name().into())
        })
    }

    /// When one of them wants to be woken.
    pub(super) fn servers_due(&self) -> Option<Instant> {
        let servers = self.servers.iter();
        servers.filter_map(|server| server.server.deadline()).min()
    }

    /// Lets another SDO server do what `work` says in the place of the default one.
    pub(super) fn with_server(&mut self, place: usize, work: impl FnOnce(&mut Slave)) {
        self.exchange_server(place);
        work(self);
        self.exchange_server(place);
    }

    fn exchange_server(&mut self, place: usize) {
        let Some(other) = self.servers.get_mut(place) else {
            return;
        };
        if self.behaviour.sdo.servers_apart {
            std::mem::swap(&mut self.sdo, &mut other.server);
        } else {
            self.sdo.exchange_identifier(&mut other.server);
        }
    }
}
