//! NMT and the boot-up message.

use super::KIND;
use crate::script::{as_variant, assert_same, conforms, departs, departures};

/// Every command in every state; the heartbeat says which one it is.
const COMMANDS: &str = "
    wait 10 ms
    < 70A#00
    > 60A#2B1710000A000000
    < 58A#6017100000000000
    > 000#800A
    wait 8 ms
    < 70A#7F
    > 000#010A
    < 18A#E803A0860100
    < 38A#FFFDFFFFFF
    wait 9 ms
    < 70A#05
    > 000#020A
    wait 9 ms
    < 70A#04
    > 000#0100
    < 18A#E803A0860100
    < 38A#FFFDFFFFFF
    wait 9 ms
    < 70A#05
    > 000#8000
    wait 9 ms
    < 70A#7F
    > 000#0200
    wait 9 ms
    < 70A#04
    > 000#800A
    wait 9 ms
    < 70A#7F
";

#[test]
fn commands_lead_from_state_to_state() {
    conforms(&KIND, COMMANDS);
}

#[test]
fn commands_that_are_ignored() {
    let stays_stopped = [("< 18A#E803A0860100", ""), ("< 38A#FFFDFFFFFF", "")];
    // The same frames come twice: only the second ones, after Stopped, stay away.
    let kept = [
        ("< 18A#E803A0860100", "< 18A#E803A0860100"),
        ("< 38A#FFFDFFFFFF", "< 38A#FFFDFFFFFF"),
    ];
    let changes = [&kept[..], &stays_stopped[..], &[("< 70A#05", "< 70A#04")]].concat();
    departs(&KIND, "start-ignored-in-stopped", COMMANDS, &changes);
    let last = [
        ("< 70A#7F", "< 70A#7F"),
        ("< 70A#7F", "< 70A#7F"),
        ("< 70A#7F", "< 70A#04"),
    ];
    departs(&KIND, "pre-operational-ignored-in-stopped", COMMANDS, &last);
    let stays = [("< 70A#04", "< 70A#04"), ("< 70A#04", "< 70A#7F")];
    departs(&KIND, "stop-ignored-in-pre-operational", COMMANDS, &stays);
}

#[test]
fn error_control_in_each_state() {
    let silent = [("< 70A#04", ""), ("< 70A#04", "")];
    departs(&KIND, "error-control-silent-in-stopped", COMMANDS, &silent);
    let silent = [("< 70A#7F", ""), ("< 70A#7F", ""), ("< 70A#7F", "")];
    departs(
        &KIND,
        "error-control-silent-in-pre-operational",
        COMMANDS,
        &silent,
    );
}

/// Frames that are no command to this node.
const NO_COMMANDS: &str = "
    wait 10 ms
    < 70A#00
    > 000#010A
    < 18A#E803A0860100
    < 38A#FFFDFFFFFF
    > 000#
    > 000#02
    > 000#020A00
    > 000#020B
    > 000#550A
    > 00000000#020A
    > 60A#4000100000000000
    < 58A#4300100000000000
";

#[test]
fn frames_that_are_no_command() {
    let answer = "< 58A#4300100000000000";
    departs(
        &KIND,
        "nmt-command-of-one-byte-obeyed",
        NO_COMMANDS,
        &[(answer, "")],
    );
    departs(&KIND, "nmt-to-another-obeyed", NO_COMMANDS, &[(answer, "")]);
    departs(
        &KIND,
        "unknown-nmt-command-stops",
        NO_COMMANDS,
        &[(answer, "")],
    );
    departs(
        &KIND,
        "nmt-command-of-three-bytes-resets",
        NO_COMMANDS,
        &[(answer, "< 70A#00")],
    );
    departs(
        &KIND,
        "nmt-extended-identifier-obeyed",
        NO_COMMANDS,
        &[(answer, "")],
    );
    let obeyed = as_variant(&KIND, "long-nmt-commands", NO_COMMANDS);
    assert_same(&obeyed, &departures(NO_COMMANDS, &[(answer, "")]));
}

const RESETS: &str = "
    wait 10 ms
    < 70A#00
    > 60A#2B171000E8030000
    < 58A#6017100000000000
    > 60A#2B06200034120000
    < 58A#6006200000000000
    > 000#820A
    wait 6 ms
    < 70A#00
    > 60A#4017100000000000
    < 58A#4B17100000000000
    > 60A#4006200000000000
    < 58A#4B06200034120000
    > 60A#2B171000E8030000
    < 58A#6017100000000000
    > 000#800A
    > 000#810A
    wait 6 ms
    < 70A#00
    > 60A#4017100000000000
    < 58A#4B17100000000000
    > 60A#4006200000000000
    < 58A#4B062000E8030000
