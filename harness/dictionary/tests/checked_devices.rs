//! What the checker finds in the EDS files of the four devices.

use std::collections::BTreeMap;

use fieldproof_dictionary::eds::manual::{self, Table};
use fieldproof_dictionary::eds::{self, Finding};

macro_rules! fixture {
    ($path:literal) => {
        include_str!(concat!("../../../fixtures/devices/", $path))
    };
}

const TECO: &str = fixture!("teco-jn5-cm-can/TECO_510_CAN.eds");

fn findings(text: &str) -> Vec<Finding> {
    eds::check(&eds::read(text))
}

fn shown(findings: &[Finding]) -> Vec<String> {
    findings
        .iter()
        .map(|finding| {
            format!(
                "{} line {}: {}",
                finding.rule.code, finding.line, finding.text
            )
        })
        .collect()
}

#[test]
fn our_own_files_are_free_of_findings() {
    for text in [
        fixture!("liaomiao-encoder/liaomiao-encoder.eds"),
        fixture!("kinco-servo/kinco-servo.eds"),
        fixture!("huacheng-ssts1/huacheng-ssts1.eds"),
        fixture!("canopen-complete/canopen-complete.eds"),
    ] {
        assert_eq!(shown(&findings(text)), [""; 0]);
    }
}

/// Contradiction of the file, code, how often it is found, words of one of the findings.
const CONTRADICTIONS: &[(&str, &str, usize, &str)] = &[
    (
        "TC-40",
        "E021",
        1,
        "is 32, but [OptionalObjects] has 26 entries",
    ),
    (
        "TC-41",
        "E023",
        1,
        "2025 does not belong in [OptionalObjects]",
    ),
    ("TC-42", "E026", 1, "[ManufacturerObjects] is missing"),
    ("TC-43", "E036", 1, "SubNumber=0x15, but [2025] has 22"),
    ("TC-44", "E018", 1, "0x000000EE"),
    ("TC-45", "E040", 4, "6042:00 is Unsigned16"),
    ("TC-46", "E068", 1, "1600, 1601, 1A00, 1A01"),
    ("TC-47", "E017", 1, "DynamicChannelsSupported is 2"),
    ("TC-48", "E015", 1, "BaudRate_100"),
    ("TC-49", "E014", 2, "11:04 AM"),
    ("TC-50", "E054", 7, "$NodeID + 0x80"),
    ("TC-51", "E053", 14, "0X604F0010"),
    ("TC-52", "E031", 7, "vl ramp functiion time;"),
    ("TC-53", "E065", 4, "[6040] is rw and mappable"),
    ("TC-54", "E055", 2, "241 to 251"),
    ("TC-55", "E057", 1, "1006:00 is 10 us"),
    ("TC-56", "E042", 2, "1800:04 is reserved"),
    ("TC-58", "E066", 3, "6040:00 is sent here and received"),
    ("TC-59", "E067", 4, "[1600] has 4 entries and maps 2"),
    ("TC-63", "E032", 3, "Operation  Signal"),
    ("TC-63", "E086", 3, "`Intput` in the name `AI 1 Intput`"),
];

#[test]
fn every_contradiction_of_the_teco_file_is_found_and_nothing_else() {
    let all = findings(TECO);
    for (id, code, times, words) in CONTRADICTIONS {
        let of_code: Vec<&Finding> = all
            .iter()
            .filter(|finding| finding.rule.code == *code)
            .collect();
        assert_eq!(of_code.len(), *times, "{id} {code}: {:#?}", shown(&all));
        assert!(
            of_code.iter().any(|finding| finding.text.contains(words)),
            "{id}: {of_code:#?}"
        );
    }
    let known = |finding: &&Finding| {
        CONTRADICTIONS
            .iter()
            .any(|(_, code, ..)| *code == finding.rule.code)
    };
    let more: Vec<Finding> = all
        .iter()
        .filter(|finding| !known(finding))
        .cloned()
        .collect();
    assert_eq!(shown(&more), [""; 0]);
}

#[test]
fn a_file_is_called_as_it_says() {
    for (text, name) in [
        (TECO, "TECO_510_CAN.eds"),
        (TECO, "teco_510_can.EDS"),
        (
            fixture!("liaomiao-encoder/liaomiao-encoder.eds"),
            "liaomiao-encoder.eds",
        ),
        (fixture!("kinco-servo/kinco-servo.eds"), "kinco-servo.eds"),
        (
            fixture!("huacheng-ssts1/huacheng-ssts1.eds"),
            "huacheng-ssts1.eds",
        ),
        ("[FileInfo]\nFileName=\n", "any.eds"),
        ("[DeviceInfo]\n", "any.eds"),
    ] {
        assert_eq!(eds::check_file_name(&eds::read(text), name), None);
    }
    // TC-64: the name that the manual prints above the file.
    let found = eds::check_file_name(&eds::read(TECO), "00000373000101920000010000010000");
    assert_eq!(
        shown(&[found.unwrap()]),
        [
            "E085 line 5: FileName is TECO_510_CAN.eds, but the file is called 00000373000101920000010000010000"
        ]
    );
}

