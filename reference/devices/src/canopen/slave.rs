//! The slave as a whole: what it holds, what arrives, when it wants to be woken, what a reset does.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::time::Duration;

use fieldproof_can::{Frame, Id};
use fieldproof_link::{Instant, Line, NotOffered, Outbox};

use super::consumers::Consumers;
use super::emergency::Errors;
use super::error_control::ErrorControl;
use super::lss::{self, BitTimingSwitch, LssState, LssWork, NO_NODE};
use super::memory::Memory;
use super::nmt::Command;
use super::objects::Objects;
use super::pdo::{self, Rpdo};
use super::pdo_rules::Parameter;
use super::queue::{Queue, Service, identifier};
use super::robustness::Strain;
use super::sdo::Server;
use super::services::AdditionalServer;
use super::sync::Sync;
use super::time::Clock;
use super::tpdo::{self, Tpdo};
use super::{Address, Application, Behaviour, Profile, State};

pub(super) const ALL: RangeInclusive<u16> = 0x0000..=0xFFFF;
const IDENTITY: u16 = 0x1018;

/// A CANopen slave on one CAN port.
#[derive(Debug)]
pub(crate) struct Slave {
    pub(crate) objects: Objects,
    pub(super) profile: Profile,
    pub(super) behaviour: Behaviour,
    pub(super) state: State,
    pub(super) lss: LssState,
    pub(super) node: u8,
    pub(super) pending_node: u8,
    pub(super) pending_bit_rate: u32,
    pub(super) memory: Memory,
    pub(super) queue: Queue,
    pub(super) sdo: Server,
    pub(super) sync: Sync,
    pub(super) error_control: ErrorControl,
    pub(super) errors: Errors,
    pub(super) consumers: Consumers,
    pub(super) clock: Clock,
    /// The state that follows a communication error.
    pub(super) consequence: Option<State>,
    /// A bit timing is being activated.
    pub(super) switch: Option<BitTimingSwitch>,
    pub(super) lss_work: LssWork,
    /// What the traffic has done to it.
    pub(super) strain: Strain,
    /// The SDO servers beside the default one.
    pub(super) servers: Vec<AdditionalServer>,
    pub(super) rpdos: Vec<Rpdo>,
    pub(super) tpdos: Vec<Tpdo>,
    pub(super) bit_rate: u32,
    pub(super) powered: bool,
    boot_at: Option<Instant>,
    chance: fastrand::Rng,
}

/// What a slave is at the factory.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Factory {
    pub(crate) node: u8,
    pub(crate) bit_rate: u32,
    pub(crate) seed: u64,
}

impl Slave {
    /// A slave that is powered on when the lane is opened.
    pub(crate) fn new(
        profile: Profile,
        behaviour: Behaviour,
        factory: Factory,
        application: &mut dyn Application,
    ) -> Slave {
        let memory = Memory {
            values: BTreeMap::new(),
            node: factory.node,
            bit_rate: factory.bit_rate,
        };
        let mut slave = Slave {
            objects: Objects::new(profile.dictionary, behaviour.object_fault),
            profile,
            behaviour,
            state: State::Initialising,
            lss: LssState::default(),
            node: factory.node,
            pending_node: factory.node,
            pending_bit_rate: factory.bit_rate,
            memory,
            queue: Queue::default(),
            sdo: Server::default(),
            sync: Sync::default(),
            error_control: ErrorControl::default(),
            errors: Errors::default(),
            consumers: Consumers::default(),
            clock: Clock::default(),
            consequence: None,
            switch: None,
            lss_work: LssWork::default(),
            strain: Strain::default(),
            servers: Vec::new(),
            rpdos: Vec::new(),
            tpdos: Vec::new(),
            bit_rate: factory.bit_rate,
            powered: false,
            boot_at: None,
            chance: fastrand::Rng::with_seed(factory.seed),
        };
        slave.power(Instant::START, true, application);
        slave
    }

    /// How it is set on its port.
    pub(crate) fn line(&self) -> Line {
        if self.powered {
            Line::Can {
                bit_rate: self.bit_rate,
            }
        } else {
            Line::Off
        }
    }

