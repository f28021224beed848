//! SYNC: taken, and produced where the device can.

use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::Instant;

use super::cob_id::is_restricted;
use super::queue::{Service, identifier};
use super::{Abort, Address, Application, Departures, Profile, Slave};

pub(super) const COB_ID: Address = Address::new(0x1005, 0);
pub(super) const CYCLE: Address = Address::new(0x1006, 0);
/// The synchronous window length.
pub(super) const WINDOW: Address = Address::new(0x1007, 0);
pub(super) const OVERFLOW: Address = Address::new(0x1019, 0);
const DEFAULT_IDENTIFIER: u16 = 0x080;
/// Bit 30 of 1005h: the device produces SYNC.
const PRODUCES: u32 = 1 << 30;

/// Whether `value` may be written to 1005h, which holds `present`.
///
/// # Errors
/// A 29-bit or reserved identifier, an identifier changed while SYNC is produced, or production by a device that
/// cannot.
pub(super) fn check(
    profile: &Profile,
    departs: &Departures,
    present: u32,
    value: u32,
) -> Result<(), Abort> {
    let identifier = value & !PRODUCES & !(1 << 31);
    if is_restricted(identifier, departs) || (value & PRODUCES != 0 && !profile.produces_sync) {
        return Err(Abort::INVALID_VALUE);
    }
    let changes = present & value & PRODUCES != 0 && present != value;
    if changes && !departs.sync_identifier_unprotected {
        return Err(Abort::DEVICE_STATE);
    }
    Ok(())
}

/// Whether `value` may be written to 1019h while 1006h holds `period`.
///
/// # Errors
/// 1 and what is above 240 are reserved; while there is a period the counter stays as it is.
pub(super) fn check_overflow(departs: &Departures, period: u32, value: u32) -> Result<(), Abort> {
    let taken = match value {
        0 | 2..=127 => true,
        1 => departs.counter_of_1_taken,
        128..=240 => !departs.counter_above_127_refused,
        _ => false,
    };
    if !taken {
        Err(Abort::INVALID_VALUE)
    } else if period != 0 && !departs.counter_unprotected {
        Err(Abort::DEVICE_STATE)
    } else {
        Ok(())
    }
}

/// A shorter cycle period is kept as this one: no bus carries more.
const SHORTEST_PERIOD: Duration = Duration::from_micros(200);

/// What a slave knows of SYNC.
#[derive(Debug, Default)]
pub(super) struct Sync {
    pub(super) identifier: Option<u16>,
    period: Duration,
    /// What is sent later than this after a SYNC is not sent at all.
    window: Option<Duration>,
    /// When it produces the next one.
    pub(super) next: Option<Instant>,
    /// The highest counter of a SYNC; 0: it has none.
    pub(super) overflow: u8,
    /// That of the last SYNC produced.
    pub(super) counter: u8,
}

impl Slave {
    /// Reads 1005h, 1006h, 1007h and 1019h again.
    pub(super) fn reconfigure_sync(&mut self, now: Instant) {
        let departs = &self.behaviour.departs;
        let cob_id = self.objects.number(COB_ID);
        let count = self.objects.number(CYCLE).unwrap_or(0);
        let low = |cob_id: u32| u16::try_from(cob_id & 0x7FF).ok();
        self.sync.identifier = if departs.sync_identifier_fixed {
            Some(DEFAULT_IDENTIFIER)
        } else {
            cob_id.and_then(low)
        };
        let unit = if departs.sync_period_in_10_us { 10 } else { 1 };
        let outlives = departs.sync_outlives_period && self.sync.next.is_some();
        if count != 0 || !outlives {
            let period = Duration::from_micros(u64::from(count) * unit);
            self.sync.period = period.max(SHORTEST_PERIOD);
        }
        let asked = cob_id.is_some_and(|cob_id| cob_id & PRODUCES != 0);
        let goes_on = self.sync.next.is_some() && !self.behaviour.sync_can_be_stopped;
        let produces = (asked || goes_on) && (count != 0 || outlives);
        if self.sync.next.is_none() {
            self.sync.counter = 0;
        }
        let delay = if self.behaviour.manners.first_sync_at_once {
            Duration::ZERO
        } else if departs.sync_starts_late {
            5 * self.sync.period
        } else {
            self.sync.period
        };
        self.sync.next = produces.then(|| now + delay);
        let overflow = self.objects.number(OVERFLOW).unwrap_or(0);
        self.sync.overflow = overflow.to_le_bytes()[0];
        let window = u64::from(self.objects.number(WINDOW).unwrap_or(0));
        let window = if departs.sync_window_in_ns {
            Duration::from_nanos(window)
        } else {
            Duration::from_micros(window)
        };
        self.sync.window = (!window.is_zero()).then_some(window);
    }

    /// What 1005h to 1019h hold after a reset counts from now on.
    pub(super) fn start_sync(&mut self, now: Instant) {
        self.reconfigure_sync(now);
        if self.behaviour.departs.sync_rests_after_reset {
            self.sync.next = None;
        }
    }

    /// Whether what is sent so long after a SYNC belongs to it no more.
    pub(super) fn window_has_passed(&self, after: Duration) -> bool {
        self.sync.window.is_some_and(|window| after > window)
    }

    /// A SYNC has come: with a counter, or without one, as 1019h says.
    pub(super) fn receive_sync(
        &mut self,
        now: Instant,
        frame: &Frame,
        application: &mut dyn Application,
    ) {
        let unchecked = !self.profile.complete || self.behaviour.departs.sync_length_unchecked;
        let counter = match (frame.bytes(), self.sync.overflow) {
            ([counter], 1..) => Some(*counter),
            ([], 0) => None,
            _ if unchecked => None,
            _ => return self.report(now, super::emergency::SYNC_LENGTH),
        };
        self.synchronise(now, counter, application);
    }

    /// A SYNC was received or sent.
    fn synchronise(
        &mut self,
        now: Instant,
        counter: Option<u8>,
        application: &mut dyn Application,
    ) {
        if self.state.permits(Service::Pdo, &self.behaviour) {
            self.actuate_pdos(now, application);
            self.notice_changes();
            self.synchronise_tpdos(now, counter);
        }
    }

    /// The counter of the next SYNC, from 1 to 1019h.
    fn count_sync(&mut self) -> Option<u8> {
        let before = self.sync.counter.checked_rem(self.sync.overflow)?;
        self.sync.counter = before + 1;
        if self.behaviour.departs.counter_from_0 {
            return Some(before);
        }
        Some(self.sync.counter)
    }

    pub(super) fn produce_sync(&mut self, now: Instant, application: &mut dyn Application) {
        let Some(due) = self.sync.next.filter(|due| *due <= now) else {
            return;
        };
        self.sync.next = Some((due + self.sync.period).max(now));
        if !self.state.permits(Service::Sync, &self.behaviour) {
            return;
        }
        let counter = self.count_sync();
        let shown = counter.filter(|_| self.behaviour.sync_counter_sent);
        let data = shown.as_slice();
        let raw = self.sync.identifier;
        if let Some(frame) = raw.and_then(|raw| Frame::data(identifier(raw), data)) {
            self.queue.push(now, Service::Sync, frame);
            self.synchronise(now, counter, application);
        }
    }
}
