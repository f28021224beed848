//! A hundred thousand cases, half of them failing, fit into little memory. In a process of its own, for its peak is
//! measured.

#![cfg(target_os = "linux")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod support;

use fieldproof_record::Verdict;
use fieldproof_report::junit::{JunitLane, assemble};
use fieldproof_report::{Console, ConsoleOptions};
use support::{case, lane_started, suite_started};

const CASES: u32 = 100_000;
const LIMIT_KIB: u64 = 100 * 1024;

#[test]
fn hundred_thousand_cases_stay_small() {
    let mut console = Console::new(&["drive"], ConsoleOptions::default());
    let mut junit = JunitLane::new(std::io::sink(), false);
    for event in [lane_started("drive"), suite_started("drive.many")] {
        console.event(0, &event);
        junit.event(&event);
    }
    for index in 0..CASES {
        let verdict = if index % 2 == 0 {
            Verdict::Pass
        } else {
            Verdict::Fail
        };
        for event in case(&format!("drive.many/case[index={index}]"), verdict) {
            // Shown, and gone.
            console.event(0, &event);
            junit.event(&event);
        }
    }
    console.end(0);
    let (_, heads) = junit.finish().unwrap();
    assemble(std::io::sink(), [(heads, std::io::empty())]).unwrap();
    assert_eq!(console.summaries()[0].counts.total(), CASES);
    let peak = peak_kib();
    assert!(peak < LIMIT_KIB, "{peak} KiB");
    println!("peak: {peak} KiB");
}

fn peak_kib() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status
        .lines()
        .find(|line| line.starts_with("VmHWM:"))
        .unwrap();
    line.split_whitespace().nth(1).unwrap().parse().unwrap()
}
