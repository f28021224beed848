//! LSS beyond selection and configuration: finding slaves, and activating a bit timing.

use std::time::Duration;

use fieldproof_link::Instant;

use super::Slave;
use super::lss::{LssState, NO_NODE};

/// The answer of a slave that is meant.
const FOUND: u8 = 0x4F;
/// The answer of a slave without node-ID that is meant.
const FOUND_WITHOUT_NODE: u8 = 0x50;
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
        if !self.behaviour.lss.talks_while_switching {
            self.queue.drop_due(now);
        }
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
            0x46..=0x4B => self.identify(now, specifier - 0x46, u32::from_le_bytes(named)),
            0x4C if self.says_it_has_no_node() => self.answer_lss(now, &[FOUND_WITHOUT_NODE]),
            0x51 => self.scan(now, u32::from_le_bytes(named), [bit, part, next]),
            _ => {}
        }
    }

    fn says_it_has_no_node(&self) -> bool {
        let departs = &self.behaviour.lss;
        match self.pending_node == NO_NODE {
            true => !departs.unconfigured_silent,
            false => departs.unconfigured_with_node,
        }
    }

    /// Six numbers, one after the other, between which the identity must be.
    fn identify(&mut self, now: Instant, step: u8, named: u32) {
        let departs = &self.behaviour.lss;
        let (revision, serial) = (self.own(2), self.own(3));
        let strictly = departs.identify_bounds_exclusive;
        let within = |low: u32, high: u32| low < high || (low == high && !strictly);
        let fits = match step {
            0 => self.own(0) == named,
            1 => self.own(1) == named,
            2 => within(named, revision),
            3 => within(revision, named),
            4 => within(named, serial) || !self.behaviour.lss_identify_compares,
            _ => within(serial, named) || !self.behaviour.lss_identify_compares,
        };
        let fits = fits || departs.identify_step_ignored == Some(step);
        let work = &mut self.lss_work;
        let expected = step == 0 || work.identified == step || departs.identify_begins_anywhere;
        work.identified = if fits && expected { step + 1 } else { 0 };
        if work.identified == 6 {
            work.identified = 0;
            self.answer_lss(now, &[FOUND]);
        }
    }

    /// Bit by bit, from the highest, through the four numbers of the identity.
    fn scan(&mut self, now: Instant, named: u32, [bit, part, next]: [u8; 3]) {
        let departs = self.behaviour.lss.clone();
        let unconfigured = self.pending_node == NO_NODE && !self.has_node();
        let asked = unconfigured || !self.behaviour.lss_fastscan_unconfigured_only;
        let selected = self.lss == LssState::Configuration && !departs.scan_in_configuration;
        if !asked || selected {
            return;
        }
        if bit == SCAN_BEGINS {
            if !departs.scan_goes_on {
                self.lss_work.scanned = 0;
            }
            return self.answer_lss(now, &[FOUND]);
        }
        let in_turn = part == self.lss_work.scanned || departs.scan_part_ignored;
        if bit > 31 || part > 3 || next > 3 || !in_turn {
            return;
        }
        let lowest = if departs.scan_low_bits_compared {
            0
        } else {
            bit
        };
        if (self.own(part) ^ named) >> lowest != 0 && !departs.scan_number_ignored {
            return;
        }
        if bit == 0 {
            self.lss_work.scanned = next;
            if next < part && !departs.scan_does_not_select {
                self.lss = LssState::Configuration;
            }
        }
        self.answer_lss(now, &[FOUND]);
    }
}
