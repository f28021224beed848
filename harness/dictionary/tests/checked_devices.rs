//! What the checker finds in the EDS files of the four devices.

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
