use std::time::Duration;

use crate::script::{Script, conforms, departs, without_fault};
use crate::{DeviceKind, Settings, huacheng_ssts1, kinco_servo};

const KINCO: &DeviceKind = &kinco_servo::KIND;
const HUACHENG: &DeviceKind = &huacheng_ssts1::KIND;

/// `6` writes the controlword 0006h; `?` reads the statusword, of which the low byte is told, and bits 8 to 15.
fn drive(kind: &DeviceKind, settings: &Settings, script: &str) -> Vec<String> {
    let mut device = Script::new(kind, settings);
    device.pass(Duration::from_millis(100));
    let mut seen = Vec::new();
    for word in script.split_whitespace() {
        if word == "?" {
            let told = device.play("> 601#4041600000000000");
            let answer = told
                .lines()
                .rfind(|line| line.starts_with("< 581#"))
                .unwrap();
            let bytes = &answer["< 581#4B416000".len()..];
            seen.push(format!("{}{}", &bytes[2..4], &bytes[..2]));
        } else if let Some(milliseconds) = word.strip_suffix("ms") {
            device.play(&format!("wait {milliseconds} ms"));
        } else if let Some((object, value)) = word.split_once('=') {
            let (index, size) = object.split_at(4);
            let command = match size {
                "b" => 0x2F,
                "w" => 0x2B,
                _ => 0x23,
            };
            let value = (value.parse::<i64>().unwrap() as u32).to_le_bytes();
            let value: String = value.iter().map(|byte| format!("{byte:02X}")).collect();
            let told = device.play(&format!(
                "> 601#{command:02X}{}{}00{value}",
                &index[2..],
                &index[..2]
            ));
            assert!(told.contains("< 581#60"), "{word}: {told}");
        } else if let Some(condition) = word.strip_prefix('+') {
            device.play(&format!("begin {condition}"));
        } else if let Some(condition) = word.strip_prefix('-') {
            device.play(&format!("end {condition}"));
        } else {
            let value = u16::from_str_radix(word, 16).unwrap().swap_bytes();
            device.play(&format!("> 601#2B406000{value:04X}0000"));
        }
    }
    seen
}

fn right(kind: &DeviceKind, script: &str, statuswords: &[&str]) {
    let seen = drive(kind, &Settings::default(), script);
    assert_eq!(seen, statuswords, "{} {script}", kind.name);
}

fn variant(name: &str) -> Settings {
    Settings {
        variant: Some(name.to_owned()),
        ..Settings::default()
    }
}

/// A right drive shows `statuswords`, one with the fault something else.
fn wrong(kind: &DeviceKind, fault: &str, script: &str, statuswords: &[&str], faulty: &[&str]) {
    right(kind, script, statuswords);
    let settings = Settings {
        fault: Some(fault.to_owned()),
        ..Settings::default()
    };
    assert_eq!(drive(kind, &settings, script), faulty, "{fault}");
}

#[test]
fn up_and_down() {
    for kind in [KINCO, HUACHENG] {
        right(
            kind,
            "? 6 ? 7 ? F ? 7 ? F ? 6 ? F ? 0 ?",
            &[
                "0250", "0231", "0233", "0237", "0233", "0237", "0231", "0237", "0250",
            ],
        );
        right(kind, "7 ? F ? 2 ? 0 ?", &["0250"; 4]);
        right(kind, "6 2 ? 6 7 2 ?", &["0250", "0250"]);
    }
}

#[test]
fn quick_stop() {
    // The motor of this drive stands after 10 ms.
    right(KINCO, "6 F 2 ? 20ms ? F ?", &["0217", "0250", "0250"]);
    right(HUACHENG, "6 F 2 ? 20ms ?", &["0217", "0250"]);
    right(
        KINCO,
        "605Aw=6 6 F 2 ? 20ms ? 6 ? 7 ? F ? 2 0 ?",
        &["0217", "0217", "0217", "0217", "0237", "0250"],
    );
    right(KINCO, "605Aw=0 6 F 2 ?", &["0250"]);
}

