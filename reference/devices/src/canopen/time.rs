//! TIME: taken and produced, and the clock of the device.

use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::Instant;

use super::queue::{Service, identifier};
use super::{Abort, Address, Application, Departures, Profile, Slave, cob_id};

pub(super) const COB_ID: Address = Address::new(0x1012, 0);
/// Bit 31 of 1012h: the device takes TIME.
const CONSUMES: u32 = 1 << 31;
/// Bit 30 of 1012h: the device produces TIME.
const PRODUCES: u32 = 1 << 30;
const DEFAULT_IDENTIFIER: u16 = 0x100;
/// CiA 301 sets no period.
const PERIOD: Duration = Duration::from_secs(1);
const MILLISECONDS_A_DAY: u64 = 24 * 60 * 60 * 1000;

/// A TIME_OF_DAY.
///
/// | byte | holds |
/// | --- | --- |
/// | 0 to 3 | milliseconds after midnight, 28 bits |
/// | 4, 5 | days since the first of January 1984 |
type TimeOfDay = [u8; 6];

/// What a slave knows of the time.
#[derive(Debug, Default)]
pub(super) struct Clock {
    identifier: Option<u16>,
    consumes: bool,
    /// When it produces the next TIME.
    pub(super) next: Option<Instant>,
    /// The time it was set to, and when; at a reset it is set to 0.
    set: (Instant, TimeOfDay),
}

/// Whether `value` may be written to 1012h, which holds `present`.
///
/// # Errors
/// Bits 30 and 31 in a device that neither takes nor produces TIME; the rules of every COB-ID.
pub(super) fn check(
    profile: &Profile,
    departs: &Departures,
    (present, value): (u32, u32),
) -> Result<(), Abort> {
    if !profile.complete && in_use(value) {
        return Err(Abort::INVALID_VALUE);
    }
    let protected = !departs.time_identifier_unprotected;
    cob_id::check((present, value), in_use, protected, departs)
}

/// Whether the COB-ID is in use.
fn in_use(cob_id: u32) -> bool {
    cob_id & (CONSUMES | PRODUCES) != 0
}

/// `time`, and so much later.
fn later(time: TimeOfDay, by: Duration) -> TimeOfDay {
    let [m0, m1, m2, m3, d0, d1] = time;
    let milliseconds = u64::from(u32::from_le_bytes([m0, m1, m2, m3 & 0x0F]));
    let days = u64::from(u16::from_le_bytes([d0, d1]));
    let passed = u64::try_from(by.as_millis()).unwrap_or(0);
    let total = days * MILLISECONDS_A_DAY + milliseconds + passed;
    let [m0, m1, m2, m3, ..] = (total % MILLISECONDS_A_DAY).to_le_bytes();
    let [d0, d1, ..] = (total / MILLISECONDS_A_DAY).to_le_bytes();
    [m0, m1, m2, m3, d0, d1]
}

impl Slave {
    /// Reads 1012h again.
    pub(super) fn reconfigure_time(&mut self, now: Instant) {
        let departs = &self.behaviour.departs;
        let Some(cob_id) = self
            .objects
            .number(COB_ID)
            .filter(|_| self.profile.complete)
        else {
            return;
        };
        self.clock.identifier = if departs.time_identifier_fixed {
            Some(DEFAULT_IDENTIFIER)
        } else {
            u16::try_from(cob_id & 0x7FF).ok()
        };
        self.clock.consumes = cob_id & CONSUMES != 0 || departs.time_always_taken;
        let goes_on = departs.time_not_stopped && self.clock.next.is_some();
        let produces = cob_id & PRODUCES != 0 || goes_on;
        self.clock.next = produces.then(|| self.clock.next.unwrap_or(now + PERIOD));
    }

    pub(super) fn takes_time(&self, raw: u16) -> bool {
        self.clock.consumes && self.clock.identifier == Some(raw)
    }

    /// A TIME has come: the clock goes on from there, and the object that shows it shows what came.
    pub(super) fn receive_time(
        &mut self,
        now: Instant,
        frame: &Frame,
        application: &mut dyn Application,
    ) {
        let mut time = TimeOfDay::default();
        let unchecked = self.behaviour.departs.time_length_unchecked;
        if frame.len() != time.len() && !unchecked {
            return;
        }
        let places = time.iter_mut().zip(frame.bytes());
        places.for_each(|(to, from)| *to = *from);
        if !self.state.permits(Service::Time, &self.behaviour) || !self.behaviour.time_taken {
            return;
        }
        if let Some(address) = self.profile.clock_object {
            self.objects.set(address, &time);
            application.written(address, &mut self.objects);
            self.set_clock(now);
        }
    }

    /// The object that shows the clock was set.
    pub(super) fn set_clock(&mut self, now: Instant) {
        let shown = self
            .profile
            .clock_object
            .and_then(|address| self.objects.get(address));
        let time = shown.and_then(|object| TimeOfDay::try_from(object.value()).ok());
        self.clock.set = (now, time.unwrap_or_default());
    }

    pub(super) fn produce_time(&mut self, now: Instant) {
        let Some(due) = self.clock.next.filter(|due| *due <= now) else {
            return;
        };
        self.clock.next = Some((due + PERIOD).max(now));
        if !self.state.permits(Service::Time, &self.behaviour) {
            return;
        }
        let (set_at, time) = self.clock.set;
        let departs = &self.behaviour.departs;
        let passed = now.since(set_at);
        let passed = if departs.time_stands_still {
            Duration::ZERO
        } else {
            passed
        };
        let mut bytes = [0; 8];
        let length = if departs.time_of_eight_bytes { 8 } else { 6 };
        let places = bytes.iter_mut().zip(later(time, passed));
        places.for_each(|(to, from)| *to = from);
        let raw = self.clock.identifier.unwrap_or(0);
        let bytes = bytes.get(..length).unwrap_or(&bytes);
        if let Some(frame) = Frame::data(identifier(raw), bytes) {
            self.queue.push(now, Service::Time, frame);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn midnight_begins_a_day() {
        let before = [0xFF, 0x5B, 0x26, 0x05, 0x01, 0x00];
        let after = [0x00, 0x00, 0x00, 0x00, 0x02, 0x00];
        assert_eq!(later(before, Duration::from_millis(1)), after);
        assert_eq!(later(after, Duration::ZERO), after);
    }
}
