//! The JUnit file, read back by two strangers: quick-junit, and a plain XML reader with the rules that Jenkins, GitLab
//! and the GitHub actions rely on.

#![allow(clippy::unwrap_used, clippy::panic)]

mod support;

use std::io::Cursor;

use fieldproof_record::{Event, Note, Verdict};
use fieldproof_report::junit::{JunitLane, assemble};
use quick_junit::{NonSuccessKind, Report, TestCaseStatus};
use support::{case_finished, case_started, lane, lane_started, suite_started};

fn junit(lanes: &[Vec<Event>], strict: bool) -> String {
    let mut written = Vec::new();
    for events in lanes {
        let mut lane = JunitLane::new(Vec::new(), strict);
        for event in events {
            lane.event(event);
        }
        let (body, heads) = lane.finish().unwrap();
        written.push((heads, Cursor::new(body)));
    }
    let mut out = Vec::new();
    assemble(&mut out, written).unwrap();
    String::from_utf8(out).unwrap()
}

fn read(xml: &str) -> Report {
    keeps_the_rules(xml);
    Report::deserialize_from_str(xml).unwrap()
}

/// What the consumers have in common: the names and order of elements, required attributes, numbers that add up.
fn keeps_the_rules(xml: &str) {
    let document = roxmltree::Document::parse(xml).unwrap();
    let root = document.root_element();
    assert_eq!(root.tag_name().name(), "testsuites");
    let number = |node: roxmltree::Node<'_, '_>, name: &str| -> u64 {
        node.attribute(name)
            .unwrap_or_else(|| panic!("no {name}"))
            .parse()
            .unwrap()
    };
    let nanoseconds = |node: roxmltree::Node<'_, '_>| -> u64 {
        let (seconds, fraction) = node.attribute("time").unwrap().split_once('.').unwrap();
        assert_eq!(fraction.len(), 9);
        seconds.parse::<u64>().unwrap() * 1_000_000_000 + fraction.parse::<u64>().unwrap()
    };
    let elements = |node: roxmltree::Node<'_, '_>, name: &str| {
        node.descendants()
            .filter(|child| child.has_tag_name(name))
            .count() as u64
    };
    for suite in root.children().filter(|node| node.is_element()) {
        assert_eq!(suite.tag_name().name(), "testsuite");
        assert!(!suite.attribute("name").unwrap().is_empty());
        let mut sum = 0;
        let mut seen_case = false;
        for child in suite.children().filter(|node| node.is_element()) {
            match child.tag_name().name() {
                "properties" => assert!(!seen_case, "properties after a case"),
                "testcase" => {
                    seen_case = true;
                    for required in ["name", "classname", "time"] {
                        assert!(child.attribute(required).is_some(), "no {required}");
                    }
                    sum += nanoseconds(child);
                    let outcomes =
                        ["failure", "error", "skipped"].map(|name| elements(child, name));
                    assert!(outcomes.iter().sum::<u64>() <= 1);
                }
                other => panic!("unknown element {other}"),
            }
        }
        assert_eq!(nanoseconds(suite), sum);
        assert_eq!(number(suite, "tests"), elements(suite, "testcase"));
    }
    let suites = || root.children().filter(|node| node.is_element());
    for node in suites().chain([root]) {
        assert_eq!(number(node, "failures"), elements(node, "failure"));
        assert_eq!(number(node, "errors"), elements(node, "error"));
        assert_eq!(number(node, "skipped"), elements(node, "skipped"));
    }
    assert_eq!(number(root, "tests"), elements(root, "testcase"));
    assert_eq!(nanoseconds(root), suites().map(nanoseconds).sum::<u64>());
}

fn kinds(report: &Report) -> Vec<(&str, Option<&str>)> {
    let cases = report
        .test_suites
        .iter()
        .flat_map(|suite| &suite.test_cases);
    cases
        .map(|case| match &case.status {
            TestCaseStatus::Success { .. } => ("passed", None),
            TestCaseStatus::Skipped { message, .. } => ("skipped", message.as_deref()),
            TestCaseStatus::NonSuccess { kind, ty, .. } => match kind {
                NonSuccessKind::Failure => ("failure", ty.as_deref()),
                NonSuccessKind::Error => ("error", ty.as_deref()),
            },
        })
        .collect()
}

#[test]
fn every_verdict_has_its_element() {
    let report = read(&junit(&[lane("drive", &Verdict::ALL)], false));
    assert_eq!(
        kinds(&report),
        [
            ("passed", None),
            ("skipped", Some("needs lss, which is not claimed")),
            ("passed", None),
            ("error", Some("inconclusive")),
            ("failure", Some("fail")),
            ("error", Some("error")),
        ]
    );
}

