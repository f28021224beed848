//! Every worked example of the four manuals is played by a case, byte for byte where it is a frame, or a line says why
//! it is not.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a test may fail this way"
)]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use fieldproof_suite::model::{Case, Crc, ModbusRequest, PdoName, Step};
use fieldproof_suite::{Environment, SourceFile, Suite, load};
use fieldproof_wire::modbus::crc16_bytes;

const DEVICES: [&str; 4] = [
    "huacheng-ssts1",
    "kinco-servo",
    "liaomiao-encoder",
    "teco-jn5-cm-can",
];

/// Frames that a case names and does not play as they stand.
const PLAYED_OTHERWISE: [(&str, &str); 3] = [
    (
        "X4",
        "the manual prints no length for the guarding request; the case asks for one byte",
    ),
    (
        "TE-117",
        "made from the rules: the module may send three characters expedited or in segments",
    ),
    (
        "TE-128",
        "the mapping of the table, which the case decides against: six bytes must come, not eight",
    ),
];

/// One line of a device's `worked-examples.txt`.
struct Example {
    id: String,
    kind: String,
    /// The frame as it should be, and as the manual prints it where that is wrong.
    frames: Vec<String>,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn examples(device: &str) -> Vec<Example> {
    let path = root()
        .join("fixtures/devices")
        .join(device)
        .join("worked-examples.txt");
    let text = fs::read_to_string(path).expect("the list of worked examples");
    let lines = text
        .lines()
        .filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
    lines
        .map(|line| {
            let columns: Vec<&str> = line.split('|').map(str::trim).collect();
            let frames = [columns[4], columns[5]]
                .into_iter()
                .filter(|frame| *frame != "-");
            Example {
                id: columns[0].to_owned(),
                kind: columns[3].to_owned(),
                frames: frames.map(str::to_owned).collect(),
            }
        })
        .collect()
}

fn suites(device: &str) -> Vec<Suite> {
    let folder = root().join("suites/devices").join(device);
    let mut paths: Vec<PathBuf> = fs::read_dir(folder)
        .expect("a folder")
        .map(|e| e.unwrap().path())
        .collect();
    paths.sort();
    let files: Vec<SourceFile> = paths
        .iter()
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "yaml")
        })
        .map(|path| SourceFile {
            path: path.display().to_string(),
            text: fs::read_to_string(path).expect("a suite"),
        })
        .collect();
    let loaded = load(&files);
    assert!(loaded.diagnostics.is_empty(), "{:#?}", loaded.diagnostics);
    loaded.suites
}

/// The cases of a device, each for the node and address it was written for.
fn cases(device: &str) -> Vec<Case> {
    let environment = |case: &Case| Environment {
        node: case.written_for.node,
        address: case.written_for.address,
        ..Environment::default()
    };
    let any = Environment {
        node: Some(1),
        address: Some(1),
        ..Environment::default()
    };
    suites(device)
        .iter()
        .flat_map(|suite| {
            let lowered: Vec<Case> = suite
                .cases()
                .map(|case| {
                    let written = case.lower(&any).expect("a case");
                    case.lower(&environment(&written)).unwrap_or(written)
                })
                .collect();
            lowered
        })
        .collect()
}

/// `id: reason`, a line each.
fn not_played(device: &str) -> BTreeMap<String, String> {
    let path = root()
        .join("suites/devices")
        .join(device)
        .join("not-played.txt");
    let text = fs::read_to_string(path).expect("the list of what is not played");
    text.lines()
        .filter(|line| !line.trim().is_empty() && !line.starts_with('#'))
        .map(|line| {
            let (id, reason) = line.split_once(':').expect("id: reason");
            (id.trim().to_owned(), reason.trim().to_owned())
        })
        .collect()
}

#[test]
fn every_worked_example_is_played_or_a_line_says_why_not() {
    for device in DEVICES {
        let known: BTreeSet<String> = examples(device)
            .into_iter()
            .map(|example| example.id)
            .collect();
        let played: BTreeSet<String> = cases(device)
            .into_iter()
            .flat_map(|case| case.examples)
            .collect();
        let excused = not_played(device);
        for id in &known {
            assert!(
                played.contains(id) != excused.contains_key(id),
                "{device}: {id} must be played by a case or excused in not-played.txt, not both"
            );
        }
        let unknown: Vec<&String> = played
            .iter()
            .chain(excused.keys())
            .filter(|id| !known.contains(*id))
            .collect();
        assert!(
            unknown.is_empty(),
            "{device}: not in worked-examples.txt: {unknown:?}"
        );
        assert!(
            excused.values().all(|reason| reason.len() > 10),
            "{device}: an excuse without a reason"
        );
    }
}

