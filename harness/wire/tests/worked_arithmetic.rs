//! The arithmetic of the devices' manuals that is the codec's: identifiers, command bytes, dictionary values, lengths.
//! Every check carries the id of its example.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use fieldproof_can::{Id, StandardId};
use fieldproof_wire::canopen::emergency::Emergency;
use fieldproof_wire::canopen::nmt::{Command, State};
use fieldproof_wire::canopen::pdo::{Mapping, MappingEntry, PdoIdentifier, TransmissionType};
use fieldproof_wire::canopen::sdo::{Expedited, RawSdo, Request, Response, SegmentData, Transfer};
use fieldproof_wire::canopen::sync::SyncIdentifier;
use fieldproof_wire::canopen::{
    AbortCode, Multiplexer, NodeId, PdoNumber, Service, cob_id, identify, lss,
};
use fieldproof_wire::modbus::pdu;
use fieldproof_wire::modbus::rtu::RtuAdu;
use fieldproof_wire::ssi::SsiFrame;

fn node(raw: u8) -> NodeId {
    NodeId::new(raw).unwrap()
}

fn transmit_pdo(number: u8) -> Service {
    Service::TransmitPdo(PdoNumber::new(number).unwrap())
}

fn receive_pdo(number: u8) -> Service {
    Service::ReceivePdo(PdoNumber::new(number).unwrap())
}

fn id_of(service: Service, node_id: u8) -> u16 {
    cob_id(service, Some(node(node_id))).raw()
}

/// Bytes 4 to 7 of a write of four bytes.
fn written(value: u32) -> [u8; 4] {
    let request = Request::InitiateDownload {
        object: Multiplexer::new(0x2000, 0),
        transfer: Transfer::Expedited(Expedited::new(&value.to_le_bytes()).unwrap()),
    };
    RawSdo(request.encode()).data()
}

#[test]
fn identifier_ranges_of_nodes() {
    let ranges = [
        ("kinco KC-020", Service::SdoRequest, 0x601, 0x67F),
        ("kinco KC-021", Service::SdoResponse, 0x581, 0x5FF),
        ("kinco KC-022", transmit_pdo(1), 0x181, 0x1FF),
        ("kinco KC-023", receive_pdo(1), 0x201, 0x27F),
        ("kinco KC-024", transmit_pdo(2), 0x281, 0x2FF),
        ("kinco KC-025", receive_pdo(2), 0x301, 0x37F),
        ("kinco KC-026", transmit_pdo(3), 0x381, 0x3FF),
        ("kinco KC-027", receive_pdo(3), 0x401, 0x47F),
        ("kinco KC-028", transmit_pdo(4), 0x481, 0x4FF),
        ("kinco KC-029", receive_pdo(4), 0x501, 0x57F),
        ("teco TE-065", Service::Emergency, 0x081, 0x0FF),
        ("teco TE-066", transmit_pdo(1), 0x181, 0x1FF),
        ("teco TE-067", receive_pdo(1), 0x201, 0x27F),
        ("teco TE-068", transmit_pdo(2), 0x281, 0x2FF),
        ("teco TE-069", receive_pdo(2), 0x301, 0x37F),
        ("teco TE-070", Service::SdoResponse, 0x581, 0x5FF),
        ("teco TE-071", Service::SdoRequest, 0x601, 0x67F),
        ("teco TE-072", Service::ErrorControl, 0x701, 0x77F),
    ];
    for (example, service, first, last) in ranges {
        assert_eq!(id_of(service, 1), first, "{example}");
        assert_eq!(id_of(service, 127), last, "{example}");
        for raw in first..=last {
            let node_id = node((raw - first + 1) as u8);
            let identified = identify(StandardId::new(raw).unwrap());
            assert_eq!(identified, Some((service, Some(node_id))), "{example}");
        }
    }
}

#[test]
fn function_codes_are_the_upper_four_bits() {
    let codes = [
        ("teco TE-065", Service::Emergency, 0b0001),
        ("teco TE-066", transmit_pdo(1), 0b0011),
        ("teco TE-067", receive_pdo(1), 0b0100),
        ("teco TE-068", transmit_pdo(2), 0b0101),
        ("teco TE-069", receive_pdo(2), 0b0110),
        ("teco TE-070", Service::SdoResponse, 0b1011),
        ("teco TE-071", Service::SdoRequest, 0b1100),
        ("teco TE-072", Service::ErrorControl, 0b1110),
        ("teco TE-073", Service::Sync, 0b0001),
        ("teco TE-073", Service::Nmt, 0b0000),
    ];
    for (example, service, code) in codes {
        assert_eq!(cob_id(service, None).raw(), code << 7, "{example}");
    }
}