#[test]
fn fault_and_its_reset() {
    for kind in [KINCO, HUACHENG] {
        right(
            kind,
            "6 7 F +drive-fault ? 20ms ? 80 ? 0 ? -drive-fault F ? 0 80 ? F ?",
            &["021F", "0218", "0218", "0218", "0218", "0250", "0250"],
        );
        // Bit 7 was 1 before the cause had gone: there is no edge.
        right(
            kind,
            "+drive-fault 80 -drive-fault 80 ? 0 ? 80 ?",
            &["0218", "0218", "0250"],
        );
    }
}

#[test]
fn fault_tells_its_code() {
    conforms(
        HUACHENG,
        "
        wait 30 ms
        < 701#00
        begin drive-fault
        wait 1 ms
        < 081#0573210000000000
        > 601#403F600000000000
        < 581#4B3F600005730000
        > 601#4001100000000000
        < 581#4F01100021000000
        > 601#4000210000000000
        < 581#4B00210002000000
        end drive-fault
        wait 1 ms
        > 601#2B40600080000000
        < 081#0000000000000000
        < 581#6040600000000000
        wait 1 ms
        > 601#403F600000000000
        < 581#4B3F600000000000
        ",
    );
}

#[test]
fn reset_and_power_disable() {
    for again in ["> 000#8101\nwait 50 ms", "power off\npower on\nwait 50 ms"] {
        let script = format!(
            "wait 30 ms\n> 601#2B40600006000000\n> 601#2B4060000F000000\n{again}\n> 601#4041600000000000"
        );
        let told = without_fault(KINCO, &script);
        assert!(told.ends_with("< 581#4B41600050020000\n"), "{told}");
    }
}

#[test]
fn panel_has_control() {
    right(
        KINCO,
        "6 +local-control ? F ? -local-control ? F ?",
        &["0031", "0031", "0231", "0237"],
    );
}

#[test]
fn profile_position() {
    // 100 counts at 2000 counts a second.
    let script = "6060b=1 6081=2000 607A=100 6 F ? 1F ? 1F ? F ? 60ms ? 1F F ? 60ms ?";
    let statuswords = ["0637", "1237", "1237", "0237", "0637", "0237", "0637"];
    right(KINCO, script, &statuswords);
    // A second set-point waits for the first; a third is not taken.
    right(
        KINCO,
        "6060b=1 6081=2000 607A=100 6 F 1F F 607A=200 1F ? F 1F ? F 60ms ? 60ms ?",
        &["1237", "0237", "0237", "0637"],
    );
    // At once, and halted.
    right(
        KINCO,
        "6060b=1 6081=2000 607A=1000 6 F 3F F ? 10F ? 20ms ? F ? 607A=0 3F F 60ms ?",
        &["0237", "0637", "0637", "0237", "0637"],
    );
}

#[test]
fn position_follows_its_set_points() {
    let mut device = Script::new(HUACHENG, &Settings::default());
    device.pass(Duration::from_millis(50));
    let told = device.play(
        "
        > 601#2F60600001000000
        > 601#2381600006000000
        > 601#237A600064000000
        > 601#2B40600006000000
        > 601#2B4060000F000000
        > 601#2B4060005F000000
        wait 300 ms
        > 601#4064600000000000
        > 601#2B4060000F000000
        > 601#2B4060005F000000
        wait 50 ms
        > 601#406C600000000000
        wait 300 ms
        > 601#4064600000000000
        ",
    );
    // Twice by 100 pulses, at 6 rpm.
    for answer in [
        "581#4364600064000000",
        "581#436C600006000000",
        "581#43646000C8000000",
    ] {
        assert!(told.contains(answer), "{answer}\n{told}");
    }
}

#[test]
fn profile_velocity() {
    right(
        KINCO,
        "6060b=3 60FF=0 6 F ? 60FF=-500 ? 10ms ? 10F 10ms ? F 60FF=0 10ms ?",
        &["1637", "1237", "0637", "1637", "1637"],
    );
    // 100 rpm with 1000 ms for 1000 rpm are there after 100 ms.
    right(
        HUACHENG,
        "6060b=3 6083=1000 60FF=100 6 F 50ms ? 70ms ?",
        &["0237", "0637"],
    );
}

