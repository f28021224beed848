use super::KIND;
use crate::Settings;
use crate::script::{Script, assert_same, conforms, departs, departures};

const PDO: &str = "
    wait 20 ms
    < 720#00
    set position = 51159
    set speed = 22153012
    > 000#0120
    wait 98 ms
    wait 1 ms
    < 1A0#D7C7000034075201
    > 080#
    < 2A0#D7C7000034075201
    > 080#01
    < 2A0#D7C7000034075201
    wait 98 ms
    < 1A0#D7C7000034075201
    > 620#2B006200F4010000
    < 5A0#6000620000000000
    > 620#4000180500000000
    < 5A0#4B001805F4010000
    wait 497 ms
    wait 2 ms
    < 1A0#D7C7000034075201
    > 620#2B00180564000000
    < 5A0#6000180500000000
    > 620#4000620000000000
    < 5A0#4B00620064000000
";

#[test]
fn position_and_speed_in_both_pdos() {
    conforms(&KIND, PDO);
}

#[test]
fn node_by_sdo_is_active_after_a_reset() {
    conforms(&KIND, NODE_BY_SDO);
}

const NODE_BY_SDO: &str = "
    wait 20 ms
    < 720#00
    > 000#8020
    > 620#2F00300005000000
    < 5A0#6000300000000000
    > 620#4000300000000000
    < 5A0#4F00300005000000
    > 000#8105
    > 000#8120
    wait 20 ms
    < 705#00
    > 605#4000180100000000
    < 585#4300180185010000
    power off
    wait 5 ms
    power on
    wait 20 ms
    < 705#00
";

#[test]
fn bit_rate_by_sdo_is_active_after_a_reset() {
    let mut script = Script::new(&KIND, &Settings::default());
    script.play("wait 20 ms\n > 620#2F01300004000000");
    assert_eq!(
        script.device.state().get("bit-rate").as_deref(),
        Some("250000")
    );
    let told = script.play("> 000#8120\n wait 20 ms");
    assert_eq!(told, "> 000#8120\nwait 20 ms\n< 720#00\n");
    assert_eq!(
        script.device.state().get("bit-rate").as_deref(),
        Some("125000")
    );
}

const LSS: &str = "
    wait 20 ms
    < 720#00
    > 000#8020
    > 7E5#5A00000000000000
    > 7E5#0401000000000000
    > 7E5#5A00000000000000
    < 7E4#5A3C060000000000
    > 7E5#5B00000000000000
    < 7E4#5B01000000000000
    > 7E5#5C00000000000000
    < 7E4#5C01000000000000
    > 7E5#5D00000000000000
    < 7E4#5DB8615D0E000000
    > 7E5#5E00000000000000
    < 7E4#5E20000000000000
    > 7E5#1105000000000000
    < 7E4#1100000000000000
    > 7E5#1180000000000000
    < 7E4#1101000000000000
    > 7E5#1300090000000000
    < 7E4#1301000000000000
    > 7E5#1301040000000000
    < 7E4#1301000000000000
    > 620#4000100000000000
    < 5A0#4300100096010200
    > 7E5#1700000000000000
    < 7E4#1700000000000000
    > 620#4000300000000000
    < 5A0#4F00300005000000
    > 000#8120
    wait 20 ms
    < 705#00
    > 7E5#5A00000000000000
";

#[test]
fn lss_inquiry_and_node() {
    conforms(&KIND, LSS);
}

#[test]
fn lss_bit_rate() {
    let mut script = Script::new(&KIND, &Settings::default());
    script.play("wait 20 ms\n > 7E5#0401000000000000\n > 7E5#1300040000000000");
    script.play("> 7E5#1700000000000000");
    assert_eq!(
        script.device.state().get("bit-rate").as_deref(),
        Some("250000")
    );
    assert_eq!(script.device.state().get("3001:00").as_deref(), Some("04"));
    script.play("> 000#8120");
    assert_eq!(
        script.device.state().get("bit-rate").as_deref(),
        Some("125000")
    );
}

#[test]
fn what_lss_did_not_store_is_lost() {
    conforms(
        &KIND,
        "
        wait 20 ms
        < 720#00
        > 7E5#0401000000000000
        > 7E5#1105000000000000
        < 7E4#1100000000000000
        > 000#8120
        wait 20 ms
        < 720#00
        > 7E5#0401000000000000
        > 7E5#1105000000000000
        < 7E4#1100000000000000
        > 000#8220
        wait 20 ms
        < 705#00
        ",
    );
}

