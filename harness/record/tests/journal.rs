//! What is written to a journal is read back as it was, whatever it was, and however much of it is left.

#![allow(clippy::unwrap_used, clippy::panic)]

use fieldproof_record::{
    CaseFinished, CaseStarted, Cite, Direction, Entry, Event, ExcerptLine, FORMAT, Failure,
    FrameEvent, Identity, IdentityPart, Journal, JournalError, JournalReader, LaneFinished,
    LaneStarted, Limits, Measurement, Note, Observation, Place, PlannedLane, PortInfo, PuttingBack,
    RunFinished, RunStarted, SerialEvent, Setting, Sink, StepStarted, StimulusEvent, SuiteFinished,
    SuiteStarted, UsedFile, Verdict, VerdictCounts, WrittenStep, journal_schema, read_journal,
};
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;

fn start() -> Entry {
    Entry::RunStarted(Box::new(RunStarted {
        format: FORMAT,
        tool: "fieldproof 0.1.0".to_owned(),
        started: "2026-11-22T21:36:29Z".to_owned(),
        arguments: vec!["run".to_owned()],
        settings: vec![Setting {
            key: "operator".to_owned(),
            value: "A. Smith".to_owned(),
        }],
        bench: None,
        strict: false,
        depth: "default".to_owned(),
        seed: u64::MAX,
        files: vec![UsedFile {
            kind: "suite".to_owned(),
            path: "a.yaml".to_owned(),
            sha256: "00".repeat(32),
        }],
        lanes: vec![PlannedLane {
            device: "kinco-servo".to_owned(),
            cases: 1,
            simulated: true,
            files: Vec::new(),
        }],
    }))
}

fn written(entries: &[Entry]) -> Vec<u8> {
    let mut journal = Vec::new();
    for entry in entries {
        entry.write(&mut journal).unwrap();
    }
    journal
}

/// Everything that a journal has, its start first.
fn all(journal: &[u8]) -> Result<Vec<Entry>, JournalError> {
    let (start, entries) = read_journal(journal)?;
    let start = Entry::RunStarted(Box::new(start));
    Ok(std::iter::once(start).chain(entries).collect())
}

#[test]
fn frame_is_one_short_line() {
    let frame = Event::Frame(FrameEvent {
        at_ns: 1_234,
        port: 0,
        direction: Direction::Received,
        id: 0x581,
        extended: false,
        remote: false,
        len: 4,
        data: [0x43, 0x00, 0x10, 0x00, 0, 0, 0, 0],
        decoded: None,
    });
    assert_eq!(
        String::from_utf8(written(&[Entry::Lane(3, frame)])).unwrap(),
        concat!(
            r#"{"lane":3,"event":"frame","at_ns":1234,"port":0,"direction":"received","id":1409,"data":"43001000"}"#,
            "\n"
        )
    );
}

