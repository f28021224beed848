//! Block transfers against a server that is right or wrong in one thing.

use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_record::Verdict;

use crate::scripted::{Scripted, Setup, frame, soon};

const READ: &str = "
  - case: read
    title: Reads the name
    cite: [book]
    steps:
      - sdo-read: {object: \"1008:00\", as: text, transfer: block, expect: eight by}
";

/// Answers a block upload of `eight by`, the answers changed as `changes` say.
fn server(changes: &'static [(&'static str, &'static str)]) -> Scripted {
    Scripted::new(move |request: &Frame| {
        let answers: &[&str] = match request.to_string().as_str() {
            "601#A40810007F000000" => &["581#C608100008000000"],
            "601#A300000000000000" => &["581#0165696768742062", "581#8279000000000000"],
            "601#A2027F0000000000" => &["581#D9CC5D0000000000"],
            _ => &[],
        };
        let changed = answers.iter().map(|answer| {
            let change = changes.iter().find(|(old, _)| old == answer);
            change.map_or(*answer, |(_, new)| *new)
        });
        changed
            .filter(|answer| !answer.is_empty())
            .enumerate()
            .map(|(place, answer)| {
                (
                    soon(answer).0 + Duration::from_micros(place as u64),
                    frame(answer),
                )
            })
            .collect()
    })
}

#[test]
fn a_right_upload_passes_and_a_wrong_one_says_what_is_wrong() {
    let right = Setup::default().play(server(&[]), READ);
    assert_eq!(right.verdict(), (Verdict::Pass, ""));
    let wrong: [(&'static [(&str, &str)], &str); 6] = [
        (
            &[("581#D9CC5D0000000000", "581#D9CD5D0000000000")],
            "the CRC of the upload is wrong: 5DCDh, and not 5DCCh",
        ),
        (
            &[("581#D9CC5D0000000000", "581#D5CC5D0000000000")],
            "the blocks do not carry as many bytes as the server announced: 9 bytes, and not 8 bytes",
        ),
        (
            &[("581#8279000000000000", "581#8379000000000000")],
            "the segments of the block are not in order: segment 3 (581#8379000000000000), and not segment 2",
        ),
        (
            &[("581#8279000000000000", "")],
            "the SDO server stops within a block",
        ),
        (
            &[("581#8279000000000000", "581#8008100000000405")],
            "reading 1008h:00 is refused: 05040000h (SDO transfer timed out)",
        ),
        (
            &[("581#C608100008000000", "581#C609100008000000")],
            "the answer to the read names another object: 1009h:00, and not 1008h:00",
        ),
    ];
    for (changes, what) in wrong {
        let played = Setup::default().play(server(changes), READ);
        assert_eq!(played.verdict(), (Verdict::Fail, what));
    }
}
