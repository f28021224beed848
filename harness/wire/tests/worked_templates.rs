//! The SDO frames that the Huacheng manual prints as templates (section 4.3.3.5): every frame we write for any object
//! and any value is one of them, and only one.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use fieldproof_can::{Frame, Pattern};
use fieldproof_wire::canopen::sdo::{Expedited, Request, Response, Transfer};
use fieldproof_wire::canopen::{AbortCode, Multiplexer, NodeId, Service, cob_id};
use proptest::prelude::*;

/// Example, template, how many bytes of value it has.
const WRITES: [(&str, &str, usize); 4] = [
    ("X7a", "601#23??????????????", 4),
    ("X7b", "601#27????????????00", 3),
    ("X7c", "601#2B??????????0000", 2),
    ("X7d", "601#2F????????000000", 1),
];
const WRITTEN: (&str, &str) = ("X7e", "581#60??????00000000");
const READ: (&str, &str) = ("X8a", "601#40??????00000000");
const VALUES: [(&str, &str, usize); 4] = [
    ("X8b", "581#43??????????????", 4),
    ("X8c", "581#47????????????00", 3),
    ("X8d", "581#4B??????????0000", 2),
    ("X8e", "581#4F????????000000", 1),
];
/// The same for a write and for a read.
const ABORTS: [(&str, &str); 2] = [
    ("X7f", "581#80??????????????"),
    ("X8f", "581#80??????????????"),
];

fn frame(service: Service, bytes: [u8; 8]) -> Frame {
    Frame::of_eight(cob_id(service, Some(NodeId::MIN)), bytes)
}

fn is(frame: &Frame, (example, template): (&str, &str)) {
    let pattern: Pattern = template.parse().unwrap();
    assert!(pattern.matches(frame), "{example}: {frame}");
}

proptest! {
    #[test]
    fn what_we_send_is_the_template(index: u16, sub: u8, value: [u8; 4], code: u32) {
        let object = Multiplexer::new(index, sub);
        let code = AbortCode(code);
        for (example, template, len) in WRITES {
            let transfer = Transfer::Expedited(Expedited::new(&value[..len]).unwrap());
            let request = Request::InitiateDownload { object, transfer };
            is(&frame(Service::SdoRequest, request.encode()), (example, template));
        }
        for (example, template, len) in VALUES {
            let transfer = Transfer::Expedited(Expedited::new(&value[..len]).unwrap());
            let response = Response::InitiateUpload { object, transfer };
            is(&frame(Service::SdoResponse, response.encode()), (example, template));
        }
        let read = Request::InitiateUpload(object);
        is(&frame(Service::SdoRequest, read.encode()), READ);
        let written = Response::InitiateDownload(object);
        is(&frame(Service::SdoResponse, written.encode()), WRITTEN);
        for abort in ABORTS {
            let response = Response::Abort { object, code };
            is(&frame(Service::SdoResponse, response.encode()), abort);
        }
    }

    #[test]
    fn what_the_template_carries_is_read(index: u16, sub: u8, value: [u8; 4]) {
        let object = Multiplexer::new(index, sub);
        let [low, high] = index.to_le_bytes();
        for (example, template, len) in WRITES.into_iter().chain(VALUES) {
            let pattern: Pattern = template.parse().unwrap();
            let mut bytes = [pattern.bytes()[0].exact().unwrap(), low, high, sub, 0, 0, 0, 0];
            bytes[4..4 + len].copy_from_slice(&value[..len]);
            let expected = Transfer::Expedited(Expedited::new(&value[..len]).unwrap());
            let found = if example.starts_with("X7") {
                match Request::parse(&bytes) {
                    Ok(Request::InitiateDownload { object, transfer }) => (object, transfer),
                    other => panic!("{example}: {other:?}"),
                }
            } else {
                match Response::parse(&bytes) {
                    Ok(Response::InitiateUpload { object, transfer }) => (object, transfer),
                    other => panic!("{example}: {other:?}"),
                }
            };
            prop_assert_eq!(found, (object, expected), "{}", example);
        }
    }
}
