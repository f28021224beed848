//! Runs from end to end: what is written, what is repeated, what is interrupted.

#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use fieldproof_record::{Entry, Event};
use quick_junit::Report;
use support::{Folder, suite};

const READ: &str = "sdo-read: {object: \"1000:00\", as: u32}";

#[test]
fn everything_passes_on_every_device() {
    let folder = Folder::new();
    let ran = folder.run(&["run", "--format", "json"]);
    assert_eq!(ran.exit(), Some(0), "{}", ran.error());
    let outcome: serde_json::Value = serde_json::from_str(&ran.out()).unwrap();
    let report = Report::deserialize_from_str(&folder.read("reports/junit.xml")).unwrap();
    let lanes = outcome["lanes"].as_array().unwrap();
    assert_eq!(lanes.len(), fieldproof_devices::kinds().len());
    let count = |verdict: &str| -> u64 {
        lanes
            .iter()
            .map(|lane| lane["counts"][verdict].as_u64().unwrap())
            .sum()
    };
    assert_eq!(report.skipped as u64, count("skipped"));
    assert_eq!((report.failures, report.errors), (0, 0));
    assert!(count("pass") > 100);
    let (start, entries) = folder.journal();
    for (index, lane) in lanes.iter().enumerate() {
        assert_eq!(start.lanes[index].device, lane["device"]);
        let of_lane =
            |entry: &&Entry| matches!(entry, Entry::Lane(lane, _) if *lane == index as u32);
        let last = entries.iter().rfind(of_lane);
        assert!(matches!(last, Some(Entry::Lane(_, Event::LaneFinished(_)))));
    }
    assert!(matches!(entries.last(), Some(Entry::RunFinished(_))));
}

#[test]
fn same_seed_gives_the_same_bytes() {
    let run = |seed: &str| -> Vec<(String, Vec<u8>)> {
        let folder = Folder::new();
        let mut command = folder.command(&["run", "--seed", seed, "--quiet"]);
        let ran = command.env("SOURCE_DATE_EPOCH", "1000000000").output();
        assert_eq!(ran.unwrap().status.code(), Some(0));
        // Lanes write to the journal as they come; what is made of it is in their order.
        let files = folder.files().into_iter();
        let made =
            files.filter(|file| !file.ends_with("run.jsonl") && !file.ends_with("SHA256SUMS"));
        let bytes = |file: String| {
            let bytes = std::fs::read(folder.path().join(&file));
            (file, bytes.unwrap())
        };
        made.map(bytes).collect()
    };
    let first = run("7");
    assert!(first.len() > 10);
    // Not `assert_eq`, which would print all of it.
    assert!(first == run("7"));
    assert!(first != run("8"));
}

#[test]
fn exported_suites_are_the_embedded_ones() {
    let folder = Folder::new();
    assert_eq!(folder.run(&["export", "mine"]).exit(), Some(0));
    let cases = |arguments: &[&str]| -> Vec<String> {
        let ran = folder.run(arguments);
        assert_eq!(ran.exit(), Some(0), "{}", ran.error());
        let listed: serde_json::Value = serde_json::from_str(&ran.out()).unwrap();
        let ids = listed
            .as_array()
            .unwrap()
            .iter()
            .map(|case| case["id"].to_string());
        let mut ids: Vec<String> = ids.collect();
        ids.sort();
        ids
    };
    assert_eq!(
        cases(&["list", "--format", "json"]),
        cases(&["list", "mine", "--format", "json"])
    );
    let ran = folder.run(&["run", "mine", "--quiet"]);
    assert_eq!(ran.exit(), Some(0), "{}{}", ran.out(), ran.error());
}

#[test]
fn export_overwrites_only_when_forced() {
    let folder = Folder::new();
    folder.write("mine/suites/canopen/nmt.yaml", "mine");
    let refused = folder.run(&["export", "mine"]);
    assert_eq!(refused.exit(), Some(2));
    assert!(refused.error().contains("nmt.yaml"), "{}", refused.error());
    assert_eq!(folder.files(), ["mine/suites/canopen/nmt.yaml"]);
    assert_eq!(folder.run(&["export", "mine", "--force"]).exit(), Some(0));
    assert!(
        folder
            .read("mine/suites/canopen/nmt.yaml")
            .contains("canopen.nmt")
    );
}

#[test]
fn description_of_the_user_takes_the_place_of_ours() {
    let folder = Folder::new();
    assert_eq!(folder.run(&["export", "mine"]).exit(), Some(0));
    let path = "mine/devices/kinco-servo/device.yaml";
    folder.write(path, folder.read(path).replace("  - sdo-server\n", ""));
    folder.write(
        "a.yaml",
        suite("a", READ).replace("    steps:", "    needs: [sdo-server]\n    steps:"),
    );
    let ran = folder.run(&["run", "a.yaml", path, "--device", "kinco-servo"]);
    assert!(
        ran.out().contains("the device does not claim sdo-server"),
        "{}",
        ran.out()
    );
    assert_eq!(ran.exit(), Some(2));
}

