//! The worked frames of the devices' manuals (`fixtures/wire`): decoded, described, and encoded again.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a test fails by panicking"
)]

use std::collections::BTreeSet;

use fieldproof_can::{BytePattern, Frame, Pattern};
use fieldproof_wire::canopen::emergency::Emergency;
use fieldproof_wire::canopen::error_control::ErrorControl;
use fieldproof_wire::canopen::nmt::NmtMessage;
use fieldproof_wire::canopen::sync::Sync;
use fieldproof_wire::canopen::time::TimeOfDay;
use fieldproof_wire::canopen::{Service, identify, lss, sdo};
use fieldproof_wire::describe::{Direction, describe_frame, describe_modbus};
use fieldproof_wire::modbus::rtu::RtuAdu;
use fieldproof_wire::modbus::{Request, Response};
use fieldproof_wire::{Rule, Violation};

const FILES: [(&str, usize, &str); 4] = [
    (
        "huacheng-ssts1",
        31,
        include_str!("../../../fixtures/wire/huacheng-ssts1.txt"),
    ),
    (
        "kinco-servo",
        32,
        include_str!("../../../fixtures/wire/kinco-servo.txt"),
    ),
    (
        "liaomiao-encoder",
        123,
        include_str!("../../../fixtures/wire/liaomiao-encoder.txt"),
    ),
    (
        "teco-jn5-cm-can",
        44,
        include_str!("../../../fixtures/wire/teco-jn5-cm-can.txt"),
    ),
];

struct Line<'a> {
    name: &'a str,
    bytes: &'a str,
    meaning: &'a str,
}

fn lines(file: &str) -> Vec<Line<'_>> {
    file.lines()
        .filter(|line| !line.starts_with('#'))
        .map(|line| {
            let columns: Vec<&str> = line.split('|').map(str::trim).collect();
            let [name, bytes, meaning, source] = columns[..] else {
                panic!("not four columns: {line}");
            };
            assert!(!name.is_empty() && !source.is_empty(), "{line}");
            Line {
                name,
                bytes,
                meaning,
            }
        })
        .collect()
}

#[test]
fn every_worked_frame_is_there_once() {
    let mut names = BTreeSet::new();
    for (file, count, text) in FILES {
        let lines = lines(text);
        assert_eq!(lines.len(), count, "{file}");
        for line in lines {
            assert!(names.insert(line.name), "twice: {}", line.name);
        }
    }
}

#[test]
fn every_worked_frame_means_what_its_line_says() {
    for (_, _, text) in FILES {
        for line in lines(text) {
            match line.bytes.split_at_checked(2) {
                Some(("> ", adu)) => check_adu(&line, adu, Direction::Request),
                Some(("< ", adu)) => check_adu(&line, adu, Direction::Response),
                _ => check_frame(&line),
            }
        }
    }
}

/// A frame that is not the same for every wildcard must mean the same for every wildcard.
fn check_frame(line: &Line<'_>) {
    let pattern: Pattern = line.bytes.parse().unwrap();
    for digit in ["0", "7", "F"] {
        let frame: Frame = line.bytes.replace('?', digit).parse().unwrap();
        assert!(pattern.matches(&frame), "{}", line.name);
        assert_eq!(describe_frame(&frame), line.meaning, "{}", line.name);
        match encoded_again(&frame) {
            Ok(again) if again == frame => {}
            Ok(_) => assert!(line.meaning.contains("instead of"), "{}", line.name),
            Err(violation) => assert!(
                line.meaning.ends_with(&violation.to_string()),
                "{}: {violation}",
                line.name
            ),
        }
    }
}

fn encoded_again(frame: &Frame) -> Result<Frame, Violation> {
    let id = frame.standard_id().unwrap();
    let (service, _) = identify(id).unwrap();
    let sdo = |bytes| Frame::of_eight(id, bytes);
    match service {
        Service::Nmt => NmtMessage::parse(frame).map(|message| message.encode()),
        Service::Sync => Sync::parse(frame).map(|sync| sync.encode()),
        Service::Time => TimeOfDay::parse(frame).map(|time| time.encode()),
        Service::Emergency => Emergency::parse(frame).map(|(node, emcy)| emcy.encode(node)),
        Service::ErrorControl => ErrorControl::parse(frame).map(|(node, c)| c.encode(node)),
        Service::SdoRequest => sdo::Request::parse(frame.bytes()).map(|r| sdo(r.encode())),
        Service::SdoResponse => sdo::Response::parse(frame.bytes()).map(|r| sdo(r.encode())),
        Service::LssRequest => lss::Request::parse(frame).map(|r| r.encode()),
        Service::LssResponse => lss::Response::parse(frame).map(|r| r.encode()),
        Service::TransmitPdo(_) | Service::ReceivePdo(_) => Ok(*frame),
    }
}

fn check_adu(line: &Line<'_>, bytes: &str, direction: Direction) {
    let bytes = bytes.parse::<BytePattern>().unwrap().exact().unwrap();
    let described = describe_modbus(&bytes, direction);
    assert_eq!(described, line.meaning, "{}", line.name);
    let adu = match RtuAdu::parse(&bytes) {
        Ok(adu) => adu,
        Err(violation) => {
            assert_eq!(violation.rule, Rule::Checksum, "{}", line.name);
            assert!(line.name.ends_with("as printed"), "{}", line.name);
            return;
        }
    };
    let pdu = match direction {
        Direction::Request => Request::parse(adu.pdu()).unwrap().encode(),
        Direction::Response => Response::parse(adu.pdu()).unwrap().encode(),
    };
    let again = RtuAdu::new(adu.address(), &pdu).unwrap();
    assert_eq!(again.encode(), bytes, "{}", line.name);
}
