//! Faults of single values of a reference device's dictionary: `wrong-default:6040:00`.

use fieldproof_devices::canopen::{ObjectFault, ObjectFaultKind};
use fieldproof_dictionary::Dictionary;

use crate::library::Device;

/// How many values are given each kind of fault where none is asked for.
const OF_EACH_KIND: usize = 3;

/// The fault that `name` means, if `device` can have it.
pub(crate) fn of(device: &Device, name: &str) -> Option<ObjectFault> {
    let dictionary = dictionary(device)?;
    ObjectFault::parse(name).filter(|fault| fault.fits(dictionary))
}

/// Some of every kind, spread over the dictionary.
pub(crate) fn some(device: &Device) -> Vec<ObjectFault> {
    let Some(dictionary) = dictionary(device) else {
        return Vec::new();
    };
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
        spread(&all)
    };
    ObjectFaultKind::ALL.into_iter().flat_map(of_kind).collect()
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

fn spread(all: &[ObjectFault]) -> Vec<ObjectFault> {
    let steps = OF_EACH_KIND - 1;
    let last = all.len().saturating_sub(1);
    let mut places: Vec<usize> = (0..OF_EACH_KIND).map(|step| step * last / steps).collect();
    places.dedup();
    places
        .into_iter()
        .filter_map(|place| all.get(place).copied())
        .collect()
}

/// Only of what can be simulated.
fn dictionary(device: &Device) -> Option<&Dictionary> {
    let simulated = device.kind.is_some() && device.is_simulated();
    device.dictionary.as_ref().filter(|_| simulated)
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

    #[test]
    fn a_few_are_taken_from_the_whole() {
        let all: Vec<ObjectFault> = (0..=10)
            .map(|sub| ObjectFault::new(ObjectFaultKind::Missing, 0x1000, sub))
            .collect();
        let of = |count: usize| {
            let taken = spread(all.get(..count).unwrap());
            taken.iter().map(ToString::to_string).collect::<Vec<_>>()
        };
        assert_eq!(of(0), [""; 0]);
        assert_eq!(of(1), ["missing:1000:00"]);
        assert_eq!(of(2), ["missing:1000:00", "missing:1000:01"]);
        assert_eq!(
            of(11),
            ["missing:1000:00", "missing:1000:05", "missing:1000:0A"]
        );
    }
}
