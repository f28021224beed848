//! LSS beyond selection and configuration: finding slaves, and activating a bit timing.

use std::time::Duration;

use fieldproof_link::Instant;

use super::lss::{IDENTITY, LssState};
use super::{Address, Slave};

/// The answer of a slave that is meant.
const FOUND: u8 = 0x4F;
/// The answer of a slave without node-ID that is meant.
const FOUND_WITHOUT_NODE: u8 = 0x50;
const NO_NODE: u8 = 255;
/// `BitChecked` of the request that begins a fastscan.
const SCAN_BEGINS: u8 = 128;

/// A bit rate that becomes another.
#[derive(Debug, Clone, Copy)]
pub(in crate::canopen) struct BitTimingSwitch {
    delay: Duration,
    /// When the bit rate changes, and when the slave may send again.
    at: Instant,
    changed: bool,
}

impl BitTimingSwitch {
    pub(super) fn due(&self) -> Instant {
        if self.changed {
            self.at + self.delay
        } else {
            self.at
        }
    }
}

impl Slave {
    /// 15h: the bit rate changes after the delay of `milliseconds`; from now to as long after that nothing is sent.
    pub(super) fn activate_bit_timing(&mut self, now: Instant, milliseconds: u16) {
        if !self.behaviour.lss_activates {
            return;
        }
        let delay = Duration::from_millis(u64::from(milliseconds));
        self.switch = Some(BitTimingSwitch {
            delay,
            at: now + delay,
            changed: false,
        });
    }

    /// Changes the bit rate when it is time; what became due meanwhile is not sent.
    pub(super) fn wake_switch(&mut self, now: Instant) {
        let Some(mut switch) = self.switch.take() else {
            return;
        };
        if !switch.changed && switch.at <= now {
            self.bit_rate = self.pending_bit_rate;
            switch.changed = true;
        }
        self.queue.drop_due(now);
        if !switch.changed || switch.due() > now {
            self.switch = Some(switch);
        }
    }

    /// The services by which a master finds slaves.
    ///
    /// | command specifier | bytes 1 to 4 |
    /// | --- | --- |
    /// | 46h, 47h | vendor-ID, product code |
    /// | 48h, 49h | lowest and highest revision number |
    /// | 4Ah, 4Bh | lowest and highest serial number |
    /// | 4Ch | nothing: every slave without node-ID is meant |
    /// | 51h | fastscan |
    pub(super) fn find(&mut self, now: Instant, request: &[u8; 8]) {
        let [specifier, named @ .., bit, part, next] = *request;
        match specifier {
            0x46..=0x4B => self.identify(now, specifier, u32::from_le_bytes(named)),
            0x4C if self.pending_node == NO_NODE => self.answer(now, FOUND_WITHOUT_NODE),
            0x51 => self.scan(now, u32::from_le_bytes(named), [bit, part, next]),
            _ => {}
        }
    }

    fn own(&self, part: u8) -> u32 {
        let address = Address::new(IDENTITY, part.saturating_add(1));
        self.objects.number(address).unwrap_or(0)
    }

    fn answer(&mut self, now: Instant, specifier: u8) {
        self.answer_lss(now, [specifier, 0, 0, 0, 0, 0, 0, 0]);
    }

    /// Six numbers, one after the other, between which the identity must be.
    fn identify(&mut self, now: Instant, specifier: u8, named: u32) {
        let step = specifier - 0x46;
        let fits = match step {
            0 => self.own(0) == named,
            1 => self.own(1) == named,
            2 => self.own(2) >= named,
            3 => self.own(2) <= named,
            4 => self.own(3) >= named || !self.behaviour.lss_identify_compares,
            _ => self.own(3) <= named || !self.behaviour.lss_identify_compares,
        };
        let expected = step == 0 || self.identified == step;
        self.identified = if fits && expected { step + 1 } else { 0 };
        if self.identified == 6 {
            self.identified = 0;
            self.answer(now, FOUND);
        }
    }

    /// Bit by bit, from the highest, through the four numbers of the identity.
    fn scan(&mut self, now: Instant, named: u32, [bit, part, next]: [u8; 3]) {
        let unconfigured = self.pending_node == NO_NODE && !self.has_node();
        let asked = unconfigured || !self.behaviour.lss_fastscan_unconfigured_only;
        if !asked || self.lss == LssState::Configuration {
            return;
        }
        if bit == SCAN_BEGINS {
            self.scanned = 0;
            return self.answer(now, FOUND);
        }
        if bit > 31 || part > 3 || next > 3 || part != self.scanned {
            return;
        }
        if (self.own(part) ^ named) >> bit != 0 {
            return;
        }
        if bit == 0 {
            self.scanned = next;
            if next < part {
                self.lss = LssState::Configuration;
            }
        }
        self.answer(now, FOUND);
    }
}