#[test]
fn single_identifiers() {
    let cases = [
        ("huacheng X1", receive_pdo(2), 2, 0x302),
        ("teco TE-074", transmit_pdo(1), 63, 0x1BF),
    ];
    for (example, service, node_id, id) in cases {
        assert_eq!(id_of(service, node_id), id, "{example}");
    }
}

#[test]
fn command_bytes_by_length() {
    let cases = [
        ("kinco KC-031", 0x4F, 1),
        ("kinco KC-032", 0x4B, 2),
        ("kinco KC-033", 0x47, 3),
        ("kinco KC-034", 0x43, 4),
        ("kinco KC-035", 0x2F, 1),
        ("kinco KC-036", 0x2B, 2),
        ("kinco KC-037", 0x27, 3),
        ("kinco KC-038", 0x23, 4),
        ("teco TE-077", 0x43, 4),
        ("teco TE-077", 0x4B, 2),
        ("teco TE-077", 0x4F, 1),
        ("teco TE-077", 0x23, 4),
        ("teco TE-077", 0x2B, 2),
        ("teco TE-077", 0x2F, 1),
    ];
    let object = Multiplexer::new(0x6040, 0);
    for (example, command, len) in cases {
        let transfer = Transfer::Expedited(Expedited::new(&[0xFF; 4][..len]).unwrap());
        let bytes = if command & 0x40 != 0 {
            Response::InitiateUpload { object, transfer }.encode()
        } else {
            Request::InitiateDownload { object, transfer }.encode()
        };
        assert_eq!(bytes[0], command, "{example}");
    }
}

#[test]
fn command_specifiers_kinco_kc_039() {
    let object = Multiplexer::new(0x6040, 0);
    let code = AbortCode::GENERAL_ERROR;
    let cases = [
        (Request::InitiateUpload(object).encode(), 0x40, 2),
        (Response::InitiateDownload(object).encode(), 0x60, 3),
        (Response::Abort { object, code }.encode(), 0x80, 4),
    ];
    for (bytes, command, specifier) in cases {
        assert_eq!(RawSdo(bytes).command(), command);
        assert_eq!(RawSdo(bytes).specifier(), specifier);
    }
}

#[test]
fn values_on_the_wire() {
    let cases = [
        ("kinco KC-003", -12013_i32 as u32, [0x13, 0xD1, 0xFF, 0xFF]),
        ("kinco KC-005", 100_000, [0xA0, 0x86, 0x01, 0x00]),
        ("huacheng D1", 0x0002_0192, [0x92, 0x01, 0x02, 0x00]),
        (
            "liaomiao co-1000h-value",
            0x0002_0196,
            [0x96, 0x01, 0x02, 0x00],
        ),
        (
            "liaomiao co-2000h-value",
            30_819_740,
            [0x9C, 0x45, 0xD6, 0x01],
        ),
        ("liaomiao co-6002h-value", u32::MAX, [0xFF; 4]),
        ("teco TE-061", 0x0001_0192, [0x92, 0x01, 0x01, 0x00]),
    ];
    for (example, value, bytes) in cases {
        assert_eq!(written(value), bytes, "{example}");
    }
}

#[test]
fn the_write_response_of_the_slides_is_not_that_of_the_standard_kinco_kc_007() {
    let printed = [0x60, 0x7A, 0x60, 0x00, 0xA0, 0x86, 0x01, 0x00];
    let violation = Response::check_reserved(&printed).unwrap_err();
    assert_eq!((violation.offset, violation.found.as_str()), (4, "A0h"));
}

