use super::KIND;
use crate::Settings;
use crate::inverter::Inverter;
use crate::script::{Script, assert_same, departures, without_fault};

fn play(fault: Option<&str>, script: &str) -> String {
    let settings = Settings {
        fault: fault.map(str::to_owned),
        ..Settings::default()
    };
    let inverter = Box::new(Inverter::new(0));
    Script::new(&KIND, &settings).with(inverter).play(script)
}

fn conforms(script: &str) {
    assert_same(&play(None, script), script);
}

fn departs(fault: &str, script: &str, changes: &[(&str, &str)]) {
    conforms(script);
    assert_same(&play(Some(fault), script), &departures(script, changes));
}

const OBJECTS: &str = "
    wait 20 ms
    < 701#00
    > 601#4000100000000000
    < 581#4300100092010100
    > 601#4018100100000000
    < 581#4318100173030000
    > 601#4008100000000000
    < 581#410810000A000000
    > 601#6000000000000000
    < 581#004A4E352D434D2D
    > 601#7000000000000000
    < 581#1943414E00000000
    > 601#4009100000000000
    < 581#4709100056313000
    > 601#4025200100000000
    < 581#8025200111000906
    > 601#2B4F600000000000
    < 581#804F600032000906
    > 601#2F00180200000000
    < 581#8000180230000906
    > 601#2305100080000040
    < 581#8005100030000906
    > 601#2305100080000000
    < 581#6005100000000000
    > 7E5#0401000000000000
    > 7E5#5A00000000000000
";

#[test]
fn objects_of_the_module_itself() {
    conforms(OBJECTS);
}

const RUN_REVERSE: &str = "
    wait 20 ms
    < 701#00
    > 601#2B42600052240000
    << 01 06 25 02 48 A4 14 BD
    wait 50 ms
    >> 01 06 25 02 48 A4 14 BD
    < 581#6042600000000000
    > 601#2B40600001000000
    << 01 06 25 01 00 01 12 C6
    wait 50 ms
    >> 01 06 25 01 00 01 12 C6
    < 581#6040600000000000
    > 601#2B42600052A40000
    << 01 06 25 02 48 A4 14 BD
    wait 80 ms
    >> 01 06 25 02 48 A4 14 BD
    << 01 06 25 01 00 03 93 07
    >> 01 06 25 01 00 03 93 07
    < 581#6042600000000000
    > 601#4043600000000000
    << 01 03 25 20 00 05 8F 0F
    wait 50 ms
    >> 01 03 0A 00 07 00 00 00 00 48 A4 48 A4 63 7E
    < 581#4B43600052A40000
    > 601#4042600000000000
    < 581#4B42600052A40000
    > 601#4025200200000000
    << 01 03 25 01 00 01 DE C6
    wait 50 ms
    >> 01 03 02 00 03 F8 45
    < 581#4B25200203000000
";

#[test]
fn target_velocity_is_frequency_and_direction() {
    conforms(RUN_REVERSE);
}

const GROUP_25: &str = "
    wait 20 ms
    < 701#00
    > 601#2B25200201000000
    << 01 06 25 01 00 01 12 C6
    wait 50 ms
    >> 01 06 25 01 00 01 12 C6
    < 581#6025200200000000
    > 601#4025202100000000
    << 01 03 25 20 00 01 8E CC
    wait 50 ms
    >> 01 03 02 00 05 78 47
    < 581#4B25202105000000
    > 601#4025202400000000
    << 01 03 25 23 00 01 7E CC
    wait 50 ms
    >> 01 03 02 01 F4 B8 53
    < 581#4B252024F4010000
    > 601#4025203000000000
    << 01 03 25 2F 00 01 BE CF
    wait 50 ms
    >> 01 03 02 01 2C B8 09
    < 581#4B2520302C010000
    > 601#2B252003419C0000
    < 581#8025200331000906
    > 601#2B42600021520000
    << 01 06 25 02 A4 42 D9 F7
    wait 50 ms
    >> 01 86 03 02 61
    < 581#8042600030000906
    > 601#4042600000000000
    < 581#4B42600000000000
";

#[test]
fn group_25_and_what_the_inverter_refuses() {
    conforms(GROUP_25);
}

