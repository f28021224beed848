//! A small lane to make reports of.

#![allow(dead_code, reason = "each test uses some of it")]

use fieldproof_record::{
    CaseFinished, CaseStarted, Cite, Direction, Event, ExcerptLine, Failure, LaneFinished,
    LaneStarted, Limits, Measurement, Observation, Place, PortInfo, SuiteFinished, SuiteStarted,
    Verdict, VerdictCounts,
};

pub(crate) fn lane_started(device: &str) -> Event {
    Event::LaneStarted(Box::new(LaneStarted {
        tool: "fieldproof 0.1.0".to_owned(),
        device: device.to_owned(),
        title: "A drive".to_owned(),
        fault: None,
        variant: None,
        seed: 7,
        ports: vec![PortInfo {
            name: "can".to_owned(),
            link: "sim:".to_owned(),
            line: "250 kbit/s".to_owned(),
            timestamps: "simulated".to_owned(),
            uncertainty_ns: 0,
        }],
    }))
}

pub(crate) fn suite_started(suite: &str) -> Event {
    Event::SuiteStarted(Box::new(SuiteStarted {
        suite: suite.to_owned(),
        title: "Worked examples".to_owned(),
        path: "suites/drive.yaml".to_owned(),
    }))
}

pub(crate) fn place() -> Place {
    Place {
        path: "suites/drive.yaml".to_owned(),
        line: 12,
        column: 9,
        end_column: 15,
        text: "      - expect: \"581#43636000.13D1FFFF\"".to_owned(),
    }
}

pub(crate) fn case_started(id: &str) -> CaseStarted {
    CaseStarted {
        id: id.to_owned(),
        written_id: id.to_owned(),
        title: "Slide 7: 6063h reads -12013".to_owned(),
        at_ns: 1_000_000_000,
        cites: vec![Cite {
            document: "Drive manual".to_owned(),
            section: Some("slide 7".to_owned()),
        }],
        against: Vec::new(),
        because: None,
        examples: vec!["drive-007".to_owned()],
        effects: vec!["writes".to_owned()],
        steps: Vec::new(),
        place: place(),
    }
}

pub(crate) fn failure(verdict: Verdict) -> Failure {
    Failure {
        verdict,
        place: place(),
        at_ns: 1_000_420_000,
        what: "the answer carries another value".to_owned(),
        expected: "581#43636000.13D1FFFF  SDO answer 6063h:00 = -12013".to_owned(),
        actual: "581#4363600014D1FFFF  SDO answer 6063h:00 = -12012".to_owned(),
        notes: vec!["byte 4 differs".to_owned()],
    }
}

pub(crate) fn case_finished(id: &str, verdict: Verdict) -> CaseFinished {
    let frame = |at_ns, direction, raw: &str, decoded: &str, marked| ExcerptLine {
        at_ns,
        port: "can".to_owned(),
        direction,
        raw: raw.to_owned(),
        decoded: decoded.to_owned(),
        marked,
    };
    let mut finished = CaseFinished {
        id: id.to_owned(),
        at_ns: 1_000_500_000,
        duration_ns: 500_000,
        verdict,
        reason: None,
        failures: Vec::new(),
        excerpt: Vec::new(),
    };
    match verdict {
        Verdict::Pass => {}
        Verdict::Skipped => finished.reason = Some("needs lss, which is not claimed".to_owned()),
        _ => {
            finished.failures = vec![failure(verdict)];
            finished.excerpt = vec![
                frame(
                    1_000_000_000,
                    Direction::Sent,
                    "601#4063600000000000",
                    "SDO read 6063h:00",
                    false,
                ),
                frame(
                    1_000_420_000,
                    Direction::Received,
                    "581#4363600014D1FFFF",
                    "SDO answer 6063h:00 = -12012",
                    true,
                ),
            ];
        }
    }
    finished
}

pub(crate) fn case(id: &str, verdict: Verdict) -> Vec<Event> {
    vec![
        Event::CaseStarted(Box::new(case_started(id))),
        Event::Measurement(Box::new(Measurement {
            at_ns: 1_000_420_000,
            name: "SDO response time".into(),
            value_ns: 213_000,
            uncertainty_ns: 0,
            limits: Limits {
                min_ns: None,
                max_ns: Some(50_000_000),
            },
            verdict: Verdict::Pass,
        })),
        Event::Observation(Box::new(Observation {
            at_ns: 1_000_420_000,
            name: "position".to_owned(),
            value: "-12012".to_owned(),
        })),
        Event::CaseFinished(Box::new(case_finished(id, verdict))),
    ]
}

/// A lane with one suite that has one case of each of `verdicts`.
pub(crate) fn lane(device: &str, verdicts: &[Verdict]) -> Vec<Event> {
    let mut counts = VerdictCounts::default();
    let mut events = vec![lane_started(device), suite_started("drive.worked-examples")];
    for verdict in verdicts {
        counts.add(*verdict);
        events.extend(case(&format!("drive.worked-examples/{verdict}"), *verdict));
    }
    events.push(Event::SuiteFinished(SuiteFinished {
        suite: "drive.worked-examples".to_owned(),
        at_ns: 2_000_000_000,
        counts,
    }));
    events.push(Event::LaneFinished(Box::new(LaneFinished {
        at_ns: 2_000_000_000,
        counts,
        stopped: None,
    })));
    events
}