#[test]
fn lss_switch_selective() {
    conforms(
        &KIND,
        "
        wait 20 ms
        < 720#00
        > 000#8020
        > 7E5#403C060000000000
        > 7E5#4101000000000000
        > 7E5#4202000000000000
        > 7E5#43B8615D0E000000
        > 7E5#403C060000000000
        > 7E5#4101000000000000
        > 7E5#4201000000000000
        > 7E5#43B8615D0E000000
        < 7E4#4400000000000000
        > 7E5#5E00000000000000
        < 7E4#5E20000000000000
        > 7E5#0400000000000000
        > 7E5#5E00000000000000
        ",
    );
}

#[test]
fn a_slave_without_a_node_has_lss_only() {
    conforms(
        &KIND,
        "
        wait 20 ms
        < 720#00
        > 7E5#0401000000000000
        > 7E5#11FF000000000000
        < 7E4#1100000000000000
        > 7E5#1700000000000000
        < 7E4#1700000000000000
        > 000#8120
        wait 20 ms
        > 000#8100
        > 620#4000100000000000
        > 7E5#0401000000000000
        > 7E5#5E00000000000000
        < 7E4#5EFF000000000000
        > 7E5#1120000000000000
        < 7E4#1100000000000000
        > 7E5#0400000000000000
        wait 20 ms
        < 720#00
        ",
    );
}

const SERIAL: &str = "
    wait 20 ms
    < 720#00
    set position = 147853323
    set speed = -362115
    >> 20 03 00 02 00 01 23 7B
    << 20 03 02 08 D0 02 1F
    >> 20 03 00 0C 00 02 02 B9
    << 20 03 04 FF DC F7 BD BC 9E
    > 620#4004600000000000
    < 5A0#430460000B10D008
    > 620#4000200000000000
    < 5A0#430020007D79FAFF
";

#[test]
fn both_ports_show_one_shaft() {
    conforms(&KIND, SERIAL);
}

#[test]
fn settings_of_either_port_show_on_the_other() {
    conforms(
        &KIND,
        "
        wait 20 ms
        < 720#00
        set speed = 10000
        >> 20 06 00 06 00 01 AE BA
        << 20 06 00 06 00 01 AE BA
        > 620#4000600000000000
        < 5A0#4B00600001000000
        > 620#4000650000000000
        < 5A0#4B00650001000000
        > 620#4000200000000000
        < 5A0#43002000F0D8FFFF
        > 620#2B00600000000000
        < 5A0#6000600000000000
        >> 20 03 00 06 00 01 62 BA
        << 20 03 02 00 00 04 43
        > 620#2303600001000000
        < 5A0#6003600000000000
        >> 20 03 00 02 00 01 23 7B
        << 20 03 02 00 00 04 43
        ",
    );
}

#[test]
fn objects_of_the_manual() {
    conforms(
        &KIND,
        "
        wait 20 ms
        < 720#00
        > 620#4010100100000000
        < 5A0#4310100102000000
        > 620#2310100173617665
        < 5A0#8010100102000106
        > 620#231110016C6F6164
        < 5A0#8011100120000008
        > 620#4002600000000000
        < 5A0#43026000FFFFFFFF
        > 620#4010650000000000
        < 5A0#4110650005000000
        > 620#6000000000000000
        < 5A0#0500000000000000
        > 620#2F00300080000000
        < 5A0#8000300031000906
        > 620#2F01300009000000
        < 5A0#8001300031000906
        > 620#2B00620000000000
        < 5A0#8000620032000906
        > 620#2B00180500000000
        < 5A0#8000180532000906
        > 620#2F03100001000000
        < 5A0#8003100030000906
        > 620#2F03100000000000
        < 5A0#6003100000000000
        ",
    );
}

#[test]
fn saved_values_come_back_and_leave_no_trace_once_put_back() {
    let mut script = Script::new(&KIND, &Settings::default());
    script.play("wait 20 ms");
    let before = script.device.state();
    script.play("> 620#2B006200F4010000\n > 000#8120\n wait 20 ms");
    assert_eq!(
        script.device.state().get("6200:00").as_deref(),
        Some("01F4")
    );
    assert_eq!(
        script.device.state().get("1800:05").as_deref(),
        Some("01F4")
    );
    script.play("> 620#2B00620064000000");
    assert_eq!(script.device.state(), before);
}

#[test]
fn no_power_no_ports() {
    use fieldproof_link::Line;
    let mut script = Script::new(&KIND, &Settings::default());
    script.play("wait 20 ms\n power off");
    assert_eq!([0, 1].map(|port| script.device.line(port)), [Line::Off; 2]);
    assert_eq!(script.device.wake_at(), None);
    script.play("power on");
    assert!(
        [0, 1]
            .map(|port| script.device.line(port))
            .iter()
            .all(|line| *line != Line::Off)
    );
}

