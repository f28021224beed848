use super::KIND;
use crate::Settings;
use crate::script::{Script, conforms, departs};
use std::time::Duration;

const SDO: &str = "
    wait 10 ms
    < 701#00
    set 6063:00 = -12013
    > 601#4063600000000000
    < 581#4363600013D1FFFF
    > 601#237A6000A0860100
    < 581#607A6000A0860100
    > 601#4041600000000000
    < 581#4B41600050020000
    > 601#2B4060000F000000
    < 581#604060000F000000
    > 601#4040600000000000
    < 581#4B4060000F000000
    > 601#4060600000000000
    < 581#4F60600000000000
";

#[test]
fn worked_sdo_examples() {
    conforms(&KIND, SDO);
}

const ABORTS: &str = "
    wait 10 ms
    < 701#00
    > 601#40FF5F0000000000
    < 581#80FF5F0000000206
    > 601#2B41600000000000
    < 581#8041600002000106
    > 601#407A600000000000
    < 581#807A600001000106
    > 601#4041600100000000
    < 581#8041600111000906
    > 601#E000000000000000
    < 581#8000000001000405
    > 601#E041600200000000
    < 581#8041600201000405
    > 601#2340600000000000
    < 581#8040600012000706
    > 601#2F40600000000000
    < 581#8040600013000706
    > 601#2B5A600009000000
    < 581#805A600031000906
    > 601#2B5A6000FFFF0000
    < 581#805A600032000906
    > 601#2F001A0000000000
    < 581#80001A0022000008
    > 601#2F001802F5000000
    < 581#8000180230000906
    > 601#6000000000000000
    < 581#8000000001000405
    > 601#40416000000000
";

#[test]
fn aborts() {
    conforms(&KIND, ABORTS);
}

const SEGMENTED: &str = "
    wait 10 ms
    < 701#00
    > 601#4008100000000000
    < 581#4108100011000000
    > 601#6000000000000000
    < 581#004B696E636F2073
    > 601#7000000000000000
    < 581#106572766F206472
    > 601#6000000000000000
    < 581#0969766500000000
    > 601#4008100000000000
    < 581#4108100011000000
    > 601#7000000000000000
    < 581#8008100000000305
    > 601#6000000000000000
    < 581#8000000001000405
";

#[test]
fn segmented_upload() {
    conforms(&KIND, SEGMENTED);
}

#[test]
fn segmented_download() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 701#00
        > 601#217A600004000000
        < 581#607A600000000000
        > 601#07A0860100000000
        < 581#2000000000000000
        > 601#2141600002000000
        < 581#8041600002000106
        > 601#217A600005000000
        < 581#807A600012000706
        > 601#217A600003000000
        < 581#807A600013000706
        > 601#207A600000000000
        < 581#607A600000000000
        > 601#1701020304000000
        < 581#807A600000000305
        > 601#207A600000000000
        < 581#607A600000000000
        > 601#0B01000000000000
        < 581#807A600013000706
        ",
    );
}

const NMT: &str = "
    wait 10 ms
    < 701#00
    > 601#2B17100064000000
    < 581#6017100064000000
    wait 100 ms
    < 701#7F
    > 000#0101
    < 181#000000005002
    wait 99 ms
    < 701#05
    > 000#0200
    > 601#4000100000000000
    wait 98 ms
    < 701#04
    > 000#8002
    > 000#0101FF
    > 000#01
    > 000#0301
    wait 96 ms
    < 701#04
    > 000#8001
    > 601#4000100000000000
    < 581#4300100092010200
    > 000#8201
    wait 200 ms
    < 701#00
    > 000#8101
    wait 200 ms
    < 701#00
";

#[test]
fn state_machine_and_heartbeat() {
    conforms(&KIND, NMT);
}