#[test]
fn modes() {
    conforms(
        KINCO,
        "
        wait 10 ms
        < 701#00
        > 601#2F60600003000000
        < 581#6060600003000000
        > 601#4061600000000000
        < 581#4F61600003000000
        > 601#2F60600004000000
        < 581#8060600030000906
        > 601#4061600000000000
        < 581#4F61600003000000
        > 601#4002650000000000
        < 581#4302650005000000
        ",
    );
}

#[test]
fn variants() {
    let brake = "6 F ? 50ms ? 40ms ? 0 6 F 50ms F 40ms ?";
    let seen = drive(KINCO, &variant("brake"), brake);
    assert_eq!(seen, ["0233", "0233", "0237", "0237"]);
    let seen = drive(KINCO, &variant("brake"), "6 F 0 ? 100ms ?");
    assert_eq!(seen, ["0250", "0250"]);
    let seen = drive(KINCO, &variant("enabled-step-by-step"), "6 F ? F ?");
    assert_eq!(seen, ["0233", "0237"]);
    let stay = "605Aw=6 6 F 2 20ms ? F ? 0 ?";
    let seen = drive(KINCO, &variant("quick-stop-not-resumed"), stay);
    assert_eq!(seen, ["0217", "0217", "0250"]);
    let seen = drive(
        KINCO,
        &variant("quick-stop-bit-at-rest"),
        "? 6 ? +drive-fault ?",
    );
    assert_eq!(seen, ["0270", "0231", "0238"]);
    let later = variant("mode-switched-later");
    let seen = drive(KINCO, &later, "6 F 6060b=3 ? 50ms ?");
    assert_eq!(seen, ["0237", "1637"]);
    let passed = variant("unsupported-mode-passed-over");
    let seen = drive(KINCO, &passed, "6060b=3 6060b=7 6 F ?");
    assert_eq!(seen, ["1637"]);
}

#[test]
fn faults_of_transitions() {
    let rows = [
        ("drive-enabled-without-shutdown", "F ?", "0250", "0237"),
        ("drive-switched-on-without-shutdown", "7 ?", "0250", "0233"),
        ("drive-shutdown-ignored", "6 ?", "0231", "0250"),
        ("drive-direct-enable-ignored", "6 F ?", "0237", "0231"),
        ("drive-disable-operation-ignored", "6 F 7 ?", "0233", "0237"),
        (
            "drive-shutdown-from-switched-on-ignored",
            "6 7 6 ?",
            "0231",
            "0233",
        ),
        (
            "drive-shutdown-while-enabled-ignored",
            "6 F 6 ?",
            "0231",
            "0237",
        ),
        ("drive-ready-state-kept", "6 0 ?", "0250", "0231"),
        (
            "drive-quick-stop-at-rest-ignored",
            "6 7 2 ?",
            "0250",
            "0233",
        ),
        ("drive-disable-voltage-ignored", "6 F 0 ?", "0250", "0237"),
        ("drive-quick-stop-ignored", "6 F 2 ?", "0217", "0237"),
        (
            "drive-quick-stop-option-ignored",
            "605Aw=6 6 F 2 20ms ?",
            "0217",
            "0250",
        ),
        (
            "drive-quick-stop-left-by-shutdown",
            "605Aw=6 6 F 2 6 ?",
            "0217",
            "0231",
        ),
        (
            "drive-quick-stop-never-ends",
            "6 F 2 20ms ?",
            "0250",
            "0217",
        ),
        ("drive-commands-by-whole-word", "6 F D ?", "0250", "0237"),
        ("drive-remote-bit-missing", "6 ?", "0231", "0031"),
        ("drive-quick-stop-kept", "605Aw=6 6 F 2 0 ?", "0250", "0217"),
        (
            "drive-fault-left-by-disable-voltage",
            "+drive-fault -drive-fault 0 ?",
            "0218",
            "0250",
        ),
        (
            "drive-fault-reset-by-level",
            "80 +drive-fault -drive-fault 80 ?",
            "0218",
            "0250",
        ),
        (
            "drive-fault-reset-with-cause",
            "+drive-fault 80 ?",
            "0218",
            "0250",
        ),
        (
            "drive-ready-after-fault-reset",
            "+drive-fault -drive-fault 80 ?",
            "0250",
            "0231",
        ),
        (
            "drive-enabled-through-fault",
            "6 F +drive-fault 20ms ?",
            "0218",
            "0237",
        ),
    ];
    for (fault, script, right, faulty) in rows {
        wrong(KINCO, fault, script, &[right], &[faulty]);
    }
}

