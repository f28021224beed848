//! Servers that do one thing wrong, or go away.

use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::thread;

use fieldproof_link::Framing;
use fieldproof_record::{Event, Verdict};

use crate::bench::{Played, description, play, suites_of};

const READ_TWICE: &str = "
  - case: first
    title: Reads register 1
    cite: [book]
    steps:
      - modbus: {read-holding: {address: 1, count: 1}, expect: {registers: [0x0FB4]}}
  - case: second
    title: Reads it again
    cite: [book]
    steps:
      - modbus: {read-holding: {address: 1, count: 1}, expect: {registers: [0x0FB4]}}
";

/// The right answer to a read of one register on Modbus TCP.
fn right_answer(request: &[u8]) -> Vec<u8> {
    let mut answer = vec![request[0], request[1], 0, 0, 0, 5, request[6], 3, 2];
    answer.extend([0x0F, 0xB4]);
    answer
}

/// Plays both cases against a server that answers its requests, counted from 0, with these bytes, and closes when there
/// are none. RTU requests have 8 bytes, those of Modbus TCP 12.
fn against(
    framing: Framing,
    answer: impl Fn(usize, &[u8]) -> Option<Vec<u8>> + Send + 'static,
) -> Played {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let host_port = listener.local_addr().unwrap().to_string();
    let server = thread::spawn(move || {
        let (mut stream, _) = listener.accept().unwrap();
        let mut request = vec![0; if framing == Framing::ModbusTcp { 12 } else { 8 }];
        for number in 0.. {
            if stream.read_exact(&mut request).is_err() {
                return;
            }
            let Some(answer) = answer(number, &request) else {
                return;
            };
            stream.write_all(&answer).unwrap();
        }
    });
    let device = description("liaomiao-encoder");
    let played = play(&host_port, framing, &device, &suites_of(READ_TWICE));
    server.join().unwrap();
    played
}

/// A failure says what is wrong, and behind a colon with which request and answer.
fn verdicts(played: &Played) -> Vec<(Verdict, &str)> {
    let cases = played.cases().into_iter();
    cases
        .map(|case| {
            let first = case.failures.first();
            let what = first.map_or("", |failure| &failure.what);
            let wrong = match case.verdict {
                Verdict::Fail => what.split(": ").next().unwrap_or(what),
                _ => what,
            };
            (case.verdict, wrong)
        })
        .collect()
}

#[test]
fn right_answers_pass() {
    let played = against(Framing::ModbusTcp, |_, request| Some(right_answer(request)));
    assert_eq!(verdicts(&played), [(Verdict::Pass, ""); 2]);
}

#[test]
fn every_wrong_field_of_the_header_is_noticed_and_the_next_case_is_not_harmed() {
    let cases: [(usize, u8, &str); 5] = [
        (
            1,
            1,
            "the answer carries another transaction identifier than the request",
        ),
        (
            3,
            1,
            "the protocol identifier of the answer is not that of Modbus",
        ),
        (
            5,
            1,
            "the length field of the answer is not that of what it carries",
        ),
        (
            5,
            0x80,
            "the length field of the answer is not that of what it carries",
        ),
        (
            6,
            1,
            "the answer carries another unit identifier than the request",
        ),
    ];
    for (place, bits, what) in cases {
        let played = against(Framing::ModbusTcp, move |number, request| {
            let mut answer = right_answer(request);
            if number == 0 {
                answer[place] ^= bits;
            }
            Some(answer)
        });
        let verdicts = verdicts(&played);
        assert_eq!(verdicts[0], (Verdict::Fail, what), "byte {place}");
        assert_eq!(verdicts[1], (Verdict::Pass, ""), "byte {place}");
    }
}

