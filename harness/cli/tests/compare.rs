//! Two runs side by side.

#![allow(clippy::unwrap_used)]

mod support;

use serde_json::Value;
use support::{Folder, Ran};

/// Runs of one device into `old` and `new`, each with what is added.
fn runs(old: &[&str], new: &[&str]) -> Folder {
    let folder = Folder::new();
    for (reports, more) in [("old", old), ("new", new)] {
        let arguments = ["run", "canopen.sdo", "--device", "kinco-servo", "--quiet"];
        let ran = folder.run(&[&arguments[..], &["--reports", reports], more].concat());
        assert!(matches!(ran.exit(), Some(0 | 1)), "{}", ran.error());
    }
    folder
}

const FAULT: [&str; 2] = ["--fault", "abort-names-another-object"];
const ONE: [&str; 2] = ["--case", "canopen.sdo-segmented/unknown-object"];

fn compare(folder: &Folder, more: &[&str]) -> Ran {
    folder.run(&[&["compare", "old", "new"], more].concat())
}

fn as_json(folder: &Folder, more: &[&str]) -> Value {
    let ran = compare(folder, &[&["--format", "json"], more].concat());
    serde_json::from_str(&ran.out()).unwrap()
}

#[test]
fn another_seed_of_the_same_device_is_no_worse_and_nothing_has_moved() {
    for seed in ["2", "3", "4"] {
        let folder = runs(&[], &["--seed", seed]);
        let ran = compare(&folder, &["--fail-on-slower"]);
        assert_eq!(ran.exit(), Some(0), "{}", ran.out());
        assert!(ran.out().contains("no worse than before"), "{}", ran.out());
        let device = &as_json(&folder, &[])["devices"][0];
        assert_eq!(device["moved"], Value::Array(Vec::new()));
        assert!(!device["steady"].as_array().unwrap().is_empty());
    }
}

#[test]
fn case_that_fails_now_is_a_regression_and_one_that_failed_is_fixed() {
    let folder = runs(&ONE, &[&ONE[..], &FAULT].concat());
    let ran = compare(&folder, &[]);
    assert_eq!(ran.exit(), Some(1), "{}", ran.out());
    assert!(ran.out().contains("1 newly failing"), "{}", ran.out());
    assert!(
        ran.out().contains("another frame came than expected"),
        "{}",
        ran.out()
    );
    assert!(ran.out().contains("worse than before"), "{}", ran.out());
    let back = folder.run(&["compare", "new/run.jsonl", "old"]);
    assert_eq!(back.exit(), Some(0), "{}", back.out());
    assert!(back.out().contains("1 fixed"), "{}", back.out());
    let same = folder.run(&["compare", "new", "new"]);
    assert_eq!(same.exit(), Some(0), "{}", same.out());
    assert!(same.out().contains("1 still failing"), "{}", same.out());
}

#[test]
fn cases_of_one_run_alone_are_new_or_gone() {
    let folder = runs(&ONE, &["--case", "canopen.sdo-segmented/*"]);
    let device = as_json(&folder, &[])["devices"][0].clone();
    assert!(device["new"].as_array().unwrap().len() > 5);
    assert_eq!(device["same"], 1);
    let ran = folder.run(&["compare", "new", "old"]);
    assert!(
        ran.out().contains("gone or not played any more"),
        "{}",
        ran.out()
    );
}

fn waiver(expires: &str) -> String {
    format!(
        "language: 1\nwaivers:\n  - case: \"canopen.sdo-segmented/unknown-*\"\n    device: kinco-servo\n    reason: known, mended in V2.1\n    expires: {expires}\n"
    )
}

