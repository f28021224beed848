//! Heartbeat and node guarding.

use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::Instant;

use super::emergency::LIFE_GUARDING;
use super::queue::{Service, identifier};
use super::{Address, Behaviour, Slave, State};

pub(super) const GUARD_TIME: Address = Address::new(0x100C, 0);
pub(super) const LIFE_TIME_FACTOR: Address = Address::new(0x100D, 0);
/// What follows a communication error: 0 Pre-operational out of Operational, 1 nothing, 2 Stopped.
const ERROR_BEHAVIOUR: Address = Address::new(0x1029, 1);
pub(super) const PRODUCER_TIME: Address = Address::new(0x1017, 0);

/// Heartbeat producer and guarded slave.
#[derive(Debug, Default)]
pub(super) struct ErrorControl {
    /// The boot-up message is left out this time.
    pub(super) boots_silently: bool,
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

    /// As it is after a reset of the communication: nothing guards.
    pub(super) fn after_reset(&self, behaviour: &Behaviour) -> ErrorControl {
        let settings = &behaviour.error_control;
        ErrorControl {
            toggle: if settings.toggle_restarts {
                settings.first_toggle
            } else {
                self.toggle
            },
            ..ErrorControl::default()
        }
    }
}

impl Slave {
    /// With the boot-up message the heartbeat begins.
    pub(super) fn start_error_control(&mut self, now: Instant) {
        self.error_control = self.error_control.after_reset(&self.behaviour);
        let settings = &self.behaviour.error_control;
        if settings.stored_heartbeat_starts {
            self.start_heartbeat(now, settings.heartbeat_with_boot_up);
        }
    }

    /// 1017h was written.
    pub(super) fn reconfigure_heartbeat(&mut self, now: Instant) {
        let changed = self.error_control.heartbeat.is_some() && self.heartbeat_time() != 0;
        if !changed || self.behaviour.error_control.heartbeat_change_taken {
            self.start_heartbeat(now, self.behaviour.heartbeat_on_write);
        }
    }

    /// 1017h, in ms.
    fn heartbeat_time(&self) -> u32 {
        self.objects.number(PRODUCER_TIME).unwrap_or(0)
    }

    fn start_heartbeat(&mut self, now: Instant, at_once: bool) {
        let period = Duration::from_millis(u64::from(self.heartbeat_time()));
        let period = period * self.behaviour.error_control.heartbeat_percent / 100;
        if period.is_zero() && !self.behaviour.heartbeat_can_be_stopped {
            return;
        }
        let first = if at_once { now } else { now + period };
        self.error_control.heartbeat_period = period;
        self.error_control.heartbeat = (!period.is_zero()).then_some(first);
        if !period.is_zero() {
            self.error_control.guarded_until = None;
        }
    }

    pub(super) fn wake_error_control(&mut self, now: Instant) {
        let control = &mut self.error_control;
        if let Some(due) = control.heartbeat.filter(|due| *due <= now) {
            control.heartbeat = Some((due + control.heartbeat_period).max(now));
            let settings = &self.behaviour.error_control;
            let toggle = settings.heartbeat_toggles && control.toggle;
            control.toggle ^= settings.heartbeat_toggles;
            self.send_state(now, toggle, settings.heartbeat_length);
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

    /// A communication error: what 1029h says of it follows once the EMCY is on its way. Without 1029h it is as if that
    /// were 0.
    pub(super) fn communication_failed(&mut self) {
        if !self.behaviour.error_behaviour_kept {
            return;
        }
        let settings = &self.behaviour.error_control;
        let held = self.objects.number(ERROR_BEHAVIOUR).unwrap_or(0);
        let concerned = self.state == State::Operational || settings.error_behaviour_everywhere;
        self.consequence = match settings.error_behaviour_fixed.unwrap_or(held) {
            0 if concerned => Some(State::PreOperational),
            2 => Some(State::Stopped),
            _ => None,
        };
    }

    /// Whether a remote frame with this identifier is a guarding request to it.
    pub(super) fn is_guarded_by(&self, identifier: u16) -> bool {
        let any = self.behaviour.error_control.guarding_answers_for_any_node;
        identifier == 0x700 + u16::from(self.node) || (any && identifier >> 7 == 0x700 >> 7)
    }

    /// A remote frame on the identifier of error control. A node with a heartbeat is not guarded.
    pub(super) fn guard(&mut self, now: Instant, request: &Frame) {
        let settings = &self.behaviour.error_control;
        if !self.profile.guarding || (request.len() != 1 && !settings.guarding_answers_any_length) {
            return;
        }
        if settings.guarding_ends_heartbeat {
            self.error_control.heartbeat = None;
        }
        let beside_heartbeat = self.error_control.heartbeat.is_some();
        if beside_heartbeat && !settings.guarding_answered_beside_heartbeat {
            return;
        }
        let length = if settings.guarding_answer_as_long_as_request {
            request.len().max(1)
        } else {
            1
        };
        let toggle = self.error_control.toggle;
        self.error_control.toggle = !toggle && self.behaviour.guarding_toggles;
        let at = now + self.turnaround();
        self.send_state(at, toggle, length);
        if beside_heartbeat {
            return;
        }
        self.await_master(now);
        if std::mem::take(&mut self.error_control.lost) {
            self.set_error(now, LIFE_GUARDING, false);
        }
    }

    /// The master has a life time from now on. Guarding without one is not supervised.
    fn await_master(&mut self, now: Instant) {
        let settings = &self.behaviour.error_control;
        let number = |address| self.objects.number(address).unwrap_or(0);
        let factor = match number(LIFE_TIME_FACTOR) {
            0 if settings.life_time_needs_factor => 0,
            0 => 1,
            _ if !settings.life_time_factor_used => 1,
            factor => factor,
        };
        let life_time = Duration::from_millis(u64::from(number(GUARD_TIME)) * u64::from(factor));
        self.error_control.guarded_until = (!life_time.is_zero()).then(|| now + life_time);
    }

    /// 100Ch or 100Dh was written: the master is waited for from its next request on.
    pub(super) fn reconfigure_guarding(&mut self, now: Instant) {
        self.error_control.guarded_until = None;
        if !self.behaviour.error_control.life_time_waits_for_first {
            self.await_master(now);
        }
    }

    /// | byte | holds |
    /// | --- | --- |
    /// | 0 | state in bits 0 to 6; bit 7 alternates in the answers of guarding |
    fn send_state(&mut self, at: Instant, toggle: bool, length: usize) {
        if !self.state.permits(Service::ErrorControl, &self.behaviour) {
            return;
        }
        let mut bytes = [0; 8];
        bytes[0] = self.state.code(&self.behaviour) | u8::from(toggle) << 7;
        let identifier = identifier(0x700 + u16::from(self.node));
        let frame = bytes.get(..length);
        if let Some(frame) = frame.and_then(|bytes| Frame::data(identifier, bytes)) {
            self.queue.push(at, Service::ErrorControl, frame);
        }
    }
}
