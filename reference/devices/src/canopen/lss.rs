//! The LSS slave: node-ID and bit rate over the bus.

use fieldproof_can::Frame;
use fieldproof_link::Instant;

pub(super) use super::lss_services::BitTimingSwitch;
use super::queue::{Service, identifier};
use super::{Address, LssAbilities, NodeActivation, Slave, State};

/// Requests; answers are one below.
pub(super) const REQUEST: u16 = 0x7E5;
const ANSWER: u16 = 0x7E4;
const IDENTITY: u16 = 0x1018;
/// The node-ID of a slave that has none.
pub(super) const NO_NODE: u8 = 255;

/// Between power-on and the last match of its identity.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum LssState {
    #[default]
    Waiting,
    /// So many parts of its identity were named in a row.
    Matching(u8),
    Configuration,
}

/// What an LSS slave remembers beside its state.
#[derive(Debug, Default)]
pub(super) struct LssWork {
    /// The numbers of an LSS address that have come, where they are compared at the end.
    named: [Option<u32>; 4],
    /// So many numbers by which slaves are to identify themselves have fitted in a row.
    pub(super) identified: u8,
    /// The part of the identity that a fastscan asks for.
    pub(super) scanned: u8,
    answers: u32,
    last_answer: [u8; 8],
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
        let Some(request) = self.lss_request(frame) else {
            return;
        };
        let [specifier, first, second, ..] = request;
        match specifier {
            0x04 => self.switch_global(now, first),
            0x40..=0x43 => self.switch_selective(now, specifier - 0x40, &request),
            0x46..=0x4C | 0x51 if self.profile.complete => self.find(now, &request),
            _ if !self.serves_lss(specifier) => {}
            0x11 => self.configure_node(now, first),
            0x13 => self.configure_bit_rate(now, abilities, first, second),
            0x17 => {
                self.store_configuration();
                if !self.behaviour.lss.store_unanswered {
                    self.say_whether(now, specifier, false);
                }
            }
            0x5A..=0x5D => self.inquire_identity(now, specifier),
            0x15 if self.profile.complete => {
                self.activate_bit_timing(now, u16::from_le_bytes([first, second]));
            }
            0x5E => self.inquire_node(now),
            _ if self.behaviour.lss.unknown_answered => self.say_whether(now, specifier, true),
            _ => {}
        }
    }

    fn lss_request(&self, frame: &Frame) -> Option<[u8; 8]> {
        let departs = &self.behaviour.lss;
        let silent = match self.state {
            State::Operational => departs.not_in_operational,
            State::Stopped => departs.not_in_stopped,
            State::Initialising | State::PreOperational => false,
        };
        if silent {
            return None;
        }
        if departs.short_requests_taken && !frame.is_remote() {
            let mut request = [0; 8];
            let bytes = request.iter_mut().zip(frame.bytes());
            bytes.for_each(|(to, from)| *to = *from);
            return Some(request);
        }
        <[u8; 8]>::try_from(frame.bytes()).ok()
    }

    /// Whether a service that only configuration has is carried out now.
    fn serves_lss(&self, specifier: u8) -> bool {
        let departs = &self.behaviour.lss;
        self.lss == LssState::Configuration
            || match specifier {
                0x11 | 0x13 | 0x17 => departs.configured_in_waiting,
                0x15 => departs.activated_in_waiting,
                0x5A..=0x5E => departs.inquired_in_waiting,
                _ => false,
            }
    }

    fn switch_global(&mut self, now: Instant, mode: u8) {
        let departs = &self.behaviour.lss;
        match mode {
            0 if departs.stays_in_configuration => {}
            0 => {
                if self.lss == LssState::Configuration || !departs.selection_goes_on {
                    self.lss = LssState::Waiting;
                    self.lss_work.named = [None; 4];
                }
                if !self.has_node() && self.pending_node <= 127 {
                    self.reset_communication(now);
                }
            }
            1 => self.lss = LssState::Configuration,
            _ if departs.any_mode_configures => self.lss = LssState::Configuration,
            _ => {}
        }
    }

    /// 40h vendor-ID, 41h product code, 42h revision number, 43h serial number, one after the other.
    fn switch_selective(&mut self, now: Instant, part: u8, request: &[u8; 8]) {
        let [_, named @ .., _, _, _] = request;
        if self.lss == LssState::Configuration {
            return;
        }
        let named = u32::from_le_bytes(*named);
        self.lss = if self.behaviour.lss.compares_at_the_end {
            self.select_at_the_end(part, named)
        } else {
            self.select_one_by_one(part, named)
        };
        let departs = &self.behaviour.lss;
        let confirmed = match self.lss {
            LssState::Configuration => self.behaviour.lss_selection_confirmed,
            LssState::Matching(_) => departs.every_part_confirmed,
            LssState::Waiting => false,
        };
        if confirmed {
            self.answer_lss(now, &[0x44]);
        }
    }

    fn is_own(&self, part: u8, named: u32) -> bool {
        let differing = named ^ self.own(part);
        let compared = match self.behaviour.lss.low_words_compared {
            true => 0xFFFF,
            false => u32::MAX,
        };
        differing & compared == 0
            || self.behaviour.lss.part_ignored == Some(part)
            || (part == 3 && !self.behaviour.lss_serial_matters)
    }

    fn select_one_by_one(&self, part: u8, named: u32) -> LssState {
        let before = match self.lss {
            LssState::Matching(parts) => parts,
            LssState::Waiting | LssState::Configuration => 0,
        };
        let any_order = self.behaviour.lss.order_ignored;
        let alone = part == 3 && self.behaviour.lss.serial_selects_alone;
        let in_turn = any_order || alone || part == before || part == 0;
        if !self.is_own(part, named) || !in_turn {
            return LssState::Waiting;
        }
        match if any_order { before } else { part } {
            0..=2 if any_order => LssState::Matching(before + 1),
            0..=2 => LssState::Matching(part + 1),
            _ => LssState::Configuration,
        }
    }

    fn select_at_the_end(&mut self, part: u8, named: u32) -> LssState {
        if let Some(place) = self.lss_work.named.get_mut(usize::from(part)) {
            *place = Some(named);
        }
        let known = (0..4).zip(self.lss_work.named);
        let mut known = known.map(|(part, named)| named.is_some_and(|it| self.is_own(part, it)));
        match part == 3 && known.all(|same| same) {
            true => LssState::Configuration,
            false => LssState::Waiting,
        }
    }

    fn configure_node(&mut self, now: Instant, node: u8) {
        let departs = &self.behaviour.lss;
        let valid = matches!(node, 1..=127 | 255) && departs.node_refused != Some(node);
        let refused =
            !valid && departs.node_taken != Some(node) && self.behaviour.lss_configuration_checked;
        if valid {
            let six_bits = departs.node_of_six_bits && node <= 127;
            self.pending_node = if six_bits { node & 0x3F } else { node };
            if departs.stored_unasked {
                self.memory.node = self.pending_node;
            }
        } else if departs.refused_node_kept {
            self.pending_node = NO_NODE;
        }
        self.say_whether(now, 0x11, refused);
        if valid {
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
        let departs = &self.behaviour.lss;
        let mut place = usize::from(index);
        if departs.last_index_for_all {
            place = place.min(abilities.bit_rates.len().saturating_sub(1));
        }
        let rate = abilities.bit_rates.get(place);
        let reserved = 0;
        let rate = rate.filter(|rate| {
            **rate != reserved
                && (selector == 0 || departs.table_ignored)
                && self.behaviour.lss_refused_index != Some(index)
        });
        let refused = rate.is_none() && self.behaviour.lss_configuration_checked;
        let at_once = departs.bit_timing_at_once;
        self.say_whether(now, 0x13, refused);
        if let Some(rate) = rate {
            self.pending_bit_rate = *rate;
            if at_once {
                self.bit_rate = *rate;
            }
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
        let number = self.own(specifier - 0x5A);
        let answered = match specifier {
            0x5C => self.behaviour.lss_revision_specifier,
            other => other,
        };
        let [b0, b1, b2, b3] = if self.behaviour.lss_identity_big_endian {
            number.to_be_bytes()
        } else {
            number.to_le_bytes()
        };
        self.answer_lss(now, &[answered, b0, b1, b2, b3]);
    }

    /// The node-ID in use, whatever was configured meanwhile.
    fn inquire_node(&mut self, now: Instant) {
        let node = match self.behaviour.lss.pending_node_told {
            true => self.pending_node,
            false => self.node,
        };
        self.answer_lss(now, &[0x5E, node]);
    }

    /// Part 0 to 3 of the own identity.
    pub(super) fn own(&self, part: u8) -> u32 {
        let address = Address::new(IDENTITY, part.saturating_add(1));
        self.objects.number(address).unwrap_or(0)
    }

    /// The error code, and that of the manufacturer, which there is none of.
    fn say_whether(&mut self, now: Instant, specifier: u8, refused: bool) {
        self.answer_lss(now, &[specifier, u8::from(refused), 0]);
    }

    pub(super) fn answer_lss(&mut self, now: Instant, meaningful: &[u8]) {
        let departs = &self.behaviour.lss;
        let work = &mut self.lss_work;
        if departs
            .answers_at_most
            .is_some_and(|most| work.answers >= most)
        {
            return;
        }
        work.answers += 1;
        let mut answer = match departs.reserved_bytes_stale {
            true => work.last_answer,
            false => [0; 8],
        };
        let bytes = answer.iter_mut().zip(meaningful);
        bytes.for_each(|(to, from)| *to = *from);
        work.last_answer = answer;
        let len = match departs.answers_cut_short {
            true => meaningful.len(),
            false => answer.len(),
        };
        let twice = departs.answers_twice;
        let at = now + self.turnaround();
        let frame = answer.get(..len);
        if let Some(frame) = frame.and_then(|data| Frame::data(identifier(ANSWER), data)) {
            if twice {
                self.queue.push(at, Service::Lss, frame);
            }
            self.queue.push(at, Service::Lss, frame);
        }
    }
}
