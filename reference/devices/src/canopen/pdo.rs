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
}

impl Communication {
    /// | sub | holds |
    /// | --- | --- |
    /// | 1 | COB-ID: bit 31 not valid, bit 30 no RTR, bits 0 to 10 identifier |
    /// | 2 | transmission type |
    /// | 3 | inhibit time, 100 us |
    /// | 5 | event timer, ms |
    pub(super) fn read(
        objects: &Objects,
        index: u16,
        behaviour: &Behaviour,
    ) -> Option<Communication> {
        let number = |sub| objects.number(Address::new(index, sub));
        let cob_id = number(1)?;
        let [identifier_low, identifier_high, ..] = cob_id.to_le_bytes();
        Some(Communication {
            valid: cob_id & INVALID == 0 || (behaviour.invalid_tpdo_sent && is_transmit(index)),
            remote: cob_id & NO_REMOTE == 0 || behaviour.remote_bit_ignored,
            identifier: u16::from_le_bytes([identifier_low, identifier_high]) & 0x7FF,
            kind: number(2)?.to_le_bytes()[0],
            inhibit: Duration::from_micros(u64::from(number(3).unwrap_or(0)) * 100),
            event_timer: Duration::from_millis(u64::from(number(5).unwrap_or(0)))
                * behaviour.event_timer_unit_ms,
        })
    }

    pub(super) fn event_driven(&self) -> bool {
        self.kind >= EVENT_DRIVEN
    }
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

/// One mapped object: its slot and its length in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Field {
    pub(super) slot: usize,
    pub(super) address: Address,
    pub(super) size: usize,
}

/// The objects mapped at `index`. Only whole bytes are mapped.
pub(super) fn fields(objects: &Objects, index: u16) -> Vec<Field> {
    let field = |entry: MappingEntry| {
        Some(Field {
            slot: objects.find(entry.address).ok()?,
            address: entry.address,
            size: usize::from(entry.bits / 8),
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
}

/// The RPDOs that the dictionary describes.
pub(super) fn rpdos(objects: &Objects, behaviour: &Behaviour) -> Vec<Rpdo> {
    let rpdo = |number| {
        Some(Rpdo {
            communication: Communication::read(objects, RPDO_COMMUNICATION + number, behaviour)?,
            fields: fields(objects, RPDO_MAPPING + number),
            latched: None,
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
            rpdo.communication.valid && rpdo.communication.identifier == identifier
        });
        let Some(rpdo) = found.and_then(|number| self.rpdos.get_mut(number)) else {
            return;
        };
        let mapped: usize = rpdo.fields.iter().map(|field| field.size).sum();
        if frame.len() < mapped {
            self.report(now, super::emergency::PDO_TOO_SHORT);
            return;
        }
        let mut data = [0; 8];
        data.iter_mut()
            .zip(frame.bytes())
            .for_each(|(to, from)| *to = *from);
        if rpdo.communication.event_driven() {
            let fields = rpdo.fields.clone();
            self.take_pdo(now, &fields, data, application);
        } else {
            rpdo.latched = Some(data);
        }
    }

    /// SYNC: what was received since the last one takes effect.
    pub(super) fn actuate_pdos(&mut self, now: Instant, application: &mut dyn Application) {
        for number in 0..self.rpdos.len() {
            let Some(rpdo) = self.rpdos.get_mut(number) else {
                return;
            };
            if let Some(data) = rpdo.latched.take() {
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
        let mut rest = data.as_slice();
        for field in fields {
            let Some((value, behind)) = rest.split_at_checked(field.size) else {
                return;
            };
            rest = behind;
            // A PDO has no answer: a value that the object does not take leaves it as it was.
            let _ = self.write(now, field.address, field.slot, value, application);
        }
    }
}
