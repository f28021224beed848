//! What may be written to PDO parameters, and when.

use super::cob_id::is_restricted;
use super::objects::Objects;
use super::pdo::{
    EVENT_DRIVEN, INVALID, MappingEntry, NO_REMOTE, ON_REMOTE_FRAME, RPDO_COMMUNICATION,
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

/// Whether `value` may be written to the PDO parameter at `address` now.
///
/// # Errors
/// The rule of CiA 301 that forbids it.
pub(super) fn check(
    objects: &Objects,
    profile: &Profile,
    behaviour: &Behaviour,
    parameter: Parameter,
    address: Address,
    value: &[u8],
) -> Result<(), Abort> {
    match (parameter, address.sub()) {
        (Parameter::Communication, 1) => cob_id(objects, behaviour, address, number(value)),
        (Parameter::Communication, 2) => {
            let kind = value.first().copied().unwrap_or(0);
            transmission_type(profile, behaviour, is_transmit(address.index()), kind)
        }
        (Parameter::Communication, 3) if is_transmit(address.index()) => {
            let same = objects.number(address) == Some(number(value));
            if enabled(objects, address.index()) && !same {
                return Err(Abort::DEVICE_STATE);
            }
            Ok(())
        }
        (Parameter::Communication, 6) if profile.complete => {
            let same = objects.number(address) == Some(number(value));
            if enabled(objects, address.index()) && !same {
                return Err(Abort::DEVICE_STATE);
            }
            match number(value) {
                0..=240 => Ok(()),
                _ => Err(Abort::INVALID_VALUE),
            }
        }
        (Parameter::Communication, _) => Ok(()),
        (Parameter::Mapping, sub) => {
            if enabled(objects, communication_of(address.index())) {
                return Err(Abort::DEVICE_STATE);
            }
            if sub == 0 {
                return count(
                    objects,
                    profile,
                    address.index(),
                    value.first().copied().unwrap_or(0),
                );
            }
            if objects.number(Address::new(address.index(), 0)) != Some(0) {
                return Err(Abort::DEVICE_STATE);
            }
            match number(value) {
                0 => Ok(()),
                entry => mappable(objects, profile, address.index(), entry.into()).map(drop),
            }
        }
    }
}

/// Types 241 to 251 are reserved; 252 and 253 are for what is sent, and need remote frames.
fn transmission_type(
    profile: &Profile,
    behaviour: &Behaviour,
    transmit: bool,
    kind: u8,
) -> Result<(), Abort> {
    let lowest = if transmit {
        profile.lowest_transmit_type
    } else {
        0
    };
    let remote = profile.complete && transmit && behaviour.remote_frames_answered;
    match kind {
        EVENT_DRIVEN.. => Ok(()),
        SAMPLED_BY_SYNC..=ON_REMOTE_FRAME if remote => Ok(()),
        241..EVENT_DRIVEN if !behaviour.reserved_types_taken => Err(Abort::INVALID_VALUE),
        _ if kind < lowest => Err(Abort::INVALID_VALUE),
        _ => Ok(()),
    }
}

/// The identifier of an enabled PDO stays as it is; an 11-bit one of the NMT, SDO, error control or LSS services is
/// never taken.
fn cob_id(
    objects: &Objects,
    behaviour: &Behaviour,
    address: Address,
    value: u32,
) -> Result<(), Abort> {
    let identifier = value & !(INVALID | NO_REMOTE);
    let restricted = is_restricted(identifier, &behaviour.departs);
    if identifier > 0x7FF || (restricted && value & INVALID == 0) {
        return Err(Abort::INVALID_VALUE);
    }
    let present = objects.number(address).unwrap_or(INVALID);
    if (present | value) & INVALID == 0 && present != value {
        return Err(Abort::DEVICE_STATE);
    }
    Ok(())
}

/// Entries 1 to `count` must be there and fit one PDO.
fn count(objects: &Objects, profile: &Profile, index: u16, count: u8) -> Result<(), Abort> {
    let mut bits = 0;
    for sub in 1..=count {
        let entry = objects
            .number(Address::new(index, sub))
            .ok_or(Abort::MAPPING_TOO_LONG)?;
        bits += mappable(objects, profile, index, entry.into())?;
    }
    if bits > 64 {
        return Err(Abort::MAPPING_TOO_LONG);
    }
    Ok(())
}

/// The length in bits of what `entry` maps at `index`.
fn mappable(
    objects: &Objects,
    profile: &Profile,
    index: u16,
    entry: MappingEntry,
) -> Result<u32, Abort> {
    if profile.complete
        && let Some(bits) = dummy(entry.address)
    {
        let taken = !is_transmit(index) && bits == u32::from(entry.bits);
        return taken.then_some(bits).ok_or(Abort::NOT_MAPPABLE);
    }
    let slot = objects.find(entry.address)?;
    let object = objects.at(slot).ok_or(Abort::NO_OBJECT)?;
    let access = if is_transmit(index) {
        object.readable
    } else {
        object.writable
    };
    let whole = object.bits() == Some(u32::from(entry.bits));
    if !object.mappable || !access || !whole {
        return Err(Abort::NOT_MAPPABLE);
    }
    Ok(u32::from(entry.bits))
}
