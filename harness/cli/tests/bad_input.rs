//! Whatever the input is: a clear error, exit code 2, and nothing in `reports/`.

#![allow(clippy::unwrap_used)]

mod support;

use std::fs::File;

use support::{Folder, Ran, suite};

/// One error that contains each of `parts`, and nothing written.
#[track_caller]
fn refused(folder: &Folder, arguments: &[&str], parts: &[&str]) {
    let before = folder.files();
    let ran = folder.run(arguments);
    refused_with_one_error(&ran, parts);
    assert_eq!(folder.files(), before);
}

#[track_caller]
fn refused_with_one_error(ran: &Ran, parts: &[&str]) {
    let error = ran.error();
    assert_eq!(ran.exit(), Some(2), "{error}");
    let errors = error.lines().filter(|line| line.starts_with("error"));
    assert_eq!(errors.count(), 1, "{error}");
    for part in parts {
        assert!(error.contains(part), "no {part:?} in\n{error}");
    }
    assert_eq!(ran.out(), "");
}

#[test]
fn unknown_names_are_answered_with_the_nearest() {
    let folder = Folder::new();
    for (arguments, parts) in [
        (
            ["run", "canopen.ntm"].as_slice(),
            ["no suite, file or folder is called", "\"canopen.nmt\"?"],
        ),
        (
            &["run", "--case", "canopen.nmt/transitoin"],
            ["no case is like", "\"canopen.nmt/transition\"?"],
        ),
        (
            &["run", "--device", "kinko"],
            ["no device is called", "\"kinco-servo\"?"],
        ),
        (
            &["run", "--fault", "boot-up-mising"],
            ["no fault is called", "\"boot-up-missing\"?"],
        ),
        (
            &["run", "--variant", "slwo"],
            ["no variant is called", "\"slow\"?"],
        ),
        (
            &["prove", "--fault", "boot-up-mising"],
            ["no fault is called", "\"boot-up-missing\"?"],
        ),
        (
            &["list", "canopen.ntm"],
            ["no suite, file or folder is called", "\"canopen.nmt\"?"],
        ),
    ] {
        refused(&folder, arguments, &parts);
    }
}

#[test]
fn fault_of_another_device_is_unknown_here() {
    let folder = Folder::new();
    let arguments = [
        "run",
        "--device",
        "kinco-servo",
        "--fault",
        "stale-crc-accepted",
    ];
    refused(
        &folder,
        &arguments,
        &[
            "no fault is called \"stale-crc-accepted\"",
            "abort-code-wrong",
        ],
    );
}

#[test]
fn large_file_is_not_read() {
    let folder = Folder::new();
    // A hole in the file: it takes no room on the disk.
    File::create(folder.path().join("large.yaml"))
        .unwrap()
        .set_len(100_000_000)
        .unwrap();
    refused(
        &folder,
        &["run", "large.yaml"],
        &["larger than 16 MiB", "large.yaml"],
    );
}

#[test]
fn yaml_bomb_is_an_error() {
    let folder = Folder::new();
    let mut bomb = "a0: &a0 [x, x, x, x, x, x, x, x, x]\n".to_owned();
    for level in 1..40 {
        let last = level - 1;
        let aliases = vec![format!("*a{last}"); 9].join(", ");
        bomb.push_str(&format!("a{level}: &a{level} [{aliases}]\n"));
    }
    folder.write("bomb.yaml", bomb);
    let ran = folder.run(&["run", "bomb.yaml"]);
    assert_eq!(ran.exit(), Some(2));
    assert!(
        ran.error()
            .contains("an alias: what a case says must stand in it")
    );
    // However many mistakes there are, so many are shown.
    assert_eq!(ran.error().matches("error[S004]").count(), 20);
    assert_eq!(folder.files(), ["bomb.yaml"]);
}

#[test]
fn deep_yaml_is_an_error() {
    let folder = Folder::new();
    folder.write("deep.yaml", "[".repeat(1_000_000));
    refused(&folder, &["run", "deep.yaml"], &["deep.yaml:"]);
}

#[test]
fn file_that_is_no_text_is_an_error() {
    let folder = Folder::new();
    folder.write("a.yaml", b"suite: \xff\xfe");
    refused(&folder, &["run", "a.yaml"], &["not UTF-8 text", "a.yaml"]);
}

