//! A comparison on the terminal.

use std::fmt::Write;

use fieldproof_record::Verdict;

use super::{Change, Comparison, DeviceComparison, MovedSeries};
use crate::html::{percent, time};
use crate::ink::Ink;

/// The comparison in lines.
pub fn comparison_text(comparison: &Comparison, ink: Ink) -> String {
    let mut text = String::new();
    for (word, run) in [("old", &comparison.old), ("new", &comparison.new)] {
        let incomplete = if run.complete { "" } else { ", incomplete" };
        say(
            &mut text,
            format_args!("{word}  {}  {}{incomplete}\n", run.path, run.started),
        );
    }
    for device in &comparison.devices {
        text.push_str(&device_text(device, ink));
    }
    if !comparison.waivers.is_empty() {
        text.push_str("\nwaivers:\n");
        for line in &comparison.waivers {
            say(&mut text, format_args!("  {line}\n"));
        }
    }
    let words = match (comparison.regressed, comparison.waiver_expired) {
        (true, _) => ink.verdict(Verdict::Fail, "worse than before"),
        (false, true) => ink.verdict(Verdict::Fail, "a waiver has expired"),
        (false, false) => ink.verdict(Verdict::Pass, "no worse than before"),
    };
    say(&mut text, format_args!("\n{words}\n"));
    text
}

fn device_text(device: &DeviceComparison, ink: Ink) -> String {
    let mut text = String::new();
    let firmware = |it: &Option<String>| it.clone().unwrap_or_else(|| "unknown".to_owned());
    say(
        &mut text,
        format_args!(
            "\n{}  firmware {} -> {}\n",
            ink.bold(&device.device),
            firmware(&device.old_firmware),
            firmware(&device.new_firmware)
        ),
    );
    for (heading, changes, verdict) in lists(device) {
        if changes.is_empty() {
            continue;
        }
        let number = format!("{:>7}", changes.len());
        say(
            &mut text,
            format_args!("{} {heading}\n", ink.verdict(verdict, number)),
        );
        for change in changes {
            text.push_str(&change_text(change));
        }
    }
    say(&mut text, format_args!("{:>7} the same\n", device.same));
    for series in &device.moved {
        let worse = if series.change > 0.0 {
            Verdict::Inconclusive
        } else {
            Verdict::Pass
        };
        say(
            &mut text,
            format_args!("  moved  {}\n", ink.verdict(worse, series_text(series))),
        );
    }
    text
}

/// The lists of a device in the order that they matter.
pub(super) fn lists(device: &DeviceComparison) -> [(&'static str, &[Change], Verdict); 6] {
    [
        ("newly failing", &device.newly_failing, Verdict::Fail),
        (
            "still failing",
            &device.still_failing,
            Verdict::Inconclusive,
        ),
        ("fixed", &device.fixed, Verdict::Pass),
        ("new", &device.new, Verdict::Deviation),
        (
            "gone or not played any more",
            &device.gone,
            Verdict::Skipped,
        ),
        ("otherwise changed", &device.otherwise, Verdict::Deviation),
    ]
}

fn change_text(change: &Change) -> String {
    let word = |verdict: Option<Verdict>| verdict.map_or("-", Verdict::name);
    let mut text = format!(
        "         {}  {} -> {}\n",
        change.id,
        word(change.old),
        word(change.new)
    );
    if !change.what.is_empty() {
        say(&mut text, format_args!("           {}\n", change.what));
    }
    if let Some(why) = &change.waived {
        say(&mut text, format_args!("           accepted: {why}\n"));
    }
    text
}

fn series_text(series: &MovedSeries) -> String {
    let direction = if series.change > 0.0 { "more" } else { "less" };
    let mut text = format!(
        "{}: {} -> {} ({} {direction} in {} cases, p = {:.1e})",
        series.name,
        time(series.old_median_ns),
        time(series.new_median_ns),
        percent(series.change.abs()),
        series.cases,
        series.p
    );
    if let (Some(old), Some(new)) = series.of_limit {
        say(
            &mut text,
            format_args!("; {} -> {} of the limit", percent(old), percent(new)),
        );
    }
    text
}

fn say(text: &mut String, words: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = text.write_fmt(words);
}
