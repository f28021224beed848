//! What may be written to PDO parameters, and when.

use super::cob_id::is_restricted;
use super::objects::Objects;
use super::pdo::{
    EVENT_DRIVEN, EXTENDED, INVALID, MappingEntry, NO_REMOTE, ON_REMOTE_FRAME, RPDO_COMMUNICATION,
    RPDO_MAPPING, SAMPLED_BY_SYNC, TPDO_COMMUNICATION, TPDO_MAPPING, dummy,
};
use super::{Abort, Address, Behaviour, Profile};

/// Which parameter an index is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Parameter {
    Communication,
    Mapping,
}

impl Parameter {
    pub(super) const fn of(index: u16) -> Option<Parameter> {
        match index {
            0x1400..=0x15FF | 0x1800..=0x19FF => Some(Parameter::Communication),
            0x1600..=0x17FF | 0x1A00..=0x1BFF => Some(Parameter::Mapping),
            _ => None,
        }
    }
}

/// Whether `index` is a parameter of a PDO that is sent.
pub(super) const fn is_transmit(index: u16) -> bool {
    index >= TPDO_COMMUNICATION
}

/// The index of the communication parameter that belongs to the mapping at `index`.
const fn communication_of(index: u16) -> u16 {
    if is_transmit(index) {
        index - TPDO_MAPPING + TPDO_COMMUNICATION
    } else {
        index - RPDO_MAPPING + RPDO_COMMUNICATION
    }
}

fn number(value: &[u8]) -> u32 {
    let bytes = value.iter().take(4).rev();
    bytes.fold(0, |number, byte| number << 8 | u32::from(*byte))
}

fn enabled(objects: &Objects, communication: u16) -> bool {
    let cob_id = objects.number(Address::new(communication, 1));
    cob_id.is_some_and(|cob_id| cob_id & INVALID == 0)
}

/// What the rules look at.
#[derive(Clone, Copy)]
pub(super) struct Rules<'a> {
    pub(super) objects: &'a Objects,
    pub(super) profile: &'a Profile,
    pub(super) behaviour: &'a Behaviour,
}

