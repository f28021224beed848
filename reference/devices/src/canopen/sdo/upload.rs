//! Uploads, expedited and segmented.

use fieldproof_link::Instant;

use super::{Asked, Refusal, SEGMENT, StraySegment, Transfer, is_mapping_entry};
use crate::canopen::{Abort, Address, Answer, Application, Slave};

impl Slave {
    pub(super) fn begin_upload(
        &mut self,
        now: Instant,
        address: Address,
        asked: Asked,
        application: &mut dyn Application,
    ) -> Result<(), Refusal> {
        let refused = |abort| (address, abort);
        self.forget_segments();
        self.sdo.transfer = Transfer::None;
        let slot = match self.objects.find(address) {
            Ok(slot) => slot,
            Err(abort) if self.answers_without_object(address, abort) => {
                let [m0, m1, m2] = address.multiplexer();
                self.respond(now, [0x43, m0, m1, m2, 0, 0, 0, 0]);
                return Ok(());
            }
            Err(abort) => return Err(refused(abort)),
        };
        let readable = self.objects.at(slot).is_some_and(|object| object.readable);
        if !readable && self.behaviour.sdo.write_only_checked {
            return Err(refused(Abort::WRITE_ONLY));
        }
        match application.reading(address) {
            Answer::Now => self.answer_upload(now, address, slot, asked),
            Answer::Refused(abort) => return Err(refused(abort)),
            Answer::Later => self.sdo.transfer = Transfer::Reading { address, asked },
        }
        Ok(())
    }

    /// Whether a value is invented where there is none.
    fn answers_without_object(&self, address: Address, abort: Abort) -> bool {
        match abort {
            Abort::NO_SUB_INDEX if !self.behaviour.sdo.gaps_refused => {
                let highest = self.objects.number(Address::new(address.index(), 0));
                highest.is_some_and(|highest| u32::from(address.sub()) < highest)
            }
            Abort::NO_OBJECT => !self.behaviour.sdo.unknown_object_refused,
            _ => false,
        }
    }

    fn answer_upload(&mut self, now: Instant, address: Address, slot: usize, asked: Asked) {
        let before = self.sdo.before.as_ref();
        let before = before.filter(|(written, _)| *written == address);
        let value = match (before, self.objects.at(slot)) {
            (Some((_, value)), _) => value.as_slice(),
            (None, Some(object)) => object.value(),
            (None, None) => return,
        };
        if let Asked::Blocks(blocks) = asked
            && !blocks.switches(self, value.len())
        {
            let value = value.to_vec();
            return self.answer_block_upload(now, address, &value, blocks);
        }
        let mut response = [0; 8];
        let [command, m0, m1, m2, data @ ..] = &mut response;
        [*m0, *m1, *m2] = address.multiplexer();
        let settings = &self.behaviour.sdo;
        let empty = value.is_empty() && !settings.empty_sent;
        let value = if empty { &[0; 4] } else { value };
        if (1..=4).contains(&value.len()) {
            data.iter_mut()
                .zip(value)
                .for_each(|(to, from)| *to = *from);
            let reversed = self.behaviour.upload_big_endian
                || (self.behaviour.mapping_entry_big_endian && is_mapping_entry(address));
            if let Some(number) = data.get_mut(..value.len()).filter(|_| reversed) {
                number.reverse();
            }
            let size = match value.len() {
                size if !self.behaviour.expedited_size_off_by_one => size,
                4 => 3,
                size => size + 1,
            };
            *command = 0x43 | ((4 - size) << 2).to_le_bytes()[0];
        } else {
            let size = value.len() + settings.surplus_size;
            let [s0, s1, ..] = size.to_le_bytes();
            (*command, *data) = if settings.size_given {
                (0x41, [s0, s1, 0, 0])
            } else {
                (0x40, [0; 4])
            };
            self.sdo.buffer.clear();
            self.sdo.buffer.extend_from_slice(value);
            self.sdo.transfer = Transfer::Upload {
                address,
                offset: 0,
                toggle: false,
            };
        }
        self.respond(now, response);
    }

    /// | bits of byte 0 | hold |
    /// | --- | --- |
    /// | 4 | toggle |
    /// | 1 to 3 | in the answer: data bytes without data |
    /// | 0 | in the answer: this was the last segment |
    pub(super) fn upload_segment(
        &mut self,
        now: Instant,
        command: u8,
        named: Address,
    ) -> Result<(), Refusal> {
        let Transfer::Upload {
            address,
            offset,
            toggle,
        } = self.sdo.transfer
        else {
            return match self.behaviour.sdo.stray_segment {
                StraySegment::Refused => Err((named, Abort::UNKNOWN_COMMAND)),
                StraySegment::Ignored => Ok(()),
                StraySegment::Answered => {
                    self.respond(now, [command & 0x10 | 0x01, 0, 0, 0, 0, 0, 0, 0]);
                    Ok(())
                }
            };
        };
        let settings = &self.behaviour.sdo;
        let toggle = if settings.upload_toggle_checked {
            toggle
        } else {
            command & 0x10 != 0
        };
        if (command & 0x10 != 0) != toggle {
            return Err((address, Abort::TOGGLE));
        }
        let rest = self.sdo.buffer.get(offset..).unwrap_or_default();
        let size = rest.len().min(SEGMENT);
        let last = rest.len() <= SEGMENT;
        let mut response = [0; 8];
        let [first, data @ ..] = &mut response;
        let place = if settings.long_offset {
            offset
        } else {
            offset & 0xFF
        };
        let part = self.sdo.buffer.get(place..).unwrap_or_default();
        data.iter_mut().zip(part).for_each(|(to, from)| *to = *from);
        let shown = toggle && self.behaviour.toggle_alternates;
        let unused = if settings.unused_given {
            (SEGMENT - size).to_le_bytes()[0]
        } else {
            0
        };
        let marked = last && settings.last_marked;
        *first = u8::from(shown) << 4 | unused << 1 | u8::from(marked);
        self.sdo.transfer = if last {
            Transfer::None
        } else {
            Transfer::Upload {
                address,
                offset: offset + size,
                toggle: !toggle,
            }
        };
        self.respond(now, response);
        Ok(())
    }

    /// The application has read `address`.
    pub(crate) fn finish_upload(
        &mut self,
        now: Instant,
        address: Address,
        outcome: Result<&[u8], Abort>,
    ) {
        if let Ok(value) = outcome {
            self.objects.set(address, value);
        }
        let Transfer::Reading {
            address: awaited,
            asked,
        } = self.sdo.transfer
        else {
            return;
        };
        if awaited != address {
            return;
        }
        self.sdo.transfer = Transfer::None;
        match (outcome, self.objects.find(address)) {
            (Ok(_), Ok(slot)) => self.answer_upload(now, address, slot, asked),
            (Err(abort), _) | (_, Err(abort)) => self.abort(now, address, abort),
        }
        self.await_request(now);
    }
}
