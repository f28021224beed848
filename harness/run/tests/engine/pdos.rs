//! PDOs and SYNC: what is counted and compared; and values that a device may take or not.

use fieldproof_can::Frame;
use fieldproof_record::Verdict;
use fieldproof_suite::model::Effect;

use crate::scripted::{Answers, Memory, Played, Scripted, Setup, frame, soon};

const COUNTED: &str = "
  - case: counted
    title: Every third SYNC
    cite: [book]
    effects: [disturbs-bus]
    steps:
      - start-sync: {period: 10 ms}
      - expect-tpdo: {number: 1, within: 1 s, syncs: 3, count: 4}
      - stop-sync:
";

/// Sends TPDO1 after SYNCs as the list says, again and again.
fn after_syncs(distances: &'static [u32]) -> Scripted {
    let mut distances = distances.iter().cycle();
    let mut left = 1;
    Scripted::new(move |received: &Frame| {
        if *received != frame("080#") {
            return Answers::new();
        }
        left -= 1;
        if left > 0 {
            return Answers::new();
        }
        left = *distances.next().unwrap();
        vec![soon("181#0102")]
    })
}

fn play(device: Scripted, cases: &str) -> Played {
    let mut setup = Setup::default();
    setup.permits.push(Effect::DisturbsBus);
    setup.play(device, cases)
}

#[test]
fn syncs_between_pdos_are_counted_exactly() {
    let verdict = |distances| {
        let played = play(after_syncs(distances), COUNTED);
        (played.verdict().0, played.verdict().1.to_owned())
    };
    assert_eq!(verdict(&[3]), (Verdict::Pass, String::new()));
    for (distances, wrong) in [
        (&[3, 3, 2][..], "TPDO1 comes after 2 SYNCs, and not after 3"),
        (&[3, 3, 3, 4], "TPDO1 comes after 4 SYNCs, and not after 3"),
        (&[3, 9], "TPDO1 stops"),
    ] {
        let wrong = format!("{wrong}; after SYNC every 10 ms");
        assert_eq!(verdict(distances), (Verdict::Fail, wrong));
    }
}

#[test]
fn a_pdo_carries_just_the_values() {
    let case = |carries: &str, identifier: &str| {
        format!(
            "
  - case: carries
    title: Values
    cite: [book]
    effects: [disturbs-bus]
    steps:
      - sync:
      - expect-tpdo: {{identifier: \"{identifier}\", within: 100 ms, carries: {carries}}}
"
        )
    };
    let verdict = |carries, identifier| {
        play(after_syncs(&[1]), &case(carries, identifier))
            .verdict()
            .0
    };
    let bytes = "[{as: u8, value: 1}, {as: u8, value: 2}]";
    assert_eq!(verdict(bytes, "181"), Verdict::Pass);
    assert_eq!(verdict("{as: u16, value: 0x0201}", "181"), Verdict::Pass);
    assert_eq!(verdict("{as: u8, value: 1}", "181"), Verdict::Fail);
    assert_eq!(verdict("{as: u16, value: 0x0102}", "181"), Verdict::Fail);
    assert_eq!(verdict(bytes, "182"), Verdict::Fail);
}

const OPTIONAL: &str = "
  - case: optional
    title: Taken or refused
    cite: [book]
    effects: [writes]
    steps:
      - sdo-write: {object: \"2000:00\", as: u32, value: 9, expect: {abort: 0x06090030, or: ok}}
";

/// A node with 5 at 2000h that answers a write so, and stores it or not.
fn taking(answer: Option<&'static str>, stores: bool) -> Scripted {
    let mut memory = Memory::new(&[((0x2000, 0), [5, 0, 0, 0])]);
    Scripted::new(move |request: &Frame| {
        let writes = *request == frame("601#2300200009000000");
        match answer {
            Some(answer) if writes => {
                if stores {
                    memory.answer(request);
                }
                vec![soon(answer)]
            }
            _ => memory.answer(request),
        }
    })
}

#[test]
fn a_value_that_may_be_refused_must_be_taken_or_left() {
    let verdict = |answer, stores| {
        let played = Setup::default().play(taking(answer, stores), OPTIONAL);
        played.case().verdict
    };
    let (done, refused) = ("581#6000200000000000", "581#8000200030000906");
    assert_eq!(verdict(None, true), Verdict::Pass);
    assert_eq!(verdict(Some(refused), false), Verdict::Pass);
    assert_eq!(verdict(Some(done), false), Verdict::Fail);
    assert_eq!(
        verdict(Some("581#8000200000000206"), false),
        Verdict::Fail,
        "another abort code"
    );
    let stored = Setup::default().play(taking(Some(refused), true), OPTIONAL);
    assert_eq!(
        stored.case().failures[0].what,
        "2000h:00 does not hold what the answer to the write said: \
         09 00 00 00, and not 05 00 00 00, for it was refused"
    );
}
