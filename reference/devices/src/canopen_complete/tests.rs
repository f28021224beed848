use super::KIND;
use crate::script::{conforms, departs};

#[test]
fn a_value_that_is_set_can_be_sent() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 70A#00
        > 60A#4006200000000000
        < 58A#4B062000E8030000
        > 60A#4006210000000000
        < 58A#4B062100E8030000
        > 60A#2B06200034120000
        < 58A#6006200000000000
        > 60A#4006210000000000
        < 58A#4B06210034120000
        > 60A#2B06200061EA0000
        < 58A#8006200031000906
        > 60A#2B06200000000000
        < 58A#8006200032000906
        > 60A#400A200000000000
        < 58A#430A20000011AAFF
        ",
    );
}

/// 1: INTEGER8 as a dummy; 2: BOOLEAN as set; 3: the same as a dummy. Bits fill a byte from the lowest.
#[test]
fn bits_and_dummies() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 70A#00
        > 60A#230014010A020080
        < 58A#6000140100000000
        > 60A#2F00160000000000
        < 58A#6000160000000000
        > 60A#2300160101000100
        < 58A#6000160100000000
        > 60A#2300160201000120
        < 58A#6000160200000000
        > 60A#2300160308000520
        < 58A#6000160300000000
        > 60A#2300160408000100
        < 58A#8000160441000406
        > 60A#2F00160003000000
        < 58A#6000160000000000
        > 60A#230014010A020000
        < 58A#6000140100000000
        > 60A#23001A0101000100
        < 58A#80001A0122000008
        > 000#010A
        < 18A#E803A0860100
        < 38A#FFFDFFFFFF
        > 20A#1E00
        > 60A#4001200000000000
        < 58A#4F01200001000000
        > 60A#4005200000000000
        < 58A#4F05200007000000
        ",
    );
}

#[test]
fn transmission_types() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 70A#00
        > 60A#2F001802F0000000
        < 58A#6000180200000000
        > 60A#2F001802F1000000
        < 58A#8000180230000906
        > 60A#2F001802FB000000
        < 58A#8000180230000906
        > 60A#2F001802FC000000
        < 58A#6000180200000000
        > 60A#2F001802FD000000
        < 58A#6000180200000000
        > 60A#2F001402FC000000
        < 58A#8000140230000906
        > 60A#2F001402F0000000
        < 58A#6000140200000000
        ",
    );
}

const COUNTED: &str = "
    wait 10 ms
    < 70A#00
    > 60A#2F19100001000000
    < 58A#8019100030000906
    > 60A#2F19100002000000
    < 58A#6019100000000000
    > 60A#2306100010270000
    < 58A#6006100000000000
    > 60A#2F19100003000000
    < 58A#8019100022000008
    > 60A#2305100080000040
    < 58A#6005100000000000
    wait 30 ms
    < 080#01
    < 080#02
    < 080#01
    > 000#020A
    wait 30 ms
    > 000#800A
    wait 8 ms
    < 080#01
";

#[test]
fn sync_is_counted_and_begins_with_1_again_after_stopped() {
    conforms(&KIND, COUNTED);
}

#[test]
fn sync_counter_missing() {
    departs(
        &KIND,
        "sync-counter-missing",
        COUNTED,
        &[
            ("< 080#01", "< 080#"),
            ("< 080#02", "< 080#"),
            ("< 080#01", "< 080#"),
            ("< 080#01", "< 080#"),
        ],
    );
}

/// Two nodes are listened to. The first is lost in Operational and heard again; the second never speaks.
const LOST: &str = "
    wait 10 ms
    < 70A#00
    > 60A#2316100132000500
    < 58A#6016100100000000
    > 60A#2316100264000500
    < 58A#8016100243000406
    > 60A#2316100264000600
    < 58A#6016100200000000
    > 60A#2F29100102000000
    < 58A#6029100100000000
    > 000#010A
    < 18A#E803A0860100
    < 38A#FFFDFFFFFF
    > 705#05
    wait 48 ms
    wait 10 ms
    < 08A#3081110000000000
    > 000#800A
    > 60A#4001100000000000
    < 58A#4F01100011000000
    > 60A#4003100100000000
    < 58A#4303100130810000
    > 705#7F
    < 08A#0000000000000000
    > 705#00
    wait 200 ms
";

#[test]
fn lost_heartbeat() {
    conforms(&KIND, LOST);
}

#[test]
fn emergencies_wait_for_the_inhibit_time() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 70A#00
        > 60A#2B15100064000000
        < 58A#6015100000000000
        begin hardware-fault
        wait 1 ms
        < 08A#0050010000000000
        end hardware-fault
        wait 8 ms
        wait 2 ms
        < 08A#0000000000000000
        > 60A#2F03100001000000
        < 58A#8003100030000906
        > 60A#2F03100009000000
        < 58A#8003100031000906
        > 60A#2314100000010000
        < 58A#8014100022000008
        ",
    );
}

