//! The EDS files of the devices.

use fieldproof_dictionary::eds::{self, Eds};
use fieldproof_dictionary::{Access, DataType, ObjectKind};

macro_rules! fixture {
    ($path:literal) => {
        include_str!(concat!("../../../fixtures/devices/", $path))
    };
}

const TECO: &str = fixture!("teco-jn5-cm-can/TECO_510_CAN.eds");
const ENCODER: &str = fixture!("liaomiao-encoder/liaomiao-encoder.eds");
const KINCO: &str = fixture!("kinco-servo/kinco-servo.eds");
const HUACHENG: &str = fixture!("huacheng-ssts1/huacheng-ssts1.eds");
const COMPLETE: &str = fixture!("canopen-complete/canopen-complete.eds");

/// The default of an entry; no bytes if it has none.
fn default_of(eds: &Eds, index: u16, sub: u8, node: u8) -> Vec<u8> {
    let entry = eds.dictionary.entry(index, sub);
    entry
        .and_then(|entry| entry.default_bytes(node))
        .unwrap_or_default()
}

/// The default of an entry as a number; one that no entry has if it has none.
fn number(eds: &Eds, index: u16, sub: u8, node: u8) -> u32 {
    let bytes = default_of(eds, index, sub, node);
    if bytes.is_empty() {
        return u32::MAX;
    }
    bytes
        .iter()
        .rev()
        .fold(0, |value, byte| value << 8 | u32::from(*byte))
}

#[test]
fn nothing_is_lost_and_the_counts_are_right() {
    for (name, text, objects, entries) in [
        ("teco", TECO, 29, 86),
        ("encoder", ENCODER, 39, 61),
        ("kinco", KINCO, 40, 144),
        ("huacheng", HUACHENG, 74, 230),
    ] {
        let eds = eds::read(text);
        assert_eq!(eds.findings, [], "{name}");
        assert_eq!(eds.dictionary.objects().count(), objects, "{name}");
        assert_eq!(eds.dictionary.entries().count(), entries, "{name}");
        for (index, sub, entry) in eds.dictionary.entries() {
            assert!(
                !matches!(entry.data_type, DataType::Unknown(_)),
                "{name} {index:04X}:{sub:02X}"
            );
            assert_eq!(
                entry.default.is_some(),
                entry.default_bytes(1).is_some(),
                "{name} {index:04X}:{sub:02X}"
            );
        }
    }
}

#[test]
fn sub_index_0_of_our_files_is_the_highest_sub_index() {
    for text in [ENCODER, KINCO, HUACHENG, COMPLETE] {
        let eds = eds::read(text);
        for object in eds.dictionary.objects() {
            let counted = matches!(object.kind, ObjectKind::Array | ObjectKind::Record);
            // A mapping counts what is mapped, an error field what happened.
            let mapping = matches!(object.index, 0x1003 | 0x1600..=0x17FF | 0x1A00..=0x1BFF);
            if counted && !mapping {
                // Sub-index FFh is beside the members: it tells what the object is.
                let mut members = object.entries.keys().rev().filter(|sub| **sub < 0xFF);
                let highest = *members.next().unwrap();
                assert_eq!(
                    number(&eds, object.index, 0, 1),
                    u32::from(highest),
                    "{:04X}",
                    object.index
                );
            }
        }
    }
}

#[test]
fn mappings_of_all_files_name_mappable_objects_of_their_size() {
    for text in [TECO, ENCODER, KINCO, HUACHENG] {
        let eds = eds::read(text);
        let mut checked = 0;
        for object in eds.dictionary.objects() {
            if !matches!(object.index, 0x1600..=0x17FF | 0x1A00..=0x1BFF) {
                continue;
            }
            for sub in 1..=u8::try_from(number(&eds, object.index, 0, 1)).unwrap() {
                let mapped = number(&eds, object.index, sub, 1);
                let target = eds
                    .dictionary
                    .entry((mapped >> 16) as u16, (mapped >> 8) as u8)
                    .unwrap_or_else(|| panic!("{mapped:08X} maps nothing"));
                assert!(target.pdo_mapping, "{mapped:08X}");
                assert_eq!(target.data_type.bits(), Some(mapped & 0xFF), "{mapped:08X}");
                checked += 1;
            }
        }
        assert!(checked > 0);
    }
}

#[test]
fn teco_with_its_contradictions() {
    let eds = eds::read(TECO);
    let group = eds.dictionary.object(0x2025).unwrap();
    let subs: Vec<u8> = group.entries.keys().copied().collect();
    assert_eq!(
        subs,
        [
            0x00, 0x02, 0x03, 0x06, 0x07, 0x08, 0x11, 0x12, 0x13, 0x21, 0x22, 0x23, 0x24, 0x25,
            0x27, 0x28, 0x29, 0x2A, 0x2D, 0x2E, 0x2F, 0x30
        ]
    );
    assert_eq!(number(&eds, 0x2025, 0, 1), 0x30);
    assert_eq!(group.entries.get(&2).unwrap().name, "Operation  Signal");
    assert_eq!(number(&eds, 0x1014, 0, 1), 0x81);
    assert_eq!(number(&eds, 0x1401, 1, 63), 0x33F);
    assert_eq!(number(&eds, 0x1400, 2, 1), 254);
    assert_eq!(number(&eds, 0x1800, 2, 1), 17);
    assert_eq!(number(&eds, 0x1601, 1, 1), 0x604F_0010);
    assert_eq!(default_of(&eds, 0x1008, 0, 1), b"JN5-CM-CAN");
    let status = eds.dictionary.entry(0x6041, 0).unwrap();
    assert_eq!(
        (status.name.as_str(), &status.default),
        ("Status word;", &None)
    );
    let ramp = eds.dictionary.entry(0x604F, 0).unwrap();
    let limits = (
        ramp.low_limit.unwrap().value(1),
        ramp.high_limit.unwrap().value(1),
    );
    assert_eq!((limits, ramp.access), ((1, 60000), Access::ReadWrite));
    assert_eq!(eds.device_info.vendor_number, Some(0xEE));
    assert_eq!(number(&eds, 0x1018, 1, 1), 0x373);
    let rates: Vec<u32> = eds.device_info.bit_rates_kbit_per_s.into_iter().collect();
    assert_eq!(rates, [50, 125, 250, 500]);
}

