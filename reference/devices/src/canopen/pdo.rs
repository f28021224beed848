//! PDO parameters as the dictionary holds them, and the PDOs that are received.

use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::Instant;

use super::objects::Objects;
use super::pdo_rules::is_transmit;
use super::queue::Service;
use super::{Address, Application, Behaviour, Slave};

pub(super) const RPDO_COMMUNICATION: u16 = 0x1400;
pub(super) const RPDO_MAPPING: u16 = 0x1600;
pub(super) const TPDO_COMMUNICATION: u16 = 0x1800;
pub(super) const TPDO_MAPPING: u16 = 0x1A00;
/// As many PDOs as have an identifier of their own, and as many again.
pub(super) const MOST_PDOS: u16 = 8;

/// Bit 31 of a PDO's COB-ID: the PDO does not exist.
pub(super) const INVALID: u32 = 1 << 31;
/// Bit 30: a remote frame does not fetch it.
pub(super) const NO_REMOTE: u32 = 1 << 30;

/// Bit 29: the identifier has 29 bits.
pub(super) const EXTENDED: u32 = 1 << 29;

/// A remote frame fetches what the last SYNC found.
pub(super) const SAMPLED_BY_SYNC: u8 = 252;
/// A remote frame fetches what there is.
pub(super) const ON_REMOTE_FRAME: u8 = 253;
/// From this transmission type on a PDO is event-driven.
pub(super) const EVENT_DRIVEN: u8 = 254;

/// A PDO's communication parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Communication {
    pub(super) valid: bool,
    pub(super) remote: bool,
    pub(super) identifier: u16,
    pub(super) kind: u8,
    pub(super) inhibit: Duration,
    pub(super) event_timer: Duration,
    /// The counter of the SYNC that is taken for the first; 0 for any.
    pub(super) start: u8,
}

impl Communication {
    /// | sub | holds |
    /// | --- | --- |
    /// | 1 | COB-ID: bit 31 not valid, bit 30 no RTR, bits 0 to 10 identifier |
    /// | 2 | transmission type |
    /// | 3 | inhibit time, 100 us |
    /// | 5 | event timer, ms |
    /// | 6 | SYNC start value |
    pub(super) fn read(
        objects: &Objects,
        index: u16,
        behaviour: &Behaviour,
    ) -> Option<Communication> {
        let number = |sub| objects.number(Address::new(index, sub));
        let cob_id = number(1)?;
        let [identifier_low, identifier_high, ..] = cob_id.to_le_bytes();
        Some(Communication {
            valid: cob_id & INVALID == 0
                || if is_transmit(index) {
                    behaviour.invalid_tpdo_sent
                } else {
                    !behaviour.pdo.invalid_rpdo_passed_over
                },
            remote: cob_id & NO_REMOTE == 0 || behaviour.remote_bit_ignored,
            identifier: if behaviour.pdo.identifier_used {
                u16::from_le_bytes([identifier_low, identifier_high]) & 0x7FF
            } else {
                predefined(index) | u16::from(identifier_low & 0x7F)
            },
            kind: number(2)?.to_le_bytes()[0],
            inhibit: if behaviour.inhibit_time_kept {
                Duration::from_micros(u64::from(number(3).unwrap_or(0)) * 100)
            } else {
                Duration::ZERO
            },
            event_timer: Duration::from_millis(u64::from(number(5).unwrap_or(0)))
                * behaviour.event_timer_unit_ms,
            start: number(6).unwrap_or(0).to_le_bytes()[0],
        })
    }

    pub(super) fn event_driven(&self) -> bool {
        self.kind >= EVENT_DRIVEN
    }
}

/// The identifier that the PDO with the communication parameter at `index` has for node 0, by its number.
const fn predefined(index: u16) -> u16 {
    let first = if is_transmit(index) { 0x180 } else { 0x200 };
    first + (index & 3) * 0x100
}

/// What a mapping entry says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct MappingEntry {
    pub(super) address: Address,
    pub(super) bits: u8,
}