    /// `frame` arrived.
    pub(crate) fn receive(
        &mut self,
        now: Instant,
        frame: &Frame,
        application: &mut dyn Application,
    ) {
        if let Some(cut) = self.cut(frame) {
            return self.receive(now, &cut, application);
        }
        if !self.powered || self.boot_at.is_some() {
            return;
        }
        let mut frame = *frame;
        match frame.id() {
            Id::Extended(id) if id.raw() == 0 && self.behaviour.nmt.extended_identifier_taken => {
                frame = frame.with_id(identifier(0));
            }
            Id::Extended(id) if !self.behaviour.pdo.extended_frames_passed_over => {
                let [low, high, ..] = (id.raw() & 0x7FF).to_le_bytes();
                let identifier = u16::from_le_bytes([low, high]);
                return self.receive_pdo(now, identifier, &frame, application);
            }
            _ => {}
        }
        let Some(frame) = &self.bear(now, &frame, application) else {
            return;
        };
        let Some(id) = frame.standard_id() else {
            return;
        };
        let (raw, node) = (id.raw(), u16::from(self.node));
        if raw == lss::REQUEST {
            self.receive_lss(now, frame);
        } else if self.state == State::Initialising {
            // Without a node-ID there is LSS and nothing else.
        } else if raw == 0x600 + node || (raw == 0x601 + node && !self.behaviour.sdo.own_node_only)
        {
            self.serve(now, frame, application);
        } else if raw == 0 {
            if let Some(command) = Command::of(frame, self.node, &self.behaviour) {
                self.command(now, command, application);
            }
        } else if frame.is_remote() && self.is_guarded_by(raw) {
            self.guard(now, frame);
        } else if frame.is_remote() && !self.takes_for_sync(raw) {
            self.fetch_tpdo(now, raw);
        } else if self.sync.identifier == Some(raw) {
            self.receive_sync(now, frame, application);
        } else if let Some(place) = self.server_of(raw) {
            self.with_server(place, |slave| slave.serve(now, frame, application));
        } else if self.takes_time(raw) {
            self.receive_time(now, frame, application);
        } else if (0x701..=0x77F).contains(&raw) {
            self.hear(now, raw - 0x700, frame);
        } else {
            self.receive_pdo(now, raw, frame, application);
        }
        self.notice_changes();
    }

    /// When it wants to be woken.
    pub(crate) fn wake_at(&self) -> Option<Instant> {
        if !self.powered {
            return None;
        }
        let timers = [
            self.queue.next(),
            self.boot_at,
            self.error_control.due(),
            self.sync.next,
            self.tpdos_due(),
            self.sdo.deadline(),
            self.servers_due(),
            self.rpdos_due(),
            self.consumers.due(),
            self.clock.next,
            self.switch.as_ref().map(BitTimingSwitch::due),
        ];
        timers.into_iter().flatten().min()
    }

    /// The instant it asked for has come.
    pub(crate) fn wake(
        &mut self,
        now: Instant,
        port: usize,
        application: &mut dyn Application,
        out: &mut Outbox,
    ) {
        if !self.powered {
            return;
        }
        if self.boot_at.is_some_and(|at| at <= now) {
            self.boot(now);
        }
        self.wake_error_control(now);
        self.wake_sdo(now);
        for place in 0..self.servers.len() {
            self.with_server(place, |slave| slave.wake_sdo(now));
        }
        self.wake_consumers(now);
        self.wake_rpdos(now);
        self.produce_sync(now, application);
        self.produce_time(now);
        self.wake_tpdos(now);
        self.wake_switch(now);
        self.queue.flush(now, port, out);
        if let Some(state) = self.consequence.take() {
            self.enter(now, state);
        }
    }

    pub(crate) fn is_operational(&self) -> bool {
        self.state == State::Operational
    }

    /// The device has set values itself.
    pub(crate) fn values_changed(&mut self) {
        self.notice_changes();
    }

    /// Sets what the device measures: `name` is an object such as `6063:00`.
    ///
    /// # Errors
    /// [`NotOffered`]: there is no such object.
    pub(crate) fn set_process_value(&mut self, name: &str, value: i64) -> Result<(), NotOffered> {
        let address = Address::parse(name).ok_or(NotOffered)?;
        self.objects.find(address).map_err(|_| NotOffered)?;
        self.objects.set_number(address, value);
        self.notice_changes();
        Ok(())
    }

    /// Between a request and its answer.
    pub(super) fn turnaround(&mut self) -> Duration {
        Duration::from_micros(self.chance.u64(self.behaviour.response_us.clone()))
    }