#[test]
fn encoder_identity_and_pdos() {
    let eds = eds::read(ENCODER);
    let identity: Vec<u32> = (1..=4).map(|sub| number(&eds, 0x1018, sub, 32)).collect();
    assert_eq!(identity, [0x63C, 1, 1, 241_000_888]);
    assert_eq!(default_of(&eds, 0x1000, 0, 32), [0x96, 0x01, 0x02, 0x00]);
    assert_eq!(number(&eds, 0x1010, 1, 32), 2);
    assert_eq!(number(&eds, 0x1800, 1, 32), 0x1A0);
    assert_eq!(
        (number(&eds, 0x1800, 5, 32), number(&eds, 0x6200, 0, 32)),
        (100, 100)
    );
    assert_eq!(
        eds.dictionary.entry(0x6510, 0).unwrap().data_type.bytes(),
        Some(5)
    );
    assert_eq!(eds.device_info.lss_supported, Some(true));
}

#[test]
fn kinco_screens() {
    let eds = eds::read(KINCO);
    let transmit: Vec<u32> = (0..=8).map(|sub| number(&eds, 0x1A00, sub, 1)).collect();
    assert_eq!(transmit, [2, 0x6063_0020, 0x6041_0010, 0, 0, 0, 0, 0, 0]);
    let receive: Vec<u32> = (0..=8).map(|sub| number(&eds, 0x1600, sub, 1)).collect();
    assert_eq!(
        receive,
        [3, 0x60FF_0020, 0x6040_0010, 0x6060_0008, 0, 0, 0, 0, 0]
    );
    let parameters: Vec<u32> = [1, 2, 3, 5]
        .map(|sub| number(&eds, 0x1800, sub, 1))
        .to_vec();
    assert_eq!(parameters, [0x181, 254, 10, 0]);
    assert!(eds.dictionary.entry(0x1800, 4).is_none());
    assert_eq!(
        eds.dictionary.entry(0x607A, 0).unwrap().access,
        Access::WriteOnly
    );
}

#[test]
fn huacheng_mapping_table() {
    let eds = eds::read(HUACHENG);
    let mapped = |index| -> Vec<u32> { (0..=2).map(|sub| number(&eds, index, sub, 1)).collect() };
    assert_eq!(mapped(0x1600), [2, 0x6040_0010, 0x6060_0008]);
    assert_eq!(mapped(0x1601), [2, 0x607A_0020, 0x6081_0020]);
    assert_eq!(mapped(0x1A00), [2, 0x6041_0010, 0x6061_0008]);
    assert_eq!(mapped(0x1A01), [2, 0x6064_0020, 0x606C_0020]);
    assert_eq!(number(&eds, 0x1401, 1, 2), 0x302);
    assert!(eds.dictionary.object(0x6068).is_none());
}

#[test]
fn the_complete_device_has_every_data_type_and_every_object_of_a_slave() {
    let eds = eds::read(COMPLETE);
    assert_eq!(eds.findings, []);
    for code in 0x01..=0x1B_u16 {
        let data_type = DataType::from_code(code);
        if matches!(data_type, DataType::Unknown(_)) {
            continue;
        }
        let settable = eds.dictionary.entry(0x2000 + code, 0).unwrap();
        assert_eq!(settable.data_type, data_type);
        assert!(settable.access.readable() && settable.access.writable());
        assert_eq!(
            settable.default.is_some(),
            settable.default_bytes(1).is_some(),
            "{data_type:?}"
        );
        let fixed = data_type.bits().is_some();
        assert_eq!(settable.pdo_mapping, fixed, "{data_type:?}");
        let sent = eds.dictionary.entry(0x2100 + code, 0);
        assert_eq!(sent.map(|sent| sent.data_type), fixed.then_some(data_type));
        let integer = fixed && settable.low_limit.is_some();
        let others = data_type.is_real()
            || matches!(
                data_type,
                DataType::Boolean | DataType::TimeOfDay | DataType::TimeDifference
            );
        assert_eq!(integer, fixed && !others, "{data_type:?}");
    }
    for index in [
        0x1000, 0x1001, 0x1003, 0x1005, 0x1006, 0x1007, 0x1008, 0x1009, 0x100A, 0x100C, 0x100D,
        0x1010, 0x1011, 0x1012, 0x1013, 0x1014, 0x1015, 0x1016, 0x1017, 0x1018, 0x1019, 0x1029,
        0x1200, 0x1201, 0x1400, 0x1401, 0x1402, 0x1403, 0x1600, 0x1601, 0x1602, 0x1603, 0x1800,
        0x1801, 0x1802, 0x1803, 0x1A00, 0x1A01, 0x1A02, 0x1A03,
    ] {
        assert!(eds.dictionary.object(index).is_some(), "{index:04X}");
    }
    assert_eq!(eds.device_info.lss_supported, Some(true));
    assert_eq!(eds.device_info.bit_rates_kbit_per_s.len(), 8);
}
