//! Tables and chosen things that only the description of a device can fill: `choose`, and `each` with a query.
//!
//! Until it is known which device is tested a sample stands for what it will give, so that the case can be read and
//! checked.

use std::collections::BTreeSet;
use std::sync::Arc;

use serde::Deserialize;

use super::{CaseTemplate, Suite};
use crate::Position;
use crate::code;
use crate::expand::{BENCH_NAMES, Scope, is_name};
use crate::model::{Query, QueryKind, TypeWord};
use crate::node::{Entry, Key, Kind, Node};
use crate::problem::Problem;
use crate::read::Reader;

/// The columns that one thing gives: what follows the name (`-type`; nothing for the thing itself), and the text.
pub type Columns = Vec<(&'static str, String)>;

/// A `choose`, or an `each` with a query.
#[derive(Debug, Clone)]
pub(super) struct Filling {
    name: String,
    query: Query,
    at: Position,
    /// A row for each, and not only the first.
    every: bool,
}

impl Suite {
    /// Whether cases of it wait for the description of a device.
    pub fn is_open(&self) -> bool {
        self.cases.iter().any(CaseTemplate::is_open)
    }

    /// The suite with everything in its tables that `find` finds in the description of a device. A case for which there
    /// is nothing remains, and says so ([`super::CaseRef::absent`]).
    #[must_use]
    pub fn filled(&self, find: &dyn Fn(&Query) -> Vec<Columns>) -> Suite {
        if !self.is_open() {
            return self.clone();
        }
        let filled = |template: &CaseTemplate| {
            let mut template = template.clone();
            template.fill(find);
            template
        };
        Suite {
            cases: self.cases.iter().map(filled).collect(),
            ..self.clone()
        }
    }
}

impl CaseTemplate {
    pub(super) fn is_open(&self) -> bool {
        self.open && !self.fillings.is_empty()
    }

    /// Whether it is one case in place of those that the description of a device would give.
    pub(super) fn stands_for_many(&self) -> bool {
        let unfilled = self.open || self.absent.is_some();
        unfilled && self.fillings.iter().any(|filling| filling.every)
    }

    /// Reads what is chosen and what fills the table; a sample stands for it.
    pub(super) fn read_fillings(
        &mut self,
        choose: Option<&Entry>,
        each: Option<&Entry>,
        problems: &mut Vec<Problem>,
    ) {
        let chosen = choose.map(|entry| (entry, false));
        for (entry, every) in chosen.into_iter().chain(each.map(|entry| (entry, true))) {
            match read_queries(entry, every) {
                Ok(fillings) => self.fillings.extend(fillings),
                Err(problem) => {
                    problems.push(*problem);
                    self.without_rows = true;
                    return;
                }
            }
        }
        if self.fillings.is_empty() {
            return;
        }
        self.open = true;
        if self.rows.is_empty() {
            self.rows.push(Node {
                at: self.at,
                kind: Kind::Map(Vec::new()),
            });
        }
        for filling in &self.fillings {
            let cells = cells(filling, sample(&filling.query));
            for row in &mut self.rows {
                if let Kind::Map(entries) = &mut row.kind {
                    let taken = entries
                        .iter()
                        .find(|entry| cells.iter().any(|cell| cell.key.text == entry.key.text));
                    if let Some(taken) = taken {
                        let message = format!("there is already a column `{}`", taken.key.text);
                        let problem = Problem::new(code::NAME, message, "a second time");
                        problems.push(*problem.at(filling.at).also(taken.key.at, "the column"));
                        return;
                    }
                    entries.extend(cells.clone());
                }
            }
        }
    }

    /// The columns that only a description fills, all beginning with one of these names.
    pub(super) fn filled_names(&self) -> impl Iterator<Item = (&str, Position)> {
        self.fillings
            .iter()
            .map(|filling| (filling.name.as_str(), filling.at))
    }

    fn fill(&mut self, find: &dyn Fn(&Query) -> Vec<Columns>) {
        if !self.is_open() {
            return;
        }
        self.open = false;
        let sampled: BTreeSet<String> = self
            .fillings
            .iter()
            .flat_map(|filling| cells(filling, sample(&filling.query)))
            .map(|cell| cell.key.text.to_string())
            .collect();
        for row in &mut self.rows {
            if let Kind::Map(entries) = &mut row.kind {
                entries.retain(|entry| !sampled.contains(entry.key.text.as_ref()));
            }
        }
        for filling in self.fillings.clone() {
            let mut found = find(&filling.query);
            if !filling.every {
                found.truncate(1);
            }
            if found.is_empty() {
                self.absent = Some(format!("the device has no {}", filling.query));
                return;
            }
            let rows = std::mem::take(&mut self.rows);
            for row in rows {
                let with = |columns: &Columns| {
                    let mut row = row.clone();
                    if let Kind::Map(entries) = &mut row.kind {
                        entries.extend(cells(&filling, columns.clone()));
                    }
                    row
                };
                self.rows.extend(found.iter().map(with));
            }
        }
    }
}

fn read_queries(entry: &Entry, every: bool) -> Result<Vec<Filling>, Box<Problem>> {
    let entries = entry.value.entries();
    if entries.is_empty() || (every && entries.len() > 1) {
        let message = match every {
            true => "a table is filled from one query",
            false => "nothing is chosen",
        };
        let label = "expected a name and what it stands for: `{object: {access: ro}}`";
        return Err(Problem::new(code::TABLE, message, label).at(entry.value.at));
    }
    let read = |one: &Entry| {
        let name = one.key.text.as_ref();
        if !is_name(name) || BENCH_NAMES.contains(&name) {
            let message = format!("what a device gives cannot be named `{name}`");
            let label = "expected a word of letters, digits, `_` and `-`";
            return Err(Problem::new(code::NAME, message, label).at(one.key.at));
        }
        let scope = Scope::default();
        let reader = Reader::new(&one.value, &scope, one.key.at);
        let query = Query::deserialize(reader).map_err(|error| error.0)?;
        Ok(Filling {
            name: name.to_owned(),
            query,
            at: one.key.at,
            every,
        })
    };
    entries.iter().map(read).collect()
}

fn cells(filling: &Filling, columns: Columns) -> Vec<Entry> {
    let cell = |(suffix, text): (&'static str, String)| Entry {
        key: Key {
            text: Arc::from(format!("{}{suffix}", filling.name)),
            at: filling.at,
        },
        value: Node {
            at: filling.at,
            kind: Kind::Text(text.into_boxed_str()),
        },
    };
    columns.into_iter().map(cell).collect()
}

/// What a device could give. What the query does not ask for is not there, for it may be missing then.
fn sample(query: &Query) -> Columns {
    let text = |text: &str| text.to_owned();
    match query.is {
        QueryKind::Object => sample_object(query),
        QueryKind::AbsentObject | QueryKind::AbsentSubIndex => vec![
            ("", text("2000:00")),
            ("-index", text("0x2000")),
            ("-sub", text("0")),
        ],
        QueryKind::BitRate | QueryKind::OtherBitRate => vec![
            ("", text("250 kbit/s")),
            ("-index", text("3")),
            ("-before", text("500 kbit/s")),
            ("-before-index", text("2")),
        ],
        QueryKind::Tpdo | QueryKind::Rpdo => vec![
            ("", text("1")),
            ("-communication", text("1800")),
            ("-mapping", text("1A00")),
            ("-identifier", text("181")),
            ("-length", text("8")),
        ],
        QueryKind::Register => sample_register(query),
        QueryKind::Hole => vec![("", text("1")), ("-table", text("holding"))],
        QueryKind::Function => vec![("", text("65"))],
    }
}

fn sample_register(query: &Query) -> Columns {
    let text = |text: &str| text.to_owned();
    let mut columns = vec![
        ("", text("1")),
        ("-name", text("a name")),
        ("-table", text("holding")),
        ("-type", text("u16")),
        ("-access", text("rw")),
        ("-count", text("1")),
        ("-last", text("1")),
    ];
    let said = || query.has.iter().filter_map(|has| has.column());
    columns.extend(said().map(|suffix| (suffix, text("1"))));
    let of_last = said().filter_map(|suffix| match suffix {
        "-low" => Some("-last-low"),
        "-high" => Some("-last-high"),
        "-below" => Some("-last-below"),
        "-above" => Some("-last-above"),
        _ => None,
    });
    columns.extend(of_last.map(|suffix| (suffix, text("1"))));
    columns
}

fn sample_object(query: &Query) -> Columns {
    let word = query.types.first().copied().unwrap_or(TypeWord::U8);
    let number = match word.as_word() {
        "text" => "text",
        "bytes" => "00 11",
        _ => "1",
    };
    let mut columns = vec![
        ("", "2000:00".to_owned()),
        ("-index", "0x2000".to_owned()),
        ("-sub", "0".to_owned()),
        ("-name", "a name".to_owned()),
        ("-type", word.as_word().to_owned()),
        ("-access", "rw".to_owned()),
        ("-size", "1".to_owned()),
        ("-bits", "8".to_owned()),
        ("-mapping", "0x20000008".to_owned()),
    ];
    let said = query.has.iter().filter_map(|has| has.column());
    columns.extend(said.map(|suffix| (suffix, number.to_owned())));
    columns
}