#[test]
fn guarding_toggles_and_a_lost_master_is_reported() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 701#00
        > 601#2B0C100064000000
        < 581#600C100064000000
        > 601#2F0D100003000000
        < 581#600D100003000000
        > 701#R
        < 701#7F
        wait 200 ms
        > 701#R
        < 701#FF
        > 000#0101
        < 181#000000005002
        wait 400 ms
        < 081#3081100000000000
        > 701#R
        < 081#0000000000000000
        < 701#05
        ",
    );
}

const EVENT_DRIVEN: &str = "
    wait 10 ms
    < 701#00
    set 6063:00 = -12013
    wait 10 ms
    > 000#0101
    < 181#13D1FFFF5002
    wait 1000 ms
    set 6063:00 = 1
    wait 2 ms
    < 181#010000005002
    > 201#E8030000060003
    < 181#010000003102
    > 601#4061600000000000
    < 581#4F61600003000000
    > 201#E803000000000000
    < 181#010000005002
    wait 3 ms
    > 181#R
    < 181#010000005002
    > 201#E8030000
    < 081#1082000000000000
";

#[test]
fn event_driven_pdos() {
    conforms(&KIND, EVENT_DRIVEN);
}

#[test]
fn inhibit_time_counts_hundreds_of_microseconds() {
    let mut script = Script::new(&KIND, &Settings::default());
    script.play(
        "
        wait 10 ms
        > 601#2300180181010080
        > 601#2B00180332000000
        > 601#2300180181010000
        > 000#0101
        wait 20 ms
        set 6063:00 = 1
        wait 1 ms
        set 6063:00 = 2
        wait 1 ms
        set 6063:00 = 3
        wait 20 ms
        ",
    );
    let [.., (second, _), (third, last)] = script.sent[..] else {
        panic!("{:?}", script.sent);
    };
    assert_eq!(third.since(second), Duration::from_millis(5));
    assert_eq!(last.bytes(), [3, 0, 0, 0, 0x50, 2]);
}

const SYNCHRONOUS: &str = "
    wait 10 ms
    < 701#00
    > 601#2F00180202000000
    < 581#6000180202000000
    > 000#0101
    > 080#
    > 080#
    < 181#000000005002
    > 080#01
    > 080#02
    < 181#000000005002
    > 601#2F00180200000000
    < 581#6000180200000000
    > 080#
    set 6063:00 = 7
    > 080#
    < 181#070000005002
    > 080#
    > 601#2F00140201000000
    < 581#6000140201000000
    > 201#E8030000060003
    > 080#
    < 181#070000003102
";

#[test]
fn synchronous_pdos() {
    conforms(&KIND, SYNCHRONOUS);
}

const REMAPPING: &str = "
    wait 10 ms
    < 701#00
    > 601#23001A0120006360
    < 581#80001A0122000008
    > 601#2300180181010080
    < 581#6000180181010080
    > 601#23001A0120006360
    < 581#80001A0122000008
    > 601#2F001A0000000000
    < 581#60001A0000000000
    > 601#23001A0120006360
    < 581#60001A0120006360
    > 601#23001A0210004160
    < 581#60001A0210004160
    > 601#23001A0310000010
    < 581#80001A0341000406
    > 601#23001A0320FF5F60
    < 581#80001A0300000206
    > 601#23001A0320007A60
    < 581#80001A0341000406
    > 601#23001A0320006360
    < 581#60001A0320006360
    > 601#2F001A0003000000
    < 581#80001A0042000406
    > 601#2F001A0009000000
    < 581#80001A0031000906
    > 601#2F001A0002000000
    < 581#60001A0002000000
    > 601#40001A0100000000
    < 581#43001A0120006360
    > 601#2300180181010000
    < 581#6000180181010000
    > 601#2300180182010000
    < 581#8000180122000008
    > 601#2300180101060080
    < 581#6000180101060080
    > 601#2300180101060000
    < 581#8000180130000906
";

#[test]
fn remapping() {
    // 680h is not reserved; 601h to 67Fh are.
    let script = REMAPPING
        .replace("80060080", "01060080")
        .replace("80060000", "01060000");
    conforms(&KIND, &script);
}

