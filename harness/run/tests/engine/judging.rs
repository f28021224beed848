//! Verdicts.

use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_record::{Event, Verdict};
use fieldproof_suite::Position;
use fieldproof_suite::device::{Deviation, Feature, Instead};

use crate::scripted::{Answers, Scripted, Setup, frame, soon};

const READ: &str = "
  - case: read
    title: Reads 2000h
    cite: [book]
    steps:
      - sdo-read: {object: \"2000:00\", as: u32, expect: 5}
";

/// Answers a read of 2000h with these frames.
fn answering(answers: &'static [&'static str]) -> Scripted {
    Scripted::new(move |request: &Frame| {
        if *request == frame("601#4000200000000000") {
            answers.iter().map(|text| soon(text)).collect()
        } else {
            Answers::new()
        }
    })
}

#[test]
fn the_right_answer_passes() {
    let played = Setup::default().play(answering(&["581#4300200005000000"]), READ);
    assert_eq!(played.verdict(), (Verdict::Pass, ""));
    assert_eq!(played.outcome.counts.pass, 1);
}

#[test]
fn a_wrong_value_fails_and_shows_the_frames() {
    let played = Setup::default().play(answering(&["581#4300200006000000"]), READ);
    assert_eq!(
        played.verdict(),
        (Verdict::Fail, "2000h:00 holds another value: 6, and not 5")
    );
    let case = played.case();
    assert_eq!(case.failures[0].expected, "5");
    assert_eq!(case.failures[0].actual, "6");
    let raw: Vec<&str> = case.excerpt.iter().map(|line| line.raw.as_str()).collect();
    assert_eq!(raw, ["601#4000200000000000", "581#4300200006000000"]);
    assert_eq!(
        case.failures[0].place.text.trim(),
        "- sdo-read: {object: \"2000:00\", as: u32, expect: 5}"
    );
}

#[test]
fn any_value_but_one_passes() {
    let case = READ.replace("expect: 5", "expect: {other-than: 5}");
    let played = Setup::default().play(answering(&["581#4300200006000000"]), &case);
    assert_eq!(played.verdict(), (Verdict::Pass, ""));
    let played = Setup::default().play(answering(&["581#4300200005000000"]), &case);
    assert_eq!(
        played.verdict(),
        (Verdict::Fail, "2000h:00 holds 5, which it must not")
    );
    assert_eq!(played.case().failures[0].expected, "any but 5");
}

#[test]
fn an_answer_that_comes_twice_fails() {
    let twice = answering(&["581#4300200005000000", "581#4300200005000000"]);
    let played = Setup::default().play(twice, READ);
    assert_eq!(
        played.verdict(),
        (
            Verdict::Fail,
            "an unexpected SDO answer came: SDO value 2000h:00 = 00000005h"
        )
    );
}

#[test]
fn an_emcy_is_noted_and_fails_only_where_it_is_forbidden() {
    let emcy = ["081#1000010000000000", "581#4300200005000000"];
    let device = || {
        Scripted::new(move |request: &Frame| {
            if *request == frame("601#4000200000000000") {
                emcy.map(soon).to_vec()
            } else {
                Vec::new()
            }
        })
    };
    let played = Setup::default().play(device(), READ);
    assert_eq!(played.verdict(), (Verdict::Pass, ""));
    assert!(
        played
            .events
            .iter()
            .any(|event| matches!(event, Event::Note(note) if note.text.contains("081#")))
    );

    let forbidding = READ.replace("    steps:", "    forbids: [emergency]\n    steps:");
    let played = Setup::default().play(device(), &forbidding);
    let (verdict, what) = played.verdict();
    assert_eq!(verdict, Verdict::Fail);
    assert!(
        what.starts_with("an unexpected EMCY came: EMCY of node 1: 0010h"),
        "{what}"
    );
}

#[test]
fn an_abort_must_name_the_object_that_was_asked_for() {
    let played = Setup::default().play(answering(&["581#8001200011000906"]), READ);
    assert_eq!(
        played.verdict(),
        (
            Verdict::Fail,
            "the abort names another object: 2001h:00, and not 2000h:00"
        )
    );
}

#[test]
fn a_spontaneous_boot_up_fails() {
    let booting = answering(&["581#4300200005000000", "701#00"]);
    let played = Setup::default().play(booting, READ);
    assert_eq!(
        played.verdict(),
        (
            Verdict::Fail,
            "an unexpected error control message came: boot-up of node 1"
        )
    );
}