#[test]
fn time_is_taken_and_produced() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 70A#00
        > 60A#23121000000100C0
        < 58A#6012100000000000
        > 100#FF5B26050100
        > 60A#400C210000000000
        < 58A#410C210006000000
        > 60A#6000000000000000
        < 58A#03FF5B2605010000
        wait 997 ms
        < 100#E60300000200
        > 60A#2312100000020040
        < 58A#8012100022000008
        ",
    );
}

#[test]
fn second_sdo_server() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 70A#00
        > 6A0#4001220000000000
        > 60A#23011201A0060000
        < 58A#6001120100000000
        > 60A#2301120201060000
        < 58A#8001120230000906
        > 60A#23011202A1060000
        < 58A#6001120200000000
        > 6A0#4008100000000000
        < 6A1#4108100010000000
        > 60A#4008100000000000
        < 58A#4108100010000000
        > 6A0#6000000000000000
        < 6A1#0063616E6F70656E
        > 60A#6000000000000000
        < 58A#0063616E6F70656E
        ",
    );
}

/// The bit rate changes 5 ms after it was activated; nothing leaves for 10 ms.
#[test]
fn bit_timing_is_activated() {
    let mut script = crate::script::Script::new(&KIND, &crate::Settings::default());
    script.play(
        "
        wait 10 ms
        > 7E5#0401000000000000
        > 7E5#1300030000000000
        > 60A#2B17100002000000
        > 7E5#1505000000000000
        ",
    );
    let rate = |script: &crate::script::Script| script.device.line(0);
    let can = |bit_rate| fieldproof_link::Line::Can { bit_rate };
    assert_eq!(rate(&script), can(500_000));
    let quiet = script.sent.len();
    script.play("wait 3 ms");
    assert_eq!(rate(&script), can(500_000));
    script.play("wait 2 ms");
    assert_eq!(rate(&script), can(250_000));
    script.play("wait 4 ms");
    assert_eq!(script.sent.len(), quiet);
    script.play("wait 4 ms");
    assert!(script.sent.len() > quiet);
}

const FASTSCAN: &str = "
    wait 10 ms
    < 70A#00
    > 7E5#5100000000800000
    > 7E5#0401000000000000
    > 7E5#11FF000000000000
    < 7E4#1100000000000000
    > 000#820A
    wait 10 ms
    > 7E5#4C00000000000000
    < 7E4#5000000000000000
    > 7E5#5100000000800000
    < 7E4#4F00000000000000
    > 7E5#5100000000000001
    < 7E4#4F00000000000000
    > 7E5#5100000000000102
    > 7E5#5101000000000102
    < 7E4#4F00000000000000
    > 7E5#5100000100000203
    < 7E4#4F00000000000000
    > 7E5#5101000000000300
    < 7E4#4F00000000000000
    > 7E5#110B000000000000
    < 7E4#1100000000000000
    > 7E5#0400000000000000
    wait 10 ms
    < 70B#00
";

#[test]
fn fastscan() {
    conforms(&KIND, FASTSCAN);
}

#[test]
fn fastscan_with_a_node() {
    departs(
        &KIND,
        "lss-fastscan-with-node",
        FASTSCAN,
        &[(
            "> 7E5#5100000000800000",
            "> 7E5#5100000000800000\n< 7E4#4F00000000000000",
        )],
    );
}

#[test]
fn stored_values_come_back_and_history_is_none_of_them() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 70A#00
        begin hardware-fault
        end hardware-fault
        wait 1 ms
        < 08A#0050010000000000
        < 08A#0000000000000000
        > 60A#2B02220034120000
        < 58A#6002220000000000
        > 60A#2310100165766173
        < 58A#8010100120000008
        > 60A#2310100173617665
        < 58A#6010100100000000
        power off
        power on
        wait 10 ms
        < 70A#00
        > 60A#4002220000000000
        < 58A#4B02220034120000
        > 60A#4003100000000000
        < 58A#4F03100000000000
        > 60A#231110046C6F6164
        < 58A#6011100400000000
        > 60A#4002220000000000
        < 58A#4B02220034120000
        > 000#810A
        wait 10 ms
        < 70A#00
        > 60A#4002220000000000
        < 58A#4B02220000000000
        ",
    );
}

#[test]
fn an_rpdo_that_is_late_is_reported_once() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 70A#00
        > 60A#2B0014050A000000
        < 58A#6000140500000000
        > 000#010A
        < 18A#E803A0860100
        < 38A#FFFDFFFFFF
        wait 20 ms
        > 20A#010002000000
        < 18A#010002000000
        wait 12 ms
        < 08A#5082000000000000
        wait 20 ms
        ",
    );
}