const TECO_MANUAL: &str = fixture!("teco-jn5-cm-can/manual.objects");

/// Contradiction between the file and the table of the manual: its name, code, entry, words of the finding.
const AGAINST_THE_MANUAL: &[(&str, &str, &str, &str)] = &[
    ("TC-01", "E093", "1005:00", "rw in the EDS, ro in"),
    ("TC-65", "E093", "1005:00", "rw in the EDS, ro in"),
    (
        "TC-02",
        "E094",
        "1006:00",
        "0x0000000A by default in the EDS, 0 in",
    ),
    (
        "TC-03",
        "E092",
        "1008:00",
        "VisibleString in the EDS, Unsigned32 in",
    ),
    (
        "TC-03",
        "E092",
        "1009:00",
        "VisibleString in the EDS, Unsigned32 in",
    ),
    (
        "TC-03",
        "E092",
        "100A:00",
        "VisibleString in the EDS, Unsigned32 in",
    ),
    ("TC-61", "E096", "1016:01", "not supported by the manual"),
    ("TC-21", "E096", "1016:01", "not supported by the manual"),
    ("TC-04", "E094", "1600:00", "2 by default in the EDS, 3 in"),
    (
        "TC-05",
        "E094",
        "1A00:03",
        "0X604F0010 by default in the EDS, 0x604F0020 in",
    ),
    ("TC-06", "E094", "1A01:00", "3 by default in the EDS, 4 in"),
    (
        "TC-06",
        "E094",
        "1A01:04",
        "0X00000000 by default in the EDS, 0x60610008 in",
    ),
    ("TC-09", "E091", "2025:00", "the manual does not"),
    ("TC-60", "E096", "2025:2F", "reserved by the manual"),
    ("TC-62", "E095", "6041:00", "no default in the EDS, 0 in"),
    (
        "TC-30",
        "E092",
        "6042:00",
        "Unsigned16 in the EDS, Integer16 in",
    ),
    (
        "TC-30",
        "E092",
        "6043:00",
        "Unsigned16 in the EDS, Integer16 in",
    ),
    (
        "TC-07",
        "E092",
        "604F:00",
        "Unsigned16 in the EDS, Unsigned32 in",
    ),
    (
        "TC-07",
        "E094",
        "604F:00",
        "100 by default in the EDS, 10000 in",
    ),
    (
        "TC-57",
        "E094",
        "604F:00",
        "100 by default in the EDS, 10000 in",
    ),
    (
        "TC-07",
        "E092",
        "6050:00",
        "Unsigned16 in the EDS, Unsigned32 in",
    ),
];

#[test]
fn every_contradiction_with_the_manual_is_found_and_nothing_else() {
    let table = Table::parse(TECO_MANUAL).unwrap();
    let differences = manual::compare(&eds::read(TECO), &table);
    let mut expected: BTreeMap<(&str, &str), &str> = BTreeMap::new();
    for (id, code, entry, words) in AGAINST_THE_MANUAL {
        expected.insert((code, entry), words);
        let found = differences.iter().find(|difference| {
            let finding = &difference.finding;
            finding.rule.code == *code && finding.text.contains(entry)
        });
        let text = found.map(|difference| difference.finding.text.as_str());
        assert!(
            text.is_some_and(|text| text.contains(words)),
            "{id}: {text:?}"
        );
    }
    assert_eq!(differences.len(), expected.len(), "{differences:#?}");
}

/// Rows of chapter 4.5 of the manual that differ from the file.
const DIFFERING: [&str; 14] = [
    "1005:00", "1006:00", "1008:00", "1009:00", "100A:00", "1600:00", "1A00:03", "1A01:00",
    "1A01:04", "6041:00", "6042:00", "6043:00", "604F:00", "6050:00",
];

#[test]
fn of_the_64_rows_of_the_object_dictionary_14_differ() {
    let (head, group) = TECO_MANUAL.split_once("# Chapter 4.7").unwrap();
    assert!(group.lines().skip(2).all(|line| line.starts_with("2025:")));
    let table = Table::parse(head).unwrap();
    assert_eq!(table.len(), 64);
    let eds = eds::read(TECO);
    let mut differing = Vec::new();
    for row in table.rows() {
        // One row alone, so that every finding is about it or about what it leaves out.
        let alone = Table::parse(head.lines().nth(row.line - 1).unwrap()).unwrap();
        let codes: Vec<&str> = manual::compare(&eds, &alone)
            .iter()
            .filter(|difference| difference.row.is_some())
            .map(|difference| difference.finding.rule.code)
            .collect();
        let place = format!("{:04X}:{:02X}", row.index, row.sub);
        match place.as_str() {
            // It agrees; the manual says beside it that the device does not support it.
            "1016:01" => assert_eq!(codes, ["E096"]),
            _ if codes.is_empty() => {}
            _ => differing.push(place),
        }
    }
    assert_eq!(differing, DIFFERING);
}
