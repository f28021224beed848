//! The outcome of `prove` for people.

use std::fmt::Write;

use fieldproof_record::Verdict;

use super::judge::{Figures, Finding, Proof, Wrong};
use super::rounds::Guise;
use crate::screen::INK;

/// So many cases or faults are named on a line, and the others counted.
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
    if proof.whole {
        text.push_str("\ncases, and the faults that they catch\n");
        for (case, faults) in &proof.cases {
            let faults: Vec<String> = faults
                .iter()
                .map(|(device, fault)| format!("{fault} ({device})"))
                .collect();
            let caught = match faults.is_empty() {
                true => paint(Verdict::Fail, "catches nothing"),
                false => format!("{}: {}", faults.len(), named(&faults)),
            };
            say(&mut text, format_args!("  {case}  {caught}\n"));
        }
    }
    wrong_rounds(&mut text, proof);
    if proof.whole && !proof.idle_cases.is_empty() {
        let count = proof.idle_cases.len();
        say(
            &mut text,
            format_args!("\ncases that catch no fault ({count}):\n"),
        );
        for case in &proof.idle_cases {
            say(&mut text, format_args!("  {case}\n"));
        }
    }
    say(
        &mut text,
        format_args!("\n{}\n", figures(&proof.figures, proof.whole)),
    );
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

fn figures(figures: &Figures, whole: bool) -> String {
    let Figures {
        faults,
        caught,
        caught_where_they_belong,
        named,
        cases,
        cases_that_catch,
    } = figures;
    let mut text = format!("{caught} of {faults} faults are caught");
    if whole {
        text.push_str(&format!(
            "; {cases_that_catch} of {cases} cases have caught one"
        ));
    }
    text.push_str(&format!(
        "\n{caught_where_they_belong} by the suites they belong to, {named} of these named in the first line of a failure"
    ));
    text
}

fn wrong_rounds(text: &mut String, proof: &Proof) {
    let wrong = || proof.rounds.iter().filter(|it| it.wrong.is_some());
    if wrong().next().is_none() {
        return;
    }
    text.push_str("\nnot as it must be:\n");
    for finding in wrong() {
        let what = match &finding.wrong {
            None => continue,
            Some(Wrong::CaughtByNothing) => "nothing catches it".to_owned(),
            Some(Wrong::CaughtElsewhere(service)) => {
                let cases: Vec<String> = finding.failed.keys().cloned().collect();
                format!("no case about {service} catches it, only {}", named(&cases))
            }
            Some(Wrong::NotPassed) => "a right device does not pass".to_owned(),
            Some(Wrong::PassedInVain) => {
                format!(
                    "these cases pass without anything to rest on: {}",
                    named(&finding.passed_in_vain)
                )
            }
            Some(Wrong::NotSeen) => "nothing shows it".to_owned(),
            Some(Wrong::Hung) => "it did not end, and was ended".to_owned(),
        };
        say(
            text,
            format_args!("  {}  {}: {what}\n", finding.device, title(&finding.guise)),
        );
    }
}

fn title(guise: &Guise) -> String {
    match guise {
        Guise::AsItIs => "as it is".to_owned(),
        Guise::Variant(name) => format!("variant {name}"),
        Guise::Fault(name) => format!("fault {name}"),
        Guise::Line(name) => format!("line {name}"),
        Guise::Numbers { node, address } => {
            let node = node.map(|node| format!("node {node}"));
            let address = address.map(|address| format!("address {address}"));
            let numbers: Vec<String> = node.into_iter().chain(address).collect();
            numbers.join(", ")
        }
    }
}

fn round(text: &mut String, finding: &Finding) {
    let failed: Vec<String> = finding.failed.keys().cloned().collect();
    let mut parts = Vec::new();
    let right = |is: bool| match is {
        true => Verdict::Pass,
        false => Verdict::Fail,
    };
    let is_right = finding.wrong.is_none();
    match &finding.guise {
        Guise::Fault(_) if failed.is_empty() => {
            parts.push(paint(Verdict::Fail, "caught by nothing"));
        }
        Guise::Fault(_) => parts.push(paint(
            right(is_right),
            format!("caught by {}", named(&failed)),
        )),
        _ if finding.passes() => {
            let words = format!("{} cases, nothing wrong", finding.cases);
            parts.push(paint(right(is_right), words));
        }
        _ if !failed.is_empty() => {
            parts.push(paint(right(is_right), format!("fail: {}", named(&failed))));
        }
        _ => {}
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
    let name = title(&finding.guise);
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