    /// Power goes on or off.
    pub(crate) fn power(&mut self, now: Instant, on: bool, application: &mut dyn Application) {
        self.powered = on;
        self.strain = Strain::default();
        self.queue.clear();
        if on {
            self.error_control = ErrorControl::default();
            self.reset_node(now, ALL, application);
        } else {
            self.boot_at = None;
            self.state = State::Initialising;
            if self.behaviour.departs.stores_in_ram {
                self.memory.values.clear();
            }
        }
    }

    fn command(&mut self, now: Instant, command: Command, application: &mut dyn Application) {
        let settings = &self.behaviour.nmt;
        if settings.ignored == Some((self.state, command)) {
            return;
        }
        match command {
            Command::Enter(state) => {
                let boots = settings.boot_up_repeated && state == State::PreOperational;
                self.enter(now, state);
                if boots {
                    self.send_boot_up(now);
                }
            }
            _ if self.behaviour.departs.parameters_outlive_reset => self.initialise(now),
            Command::ResetNode => {
                let restored = settings.restored_by_reset_node.clone();
                self.reset_node(now, restored, application);
            }
            Command::ResetCommunication => {
                let silent = !settings.boot_up_after_reset_communication;
                self.reset_communication(now);
                self.error_control.boots_silently = silent;
            }
        }
    }

    fn enter(&mut self, now: Instant, state: State) {
        if state == self.state {
            return;
        }
        if self.state == State::Stopped && !self.behaviour.departs.counter_outlives_stopped {
            self.sync.counter = 0;
        }
        self.state = state;
        self.queue
            .retain(|service| state.permits(service, &self.behaviour));
        if state.permits(Service::Pdo, &self.behaviour) {
            self.start_tpdos(now);
            self.start_rpdos(now);
        } else {
            self.stop_rpdos();
        }
    }

    /// Everything as after power-on: what is in non-volatile memory, else the defaults.
    pub(super) fn reset_node(
        &mut self,
        now: Instant,
        restored: RangeInclusive<u16>,
        application: &mut dyn Application,
    ) {
        self.node = self.memory.node;
        self.pending_node = self.memory.node;
        self.bit_rate = self.memory.bit_rate;
        self.pending_bit_rate = self.memory.bit_rate;
        self.objects.load(restored, self.node, &self.memory.values);
        application.reset(&mut self.objects);
        self.initialise(now);
    }

    /// The communication part of it, with the node-ID that was configured.
    pub(super) fn reset_communication(&mut self, now: Instant) {
        if !self.behaviour.lss.node_waits_for_reset_node {
            self.node = self.pending_node;
        }
        let kept = self.kept_pdo_parameters();
        let restored = self.behaviour.nmt.restored_by_reset_communication.clone();
        self.objects.load(restored, self.node, &self.memory.values);
        for (address, value) in kept {
            self.objects.set(address, &value);
        }
        self.initialise(now);
    }

    /// The PDO parameters that reset communication leaves as they are: none in a right device.
    fn kept_pdo_parameters(&self) -> Vec<(Address, Vec<u8>)> {
        if self.behaviour.pdo.reset_restores {
            return Vec::new();
        }
        let parameters = self
            .objects
            .iter()
            .filter(|(address, _)| Parameter::of(address.index()).is_some());
        parameters
            .map(|(address, object)| (address, object.value().to_vec()))
            .collect()
    }

    /// What a device that does not keep to its EDS has in the place of its defaults.
    fn spoil_pdo_parameters(&mut self) {
        if !self.behaviour.pdo.default_mapping_right {
            for address in [Address::new(0x1600, 1), Address::new(0x1A00, 1)] {
                let entry = self.objects.number(address).unwrap_or(0);
                self.objects
                    .set_number(address, i64::from(entry + (entry & 0x3F)));
            }
        }
        if !self.behaviour.pdo.sub_indices_right {
            let counts = (0x1400..0x1408).chain(0x1800..0x1808);
            for address in counts.map(|index| Address::new(index, 0)) {
                self.objects.set_number(address, 32);
            }
        }
    }