const ALONE: &str = "
    wait 20 ms
    < 701#00
    > 601#2B25200201000000
    << 01 06 25 01 00 01 12 C6
    wait 120 ms
    < 581#8025200200000606
    > 601#4025202100000000
    << 01 03 25 20 00 01 8E CC
    wait 120 ms
    < 581#8025202100000606
    set 6043:00 = 41248
    > 601#4043600000000000
    < 581#4B43600020A10000
";

#[test]
fn without_an_inverter() {
    let told = without_fault(&KIND, ALONE);
    assert_same(&told, ALONE);
}

#[test]
fn pdos() {
    let script = "
        wait 20 ms
        < 701#00
        > 601#2F00180201000000
        < 581#6000180200000000
        > 601#2F01180201000000
        < 581#6001180200000000
        > 000#0101
        << 01 03 25 20 00 05 8F 0F
        wait 40 ms
        >> 01 03 0A 00 04 00 00 00 00 01 F4 00 00 56 78
        > 201#01005224
        << 01 06 25 01 00 01 12 C6
        > 601#4042600000000000
        < 581#4B42600052240000
        wait 40 ms
        >> 01 06 25 01 00 01 12 C6
        << 01 06 25 02 48 A4 14 BD
        >> 01 06 25 02 48 A4 14 BD
        > 301#64006400
        wait 50 ms
        << 01 03 25 20 00 05 8F 0F
        >> 01 03 0A 00 05 00 00 00 00 48 A4 48 A4 7A 1E
        > 080#
        < 181#010052246400
        < 281#000001005224
        > 000#8001
        wait 300 ms
    ";
    conforms(script);
}

#[test]
fn only_what_the_switches_can_say() {
    use fieldproof_link::{Outbox, Stimulus};
    let mut script = Script::new(&KIND, &Settings::default());
    for (name, value, offered) in [
        ("node", 63, true),
        ("node", 64, false),
        ("node", 0, false),
        ("bit-rate", 50_000, true),
        ("bit-rate", 1_000_000, false),
        ("address", 1, false),
    ] {
        let stimulus = Stimulus::Setting {
            name: name.to_owned(),
            value,
        };
        let outcome = script
            .device
            .stimulate(script.now, &stimulus, &mut Outbox::default());
        assert_eq!(outcome.is_ok(), offered, "{name} {value}");
    }
}

#[test]
fn fault_in_registers() {
    departs(
        "gateway-swaps-two-registers",
        GROUP_25,
        &[("<< 01 03 25 23 00 01 7E CC", "<< 01 03 25 24 00 01 CF 0D")],
    );
}

#[test]
fn fault_in_direction() {
    departs(
        "gateway-direction-lost",
        RUN_REVERSE,
        &[
            ("<< 01 06 25 01 00 03 93 07", ""),
            (">> 01 06 25 01 00 03 93 07", ""),
            (
                ">> 01 03 0A 00 07 00 00 00 00 48 A4 48 A4 63 7E",
                ">> 01 03 0A 00 05 00 00 00 00 48 A4 48 A4 7A 1E",
            ),
            ("< 581#4B43600052A40000", "< 581#4B43600052240000"),
            (">> 01 03 02 00 03 F8 45", ">> 01 03 02 00 01 79 84"),
            ("< 581#4B25200203000000", "< 581#4B25200201000000"),
        ],
    );
}

#[test]
fn fault_in_fault_reset() {
    departs(
        "gateway-fault-reset-lost",
        "
        wait 20 ms
        < 701#00
        > 601#2B40600080000000
        << 01 06 25 01 00 08 D2 C0
        wait 30 ms
        >> 01 06 25 01 00 08 D2 C0
        < 581#6040600000000000
        ",
        &[
            ("<< 01 06 25 01 00 08 D2 C0", "<< 01 06 25 01 00 00 D3 06"),
            (">> 01 06 25 01 00 08 D2 C0", ">> 01 06 25 01 00 00 D3 06"),
        ],
    );
}

#[test]
fn fault_in_scale() {
    let script = "
        wait 20 ms
        < 701#00
        > 601#2B42600052240000
        << 01 06 25 02 48 A4 14 BD
        wait 50 ms
        >> 01 06 25 02 48 A4 14 BD
        < 581#6042600000000000
    ";
    departs(
        "gateway-frequency-halved",
        script,
        &[
            ("<< 01 06 25 02 48 A4 14 BD", "<< 01 06 25 02 24 52 B9 FB"),
            (">> 01 06 25 02 48 A4 14 BD", ">> 01 06 25 02 24 52 B9 FB"),
        ],
    );
}

