//! The EDS files that are ours, held against what the manuals print: they agree but for what is listed here with its
//! reason, and what a manual does not print is marked so in the EDS.

use std::collections::{BTreeMap, BTreeSet};

use fieldproof_dictionary::eds::manual::{self, Table};
use fieldproof_dictionary::eds::{self, Eds};

/// An EDS, the table of its manual, and where they differ: code, entry, why the EDS says otherwise.
struct Claims {
    name: &'static str,
    eds: &'static str,
    table: &'static str,
    explained: &'static [(&'static str, &'static str, &'static str)],
}

macro_rules! claims {
    ($folder:literal, $explained:expr) => {
        Claims {
            name: $folder,
            eds: include_str!(concat!(
                "../../../fixtures/devices/",
                $folder,
                "/",
                $folder,
                ".eds"
            )),
            table: include_str!(concat!(
                "../../../fixtures/devices/",
                $folder,
                "/manual.objects"
            )),
            explained: $explained,
        }
    };
}

const CLAIMS: [Claims; 3] = [
    claims!(
        "liaomiao-encoder",
        &[
            (
                "E093",
                "1003:00",
                "writing 0 clears it, so it cannot be ro as the whole object is printed",
            ),
            (
                "E094",
                "1018:01",
                "the LSS frames of the manual carry 0x63C"
            ),
            ("E094", "1018:02", "the LSS frames of the manual carry 1"),
            (
                "E094",
                "1018:04",
                "each unit has its own; the LSS frames carry 241000888",
            ),
            (
                "E094",
                "3000:00",
                "it is the node-ID that the unit has; the manual prints the one it comes with",
            ),
        ]
    ),
    claims!("kinco-servo", &[]),
    claims!(
        "huacheng-ssts1",
        &[
            ("E090", "6068:00", "type and unit are those of 606Bh"),
            ("E091", "606B", "printed as 6068h"),
            ("E092", "607F:00", "UNSIGNED32 in CiA 402, of the same size"),
        ]
    ),
];

impl Claims {
    fn read(&self) -> (Eds, Table) {
        let table = Table::parse(self.table).unwrap_or_default();
        assert!(!table.is_empty(), "{}", self.name);
        (eds::read(self.eds), table)
    }

    /// Whether the manual prints the entry, under another index even.
    fn prints(&self, table: &Table, index: u16, sub: u8) -> bool {
        let elsewhere = format!("{index:04X}");
        table.row(index, sub).is_some()
            || self
                .explained
                .iter()
                .any(|(code, entry, _)| *code == "E091" && *entry == elsewhere)
    }

    /// The objects and entries whose sections have `; not in the manual` above them; objects are without sub-index.
    fn marked(&self) -> BTreeSet<(u16, Option<u8>)> {
        let mut marked = BTreeSet::new();
        let mut mark = false;
        for line in self.eds.lines().map(str::trim) {
            if line == "; not in the manual" {
                mark = true;
            } else if let Some(name) = line
                .strip_prefix('[')
                .and_then(|line| line.strip_suffix(']'))
            {
                let (index, sub) = match name.split_once("sub") {
                    Some((index, sub)) => (index, u8::from_str_radix(sub, 16).ok()),
                    None => (name, None),
                };
                if let (true, Ok(index)) = (mark, u16::from_str_radix(index, 16)) {
                    marked.insert((index, sub));
                }
                mark = false;
            } else if !line.starts_with(';') {
                mark = false;
            }
        }
        marked
    }
}

#[test]
fn our_files_agree_with_the_manuals_but_for_what_is_explained() {
    for claims in &CLAIMS {
        let (eds, table) = claims.read();
        let mut explained: BTreeMap<(&str, &str), &str> = BTreeMap::new();
        for (code, entry, why) in claims.explained {
            explained.insert((code, entry), why);
        }
        for difference in manual::compare(&eds, &table) {
            let finding = &difference.finding;
            let known = explained
                .keys()
                .find(|(code, entry)| *code == finding.rule.code && finding.text.contains(entry))
                .copied();
            match known {
                Some(known) => drop(explained.remove(&known)),
                // What the manual does not print is looked at below, entry by entry.
                None => assert_eq!(finding.rule.code, "E091", "{}: {finding:?}", claims.name),
            }
        }
        assert!(
            explained.is_empty(),
            "{}: {explained:?} is no more",
            claims.name
        );
    }
}

#[test]
fn an_entry_is_in_the_manual_or_marked_as_not_in_it() {
    for claims in &CLAIMS {
        let (eds, table) = claims.read();
        let marked = claims.marked();
        assert!(!marked.is_empty(), "{}", claims.name);
        for object in eds.dictionary.objects() {
            let subs: Vec<u8> = object.entries.keys().copied().collect();
            let has_sections = subs != [0];
            let mut any = false;
            for sub in subs {
                let printed = claims.prints(&table, object.index, sub);
                any |= printed;
                let place = (object.index, has_sections.then_some(sub));
                assert_eq!(
                    marked.contains(&place),
                    !printed,
                    "{} {:04X}:{sub:02X}: marked and not printed go together",
                    claims.name,
                    object.index
                );
            }
            assert_eq!(
                marked.contains(&(object.index, None)),
                !any,
                "{} [{:04X}]",
                claims.name,
                object.index
            );
        }
    }
}
