//! The lists of worked examples: complete, and every line right in itself.

mod claim;

use std::collections::BTreeSet;

/// A line of a list.
struct Example<'a> {
    id: &'a str,
    printed: bool,
    kind: &'a str,
    what: &'a str,
    as_printed: Option<&'a str>,
    claim: Option<&'a str>,
}

/// Name, text, examples, examples that the manual prints.
const LISTS: [(&str, &str, usize, usize); 4] = [
    (
        "huacheng",
        include_str!("../../../fixtures/devices/huacheng-ssts1/worked-examples.txt"),
        59,
        39,
    ),
    (
        "encoder",
        include_str!("../../../fixtures/devices/liaomiao-encoder/worked-examples.txt"),
        127,
        127,
    ),
    (
        "kinco",
        include_str!("../../../fixtures/devices/kinco-servo/worked-examples.txt"),
        64,
        38,
    ),
    (
        "teco",
        include_str!("../../../fixtures/devices/teco-jn5-cm-can/worked-examples.txt"),
        117,
        71,
    ),
];

/// What is wrong with the line, if it is no example.
fn example(line: &str) -> Result<Example<'_>, String> {
    let columns: Vec<&str> = line.split(" | ").collect();
    let (fixed, claim) = match columns.as_slice() {
        [fixed @ .., claim] if columns.len() == 8 => (fixed, Some(*claim)),
        fixed => (fixed, None),
    };
    let [id, _section, origin, kind, what, as_printed, description] = fixed else {
        return Err(format!("{} columns: {line}", columns.len()));
    };
    if id.is_empty() || description.len() < 3 || !["printed", "derived"].contains(origin) {
        return Err(format!("incomplete: {line}"));
    }
    Ok(Example {
        id,
        printed: *origin == "printed",
        kind,
        what,
        as_printed: (*as_printed != "-").then_some(*as_printed),
        claim,
    })
}

fn examples(text: &str) -> impl Iterator<Item = Result<Example<'_>, String>> {
    text.lines()
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
        .map(example)
}

fn bytes(digits: &str) -> Option<Vec<u8>> {
    let pair = |at| u8::from_str_radix(digits.get(at..at + 2)?, 16).ok();
    (0..digits.len()).step_by(2).map(pair).collect()
}

/// A frame in can-utils notation with an 11-bit identifier.
fn is_can(text: &str) -> bool {
    text.split_once('#').is_some_and(|(id, data)| {
        id.len() == 3
            && u16::from_str_radix(id, 16).is_ok_and(|id| id <= 0x7FF)
            && (data == "R" || bytes(data).is_some_and(|data| data.len() <= 8))
    })
}

/// A frame with `??` for any byte, or the layout of the SSI frame.
fn is_template(text: &str) -> bool {
    text.contains("??") && is_can(&text.replace("??", "00")) || text == "D32 .. D1 S1 S0"
}

fn is_values(text: &str) -> bool {
    text.split(", ").all(|pair| {
        pair.split_once('=').is_some_and(|(name, value)| {
            let number = match value.strip_prefix("0x") {
                Some(digits) => u64::from_str_radix(digits, 16),
                None => value.parse(),
            };
            !name.is_empty() && number.is_ok()
        })
    })
}

/// Whether a Modbus frame ends in its CRC-16, low byte first.
fn has_right_crc(text: &str) -> Option<bool> {
    let frame = bytes(&text.replace(' ', ""))?;
    let (body, crc) = frame.split_last_chunk::<2>()?;
    let computed = body.iter().fold(0xFFFF_u16, |crc, byte| {
        (0..8).fold(crc ^ u16::from(*byte), |crc, _| {
            if crc & 1 == 1 {
                crc >> 1 ^ 0xA001
            } else {
                crc >> 1
            }
        })
    });
    Some(*crc == computed.to_le_bytes())
}

#[test]
fn nothing_is_missing() {
    let mut total = 0;
    for (name, text, expected, expected_printed) in LISTS {
        let list: Vec<Example<'_>> = examples(text).collect::<Result<_, _>>().unwrap();
        let ids: BTreeSet<&str> = list.iter().map(|example| example.id).collect();
        assert_eq!((list.len(), ids.len()), (expected, expected), "{name}");
        let printed = list.iter().filter(|example| example.printed).count();
        assert_eq!(printed, expected_printed, "{name}");
        total += list.len();
    }
    assert_eq!(total, 367);
}

#[test]
fn every_line_is_of_its_kind() {
    for example in LISTS.iter().flat_map(|(_, text, _, _)| examples(text)) {
        let Example {
            id,
            kind,
            what,
            as_printed,
            ..
        } = example.unwrap();
        match kind {
            "can" => assert!(is_can(what) && as_printed.is_none_or(is_can), "{id}"),
            "template" => assert!(is_template(what), "{id}"),
            "value" => assert!(is_values(what), "{id}"),
            "modbus" => assert_eq!(has_right_crc(what), Some(true), "{id}"),
            "arithmetic" => assert_eq!(claim::is_right(what), Ok(true), "{id}"),
            other => panic!("{id}: {other}"),
        }
    }
}

#[test]
fn claims_of_frames_and_values_are_right() {
    let mut claims = 0;
    for example in LISTS.iter().flat_map(|(_, text, _, _)| examples(text)) {
        let example = example.unwrap();
        if let Some(claim) = example.claim {
            assert_eq!(claim::is_right(claim), Ok(true), "{}", example.id);
            claims += 1;
        }
    }
    assert_eq!(claims, 38);
}

#[test]
fn what_the_manuals_print_wrong() {
    let wrong: Vec<(&str, &str)> = LISTS
        .iter()
        .flat_map(|(_, text, _, _)| examples(text))
        .map(Result::unwrap)
        .filter_map(|example| Some((example.id, example.as_printed?)))
        .collect();
    assert_eq!(
        wrong,
        [
            ("M5", "01 10 01 45 00 02 04 03 E8 07 D0 89 EC"),
            ("M7", "01 06 01 45 27 10 99 5D"),
            ("lss-inq-9", "7E4#5B01000000000000"),
        ]
    );
    assert_eq!(has_right_crc(wrong[0].1), Some(false));
    assert_eq!(has_right_crc(wrong[1].1), Some(false));
}