#[test]
fn fault_in_speed_sign() {
    departs(
        &KIND,
        "speed-sign-lost-on-can",
        SERIAL,
        &[("< 5A0#430020007D79FAFF", "< 5A0#4300200083860500")],
    );
}

#[test]
fn fault_in_speed_sign_on_the_serial_line() {
    departs(
        &KIND,
        "speed-sign-lost",
        SERIAL,
        &[(
            "<< 20 03 04 FF DC F7 BD BC 9E",
            "<< 20 03 04 00 24 08 43 CD 0B",
        )],
    );
}

#[test]
fn fault_in_lss_revision() {
    departs(
        &KIND,
        "lss-revision-answers-5b",
        LSS,
        &[("< 7E4#5C01000000000000", "< 7E4#5B01000000000000")],
    );
}

#[test]
fn fault_in_node_activation() {
    departs(
        &KIND,
        "node-id-active-before-reset",
        "
        wait 20 ms
        < 720#00
        > 620#2F00300005000000
        < 5A0#6000300000000000
        > 620#4000100000000000
        < 5A0#4300100096010200
        > 605#4000100000000000
        > 620#2F00300020000000
        < 5A0#6000300000000000
        ",
        &[
            ("< 5A0#4300100096010200", ""),
            (
                "> 605#4000100000000000",
                "> 605#4000100000000000\n< 585#4300100096010200",
            ),
            ("< 5A0#6000300000000000", ""),
        ],
    );
}

#[test]
fn fault_in_synchronous_tpdo() {
    departs(
        &KIND,
        "tpdo-one-sync-late",
        "
        wait 20 ms
        < 720#00
        > 000#0120
        > 080#
        < 2A0#0000000000000000
        > 080#
        < 2A0#0000000000000000
        ",
        &[("< 2A0#0000000000000000", "")],
    );
}

#[test]
fn faults_of_the_serial_line() {
    const READ: &str = "
        wait 20 ms
        < 720#00
        >> 20 03 00 05 00 01 92 BA
        << 20 03 02 25 80 1F 73
        >> 20 03 00 05 00 01 92 BB
        >> 20 03 01 00 00 01 83 47
        << 20 83 02 90 FB
        >> 21 03 00 05 00 01 93 6B
        >> 20 BE 98
        >> FF 10 00 01 00 03 06 61 64 64 72 3A 03 75 09
        << 03 10 00 01 00 03 D0 2A
    ";
    let read = "<< 20 03 02 25 80 1F 73";
    let stale = ">> 20 03 00 05 00 01 92 BB";
    let answered = ">> 20 03 00 05 00 01 92 BB\n<< 20 03 02 25 80 1F 73";
    let exception = "<< 20 83 02 90 FB";
    let other = ">> 21 03 00 05 00 01 93 6B";
    let answered_for_it = ">> 21 03 00 05 00 01 93 6B\n<< 20 03 02 25 80 1F 73";
    let bare = ">> 20 BE 98";
    let answered_to_it = ">> 20 BE 98\n<< 20 80 01 D0 0A";
    let change = "<< 03 10 00 01 00 03 D0 2A";
    for (fault, changes) in [
        (
            "crc-bytes-swapped",
            &[
                (read, "<< 20 03 02 25 80 73 1F"),
                (exception, "<< 20 83 02 FB 90"),
                (change, "<< 03 10 00 01 00 03 2A D0"),
            ][..],
        ),
        ("stale-crc-accepted", &[(stale, answered)]),
        ("other-address-answered", &[(other, answered_for_it)]),
        ("bare-address-answered", &[(bare, answered_to_it)]),
        ("exception-without-80h", &[(exception, "<< 20 03 02 F1 3B")]),
        ("address-change-not-answered", &[(change, "")]),
    ] {
        departs(&KIND, fault, READ, changes);
    }
}

#[test]
fn fault_in_event_timer() {
    departs(
        &KIND,
        "event-timer-unit",
        "
        wait 20 ms
        < 720#00
        > 000#0120
        wait 100 ms
        < 1A0#0000000000000000
        wait 900 ms
        < 1A0#0000000000000000
        < 1A0#0000000000000000
        < 1A0#0000000000000000
        < 1A0#0000000000000000
        < 1A0#0000000000000000
        < 1A0#0000000000000000
        < 1A0#0000000000000000
        < 1A0#0000000000000000
        < 1A0#0000000000000000
        ",
        &[("< 1A0#0000000000000000", ""); 9],
    );
}

