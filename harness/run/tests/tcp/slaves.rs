//! Whole suites against reference slaves.

use std::collections::BTreeMap;

use fieldproof_link::Framing;
use fieldproof_record::{Event, Verdict};

use crate::bench::{Played, Served, description, modbus_suites, play, suites_of, tcp_suite};

fn played(device: &str, framing: Framing) -> Played {
    let served = Served::start(device, framing);
    let suites = modbus_suites(device);
    play(&served.host_port, framing, &description(device), &suites)
}

const RTU: &str = "written as an RTU frame; this link is Modbus TCP";

/// What a case asks for that the device does not have, whatever the link is.
const OF_THE_DEVICE: [&str; 5] = [
    "the device does not claim ",
    "the device has no ",
    "the line has no parity bit",
    "takes long: ",
    "characters take no time on this link",
];
const NO_SILENCE: &str = "no silence ends a frame on this link";

/// Everything passes (or deviates as documented), at least so many cases, or is skipped for a reason that begins like
/// one of these; each of them is met.
#[track_caller]
fn assert_plays(played: &Played, at_least: u32, reasons: &[&str]) {
    let mut skipped: BTreeMap<&str, usize> = BTreeMap::new();
    for case in played.cases() {
        match case.verdict {
            Verdict::Pass | Verdict::Deviation => {}
            Verdict::Skipped => {
                *skipped.entry(case.reason.as_deref().unwrap()).or_default() += 1;
            }
            verdict => panic!("{} is {verdict:?}: {:#?}", case.id, case.failures),
        }
    }
    assert_eq!(played.outcome.stopped, None);
    let counts = played.outcome.counts;
    assert!(
        counts.pass + counts.deviation >= at_least,
        "{counts:?} {skipped:#?}"
    );
    for reason in reasons {
        assert!(
            skipped.keys().any(|it| it.starts_with(reason)),
            "{skipped:#?}"
        );
    }
    for reason in skipped.keys() {
        let mut allowed = reasons.iter().chain(&OF_THE_DEVICE);
        assert!(allowed.any(|it| reason.starts_with(it)), "{skipped:#?}");
    }
}

const NO_STIMULUS: &str = "the bench does not offer the stimulus ";
const OTHER_ADDRESS: &str = "written for address 2, which the device does not have here";
const SENT_ELSEWHERE: &str = "sent to address ";

#[test]
fn the_encoder_over_modbus_tcp() {
    let played = played("liaomiao-encoder", Framing::ModbusTcp);
    assert_plays(&played, 5, &[RTU, NO_STIMULUS, SENT_ELSEWHERE]);
}

#[test]
fn the_servo_over_modbus_tcp() {
    let played = played("huacheng-ssts1", Framing::ModbusTcp);
    assert_plays(&played, 7, &[RTU, NO_STIMULUS, SENT_ELSEWHERE]);
}

#[test]
fn the_encoder_over_rtu_frames() {
    let played = played("liaomiao-encoder", Framing::Rtu);
    assert_plays(&played, 40, &[NO_STIMULUS, NO_SILENCE]);
}

#[test]
fn the_servo_over_rtu_frames() {
    let played = played("huacheng-ssts1", Framing::Rtu);
    assert_plays(&played, 20, &[NO_STIMULUS, OTHER_ADDRESS, NO_SILENCE]);
}

#[test]
fn the_record_shows_the_header_and_says_what_carries_it() {
    let played = played("huacheng-ssts1", Framing::ModbusTcp);
    let Some(Event::LaneStarted(lane)) = played.events.first() else {
        panic!("{:?}", played.events.first());
    };
    let port = &lane.ports[0];
    assert!(port.link.starts_with("tcp:127.0.0.1:"), "{}", port.link);
    assert_eq!(
        (port.line.as_str(), port.timestamps.as_str()),
        ("Modbus TCP", "user space")
    );
    let frames: Vec<_> = played
        .events
        .iter()
        .filter_map(|event| match event {
            Event::Serial(serial) => Some(serial),
            _ => None,
        })
        .collect();
    assert!(frames.len() > 10);
    for (number, pair) in frames.chunks(2).enumerate() {
        let transaction = u16::try_from(number + 1).unwrap().to_be_bytes();
        for frame in pair {
            assert_eq!(frame.bytes[..4], [transaction[0], transaction[1], 0, 0]);
            assert_eq!(usize::from(frame.bytes[5]), frame.bytes.len() - 6);
            assert_eq!(frame.bytes[6], 1);
        }
    }
    let instants = frames.iter().map(|frame| frame.at_ns);
    assert!(instants.is_sorted());
}

#[test]
fn a_server_outlives_its_clients() {
    let served = Served::start("liaomiao-encoder", Framing::ModbusTcp);
    let suites = suites_of(
        "
  - case: address
    title: Reads the address
    cite: [book]
    steps:
      - modbus: {read-holding: {address: 1, count: 1}, expect: {registers: [32]}}
",
    );
    for _ in 0..3 {
        let device = description("liaomiao-encoder");
        let played = play(&served.host_port, Framing::ModbusTcp, &device, &suites);
        assert_eq!(played.outcome.counts.pass, 1);
    }
}

#[test]
fn the_suite_of_modbus_tcp_over_connections() {
    let served = Served::start_with_connections("modbus-complete");
    let device = description("modbus-complete");
    let suites = tcp_suite();
    let played = play(&served.host_port, Framing::ModbusTcp, &device, &suites);
    assert_plays(&played, 45, &[]);
}
