//! Heartbeat, guarding and what follows an error.

use super::KIND;
use crate::script::{
    as_variant, assert_same, conforms, departs, departures, with_fault, without_fault,
};

/// 20 ms, 10 ms, and none.
const HEARTBEAT: &str = "
    wait 10 ms
    < 70A#00
    > 60A#2B17100014000000
    < 58A#6017100000000000
    wait 40 ms
    < 70A#7F
    < 70A#7F
    > 60A#2B1710000A000000
    < 58A#6017100000000000
    wait 20 ms
    < 70A#7F
    < 70A#7F
    > 60A#2B17100000000000
    < 58A#6017100000000000
    wait 40 ms
";

#[test]
fn the_heartbeat_follows_1017h() {
    conforms(&KIND, HEARTBEAT);
    let beat = "< 70A#7F";
    let same = (beat, beat);
    let departs = |fault, changes: &[_]| departs(&KIND, fault, HEARTBEAT, changes);
    departs("heartbeat-change-ignored", &[same, same, same, (beat, "")]);
    let long = (beat, "< 70A#7F00000000000000");
    departs("heartbeat-of-eight-bytes", &[long; 4]);
    let toggled = (beat, "< 70A#FF");
    departs("heartbeat-toggles", &[same, toggled, same, toggled]);
    departs(
        "heartbeat-period-doubled",
        &[same, (beat, ""), same, (beat, "")],
    );
}

/// 1017h is saved.
const SAVED: &str = "
    wait 10 ms
    < 70A#00
    > 60A#2B17100014000000
    < 58A#6017100000000000
    > 60A#2310100173617665
    < 58A#6010100100000000
    power off
    power on
    wait 30 ms
    < 70A#00
    < 70A#7F
";

#[test]
fn a_saved_heartbeat_begins_with_the_boot_up() {
    departs(
        &KIND,
        "stored-heartbeat-not-started",
        SAVED,
        &[("< 70A#7F", "")],
    );
    let at_once = as_variant(&KIND, "heartbeat-at-once", SAVED);
    let twice = [
        ("< 58A#6017100000000000", "< 70A#7F\n< 58A#6017100000000000"),
        ("< 70A#7F", "< 70A#7F\n< 70A#7F"),
    ];
    assert_same(&at_once, &departures(SAVED, &twice));
}

/// Nodes 6Fh and 70h within 50 ms: the first has not come yet, comes, comes in time, is late; the second is late later.
const CONSUMERS: &str = "
    wait 10 ms
    < 70A#00
    > 60A#2316100132006F00
    < 58A#6016100100000000
    > 60A#2316100232006F00
    < 58A#8016100243000406
    > 60A#2316100232007000
    < 58A#6016100200000000
    wait 100 ms
    > 76F#05
    wait 40 ms
    > 76F#7F
    wait 40 ms
    > 770#05
    wait 20 ms
    < 08A#3081110000000000
    wait 20 ms
    > 76F#05
    < 08A#0000000000000000
    > 770#05
    wait 40 ms
    > 770#05
    wait 20 ms
    < 08A#3081110000000000
    wait 40 ms
    < 08A#3081110000000000
    > 60A#2316100100000000
    < 08A#0000110000000000
    < 08A#0000000000000000
    < 58A#6016100100000000
    > 60A#2316100200000000
    < 58A#6016100200000000
    wait 100 ms
";

#[test]
fn heartbeats_are_listened_to() {
    conforms(&KIND, CONSUMERS);
}

#[test]
fn each_fault_of_a_heartbeat_consumer_shows() {
    each_shows(
        CONSUMERS,
        &[
            "consumer-before-first-heartbeat",
            "consumer-takes-any-node",
            "consumer-entry-twice-taken",
            "consumer-time-halved",
            "consumer-second-entry-ignored",
            "consumer-not-stopped",
            "consumer-wants-operational",
            "consumer-does-not-resume",
            "lost-heartbeat-reported-again",
            "lost-heartbeat-code-wrong",
            "lost-heartbeat-unnoticed",
        ],
    );
}