#[test]
fn accepted_failure_is_no_regression_until_it_expires() {
    let folder = runs(&ONE, &[&ONE[..], &FAULT].concat());
    folder.write("waivers.yaml", waiver("2999-12-31"));
    let ran = compare(&folder, &["--waivers", "waivers.yaml"]);
    assert_eq!(ran.exit(), Some(0), "{}{}", ran.out(), ran.error());
    assert!(
        ran.out().contains("accepted: known, mended in V2.1"),
        "{}",
        ran.out()
    );
    folder.write("waivers.yaml", waiver("2020-01-01"));
    let ran = compare(&folder, &["--waivers", "waivers.yaml"]);
    assert_eq!(ran.exit(), Some(1), "{}", ran.out());
    assert!(ran.out().contains("expired on 2020-01-01"), "{}", ran.out());
    // What is known to fail fails the comparison as well, once nobody accepts it any more.
    let ran = folder.run(&["compare", "new", "new", "--waivers", "waivers.yaml"]);
    assert_eq!(ran.exit(), Some(1), "{}", ran.out());
}

#[test]
fn waiver_that_is_not_needed_is_reported() {
    let folder = runs(&ONE, &ONE);
    folder.write("waivers.yaml", waiver("2999-12-31"));
    let ran = compare(&folder, &["--waivers", "waivers.yaml"]);
    assert_eq!(ran.exit(), Some(0), "{}", ran.out());
    assert!(ran.out().contains("passes now"), "{}", ran.out());
    folder.write(
        "waivers.yaml",
        waiver("2999-12-31").replace("unknown-", "never-"),
    );
    let ran = compare(&folder, &["--waivers", "waivers.yaml"]);
    assert!(ran.out().contains("there is no such case"), "{}", ran.out());
}

#[test]
fn waiver_with_a_mistake_is_shown_with_its_place() {
    let folder = runs(&ONE, &ONE);
    for (text, message) in [
        (waiver("2027-02-30"), "is no day"),
        (waiver("2027-02-28").replace("reason", "why"), "why"),
    ] {
        folder.write("waivers.yaml", text);
        let ran = compare(&folder, &["--waivers", "waivers.yaml"]);
        assert_eq!(ran.exit(), Some(2));
        assert!(ran.error().contains("waivers.yaml:"), "{}", ran.error());
        assert!(ran.error().contains(message), "{}", ran.error());
    }
}

#[test]
fn comparison_keeps_its_schema_and_is_a_page() {
    let folder = runs(&ONE, &[&ONE[..], &FAULT].concat());
    let schema = serde_json::from_str(&folder.run(&["schema", "comparison"]).out()).unwrap();
    let schema = jsonschema::validator_for(&schema).unwrap();
    let comparison = as_json(&folder, &[]);
    schema
        .validate(&comparison)
        .map_err(|error| error.to_string())
        .unwrap();
    let page = compare(&folder, &["--format", "html"]).out();
    assert!(page.starts_with("<!DOCTYPE html>") && page.contains("newly failing"));
    assert!(!page.contains("http"), "nothing from outside");
}

#[test]
fn slower_firmware_shows_before_a_limit_breaks() {
    let folder = runs(&["--case", "canopen.sdo-*"], &["--case", "canopen.sdo-*"]);
    // Every answer takes a quarter more than it did.
    let journal = folder.read("new/run.jsonl");
    let slower: String = journal
        .lines()
        .map(|line| {
            let mut entry: Value = serde_json::from_str(line).unwrap();
            if entry["event"] == "measurement" {
                let value = entry["value_ns"].as_u64().unwrap();
                entry["value_ns"] = (value + value / 4).into();
                // The lane's number stands first.
                let text = entry.to_string();
                return format!("{text}\n");
            }
            format!("{line}\n")
        })
        .collect();
    folder.write("new/run.jsonl", slower);
    let ran = compare(&folder, &[]);
    assert_eq!(ran.exit(), Some(0), "{}{}", ran.out(), ran.error());
    assert!(
        ran.out().contains("moved  SDO response time"),
        "{}",
        ran.out()
    );
    assert!(ran.out().contains("25 % more"), "{}", ran.out());
    assert_eq!(compare(&folder, &["--fail-on-slower"]).exit(), Some(1));
}