#[test]
fn mapping_entries() {
    let cases = [
        ("huacheng P1", 0x6040_0010, 0x6040, 16),
        ("huacheng P2", 0x6060_0008, 0x6060, 8),
        ("huacheng P3", 0x607A_0020, 0x607A, 32),
        ("huacheng P4", 0x6081_0020, 0x6081, 32),
        ("huacheng P5", 0x6041_0010, 0x6041, 16),
        ("huacheng P6", 0x6061_0008, 0x6061, 8),
        ("huacheng P7", 0x6064_0020, 0x6064, 32),
        ("huacheng P8", 0x606C_0020, 0x606C, 32),
        ("huacheng S3a", 0x6041_0010, 0x6041, 16),
        ("huacheng S3b", 0x6061_0008, 0x6061, 8),
        ("kinco KC-011", 0x6063_0020, 0x6063, 32),
        ("kinco KC-011", 0x6041_0010, 0x6041, 16),
        ("kinco KC-011", 0x60FF_0020, 0x60FF, 32),
        ("kinco KC-011", 0x6040_0010, 0x6040, 16),
        ("kinco KC-011", 0x6060_0008, 0x6060, 8),
        ("kinco KC-040", 0x6060_0008, 0x6060, 8),
        ("kinco KC-040", 0x6040_0010, 0x6040, 16),
        ("kinco KC-040", 0x60FF_0020, 0x60FF, 32),
    ];
    for (example, value, index, bits) in cases {
        let entry = MappingEntry::parse(value).unwrap();
        assert_eq!(entry.object, Multiplexer::new(index, 0), "{example}");
        assert_eq!(entry.bits.raw(), bits, "{example}");
        assert_eq!(entry.encode(), value, "{example}");
    }
}

#[test]
fn mapping_lengths() {
    let cases: [(&str, &[u32], usize); 13] = [
        ("huacheng P9", &[0x607A_0020, 0x6081_0020], 8),
        ("huacheng S4", &[0x6041_0010, 0x6061_0008], 3),
        ("kinco KC-009", &[0x6063_0020, 0x6041_0010], 6),
        ("kinco KC-010", &[0x60FF_0020, 0x6040_0010, 0x6060_0008], 7),
        ("kinco KC-044", &[0x6063_0020, 0x6041_0010], 6),
        ("kinco KC-045", &[0x60FF_0020, 0x6040_0010, 0x6060_0008], 7),
        ("teco TE-084", &[0x6040_0010, 0x6042_0010], 4),
        ("teco TE-085", &[0x604F_0010, 0x6050_0010], 4),
        ("teco TE-086", &[0x6040_0010, 0x6042_0010, 0x604F_0020], 8),
        ("teco TE-087", &[0x6040_0010, 0x6042_0010, 0x604F_0010], 6),
        (
            "teco TE-088",
            &[0x603F_0010, 0x6041_0010, 0x6043_0010, 0x6061_0008],
            7,
        ),
        ("teco TE-089", &[0x603F_0010, 0x6041_0010, 0x6043_0010], 6),
        ("huacheng S2", &[], 0),
    ];
    for (example, values, bytes) in cases {
        assert_eq!(Mapping::parse(values).unwrap().bytes(), bytes, "{example}");
    }
}

#[test]
fn pdo_data_by_its_mapping() {
    type Case<'a> = (&'a str, &'a [u32], &'a [u8], &'a [u64]);
    // The encoder's manual prints the layout, two numbers of 32 bits, and not the mapping.
    let cases: [Case; 10] = [
        (
            "kinco KC-008",
            &[0x6063_0020, 0x6041_0010],
            &[0x13, 0xD1, 0xFF, 0xFF, 0x31, 0x02],
            &[0xFFFF_D113, 0x0231],
        ),
        (
            "kinco KC-123",
            &[0x60FF_0020, 0x6040_0010, 0x6060_0008],
            &[0xE8, 0x03, 0x00, 0x00, 0x0F, 0x00, 0x03],
            &[1000, 0x000F, 3],
        ),
        (
            "liaomiao co-tpdo1",
            &[0x6004_0020, 0x2000_0020],
            &[0xD7, 0xC7, 0x00, 0x00, 0x34, 0x07, 0x52, 0x01],
            &[51_159, 22_153_012],
        ),
        (
            "liaomiao co-tpdo2",
            &[0x6004_0020, 0x2000_0020],
            &[0xD7, 0xC7, 0x00, 0x00, 0x34, 0x07, 0x52, 0x01],
            &[51_159, 22_153_012],
        ),
        (
            "teco TE-125",
            &[0x6040_0010, 0x6042_0010],
            &[0x01, 0x00, 0x52, 0x24],
            &[1, 0x2452],
        ),
        (
            "teco TE-126",
            &[0x604F_0010, 0x6050_0010],
            &[0x64, 0x00, 0x64, 0x00],
            &[100, 100],
        ),
        (
            "teco TE-127",
            &[0x6040_0010, 0x6042_0010, 0x604F_0010],
            &[0x01, 0x00, 0x52, 0x24, 0x64, 0x00],
            &[1, 0x2452, 100],
        ),
        (
            "teco TE-128",
            &[0x6040_0010, 0x6042_0010, 0x604F_0020],
            &[0x01, 0x00, 0x52, 0x24, 0x64, 0x00, 0x00, 0x00],
            &[1, 0x2452, 100],
        ),
        (
            "teco TE-129",
            &[0x603F_0010, 0x6041_0010, 0x6043_0010],
            &[0x00, 0x00, 0x01, 0x00, 0x20, 0x4E],
            &[0, 1, 0x4E20],
        ),
        ("huacheng S2", &[], &[], &[]),
    ];
    for (example, mapping, data, values) in cases {
        let mapping = Mapping::parse(mapping).unwrap();
        assert_eq!(mapping.pack(values), Some(data.to_vec()), "{example}");
        let unpacked = mapping.unpack(data).unwrap();
        assert!(
            unpacked.iter().map(|(_, value)| value).eq(values),
            "{example}: {unpacked:?}"
        );
    }
}