#[test]
fn fault_in_storing() {
    departs(
        &KIND,
        "lss-store-forgets",
        LSS,
        &[
            ("< 5A0#4F00300005000000", "< 5A0#4F00300020000000"),
            ("< 705#00", "< 720#00"),
        ],
    );
}

#[test]
fn fault_in_selecting() {
    departs(
        &KIND,
        "lss-serial-ignored",
        "
        wait 20 ms
        < 720#00
        > 7E5#403C060000000000
        > 7E5#4101000000000000
        > 7E5#4201000000000000
        > 7E5#43B9615D0E000000
        > 7E5#5A00000000000000
        ",
        &[
            (
                "> 7E5#43B9615D0E000000",
                "> 7E5#43B9615D0E000000\n< 7E4#4400000000000000",
            ),
            (
                "> 7E5#5A00000000000000",
                "> 7E5#5A00000000000000\n< 7E4#5A3C060000000000",
            ),
        ],
    );
}

#[test]
fn fault_in_identity() {
    departs(
        &KIND,
        "identity-of-the-template",
        LSS,
        &[
            ("< 7E4#5A3C060000000000", "< 7E4#5A00000000000000"),
            ("< 7E4#5B01000000000000", "< 7E4#5B00000000000000"),
            ("< 7E4#5DB8615D0E000000", "< 7E4#5D01000000000000"),
        ],
    );
}

#[test]
fn fault_in_identity_byte_order() {
    departs(
        &KIND,
        "lss-identity-byte-order",
        LSS,
        &[
            ("< 7E4#5A3C060000000000", "< 7E4#5A0000063C000000"),
            ("< 7E4#5B01000000000000", "< 7E4#5B00000001000000"),
            ("< 7E4#5C01000000000000", "< 7E4#5C00000001000000"),
            ("< 7E4#5DB8615D0E000000", "< 7E4#5D0E5D61B8000000"),
        ],
    );
}

#[test]
fn fault_in_checking_a_configuration() {
    departs(
        &KIND,
        "lss-configuration-unchecked",
        LSS,
        &[
            ("< 7E4#1101000000000000", "< 7E4#1100000000000000"),
            ("< 7E4#1301000000000000", "< 7E4#1300000000000000"),
            ("< 7E4#1301000000000000", "< 7E4#1300000000000000"),
        ],
    );
}

#[test]
fn fault_in_bit_timing() {
    departs(
        &KIND,
        "lss-bit-timing-missing",
        "
        wait 20 ms
        < 720#00
        > 7E5#0401000000000000
        > 7E5#1300010000000000
        < 7E4#1300000000000000
        > 7E5#1300000000000000
        < 7E4#1300000000000000
        ",
        &[("< 7E4#1300000000000000", "< 7E4#1301000000000000")],
    );
}

#[test]
fn fault_in_confirming_a_selection() {
    departs(
        &KIND,
        "lss-selection-not-confirmed",
        "
        wait 20 ms
        < 720#00
        > 7E5#403C060000000000
        > 7E5#4101000000000000
        > 7E5#4201000000000000
        > 7E5#43B8615D0E000000
        < 7E4#4400000000000000
        > 7E5#5A00000000000000
        < 7E4#5A3C060000000000
        ",
        &[("< 7E4#4400000000000000", "")],
    );
}

const PRESET: &str = "
    wait 20 ms
    < 720#00
    > 620#23036000F4010000
    < 5A0#6003600000000000
    > 620#4004600000000000
    < 5A0#43046000F4010000
    set turn = 256
    > 620#4004600000000000
    < 5A0#43046000F4020000
    > 620#2B00600001000000
    < 5A0#6000600000000000
    > 620#4000650000000000
    < 5A0#4B00650001000000
    > 620#4004600000000000
    < 5A0#43046000F4020000
    set turn = 256
    > 620#4004600000000000
    < 5A0#43046000F4010000
    > 620#2303600064000000
    < 5A0#6003600000000000
    > 620#4004600000000000
    < 5A0#4304600064000000
    > 000#8120
    wait 20 ms
    < 720#00
    > 620#4004600000000000
    < 5A0#4304600064000000
    > 620#4003600000000000
    < 5A0#4303600064000000
";

#[test]
fn preset_sets_the_position_and_direction_turns_the_count() {
    conforms(&KIND, PRESET);
}

