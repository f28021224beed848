//! SYNC: taken, and produced where the device can.

use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::Instant;

use super::queue::{Service, identifier};
use super::{Abort, Address, Application, Profile, Slave};

pub(super) const COB_ID: Address = Address::new(0x1005, 0);
pub(super) const CYCLE: Address = Address::new(0x1006, 0);
/// Bit 30 of 1005h: the device produces SYNC.
const PRODUCES: u32 = 1 << 30;

/// Whether `value` may be written to 1005h, which holds `present`.
///
/// # Errors
/// A 29-bit or reserved identifier, an identifier changed while SYNC is produced, or production by a device that
/// cannot.
pub(super) fn check(profile: &Profile, present: u32, value: u32) -> Result<(), Abort> {
    let identifier = value & !PRODUCES & !(1 << 31);
    let restricted = matches!(
        identifier,
        0x000..=0x07F | 0x101..=0x180 | 0x581..=0x5FF | 0x601..=0x67F | 0x6E0..
    );
    if restricted || (value & PRODUCES != 0 && !profile.produces_sync) {
        return Err(Abort::INVALID_VALUE);
    }
    if present & value & PRODUCES != 0 && present != value {
        return Err(Abort::DEVICE_STATE);
    }
    Ok(())
}

/// A shorter cycle period is kept as this one: no bus carries more.
const SHORTEST_PERIOD: Duration = Duration::from_micros(200);

/// What a slave knows of SYNC.
#[derive(Debug, Default)]
pub(super) struct Sync {
    pub(super) identifier: Option<u16>,
    period: Duration,
    /// When it produces the next one.
    pub(super) next: Option<Instant>,
}

impl Slave {
    /// Reads 1005h and 1006h again.
    pub(super) fn reconfigure_sync(&mut self, now: Instant) {
        let cob_id = self.objects.number(COB_ID);
        let period = self.objects.number(CYCLE).unwrap_or(0);
        let low = |cob_id: u32| u16::try_from(cob_id & 0x7FF).ok();
        self.sync.identifier = cob_id.and_then(low);
        self.sync.period = Duration::from_micros(u64::from(period)).max(SHORTEST_PERIOD);
        let asked = cob_id.is_some_and(|cob_id| cob_id & PRODUCES != 0);
        let goes_on = self.sync.next.is_some() && !self.behaviour.sync_can_be_stopped;
        let produces = (asked || goes_on) && period != 0;
        self.sync.next = produces.then(|| now + self.sync.period);
    }

    /// A SYNC was received or sent.
    pub(super) fn synchronise(&mut self, now: Instant, application: &mut dyn Application) {
        if self.state.permits(Service::Pdo, &self.behaviour) {
            self.actuate_pdos(now, application);
            self.notice_changes();
            self.synchronise_tpdos(now);
        }
    }

    pub(super) fn produce_sync(&mut self, now: Instant, application: &mut dyn Application) {
        let Some(due) = self.sync.next.filter(|due| *due <= now) else {
            return;
        };
        self.sync.next = Some((due + self.sync.period).max(now));
        if !self.state.permits(Service::Sync, &self.behaviour) {
            return;
        }
        let frame = self
            .sync
            .identifier
            .and_then(|raw| Frame::data(identifier(raw), &[]));
        if let Some(frame) = frame {
            self.queue.push(now, Service::Sync, frame);
            self.synchronise(now, application);
        }
    }
}