#[test]
fn empty_file_is_an_error() {
    let folder = Folder::new();
    folder.write("empty.yaml", "");
    refused(&folder, &["run", "empty.yaml"], &["empty.yaml"]);
}

#[test]
fn mistakes_point_at_their_place() {
    for (step, parts) in [
        (
            "sdo-raed: {object: \"1000:00\", as: u32}",
            ["sdo-raed", ":12:9"],
        ),
        ("expect-silence: 3 apples", ["apples", ":12:25"]),
        ("send: \"601#40001000000000\\n\"", ["not a frame", ":12:15"]),
        (
            "sdo-read: {object: \"10000:00\", as: u32}",
            ["10000", ":12:28"],
        ),
        ("nmt-enter: sleeping", ["sleeping", ":12:20"]),
    ] {
        let folder = Folder::new();
        folder.write("a.yaml", suite("a", step));
        refused(&folder, &["run", "a.yaml"], &parts);
    }
}

#[test]
fn suite_for_a_device_that_does_not_exist_is_an_error() {
    let folder = Folder::new();
    let text = suite("a", "sdo-read: {object: \"1000:00\", as: u32}");
    let text = text.replace("protocol:", "device: kinko-servo\nprotocol:");
    folder.write("a.yaml", text);
    refused(
        &folder,
        &["run", "a.yaml"],
        &["kinko-servo", "\"kinco-servo\"?"],
    );
}

#[test]
fn good_suite_beside_a_bad_one_is_not_played() {
    let folder = Folder::new();
    folder.write(
        "good.yaml",
        suite("good", "sdo-read: {object: \"1000:00\", as: u32}"),
    );
    folder.write("bad.yaml", suite("bad", "sdo-read: {object: 5}"));
    refused(&folder, &["run", "good.yaml", "bad.yaml"], &["bad.yaml:12"]);
}

#[test]
fn reports_that_cannot_be_written_are_the_benchs_fault() {
    let folder = Folder::new();
    folder.write(
        "good.yaml",
        suite("good", "sdo-read: {object: \"1000:00\", as: u32}"),
    );
    folder.write("reports", "a file");
    let ran = folder.run(&["run", "good.yaml"]);
    assert_eq!(ran.exit(), Some(3));
    assert!(ran.error().contains("cannot be written"), "{}", ran.error());
    assert_eq!(folder.read("reports"), "a file");
}

#[test]
fn device_description_with_a_mistake_is_an_error() {
    let folder = Folder::new();
    assert_eq!(folder.run(&["export", "mine"]).exit(), Some(0));
    let path = "mine/devices/teco-jn5-cm-can/device.yaml";
    let right = folder.read(path);
    let line = right
        .lines()
        .position(|line| line == "  - gateway")
        .unwrap()
        + 1;
    let place = format!("{path}:{line}:5");
    for (what, instead, parts) in [
        (
            "eds: TECO_510_CAN.eds",
            "eds: missing.eds",
            ["cannot be read", "missing.eds"],
        ),
        (
            "companion: teco-inverter",
            "companion: teco",
            ["no companion", "\"teco-inverter\"?"],
        ),
        (
            "  inverter:",
            "  invertor:",
            ["no port \"invertor\"", "\"inverter\"?"],
        ),
        (
            "{serial: 19200, parity: none, stop-bits: 1, companion: teco-inverter}",
            "{can: 500 kbit/s}",
            ["the port \"inverter\" is a serial port", path],
        ),
        (
            "device: teco-jn5-cm-can",
            "device: teco-jn5",
            ["no reference device", "\"teco-jn5-cm-can\"?"],
        ),
        (
            "  - gateway",
            "  - gatway",
            ["unknown word `gatway`", place.as_str()],
        ),
    ] {
        assert!(right.contains(what), "{what}");
        folder.write(path, right.replacen(what, instead, 1));
        refused(&folder, &["run", path], &parts);
    }
}

#[test]
fn empty_name_is_an_error() {
    refused(
        &Folder::new(),
        &["run", ""],
        &["the name of a suite is empty"],
    );
}

#[test]
fn seed_below_zero_is_an_error() {
    let ran = Folder::new().run(&["run", "--seed", "-1"]);
    assert_eq!(ran.exit(), Some(2));
    assert!(ran.error().contains("invalid value '-1' for '--seed <N>'"));
}
