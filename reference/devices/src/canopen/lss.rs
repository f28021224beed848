//! The LSS slave: node-ID and bit rate over the bus.

use fieldproof_can::Frame;
use fieldproof_link::Instant;

pub(super) use super::lss_services::BitTimingSwitch;
use super::queue::{Service, identifier};
use super::{Address, LssAbilities, NodeActivation, Slave};

/// Requests; answers are one below.
pub(super) const REQUEST: u16 = 0x7E5;
const ANSWER: u16 = 0x7E4;
pub(super) const IDENTITY: u16 = 0x1018;

/// Between power-on and the last match of its identity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum LssState {
    #[default]
    Waiting,
    /// So many parts of its identity were named in a row.
    Matching(u8),
    Configuration,
}

impl LssState {
    pub(super) const fn name(self) -> &'static str {
        match self {
            LssState::Waiting => "waiting",
            LssState::Matching(_) => "matching",
            LssState::Configuration => "configuration",
        }
    }
}

impl Slave {
    /// | byte | holds |
    /// | --- | --- |
    /// | 0 | command specifier |
    /// | 1 to 7 | what it needs, the rest reserved |
    pub(super) fn receive_lss(&mut self, now: Instant, frame: &Frame) {
        let Some(abilities) = self.profile.lss else {
            return;
        };
        let Ok(request) = <[u8; 8]>::try_from(frame.bytes()) else {
            return;
        };
        let [specifier, first, second, ..] = request;
        match specifier {
            0x04 => self.switch_global(now, first),
            0x40..=0x43 => self.switch_selective(now, specifier, &request),
            0x46..=0x4C | 0x51 if self.profile.complete => self.find(now, &request),
            _ if self.lss != LssState::Configuration => {}
            0x11 => self.configure_node(now, first),
            0x13 => self.configure_bit_rate(now, abilities, first, second),
            0x17 => {
                self.store_configuration();
                self.answer_lss(now, [0x17, 0, 0, 0, 0, 0, 0, 0]);
            }
            0x5A..=0x5D => self.inquire_identity(now, specifier),
            0x15 if self.profile.complete => {
                self.activate_bit_timing(now, u16::from_le_bytes([first, second]));
            }
            0x5E => self.answer_lss(now, [0x5E, self.node, 0, 0, 0, 0, 0, 0]),
            _ => {}
        }
    }

    fn switch_global(&mut self, now: Instant, mode: u8) {
        match mode {
            0 => {
                self.lss = LssState::Waiting;
                if !self.has_node() && self.pending_node <= 127 {
                    self.reset_communication(now);
                }
            }
            1 => self.lss = LssState::Configuration,
            _ => {}
        }
    }

    /// 40h vendor-ID, 41h product code, 42h revision number, 43h serial number, one after the other.
    fn switch_selective(&mut self, now: Instant, specifier: u8, request: &[u8; 8]) {
        let [_, named @ .., _, _, _] = request;
        let part = specifier - 0x40;
        let expected = match self.lss {
            LssState::Configuration => return,
            LssState::Waiting => 0,
            LssState::Matching(parts) => parts,
        };
        let own = self
            .objects
            .number(Address::new(IDENTITY, part + 1))
            .unwrap_or(0);
        let same =
            u32::from_le_bytes(*named) == own || (part == 3 && !self.behaviour.lss_serial_matters);
        let matches = same && (part == expected || part == 0);
        self.lss = match (matches, part) {
            (false, _) => LssState::Waiting,
            (true, 3) => LssState::Configuration,
            (true, _) => LssState::Matching(part + 1),
        };
        if self.lss == LssState::Configuration && self.behaviour.lss_selection_confirmed {
            self.answer_lss(now, [0x44, 0, 0, 0, 0, 0, 0, 0]);
        }
    }

    fn configure_node(&mut self, now: Instant, node: u8) {
        let valid = matches!(node, 1..=127 | 255);
        let refused = !valid && self.behaviour.lss_configuration_checked;
        self.answer_lss(now, [0x11, u8::from(refused), 0, 0, 0, 0, 0, 0]);
        if valid {
            self.pending_node = node;
            self.activate_pending_node();
        }
    }

    /// Where the behaviour does not wait for a reset.
    pub(super) fn activate_pending_node(&mut self) {
        if self.behaviour.node_activation == NodeActivation::AtOnce && self.pending_node <= 127 {
            self.take_node(self.pending_node);
        }
    }

    fn configure_bit_rate(
        &mut self,
        now: Instant,
        abilities: LssAbilities,
        selector: u8,
        index: u8,
    ) {
        let rate = abilities.bit_rates.get(usize::from(index));
        let reserved = 0;
        let rate = rate.filter(|rate| {
            **rate != reserved && selector == 0 && self.behaviour.lss_refused_index != Some(index)
        });
        let refused = rate.is_none() && self.behaviour.lss_configuration_checked;
        self.answer_lss(now, [0x13, u8::from(refused), 0, 0, 0, 0, 0, 0]);
        if let Some(rate) = rate {
            self.pending_bit_rate = *rate;
        }
    }

    fn store_configuration(&mut self) {
        if !self.behaviour.lss_stores {
            return;
        }
        self.memory.node = self.pending_node;
        self.memory.bit_rate = self.pending_bit_rate;
        self.show_configuration();
    }

    fn inquire_identity(&mut self, now: Instant, specifier: u8) {
        let sub = specifier - 0x59;
        let number = self
            .objects
            .number(Address::new(IDENTITY, sub))
            .unwrap_or(0);
        let answered = match specifier {
            0x5C => self.behaviour.lss_revision_specifier,
            other => other,
        };
        let [b0, b1, b2, b3] = if self.behaviour.lss_identity_big_endian {
            number.to_be_bytes()
        } else {
            number.to_le_bytes()
        };
        self.answer_lss(now, [answered, b0, b1, b2, b3, 0, 0, 0]);
    }

    pub(super) fn answer_lss(&mut self, now: Instant, answer: [u8; 8]) {
        let at = now + self.turnaround();
        let frame = Frame::of_eight(identifier(ANSWER), answer);
        self.queue.push(at, Service::Lss, frame);
    }
}
