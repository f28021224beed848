//! Heartbeat and node guarding.

use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::Instant;

use super::emergency::LIFE_GUARDING;
use super::queue::{Service, identifier};
use super::{Address, Slave, State};

pub(super) const GUARD_TIME: Address = Address::new(0x100C, 0);
pub(super) const LIFE_TIME_FACTOR: Address = Address::new(0x100D, 0);
/// What follows a communication error: 0 Pre-operational out of Operational, 1 nothing, 2 Stopped.
const ERROR_BEHAVIOUR: Address = Address::new(0x1029, 1);
pub(super) const PRODUCER_TIME: Address = Address::new(0x1017, 0);

/// Heartbeat producer and guarded slave.
#[derive(Debug, Default)]
pub(super) struct ErrorControl {
    heartbeat_period: Duration,
    heartbeat: Option<Instant>,
    /// The toggle bit of the next guarding answer.
    toggle: bool,
    /// When the master is lost, once it has begun to guard.
    guarded_until: Option<Instant>,
    lost: bool,
}

impl ErrorControl {
    pub(super) fn due(&self) -> Option<Instant> {
        [self.heartbeat, self.guarded_until]
            .into_iter()
            .flatten()
            .min()
    }
}

impl Slave {
    /// After a reset of the communication: nothing guards, the heartbeat begins with the boot-up message.
    pub(super) fn start_error_control(&mut self, now: Instant) {
        self.error_control = ErrorControl::default();
        self.start_heartbeat(now, false);
    }

    /// 1017h was written.
    pub(super) fn reconfigure_heartbeat(&mut self, now: Instant) {
        self.start_heartbeat(now, self.behaviour.heartbeat_on_write);
    }

    fn start_heartbeat(&mut self, now: Instant, at_once: bool) {
        let period = self.objects.number(PRODUCER_TIME).unwrap_or(0);
        let period = Duration::from_millis(u64::from(period));
        if period.is_zero() && !self.behaviour.heartbeat_can_be_stopped {
            return;
        }
        let first = if at_once { now } else { now + period };
        self.error_control.heartbeat_period = period;
        self.error_control.heartbeat = (!period.is_zero()).then_some(first);
    }

    pub(super) fn wake_error_control(&mut self, now: Instant) {
        let control = &mut self.error_control;
        if let Some(due) = control.heartbeat.filter(|due| *due <= now) {
            control.heartbeat = Some((due + control.heartbeat_period).max(now));
            self.send_state(now, 0);
        }
        let control = &mut self.error_control;
        if control.guarded_until.is_some_and(|until| until <= now) {
            control.guarded_until = None;
            if !self.behaviour.lost_master_noticed {
                return;
            }
            control.lost = true;
            self.set_error(now, LIFE_GUARDING, true);
            self.communication_failed();
        }
    }

    /// A communication error: what 1029h says of it follows once the EMCY is on its way.
    pub(super) fn communication_failed(&mut self) {
        if !self.profile.complete || !self.behaviour.error_behaviour_kept {
            return;
        }
        self.consequence = match self.objects.number(ERROR_BEHAVIOUR) {
            Some(0) if self.state == State::Operational => Some(State::PreOperational),
            Some(2) => Some(State::Stopped),
            _ => None,
        };
    }

    /// A remote frame on the identifier of error control. A node with a heartbeat is not guarded.
    pub(super) fn guard(&mut self, now: Instant) {
        if !self.profile.guarding || self.error_control.heartbeat.is_some() {
            return;
        }
        let toggle = self.error_control.toggle;
        self.error_control.toggle = !toggle && self.behaviour.guarding_toggles;
        let at = now + self.turnaround();
        self.send_state(at, u8::from(toggle) << 7);
        let number = |address| u64::from(self.objects.number(address).unwrap_or(0));
        let life_time = Duration::from_millis(number(GUARD_TIME) * number(LIFE_TIME_FACTOR));
        self.error_control.guarded_until = (!life_time.is_zero()).then(|| now + life_time);
        if std::mem::take(&mut self.error_control.lost) {
            self.set_error(now, LIFE_GUARDING, false);
        }
    }

    /// Guarding without a life time is not supervised.
    pub(super) fn reconfigure_guarding(&mut self) {
        self.error_control.guarded_until = None;
    }

    fn send_state(&mut self, at: Instant, toggle: u8) {
        let byte = self.state.code(&self.behaviour) | toggle;
        let identifier = identifier(0x700 + u16::from(self.node));
        if let Some(frame) = Frame::data(identifier, &[byte]) {
            self.queue.push(at, Service::ErrorControl, frame);
        }
    }
}
