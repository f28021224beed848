//! SYNC, EMCY, TIME, storing and COB-IDs: what the slave does, and what each fault changes.

use super::KIND;
use crate::Settings;
use crate::script::{Script, assert_same, conforms, departs};

/// With a period of 20 ms.
const PRODUCED: &str = "
    wait 10 ms
    < 70A#00
    > 60A#23061000204E0000
    < 58A#6006100000000000
    > 60A#2305100080000040
    < 58A#6005100000000000
    wait 22 ms
    < 080#
    > 60A#23051000A0060040
    < 58A#8005100022000008
    > 60A#2306100000000000
    < 58A#6006100000000000
    wait 60 ms
    > 60A#2305100080000000
    < 58A#6005100000000000
    > 60A#23051000A0060040
    < 58A#6005100000000000
    > 60A#23061000204E0000
    < 58A#6006100000000000
    wait 22 ms
    < 6A0#
    > 000#020A
    wait 30 ms
";

#[test]
fn sync_is_produced_while_it_may() {
    conforms(&KIND, PRODUCED);
    for (fault, changes) in [
        (
            "sync-identifier-unprotected",
            &[("< 58A#8005100022000008", "< 58A#6005100000000000")][..],
        ),
        ("sync-identifier-fixed", &[("< 6A0#", "< 080#")]),
        (
            "sync-outlives-period",
            &[("wait 60 ms", "wait 60 ms\n< 080#\n< 080#\n< 080#")],
        ),
        ("sync-in-stopped", &[("wait 30 ms", "wait 30 ms\n< 6A0#")]),
        (
            "sync-in-operational-only",
            &[("< 080#", ""), ("< 6A0#", "")],
        ),
        ("sync-starts-late", &[("< 080#", ""), ("< 6A0#", "")]),
        ("sync-period-in-10-us", &[("< 080#", ""), ("< 6A0#", "")]),
    ] {
        departs(&KIND, fault, PRODUCED, changes);
    }
}

/// TPDO1 follows SYNC; its window is 1 ms.
const TAKEN: &str = "
    wait 10 ms
    < 70A#00
    > 60A#230018018A010080
    < 58A#6000180100000000
    > 60A#2F00180201000000
    < 58A#6000180200000000
    > 60A#230018018A010000
    < 58A#6000180100000000
    > 60A#23071000E8030000
    < 58A#6007100000000000
    > 000#010A
    < 38A#FFFDFFFFFF
    > 080#R
    > 080#01
    < 08A#4082000000000000
    > 080#
    < 18A#E803A0860100
    < 28A#0500000000000000
";

#[test]
fn sync_is_a_data_frame_without_data() {
    conforms(&KIND, TAKEN);
    for (fault, changes) in [
        (
            "sync-by-remote-frame",
            &[(
                "> 080#R",
                "> 080#R\n< 18A#E803A0860100\n< 28A#0500000000000000",
            )][..],
        ),
        (
            "sync-length-unchecked",
            &[(
                "< 08A#4082000000000000",
                "< 18A#E803A0860100\n< 28A#0500000000000000",
            )],
        ),
        (
            "sync-window-in-ns",
            &[("< 18A#E803A0860100", ""), ("< 28A#0500000000000000", "")],
        ),
        (
            "sync-cob-id-lost",
            &[
                ("< 08A#4082000000000000", ""),
                ("< 18A#E803A0860100", ""),
                ("< 28A#0500000000000000", ""),
            ],
        ),
    ] {
        departs(&KIND, fault, TAKEN, changes);
    }
}

const COUNTER: &str = "
    wait 10 ms
    < 70A#00
    > 60A#2F19100001000000
    < 58A#8019100030000906
    > 60A#2F191000F0000000
    < 58A#6019100000000000
    > 60A#2306100010270000
    < 58A#6006100000000000
    > 60A#2F19100002000000
    < 58A#8019100022000008
    > 60A#2305100080000040
    < 58A#6005100000000000
    wait 10 ms
    < 080#01
    > 000#020A
    > 000#800A
    wait 10 ms
    < 080#01