#[test]
fn variant_mirrors_the_position_with_the_direction() {
    let settings = Settings {
        variant: Some("position-jumps-with-direction".to_owned()),
        ..Settings::default()
    };
    let told = Script::new(&KIND, &settings).play(PRESET);
    let mirrored = [
        ("< 5A0#43046000F4020000", "< 5A0#43046000F4020000"),
        ("< 5A0#43046000F4020000", "< 5A0#430460000CFDFFFF"),
        ("< 5A0#43046000F4010000", "< 5A0#430460000CFCFFFF"),
    ];
    assert_same(&told, &departures(PRESET, &mirrored));
}

#[test]
fn faults_in_direction_and_preset() {
    let (first, turned) = ("< 5A0#43046000F4010000", "< 5A0#43046000F4020000");
    let (same, back) = (turned, first);
    let last = "< 5A0#4304600064000000";
    for (fault, changes) in [
        (
            "direction-of-count-fixed",
            &[(first, first), (back, "< 5A0#43046000F4030000")][..],
        ),
        (
            "preset-without-effect",
            &[
                (first, "< 5A0#4304600000000000"),
                (turned, "< 5A0#4304600000010000"),
                (same, "< 5A0#4304600000010000"),
                (back, "< 5A0#4304600000000000"),
                (last, "< 5A0#4304600000000000"),
                (last, "< 5A0#4304600000000000"),
            ],
        ),
        (
            "preset-added",
            &[
                (last, "< 5A0#4304600058020000"),
                (last, "< 5A0#4304600058020000"),
            ],
        ),
        (
            "preset-mirrored",
            &[
                (last, "< 5A0#430460009CFFFFFF"),
                (last, "< 5A0#430460009CFFFFFF"),
            ],
        ),
        (
            "preset-lost-at-reset",
            &[(last, last), (last, "< 5A0#4304600000000000")],
        ),
        (
            "operating-status-frozen",
            &[("< 5A0#4B00650001000000", "< 5A0#4B00650000000000")],
        ),
        (
            "settings-forgotten",
            &[("< 5A0#4303600064000000", "< 5A0#4303600000000000")],
        ),
    ] {
        departs(&KIND, fault, PRESET, changes);
    }
}

const TURNS: &str = "
    wait 20 ms
    < 720#00
    > 620#2303600000FFFFFF
    < 5A0#6003600000000000
    set turn = 65792
    > 620#4004600000000000
    < 5A0#4304600000000100
    > 620#2B0320000C000000
    < 5A0#6003200000000000
    > 620#2303600000000000
    < 5A0#6003600000000000
    set turn = 65536
    > 620#4004600000000000
    < 5A0#4304600000100000
    power off
    set turn = 32768
    wait 5 ms
    power on
    wait 20 ms
    < 720#00
    > 620#4004600000000000
    < 5A0#4304600000180000
    > 620#4003200000000000
    < 5A0#4B0320000C000000
    set speed = 60000000
    > 620#4000200000000000
    < 5A0#4300200000879303
    > 620#2B03200011000000
    < 5A0#8003200031000906
";

#[test]
fn turns_are_counted_with_and_without_power() {
    conforms(&KIND, TURNS);
}

#[test]
fn faults_in_counting() {
    let (round, turn, unpowered) = (
        "< 5A0#4304600000000100",
        "< 5A0#4304600000100000",
        "< 5A0#4304600000180000",
    );
    for (fault, changes) in [
        (
            "turns-not-counted",
            &[
                (round, "< 5A0#430460000000FFFF"),
                (turn, "< 5A0#4304600000000000"),
                (unpowered, "< 5A0#4304600000080000"),
            ][..],
        ),
        (
            "position-stops-at-the-end",
            &[(round, "< 5A0#43046000FFFFFFFF")],
        ),
        ("turns-unpowered-missed", &[(unpowered, turn)]),
        (
            "resolution-without-effect",
            &[
                (turn, "< 5A0#4304600000000100"),
                (unpowered, "< 5A0#4304600000800100"),
                ("< 5A0#4B0320000C000000", "< 5A0#4B03200010000000"),
            ],
        ),
        (
            "speed-clipped",
            &[("< 5A0#4300200000879303", "< 5A0#4300200018FCF301")],
        ),
        (
            "limits-not-checked",
            &[("< 5A0#8003200031000906", "< 5A0#6003200000000000")],
        ),
    ] {
        departs(&KIND, fault, TURNS, changes);
    }
}

#[test]
fn fault_in_cyclic_timer() {
    departs(
        &KIND,
        "cyclic-timer-without-effect",
        "
        wait 20 ms
        < 720#00
        > 620#2B00620032000000
        < 5A0#6000620000000000
        > 620#4000180500000000
        < 5A0#4B00180532000000
        ",
        &[("< 5A0#4B00180532000000", "< 5A0#4B00180564000000")],
    );
}