#[test]
fn fault_in_waiting() {
    departs(
        "gateway-confirms-early",
        "
        wait 20 ms
        < 701#00
        > 601#2B25200201000000
        << 01 06 25 01 00 01 12 C6
        wait 50 ms
        >> 01 06 25 01 00 01 12 C6
        < 581#6025200200000000
        ",
        &[
            ("wait 50 ms", "< 581#6025200200000000\nwait 50 ms"),
            ("< 581#6025200200000000", ""),
        ],
    );
}

#[test]
fn fault_in_refusal() {
    departs(
        "gateway-refusal-hidden",
        GROUP_25,
        &[("< 581#8042600030000906", "< 581#6042600000000000")],
    );
}

/// The lines of what a device in front of an inverter makes of `script` that begin with `mark`.
fn lines_of(fault: Option<&str>, script: &str, mark: &str) -> Vec<String> {
    let told = play(fault, &format!("wait 20 ms\n{script}"));
    let lines = told.lines().filter(|line| line.starts_with(mark));
    lines
        .filter(|line| *line != "< 701#00")
        .map(str::to_owned)
        .collect()
}

#[test]
fn faults_in_what_the_inverter_is_told() {
    let run_and_turn = "
        > 601#2B40600001000000
        wait 100 ms
        > 601#2B426000F4810000
        wait 100 ms
    ";
    for (fault, script, right, wrong) in [
        (
            "gateway-target-as-integer16",
            "> 601#2B4260009CFF0000",
            "<< 01 06 25 02 FF 38 63 24",
            "<< 01 06 25 02 00 C8 22 90",
        ),
        (
            "gateway-frequency-in-15-bits",
            "> 601#2B426000204E0000",
            "<< 01 06 25 02 9C 40 4B F6",
            "<< 01 06 25 02 1C 40 2A 36",
        ),
        (
            "gateway-direction-stops",
            run_and_turn,
            "<< 01 06 25 01 00 03 93 07",
            "<< 01 06 25 01 00 02 52 C7",
        ),
        (
            "gateway-fault-reset-by-any-write",
            "> 601#2B40600000000000",
            "<< 01 06 25 01 00 00 D3 06",
            "<< 01 06 25 01 00 08 D2 C0",
        ),
        (
            "gateway-writes-one-further",
            "> 601#2B25200664000000",
            "<< 01 06 25 05 00 64 93 2C",
            "<< 01 06 25 06 00 64 63 2C",
        ),
        (
            "gateway-byte-order",
            "> 601#2B25200664000000",
            "<< 01 06 25 05 00 64 93 2C",
            "<< 01 06 25 05 64 00 B8 07",
        ),
    ] {
        let last = |fault| lines_of(fault, script, "<<").pop();
        assert_eq!(last(None).as_deref(), Some(right), "{fault}");
        assert_eq!(last(Some(fault)).as_deref(), Some(wrong), "{fault}");
    }
}

#[test]
fn faults_in_what_pdos_ask_and_tell() {
    let rpdo = "> 000#0101\n wait 90 ms\n > 201#01005224\n wait 90 ms";
    assert_eq!(lines_of(None, rpdo, "<< 01 06").len(), 2);
    let lost = lines_of(Some("gateway-pdo-not-passed-on"), rpdo, "<< 01 06");
    assert_eq!(lost.len(), 0);
    let operational = "> 000#0101\n wait 250 ms";
    assert_eq!(lines_of(None, operational, "<< 01 03").len(), 3);
    let lost = lines_of(Some("gateway-not-polled"), operational, "<< 01 03");
    assert_eq!(lost.len(), 0);
}