";

#[test]
fn the_counter_has_its_rules() {
    conforms(&KIND, COUNTER);
    for (fault, changes) in [
        (
            "sync-counter-of-1-taken",
            &[("< 58A#8019100030000906", "< 58A#6019100000000000")][..],
        ),
        (
            "sync-counter-above-127-refused",
            &[
                ("< 58A#6019100000000000", "< 58A#8019100030000906"),
                ("< 080#01", "< 080#"),
                ("< 080#01", "< 080#"),
            ],
        ),
        (
            "sync-counter-from-0",
            &[("< 080#01", "< 080#00"), ("< 080#01", "< 080#00")],
        ),
        (
            "sync-counter-outlives-stopped",
            &[
                ("wait 10 ms", "wait 10 ms"),
                ("< 080#01", "< 080#01"),
                ("< 080#01", "< 080#02"),
            ],
        ),
    ] {
        departs(&KIND, fault, COUNTER, changes);
    }
}

/// RPDO1 has six bytes.
const FORCED: &str = "
    wait 10 ms
    < 70A#00
    > 60A#4003100100000000
    < 58A#8003100124000008
    > 000#010A
    < 18A#E803A0860100
    < 38A#FFFDFFFFFF
    > 20A#
    < 08A#1082000000000000
    > 20A#01000200000007
    < 08A#2082000000000000
    < 18A#010002000000
    > 60A#4003100000000000
    < 58A#4F03100002000000
    > 60A#4003100100000000
    < 58A#4303100120820000
    > 60A#2F03100001000000
    < 58A#8003100030000906
    > 60A#2F03100000000000
    < 58A#6003100000000000
    > 60A#4003100100000000
    < 58A#8003100124000008
";

#[test]
fn lengths_of_rpdos_are_reported_and_remembered() {
    conforms(&KIND, FORCED);
    for (fault, changes) in [
        (
            "emergency-cut",
            &[
                ("< 08A#1082000000000000", "< 08A#108200"),
                ("< 08A#2082000000000000", "< 08A#208200"),
            ][..],
        ),
        (
            "errors-appended",
            &[("< 58A#4303100120820000", "< 58A#4303100110820000")],
        ),
        (
            "history-count-taken",
            &[("< 58A#8003100030000906", "< 58A#6003100000000000")],
        ),
        (
            "short-pdo-unreported",
            &[
                ("< 08A#1082000000000000", ""),
                ("< 58A#4F03100002000000", "< 58A#4F03100001000000"),
            ],
        ),
    ] {
        departs(&KIND, fault, FORCED, changes);
    }
}

#[test]
fn a_fault_of_the_hardware_shows_in_the_error_register() {
    const LASTING: &str = "
        wait 10 ms
        < 70A#00
        begin hardware-fault
        wait 1 ms
        < 08A#0050010000000000
        > 60A#4001100000000000
        < 58A#4F01100001000000
        end hardware-fault
        wait 1 ms
        < 08A#0000000000000000
        > 60A#4001100000000000
        < 58A#4F01100000000000
        > 000#020A
        begin hardware-fault
        wait 1 ms
    ";
    conforms(&KIND, LASTING);
    for (fault, changes) in [
        (
            "error-register-stuck",
            &[
                ("< 08A#0000000000000000", "< 08A#0000010000000000"),
                ("< 58A#4F01100000000000", "< 58A#4F01100001000000"),
            ][..],
        ),
        (
            "error-register-blind",
            &[
                ("< 08A#0050010000000000", "< 08A#0050000000000000"),
                ("< 58A#4F01100001000000", "< 58A#4F01100000000000"),
            ],
        ),
        (
            "emergency-in-operational-only",
            &[
                ("< 08A#0050010000000000", ""),
                ("< 08A#0000000000000000", ""),
            ],
        ),
    ] {
        departs(&KIND, fault, LASTING, changes);
    }
}