#[test]
fn strict_run_fails_on_a_documented_deviation() {
    let folder = Folder::new();
    let case = "kinco-servo.sdo/download-response-reserved-bytes";
    let arguments = ["run", "--case", case, "--device", "kinco-servo"];
    let ran = folder.run(&arguments);
    assert_eq!(ran.exit(), Some(0), "{}", ran.out());
    assert!(
        ran.out().contains("deviate as their manual documents"),
        "{}",
        ran.out()
    );
    let strict = folder.run(&[arguments.as_slice(), &["--strict"]].concat());
    assert_eq!(strict.exit(), Some(1), "{}", strict.out());
    let report = Report::deserialize_from_str(&folder.read("reports/junit.xml")).unwrap();
    assert_eq!(report.failures, 1);
}

#[test]
fn reports_that_are_there_are_replaced_and_others_left_alone() {
    let folder = Folder::new();
    folder.write("a.yaml", suite("a", READ));
    folder.write("reports/junit.xml", "old");
    folder.write("reports/notes.txt", "mine");
    assert_eq!(
        folder
            .run(&["run", "a.yaml", "--device", "kinco-servo"])
            .exit(),
        Some(0)
    );
    assert!(folder.read("reports/junit.xml").starts_with("<?xml"));
    let files = folder.files();
    let reports: Vec<&String> = files
        .iter()
        .filter(|file| file.starts_with("reports"))
        .collect();
    assert_eq!(
        reports,
        [
            "reports/SHA256SUMS",
            "reports/junit.xml",
            "reports/notes.txt",
            "reports/report.html",
            "reports/report.json",
            "reports/report.tap",
            "reports/run.jsonl",
            "reports/traffic/kinco-servo.log",
            "reports/traffic/kinco-servo.pcapng",
        ]
    );
}

#[test]
fn proof_holds_for_a_fault_that_is_caught() {
    let folder = Folder::new();
    let arguments = [
        "prove",
        "modbus.crc",
        "--device",
        "liaomiao-encoder",
        "--fault",
        "stale-crc-accepted",
    ];
    let ran = folder.run(&arguments);
    assert_eq!(ran.exit(), Some(0), "{}", ran.out());
    assert!(
        ran.out().contains("1 of 1 faults are caught"),
        "{}",
        ran.out()
    );
    let ran = folder.run(&[arguments.as_slice(), &["--format", "json"]].concat());
    let proof: serde_json::Value = serde_json::from_str(&ran.out()).unwrap();
    assert_eq!(proof["holds"], true);
    let caught = proof["rounds"].as_array().unwrap().last().unwrap();
    assert_eq!(caught["guise"]["name"], "stale-crc-accepted");
    assert!(
        caught["failed"].get("modbus.crc/spoilt-bit").is_some(),
        "{caught:?}"
    );
    assert_eq!(folder.files(), Vec::<String>::new());
}

#[test]
fn proof_fails_for_a_fault_that_nothing_catches() {
    let folder = Folder::new();
    folder.write("a.yaml", suite("a", READ));
    let arguments = [
        "prove",
        "a.yaml",
        "--device",
        "liaomiao-encoder",
        "--fault",
        "stale-crc-accepted",
    ];
    let ran = folder.run(&arguments);
    assert_eq!(ran.exit(), Some(1), "{}", ran.out());
    for part in ["0 of 1 faults are caught", "nothing catches it"] {
        assert!(ran.out().contains(part), "{}", ran.out());
    }
}

#[test]
fn proof_fails_if_a_device_without_fault_does_not_pass() {
    let folder = Folder::new();
    let wrong = READ.replace("as: u32", "as: u32, expect: 5");
    folder.write("a.yaml", suite("a", &wrong));
    let ran = folder.run(&[
        "prove",
        "a.yaml",
        "--device",
        "kinco-servo",
        "--fault",
        "boot-up-missing",
    ]);
    assert_eq!(ran.exit(), Some(1), "{}", ran.out());
    assert!(ran.out().contains("fail: a/read"), "{}", ran.out());
    // It fails without the fault too, so it has not caught it.
    assert!(
        ran.out().contains("0 of 1 faults are caught"),
        "{}",
        ran.out()
    );
}

#[test]
fn devices_and_faults_are_listed_as_data() {
    let folder = Folder::new();
    let list = |command: &str| -> Vec<serde_json::Value> {
        let ran = folder.run(&[command, "--format", "json"]);
        assert_eq!(ran.exit(), Some(0));
        serde_json::from_str(&ran.out()).unwrap()
    };
    let kinds = fieldproof_devices::kinds();
    assert_eq!(list("devices").len(), kinds.len());
    let faults = list("faults");
    assert_eq!(
        faults.len(),
        kinds
            .iter()
            .map(|kind| kind.faults().count())
            .sum::<usize>()
    );
    assert!(
        faults
            .iter()
            .all(|fault| fault["breaks"].as_str().is_some_and(|it| !it.is_empty()))
    );
    let text = folder.run(&["faults"]).out();
    assert!(kinds.iter().all(|kind| text.contains(kind.name)), "{text}");
}