#[test]
fn conditions_refuse_writes() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 701#00
        begin local-control
        > 601#237A6000A0860100
        < 581#807A600021000008
        end local-control
        begin hardware-fault
        wait 1 ms
        < 081#0050010000000000
        > 601#237A6000A0860100
        < 581#807A600000000606
        > 601#4001100000000000
        < 581#4F01100001000000
        end hardware-fault
        wait 1 ms
        < 081#0000000000000000
        > 601#237A6000A0860100
        < 581#607A6000A0860100
        ",
    );
}

#[test]
fn stored_values_survive_and_defaults_come_back() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 701#00
        > 601#2B5A600005000000
        < 581#605A600005000000
        > 601#2310100165766173
        < 581#8010100120000008
        > 601#2310100173617665
        < 581#6010100173617665
        > 601#2B5A600006000000
        < 581#605A600006000000
        > 000#8101
        wait 10 ms
        < 701#00
        > 601#405A600000000000
        < 581#4B5A600005000000
        > 601#231110016C6F6164
        < 581#601110016C6F6164
        power off
        wait 10 ms
        > 601#405A600000000000
        power on
        wait 10 ms
        < 701#00
        > 601#405A600000000000
        < 581#4B5A600002000000
        ",
    );
}

#[test]
fn node_switch_moves_every_identifier() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 701#00
        switch node = 2
        > 601#4000100000000000
        > 602#4000180100000000
        < 582#4300180182010000
        > 000#0102
        < 182#000000005002
        ",
    );
}

#[test]
fn sync_is_not_produced() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 701#00
        > 601#2305100080000040
        < 581#8005100030000906
        > 601#2305100080000000
        < 581#6005100080000000
        ",
    );
}

#[test]
fn fault_in_abort_code() {
    departs(
        &KIND,
        "abort-code-wrong",
        ABORTS,
        &[("< 581#8041600111000906", "< 581#8041600100000206")],
    );
}

#[test]
fn fault_in_abort_multiplexer() {
    let changes: Vec<(String, String)> = ABORTS
        .lines()
        .map(str::trim)
        .filter(|line| line.starts_with("< 581#80"))
        .map(|line| {
            let low = u8::from_str_radix(&line[8..10], 16).unwrap();
            let carried = u8::from_str_radix(&line[10..12], 16).unwrap() + u8::from(low == 0xFF);
            let named = format!("{:02X}{carried:02X}", low.wrapping_add(1));
            (
                line.to_owned(),
                format!("{}{named}{}", &line[..8], &line[12..]),
            )
        })
        .collect();
    let changes: Vec<(&str, &str)> = changes.iter().map(|(old, new)| (&**old, &**new)).collect();
    assert_eq!(changes.len(), 13);
    departs(&KIND, "abort-names-another-object", ABORTS, &changes);
}

#[test]
fn fault_in_boot_up() {
    departs(&KIND, "boot-up-missing", SDO, &[("< 701#00", "")]);
}

#[test]
fn fault_in_heartbeat() {
    departs(
        &KIND,
        "heartbeat-state-wrong",
        NMT,
        &[
            ("< 701#7F", "< 701#81"),
            ("< 701#05", "< 701#80"),
            ("< 701#04", "< 701#02"),
            ("< 701#04", "< 701#02"),
        ],
    );
}

#[test]
fn fault_in_synchronous_tpdo() {
    let script = "
        wait 10 ms
        < 701#00
        > 601#2F00180202000000
        < 581#6000180202000000
        > 000#0101
        > 080#
        > 080#
        < 181#000000005002
        > 080#
        > 080#
        < 181#000000005002
        > 080#
    ";
    departs(
        &KIND,
        "tpdo-one-sync-late",
        script,
        &[
            ("< 181#000000005002", ""),
            ("> 080#", "> 080#\n< 181#000000005002"),
            ("< 181#000000005002", ""),
            ("> 080#", "> 080#\n< 181#000000005002"),
        ],
    );
}