    fn initialise(&mut self, now: Instant) {
        self.show_configuration();
        self.spoil_pdo_parameters();
        self.lose_identifiers();
        for (sub, number) in (1..).zip(self.behaviour.identity.into_iter().flatten()) {
            let address = Address::new(IDENTITY, sub);
            self.objects.set_number(address, i64::from(number));
        }
        for (first, second) in self.profile.twins {
            if let Some(number) = self.objects.number(*first) {
                self.objects.set_number(*second, i64::from(number));
            }
        }
        self.state = State::Initialising;
        if !self.behaviour.lss.configuration_survives_reset {
            self.lss = LssState::Waiting;
        }
        self.queue.clear();
        self.sdo.reset(&self.behaviour.sdo);
        self.sync = Sync::default();
        self.error_control = self.error_control.after_reset(&self.behaviour);
        self.initialise_services(now);
        self.rpdos = pdo::rpdos(&self.objects, &self.behaviour);
        self.tpdos = tpdo::tpdos(&self.objects, &self.behaviour);
        self.boot_at = self.has_node().then(|| now + self.profile.boot_time);
    }

    fn boot(&mut self, now: Instant) {
        self.boot_at = None;
        if self.behaviour.boot_up && !self.error_control.boots_silently {
            self.send_boot_up(now);
        }
        self.enter(now, State::PreOperational);
        self.start_error_control(now);
        self.start_sync(now);
        self.reconfigure_time(now);
        if self.behaviour.nmt.starts_itself {
            self.enter(now, State::Operational);
        }
    }

    /// | byte | holds |
    /// | --- | --- |
    /// | 0 | 0 |
    fn send_boot_up(&mut self, now: Instant) {
        let settings = &self.behaviour.nmt;
        let heartbeat = [State::PreOperational.code(&self.behaviour)];
        let before = settings.heartbeat_before_boot_up.then_some(heartbeat);
        let count = match settings.no_boot_up_at == Some(self.node) {
            true => 0,
            false => settings.boot_ups,
        };
        let boot_ups = (0..count).map(|_| [settings.boot_up_byte]);
        for bytes in before.into_iter().chain(boot_ups) {
            let frame = Frame::data(identifier(0x700 + u16::from(self.node)), &bytes);
            if let Some(frame) = frame {
                self.queue.push(now, Service::BootUp, frame);
            }
        }
    }

    pub(super) fn has_node(&self) -> bool {
        self.node != NO_NODE
    }

    /// Puts the node-ID and the bit-rate code of non-volatile memory where the dictionary shows them.
    pub(super) fn show_configuration(&mut self) {
        if let Some(address) = self.profile.node_object {
            self.objects
                .set_number(address, i64::from(self.memory.node));
        }
        if let (Some(address), Some(lss)) = (self.profile.bit_rate_object, self.profile.lss) {
            let code = lss
                .bit_rates
                .iter()
                .position(|rate| *rate == self.memory.bit_rate);
            if let Some(code) = code.and_then(|code| i64::try_from(code).ok()) {
                self.objects.set_number(address, code);
            }
        }
    }

    /// The node-ID changes with no reset: what depends on it and has its default follows.
    pub(super) fn take_node(&mut self, node: u8) {
        self.objects.readdress(self.node, node);
        self.node = node;
        self.rpdos = pdo::rpdos(&self.objects, &self.behaviour);
        self.tpdos = tpdo::tpdos(&self.objects, &self.behaviour);
    }

    /// A switch or a front panel sets the node-ID.
    ///
    /// # Errors
    /// [`NotOffered`]: it is none.
    pub(crate) fn set_node(&mut self, now: Instant, node: i64) -> Result<(), NotOffered> {
        let node = u8::try_from(node)
            .ok()
            .filter(|node| (1..=127).contains(node));
        let node = node.ok_or(NotOffered)?;
        self.memory.node = node;
        self.pending_node = node;
        self.take_node(node);
        self.show_configuration();
        if self.state.permits(Service::Pdo, &self.behaviour) {
            self.start_tpdos(now);
        }
        Ok(())
    }

    /// A switch or a front panel sets the bit rate, one of `rates`.
    ///
    /// # Errors
    /// [`NotOffered`]: it is none of them.
    pub(crate) fn set_bit_rate(&mut self, rate: i64, rates: &[u32]) -> Result<(), NotOffered> {
        let rate = u32::try_from(rate)
            .ok()
            .filter(|rate| *rate != 0 && rates.contains(rate));
        self.memory.bit_rate = rate.ok_or(NotOffered)?;
        self.pending_bit_rate = self.memory.bit_rate;
        self.bit_rate = self.memory.bit_rate;
        self.show_configuration();
        Ok(())
    }
}
