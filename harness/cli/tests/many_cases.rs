//! A hundred thousand cases in one suite, played with all reports in 200 MB of memory.

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod support;

use std::process::Command;
use std::time::Instant;

use quick_junit::Report;
use support::{Folder, suite};

const CASES: usize = 100_000;
/// 200 MB, as `ulimit -d` counts: all memory that the process can write to, its stacks included.
const LIMIT_KIB: usize = 195_312;

#[test]
fn hundred_thousand_cases_stay_below_200_megabytes() {
    let folder = Folder::new();
    let rows: String = (0..CASES)
        .map(|n| format!("      - {{n: {n}}}\n"))
        .collect();
    let text = suite("a", "sdo-read: {object: \"1000:00\", as: u32}")
        .replace("    steps:", &format!("    each:\n{rows}    steps:"));
    folder.write("a.yaml", text);
    let program = env!("CARGO_BIN_EXE_fieldproof");
    let ran = Command::new("sh")
        .arg("-c")
        .arg(format!(
            "ulimit -d {LIMIT_KIB} && exec \"$0\" run a.yaml --device kinco-servo --quiet"
        ))
        .arg(program)
        .current_dir(folder.path())
        .output()
        .unwrap();
    let error = String::from_utf8_lossy(&ran.stderr);
    assert_eq!(ran.status.code(), Some(0), "{error}");
    let report = Report::deserialize_from_str(&folder.read("reports/junit.xml")).unwrap();
    assert_eq!(report.tests, CASES);
    let started = Instant::now();
    let made = Command::new("sh")
        .arg("-c")
        .arg(format!("ulimit -d {LIMIT_KIB} && exec \"$0\" report"))
        .arg(program)
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert_eq!(made.status.code(), Some(0));
    println!("all reports were made in {:.1?}", started.elapsed());
    let page = folder.read("reports/report.html");
    assert!(page.len() < 5_000_000, "{} bytes", page.len());
}

#[test]
fn the_limit_is_one() {
    let folder = Folder::new();
    let program = env!("CARGO_BIN_EXE_fieldproof");
    let ran = Command::new("sh")
        .arg("-c")
        .arg("ulimit -d 1000 && exec \"$0\" run --quiet")
        .arg(program)
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert_ne!(ran.status.code(), Some(0));
}
