//! Faults of single values of a reference device: of its dictionary, `wrong-default:6040:00`, and of its register map,
//! `register-missing:00D4`.

use std::fmt;

use fieldproof_devices::canopen::{ObjectFault, ObjectFaultKind};
use fieldproof_devices::modbus::{RegisterFault, RegisterFaultKind};
use fieldproof_dictionary::Dictionary;
use fieldproof_dictionary::registers::{RegisterMap, Table};
use fieldproof_suite::device::Feature;

use crate::library::Device;
use fieldproof_run::spread;

/// How many values are given each kind of fault where none is asked for.
const OF_EACH_KIND: usize = 3;

/// A fault of one value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ValueFault {
    /// Of the dictionary.
    Object(ObjectFault),
    /// Of the register map.
    Register(RegisterFault),
}

/// What is wrong with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ValueFaultKind {
    Object(ObjectFaultKind),
    Register(RegisterFaultKind),
}

impl ValueFault {
    pub(crate) fn kind(self) -> ValueFaultKind {
        match self {
            ValueFault::Object(fault) => ValueFaultKind::Object(fault.kind()),
            ValueFault::Register(fault) => ValueFaultKind::Register(fault.kind()),
        }
    }
}

impl ValueFaultKind {
    /// What it breaks.
    pub(crate) const fn breaks(self) -> &'static str {
        match self {
            ValueFaultKind::Object(kind) => kind.breaks(),
            ValueFaultKind::Register(kind) => kind.breaks(),
        }
    }
}

impl fmt::Display for ValueFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ValueFault::Object(fault) => fault.fmt(f),
            ValueFault::Register(fault) => fault.fmt(f),
        }
    }
}

/// The fault that `name` means, if `device` can have it.
pub(crate) fn of(device: &Device, name: &str) -> Option<ValueFault> {
    let of_object = ObjectFault::parse(name)
        .filter(|fault| dictionary(device).is_some_and(|it| fault.fits(it)))
        .map(ValueFault::Object);
    let of_register = || {
        RegisterFault::parse(name)
            .filter(|fault| can_show(device, *fault))
            .map(ValueFault::Register)
    };
    of_object.or_else(of_register)
}

/// Some of every kind, spread over the dictionary and over the register map.
pub(crate) fn some(device: &Device) -> Vec<ValueFault> {
    let objects = dictionary(device).map(of_objects).unwrap_or_default();
    let registers = registers(device).map(|map| of_registers(device, map));
    let registers = registers.unwrap_or_default();
    let objects = objects.into_iter().map(ValueFault::Object);
    objects
        .chain(registers.into_iter().map(ValueFault::Register))
        .collect()
}

fn of_objects(dictionary: &Dictionary) -> Vec<ObjectFault> {
    let of_kind = |kind| {
        let all: Vec<ObjectFault> = match kind {
            ObjectFaultKind::Surplus => surplus(dictionary),
            _ => dictionary
                .entries()
                .filter(|(index, _, _)| *index >= 0x1000)
                .map(|(index, sub, _)| ObjectFault::new(kind, index, sub))
                .filter(|fault| fault.fits(dictionary))
                .collect(),
        };
        spread(all, OF_EACH_KIND)
    };
    ObjectFaultKind::ALL.into_iter().flat_map(of_kind).collect()
}

fn of_registers(device: &Device, map: &RegisterMap) -> Vec<RegisterFault> {
    let Some(holding) = map.table(Table::Holding) else {
        return Vec::new();
    };
    let addresses = holding.registers().map(|register| register.address);
    let addresses: Vec<u16> = addresses.chain(holding.holes_beside()).collect();
    let of_kind = |kind| {
        let all = addresses
            .iter()
            .map(|address| RegisterFault::new(kind, *address));
        let all = all.filter(|fault| can_show(device, *fault)).collect();
        spread(all, OF_EACH_KIND)
    };
    let kinds = RegisterFaultKind::ALL.into_iter();
    kinds.flat_map(of_kind).collect()
}

/// A default can be told from another value only where nobody has changed it.
fn can_show(device: &Device, fault: RegisterFault) -> bool {
    let as_made = device
        .description
        .features
        .contains(&Feature::FactorySettings);
    let known = fault.kind() != RegisterFaultKind::WrongDefault || as_made;
    known && registers(device).is_some_and(|map| fault.fits(map))
}

/// Behind the first object, and behind the last sub-index of the first that has any, of those the standard describes.
fn surplus(dictionary: &Dictionary) -> Vec<ObjectFault> {
    let objects = || {
        dictionary
            .objects()
            .filter(|it| (0x1000..0x2000).contains(&it.index))
    };
    let free = objects().find(|it| dictionary.object(it.index + 1).is_none());
    let index = free.map(|it| ObjectFault::new(ObjectFaultKind::Surplus, it.index + 1, 0));
    let record = objects().find(|it| it.entries.len() > 1);
    let sub = record.and_then(|it| Some((it.index, it.entries.keys().last()?.checked_add(1)?)));
    let sub = sub.map(|(index, sub)| ObjectFault::new(ObjectFaultKind::Surplus, index, sub));
    index.into_iter().chain(sub).collect()
}

/// Only of what can be simulated.
fn dictionary(device: &Device) -> Option<&Dictionary> {
    device.dictionary.as_ref().filter(|_| is_simulated(device))
}

/// The same of the register map.
fn registers(device: &Device) -> Option<&RegisterMap> {
    device.registers.as_ref().filter(|_| is_simulated(device))
}

fn is_simulated(device: &Device) -> bool {
    device.kind.is_some() && device.is_simulated()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use fieldproof_dictionary::eds;

    use super::*;

    #[test]
    fn what_is_beside_the_dictionary_is_surplus() {
        let text = "[1000]\nParameterName=a\nObjectType=7\nDataType=7\nAccessType=ro\n\
                    [1001]\nParameterName=b\nObjectType=9\nSubNumber=2\n\
                    [1001sub0]\nParameterName=c\nObjectType=7\nDataType=5\nAccessType=ro\n\
                    [1001sub2]\nParameterName=d\nObjectType=7\nDataType=5\nAccessType=ro\n";
        let found = surplus(&eds::read(text).dictionary);
        let names: Vec<String> = found.iter().map(ToString::to_string).collect();
        assert_eq!(names, ["surplus:1002:00", "surplus:1001:03"]);
    }
}