#[test]
fn deviation_is_a_failure_when_strict() {
    let report = read(&junit(&[lane("drive", &[Verdict::Deviation])], true));
    assert_eq!(kinds(&report), [("failure", Some("deviation"))]);
    assert_eq!(report.failures, 1);
}

#[test]
fn case_has_its_names_and_properties() {
    let report = read(&junit(&[lane("drive", &[Verdict::Deviation])], false));
    let suite = &report.test_suites[0];
    assert_eq!(suite.name.as_str(), "drive.worked-examples on drive");
    let case = &suite.test_cases[0];
    assert_eq!(case.name.as_str(), "drive.worked-examples/deviation");
    assert_eq!(
        case.classname.as_deref(),
        Some("drive.drive.worked-examples")
    );
    let properties: Vec<(&str, &str)> = case
        .properties
        .iter()
        .map(|property| (property.name.as_str(), property.value.as_str()))
        .collect();
    assert_eq!(
        properties,
        [
            ("title", "Slide 7: 6063h reads -12013"),
            ("source", "Drive manual, slide 7"),
            ("example", "drive-007"),
            ("effect", "writes"),
            (
                "measurement.SDO response time",
                "0.000213000 s (limit 0.050000000 s, uncertainty 0.000000000 s, pass)"
            ),
            ("observation.position", "-12012"),
            ("deviation", "the answer carries another value"),
        ]
    );
}

#[test]
fn failure_carries_the_frames() {
    let report = read(&junit(&[lane("drive", &[Verdict::Fail])], false));
    let TestCaseStatus::NonSuccess {
        message,
        description,
        ..
    } = &report.test_suites[0].test_cases[0].status
    else {
        panic!("it passed");
    };
    assert_eq!(message.as_deref(), Some("the answer carries another value"));
    let body = description.as_deref().unwrap();
    for part in [
        "--> suites/drive.yaml:12:9",
        "  expected  581#4363600013D1FFFF   SDO answer 6063h:00 = -12013",
        "      came  581#4363600014D1FFFF   SDO answer 6063h:00 = -12012",
        "                        ^^",
        "received   581#4363600014D1FFFF  SDO answer",
    ] {
        assert!(body.contains(part), "{part}\n{body}");
    }
}

#[test]
fn lanes_follow_each_other_with_their_own_suites() {
    let lanes = [
        lane("drive", &[Verdict::Pass]),
        lane("encoder", &[Verdict::Pass, Verdict::Fail]),
    ];
    let report = read(&junit(&lanes, false));
    let names: Vec<&str> = report
        .test_suites
        .iter()
        .map(|suite| suite.name.as_str())
        .collect();
    assert_eq!(
        names,
        [
            "drive.worked-examples on drive",
            "drive.worked-examples on encoder"
        ]
    );
    assert_eq!((report.tests, report.failures), (3, 1));
}

#[test]
fn text_that_xml_cannot_hold_is_replaced() {
    let nasty = "a\u{0}\u{1b}[31m\u{fffe}]]> <b> & \"c\" 'd' ü\n\te";
    let mut started = case_started(nasty);
    started.title = nasty.to_owned();
    let mut finished = case_finished(nasty, Verdict::Fail);
    finished.failures[0].what = nasty.to_owned();
    finished.failures[0].expected = nasty.to_owned();
    finished.failures[0].notes = vec![nasty.to_owned()];
    finished.excerpt[0].decoded = nasty.to_owned();
    let events = vec![
        lane_started(nasty),
        suite_started(nasty),
        Event::CaseStarted(Box::new(started)),
        Event::Note(Box::new(Note {
            at_ns: 0,
            text: nasty.to_owned(),
        })),
        Event::CaseFinished(Box::new(finished)),
    ];
    let report = read(&junit(&[events], false));
    let case = &report.test_suites[0].test_cases[0];
    assert!(
        case.name.as_str().contains("]]> <b> & \"c\" 'd' ü"),
        "{}",
        case.name.as_str()
    );
}

#[test]
fn record_that_breaks_off_within_a_case_is_an_error() {
    let mut events = lane("drive", &[Verdict::Pass, Verdict::Pass]);
    events.truncate(events.len() - 3);
    let report = read(&junit(&[events], false));
    assert_eq!(kinds(&report), [("passed", None), ("error", Some("error"))]);
}

#[test]
fn case_that_was_never_begun_is_not_lost() {
    let mut events = lane("drive", &[Verdict::Skipped]);
    events.retain(|event| !matches!(event, Event::CaseStarted(_)));
    let report = read(&junit(&[events], false));
    assert_eq!(report.tests, 1);
    assert_eq!(
        report.test_suites[0].test_cases[0].name.as_str(),
        "drive.worked-examples/skipped"
    );
}

#[test]
fn run_without_lanes_is_a_file_too() {
    assert_eq!(read(&junit(&[], false)).tests, 0);
}