#[test]
fn late_and_never_are_told_apart() {
    let after = |milliseconds: u64| {
        Scripted::new(move |request: &Frame| {
            if *request == frame("601#4000200000000000") {
                vec![(
                    Duration::from_millis(milliseconds),
                    frame("581#4300200005000000"),
                )]
            } else {
                Vec::new()
            }
        })
    };
    let expecting = "
  - case: read
    title: Reads 2000h
    cite: [book]
    steps:
      - send: \"601#4000200000000000\"
      - expect: {frame: \"581#4300200005000000\", within: 20 ms}
";
    assert_eq!(
        Setup::default().play(after(19), expecting).verdict(),
        (Verdict::Pass, "")
    );
    let late = Setup::default().play(after(30), expecting);
    assert_eq!(
        late.verdict(),
        (
            Verdict::Fail,
            "no SDO response for 2000h:00 (581h) came in time; after SDO read 2000h:00"
        )
    );
    assert!(
        late.case().failures[0]
            .actual
            .starts_with("it came after 30."),
        "{:?}",
        late.case()
    );
    let never = Setup::default().play(after(3_000), expecting);
    assert_eq!(never.case().failures[0].actual, "nothing");
}

#[test]
fn a_measurement_across_its_limit_decides_nothing() {
    let device = || {
        Scripted::new(|request: &Frame| {
            if *request == frame("601#4000200000000000") {
                vec![(Duration::from_millis(19), frame("581#4300200005000000"))]
            } else {
                Vec::new()
            }
        })
    };
    let expecting = "
  - case: read
    title: Reads 2000h
    cite: [book]
    steps:
      - send: \"601#4000200000000000\"
      - expect: {frame: \"581#4300200005000000\", within: 20 ms}
";
    let setup = Setup {
        uncertainty: Duration::from_millis(2),
        ..Setup::default()
    };
    let played = setup.play(device(), expecting);
    assert_eq!(
        played.verdict(),
        (
            Verdict::Inconclusive,
            "SDO response time cannot be decided on this link; after SDO read 2000h:00"
        )
    );
}

#[test]
fn an_expectation_does_not_look_past_the_last_send() {
    // The answer to the first request comes before the second is sent: it is not an answer to the second.
    let device = Scripted::new(|request: &Frame| {
        if *request == frame("601#4000200000000000") {
            vec![soon("581#4300200005000000")]
        } else {
            Vec::new()
        }
    });
    let played = Setup::default().play(
        device,
        "
  - case: two-sends
    title: Two requests, one answer
    cite: [book]
    steps:
      - send: \"601#4000200000000000\"
      - expect-silence: {lasting: 10 ms, of: [7E4h]}
      - send: \"601#4000300000000000\"
      - expect: {frame: \"581#4300200005000000\", within: 20 ms}
",
    );
    assert_eq!(
        played.verdict(),
        (
            Verdict::Fail,
            "no SDO response for 2000h:00 (581h) came in time; after SDO read 2000h:00, then SDO read 3000h:00"
        )
    );
}

#[test]
fn a_control_that_does_not_pass_leaves_the_question_open() {
    let played = Setup::default().play(
        answering(&["581#8000200000000206"]),
        "
  - case: refused
    title: A write is refused
    cite: [book]
    effects: [writes]
    control:
      - sdo-read: {object: \"2000:00\", as: u32}
    steps:
      - sdo-write: {object: \"2000:00\", as: u32, value: 1, expect: {abort: 0x06010002}}
",
    );
    assert_eq!(
        played.verdict(),
        (
            Verdict::Inconclusive,
            "reading 2000h:00 is refused: 06020000h (object does not exist)"
        )
    );
}

#[test]
fn a_documented_deviation_is_no_failure_but_only_the_documented_one() {
    let refused = "
  - case: refused
    title: A read is refused
    cite: [book]
    steps:
      - sdo-read: {object: \"2000:00\", as: u32, expect: {abort: 0x06020000}, check: sdo.unknown-object}
";
    let deviates = |code| {
        vec![Deviation {
            check: "sdo.unknown-object".into(),
            instead: Instead::Abort(code),
            cite: Vec::new(),
            at: Position::default(),
        }]
    };
    let device = || answering(&["581#8000200000000008"]);
    let setup = Setup {
        deviates: deviates(0x0800_0000),
        ..Setup::default()
    };
    assert_eq!(
        setup.play(device(), refused).verdict().0,
        Verdict::Deviation
    );
    let setup = Setup {
        deviates: deviates(0x0601_0000),
        ..Setup::default()
    };
    assert_eq!(setup.play(device(), refused).verdict().0, Verdict::Fail);
    assert_eq!(
        Setup::default().play(device(), refused).verdict().0,
        Verdict::Fail
    );
}

#[test]
fn what_is_not_claimed_or_not_permitted_is_skipped_with_the_reason() {
    let needing = READ.replace("    steps:", "    needs: [lss]\n    steps:");
    let played = Setup::default().play(answering(&[]), &needing);
    assert_eq!(
        played.case().reason.as_deref(),
        Some("the device does not claim lss")
    );
    for (needed, reason) in [
        (
            "{another-node: 1}",
            "node-ID 1, which another node is to have, is that of the device",
        ),
        ("{another-node: 2}", ""),
    ] {
        let needing = READ.replace("    steps:", &format!("    needs: {needed}\n    steps:"));
        let played = Setup::default().play(answering(&[]), &needing);
        assert_eq!(played.case().reason.as_deref().unwrap_or_default(), reason);
    }
    let moving = READ.replace("    steps:", "    effects: [moves]\n    steps:");
    let played = Setup::default().play(answering(&[]), &moving);
    assert_eq!(
        played.case().reason.as_deref(),
        Some("the bench does not permit moves")
    );
    assert_eq!(played.verdict().0, Verdict::Skipped);
}

#[test]
fn a_heartbeat_with_a_state_the_node_was_not_told_fails() {
    // Heartbeats are switched on, the node is stopped, and says that it is operational.
    let device = || {
        Scripted::new(|request: &Frame| match request.to_string().as_str() {
            "601#2B1710000A000000" => vec![soon("581#6017100000000000")],
            "601#4017100000000000" => vec![soon("581#4B17100000000000")],
            "000#0201" => vec![(Duration::from_millis(20), frame("701#05"))],
            _ => Vec::new(),
        })
    };
    let cases = "
  - case: stop
    title: Stopped
    cite: [book]
    effects: [writes]
    steps:
      - sdo-write: {object: \"1017:00\", as: u16, value: 10 ms, unit: 1 ms}
      - nmt: stop
      - expect-silence: {lasting: 50 ms, of: [581h]}
";
    let setup = Setup {
        features: vec![Feature::SdoServer],
        ..Setup::default()
    };
    let played = setup.play(device(), cases);
    assert_eq!(
        played.verdict().1,
        "an unexpected error control message came: heartbeat operational; after SDO write 1017h:00 = 10 (Ah), then NMT stop node 1"
    );
}

#[test]
fn a_repetition_ends_with_the_first_time_that_does_not_pass_and_points_inside() {
    let mut answers = 0;
    let device = Scripted::new(move |request: &Frame| {
        if *request != frame("601#4000200000000000") {
            return Vec::new();
        }
        answers += 1;
        vec![soon(if answers < 128 {
            "581#4300200005000000"
        } else {
            "581#4300200006000000"
        })]
    });
    let played = Setup::default().play(
        device,
        "
  - case: often
    title: Reads 2000h again and again
    cite: [book]
    steps:
      - repeat:
          times: 200
          steps:
            - sdo-read: {object: \"2000:00\", as: u32, expect: 5}
",
    );
    assert_eq!(
        played.verdict(),
        (Verdict::Fail, "2000h:00 holds another value: 6, and not 5")
    );
    assert!(played.case().failures[0].place.text.contains("sdo-read"));
    let steps = played
        .events
        .iter()
        .filter(|event| matches!(event, Event::StepStarted(_)))
        .count();
    assert_eq!(steps, 128);
}

#[test]
fn a_repetition_counts() {
    let mut held = 6_u8;
    let device = Scripted::new(move |request: &Frame| {
        if *request != frame("601#4000200000000000") {
            return Vec::new();
        }
        held += 1;
        // The third time it should be 9.
        let value = if held == 9 { 8 } else { held };
        vec![soon(&format!("581#43002000{value:02X}000000"))]
    });
    let played = Setup::default().play(
        device,
        "
  - case: counted
    title: 2000h holds one more each time
    cite: [book]
    steps:
      - repeat:
          times: 5
          count-as: number
          from: 7
          steps:
            - sdo-read: {object: \"2000:00\", as: u32, expect: \"{number}\"}
",
    );
    assert_eq!(
        played.verdict(),
        (Verdict::Fail, "2000h:00 holds another value: 8, and not 9")
    );
    let failure = &played.case().failures[0];
    assert_eq!(
        (failure.expected.as_str(), failure.actual.as_str()),
        ("9", "8")
    );
}

#[test]
fn a_value_or_a_refusal_is_expected() {
    let case = READ.replace(
        "expect: 5",
        "expect: {one-of: [0, 5], abort: [0x08000024, 0x08000000]}",
    );
    for (answer, verdict) in [
        ("581#4300200005000000", (Verdict::Pass, "")),
        ("581#8000200024000008", (Verdict::Pass, "")),
        (
            "581#4300200006000000",
            (
                Verdict::Fail,
                "2000h:00 holds another value: 6, and not one of 0, 5",
            ),
        ),
        (
            "581#8000200022000008",
            (
                Verdict::Fail,
                "2000h:00 is refused with another abort code: \
                 08000022h (data cannot be passed on in the present device state), \
                 and not abort 08000024h (no data available) or 08000000h (general error)",
            ),
        ),
    ] {
        let device = Scripted::new(move |request: &Frame| {
            if *request == frame("601#4000200000000000") {
                vec![soon(answer)]
            } else {
                Answers::new()
            }
        });
        assert_eq!(Setup::default().play(device, &case).verdict(), verdict);
    }
}

#[test]
fn periods_of_frames_are_measured() {
    const EXPECT: &str = "
  - case: periods
    title: SYNC comes every 10 ms
    cite: [book]
    steps:
      - send: \"000#0100\"
      - expect: {frame: \"080#\", within: 15 ms, period: 10 ms ± 10 %, count: 3}
";
    let sent_at = |times: [u64; 4], last: &'static str| {
        Scripted::new(move |request: &Frame| {
            if *request != frame("000#0100") {
                return Answers::new();
            }
            let mut answers: Answers = times
                .iter()
                .map(|time| (Duration::from_millis(*time), frame("080#")))
                .collect();
            answers[3].1 = frame(last);
            answers
        })
    };
    let verdict = |times, last| {
        let played = Setup::default().play(sent_at(times, last), EXPECT);
        let (verdict, words) = played.verdict();
        (verdict, words.to_owned())
    };
    assert_eq!(
        verdict([10, 20, 30, 40], "080#"),
        (Verdict::Pass, String::new())
    );
    assert_eq!(verdict([10, 20, 35, 45], "080#").0, Verdict::Fail);
    assert_eq!(
        verdict([10, 20, 30, 40], "080#01"),
        (
            Verdict::Fail,
            "another frame came than expected: SYNC 1; expected: SYNC; after NMT start all nodes"
                .to_owned()
        )
    );
    assert_eq!(
        verdict([10, 20, 30, 90], "080#"),
        (
            Verdict::Fail,
            "080h stops; after NMT start all nodes".to_owned()
        )
    );
}

#[test]
fn an_answer_that_leaves_its_size_open_is_read_with_the_size_of_the_object() {
    let played = Setup::default().play(
        answering(&["581#4200200005000000"]),
        &READ.replace("u32", "u8"),
    );
    assert_eq!(played.verdict(), (Verdict::Pass, ""));
    // A size that is given must be the right one.
    let played = Setup::default().play(
        answering(&["581#4300200005000000"]),
        &READ.replace("u32", "u8"),
    );
    assert_eq!(
        played.verdict(),
        (
            Verdict::Fail,
            "2000h:00 has another size: 4 bytes: 05 00 00 00, and not 1 byte"
        )
    );
}

#[test]
fn a_transfer_that_goes_wrong_half_way_is_aborted() {
    // Two segments; the second answer repeats the toggle bit of the first.
    let device = Scripted::new(|request: &Frame| {
        let answer = match request.to_string().as_str() {
            "601#4008100000000000" => "581#410810000A000000",
            "601#6000000000000000" => "581#00414243444546",
            "601#7000000000000000" => "581#09484900000000",
            _ => return Vec::new(),
        };
        vec![soon(&format!("{answer:0<20}"))]
    });
    let seen = device.seen.clone();
    let played = Setup::default().play(
        device,
        "
  - case: name
    title: Reads the name
    cite: [book]
    steps:
      - sdo-read: {object: \"1008:00\", as: text}
",
    );
    assert_eq!(
        played.verdict().1,
        "the toggle bit of the segment is not that of the request: toggle 0, and not toggle 1"
    );
    assert_eq!(
        seen.lock().unwrap().last().map(String::as_str),
        Some("601#8008100000000008")
    );
}

#[test]
fn the_record_is_in_the_order_of_time() {
    // Answers at once, and wins the bus from the next request.
    let device = Scripted::new(|request: &Frame| {
        if *request == frame("601#4000200000000000") {
            vec![(Duration::from_micros(1), frame("581#4300200005000000"))]
        } else {
            Vec::new()
        }
    });
    let played = Setup::default().play(
        device,
        "
  - case: two-sends
    title: Two requests in a row
    cite: [book]
    steps:
      - send: \"601#4000200000000000\"
      - send: \"601#4000300000000000\"
      - expect-silence: {lasting: 10 ms, of: [701h]}
",
    );
    let instants: Vec<u64> = played
        .events
        .iter()
        .filter_map(|event| match event {
            Event::Frame(frame) => Some(frame.at_ns),
            _ => None,
        })
        .collect();
    assert!(instants.is_sorted(), "{instants:?}");
}

#[test]
fn another_node_may_boot_while_a_case_is_played() {
    let played = Setup::default().play(
        answering(&["702#00", "702#7F", "581#4300200005000000"]),
        READ,
    );
    assert_eq!(played.verdict(), (Verdict::Pass, ""));
    assert!(
        played
            .events
            .iter()
            .any(|event| matches!(event, Event::Note(note) if note.text.contains("702#00")))
    );
}