#[test]
fn an_example_that_is_a_frame_is_played_byte_for_byte() {
    let mut wrong = Vec::new();
    for device in DEVICES {
        let cases = cases(device);
        for example in examples(device) {
            if !["can", "modbus"].contains(&example.kind.as_str()) {
                continue;
            }
            let claiming: Vec<&Case> = cases
                .iter()
                .filter(|case| case.examples.contains(&example.id))
                .collect();
            for frame in example.frames.iter().filter(|_| !claiming.is_empty()) {
                if !claiming
                    .iter()
                    .any(|case| plays(case, &example.kind, frame))
                {
                    wrong.push(format!(
                        "{device}: {} is in no case that names it: {frame}",
                        example.id
                    ));
                }
            }
        }
    }
    let excused: Vec<&str> = PLAYED_OTHERWISE.iter().map(|(id, _)| *id).collect();
    let unexcused: Vec<&String> = wrong
        .iter()
        .filter(|line| !excused.iter().any(|id| line.contains(&format!(" {id} "))))
        .collect();
    assert!(unexcused.is_empty(), "{unexcused:#?}");
    assert_eq!(
        wrong.len(),
        excused.len(),
        "an excuse that is not needed: {wrong:#?}"
    );
}

fn plays(case: &Case, kind: &str, frame: &str) -> bool {
    let steps = case
        .control
        .iter()
        .chain(&case.steps)
        .map(|step| &step.value);
    match kind {
        "can" => steps.into_iter().any(|step| is_can(step, frame)),
        _ => steps.into_iter().any(|step| is_modbus(step, frame, case)),
    }
}

fn is_can(step: &Step, text: &str) -> bool {
    let Ok(frame) = text.parse::<fieldproof_can::Frame>() else {
        // A frame with a place that the manual leaves open.
        let pattern: fieldproof_can::Pattern = text.parse().expect("a frame or a pattern");
        return match step {
            Step::Expect(expect) => expect.frame.0.to_string() == pattern.to_string(),
            Step::Send(send) => pattern.matches(&send.frame.0),
            _ => false,
        };
    };
    match step {
        Step::Send(send) => send.frame.0 == frame,
        Step::Expect(expect) => expect.frame.0.matches(&frame),
        Step::Nmt(_) | Step::NmtEnter(_) => frame.id().raw() == 0,
        Step::ExpectBootUp(_) => frame.bytes() == [0] && frame.id().raw() & 0x780 == 0x700,
        Step::Sync(_) => frame.id().raw() == 0x80,
        Step::ExpectTpdo(tpdo) => {
            matches!(tpdo.pdo, PdoName::Number(number)
                if frame.id().raw() & 0x780 == 0x80 + 0x100 * u32::from(number))
                && tpdo
                    .data
                    .as_ref()
                    .is_some_and(|data| data.0.matches(frame.bytes()))
        }
        Step::SendRpdo(rpdo) => rpdo
            .data
            .as_ref()
            .is_some_and(|data| data.0 == frame.bytes()),
        _ => false,
    }
}

fn is_modbus(step: &Step, text: &str, case: &Case) -> bool {
    let frame: Vec<u8> = text
        .split_whitespace()
        .map(|byte| u8::from_str_radix(byte, 16).expect("hex"))
        .collect();
    match step {
        Step::SendBytes(send) => {
            let mut bytes = send.bytes.0.clone();
            if send.crc == Crc::Append {
                bytes.extend(crc16_bytes(&send.bytes.0));
            }
            bytes == frame
        }
        Step::ExpectBytes(expect) => expect.bytes.0.matches(&frame),
        Step::Modbus(modbus) => {
            let address = modbus.to.or(case.written_for.address);
            let mut pdu = match &modbus.request {
                ModbusRequest::ReadHolding { address, count } => {
                    [&[3], &address.to_be_bytes()[..], &count.to_be_bytes()[..]].concat()
                }
                ModbusRequest::Pdu(bytes) => bytes.0.clone(),
                _ => return false,
            };
            pdu.insert(0, address.unwrap_or_default());
            pdu.extend(crc16_bytes(&pdu));
            pdu == frame
        }
        _ => false,
    }
}
