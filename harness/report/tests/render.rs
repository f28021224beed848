//! A problem as text, at any place in any text.

#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use fieldproof_report::{Also, Elsewhere, Ink, Problem, Severity, SourceText, Span, render};
use proptest::prelude::*;

fn at(line: u32, column: u32, end_column: u32) -> Span {
    Span {
        line,
        column,
        end_column,
    }
}

fn also(at: Span, words: &str) -> Also {
    Also {
        at,
        words: words.to_owned(),
    }
}

fn unknown_verb() -> Problem {
    Problem {
        code: Some("S004".to_owned()),
        path: "suites/nmt.yaml".to_owned(),
        at: at(2, 5, 13),
        source: SourceText::Whole(Arc::from("steps:\n  - sdo-raed: {}\n  - nmt: start\n")),
        label: "expected one of the verbs".to_owned(),
        ..Problem::new(Severity::Error, "unknown verb \"sdo-raed\"")
            .help("did you mean \"sdo-read\"?")
    }
}

#[test]
fn place_is_underlined() {
    let expected = r#"error[S004]: unknown verb "sdo-raed"
 --> suites/nmt.yaml:2:5
  |
2 |   - sdo-raed: {}
  |     ^^^^^^^^ expected one of the verbs
  |
  = help: did you mean "sdo-read"?
"#;
    assert_eq!(render(&unknown_verb(), Ink::Plain), expected);
}

#[test]
fn other_place_is_shown_too() {
    let mut problem = unknown_verb();
    problem.help = None;
    problem.also = vec![also(at(1, 1, 6), "in these steps")];
    let expected = r#"error[S004]: unknown verb "sdo-raed"
 --> suites/nmt.yaml:2:5
  |
1 | steps:
  | ----- in these steps
2 |   - sdo-raed: {}
  |     ^^^^^^^^ expected one of the verbs
"#;
    assert_eq!(render(&problem, Ink::Plain), expected);
}

#[test]
fn problem_without_place_has_none() {
    let problem = Problem::new(Severity::Error, "no device is called \"kinko\"")
        .note("devices: kinco-servo")
        .help("did you mean \"kinco-servo\"?");
    let expected = r#"error: no device is called "kinko"
 |
 = note: devices: kinco-servo
 = help: did you mean "kinco-servo"?
"#;
    assert_eq!(render(&problem, Ink::Plain), expected);
}

#[test]
fn file_without_a_line_is_named() {
    let problem = Problem::new(Severity::Error, "the file cannot be read").in_file("a.yaml");
    assert_eq!(
        render(&problem, Ink::Plain),
        "error: the file cannot be read\n--> a.yaml\n"
    );
}

#[test]
fn of_a_very_long_line_the_part_around_the_place_is_shown() {
    let mut problem = unknown_verb();
    let line = format!("{}sdo-raed{}", "a".repeat(1_000_000), "b".repeat(1_000_000));
    problem.source = SourceText::Whole(Arc::from(line));
    problem.at = at(1, 1_000_001, 1_000_009);
    let text = render(&problem, Ink::Plain);
    assert!(text.contains(":1:1000001"), "{text}");
    assert!(text.contains("aasdo-raedbb"), "{text}");
    assert!(
        text.contains("  ^^^^^^^^ expected one of the verbs"),
        "{text}"
    );
    assert!(text.len() < 1_000, "{text}");
}

#[test]
fn place_far_away_is_a_note() {
    let mut problem = unknown_verb();
    problem.source = SourceText::Whole(Arc::from("0123456789\n".repeat(20_000)));
    problem.also = vec![also(at(19_999, 3, 4), "first defined here")];
    let text = render(&problem, Ink::Plain);
    assert!(
        text.contains("note: suites/nmt.yaml:19999:3: first defined here"),
        "{text}"
    );
    assert!(text.len() < 1_000, "{text}");
}

proptest! {
    #[test]
    fn any_place_in_any_text_is_rendered(
        text in "(\\PC|\n|\t|\r){0,60}", line in 0u32..6, column in 0u32..70, end_column in 0u32..70,
        others in proptest::collection::vec((0u32..6, 0u32..70, 0u32..70), 0..3), whole: bool,
    ) {
        let mut problem = unknown_verb();
        problem.source = match whole {
            true => SourceText::Whole(Arc::from(text)),
            false => SourceText::Line(text),
        };
        problem.at = at(line, column, end_column);
        problem.also = others.into_iter().map(|(line, column, end)| also(at(line, column, end), "here")).collect();
        let rendered = render(&problem, Ink::Plain);
        prop_assert!(rendered.starts_with("error[S004]: unknown verb"), "{rendered}");
        prop_assert!(rendered.contains("suites/nmt.yaml"), "{rendered}");
    }
}

#[test]
fn place_in_another_file_is_shown_too() {
    let mut problem = unknown_verb();
    problem.help = None;
    problem.label = String::new();
    problem.elsewhere = vec![Elsewhere {
        path: "verbs.txt".to_owned(),
        at: at(2, 0, 0),
        source: SourceText::Whole(Arc::from("nmt\nsdo-read\n")),
        words: "the verb".to_owned(),
    }];
    let expected = r#"error[S004]: unknown verb "sdo-raed"
 --> suites/nmt.yaml:2:5
  |
2 |   - sdo-raed: {}
  |     ^^^^^^^^
  |
 ::: verbs.txt:2:1
  |
2 | sdo-read
  | -------- the verb
"#;
    assert_eq!(render(&problem, Ink::Plain), expected);
    problem.elsewhere[0].source = SourceText::Missing;
    assert!(render(&problem, Ink::Plain).contains("= note: verbs.txt:2: the verb\n"));
}
