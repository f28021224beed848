//! What people read.

#![allow(clippy::unwrap_used)]

mod support;

use std::time::Duration;

use fieldproof_record::{Event, Verdict};
use fieldproof_report::{Console, ConsoleOptions, Ink, summary_text};
use support::{case_finished, case_started, lane};

fn shown(devices: &[&str], options: ConsoleOptions, verdicts: &[Verdict]) -> String {
    let mut console = Console::new(devices, options);
    let mut text = String::new();
    for (index, device) in devices.iter().enumerate() {
        for event in lane(device, verdicts) {
            text.push_str(&console.event(index, &event));
        }
        text.push_str(&console.end(index));
    }
    text.push_str(&summary_text(
        &console.summaries(),
        Duration::from_millis(120),
        options.strict,
        options.ink,
    ));
    text
}

#[test]
fn failing_case_is_shown_in_full() {
    let text = fieldproof_report::case_text(
        &case_started("drive.worked-examples/slide-7"),
        &case_finished("drive.worked-examples/slide-7", Verdict::Fail),
        Ink::Plain,
    );
    assert_golden("failing-case", &text);
}

#[test]
fn run_with_every_verdict() {
    let text = shown(
        &["drive", "other-drive"],
        ConsoleOptions::default(),
        &Verdict::ALL,
    );
    assert_golden("every-verdict", &text);
}

#[test]
fn verbose_run_names_every_case() {
    let options = ConsoleOptions {
        verbose: true,
        ..ConsoleOptions::default()
    };
    let text = shown(
        &["drive"],
        options,
        &[Verdict::Pass, Verdict::Skipped, Verdict::Deviation],
    );
    assert_golden("verbose", &text);
}

#[test]
fn quiet_run_that_passes_is_the_table_alone() {
    let options = ConsoleOptions {
        quiet: true,
        ..ConsoleOptions::default()
    };
    let text = shown(&["drive"], options, &[Verdict::Pass]);
    assert_golden("quiet", &text);
}

#[test]
fn colours_change_nothing_but_colours() {
    let coloured = ConsoleOptions {
        ink: Ink::Coloured,
        ..ConsoleOptions::default()
    };
    let coloured = shown(&["drive"], coloured, &Verdict::ALL);
    let plain = shown(&["drive"], ConsoleOptions::default(), &Verdict::ALL);
    assert_ne!(coloured, plain);
    assert_eq!(without_colours(&coloured), plain);
}

#[test]
fn strict_run_counts_a_deviation_as_trouble() {
    let strict = ConsoleOptions {
        strict: true,
        ..ConsoleOptions::default()
    };
    let text = shown(&["drive"], strict, &[Verdict::Pass, Verdict::Deviation]);
    assert!(text.contains("1 of 2 did not pass"), "{text}");
    let text = shown(
        &["drive"],
        ConsoleOptions::default(),
        &[Verdict::Pass, Verdict::Deviation],
    );
    assert!(text.contains("all passed"), "{text}");
}

#[test]
fn lanes_side_by_side_are_shown_one_after_the_other() {
    let devices = ["drive", "encoder"];
    let one_by_one = shown(&devices, ConsoleOptions::default(), &Verdict::ALL);
    let mut console = Console::new(&devices, ConsoleOptions::default());
    let mut text = String::new();
    let lanes = devices.map(|device| lane(device, &Verdict::ALL));
    for (first, second) in lanes[0].iter().zip(&lanes[1]) {
        // The second lane is always ahead.
        text.push_str(&console.event(1, second));
        text.push_str(&console.event(0, first));
    }
    text.push_str(&console.end(1));
    text.push_str(&console.end(0));
    assert!(one_by_one.starts_with(&text), "{text}");
    assert!(text.contains("encoder"), "{text}");
}

#[test]
fn fault_that_is_switched_on_is_named() {
    let mut console = Console::new(&["drive"], ConsoleOptions::default());
    let Event::LaneStarted(mut start) = support::lane_started("drive") else {
        unreachable!("the first event of a lane");
    };
    start.fault = Some("boot-up-missing".to_owned());
    let text = console.event(0, &Event::LaneStarted(start));
    assert_eq!(text, "drive has the fault boot-up-missing\n");
}

#[test]
fn run_in_which_all_is_skipped_has_not_passed() {
    let text = shown(&["drive"], ConsoleOptions::default(), &[Verdict::Skipped]);
    assert!(text.contains("nothing was played"), "{text}");
    assert!(!text.contains("all passed"), "{text}");
}

#[test]
fn lane_that_breaks_off_is_not_passed() {
    let mut console = Console::new(&["drive"], ConsoleOptions::default());
    for event in lane("drive", &[Verdict::Pass]) {
        if !matches!(event, Event::LaneFinished(_)) {
            console.event(0, &event);
        }
    }
    console.end(0);
    let text = summary_text(&console.summaries(), Duration::ZERO, false, Ink::Plain);
    assert!(text.contains("drive did not come to its end"), "{text}");
    assert!(!text.contains("all passed"), "{text}");
}

/// With `UPDATE_GOLDEN` set, the file is written instead.
fn assert_golden(name: &str, text: &str) {
    let path = format!("{}/tests/golden/{name}.txt", env!("CARGO_MANIFEST_DIR"));
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        std::fs::write(&path, text).unwrap();
    }
    assert_eq!(text, std::fs::read_to_string(&path).unwrap(), "{name}");
}

fn without_colours(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('\u{1b}') {
        plain.push_str(before);
        rest = after.split_once('m').unwrap().1;
    }
    plain + rest
}
