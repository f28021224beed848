//! The PDOs that are sent: by SYNC, by event with inhibit time, by event timer, by remote frame.

use fieldproof_can::Frame;
use fieldproof_link::Instant;

use super::objects::Objects;
use super::pdo::{
    Communication, Field, MOST_PDOS, SAMPLED_BY_SYNC, TPDO_COMMUNICATION, TPDO_MAPPING, fields,
};
use super::queue::{Service, identifier};
use super::{Behaviour, Slave, TransmitEvent};

/// What a PDO carries.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Payload {
    len: usize,
    bytes: [u8; 8],
}

/// A PDO that is sent.
#[derive(Debug)]
pub(super) struct Tpdo {
    pub(super) index: u16,
    communication: Communication,
    fields: Vec<Field>,
    /// What it carried last, or when it was started.
    sampled: Payload,
    /// It is to be sent: as soon as the inhibit time allows, or with the next SYNC.
    event: bool,
    /// SYNCs since it was last sent.
    syncs: u8,
    /// It waits for the SYNC with its start value.
    waits: bool,
    /// Its numbers leave with the most significant byte first.
    big_endian: bool,
    /// It was due with the SYNC before.
    owed: bool,
    last: Option<Instant>,
    timer: Option<Instant>,
}

impl Tpdo {
    fn read(objects: &Objects, number: u16, behaviour: &Behaviour) -> Option<Tpdo> {
        let index = TPDO_COMMUNICATION + number;
        Some(Tpdo {
            index,
            communication: Communication::read(objects, index, behaviour)?,
            fields: fields(objects, TPDO_MAPPING + number),
            sampled: Payload::default(),
            event: false,
            syncs: 0,
            waits: false,
            big_endian: behaviour.tpdo_big_endian,
            owed: false,
            last: None,
            timer: None,
        })
    }

    fn payload(&self, objects: &Objects) -> Payload {
        let mut data = 0;
        let mut used = 0;
        for field in &self.fields {
            if used + field.bits > 64 {
                break;
            }
            data |= self.part(objects, field).checked_shl(used).unwrap_or(0);
            used += field.bits;
        }
        Payload {
            len: used.div_ceil(8) as usize,
            bytes: data.to_le_bytes(),
        }
    }

    /// What a field carries, in the low bits.
    fn part(&self, objects: &Objects, field: &Field) -> u64 {
        let object = field.slot.and_then(|slot| objects.at(slot));
        let mut bytes = [0; 8];
        let size = field.bits.div_ceil(8) as usize;
        let places = bytes.get_mut(..size).unwrap_or_default();
        let value = object.map_or(&[][..], |object| object.value());
        places
            .iter_mut()
            .zip(value)
            .for_each(|(to, from)| *to = *from);
        if self.big_endian {
            places.reverse();
        }
        let mask = u64::MAX.checked_shr(64 - field.bits.min(64)).unwrap_or(0);
        u64::from_le_bytes(bytes) & mask
    }

    /// When it leaves next, if nothing happens before.
    fn due(&self) -> Option<Instant> {
        if !self.communication.valid || !self.communication.event_driven() {
            return None;
        }
        let event = self.event.then(|| {
            self.last
                .map_or(Instant::START, |last| last + self.communication.inhibit)
        });
        let timer = self.timer.map(|timer| match self.last {
            Some(last) => timer.max(last + self.communication.inhibit),
            None => timer,
        });
        [event, timer].into_iter().flatten().min()
    }
}

/// The TPDOs that the dictionary describes.
pub(super) fn tpdos(objects: &Objects, behaviour: &Behaviour) -> Vec<Tpdo> {
    (0..MOST_PDOS)
        .filter_map(|number| Tpdo::read(objects, number, behaviour))
        .collect()
}

impl Slave {
    /// Reads the parameters of the TPDO whose communication or mapping parameter is `index` again.
    pub(super) fn reconfigure_tpdo(&mut self, now: Instant, index: u16) {
        let number = index % TPDO_MAPPING % TPDO_COMMUNICATION;
        let Some(fresh) = Tpdo::read(&self.objects, number, &self.behaviour) else {
            return;
        };
        let active = self.state.permits(Service::Pdo, &self.behaviour);
        let place = self.tpdos.iter_mut().find(|tpdo| tpdo.index == fresh.index);
        if let Some(place) = place {
            let last = place.last;
            *place = Tpdo { last, ..fresh };
            if active {
                self.start_tpdo(now, TPDO_COMMUNICATION + number);
            }
        }
    }

    /// PDOs are permitted from now on.
    pub(super) fn start_tpdos(&mut self, now: Instant) {
        for number in 0..MOST_PDOS {
            self.start_tpdo(now, TPDO_COMMUNICATION + number);
        }
    }