const IDENTIFIER: &str = "
    wait 10 ms
    < 70A#00
    > 60A#23141000A0060000
    < 58A#8014100022000008
    > 60A#231410008A000080
    < 58A#6014100000000000
    begin hardware-fault
    wait 1 ms
    > 60A#23141000E4070000
    < 58A#8014100030000906
    > 60A#23141000A0060000
    < 58A#6014100000000000
    end hardware-fault
    wait 1 ms
    < 6A0#0000000000000000
";

#[test]
fn an_emcy_has_the_identifier_of_1014h() {
    conforms(&KIND, IDENTIFIER);
    for (fault, changes) in [
        (
            "emergency-identifier-unprotected",
            &[("< 58A#8014100022000008", "< 58A#6014100000000000")][..],
        ),
        (
            "emergency-identifier-fixed",
            &[("< 6A0#0000000000000000", "< 08A#0000000000000000")],
        ),
        (
            "emergency-while-invalid",
            &[("wait 1 ms", "wait 1 ms\n< 08A#0050010000000000")],
        ),
    ] {
        departs(&KIND, fault, IDENTIFIER, changes);
    }
}

const RESTRICTED: &str = "
    wait 10 ms
    < 70A#00
    > 60A#230510007F000000
    < 58A#8005100030000906
    > 60A#2305100081050000
    < 58A#8005100030000906
    > 60A#2305100080050000
    < 58A#6005100000000000
    > 60A#2312100001010080
    < 58A#8012100030000906
    > 60A#230014018A010080
    < 58A#6000140100000000
    > 60A#23001401FF060000
    < 58A#8000140130000906
";

#[test]
fn restricted_identifiers() {
    conforms(&KIND, RESTRICTED);
    departs(
        &KIND,
        "high-identifiers-taken",
        RESTRICTED,
        &[
            ("< 58A#8005100030000906", "< 58A#8005100030000906"),
            ("< 58A#8005100030000906", "< 58A#6005100000000000"),
            ("< 58A#8000140130000906", "< 58A#6000140100000000"),
        ],
    );
    departs(
        &KIND,
        "restricted-identifiers-taken",
        RESTRICTED,
        &[
            ("< 58A#8005100030000906", "< 58A#6005100000000000"),
            ("< 58A#8005100030000906", "< 58A#6005100000000000"),
            ("< 58A#8012100030000906", "< 58A#6012100000000000"),
            ("< 58A#8000140130000906", "< 58A#6000140100000000"),
        ],
    );
}

const TIME: &str = "
    wait 10 ms
    < 70A#00
    > 60A#2312100000010080
    < 58A#6012100000000000
    > 60A#23121000A0060080
    < 58A#8012100022000008
    > 100#1122330405
    > 60A#400C210000000000
    < 58A#410C210006000000
    > 60A#6000000000000000
    < 58A#0300000000000000
    > 60A#2312100000010000
    < 58A#6012100000000000
    > 60A#23121000A0060040
    < 58A#6012100000000000
    > 000#020A
    wait 1000 ms
    > 000#800A
    wait 1000 ms
    < 6A0#E00700000000
";

#[test]
fn time_has_six_bytes_and_the_identifier_of_1012h() {
    conforms(&KIND, TIME);
    for (fault, changes) in [
        (
            "time-identifier-unprotected",
            &[("< 58A#8012100022000008", "< 58A#6012100000000000")][..],
        ),
        (
            "time-of-eight-bytes",
            &[("< 6A0#E00700000000", "< 6A0#E007000000000000")],
        ),
        (
            "time-stands-still",
            &[("< 6A0#E00700000000", "< 6A0#000000000000")],
        ),
        (
            "time-length-unchecked",
            &[
                ("< 58A#0300000000000000", "< 58A#0311223304050000"),
                ("< 6A0#E00700000000", "< 6A0#E52933040500"),
            ],
        ),
    ] {
        departs(&KIND, fault, TIME, changes);
    }
}