/// Each fault makes something else of `script` than a device without one, and than the other faults.
fn each_shows(script: &str, faults: &[&str]) {
    let mut outcomes = vec![without_fault(&KIND, script)];
    for fault in faults {
        let outcome = with_fault(&KIND, fault, script);
        assert!(!outcomes.contains(&outcome), "{fault}:\n{outcome}");
        outcomes.push(outcome);
    }
}

/// A guard time of 20 ms and a factor of 3.
const GUARDING: &str = "
    wait 10 ms
    < 70A#00
    > 60A#2B0C100014000000
    < 58A#600C100000000000
    > 60A#2F0D100003000000
    < 58A#600D100000000000
    wait 100 ms
    > 76F#R1
    > 70A#R1
    < 70A#7F
    wait 30 ms
    > 70A#R8
    < 70A#FF
    wait 50 ms
    > 70A#R1
    < 70A#7F
    wait 60 ms
    < 08A#3081110000000000
    > 70A#R1
    < 08A#0000000000000000
    < 70A#FF
    > 60A#2F0D100000000000
    < 58A#600D100000000000
    > 70A#R1
    < 70A#7F
    wait 100 ms
    > 000#820A
    wait 6 ms
    < 70A#00
    > 70A#R1
    < 70A#7F
    > 60A#2B17100064000000
    < 58A#6017100000000000
    > 70A#R1
    wait 99 ms
    < 70A#7F
";

#[test]
fn a_guarded_node_answers_and_misses_its_master() {
    conforms(&KIND, GUARDING);
    each_shows(
        GUARDING,
        &[
            "guarding-toggle-stuck",
            "guarding-toggle-starts-with-1",
            "guarding-toggle-not-restarted",
            "life-time-before-first-request",
            "life-time-without-factor",
            "life-time-factor-zero-taken",
            "guarding-answer-as-long-as-request",
            "guarding-answers-for-any-node",
            "guarding-ends-heartbeat",
            "lost-master-unnoticed",
        ],
    );
}

#[test]
fn guarding_beside_a_heartbeat_and_with_another_length_is_left_open() {
    let request = "> 70A#R1";
    let same = (request, request);
    let beside = as_variant(&KIND, "guarded-beside-heartbeat", GUARDING);
    let answered = [
        same,
        same,
        same,
        same,
        same,
        (request, "> 70A#R1\n< 70A#FF"),
    ];
    assert_same(&beside, &departures(GUARDING, &answered));
    let by_one_byte = as_variant(&KIND, "guarded-by-one-byte", GUARDING);
    assert!(!by_one_byte.contains("> 70A#R8\n<"), "{by_one_byte}");
}

/// Node 6Fh is heard and lost in Operational, and again in Stopped; the heartbeat says what became of the state.
fn lost(value: u8, operational: &str, stopped: &str) -> String {
    format!(
        "
        wait 10 ms
        < 70A#00
        > 60A#2316100114006F00
        < 58A#6016100100000000
        > 60A#2F2910010{value}000000
        < 58A#6029100100000000
        > 60A#2B17100028000000
        < 58A#6017100000000000
        > 000#010A
        < 18A#E803A0860100
        < 38A#FFFDFFFFFF
        > 76F#05
        wait 30 ms
        < 08A#3081110000000000
        wait 10 ms
        < 70A#{operational}
        > 000#020A
        > 76F#05
        wait 36 ms
        < 70A#{stopped}
        "
    )
}

#[test]
fn what_follows_an_error_is_in_1029h() {
    conforms(&KIND, &lost(0, "7F", "04"));
    conforms(&KIND, &lost(1, "05", "04"));
    conforms(&KIND, &lost(2, "04", "04"));
    let fails = |fault, value, right, wrong| {
        let script = lost(value, right, "04");
        let beat = (format!("< 70A#{right}"), format!("< 70A#{wrong}"));
        departs(&KIND, fault, &script, &[(&beat.0, &beat.1)]);
    };
    fails("error-behaviour-ignored", 0, "7F", "05");
    fails("error-behaviour-fixed", 1, "05", "7F");
    fails("error-behaviour-stops", 1, "05", "04");
    let changes = [("< 70A#04", "< 70A#7F")];
    let script = lost(0, "7F", "04");
    departs(&KIND, "error-behaviour-out-of-stopped", &script, &changes);
}
