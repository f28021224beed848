//! Any bytes as an EDS file: reader, checker and writer do not panic, every finding is in a line of the file, and what
//! was read can be written and reads to the same.
#![no_main]

use fieldproof_dictionary::Object;
use fieldproof_dictionary::eds::{self, Eds};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let text = eds::decode(bytes);
    let first = eds::read(&text);
    let lines = text.lines().count().max(1);
    for finding in eds::check(&first) {
        assert!((1..=lines).contains(&finding.line), "{finding:?}");
    }
    let written = eds::write(&first);
    let again = eds::read(&written);
    assert_eq!(objects(&first), objects(&again));
    assert_eq!(first.device_info, again.device_info);
    assert_eq!(node(&first), node(&again));
    assert!(again.strays.is_empty());
    assert_eq!(eds::write(&again), written);
});

/// The objects without the lines they stand in.
fn objects(eds: &Eds) -> Vec<Object> {
    let mut objects: Vec<Object> = eds.dictionary.objects().cloned().collect();
    for object in &mut objects {
        object.line = 0;
        object.entries.values_mut().for_each(|entry| entry.line = 0);
    }
    objects
}

/// What a DCF says of its node, without the line.
fn node(eds: &Eds) -> Option<eds::Commissioning> {
    let node = eds.commissioning.clone()?;
    Some(eds::Commissioning { line: 0, ..node })
}
