//! The objects that a frame is about, by the names that the device's dictionary gives them.

use fieldproof_can::Frame;
use fieldproof_dictionary::{Dictionary, Object};
use fieldproof_wire::canopen::pdo::Mapping;
use fieldproof_wire::canopen::sdo::RawSdo;
use fieldproof_wire::canopen::{Multiplexer, PdoNumber, Service, identify};

/// `Controlword` for an SDO frame, `Position value = 0000C7D7h, SpeedValue = 01520734h` for a PDO. `words` is what the
/// frame says without a dictionary.
pub(crate) fn object_names(frame: &Frame, words: &str, dictionary: &Dictionary) -> Option<String> {
    let (service, _) = frame.standard_id().and_then(identify)?;
    match service {
        Service::SdoRequest | Service::SdoResponse => {
            let raw = RawSdo::from_slice(frame.bytes()).ok()?;
            // Segments carry no object: their bytes must not be read as one.
            words
                .contains(&raw.multiplexer().to_string())
                .then(|| name(dictionary, raw.multiplexer()))?
        }
        Service::TransmitPdo(number) => {
            pdo_values(frame, mapping(dictionary, 0x1A00, number)?, dictionary)
        }
        Service::ReceivePdo(number) => {
            pdo_values(frame, mapping(dictionary, 0x1600, number)?, dictionary)
        }
        _ => None,
    }
}

/// The mapping that a PDO has by default. A case may have changed it: then the lengths seldom agree, and nothing is
/// said.
fn mapping(dictionary: &Dictionary, first: u16, number: PdoNumber) -> Option<Mapping> {
    let object = dictionary.object(first + u16::from(number.raw()) - 1)?;
    let count = default(object, 0)?;
    let entries: Option<Vec<u32>> = (1..=count)
        .map(|sub| default(object, u8::try_from(sub).ok()?))
        .collect();
    Mapping::parse(&entries?).ok()
}

fn default(object: &Object, sub: u8) -> Option<u32> {
    let default = object.entries.get(&sub)?.default.as_ref()?;
    default.value(0).and_then(|value| u32::try_from(value).ok())
}

fn pdo_values(frame: &Frame, mapping: Mapping, dictionary: &Dictionary) -> Option<String> {
    if frame.is_remote() || mapping.bytes() != frame.len() || frame.is_empty() {
        return None;
    }
    let values = mapping.unpack(frame.bytes()).ok()?;
    let parts: Vec<String> = values
        .into_iter()
        .zip(mapping.entries())
        .map(|((object, value), entry)| {
            let digits = usize::from(entry.bits.raw()).div_ceil(4);
            let name = name(dictionary, object).unwrap_or_else(|| object.to_string());
            format!("{name} = {value:0digits$X}h")
        })
        .collect();
    Some(parts.join(", "))
}

/// The object's name, and that of the sub-index where there are several.
fn name(dictionary: &Dictionary, object: Multiplexer) -> Option<String> {
    let known = dictionary.object(object.index)?;
    match known.entries.get(&object.sub) {
        Some(entry) if known.entries.len() > 1 => Some(format!("{}, {}", known.name, entry.name)),
        _ => Some(known.name.clone()),
    }
}

#[cfg(test)]
mod tests {
    use fieldproof_dictionary::eds;

    use super::*;

    const EDS: &str = "
[6004]
ParameterName=Position value
ObjectType=0x7
DataType=0x0007
AccessType=ro
PDOMapping=1
[2000]
ParameterName=Speed
ObjectType=0x7
DataType=0x0004
AccessType=ro
PDOMapping=1
[1A00]
ParameterName=TPDO1 mapping
ObjectType=0x9
SubNumber=3
[1A00sub0]
ParameterName=Count
DataType=0x0005
AccessType=rw
DefaultValue=2
[1A00sub1]
ParameterName=First
DataType=0x0007
AccessType=rw
DefaultValue=0x60040020
[1A00sub2]
ParameterName=Second
DataType=0x0007
AccessType=rw
DefaultValue=0x20000020
";

    fn names(text: &str) -> Option<String> {
        let frame: Frame = text.parse().expect("a frame");
        let words = fieldproof_wire::describe::describe_frame(&frame);
        object_names(&frame, &words, &eds::read(EDS).dictionary)
    }

    #[test]
    fn the_values_of_a_pdo_are_named() {
        assert_eq!(
            names("1A0#D7C7000034075201").as_deref(),
            Some("Position value = 0000C7D7h, Speed = 01520734h")
        );
        // Another length than mapped, a PDO without a mapping, no PDO.
        assert_eq!(names("1A0#D7C70000"), None);
        assert_eq!(names("2A0#D7C7000034075201"), None);
        assert_eq!(names("080#"), None);
    }

    #[test]
    fn the_object_of_an_sdo_frame_is_named_and_segments_have_none() {
        assert_eq!(
            names("620#4004600000000000").as_deref(),
            Some("Position value")
        );
        assert_eq!(
            names("620#40001A0100000000").as_deref(),
            Some("TPDO1 mapping, First")
        );
        assert_eq!(names("5A0#0004600000000000"), None);
    }
}