impl From<u32> for MappingEntry {
    /// | bits | hold |
    /// | --- | --- |
    /// | 31 to 16 | index |
    /// | 15 to 8 | sub-index |
    /// | 7 to 0 | length in bits |
    fn from(entry: u32) -> MappingEntry {
        let [bits, sub, low, high] = entry.to_le_bytes();
        MappingEntry {
            address: Address::new(u16::from_le_bytes([low, high]), sub),
            bits,
        }
    }
}

/// The entries in force of the mapping at `index`.
pub(super) fn entries(objects: &Objects, index: u16) -> impl Iterator<Item = MappingEntry> + '_ {
    let count = objects.number(Address::new(index, 0)).unwrap_or(0);
    let subs = 1..=count.min(64).to_le_bytes()[0];
    subs.filter_map(move |sub| objects.number(Address::new(index, sub)))
        .map(MappingEntry::from)
}

/// One mapped object: its slot, or none for a dummy, and its length in bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Field {
    pub(super) slot: Option<usize>,
    pub(super) address: Address,
    pub(super) bits: u32,
}

/// The length in bits of the data type that `address` stands for in a mapping, as a dummy; none if it is no dummy.
pub(super) fn dummy(address: Address) -> Option<u32> {
    match (address.index(), address.sub()) {
        (1, 0) => Some(1),
        (2 | 5, 0) => Some(8),
        (3 | 6, 0) => Some(16),
        (4 | 7, 0) => Some(32),
        _ => None,
    }
}

/// `bits` bits of `data` from bit `from` on; `None` if there are not so many.
fn part(data: u64, from: u32, bits: u32) -> Option<u64> {
    let unused = 64_u32.checked_sub(from)?.checked_sub(bits)?;
    let above = data.checked_shl(unused).unwrap_or(0);
    Some(above.checked_shr(unused + from).unwrap_or(0))
}

/// The objects mapped at `index`.
pub(super) fn fields(objects: &Objects, index: u16, behaviour: &Behaviour) -> Vec<Field> {
    let field = |entry: MappingEntry| {
        let slot = objects.find(entry.address).ok();
        (slot.is_some() || dummy(entry.address).is_some()).then(|| Field {
            slot,
            address: entry.address,
            bits: if behaviour.pdo.bits_packed {
                u32::from(entry.bits)
            } else {
                u32::from(entry.bits).next_multiple_of(8)
            },
        })
    };
    entries(objects, index).filter_map(field).collect()
}

/// A PDO that is received.
#[derive(Debug)]
pub(super) struct Rpdo {
    communication: Communication,
    fields: Vec<Field>,
    /// What arrived and waits for SYNC.
    latched: Option<[u8; 8]>,
    /// When the next one is late.
    deadline: Option<Instant>,
}

impl Rpdo {
    /// Whether what arrives does not wait for SYNC.
    fn takes_effect_at_once(&self, behaviour: &Behaviour) -> bool {
        match self.communication.kind {
            EVENT_DRIVEN.. => behaviour.pdo.event_rpdo_at_once,
            0 if !behaviour.pdo.acyclic_rpdo_waits => true,
            _ => !behaviour.rpdo_waits_for_sync,
        }
    }
}

/// The RPDOs that the dictionary describes.
pub(super) fn rpdos(objects: &Objects, behaviour: &Behaviour) -> Vec<Rpdo> {
    let rpdo = |number| {
        Some(Rpdo {
            communication: Communication::read(objects, RPDO_COMMUNICATION + number, behaviour)?,
            fields: fields(objects, RPDO_MAPPING + number, behaviour),
            latched: None,
            deadline: None,
        })
    };
    (0..MOST_PDOS).filter_map(rpdo).collect()
}