#[test]
fn faults_in_what_the_inverter_tells() {
    // Told to run, with a fault that keeps it from that.
    let faulty = "
        > 601#2B25200204000000
        wait 100 ms
        > 601#2B25200200000000
        wait 100 ms
        > 601#2B40600001000000
        wait 100 ms
        > 601#4041600000000000
        wait 100 ms
    ";
    let running = "
        > 601#2B40600001000000
        wait 100 ms
        > 601#4041600000000000
        wait 100 ms
    ";
    let demand = "> 601#4043600000000000\n wait 100 ms";
    let read = "> 601#4025202400000000\n wait 100 ms";
    for (fault, script, right, wrong) in [
        (
            "gateway-run-state-of-command",
            faulty,
            "< 581#4B41600000000000",
            "< 581#4B41600001000000",
        ),
        (
            "gateway-run-state-frozen",
            running,
            "< 581#4B41600001000000",
            "< 581#4B41600000000000",
        ),
        (
            "gateway-demand-not-halved",
            demand,
            "< 581#4B436000FA000000",
            "< 581#4B436000F4010000",
        ),
        (
            "gateway-byte-order",
            read,
            "< 581#4B252024F4010000",
            "< 581#4B25202401F40000",
        ),
    ] {
        let last = |fault| lines_of(fault, script, "< ").pop();
        assert_eq!(last(None).as_deref(), Some(right), "{fault}");
        assert_eq!(last(Some(fault)).as_deref(), Some(wrong), "{fault}");
    }
}

/// Nobody answers, or somebody does by hand.
const BY_HAND: &str = "
    wait 20 ms
    < 701#00
    > 601#4025202400000000
    << 01 03 25 23 00 01 7E CC
    wait 10 ms
    >> 01 03 02 12 34 B5 34
    < 581#8025202400000606
    > 601#4025202400000000
    << 01 03 25 23 00 01 7E CC
    wait 10 ms
    >> 02 03 02 12 34 F1 33
    < 581#8025202400000606
    > 601#4025202400000000
    << 01 03 25 23 00 01 7E CC
    wait 10 ms
    >> 01 83 04 40 F3
    < 581#8025202420000008
    > 601#4025202400000000
    << 01 03 25 23 00 01 7E CC
    wait 10 ms
    >> 01 03 02 01 F4 B8 53
    < 581#4B252024F4010000
";

#[test]
fn faults_in_what_is_taken_for_an_answer() {
    let malformed = "< 581#8025202400000606";
    let silent = malformed;
    for (fault, changes) in [
        (
            "gateway-crc-unchecked",
            &[(malformed, "< 581#4B25202434120000")][..],
        ),
        (
            "gateway-station-unchecked",
            &[(malformed, malformed), (silent, "< 581#4B25202434120000")],
        ),
        (
            "gateway-lost-inverter-reads-zero",
            &[(malformed, malformed), (silent, "< 581#4B25202400000000")],
        ),
        (
            "gateway-exception-as-value",
            &[("< 581#8025202420000008", "< 581#4B25202404000000")],
        ),
    ] {
        crate::script::departs(&KIND, fault, BY_HAND, changes);
    }
}

#[test]
fn faults_when_the_inverter_is_lost() {
    let script = "
        wait 20 ms
        < 701#00
        > 601#4025202400000000
        << 01 03 25 23 00 01 7E CC
        wait 120 ms
        < 581#8025202400000606
        > 601#4025202200000000
        << 01 03 25 21 00 01 DF 0C
        wait 120 ms
        < 581#8025202200000606
    ";
    let (first, second) = ("< 581#8025202400000606", "< 581#8025202200000606");
    let asked = "<< 01 03 25 21 00 01 DF 0C";
    crate::script::departs(
        &KIND,
        "gateway-lost-for-good",
        script,
        &[(asked, second), (second, "")],
    );
    crate::script::departs(
        &KIND,
        "gateway-lost-inverter-hangs",
        script,
        &[(first, ""), (second, "")],
    );
}

#[test]
fn variants_in_what_the_inverter_tells() {
    for (variant, script, answer) in [
        (
            "statusword-of-cia402",
            "> 601#4041600000000000",
            "< 581#4B41600031020000",
        ),
        (
            "demand-behind-ramp",
            "> 601#4043600000000000",
            "< 581#4B43600000000000",
        ),
        (
            "demand-rounded-up",
            "> 601#2B25200301000000\n wait 100 ms\n > 601#4043600000000000",
            "< 581#4B43600001000000",
        ),
    ] {
        let settings = Settings {
            variant: Some(variant.to_owned()),
            ..Settings::default()
        };
        let inverter = Box::new(Inverter::new(0));
        let mut device = Script::new(&KIND, &settings).with(inverter);
        let told = device.play(&format!("wait 20 ms\n{script}\n wait 100 ms"));
        assert!(told.contains(answer), "{variant}: {told}");
    }
}
