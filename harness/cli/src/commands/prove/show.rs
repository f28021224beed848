//! The outcome of `prove` for people.

use std::fmt::Write;

use fieldproof_record::Verdict;

use super::{Finding, Guise, Proof};
use crate::screen::INK;

/// So many cases are named on a line, and the others counted.
const NAMED: usize = 3;

pub(super) fn text(proof: &Proof) -> String {
    let mut text = String::new();
    let mut device = "";
    for finding in &proof.rounds {
        if finding.device != device {
            let gap = if device.is_empty() { "" } else { "\n" };
            device = &finding.device;
            say(&mut text, format_args!("{gap}{device}\n"));
        }
        round(&mut text, finding);
    }
    let faults = proof
        .rounds
        .iter()
        .filter(|it| matches!(it.guise, Guise::Fault(_)))
        .count();
    let caught = faults - proof.uncaught.len();
    say(
        &mut text,
        format_args!("\n{caught} of {faults} faults are caught\n"),
    );
    if !proof.uncaught.is_empty() {
        text.push_str("\nfaults that nothing catches:\n");
        for (device, fault) in &proof.uncaught {
            say(&mut text, format_args!("  {device}  {fault}\n"));
        }
    }
    if !proof.idle_cases.is_empty() {
        let count = proof.idle_cases.len();
        say(
            &mut text,
            format_args!("\ncases that catch no fault ({count}, for information):\n"),
        );
        for case in &proof.idle_cases {
            say(&mut text, format_args!("  {case}\n"));
        }
    }
    let last = match proof.holds {
        true => paint(
            Verdict::Pass,
            "every fault is caught, and everything else passes",
        ),
        false => paint(Verdict::Fail, "the suites are not proven"),
    };
    say(&mut text, format_args!("\n{last}\n"));
    text
}

fn round(text: &mut String, finding: &Finding) {
    let (name, is_fault) = match &finding.guise {
        Guise::AsItIs => ("as it is".to_owned(), false),
        Guise::Variant(name) => (format!("variant {name}"), false),
        Guise::Fault(name) => (format!("fault {name}"), true),
    };
    let mut parts = Vec::new();
    if is_fault {
        match finding.failed.is_empty() {
            true => parts.push(paint(Verdict::Fail, "caught by nothing")),
            false => parts.push(paint(
                Verdict::Pass,
                format!("caught by {}", named(&finding.failed)),
            )),
        }
    } else if finding.passes() {
        parts.push(paint(
            Verdict::Pass,
            format!("{} cases, nothing wrong", finding.cases),
        ));
    } else if !finding.failed.is_empty() {
        parts.push(paint(
            Verdict::Fail,
            format!("fail: {}", named(&finding.failed)),
        ));
    }
    for (verdict, cases) in [
        (Verdict::Inconclusive, &finding.inconclusive),
        (Verdict::Error, &finding.error),
    ] {
        if !cases.is_empty() {
            parts.push(paint(verdict, format!("{verdict}: {}", named(cases))));
        }
    }
    if let Some(first) = finding.stops.first() {
        let times = finding.stops.len();
        parts.push(format!("fresh devices taken: {times} ({first})"));
    }
    let mut parts = parts.into_iter();
    let first = parts.next().unwrap_or_default();
    say(text, format_args!("  {name:<36}  {first}\n"));
    for part in parts {
        say(text, format_args!("  {:<36}  {part}\n", ""));
    }
}

fn named(cases: &[String]) -> String {
    let mut names = cases
        .iter()
        .take(NAMED)
        .cloned()
        .collect::<Vec<_>>()
        .join(", ");
    if cases.len() > NAMED {
        say(
            &mut names,
            format_args!(" and {} more", cases.len() - NAMED),
        );
    }
    names
}

fn paint(verdict: Verdict, words: impl std::fmt::Display) -> String {
    INK.verdict(verdict, words)
}

fn say(text: &mut String, words: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = text.write_fmt(words);
}
