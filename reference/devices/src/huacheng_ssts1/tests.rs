use super::KIND;
use crate::Settings;
use crate::script::{Script, assert_same, conforms, departs};

const REMAPPING: &str = "
    switch node = 2
    wait 30 ms
    < 702#00
    > 602#2300180182010080
    < 582#6000180100000000
    > 602#2F001A0000000000
    < 582#60001A0000000000
    > 602#23001A0110004160
    < 582#60001A0100000000
    > 602#23001A0208006160
    < 582#60001A0200000000
    > 602#2F001A0002000000
    < 582#60001A0000000000
    > 602#2300180182010000
    < 582#6000180100000000
    > 000#0102
    < 182#500200
    < 282#0000000000000000
    > 302#18FCFFFF2C010000
    > 602#407A600000000000
    < 582#437A600018FCFFFF
    > 602#4081600000000000
    < 582#438160002C010000
    set 6064:00 = -12013
    wait 1 ms
    < 282#13D1FFFF00000000
";

#[test]
fn remapping_of_node_2() {
    conforms(&KIND, REMAPPING);
}

const SYNC: &str = "
    wait 30 ms
    < 701#00
    > 601#2306100050C30000
    < 581#6006100000000000
    wait 100 ms
    > 601#2305100080000040
    < 581#6005100000000000
    wait 102 ms
    < 080#
    < 080#
    > 601#2305100081000040
    < 581#8005100022000008
    > 601#2305100080000000
    < 581#6005100000000000
    wait 49 ms
    wait 51 ms
";

#[test]
fn sync_producer() {
    conforms(&KIND, SYNC);
}

const GUARDING: &str = "
    wait 30 ms
    < 701#00
    > 701#R
    < 701#7F
    > 000#0101
    < 181#500200
    < 281#0000000000000000
    > 701#R
    < 701#85
    > 701#R
    < 701#05
    > 000#0201
    > 701#R
    < 701#84
    > 601#4000100000000000
";

#[test]
fn guarding() {
    conforms(&KIND, GUARDING);
}

#[test]
fn sdo_in_stopped_as_the_prose_has_it() {
    let script = "
        wait 30 ms
        < 701#00
        > 000#0201
        > 601#4000100000000000
        < 581#4300100092010200
        ";
    let settings = Settings {
        variant: Some("sdo-in-stopped".to_owned()),
        ..Settings::default()
    };
    assert_same(&Script::new(&KIND, &settings).play(script), script);
}

#[test]
fn objects_of_the_manual() {
    conforms(
        &KIND,
        "
        wait 30 ms
        < 701#00
        > 601#4000100000000000
        < 581#4300100092010200
        > 601#4009100000000000
        < 581#4309100056302E32
        > 601#4008100000000000
        < 581#410810000D000000
        > 601#2F60600003000000
        < 581#6060600000000000
        > 601#4061600000000000
        < 581#4F61600003000000
        > 601#2310100273617665
        < 581#6010100200000000
        > 000#8101
        wait 30 ms
        < 701#00
        > 601#4060600000000000
        < 581#4F60600000000000
        ",
    );
}

const SERIAL: &str = "
    wait 30 ms
    < 701#00
    >> 01 06 01 45 03 E8 99 5D
    << 01 06 01 45 03 E8 99 5D
    >> 01 10 01 45 00 02 04 03 E8 07 D0 B9 EC
    << 01 10 01 45 00 02 51 E1
    >> 01 06 01 45 27 10 83 DF
    << 01 86 02 C3 A1
    >> 01 06 01 45 27 10 99 5D
    switch address = 2
    set register 00D4 = 500
    set P213 = 1000
    >> 02 03 00 D4 00 02 84 00
    << 02 03 04 01 F4 03 E8 89 83
";

#[test]
fn worked_modbus_examples() {
    conforms(&KIND, SERIAL);
}

#[test]
fn registers_and_dictionary_are_as_new_after_power_off() {
    let mut script = Script::new(&KIND, &Settings::default());
    script.play("wait 30 ms");
    let before = script.device.state();
    script.play(">> 01 06 01 45 03 E8 99 5D\n > 601#2F60600003000000\n begin local-control");
    let changed = before.differences(&script.device.state());
    let changed: Vec<_> = changed.into_iter().map(|it| it.name).collect();
    assert_eq!(changed, ["6060:00", "P325", "local-control"]);
    script.play("end local-control\n power off\n power on\n wait 30 ms");
    assert_eq!(script.device.state(), before);
}

#[test]
fn fault_in_guarding() {
    departs(
        &KIND,
        "guarding-toggle-stuck",
        GUARDING,
        &[("< 701#85", "< 701#05"), ("< 701#84", "< 701#04")],
    );
}

#[test]
fn fault_in_sync() {
    departs(
        &KIND,
        "sync-not-stopped",
        SYNC,
        &[
            ("wait 49 ms", "wait 49 ms\n< 080#"),
            ("wait 51 ms", "wait 51 ms\n< 080#"),
        ],
    );
}

#[test]
fn fault_in_exception() {
    departs(
        &KIND,
        "exception-without-80h",
        SERIAL,
        &[("<< 01 86 02 C3 A1", "<< 01 06 02 A2 61")],
    );
}

#[test]
fn fault_in_writing_several() {
    departs(
        &KIND,
        "write-multiple-forgets",
        "
        wait 30 ms
        < 701#00
        >> 01 10 01 45 00 02 04 03 E8 07 D0 B9 EC
        << 01 10 01 45 00 02 51 E1
        >> 01 03 01 45 00 02 D4 22
        << 01 03 04 03 E8 07 D0 79 EF
        ",
        &[(
            "<< 01 03 04 03 E8 07 D0 79 EF",
            "<< 01 03 04 03 E8 00 00 7A 43",
        )],
    );
}

#[test]
fn fault_in_emergency() {
    departs(
        &KIND,
        "emergency-without-register",
        "
        wait 30 ms
        < 701#00
        begin hardware-fault
        wait 2 ms
        < 081#0050010000000000
        end hardware-fault
        wait 2 ms
        < 081#0000000000000000
        ",
        &[("< 081#0050010000000000", "< 081#0050000000000000")],
    );
}