impl Slave {
    /// A data frame that no other service takes.
    pub(super) fn receive_pdo(
        &mut self,
        now: Instant,
        identifier: u16,
        frame: &Frame,
        application: &mut dyn Application,
    ) {
        if !self.state.permits(Service::Pdo, &self.behaviour) {
            return;
        }
        let found = self.rpdos.iter().position(|rpdo| {
            rpdo.communication.valid
                && (rpdo.communication.identifier ^ identifier) & self.behaviour.pdo.compared() == 0
        });
        let Some(rpdo) = found.and_then(|number| self.rpdos.get_mut(number)) else {
            return;
        };
        let mapped: u32 = rpdo.fields.iter().map(|field| field.bits).sum();
        let length = mapped.div_ceil(8) as usize;
        if frame.len() < length && self.behaviour.pdo.short_passed_over {
            if self.behaviour.pdo.short_reported && !self.behaviour.departs.short_pdo_unreported {
                self.report(now, super::emergency::PDO_TOO_SHORT);
            }
            return;
        }
        if frame.len() > length && !self.behaviour.pdo.long_taken {
            return;
        }
        let reported = frame.len() > length
            && self.profile.complete
            && !self.behaviour.manners.long_pdo_unreported;
        let mut data = [0; 8];
        data.iter_mut()
            .zip(frame.bytes())
            .for_each(|(to, from)| *to = *from);
        let timer = rpdo.communication.event_timer;
        if self.profile.complete {
            rpdo.deadline = (!timer.is_zero()).then(|| now + timer);
        }
        if rpdo.takes_effect_at_once(&self.behaviour) {
            let fields = rpdo.fields.clone();
            self.take_pdo(now, &fields, data, application);
        } else if self.behaviour.pdo.last_rpdo_counts || rpdo.latched.is_none() {
            rpdo.latched = Some(data);
        }
        if reported {
            self.report(now, super::emergency::PDO_TOO_LONG);
        }
    }

    /// SYNC: what was received since the last one takes effect.
    pub(super) fn actuate_pdos(&mut self, now: Instant, application: &mut dyn Application) {
        for number in 0..self.rpdos.len() {
            let Some(rpdo) = self.rpdos.get_mut(number) else {
                return;
            };
            if let Some(data) = rpdo.latched.take()
                && self.behaviour.pdo.rpdo_actuated
            {
                let fields = rpdo.fields.clone();
                self.take_pdo(now, &fields, data, application);
            }
        }
    }

    fn take_pdo(
        &mut self,
        now: Instant,
        fields: &[Field],
        data: [u8; 8],
        application: &mut dyn Application,
    ) {
        let data = u64::from_le_bytes(data);
        let mut from = 0;
        for field in fields {
            let Some(value) = part(data, from, field.bits) else {
                return;
            };
            from += field.bits;
            let Some(slot) = field.slot else {
                if !self.behaviour.dummies_take_room {
                    from -= field.bits;
                }
                continue;
            };
            let value = value.to_le_bytes();
            let value = value.get(..field.bits.div_ceil(8) as usize);
            // A PDO has no answer: a value that the object does not take leaves it as it was.
            let _ = value.map(|value| self.write(now, field.address, slot, value, application));
        }
    }

    /// When an RPDO is late.
    pub(super) fn rpdos_due(&self) -> Option<Instant> {
        self.rpdos.iter().filter_map(|rpdo| rpdo.deadline).min()
    }

    /// Reports each RPDO that is late, once.
    pub(super) fn wake_rpdos(&mut self, now: Instant) {
        let late = |rpdo: &&mut Rpdo| rpdo.deadline.is_some_and(|deadline| deadline <= now);
        let mut count = 0;
        for rpdo in self.rpdos.iter_mut().filter(late) {
            rpdo.deadline = None;
            count += 1;
        }
        for _ in 0..count {
            if self.behaviour.pdo.deadline_noticed {
                self.report(now, super::emergency::RPDO_TIMEOUT);
            }
        }
    }

    /// PDOs are permitted from now on.
    pub(super) fn start_rpdos(&mut self, now: Instant) {
        if self.behaviour.pdo.deadline_from_first || !self.profile.complete {
            return;
        }
        for rpdo in self
            .rpdos
            .iter_mut()
            .filter(|rpdo| rpdo.communication.valid)
        {
            let timer = rpdo.communication.event_timer;
            rpdo.deadline = (!timer.is_zero()).then(|| now + timer);
        }
    }

    /// PDOs are not permitted any more: none is late, and what waits for SYNC is forgotten.
    pub(super) fn stop_rpdos(&mut self) {
        for rpdo in &mut self.rpdos {
            rpdo.deadline = None;
            rpdo.latched = None;
        }
    }
}