#[test]
fn pdo_identifier_values() {
    let cases = [
        ("huacheng S1", 0x8000_0182, false, transmit_pdo(1), 2),
        ("huacheng S5", 0x0000_0182, true, transmit_pdo(1), 2),
        ("kinco KC-012", 0x0000_0181, true, transmit_pdo(1), 1),
        ("kinco KC-013", 0x0000_0201, true, receive_pdo(1), 1),
        ("kinco KC-044", 0x0000_0181, true, transmit_pdo(1), 1),
        ("kinco KC-045", 0x0000_0201, true, receive_pdo(1), 1),
    ];
    for (example, value, valid, service, node_id) in cases {
        let expected = PdoIdentifier {
            valid,
            rtr_allowed: true,
            id: Id::Standard(cob_id(service, Some(node(node_id)))),
        };
        assert_eq!(PdoIdentifier::parse(value), Ok(expected), "{example}");
        assert_eq!(expected.encode(), value, "{example}");
    }
}

#[test]
fn sync_identifier_values() {
    let cases = [
        ("huacheng Y1", 0x4000_0080, true),
        ("huacheng Y2", 0x0000_0080, false),
    ];
    for (example, value, generates) in cases {
        let expected = SyncIdentifier {
            generates,
            id: Id::Standard(cob_id(Service::Sync, None)),
        };
        assert_eq!(SyncIdentifier::parse(value), Ok(expected), "{example}");
        assert_eq!(expected.encode(), value, "{example}");
    }
}

#[test]
fn transmission_types() {
    let cyclic = |code| match TransmissionType::from_code(code) {
        TransmissionType::SynchronousCyclic(count) => u32::from(count.raw()),
        other => panic!("{other}"),
    };
    assert_eq!(cyclic(0x11), 17, "teco TE-081");
    assert_eq!(cyclic(0x13), 19, "teco TE-081");
    let sync_period_ms = 100;
    assert_eq!(cyclic(0x11) * sync_period_ms, 1700, "teco TE-082");
    assert_eq!(cyclic(0x13) * sync_period_ms, 1900, "teco TE-082");
    for example in ["kinco KC-044", "kinco KC-045"] {
        let by_manufacturer = TransmissionType::EventDrivenByManufacturer;
        assert_eq!(
            TransmissionType::from_code(254),
            by_manufacturer,
            "{example}"
        );
    }
}

#[test]
fn nmt_command_specifiers_teco_te_080() {
    let cases = [
        (0x01, Command::Start),
        (0x02, Command::Stop),
        (0x80, Command::EnterPreOperational),
        (0x81, Command::ResetNode),
        (0x82, Command::ResetCommunication),
    ];
    for (code, command) in cases {
        assert_eq!(Command::from_code(code), command);
        assert_eq!(command.code(), code);
    }
}

/// The manual's table gives the states other codes than the standard does.
#[test]
fn states_of_the_manual_are_not_those_of_the_standard_teco_te_079() {
    let standard = [
        (0x04, State::Stopped),
        (0x05, State::Operational),
        (0x7F, State::PreOperational),
    ];
    for (code, state) in standard {
        assert_eq!(State::from_code(code), state);
    }
    for (printed, state) in [
        (0x02, State::Stopped),
        (0x80, State::Operational),
        (0x81, State::PreOperational),
    ] {
        assert_ne!(State::from_code(printed), state);
    }
}