#[test]
fn a_failure_shows_the_transaction_that_went_wrong() {
    let played = against(Framing::ModbusTcp, |_, request| {
        let mut answer = right_answer(request);
        answer[10] = 0;
        Some(answer)
    });
    assert_eq!(
        played.cases()[0].failures[0].what,
        "the registers hold something else: 3840 (0F00h), and not 4020 (0FB4h): \
         transaction 0001h: 1 register: 0F00h; after read 1 holding register from 0001h"
    );
    let excerpt = &played.cases()[0].excerpt;
    let words: Vec<&str> = excerpt.iter().map(|line| line.decoded.as_str()).collect();
    let expected = [
        "transaction 0001h: read 1 holding register from 0001h",
        "transaction 0001h: 1 register: 0F00h",
    ];
    assert_eq!(words, expected);
    assert_eq!(excerpt[0].raw, "00 01 00 00 00 06 20 03 00 01 00 01");
}

#[test]
fn an_answer_too_many_and_half_an_answer_are_noticed() {
    let twice = against(Framing::ModbusTcp, |_, request| {
        Some([right_answer(request), right_answer(request)].concat())
    });
    let unexpected = (Verdict::Fail, "an unexpected Modbus frame came");
    assert_eq!(verdicts(&twice), [unexpected; 2]);
    let half = against(Framing::ModbusTcp, |_, request| {
        Some(right_answer(request)[..10].to_vec())
    });
    let what = "the length field of the answer is not that of what it carries";
    assert_eq!(verdicts(&half), [(Verdict::Fail, what); 2]);
}

#[test]
fn a_server_that_closes_ends_the_run_and_nothing_of_it_is_lost() {
    let played = against(Framing::ModbusTcp, |number, request| {
        (number == 0).then(|| right_answer(request))
    });
    let closed = "the link failed: port serial is down: the peer closed the connection";
    assert_eq!(
        verdicts(&played),
        [(Verdict::Pass, ""), (Verdict::Error, closed)]
    );
    let stopped = played.outcome.stopped.as_deref();
    assert_eq!(
        stopped,
        Some("port serial is down: the peer closed the connection")
    );
    let serial = |event: &&Event| matches!(event, Event::Serial(_));
    assert_eq!(played.events.iter().filter(serial).count(), 3);
    let Some(Event::LaneFinished(last)) = played.events.last() else {
        panic!("{:?}", played.events.last());
    };
    assert_eq!(last.stopped.as_deref(), stopped);
}

#[test]
fn rtu_frames_are_judged_by_their_crc_and_end_by_themselves() {
    const RIGHT: [u8; 7] = [0x20, 3, 2, 0x0F, 0xB4, 0x01, 0xC4];
    let right = against(Framing::Rtu, |_, _| Some(RIGHT.to_vec()));
    assert_eq!(verdicts(&right), [(Verdict::Pass, ""); 2]);
    let spoilt = against(Framing::Rtu, |number, _| {
        let mut answer = RIGHT;
        answer[6] ^= u8::from(number == 0);
        Some(answer.to_vec())
    });
    let wrong = (Verdict::Fail, "the CRC of the answer is wrong");
    assert_eq!(verdicts(&spoilt), [wrong, (Verdict::Pass, "")]);
    // A byte count that promises more than comes.
    let short = against(Framing::Rtu, |number, _| {
        Some(match number {
            0 => vec![0x20, 3, 4, 0x0F, 0xB4, 0xE1, 0xC4],
            _ => RIGHT.to_vec(),
        })
    });
    let verdicts = verdicts(&short);
    assert_eq!(verdicts[0].0, Verdict::Fail);
    assert_eq!(verdicts[1], (Verdict::Pass, ""));
}

/// Makes sure that the peer's close is a reset: data of ours that it never read.
#[test]
fn a_server_that_resets_is_named_as_such() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let host_port = listener.local_addr().unwrap().to_string();
    let server = thread::spawn(move || {
        let (mut stream, _): (TcpStream, _) = listener.accept().unwrap();
        // Only the first byte is read: closing with the rest unread is a reset.
        stream.read_exact(&mut [0]).unwrap();
    });
    let device = description("liaomiao-encoder");
    let suites = suites_of(READ_TWICE);
    let played = play(&host_port, Framing::ModbusTcp, &device, &suites);
    server.join().unwrap();
    let reset = "the link failed: port serial is down: the peer reset the connection";
    assert_eq!(verdicts(&played), [(Verdict::Error, reset)]);
}
