//! EMCY, error register and error history, as far as the devices need them.

use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::Instant;

use super::pdo::INVALID;
use super::queue::{Service, identifier};
use super::{Address, Slave};

const ERROR_REGISTER: Address = Address::new(0x1001, 0);
/// The predefined error field.
pub(super) const ERROR_HISTORY: u16 = 0x1003;
pub(super) const COB_ID: Address = Address::new(0x1014, 0);
const INHIBIT_TIME: Address = Address::new(0x1015, 0);

/// EMCY of node 0, if there were one.
const FIRST_IDENTIFIER: u16 = 0x080;
/// The bits of the error register for any error, and for one of communication.
const GENERIC_ERROR: u8 = 0x01;
const COMMUNICATION_ERROR: u8 = 0x11;
/// How long a slow slave takes for an EMCY, and a wrong one until it sends it again.
const LATE: Duration = Duration::from_millis(20);
const REPEATED_AFTER: Duration = Duration::from_millis(100);

/// An error that comes and goes: its code and its bit of the error register.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct DeviceError {
    pub(crate) code: u16,
    pub(crate) register_bit: u8,
}

/// What a slave knows of its errors.
#[derive(Debug, Default)]
pub(super) struct Errors {
    /// Those that have begun and not ended.
    active: Vec<DeviceError>,
    /// When the last EMCY was due.
    last: Option<Instant>,
}

/// Device hardware.
pub(crate) const HARDWARE: DeviceError = DeviceError {
    code: 0x5000,
    register_bit: 0x01,
};
/// Life guarding.
pub(super) const LIFE_GUARDING: DeviceError = DeviceError {
    code: 0x8130,
    register_bit: 0x10,
};
/// A SYNC has a counter and should not, or the other way round.
pub(super) const SYNC_LENGTH: DeviceError = DeviceError {
    code: 0x8240,
    register_bit: 0,
};
/// An RPDO did not come within its event timer.
pub(super) const RPDO_TIMEOUT: DeviceError = DeviceError {
    code: 0x8250,
    register_bit: 0,
};
/// A PDO of which only the first bytes were used.
pub(super) const PDO_TOO_LONG: DeviceError = DeviceError {
    code: 0x8220,
    register_bit: 0,
};
/// A PDO not processed due to its length.
pub(super) const PDO_TOO_SHORT: DeviceError = DeviceError {
    code: 0x8210,
    register_bit: 0,
};

impl Slave {
    /// Reports an error that has no end.
    pub(super) fn report(&mut self, now: Instant, error: DeviceError) {
        self.remember(error.code);
        let shown = self.behaviour.manners.passing_errors_shown && error.register_bit == 0;
        let register = if shown { COMMUNICATION_ERROR } else { 0 };
        self.send_emergency(now, error.code, register);
    }

    /// An error begins or ends.
    pub(crate) fn set_error(&mut self, now: Instant, error: DeviceError, active: bool) {
        let known = &mut self.errors.active;
        if active {
            known.push(error);
        } else if let Some(place) = known.iter().position(|known| *known == error) {
            known.remove(place);
        }
        let bits = known
            .iter()
            .fold(0, |bits, error| bits | GENERIC_ERROR | error.register_bit);
        let departs = &self.behaviour.departs;
        if !departs.error_register_blind && (active || !departs.error_register_stuck) {
            self.objects.set_number(ERROR_REGISTER, i64::from(bits));
        }
        if active {
            self.report(now, error);
        } else if self.behaviour.error_end_reported {
            self.send_emergency(now, 0, 0);
        }
    }

    /// The newest error is first; as many are kept as the dictionary has places.
    fn remember(&mut self, code: u16) {
        if !self.behaviour.errors_remembered {
            return;
        }
        let place = |sub| Address::new(ERROR_HISTORY, sub);
        let count = self.objects.number(place(0)).unwrap_or(0);
        let Ok(count) = u8::try_from(count) else {
            return;
        };
        let places = (1..=254).take_while(|sub| self.objects.get(place(*sub)).is_some());
        let kept = places.count().min(usize::from(count) + 1);
        let Ok(kept) = u8::try_from(kept) else { return };
        let newest = if self.behaviour.departs.errors_appended {
            kept
        } else {
            for sub in (2..=kept).rev() {
                let older = self.objects.number(place(sub - 1)).unwrap_or(0);
                self.objects.set_number(place(sub), i64::from(older));
            }
            1
        };
        self.objects.set_number(place(newest), i64::from(code));
        self.objects.set_number(place(0), i64::from(kept));
    }

    /// Clears 1003h.
    pub(super) fn forget_errors(&mut self) {
        if !self.behaviour.errors_can_be_cleared {
            return;
        }
        let last = if self.behaviour.departs.cleared_errors_stay {
            0
        } else {
            254
        };
        for sub in 0..=last {
            self.objects.set_number(Address::new(ERROR_HISTORY, sub), 0);
        }
    }

    /// Whether `address` is a place of 1003h that holds no error, and cannot be read for that.
    pub(super) fn is_empty_place(&self, address: Address) -> bool {
        let count = self.objects.number(Address::new(ERROR_HISTORY, 0));
        self.behaviour.manners.empty_places_refused
            && !self.behaviour.departs.cleared_errors_stay
            && address.index() == ERROR_HISTORY
            && u32::from(address.sub()) > count.unwrap_or(0)
    }

    /// When the next EMCY may leave: 1015h counts 100 us.
    fn uninhibited(&mut self, now: Instant) -> Instant {
        let count = self.objects.number(INHIBIT_TIME).unwrap_or(0);
        let inhibit = Duration::from_micros(u64::from(count) * 100);
        let kept = self.behaviour.emergency_inhibit_kept;
        let now = if self.behaviour.manners.emergency_late {
            now + LATE
        } else {
            now
        };
        let earliest = self.errors.last.map(|last| last + inhibit);
        let at = earliest.filter(|_| kept).map_or(now, |at| at.max(now));
        self.errors.last = Some(at);
        at
    }

    /// | byte | holds |
    /// | --- | --- |
    /// | 0, 1 | error code, low byte first; 0 when an error has gone |
    /// | 2 | error register |
    /// | 3 to 7 | the manufacturer's, 0 |
    fn send_emergency(&mut self, now: Instant, code: u16, passing: u8) {
        let departs = &self.behaviour.departs;
        let Some(cob_id) = self
            .objects
            .number(COB_ID)
            .filter(|cob_id| cob_id & INVALID == 0 || departs.emergency_while_invalid)
        else {
            return;
        };
        if !self.state.permits(Service::Emergency, &self.behaviour) {
            return;
        }
        let register = self.objects.number(ERROR_REGISTER).unwrap_or(0);
        let register = if self.behaviour.emergency_shows_register {
            register.to_le_bytes()[0] | passing
        } else {
            0
        };
        let raw = if departs.emergency_identifier_fixed {
            FIRST_IDENTIFIER + u16::from(self.node)
        } else {
            u16::try_from(cob_id & 0x7FF).unwrap_or(0)
        };
        let length = if departs.emergency_cut { 3 } else { 8 };
        let times: &[Duration] = if departs.emergency_repeated {
            &[Duration::ZERO, REPEATED_AFTER]
        } else {
            &[Duration::ZERO]
        };
        let [low, high] = code.to_le_bytes();
        let data = [low, high, register, 0, 0, 0, 0, 0];
        let data = data.get(..length).unwrap_or(&data);
        if let Some(frame) = Frame::data(identifier(raw), data) {
            let at = self.uninhibited(now);
            for after in times {
                self.queue.push(at + *after, Service::Emergency, frame);
            }
        }
    }
}
