//! What frames that mean nothing do to the slave: nothing, and with a fault something.

use super::lss_tests::{answers, each_departs};

const REQUEST: &str = "60A#4000100000000000";
const ANSWER: &str = "58A#4300100000000000";

#[test]
fn a_right_slave_bears_everything() {
    let with_answer = |frame| [frame, REQUEST];
    for (fault, frame) in [
        ("stops-at-remote-request", "60A#R"),
        ("stops-at-empty-request", "60A#"),
        ("stops-at-remote-nmt", "000#R"),
        ("nmt-without-node-obeyed", "000#02"),
    ] {
        assert_eq!(
            answers(None, &with_answer(frame)),
            ANSWER,
            "without {fault}"
        );
        assert_eq!(
            answers(Some(fault), &with_answer(frame)),
            "",
            "with {fault}"
        );
    }
}

#[test]
fn each_fault_shows() {
    let boots = "70A#00";
    each_departs(&[
        (
            "stops-at-unknown-command",
            &["60A#E000100000000000", REQUEST],
            "58A#8000100001000405 58A#4300100000000000",
            "",
        ),
        (
            "extended-taken-as-standard",
            &["0000060A#4000100000000000"],
            "",
            ANSWER,
        ),
        (
            "long-sync-resets",
            &["080#0102", "10"],
            "08A#4082000000000000",
            boots,
        ),
        ("short-time-resets", &["100#FF", "10"], "", boots),
        ("empty-pdo-resets", &["20A#", "10"], "", boots),
        (
            "unknown-identifier-reported",
            &["050#"],
            "",
            "08A#1082000000000000",
        ),
        (
            "sdo-filter-of-six-bits",
            &["64A#4000100000000000"],
            "",
            ANSWER,
        ),
        (
            "foreign-heartbeat-ends-own",
            &["60A#2B17100005000000", "70B#0505", "6"],
            "58A#6017100000000000 70A#7F",
            "58A#6017100000000000",
        ),
    ]);
}

#[test]
fn a_leak_shows_after_127_frames() {
    let frames = |count| [vec!["050#"; count], vec![REQUEST]].concat();
    let leaks = Some("stops-after-127-strange-frames");
    assert_eq!(answers(leaks, &frames(127)), ANSWER);
    assert_eq!(answers(leaks, &frames(128)), "");
    assert_eq!(answers(None, &frames(128)), ANSWER);
}