impl Rules<'_> {
    /// Whether `value` may be written to the PDO parameter at `address` now; `false` if it is confirmed and not kept.
    ///
    /// # Errors
    /// The rule of CiA 301 that forbids it.
    pub(super) fn check(
        &self,
        parameter: Parameter,
        address: Address,
        value: &[u8],
    ) -> Result<bool, Abort> {
        let pdo = &self.behaviour.pdo;
        match (parameter, address.sub()) {
            (Parameter::Communication, 1) => return self.cob_id(address, number(value)),
            (Parameter::Communication, 2) => {
                let kind = value.first().copied().unwrap_or(0);
                self.transmission_type(is_transmit(address.index()), kind)?;
                return Ok(pdo.type_stored);
            }
            (Parameter::Communication, 3) if is_transmit(address.index()) => {
                self.unchanged_while_enabled(address, value, pdo.inhibit_time_locked)?;
            }
            (Parameter::Communication, 6) if self.profile.complete => {
                self.unchanged_while_enabled(address, value, pdo.start_value_locked)?;
                if number(value) > 240 {
                    return Err(Abort::INVALID_VALUE);
                }
            }
            (Parameter::Communication, _) => {}
            (Parameter::Mapping, sub) => self.mapping(address.index(), sub, value)?,
        }
        Ok(true)
    }

    /// Refuses, where `locked`, what is not there already while the PDO exists.
    fn unchanged_while_enabled(
        &self,
        address: Address,
        value: &[u8],
        locked: bool,
    ) -> Result<(), Abort> {
        let same = self.objects.number(address) == Some(number(value));
        if locked && !same && enabled(self.objects, address.index()) {
            return Err(self.not_now());
        }
        Ok(())
    }

    fn not_now(&self) -> Abort {
        Abort(self.behaviour.pdo.abort_not_now)
    }

    /// Types 241 to 251 are reserved; 252 and 253 are for what is sent, and need remote frames.
    fn transmission_type(&self, transmit: bool, kind: u8) -> Result<(), Abort> {
        let lowest = if transmit {
            self.profile.lowest_transmit_type
        } else {
            0
        };
        let remote = self.profile.complete && transmit && self.behaviour.remote_frames_answered;
        match kind {
            EVENT_DRIVEN.. => Ok(()),
            SAMPLED_BY_SYNC..=ON_REMOTE_FRAME if remote => Ok(()),
            241..EVENT_DRIVEN if !self.behaviour.reserved_types_taken => Err(Abort::INVALID_VALUE),
            _ if kind < lowest => Err(Abort::INVALID_VALUE),
            _ => Ok(()),
        }
    }

    /// The identifier of an enabled PDO stays as it is; an 11-bit one of the NMT, SDO, error control or LSS services is
    /// never taken, nor one of 29 bits.
    fn cob_id(&self, address: Address, value: u32) -> Result<bool, Abort> {
        let identifier = value & !(INVALID | NO_REMOTE);
        let restricted = is_restricted(identifier, &self.behaviour.departs);
        if identifier & EXTENDED != 0 && !self.behaviour.pdo.extended_identifier_refused {
            return Ok(false);
        }
        if identifier > 0x7FF || (restricted && value & INVALID == 0) {
            return Err(Abort::INVALID_VALUE);
        }
        let present = self.objects.number(address).unwrap_or(INVALID);
        let both_exist = (present | value) & INVALID == 0;
        let changed = (present ^ value) & !(INVALID | NO_REMOTE) != 0;
        if both_exist && changed && self.behaviour.pdo.identifier_locked {
            return Err(self.not_now());
        }
        Ok(true)
    }

    fn mapping(&self, index: u16, sub: u8, value: &[u8]) -> Result<(), Abort> {
        let pdo = &self.behaviour.pdo;
        if pdo.mapping_locked && enabled(self.objects, communication_of(index)) {
            return Err(self.not_now());
        }
        if sub == 0 {
            return self.count(index, value.first().copied().unwrap_or(0));
        }
        let counted = self.objects.number(Address::new(index, 0)) != Some(0);
        if pdo.entries_locked && counted {
            return Err(self.not_now());
        }
        match number(value) {
            0 => Ok(()),
            entry => self.mappable(index, entry.into()).map(drop),
        }
    }

    /// Entries 1 to `count` must be there and fit one PDO.
    fn count(&self, index: u16, count: u8) -> Result<(), Abort> {
        let pdo = &self.behaviour.pdo;
        let too_long = Abort(pdo.abort_too_long);
        let mut bits = 0;
        for sub in 1..=count {
            let Some(entry) = self.objects.number(Address::new(index, sub)) else {
                return if pdo.count_checked {
                    Err(too_long)
                } else {
                    Ok(())
                };
            };
            match self.mappable(index, entry.into()) {
                Ok(length) => bits += length,
                Err(_) if !pdo.count_checked => {}
                Err(abort) => return Err(abort),
            }
        }
        if bits > 64 && pdo.length_checked {
            return Err(too_long);
        }
        Ok(())
    }

    /// The length in bits of what `entry` maps at `index`.
    fn mappable(&self, index: u16, entry: MappingEntry) -> Result<u32, Abort> {
        let pdo = &self.behaviour.pdo;
        let length = u32::from(entry.bits);
        let not_mappable = Abort(pdo.abort_not_mappable);
        if self.profile.complete
            && let Some(bits) = dummy(entry.address)
        {
            let received = !is_transmit(index) || !pdo.dummies_received_only;
            let taken = received && pdo.dummies_taken && bits == length;
            return taken.then_some(bits).ok_or(not_mappable);
        }
        let slot = match self.objects.find(entry.address) {
            Ok(slot) => slot,
            Err(_) if !pdo.existence_checked => return Ok(length),
            Err(abort) => return Err(abort),
        };
        let object = self.objects.at(slot).ok_or(Abort::NO_OBJECT)?;
        let direction = if is_transmit(index) {
            object.sendable
        } else {
            object.receivable
        };
        let whole = object.bits() == Some(length) || !pdo.entry_length_checked;
        let permitted = object.mappable || !pdo.mappable_checked;
        let direction = direction || !pdo.direction_checked;
        if !permitted || !direction || !whole {
            return Err(not_mappable);
        }
        Ok(length)
    }
}