#[test]
fn schemas_are_printed() {
    let folder = Folder::new();
    for kind in ["suite", "device", "journal"] {
        let ran = folder.run(&["schema", kind]);
        assert_eq!(ran.exit(), Some(0));
        let schema: serde_json::Value = serde_json::from_str(&ran.out()).unwrap();
        assert!(
            schema["$schema"].as_str().unwrap().contains("2020-12"),
            "{kind}"
        );
    }
}

#[cfg(unix)]
#[test]
fn interrupted_run_writes_what_it_has() {
    use std::io::{BufRead, BufReader, Read};
    use std::process::{Command, Stdio};

    let folder = Folder::new();
    // Enough to be played for longer than it takes to interrupt it.
    let rows: String = (0..50_000)
        .map(|n| format!("      - {{n: {n}}}\n"))
        .collect();
    let text = suite("a", READ).replace("    steps:", &format!("    each:\n{rows}    steps:"));
    folder.write("a.yaml", text);
    let mut child = folder
        .command(&["run", "a.yaml", "--device", "kinco-servo", "--verbose"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut out = BufReader::new(child.stdout.take().unwrap());
    let mut line = String::new();
    out.read_line(&mut line).unwrap();
    let killed = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(killed.success());
    let mut rest = String::new();
    out.read_to_string(&mut rest).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(3), "{rest}");
    assert!(
        rest.contains("kinco-servo was stopped: interrupted"),
        "{rest}"
    );
    let (_, entries) = folder.journal();
    let [.., Entry::Lane(0, Event::LaneFinished(end)), _] = entries.as_slice() else {
        panic!("the journal has no end");
    };
    assert_eq!(end.stopped.as_deref(), Some("interrupted"));
    let report = Report::deserialize_from_str(&folder.read("reports/junit.xml")).unwrap();
    // One more says that it did not come to its end.
    assert_eq!(report.tests as u64, u64::from(end.counts.total()) + 1);
    // A case that was being played is broken off, and undecided.
    let broken_off = u64::from(end.counts.inconclusive);
    assert_eq!(report.errors as u64, broken_off + 1);
    assert!(broken_off <= 1);
    assert!(report.tests < 50_000);
    let tap = folder.read("reports/report.tap");
    assert!(tap.contains("Bail out! kinco-servo was stopped"), "{tap}");
}

#[test]
fn lane_that_stops_says_how_much_it_left_out() {
    let folder = Folder::new();
    let arguments = [
        "run",
        "canopen.error-control",
        "--device",
        "kinco-servo",
        "--fault",
        "download-ack-missing",
    ];
    let ran = folder.run(&arguments);
    assert_eq!(ran.exit(), Some(3), "{}", ran.error());
    assert!(ran.out().contains("cases were not played"), "{}", ran.out());
    let ran = folder.run(&[&arguments[..], &["--format", "json"]].concat());
    let outcome: serde_json::Value = serde_json::from_str(&ran.out()).unwrap();
    let counts = outcome["lanes"][0]["counts"].as_object().unwrap();
    let played: u64 = counts.values().map(|count| count.as_u64().unwrap()).sum();
    let cases = folder.run(&["list", "canopen.error-control", "--format", "json"]);
    let cases: Vec<serde_json::Value> = serde_json::from_str(&cases.out()).unwrap();
    let left_out = outcome["not_played"].as_u64().unwrap();
    assert_eq!(played + left_out, cases.len() as u64);
    assert!(left_out > 0);
}

#[test]
fn report_that_cannot_be_replaced_is_an_error_before_the_first_frame() {
    let folder = Folder::new();
    std::fs::create_dir_all(folder.path().join("reports/junit.xml")).unwrap();
    let ran = folder.run(&["run", "canopen.sdo", "--device", "kinco-servo"]);
    assert_eq!(ran.exit(), Some(3));
    assert_eq!(ran.out(), "");
    assert!(ran.error().contains("junit.xml"), "{}", ran.error());
}

#[cfg(target_os = "linux")]
#[test]
fn output_to_a_full_disk_is_an_error() {
    let folder = Folder::new();
    for arguments in [
        ["list"].as_slice(),
        &["schema"],
        &["faults", "--format", "json"],
    ] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full");
        let mut command = folder.command(arguments);
        let ran = command.stdout(full.unwrap()).output().unwrap();
        assert_eq!(ran.status.code(), Some(3), "{arguments:?}");
        let error = String::from_utf8(ran.stderr).unwrap();
        assert!(error.contains("cannot be written"), "{error}");
    }
}