    fn start_tpdo(&mut self, now: Instant, index: u16) {
        let on_start = self.behaviour.tpdo_on_start;
        let with_first = self.behaviour.tpdo_with_first_sync;
        let counted = self.sync.overflow != 0 && self.behaviour.sync_start_value_kept;
        let Some(tpdo) = self.tpdos.iter_mut().find(|tpdo| tpdo.index == index) else {
            return;
        };
        tpdo.sampled = tpdo.payload(&self.objects);
        tpdo.event = on_start && tpdo.communication.event_driven();
        let cyclic = (1..=240).contains(&tpdo.communication.kind);
        tpdo.syncs = if cyclic && with_first {
            tpdo.communication.kind - 1
        } else {
            0
        };
        tpdo.waits = cyclic && counted && tpdo.communication.start != 0;
        tpdo.owed = false;
        let period = tpdo.communication.event_timer;
        tpdo.timer = (!period.is_zero()).then(|| now + period);
    }

    /// Values may have changed.
    pub(super) fn notice_changes(&mut self) {
        if !self.objects.take_changed() || !self.state.permits(Service::Pdo, &self.behaviour) {
            return;
        }
        let on_change = self.profile.transmit_event == TransmitEvent::Change;
        for tpdo in &mut self.tpdos {
            let communication = &tpdo.communication;
            let watched = communication.kind == 0 || (communication.event_driven() && on_change);
            if communication.valid && watched {
                tpdo.event |= tpdo.payload(&self.objects) != tpdo.sampled;
            }
        }
    }

    /// SYNC, with its counter if it has one: sends the synchronous TPDOs that are due.
    pub(super) fn synchronise_tpdos(&mut self, now: Instant, counter: Option<u8>) {
        for number in 0..self.tpdos.len() {
            let late = self.behaviour.tpdo_one_sync_late;
            let surplus = self.behaviour.surplus_syncs;
            let Some(tpdo) = self.tpdos.get_mut(number) else {
                return;
            };
            let kind = tpdo.communication.kind;
            if kind == SAMPLED_BY_SYNC {
                tpdo.sampled = tpdo.payload(&self.objects);
            }
            if !tpdo.communication.valid || kind > 240 {
                continue;
            }
            tpdo.waits &= counter.is_some() && counter != Some(tpdo.communication.start);
            if tpdo.waits {
                continue;
            }
            tpdo.syncs = tpdo.syncs.saturating_add(1);
            let due = if kind == 0 {
                tpdo.event
            } else {
                tpdo.syncs >= kind.saturating_add(surplus)
            };
            if due {
                tpdo.syncs = 0;
                tpdo.event = false;
            }
            let leaves = if late {
                std::mem::replace(&mut tpdo.owed, due)
            } else {
                due
            };
            if leaves {
                let at = now + self.turnaround();
                self.transmit(number, at);
            }
        }
    }

    /// A remote frame with the identifier of a TPDO fetches it.
    pub(super) fn fetch_tpdo(&mut self, now: Instant, identifier: u16) {
        if !self.behaviour.remote_frames_answered
            || !self.state.permits(Service::Pdo, &self.behaviour)
        {
            return;
        }
        let fetched = self.tpdos.iter().position(|tpdo| {
            let communication = &tpdo.communication;
            communication.valid && communication.remote && communication.identifier == identifier
        });
        if let Some(number) = fetched {
            let at = now + self.turnaround();
            self.transmit(number, at);
        }
    }

    /// Sends the event-driven TPDOs that are due.
    pub(super) fn wake_tpdos(&mut self, now: Instant) {
        if !self.state.permits(Service::Pdo, &self.behaviour) {
            return;
        }
        for number in 0..self.tpdos.len() {
            let due = self.tpdos.get(number).and_then(Tpdo::due);
            if due.is_some_and(|due| due <= now) {
                self.transmit(number, now);
            }
        }
    }

    /// When an event-driven TPDO is due.
    pub(super) fn tpdos_due(&self) -> Option<Instant> {
        if !self.state.permits(Service::Pdo, &self.behaviour) {
            return None;
        }
        self.tpdos.iter().filter_map(Tpdo::due).min()
    }

    fn transmit(&mut self, number: usize, at: Instant) {
        let Some(tpdo) = self.tpdos.get_mut(number) else {
            return;
        };
        let latched =
            tpdo.communication.kind == SAMPLED_BY_SYNC && self.behaviour.remote_sample_kept;
        let payload = if latched || !self.behaviour.tpdo_refreshed {
            tpdo.sampled
        } else {
            tpdo.payload(&self.objects)
        };
        let period = tpdo.communication.event_timer;
        // A timer that was due keeps its pace; one that was not starts again.
        let from = tpdo.timer.filter(|timer| *timer <= at).unwrap_or(at);
        tpdo.timer = (!period.is_zero()).then(|| (from + period).max(at));
        tpdo.sampled = payload;
        tpdo.event = false;
        tpdo.last = Some(at);
        let identifier = identifier(tpdo.communication.identifier);
        let bytes = payload.bytes.get(..payload.len).unwrap_or(&payload.bytes);
        if let Some(frame) = Frame::data(identifier, bytes) {
            self.queue.push(at, Service::Pdo, frame);
        }
    }
}