#[test]
fn frame_of_nine_bytes_is_refused() {
    for frame in [
        r#""data":"000000000000000000""#,
        r#""remote":9,"data":"""#,
        r#""remote":1,"data":"00""#,
        r#""data":"0""#,
        r#""data":"+1""#,
    ] {
        let line =
            format!(r#"{{"event":"frame","at_ns":0,"port":0,"direction":"sent","id":0,{frame}}}"#);
        assert!(serde_json::from_str::<Event>(&line).is_err(), "{line}");
    }
}

#[test]
fn line_in_the_middle_that_is_no_event_is_an_error() {
    let mut journal = written(&[start()]);
    journal.extend_from_slice(b"{\"lane\":0,\"event\":\"coffee\"}\n");
    journal.extend(written(&[start()]));
    let Err(JournalError::Line { line, reason }) = read_journal(&journal) else {
        panic!("it was read");
    };
    assert_eq!(line, 2);
    assert!(reason.contains("coffee"), "{reason}");
}

#[test]
fn schema_refuses_what_is_no_event() {
    let schema = jsonschema::validator_for(&journal_schema()).unwrap();
    for line in [
        r#"{"lane":0,"event":"coffee"}"#,
        r#"{"event":"frame","at_ns":0,"port":0,"direction":"sent","id":1,"data":"00"}"#,
        r#"{"lane":0,"event":"frame","at_ns":0,"port":0,"direction":"sent","id":1,"data":[1]}"#,
        r#"{"lane":0,"event":"frame","at_ns":0,"port":0,"direction":"sent","id":1,"data":"0"}"#,
    ] {
        let value = serde_json::from_str(line).unwrap();
        assert!(!schema.is_valid(&value), "{line}");
    }
}

#[test]
fn journal_of_another_format_is_refused() {
    let journal = String::from_utf8(written(&[start()])).unwrap();
    let journal = journal.replace("\"format\":2", "\"format\":1");
    assert!(matches!(
        read_journal(journal.as_bytes()),
        Err(JournalError::Format(1))
    ));
}

#[test]
fn text_that_is_no_journal_is_refused() {
    let step = Event::StepStarted(StepStarted {
        step: 0,
        line: 1,
        at_ns: 0,
    });
    for journal in [
        b"".to_vec(),
        b"{\"ev".to_vec(),
        written(&[Entry::Lane(0, step)]),
    ] {
        assert!(matches!(read_journal(&journal), Err(JournalError::NoStart)));
    }
}

#[test]
fn lane_is_read_without_the_others() {
    let note = |lane, at_ns| {
        let text = "a line".to_owned();
        Entry::Lane(lane, Event::Note(Box::new(Note { at_ns, text })))
    };
    let end = Entry::RunFinished(RunFinished {
        finished: "2026-11-22T21:36:30Z".to_owned(),
    });
    let entries = [
        start(),
        note(0, 1),
        note(12, 2),
        note(1, 3),
        note(1, 4),
        end,
    ];
    let journal = written(&entries);
    let mut reader = JournalReader::new(journal.as_slice()).unwrap();
    let mut read = Vec::new();
    while let Some(entry) = reader.entry(Some(1)).unwrap() {
        read.push(entry);
    }
    assert_eq!(read, entries[3..]);
}

#[test]
fn lines_in_another_order_are_read_as_well() {
    let mut journal = written(&[start()]);
    journal.extend_from_slice(b"{\"at_ns\":5,\"event\":\"putting-back\",\"lane\":1}\n");
    let entry = Entry::Lane(1, Event::PuttingBack(PuttingBack { at_ns: 5 }));
    assert_eq!(all(&journal).unwrap()[1..], [entry]);
    let mut reader = JournalReader::new(journal.as_slice()).unwrap();
    assert_eq!(reader.entry(Some(0)).unwrap(), None);
}

#[test]
fn bytes_that_a_machine_left_behind_when_it_died_are_left_out() {
    let mut journal = written(&[start()]);
    journal.extend_from_slice(b"\0\0\0\0\n");
    assert_eq!(all(&journal).unwrap(), [start()]);
}

#[test]
fn writer_that_fails_is_told_at_the_end() {
    struct Full;
    impl std::io::Write for Full {
        fn write(&mut self, _: &[u8]) -> std::io::Result<usize> {
            Err(std::io::ErrorKind::StorageFull.into())
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    let mut journal = Journal::new(Full, 0);
    journal.emit(Event::PuttingBack(PuttingBack { at_ns: 0 }));
    let error = journal.finish().map(|_| ()).unwrap_err();
    assert_eq!(error.kind(), std::io::ErrorKind::StorageFull);
}

fn text() -> impl Strategy<Value = String> {
    any::<String>()
}

fn verdict() -> impl Strategy<Value = Verdict> {
    proptest::sample::select(Verdict::ALL.to_vec())
}

fn direction() -> impl Strategy<Value = Direction> {
    prop_oneof![
        Just(Direction::Sent),
        Just(Direction::Received),
        Just(Direction::Companion)
    ]
}

fn counts() -> impl Strategy<Value = VerdictCounts> {
    vec(verdict(), 0..20).prop_map(|verdicts| {
        let mut counts = VerdictCounts::default();
        verdicts.into_iter().for_each(|verdict| counts.add(verdict));
        counts
    })
}

prop_compose! {
    fn place()(path in text(), line: u32, column: u32, end_column: u32, text in text()) -> Place {
        Place { path, line, column, end_column, text }
    }
}

prop_compose! {
    fn cite()(document in text(), section in option::of(text())) -> Cite {
        Cite { document, section }
    }
}

prop_compose! {
    fn frame()(
        at_ns: u64, port: u8, direction in direction(), id: u32, extended: bool, remote: bool,
        bytes in vec(any::<u8>(), 0..=8), decoded in option::of(text()),
    ) -> FrameEvent {
        let mut data = [0; 8];
        if !remote {
            data[..bytes.len()].copy_from_slice(&bytes);
        }
        FrameEvent { at_ns, port, direction, id, extended, remote, len: bytes.len() as u8, data, decoded: decoded.map(Into::into) }
    }
}

prop_compose! {
    fn failure()(
        verdict in verdict(), place in place(), at_ns: u64, what in text(), expected in text(),
        actual in text(), notes in vec(text(), 0..3),
    ) -> Failure {
        Failure { verdict, place, at_ns, what, expected, actual, notes }
    }
}

prop_compose! {
    fn excerpt_line()(
        at_ns: u64, port in text(), direction in direction(), raw in text(), decoded in text(),
        marked: bool,
    ) -> ExcerptLine {
        ExcerptLine { at_ns, port, direction, raw, decoded, marked }
    }
}

prop_compose! {
    fn case_started()(
        (id, written_id, title) in (text(), text(), text()), at_ns: u64,
        cites in vec(cite(), 0..3), against in vec(cite(), 0..2), because in option::of(text()),
        (examples, effects) in (vec(text(), 0..3), vec(text(), 0..3)),
        steps in vec((any::<u32>(), any::<bool>(), text()), 0..3), place in place(),
    ) -> CaseStarted {
        let steps = steps.into_iter().map(|(line, control, text)| WrittenStep { line, control, text });
        CaseStarted { id, written_id, title, at_ns, cites, against, because, examples, effects, steps: steps.collect(), place }
    }
}

prop_compose! {
    fn case_finished()(
        id in text(), at_ns: u64, duration_ns: u64, verdict in verdict(),
        reason in option::of(text()), failures in vec(failure(), 0..3),
        excerpt in vec(excerpt_line(), 0..4),
    ) -> CaseFinished {
        CaseFinished { id, at_ns, duration_ns, verdict, reason, failures, excerpt }
    }
}

prop_compose! {
    fn measurement()(
        at_ns: u64, name in text(), value_ns: u64, uncertainty_ns: u64,
        min_ns in option::of(any::<u64>()), max_ns in option::of(any::<u64>()),
        verdict in verdict(),
    ) -> Measurement {
        Measurement { at_ns, name: name.into(), value_ns, uncertainty_ns, limits: Limits { min_ns, max_ns }, verdict }
    }
}

prop_compose! {
    fn serial()(
        at_ns: u64, start_ns: u64, port: u8, direction in direction(),
        bytes in vec(any::<u8>(), 0..300), spoilt: bool, decoded in option::of(text()),
    ) -> SerialEvent {
        SerialEvent { at_ns, start_ns, port, direction, bytes, spoilt, decoded: decoded.map(Into::into) }
    }
}

prop_compose! {
    fn lane_started()(
        (tool, device, title) in (text(), text(), text()), fault in option::of(text()), seed: u64,
        ports in vec((text(), text(), text(), text(), any::<u64>()), 0..3),
    ) -> LaneStarted {
        let ports = ports.into_iter().map(|(name, link, line, timestamps, uncertainty_ns)| {
            PortInfo { name, link, line, timestamps, uncertainty_ns }
        });
        LaneStarted { tool, device, title, fault: fault.clone(), variant: fault, seed, ports: ports.collect() }
    }
}

fn event() -> impl Strategy<Value = Event> {
    prop_oneof![
        lane_started().prop_map(|it| Event::LaneStarted(Box::new(it))),
        (text(), text(), text()).prop_map(|(suite, title, path)| Event::SuiteStarted(Box::new(
            SuiteStarted { suite, title, path }
        ))),
        case_started().prop_map(|it| Event::CaseStarted(Box::new(it))),
        any::<(u32, u32, u64)>().prop_map(|(step, line, at_ns)| Event::StepStarted(StepStarted {
            step,
            line,
            at_ns
        })),
        (
            any::<u64>(),
            vec((text(), text(), option::of(text())), 0..3)
        )
            .prop_map(|(at_ns, parts)| {
                let parts = parts.into_iter().map(|(name, object, read)| IdentityPart {
                    name,
                    object,
                    unread: read.clone(),
                    described: read.clone(),
                    read,
                });
                let parts = parts.collect();
                Event::Identity(Box::new(Identity { at_ns, parts }))
            }),
        any::<u64>().prop_map(|at_ns| Event::PuttingBack(PuttingBack { at_ns })),
        frame().prop_map(Event::Frame),
        serial().prop_map(|it| Event::Serial(Box::new(it))),
        (any::<u64>(), text())
            .prop_map(|(at_ns, what)| Event::Stimulus(Box::new(StimulusEvent { at_ns, what }))),
        measurement().prop_map(|it| Event::Measurement(Box::new(it))),
        (any::<u64>(), text(), text()).prop_map(|(at_ns, name, value)| Event::Observation(
            Box::new(Observation { at_ns, name, value })
        )),
        (any::<u64>(), text())
            .prop_map(|(at_ns, text)| Event::Note(Box::new(Note { at_ns, text }))),
        case_finished().prop_map(|it| Event::CaseFinished(Box::new(it))),
        (text(), any::<u64>(), counts()).prop_map(|(suite, at_ns, counts)| Event::SuiteFinished(
            SuiteFinished {
                suite,
                at_ns,
                counts
            }
        )),
        (any::<u64>(), counts(), option::of(text())).prop_map(|(at_ns, counts, stopped)| {
            Event::LaneFinished(Box::new(LaneFinished {
                at_ns,
                counts,
                stopped,
            }))
        }),
    ]
}

fn entries() -> impl Strategy<Value = Vec<Entry>> {
    let entry = (any::<u32>(), event()).prop_map(|(lane, event)| Entry::Lane(lane, event));
    vec(entry, 0..12).prop_map(|entries| std::iter::once(start()).chain(entries).collect())
}

proptest! {
    #[test]
    fn what_is_written_is_read(entries in entries()) {
        prop_assert_eq!(all(&written(&entries)).unwrap(), entries);
    }

    #[test]
    fn every_event_is_one_line(event in event()) {
        let line = written(&[Entry::Lane(0, event)]);
        prop_assert_eq!(line.iter().filter(|byte| **byte == b'\n').count(), 1);
        prop_assert_eq!(line.last(), Some(&b'\n'));
    }

    #[test]
    fn cut_off_journal_gives_the_entries_before(entries in entries(), cut in any::<prop::sample::Index>()) {
        let whole = written(&entries);
        let first = written(&entries[..1]).len();
        let end = first + cut.index(whole.len() - first + 1);
        let complete = all(&whole[..end]).unwrap();
        prop_assert_eq!(&complete[..], &entries[..complete.len()]);
        // A line is lost only if its end is: even a last line without its line feed is read.
        let lines = whole[..end].iter().filter(|byte| **byte == b'\n').count();
        prop_assert!(complete.len() == lines || complete.len() == lines + 1);
    }

    #[test]
    fn arbitrary_bytes_are_no_reason_to_panic(bytes in vec(any::<u8>(), 0..400)) {
        prop_assert!(read_journal(&bytes).is_err());
        let mut journal = written(&[start()]);
        journal.extend(bytes);
        let _ = read_journal(&journal);
    }

    #[test]
    fn every_event_keeps_the_schema(event in event()) {
        thread_local! {
            static SCHEMA: jsonschema::Validator = jsonschema::validator_for(&journal_schema()).unwrap();
        }
        for entry in [start(), Entry::Lane(7, event)] {
            let value = serde_json::from_slice(&written(&[entry])).unwrap();
            SCHEMA.with(|schema| schema.validate(&value).map_err(|error| error.to_string())).unwrap();
        }
    }
}