";

#[test]
fn what_a_reset_restores() {
    let heartbeat = ("< 58A#4B17100000000000", "< 58A#4B171000E8030000");
    let same = ("< 58A#4B17100000000000", "< 58A#4B17100000000000");
    let departs = |fault, changes: &[_]| departs(&KIND, fault, RESETS, changes);
    departs("communication-kept-by-reset-communication", &[heartbeat]);
    departs("communication-kept-by-reset-node", &[same, heartbeat]);
    let lost = ("< 58A#4B06200034120000", "< 58A#4B062000E8030000");
    departs("application-lost-by-reset-communication", &[lost]);
    let kept = ("< 58A#4B062000E8030000", "< 58A#4B06200034120000");
    departs("application-kept-by-reset-node", &[kept]);
}

#[test]
fn boot_up_messages() {
    let boot_up = "< 70A#00";
    let all = |instead| [(boot_up, instead); 3];
    let departs = |fault, changes: &[_]| departs(&KIND, fault, RESETS, changes);
    departs("boot-up-missing", &all(""));
    departs("boot-up-twice", &all("< 70A#00\n< 70A#00"));
    departs("boot-up-shows-state", &all("< 70A#7F"));
    departs("boot-up-after-heartbeat", &all("< 70A#7F\n< 70A#00"));
    let after_power_on = (boot_up, boot_up);
    departs(
        "boot-up-only-after-reset-node",
        &[after_power_on, (boot_up, "")],
    );
    let command = "> 000#800A";
    departs("boot-up-repeated", &[(command, "> 000#800A\n< 70A#00")]);
}

/// What SYNC, EMCY and SDO do in Stopped and after it. The node of 1016h is heard and lost.
const SERVICES: &str = "
    wait 10 ms
    < 70A#00
    > 60A#2306100010270000
    < 58A#6006100000000000
    > 60A#2305100080000040
    < 58A#6005100000000000
    > 60A#2316100114006F00
    < 58A#6016100100000000
    > 60A#2F29100101000000
    < 58A#6029100100000000
    wait 8 ms
    < 080#
    > 76F#05
    > 000#020A
    > 60A#2B06200034120000
    wait 30 ms
    > 000#800A
    > 60A#2305100080000000
    < 58A#6005100000000000
    > 60A#4006200000000000
    < 58A#4B062000E8030000
";

#[test]
fn services_in_stopped() {
    let written = ("< 58A#4B062000E8030000", "< 58A#4B06200034120000");
    departs(&KIND, "sdo-obeyed-in-stopped", SERVICES, &[written]);
    let missed = ("wait 30 ms", "wait 30 ms\n< 08A#3081110000000000");
    departs(&KIND, "emergency-sent-in-stopped", SERVICES, &[missed]);
    let goes_on = ("wait 30 ms", "wait 30 ms\n< 080#\n< 080#\n< 080#");
    departs(&KIND, "sync-produced-in-stopped", SERVICES, &[goes_on]);
    departs(
        &KIND,
        "sync-silent-in-pre-operational",
        SERVICES,
        &[("< 080#", "")],
    );
}

#[test]
fn services_in_operational() {
    departs(
        &KIND,
        "sdo-silent-in-operational",
        NO_COMMANDS,
        &[("< 58A#4300100000000000", "")],
    );
    departs(
        &KIND,
        "starts-by-itself",
        "
        wait 10 ms
        < 70A#00
        > 000#800A
        ",
        &[("< 70A#00", "< 70A#00\n< 18A#E803A0860100\n< 38A#FFFDFFFFFF")],
    );
}

/// A TIME in Stopped, and what 210Ch shows then.
#[test]
fn time_in_stopped() {
    let script = "
        wait 10 ms
        < 70A#00
        > 60A#2312100000010080
        < 58A#6012100000000000
        > 000#020A
        > 100#112233040506
        > 000#800A
        > 60A#400C210000000000
        < 58A#410C210006000000
        > 60A#6000000000000000
        < 58A#0300000000000000
    ";
    let taken = ("< 58A#0300000000000000", "< 58A#0311223304050600");
    departs(&KIND, "time-taken-in-stopped", script, &[taken]);
}