/// 1017h is of communication, 2202h the manufacturer's.
const GROUPS: &str = "
    wait 10 ms
    < 70A#00
    > 60A#2B17100034120000
    < 58A#6017100000000000
    > 60A#2B02220034120000
    < 58A#6002220000000000
    > 60A#2310100465766173
    < 58A#8010100420000008
    > 60A#2310100473617665
    < 58A#6010100400000000
    > 60A#4010100400000000
    < 58A#4310100401000000
    power off
    power on
    wait 10 ms
    < 70A#00
    > 60A#4017100000000000
    < 58A#4B17100000000000
    > 60A#4002220000000000
    < 58A#4B02220034120000
    > 60A#231110026C6F6164
    < 58A#6011100200000000
    > 60A#231110016C6F6165
    < 58A#8011100120000008
    > 60A#4002220000000000
    < 58A#4B02220034120000
    > 000#810A
    wait 10 ms
    < 70A#00
    > 60A#4002220000000000
    < 58A#4B02220034120000
";

#[test]
fn parameters_are_saved_and_restored_in_groups() {
    conforms(&KIND, GROUPS);
    for (fault, changes) in [
        (
            "store-groups-ignored",
            &[("< 58A#4B17100000000000", "< 58A#4B17100034120000")][..],
        ),
        (
            "store-shows-signature",
            &[("< 58A#4310100401000000", "< 58A#4310100473617665")],
        ),
        (
            "stores-in-ram",
            &[
                ("< 58A#4B02220034120000", "< 58A#4B02220000000000"),
                ("< 58A#4B02220034120000", "< 58A#4B02220000000000"),
                ("< 58A#4B02220034120000", "< 58A#4B02220000000000"),
            ],
        ),
        (
            "restore-groups-ignored",
            &[
                ("< 58A#4B02220034120000", "< 58A#4B02220034120000"),
                ("< 58A#4B02220034120000", "< 58A#4B02220034120000"),
                ("< 58A#4B02220034120000", "< 58A#4B02220000000000"),
            ],
        ),
        (
            "restore-without-signature",
            &[
                ("< 58A#8011100120000008", "< 58A#6011100100000000"),
                ("< 58A#4B02220034120000", "< 58A#4B02220034120000"),
                ("< 58A#4B02220034120000", "< 58A#4B02220000000000"),
            ],
        ),
    ] {
        departs(&KIND, fault, GROUPS, changes);
    }
}

/// What `script` makes of the slave as this variant.
fn as_variant(variant: &str, script: &str) -> String {
    let settings = Settings {
        variant: Some(variant.to_owned()),
        ..Settings::default()
    };
    Script::new(&KIND, &settings).play(script)
}

#[test]
fn a_right_slave_may_do_otherwise() {
    for (variant, script) in [
        (
            "empty-places-read-0",
            "
            wait 10 ms
            < 70A#00
            > 60A#4003100100000000
            < 58A#4303100100000000
            ",
        ),
        (
            "first-sync-at-once",
            "
            wait 10 ms
            < 70A#00
            > 60A#23061000204E0000
            < 58A#6006100000000000
            > 60A#2305100080000040
            < 080#
            < 58A#6005100000000000
            wait 20 ms
            < 080#
            ",
        ),
        (
            "emergency-late",
            "
            wait 10 ms
            < 70A#00
            begin hardware-fault
            wait 19 ms
            wait 2 ms
            < 08A#0050010000000000
            ",
        ),
        (
            "passing-errors-shown",
            "
            wait 10 ms
            < 70A#00
            > 000#010A
            < 18A#E803A0860100
            < 38A#FFFDFFFFFF
            > 20A#
            < 08A#1082110000000000
            > 60A#4001100000000000
            < 58A#4F01100000000000
            ",
        ),
        (
            "long-pdo-unreported",
            "
            wait 10 ms
            < 70A#00
            > 000#010A
            < 18A#E803A0860100
            < 38A#FFFDFFFFFF
            > 20A#01000200000007
            < 18A#010002000000
            ",
        ),
    ] {
        assert_same(&as_variant(variant, script), script);
    }
}
