//! Slips of the keyboard in names: a letter too many, one too few, or two that changed places.

use super::super::{Eds, Finding, rules};

/// Words of the names in CiA 301, 402 and 406, sorted. Left out is what a slip turns into another word (`angle`,
/// `transmit`), and what other languages write almost alike (`object`, `default`).
const WORDS: [&str; 86] = [
    "absolute",
    "acceleration",
    "access",
    "actual",
    "address",
    "alarm",
    "capture",
    "command",
    "communication",
    "configuration",
    "consumer",
    "control",
    "controlword",
    "counter",
    "current",
    "deceleration",
    "description",
    "device",
    "digital",
    "direction",
    "emergency",
    "encoder",
    "entries",
    "external",
    "feedback",
    "frequency",
    "function",
    "guard",
    "hardware",
    "heartbeat",
    "highest",
    "identifier",
    "identity",
    "inhibit",
    "input",
    "interpolation",
    "inverter",
    "length",
    "lowest",
    "manufacturer",
    "mapped",
    "mapping",
    "maximum",
    "message",
    "minimum",
    "module",
    "number",
    "operation",
    "output",
    "overload",
    "parameter",
    "period",
    "polarity",
    "position",
    "producer",
    "profile",
    "protocol",
    "receive",
    "received",
    "register",
    "reserved",
    "resolution",
    "response",
    "restore",
    "revision",
    "serial",
    "signal",
    "software",
    "standard",
    "status",
    "statusword",
    "supported",
    "switch",
    "synchronous",
    "target",
    "temperature",
    "threshold",
    "timeout",
    "torque",
    "transmission",
    "value",
    "velocity",
    "vendor",
    "version",
    "voltage",
    "warning",
];

/// A shorter word is too like too many others.
const SHORTEST_LETTERS: usize = 5;

pub(super) fn check(eds: &Eds, findings: &mut Vec<Finding>) {
    for object in eds.dictionary.objects() {
        name(eds, &object.name, object.line, findings);
        for entry in object.entries.values() {
            if entry.line != object.line {
                name(eds, &entry.name, entry.line, findings);
            }
        }
    }
}

fn name(eds: &Eds, name: &str, line: usize, findings: &mut Vec<Finding>) {
    for written in words(name) {
        if let Some(word) = meant(&written.to_ascii_lowercase()) {
            findings.push(Finding::new(
                &rules::MISSPELT,
                eds.line_of(line, "ParameterName"),
                format!("`{written}` in the name `{name}` is almost `{word}`"),
                format!("write `{word}` if that is meant"),
            ));
        }
    }
}

/// The words of `name`, those of `NumberOfEntries` too; none with letters beyond A to Z.
fn words(name: &str) -> impl Iterator<Item = &str> {
    name.split(|letter: char| !letter.is_alphabetic())
        .filter(|run| run.is_ascii())
        .flat_map(|run| {
            let mut rest = run;
            std::iter::from_fn(move || {
                let mut letters = rest.char_indices().skip(1);
                let mut before_is_small = rest.starts_with(|first: char| first.is_lowercase());
                let end = letters.find_map(|(at, letter)| {
                    let starts = before_is_small && letter.is_uppercase();
                    before_is_small = letter.is_lowercase();
                    starts.then_some(at)
                });
                let (word, after) = rest.split_at(end.unwrap_or(rest.len()));
                rest = after;
                (!word.is_empty()).then_some(word)
            })
        })
        .filter(|word| word.len() >= SHORTEST_LETTERS)
}

/// The known word that `written`, in small letters, is a slip of.
fn meant(written: &str) -> Option<&'static str> {
    let first = written.get(..1)?;
    let start = WORDS.partition_point(|word| *word < first);
    let alike = WORDS.get(start..)?;
    let mut alike = alike.iter().take_while(|word| word.starts_with(first));
    // An ending is no slip, so a word with another ending is looked at too.
    if alike.clone().any(|word| *word == written) {
        return None;
    }
    alike.find(|word| is_slip(written, word)).copied()
}

/// Whether one letter that is not the last was added or lost, or two neighbours changed places.
fn is_slip(written: &str, word: &str) -> bool {
    let same = |pair: &(u8, u8)| pair.0 == pair.1;
    let before = written.bytes().zip(word.bytes()).take_while(same).count();
    let backwards = written.bytes().rev().zip(word.bytes().rev());
    let after = backwards.take_while(same).count();
    let shorter = written.len().min(word.len());
    match written.len().abs_diff(word.len()) {
        1 => after > 0 && before + after >= shorter,
        0 => {
            let swapped = |text: &str| text.as_bytes().get(before..before + 2).map(<[u8]>::to_vec);
            let reversed = swapped(word).map(|pair| pair.into_iter().rev().collect());
            before + after + 2 == shorter && swapped(written) == reversed
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::{WORDS, meant, words};

    #[test]
    fn list_is_sorted() {
        assert!(WORDS.is_sorted());
        assert!(WORDS.iter().all(|word| meant(word).is_none()));
    }

    #[test]
    fn slips_are_found() {
        for (written, word) in [
            ("intput", "input"),
            ("functiion", "function"),
            ("paramter", "parameter"),
            ("lenght", "length"),
            ("recieve", "receive"),
            ("acces", "access"),
            ("gaurd", "guard"),
            ("threshhold", "threshold"),
        ] {
            assert_eq!(meant(written), Some(word), "{written}");
        }
    }

    #[test]
    fn other_words_and_other_endings_are_not() {
        for written in [
            "inputs",
            "functions",
            "functional",
            "valve",
            "identify",
            "resister",
            "interval",
            "commands",
            "commander",
            "profil",
            "temperatur",
            "controller",
            "phase",
            "setting",
            "phrase",
            "devise",
            "numbers",
            "",
            "vendors",
            "signals",
        ] {
            assert_eq!(meant(written), None, "{written}");
        }
    }

    #[test]
    fn names_are_split() {
        let split = |name| words(name).collect::<Vec<_>>();
        assert_eq!(
            split("NumberOfEntries 2x_Value"),
            ["Number", "Entries", "Value"]
        );
        assert_eq!(split("COB-ID SYNC message"), ["message"]);
        assert_eq!(
            split("Operación OUTPUT outputLevel"),
            ["OUTPUT", "output", "Level"]
        );
    }
}
