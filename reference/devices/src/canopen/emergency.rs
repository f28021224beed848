//! EMCY, error register and error history, as far as the devices need them.

use fieldproof_can::Frame;
use fieldproof_link::Instant;

use super::pdo::INVALID;
use super::queue::{Service, identifier};
use super::{Address, Slave};

const ERROR_REGISTER: Address = Address::new(0x1001, 0);
/// The predefined error field.
pub(super) const ERROR_HISTORY: u16 = 0x1003;
const COB_ID: Address = Address::new(0x1014, 0);

/// An error that comes and goes: its code and its bit of the error register.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct DeviceError {
    pub(crate) code: u16,
    pub(crate) register_bit: u8,
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
/// A PDO not processed due to its length.
pub(super) const PDO_TOO_SHORT: DeviceError = DeviceError {
    code: 0x8210,
    register_bit: 0,
};

impl Slave {
    /// Reports an error that has no end.
    pub(super) fn report(&mut self, now: Instant, error: DeviceError) {
        self.remember(error.code);
        self.send_emergency(now, error.code);
    }

    /// An error begins or ends.
    pub(crate) fn set_error(&mut self, now: Instant, error: DeviceError, active: bool) {
        let register = self.objects.number(ERROR_REGISTER).unwrap_or(0);
        let bits = u32::from(error.register_bit);
        let register = if active {
            register | bits
        } else {
            register & !bits
        };
        self.objects.set_number(ERROR_REGISTER, i64::from(register));
        if active {
            self.report(now, error);
        } else {
            self.send_emergency(now, 0);
        }
    }

    /// The newest error is first; as many are kept as the dictionary has places.
    fn remember(&mut self, code: u16) {
        let place = |sub| Address::new(ERROR_HISTORY, sub);
        let count = self.objects.number(place(0)).unwrap_or(0);
        let Ok(count) = u8::try_from(count) else {
            return;
        };
        let places = (1..=254).take_while(|sub| self.objects.get(place(*sub)).is_some());
        let kept = places.count().min(usize::from(count) + 1);
        let Ok(kept) = u8::try_from(kept) else { return };
        for sub in (2..=kept).rev() {
            let older = self.objects.number(place(sub - 1)).unwrap_or(0);
            self.objects.set_number(place(sub), i64::from(older));
        }
        self.objects.set_number(place(1), i64::from(code));
        self.objects.set_number(place(0), i64::from(kept));
    }

    /// Clears 1003h.
    pub(super) fn forget_errors(&mut self) {
        for sub in 0..=254 {
            self.objects.set_number(Address::new(ERROR_HISTORY, sub), 0);
        }
    }

    /// | byte | holds |
    /// | --- | --- |
    /// | 0, 1 | error code, low byte first; 0 when an error has gone |
    /// | 2 | error register |
    /// | 3 to 7 | the manufacturer's, 0 |
    fn send_emergency(&mut self, now: Instant, code: u16) {
        let Some(cob_id) = self
            .objects
            .number(COB_ID)
            .filter(|cob_id| cob_id & INVALID == 0)
        else {
            return;
        };
        if !self.state.permits(Service::Emergency, &self.behaviour) {
            return;
        }
        let [low, high] = code.to_le_bytes();
        let register = self
            .objects
            .number(ERROR_REGISTER)
            .unwrap_or(0)
            .to_le_bytes()[0];
        let register = if self.behaviour.emergency_shows_register {
            register
        } else {
            0
        };
        let raw = u16::try_from(cob_id & 0x7FF).unwrap_or(0);
        let frame = Frame::of_eight(identifier(raw), [low, high, register, 0, 0, 0, 0, 0]);
        self.queue.push(now, Service::Emergency, frame);
    }
}