#[test]
fn fault_in_toggle() {
    departs(
        &KIND,
        "toggle-not-alternated",
        SEGMENTED,
        &[("< 581#106572766F206472", "< 581#006572766F206472")],
    );
}

#[test]
fn fault_in_expedited_size() {
    departs(
        &KIND,
        "expedited-size-wrong",
        SDO,
        &[
            ("< 581#4363600013D1FFFF", "< 581#4763600013D1FFFF"),
            ("< 581#4B41600050020000", "< 581#4741600050020000"),
            ("< 581#4B4060000F000000", "< 581#474060000F000000"),
            ("< 581#4F60600000000000", "< 581#4B60600000000000"),
        ],
    );
}

#[test]
fn fault_in_reading_back() {
    departs(
        &KIND,
        "stale-value-after-write",
        SDO,
        &[("< 581#4B4060000F000000", "< 581#4B40600000000000")],
    );
}

#[test]
fn fault_in_stopped() {
    departs(
        &KIND,
        "sdo-answered-in-stopped",
        "
        wait 10 ms
        < 701#00
        > 000#0201
        > 601#4000100000000000
        ",
        &[(
            "> 601#4000100000000000",
            "> 601#4000100000000000\n< 581#4300100092010200",
        )],
    );
}

#[test]
fn fault_in_pre_operational() {
    departs(
        &KIND,
        "pdo-in-pre-operational",
        "
        wait 10 ms
        < 701#00
        set 6063:00 = 1
        wait 2 ms
        > 201#E8030000060003
        wait 2 ms
        > 601#4040600000000000
        < 581#4B40600000000000
        ",
        &[
            ("< 701#00", "< 701#00\n< 181#000000005002"),
            ("wait 2 ms", "wait 2 ms\n< 181#010000005002"),
            ("wait 2 ms", "< 181#010000003102\nwait 2 ms"),
            ("< 581#4B40600000000000", "< 581#4B40600006000000"),
        ],
    );
}

#[test]
fn fault_in_stopped_pdo() {
    departs(
        &KIND,
        "pdo-in-stopped",
        "
        wait 10 ms
        < 701#00
        > 601#2F00180201000000
        < 581#6000180201000000
        > 000#0201
        > 080#
        wait 2 ms
        ",
        &[("wait 2 ms", "< 181#000000005002\nwait 2 ms")],
    );
}

#[test]
fn fault_in_remote_bit() {
    departs(
        &KIND,
        "remote-bit-ignored",
        "
        wait 10 ms
        < 701#00
        > 601#23001801810100C0
        < 581#60001801810100C0
        > 601#2F00180201000000
        < 581#6000180201000000
        > 601#2300180181010040
        < 581#6000180181010040
        > 000#0101
        > 181#R
        wait 2 ms
        > 080#
        < 181#000000005002
        ",
        &[("wait 2 ms", "< 181#000000005002\nwait 2 ms")],
    );
}

#[test]
fn fault_in_confirmation() {
    let changes: Vec<(&str, &str)> = SDO
        .lines()
        .map(str::trim)
        .filter(|line| line.starts_with("< 581#60"))
        .map(|line| (line, ""))
        .collect();
    departs(&KIND, "download-ack-missing", SDO, &changes);
}

#[test]
fn fault_in_mapping_entry() {
    departs(
        &KIND,
        "mapping-entry-byte-order",
        "
        wait 10 ms
        < 701#00
        > 601#40001A0200000000
        < 581#43001A0210004160
        > 601#2300180181010080
        < 581#6000180181010080
        > 601#2F001A0000000000
        < 581#60001A0000000000
        > 601#23001A0120006360
        < 581#60001A0120006360
        ",
        &[
            ("< 581#43001A0210004160", "< 581#43001A0260410010"),
            ("< 581#60001A0120006360", "< 581#80001A0100000206"),
        ],
    );
}

