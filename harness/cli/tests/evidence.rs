//! Whatever happens to a run, what it saw is kept; and every report is made of that.

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::process::Stdio;

use fieldproof_record::{Entry, Event};
use quick_junit::Report;
use support::{Folder, suite};

const READ: &str = "sdo-read: {object: \"1000:00\", as: u32}";
const ROWS: usize = 50_000;

/// A folder with a suite that takes a while.
fn long_suite() -> Folder {
    let folder = Folder::new();
    let rows: String = (0..ROWS).map(|n| format!("      - {{n: {n}}}\n")).collect();
    let text = suite("a", READ).replace("    steps:", &format!("    each:\n{rows}    steps:"));
    folder.write("a.yaml", text);
    folder
}

#[test]
fn killed_run_leaves_every_finished_case() {
    let folder = long_suite();
    let mut child = folder
        .command(&["run", "a.yaml", "--device", "kinco-servo", "--verbose"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut out = BufReader::new(child.stdout.take().unwrap());
    let mut shown = String::new();
    while shown.lines().count() < 500 {
        out.read_line(&mut shown).unwrap();
    }
    // SIGKILL: it has no chance to tidy up.
    child.kill().unwrap();
    out.read_to_string(&mut shown).unwrap();
    child.wait().unwrap();
    assert!(!folder.files().contains(&"reports/junit.xml".to_owned()));

    let ran = folder.run(&["report"]);
    assert_eq!(ran.exit(), Some(3), "{}", ran.error());
    assert!(
        ran.out().contains("kinco-servo did not come to its end"),
        "{}",
        ran.out()
    );
    let (_, entries) = folder.journal();
    let finished: Vec<&str> = entries
        .iter()
        .filter_map(|entry| match entry {
            Entry::Lane(_, Event::CaseFinished(case)) => Some(case.id.as_str()),
            _ => None,
        })
        .collect();
    assert!(finished.len() < ROWS);
    // A case is shown once it is kept.
    let of_case = shown.lines().filter(|line| line.contains("a/read["));
    let told: Vec<&str> = of_case
        .filter_map(|line| line.split_whitespace().last())
        .collect();
    assert!(told.len() >= 500);
    for id in &told {
        assert!(finished.contains(id), "{id} was shown and is not there");
    }
    let junit = Report::deserialize_from_str(&folder.read("reports/junit.xml")).unwrap();
    assert_eq!(junit.errors, 1);
    assert!(junit.tests > finished.len());
    assert!(folder.read("reports/report.tap").contains("Bail out!"));
    let json: serde_json::Value =
        serde_json::from_str(&folder.read("reports/report.json")).unwrap();
    assert!(
        json["incomplete"]
            .as_str()
            .unwrap()
            .contains("did not come to its end")
    );
    assert_eq!(
        json["lanes"][0]["cases"].as_array().unwrap().len(),
        finished.len()
    );
}

#[test]
fn journal_that_cannot_be_begun_is_an_error_before_the_first_frame() {
    let folder = Folder::new();
    let run = || folder.run(&["run", "canopen.nmt", "--device", "kinco-servo"]);
    fs::create_dir(folder.path().join("reports")).unwrap();
    let journal = folder.path().join("reports/run.jsonl");
    std::os::unix::fs::symlink("/dev/full", &journal).unwrap();
    let full = run();
    fs::remove_file(&journal).unwrap();
    fs::create_dir(&journal).unwrap();
    let folder_there = run();
    for (ran, why) in [(full, "No space left"), (folder_there, "Is a directory")] {
        assert_eq!(ran.exit(), Some(3));
        assert!(ran.error().contains(why), "{}", ran.error());
        assert!(ran.error().contains("run.jsonl"), "{}", ran.error());
        assert_eq!(ran.out(), "");
    }
}

#[test]
fn disk_that_is_full_stops_the_run_cleanly() {
    let folder = long_suite();
    fs::create_dir(folder.path().join("reports")).unwrap();
    // A disk of its own, in a name space of its own.
    let ran = folder
        .command_of("unshare", &["--map-root-user", "--mount", "sh", "-c"])
        .arg(concat!(
            "mount -t tmpfs -o size=256k none reports && ",
            "{ \"$0\" run a.yaml --device kinco-servo; echo exit $?; tail -n 1 reports/run.jsonl; }"
        ))
        .arg(env!("CARGO_BIN_EXE_fieldproof"))
        .output()
        .unwrap();
    let (out, error) = (
        String::from_utf8_lossy(&ran.stdout),
        String::from_utf8_lossy(&ran.stderr),
    );
    assert!(out.contains("exit 3"), "{out}{error}");
    assert!(
        out.contains("kinco-servo was stopped: interrupted"),
        "{out}"
    );
    assert!(out.contains("cases were not played"), "{out}");
    assert!(
        error.contains("run.jsonl") && error.contains("No space left"),
        "{error}"
    );
}

#[test]
fn reports_are_made_again_and_are_the_same() {
    let folder = Folder::new();
    let ran = folder.run(&[
        "run",
        "canopen",
        "--device",
        "kinco-servo",
        "--set",
        "operator=A. Smith",
    ]);
    assert_eq!(ran.exit(), Some(0), "{}", ran.error());
    let read = |folder: &Folder| -> Vec<(String, Vec<u8>)> {
        let files = folder.files().into_iter();
        files
            .map(|file| (file.clone(), fs::read(folder.path().join(&file)).unwrap()))
            .collect()
    };
    let first = read(&folder);
    assert!(first.len() > 6);
    for (file, _) in first
        .iter()
        .filter(|(file, _)| !file.ends_with("run.jsonl"))
    {
        fs::remove_file(folder.path().join(file)).unwrap();
    }
    assert_eq!(folder.run(&["report"]).exit(), Some(0));
    assert_eq!(first, read(&folder));
}

#[test]
fn later_change_shows_in_the_manifest() {
    let folder = Folder::new();
    folder.run(&["run", "canopen.nmt", "--device", "kinco-servo"]);
    let check = || {
        let mut command = folder.command_of("sha256sum", &["--check", "--quiet", "SHA256SUMS"]);
        command
            .current_dir(folder.path().join("reports"))
            .output()
            .unwrap()
    };
    assert!(check().status.success());
    let mut files = folder.files();
    files.retain(|file| !file.ends_with("SHA256SUMS"));
    let sums = folder.read("reports/SHA256SUMS");
    for file in files {
        let name = file.strip_prefix("reports/").unwrap();
        assert!(
            sums.contains(&format!("  {name}\n")),
            "{name} is not sealed"
        );
    }
    let junit = folder.read("reports/junit.xml");
    folder.write("reports/junit.xml", junit.replace("testcase", "Testcase"));
    let changed = check();
    assert!(!changed.status.success());
    assert!(String::from_utf8_lossy(&changed.stdout).contains("junit.xml"));
}

#[test]
fn folder_without_a_journal_is_wrong_input() {
    let folder = Folder::new();
    let ran = folder.run(&["report", "nowhere"]);
    assert_eq!(ran.exit(), Some(2));
    assert!(ran.error().contains("nowhere/run.jsonl"), "{}", ran.error());
    folder.write("reports/run.jsonl", "{}\n{}\n");
    let ran = folder.run(&["report"]);
    assert_eq!(ran.exit(), Some(2));
    assert!(
        ran.error().contains("not the start of a run"),
        "{}",
        ran.error()
    );
}

#[test]
fn report_for_programs_keeps_its_schema() {
    let folder = Folder::new();
    let schema = serde_json::from_str(&folder.run(&["schema", "report"]).out()).unwrap();
    let schema = jsonschema::validator_for(&schema).unwrap();
    let fault = ["--fault", "abort-names-another-object"];
    let run = [
        "run",
        "canopen.sdo",
        "--device",
        "kinco-servo",
        "--set",
        "order=4711",
    ];
    for more in [&[][..], &fault] {
        folder.run(&[&run[..], more].concat());
        let report = serde_json::from_str(&folder.read("reports/report.json")).unwrap();
        schema
            .validate(&report)
            .map_err(|error| error.to_string())
            .unwrap();
        assert_eq!(report["run"]["settings"][0]["value"], "4711");
    }
}

#[test]
fn report_that_is_kept_as_an_example_is_sealed_and_can_be_made_again() {
    let example = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reports/example");
    let folder = Folder::new();
    let mut check = folder.command_of("sha256sum", &["--check", "--quiet", "SHA256SUMS"]);
    assert!(check.current_dir(&example).status().unwrap().success());
    folder.write(
        "reports/run.jsonl",
        fs::read(example.join("run.jsonl")).unwrap(),
    );
    let ran = folder.run(&["report"]);
    assert_eq!(ran.exit(), Some(1), "{}", ran.error());
    assert!(ran.out().contains("3 of 22 did not pass"), "{}", ran.out());
}
