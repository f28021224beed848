//! Which features an EDS shows.
//!
//! | feature | is shown by |
//! | --- | --- |
//! | nmt-slave, sdo-server | nothing: every CANopen device |
//! | sdo-segmented | an object that can be read and is longer than 4 bytes |
//! | heartbeat-producer | 1017h, unless it is fixed at 0 |
//! | node-guarding | 100Ch and 100Dh, unless one is fixed at 0 |
//! | tpdo, rpdo | communication parameters, or their number where CompactPDO leaves them out |
//! | dynamic-mapping | a mapping whose count and entries can be written, unless Granularity is 0 |
//! | sync-consumer, sync-producer | 1005h without and with bit 30 |
//! | emergency | 1014h, unless bit 31 says that it is not valid |
//! | lss | LSS_Supported |
//!
//! An EDS has no word for sdo-block, and knows of no Modbus, SSI or gateway.

use fieldproof_dictionary::eds::Eds;
use fieldproof_dictionary::{DataType, Dictionary, Entry};
use fieldproof_run::feature_name;
use fieldproof_suite::device::Feature;

/// A feature of which an EDS says something.
pub(in super::super) struct Inferred {
    /// The word of the description.
    pub(in super::super) name: &'static str,
    /// What is said.
    pub(in super::super) why: String,
    /// Whether that shows the feature; else it speaks against it.
    pub(in super::super) is_claimed: bool,
}

/// What is said of a feature: `Ok` if it is shown, `Err` if there is something that speaks against it.
type Said = Option<Result<String, String>>;

pub(super) fn inferred(eds: &Eds) -> Vec<Inferred> {
    let dictionary = &eds.dictionary;
    let info = &eds.device_info;
    let everyone = || Some(Ok("every CANopen device".to_owned()));
    let said: [(Feature, Said); 12] = [
        (Feature::NmtSlave, everyone()),
        (Feature::SdoServer, everyone()),
        (Feature::SdoSegmented, long_object(dictionary).map(Ok)),
        (Feature::HeartbeatProducer, can_be_on(dictionary, &[0x1017])),
        (
            Feature::NodeGuarding,
            can_be_on(dictionary, &[0x100C, 0x100D]),
        ),
        (
            Feature::Tpdo,
            pdos(eds, (0x1800, 0x19FF), ("NrOfTXPDO", info.transmit_pdos)),
        ),
        (
            Feature::Rpdo,
            pdos(eds, (0x1400, 0x15FF), ("NrOfRXPDO", info.receive_pdos)),
        ),
        (Feature::DynamicMapping, writable_mapping(eds)),
        (Feature::SyncConsumer, sync(dictionary, false)),
        (Feature::SyncProducer, sync(dictionary, true)),
        (Feature::Emergency, emergency(dictionary)),
        (
            Feature::Lss,
            (info.lss_supported == Some(true)).then(|| Ok("LSS_Supported".to_owned())),
        ),
    ];
    let said = said.into_iter().filter_map(|(feature, said)| {
        let (why, is_claimed) = match said? {
            Ok(why) => (why, true),
            Err(why) => (why, false),
        };
        Some(Inferred {
            name: feature_name(feature),
            why,
            is_claimed,
        })
    });
    said.collect()
}

/// What does not fit into an expedited transfer.
fn long_object(dictionary: &Dictionary) -> Option<String> {
    let long = |entry: &Entry| {
        let bytes = match entry.data_type {
            DataType::VisibleString | DataType::OctetString | DataType::UnicodeString => {
                entry.default_bytes(1).map(|bytes| bytes.len())
            }
            other => other.bytes(),
        };
        entry.access.readable() && bytes.is_some_and(|bytes| bytes > 4)
    };
    let (index, sub, _) = dictionary.entries().find(|(_, _, entry)| long(entry))?;
    Some(format!("{index:04X}h:{sub:02X} is longer than 4 bytes"))
}

/// All of these objects are there, and none is fixed at 0.
fn can_be_on(dictionary: &Dictionary, indices: &[u16]) -> Said {
    let mut names = Vec::new();
    for index in indices {
        let entry = dictionary.entry(*index, 0)?;
        if !entry.access.writable() && number(entry) == Some(0) {
            return Some(Err(format!("{index:04X}h is fixed at 0")));
        }
        names.push(format!("{index:04X}h"));
    }
    Some(Ok(names.join(", ")))
}

fn number(entry: &Entry) -> Option<i128> {
    entry.default.as_ref()?.value(1)
}

fn pdos(eds: &Eds, (low, high): (u16, u16), (key, count): (&str, Option<u16>)) -> Said {
    let mut objects = eds.dictionary.objects().map(|object| object.index);
    if let Some(index) = objects.find(|index| (low..=high).contains(index)) {
        return Some(Ok(format!("{index:04X}h")));
    }
    let count = count.filter(|count| *count > 0)?;
    Some(match eds.device_info.compact_pdo {
        Some(1..) => Ok(format!("{key}={count} with CompactPDO")),
        _ => Err(format!("{key}={count}, but none is described")),
    })
}

fn writable_mapping(eds: &Eds) -> Said {
    let dictionary = &eds.dictionary;
    let is_mapping = |index: u16| matches!(index, 0x1600..=0x17FF | 0x1A00..=0x1BFF);
    let writable = |index: u16, sub: u8| {
        dictionary
            .entry(index, sub)
            .is_some_and(|entry| entry.access.writable())
    };
    let (index, sub, _) = dictionary
        .entries()
        .find(|(index, sub, _)| is_mapping(*index) && *sub > 0 && writable(*index, *sub))?;
    let entry = format!("{index:04X}h:{sub:02X} can be written");
    if eds.device_info.granularity_bits == Some(0) {
        return Some(Err(format!("{entry}, but Granularity=0")));
    }
    Some(match writable(index, 0) {
        true => Ok(entry),
        false => Err(format!("{entry}, but not {index:04X}h:00, their count")),
    })
}

fn sync(dictionary: &Dictionary, produces: bool) -> Said {
    const GENERATES: i128 = 1 << 30;
    let entry = dictionary.entry(0x1005, 0)?;
    let generates = number(entry).is_some_and(|number| number & GENERATES != 0);
    (generates == produces).then(|| {
        Ok(match produces {
            true => "1005h has bit 30".to_owned(),
            false => "1005h".to_owned(),
        })
    })
}

fn emergency(dictionary: &Dictionary) -> Said {
    const NOT_VALID: i128 = 1 << 31;
    let entry = dictionary.entry(0x1014, 0)?;
    let off = number(entry).is_some_and(|number| number & NOT_VALID != 0);
    Some(match off && !entry.access.writable() {
        true => Err("1014h is fixed as not valid".to_owned()),
        false => Ok("1014h".to_owned()),
    })
}