#[test]
fn fault_in_ending_the_heartbeat() {
    departs(
        &KIND,
        "heartbeat-not-stopped",
        "
        wait 10 ms
        < 701#00
        > 601#2B1710000A000000
        < 581#601710000A000000
        wait 10 ms
        < 701#7F
        > 601#2B17100000000000
        < 581#6017100000000000
        wait 10 ms
        ",
        &[
            ("wait 10 ms", "wait 10 ms"),
            ("wait 10 ms", "wait 10 ms"),
            ("wait 10 ms", "wait 10 ms\n< 701#7F"),
        ],
    );
}

const NMT_ADDRESSES: &str = "
    wait 10 ms
    < 701#00
    > 000#0102
    > 701#R
    < 701#7F
    > 000#0100
    < 181#000000005002
    > 701#R
    < 701#85
    > 000#5501
    > 701#R
    < 701#05
";

#[test]
fn faults_in_nmt_commands() {
    departs(
        &KIND,
        "nmt-to-all-ignored",
        NMT_ADDRESSES,
        &[
            ("< 181#000000005002", ""),
            ("< 701#85", "< 701#FF"),
            ("< 701#05", "< 701#7F"),
        ],
    );
    departs(
        &KIND,
        "nmt-to-another-obeyed",
        NMT_ADDRESSES,
        &[
            ("> 000#0102", "> 000#0102\n< 181#000000005002"),
            ("< 701#7F", "< 701#05"),
            ("< 181#000000005002", ""),
        ],
    );
    departs(
        &KIND,
        "unknown-nmt-command-stops",
        NMT_ADDRESSES,
        &[("< 701#05", "< 701#04")],
    );
    departs(
        &KIND,
        "guarding-toggle-stuck",
        NMT_ADDRESSES,
        &[("< 701#85", "< 701#05")],
    );
}

#[test]
fn fault_in_unknown_commands() {
    departs(
        &KIND,
        "unknown-command-ignored",
        ABORTS,
        &[
            ("< 581#8000000001000405", ""),
            ("< 581#8041600201000405", ""),
        ],
    );
}

#[test]
fn fault_in_byte_order_of_uploads() {
    departs(
        &KIND,
        "upload-byte-order",
        SDO,
        &[
            ("< 581#4363600013D1FFFF", "< 581#43636000FFFFD113"),
            ("< 581#4B41600050020000", "< 581#4B41600002500000"),
            ("< 581#4B4060000F000000", "< 581#4B406000000F0000"),
        ],
    );
}

#[test]
fn fault_in_counting_sync() {
    departs(
        &KIND,
        "sync-counted-wrong",
        "
        wait 10 ms
        < 701#00
        > 601#2F00180201000000
        < 581#6000180201000000
        > 000#0101
        > 080#
        < 181#000000005002
        > 080#
        < 181#000000005002
        ",
        &[("< 181#000000005002", "")],
    );
}

#[test]
fn fault_in_invalid_pdos() {
    departs(
        &KIND,
        "invalid-tpdo-sent",
        "
        wait 10 ms
        < 701#00
        > 601#2300180181010080
        < 581#6000180181010080
        > 601#2F01180201000000
        < 581#6001180201000000
        > 000#0101
        > 080#
        ",
        &[
            (
                "> 000#0101",
                "> 000#0101\n< 181#000000005002\n< 381#\n< 481#",
            ),
            ("> 080#", "> 080#\n< 281#"),
        ],
    );
}

#[test]
fn fault_in_byte_order_of_pdos() {
    departs(
        &KIND,
        "tpdo-byte-order",
        "
        wait 10 ms
        < 701#00
        set 6063:00 = -12013
        > 000#0101
        < 181#13D1FFFF5002
        ",
        &[("< 181#13D1FFFF5002", "< 181#FFFFD1130250")],
    );
}
