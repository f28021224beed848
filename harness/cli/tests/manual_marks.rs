//! An object that a manual does not print is never cited to it: a case that judges such an object cites something else
//! beside the manual.

#![allow(clippy::unwrap_used, reason = "a test may fail this way")]

use std::fs;
use std::path::{Path, PathBuf};

use fieldproof_dictionary::eds::manual::Table;
use fieldproof_dictionary::{Dictionary, eds};
use fieldproof_suite::model::{Case, Located, ReadExpectation, SdoObject, Step, WriteExpectation};
use fieldproof_suite::{Environment, SourceFile, load};

/// Each device with its EDS and how its suites call the documents that are its manual.
const DEVICES: [(&str, &str, &str); 4] = [
    ("huacheng-ssts1", "huacheng-ssts1.eds", "huacheng"),
    ("kinco-servo", "kinco-servo.eds", "kinco"),
    ("liaomiao-encoder", "liaomiao-encoder.eds", "liaomiao"),
    ("teco-jn5-cm-can", "TECO_510_CAN.eds", "teco"),
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn cases(device: &str) -> Vec<Case> {
    let mut files: Vec<SourceFile> = fs::read_dir(root().join("suites/devices").join(device))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "yaml"))
        .map(|path| SourceFile {
            path: path.display().to_string(),
            text: fs::read_to_string(path).unwrap(),
        })
        .collect();
    files.sort_by(|one, other| one.path.cmp(&other.path));
    let any = Environment {
        node: Some(1),
        address: Some(1),
        ..Environment::default()
    };
    load(&files)
        .suites
        .iter()
        .flat_map(|suite| {
            let lowered: Vec<Case> = suite
                .cases()
                .map(|case| case.lower(&any).unwrap())
                .collect();
            lowered
        })
        .collect()
}

/// The objects of which `steps` expect something: a value, or a refusal.
fn judged(steps: &[Located<Step>]) -> Vec<(u16, u8)> {
    let mut objects = Vec::new();
    for step in steps {
        match &step.value {
            Step::SdoRead(read) if read.expect != ReadExpectation::Any => {
                objects.extend(address(read.object));
            }
            Step::SdoWrite(write) if write.expect != WriteExpectation::Ok => {
                objects.extend(address(write.object));
            }
            Step::Repeat(repeat) => objects.extend(judged(&repeat.steps)),
            _ => {}
        }
    }
    objects
}

fn address(object: SdoObject) -> Option<(u16, u8)> {
    match object {
        SdoObject::Address(address) => Some((address.index, address.sub)),
        SdoObject::WritableDomain => None,
    }
}

/// The objects that `case` judges, that the EDS has and the manual does not print, if it cites the manual alone.
fn cited_wrongly(
    case: &Case,
    manual: &str,
    table: &Table,
    dictionary: &Dictionary,
) -> Vec<(u16, u8)> {
    if case.cites.iter().any(|citation| citation.source != manual) {
        return Vec::new();
    }
    let mut objects = judged(&case.steps);
    objects.retain(|(index, sub)| {
        dictionary.entry(*index, *sub).is_some() && table.row(*index, *sub).is_none()
    });
    objects
}

#[test]
fn what_a_manual_does_not_print_is_not_cited_to_it() {
    let (mut of_the_manual_alone, mut judging_what_it_lacks) = (0, 0);
    for (device, file, manual) in DEVICES {
        let folder = root().join("fixtures/devices").join(device);
        let table = Table::parse(&fs::read_to_string(folder.join("manual.objects")).unwrap());
        let table = table.unwrap();
        let dictionary = eds::read(&fs::read_to_string(folder.join(file)).unwrap()).dictionary;
        for mut case in cases(device) {
            assert_eq!(
                cited_wrongly(&case, manual, &table, &dictionary),
                [],
                "{} cites the manual alone for what it does not print",
                case.id
            );
            let alone = case.cites.iter().all(|citation| citation.source == manual);
            of_the_manual_alone += usize::from(alone);
            // The same case with nothing beside the manual would be found.
            case.cites.retain(|citation| citation.source == manual);
            let lacking = cited_wrongly(&case, manual, &table, &dictionary);
            judging_what_it_lacks += usize::from(!lacking.is_empty());
        }
    }
    assert!(of_the_manual_alone > 0);
    assert!(judging_what_it_lacks > 0);
}
