//! What a case changes is put back.

use fieldproof_can::Frame;
use fieldproof_record::Verdict;

use crate::scripted::{Memory, Scripted, Setup};

fn memory(objects: &[((u16, u8), [u8; 4])]) -> Scripted {
    let mut memory = Memory::new(objects);
    Scripted::new(move |request: &Frame| memory.answer(request))
}

/// The writes that the device saw.
fn writes(seen: &[String]) -> Vec<&str> {
    seen.iter()
        .map(String::as_str)
        .filter(|frame| frame.starts_with("601#23"))
        .collect()
}

const TWO_WRITES: &str = "
  - case: writes
    title: Writes two objects
    cite: [book]
    effects: [writes]
    steps:
      - sdo-write: {object: \"2000:00\", as: u32, value: 7}
      - sdo-write: {object: \"2001:00\", as: u32, value: 8}
      - sdo-read: {object: \"2000:00\", as: u32, expect: EXPECTED}
";

#[test]
fn in_reverse_order_after_a_pass_and_after_a_failure() {
    for (expected, verdict) in [("7", Verdict::Pass), ("9", Verdict::Fail)] {
        let device = memory(&[((0x2000, 0), [1, 0, 0, 0]), ((0x2001, 0), [2, 0, 0, 0])]);
        let seen = device.seen.clone();
        let played = Setup::default().play(device, &TWO_WRITES.replace("EXPECTED", expected));
        assert_eq!(played.verdict().0, verdict);
        assert_eq!(
            writes(&seen.lock().unwrap()),
            [
                "601#2300200007000000",
                "601#2301200008000000",
                "601#2301200002000000",
                "601#2300200001000000",
            ]
        );
    }
}

#[test]
fn also_when_the_user_interrupts() {
    let device = memory(&[((0x2000, 0), [1, 0, 0, 0]), ((0x2001, 0), [2, 0, 0, 0])]);
    let seen = device.seen.clone();
    // Stop as soon as the first object has been written: its frames are among the first events.
    let setup = Setup {
        stop_after: Some(18),
        ..Setup::default()
    };
    let played = setup.play(device, &TWO_WRITES.replace("EXPECTED", "7"));
    assert_eq!(played.outcome.stopped.as_deref(), Some("interrupted"));
    assert_eq!(
        played.verdict(),
        (Verdict::Inconclusive, "the run was interrupted")
    );
    let seen = seen.lock().unwrap();
    let writes = writes(&seen);
    assert_eq!(writes.first(), Some(&"601#2300200007000000"), "{writes:?}");
    assert_eq!(writes.last(), Some(&"601#2300200001000000"), "{writes:?}");
}

#[test]
fn a_device_that_cannot_be_put_back_stops_the_lane() {
    // Takes every write of 2000h, but keeps the first value it was given.
    let mut memory = Memory::new(&[((0x2000, 0), [1, 0, 0, 0])]);
    let mut written = false;
    let device = Scripted::new(move |request: &Frame| {
        let is_write = request.to_string().starts_with("601#23");
        let kept = memory.objects.clone();
        let answers = memory.answer(request);
        if is_write && written {
            memory.objects = kept;
        }
        written |= is_write;
        answers
    });
    let cases = format!(
        "{}
  - case: next
    title: Is not played any more
    cite: [book]
    steps:
      - sdo-read: {{object: \"2000:00\", as: u32}}
",
        "
  - case: write
    title: Writes an object
    cite: [book]
    effects: [writes]
    steps:
      - sdo-write: {object: \"2000:00\", as: u32, value: 7}
"
    );
    let played = Setup::default().play(device, &cases);
    assert_eq!(
        played.verdict(),
        (
            Verdict::Error,
            "the device could not be put back: 2000h:00 could not be put back"
        )
    );
    assert_eq!(played.outcome.counts.total(), 1);
    assert!(played.outcome.stopped.is_some());
}

#[test]
fn a_mapping_changed_by_raw_frames_is_put_back_by_the_procedure_of_pdos() {
    let device = memory(&[
        ((0x1800, 1), [0x81, 1, 0, 0]),
        ((0x1A00, 0), [1, 0, 0, 0]),
        ((0x1A00, 1), [0x20, 0, 0x63, 0x60]),
    ]);
    let seen = device.seen.clone();
    let played = Setup::default().play(
        device,
        "
  - case: remap
    title: Writes a mapping entry, whatever the procedure
    cite: [book]
    effects: [writes]
    restore: {objects: [\"1A00:00\", \"1A00:01\"]}
    steps:
      - send: \"601#23001A0110004160\"
      - expect: \"581#60001A0100000000\"
",
    );
    assert_eq!(played.verdict(), (Verdict::Pass, ""));
    let seen = seen.lock().unwrap();
    let after: Vec<&str> = seen
        .iter()
        .map(String::as_str)
        .filter(|frame| frame.starts_with("601#2"))
        .skip(1)
        .collect();
    assert_eq!(
        after,
        [
            "601#2300180181010080",
            "601#2F001A0000000000",
            "601#23001A0120006360",
            "601#23001A0001000000",
            "601#2300180181010000",
        ]
    );
}

#[test]
fn what_cannot_be_read_must_say_how_it_is_undone() {
    // Every read of 2000h is refused: it is write-only.
    let device = || {
        Scripted::new(|request: &Frame| {
            let answer = match request.to_string().as_str() {
                "601#4000200000000000" => "581#8000200001000106",
                text if text.starts_with("601#23002000") => "581#6000200000000000",
                _ => return Vec::new(),
            };
            vec![crate::scripted::soon(answer)]
        })
    };
    let writing = "
  - case: write
    title: Writes a write-only object
    cite: [book]
    effects: [writes]
    RESTORE
    steps:
      - sdo-write: {object: \"2000:00\", as: u32, value: 7}
";
    let played = Setup::default().play(device(), &writing.replace("    RESTORE\n", ""));
    assert_eq!(played.verdict().0, Verdict::Error);
    assert!(
        played.verdict().1.contains("cannot be put back"),
        "{:?}",
        played.verdict()
    );
    let undoing = writing.replace(
        "RESTORE",
        "restore: {steps: [{sdo-write: {object: \"2000:00\", as: u32, value: 0}}]}",
    );
    assert_eq!(
        Setup::default().play(device(), &undoing).verdict(),
        (Verdict::Pass, "")
    );
}

#[test]
fn values_that_only_lay_between_are_not_played_back() {
    // The drive must not be told 0Fh once more on the way back to 0.
    let device = memory(&[((0x6040, 0), [0; 4])]);
    let seen = device.seen.clone();
    let played = Setup::default().play(
        device,
        "
  - case: writes
    title: Writes an object three times
    cite: [book]
    effects: [writes]
    steps:
      - sdo-write: {object: \"6040:00\", as: u32, value: 6}
      - sdo-write: {object: \"6040:00\", as: u32, value: 15}
      - sdo-write: {object: \"6040:00\", as: u32, value: 6}
",
    );
    assert_eq!(played.verdict(), (Verdict::Pass, ""));
    assert_eq!(
        writes(&seen.lock().unwrap()),
        [
            "601#2340600006000000",
            "601#234060000F000000",
            "601#2340600006000000",
            "601#2340600000000000",
        ]
    );
}

#[test]
fn a_pdo_that_was_moved_and_enabled_is_disabled_before_it_is_put_back() {
    let device = memory(&[
        ((0x1800, 1), [0x81, 1, 0, 0]),
        ((0x1800, 2), [254, 0, 0, 0]),
    ]);
    let seen = device.seen.clone();
    let played = Setup::default().play(
        device,
        "
  - case: moves
    title: Moves a PDO to another identifier
    cite: [book]
    effects: [writes]
    steps:
      - sdo-write: {object: \"1800:01\", as: u32, value: 0x80000181}
      - sdo-write: {object: \"1800:02\", as: u32, value: 1}
      - sdo-write: {object: \"1800:01\", as: u32, value: 0x190}
",
    );
    assert_eq!(played.verdict(), (Verdict::Pass, ""));
    let seen = seen.lock().unwrap();
    assert_eq!(
        writes(&seen)[3..],
        [
            "601#2300180190010080",
            "601#23001802FE000000",
            "601#2300180181010000",
        ]
    );
}