#[test]
fn faults_of_statusword_and_modes() {
    let rows = [
        ("drive-quick-stop-bit-missing", "6 ?", "0231", "0211"),
        ("drive-voltage-bit-missing", "6 F ?", "0237", "0227"),
        (
            "drive-local-control-not-told",
            "6 +local-control F ?",
            "0031",
            "0237",
        ),
        ("drive-mode-display-stuck", "6060b=3 6 F ?", "1637", "0237"),
        (
            "drive-set-point-not-acknowledged",
            "6060b=1 607A=9 6 F 1F ?",
            "1237",
            "0237",
        ),
        (
            "drive-acknowledge-not-withdrawn",
            "6060b=1 607A=9 6 F 1F F ?",
            "0237",
            "1237",
        ),
        (
            "drive-target-reached-always",
            "6060b=1 607A=9 6 F 1F ?",
            "1237",
            "1637",
        ),
        (
            "drive-target-reached-never",
            "6060b=1 6 F ?",
            "0637",
            "0237",
        ),
        ("drive-speed-zero-inverted", "6060b=3 6 F ?", "1637", "0637"),
        (
            "drive-halt-ignored",
            "6060b=3 60FF=5 6 F 10F 9ms ?",
            "1637",
            "0637",
        ),
    ];
    for (fault, script, right, faulty) in rows {
        wrong(KINCO, fault, script, &[right], &[faulty]);
    }
    // The second 1F has no edge.
    let twice = "6060b=1 6081=2000 607A=50 6 F 1F 50ms 607A=99 1F ?";
    wrong(
        KINCO,
        "drive-set-point-by-level",
        twice,
        &["1637"],
        &["1237"],
    );
    let ramp = "6060b=3 6083=5000 60FF=100 6 F 50ms ?";
    wrong(HUACHENG, "drive-ramp-inverted", ramp, &["0237"], &["0637"]);
}

#[test]
fn faults_of_values() {
    let mode = "
        wait 10 ms
        < 701#00
        > 601#2F60600005000000
        < 581#8060600030000906
        > 601#4002650000000000
        < 581#4302650005000000
    ";
    departs(
        KINCO,
        "drive-any-mode-taken",
        mode,
        &[("< 581#8060600030000906", "< 581#6060600005000000")],
    );
    departs(
        KINCO,
        "drive-modes-overstated",
        mode,
        &[("< 581#4302650005000000", "< 581#4302650025000000")],
    );
    let fault = "
        wait 30 ms
        < 701#00
        begin drive-fault
        wait 1 ms
        < 081#0573210000000000
        > 601#403F600000000000
        < 581#4B3F600005730000
    ";
    departs(
        HUACHENG,
        "drive-error-code-missing",
        fault,
        &[("< 581#4B3F600005730000", "< 581#4B3F600000000000")],
    );
    departs(
        HUACHENG,
        "drive-fault-without-emergency",
        fault,
        &[("< 081#0573210000000000", "")],
    );
    departs(
        HUACHENG,
        "drive-velocity-without-sign",
        "
        wait 30 ms
        < 701#00
        > 601#2F60600003000000
        < 581#6060600000000000
        > 601#23FF6000FFFFFFFF
        < 581#60FF600000000000
        > 601#2B40600006000000
        < 581#6040600000000000
        > 601#2B4060000F000000
        < 581#6040600000000000
        wait 10 ms
        > 601#406C600000000000
        < 581#436C6000FFFFFFFF
        ",
        &[("< 581#436C6000FFFFFFFF", "< 581#436C600001000000")],
    );
    departs(
        KINCO,
        "drive-enabled-through-reset",
        "
        wait 10 ms
        < 701#00
        > 601#2B40600006000000
        < 581#6040600006000000
        > 601#2B4060000F000000
        < 581#604060000F000000
        > 000#8101
        wait 20 ms
        < 701#00
        > 601#4041600000000000
        < 581#4B41600050020000
        ",
        &[("< 581#4B41600050020000", "< 581#4B41600037020000")],
    );
}