#[test]
fn abort_codes_of_the_slides_kinco_kc_041() {
    let slides = [
        0x0503_0000,
        0x0504_0000,
        0x0504_0001,
        0x0504_0002,
        0x0504_0003,
        0x0504_0004,
        0x0504_0005,
        0x0601_0000,
        0x0601_0001,
        0x0601_0002,
        0x0602_0000,
        0x0604_0041,
        0x0604_0042,
        0x0604_0043,
        0x0604_0047,
        0x0606_0000,
        0x0607_0010,
        0x0607_0012,
        0x0607_0013,
        0x0609_0011,
        0x0609_0030,
        0x0609_0031,
        0x0609_0032,
        0x0609_0036,
        0x0800_0000,
        0x0800_0020,
        0x0800_0021,
        0x0800_0022,
        0x0800_0023,
    ]
    .map(AbortCode);
    assert_eq!(slides.len(), 29);
    let absent: Vec<AbortCode> = AbortCode::NAMED
        .iter()
        .copied()
        .filter(|code| !slides.contains(code))
        .collect();
    let expected = [AbortCode::NO_SDO_CONNECTION, AbortCode::NO_DATA_AVAILABLE];
    assert_eq!(absent, expected);
    assert!(slides.iter().all(|code| code.meaning().is_some()));
}

#[test]
fn switch_positions_as_node_id_teco_te_075() {
    for (switches, node_id) in [
        ("000001", 1),
        ("000010", 2),
        ("000011", 3),
        ("111110", 62),
        ("111111", 63),
    ] {
        let raw = u8::from_str_radix(switches, 2).unwrap();
        assert_eq!(NodeId::new(raw), Some(node(node_id)), "{switches}");
    }
    assert_eq!(NodeId::new(0b000000), None);
}

#[test]
fn bit_rates_of_the_switches_are_in_the_lss_table_teco_te_076() {
    for (switches, kbit, lss_index) in [
        ("00", 50, 6),
        ("01", 125, 4),
        ("10", 250, 3),
        ("11", 500, 2),
    ] {
        assert_eq!(lss::bit_rate(lss_index), Some(kbit * 1000), "{switches}");
    }
}

/// Bit rate times length is at most 62 500 kbit/s m, for rates that are in the LSS table.
#[test]
fn longest_bus_by_bit_rate_teco_te_094() {
    for (lss_index, metres, product) in [
        (2, 100, 50_000),
        (3, 250, 62_500),
        (4, 500, 62_500),
        (6, 1000, 50_000),
    ] {
        let kbit = lss::bit_rate(lss_index).unwrap() / 1000;
        assert_eq!(kbit * metres, product);
        assert!(kbit * metres <= 62_500);
    }
}

/// The name has ten characters: more than a value of four bytes, and two segments.
#[test]
fn a_name_of_ten_characters_is_segmented_teco_te_078() {
    let name = b"JN5-CM-CAN";
    assert_eq!(Expedited::new(name), None);
    let segments: Vec<&[u8]> = name.chunks(7).collect();
    assert_eq!(segments, [&b"JN5-CM-"[..], b"CAN"]);
    assert!(segments.iter().all(|data| SegmentData::new(data).is_some()));
}

/// Request and answer of a register write, and twice the silence between frames, at ten bits a character.
#[test]
fn shortest_write_cycle_on_the_serial_side_teco_te_146() {
    let request = pdu::Request::WriteSingleRegister {
        address: 0x2501,
        value: 1,
    };
    let request = request.encode();
    let response = pdu::Response::WriteSingleRegister {
        address: 0x2501,
        value: 1,
    };
    let response = response.encode();
    let characters = RtuAdu::new(1, &request).unwrap().encode().len()
        + RtuAdu::new(1, &response).unwrap().encode().len()
        + 7;
    let microseconds = characters * 10 * 1_000_000 / 19_200;
    assert_eq!((characters, microseconds), (23, 11_979));
}

#[test]
fn an_ssi_frame_has_34_bits_liaomiao_ssi_frame() {
    let highest_bit = SsiFrame {
        position: 0x8000_0001,
        s1: true,
        s0: false,
    };
    let bits = highest_bit.encode();
    assert_eq!(bits.len(), 34);
    let set: Vec<usize> = (0..34).filter(|clock| bits[*clock]).collect();
    assert_eq!(set, [0, 31, 32]);
}

/// EMCY and SYNC share a function code; node 0 is SYNC.
#[test]
fn sync_is_the_emcy_of_no_node_teco_te_073() {
    let sync = cob_id(Service::Sync, None);
    assert_eq!(identify(sync), Some((Service::Sync, None)));
    let frame = fieldproof_can::Frame::of_eight(sync, [0; 8]);
    assert!(Emergency::parse(&frame).is_err());
}
