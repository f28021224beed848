//! One row of one case into a [`Case`].

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};

use serde::Deserialize;

use super::{CaseRef, check};
use crate::code;
use crate::expand::{Environment, Scope, is_name, placeholders};
use crate::file::{CaseFile, CiteFile};
use crate::forms::{Either, OneOrMany};
use crate::identity::Claim;
use crate::model::{Case, Citation, Located, Restore, Source, Step};
use crate::node::{Kind, Node};
use crate::problem::{Problem, ReadError, with_nearest};
use crate::read::Reader;

/// The most values that are read for one case.
pub(super) const MOST_READS: u64 = 1_000_000;

/// `[from=operational,command=stop]`
pub(super) fn row_key(row: &Node, columns: &[String]) -> String {
    let pairs: Vec<String> = columns
        .iter()
        .map(|column| {
            let text = row.get(column).and_then(Node::text).unwrap_or_default();
            format!("{column}={}", in_id(text))
        })
        .collect();
    format!("[{}]", pairs.join(","))
}

/// Without spaces and without what separates the parts of an id.
fn in_id(text: &str) -> String {
    text.chars()
        .filter(|c| !c.is_whitespace() && !c.is_control())
        .map(|c| if "[],=/\"".contains(c) { '_' } else { c })
        .collect()
}

/// The case, or everything that is wrong with it.
///
/// `reads` is how much may still be read; see [`Scope`].
pub(super) fn read<'a>(
    case: CaseRef<'a>,
    environment: &Environment,
    reads: &'a Cell<u64>,
) -> Result<Case, Vec<Problem>> {
    let body = &case.template.body;
    let mut problems = Vec::new();
    let mut scope = Scope {
        row: case.row,
        environment: *environment,
        reads: Some(reads),
        ..Scope::default()
    };
    let file = CaseFile::deserialize(Reader::new(body, &scope, case.template.at));
    let mut steps = Steps {
        scope: &mut scope,
        problems: &mut problems,
    };
    for part in ["control", "steps"] {
        steps.expect_saves(body.get(part));
    }
    let control = steps.read(body.get("control"));
    let test = steps.read(body.get("steps"));
    let restore = steps.read(body.get("restore").and_then(|restore| restore.get("steps")));
    let file = match file {
        Ok(file) => file,
        Err(error) => {
            problems.insert(0, *error.0);
            return Err(problems);
        }
    };
    let head = &case.suite.head;
    let lowered = Case {
        id: case.id(),
        written_id: case.written_id(),
        title: file.title,
        cites: citations(&head.sources, file.cite, &mut problems),
        against: citations(&head.sources, file.against, &mut problems),
        because: file.because,
        examples: file.examples.0,
        needs: file.needs.0.into_iter().map(|need| need.0).collect(),
        claims: claims(body, case.row),
        effects: file.effects.0,
        depth: file.depth,
        covers: covers(file.covers),
        written_for: file.written_for,
        forbids: file.forbids.0,
        restore: Restore {
            objects: file.restore.objects,
            registers: file.restore.registers.into_iter().map(|it| it.0).collect(),
            coils: file.restore.coils.into_iter().map(|it| it.0).collect(),
            steps: restore,
        },
        control,
        steps: test,
        at: case.at(),
    };
    if problems.is_empty() {
        check::case(head, &lowered, case.template, &mut problems);
    }
    match problems.is_empty() {
        true => Ok(lowered),
        false => Err(problems),
    }
}

/// The numbers of the device's identity that stand in a case or in its row.
fn claims(body: &Node, row: Option<&Node>) -> Vec<Claim> {
    let mut names = BTreeSet::new();
    gather_names(body, &mut names);
    row.inspect(|row| gather_names(row, &mut names));
    let mut claims = Claim::NUMBERS.to_vec();
    claims.retain(|claim| names.contains(claim.name()));
    claims
}

fn gather_names<'a>(node: &'a Node, names: &mut BTreeSet<&'a str>) {
    match &node.kind {
        Kind::Empty => {}
        Kind::Text(text) => names.extend(placeholders(text).map(|it| it.name)),
        Kind::List(elements) => elements.iter().for_each(|it| gather_names(it, names)),
        Kind::Map(entries) => entries
            .iter()
            .for_each(|entry| gather_names(&entry.value, names)),
    }
}

fn covers(covers: BTreeMap<String, OneOrMany<String>>) -> Vec<(String, String)> {
    let entries = |(catalogue, entries): (String, OneOrMany<String>)| {
        let pair = move |entry| (catalogue.clone(), entry);
        entries.0.into_iter().map(pair)
    };
    covers.into_iter().flat_map(entries).collect()
}

pub(super) fn citations(
    known_sources: &BTreeMap<String, Source>,
    cites: OneOrMany<Located<Either<CiteFile>>>,
    problems: &mut Vec<Problem>,
) -> Vec<Citation> {
    let mut citations = Vec::new();
    for cite in cites.0 {
        let sections: Vec<(String, Vec<Option<String>>)> = match cite.value.0 {
            CiteFile::Source(source) => vec![(source, vec![None])],
            CiteFile::Sections(sections) => sections
                .into_iter()
                .map(|(source, sections)| (source, sections.0.into_iter().map(Some).collect()))
                .collect(),
        };
        for (short_name, sections) in sections {
            let Some(source) = known_sources.get(&short_name) else {
                let known: Vec<&str> = known_sources.keys().map(String::as_str).collect();
                let problem = Problem::new(
                    code::UNKNOWN_SOURCE,
                    format!("unknown source `{short_name}`"),
                    "not among the `sources` of this file",
                );
                problems.push(*with_nearest(problem.at(cite.at), &short_name, &known));
                continue;
            };
            for section in sections {
                citations.push(Citation {
                    source: short_name.clone(),
                    document: source.document.clone(),
                    section: section.or_else(|| source.section.clone()),
                });
            }
        }
    }
    citations
}

/// Reads steps one by one, so that each wrong one is found.
struct Steps<'s, 'a> {
    scope: &'s mut Scope<'a>,
    problems: &'s mut Vec<Problem>,
}

impl<'a> Steps<'_, 'a> {
    /// Takes note of the names that these steps will save.
    fn expect_saves(&mut self, steps: Option<&'a Node>) {
        for step in steps.map(Node::elements).unwrap_or_default() {
            let inside = step.entries().iter().map(|entry| &entry.value);
            for value in inside {
                let names = ["save", "count-as"].map(|key| value.get(key).and_then(Node::text));
                let names = names.into_iter().flatten().map(str::to_owned);
                self.scope.saved_later.extend(names);
                self.expect_saves(value.get("steps"));
            }
        }
    }

    fn read(&mut self, steps: Option<&'a Node>) -> Vec<Located<Step>> {
        let Some(list) = steps else {
            return Vec::new();
        };
        let Kind::List(elements) = &list.kind else {
            let message = format!("{} cannot stand here", list.kind_in_words());
            let problem = Problem::new(code::WRONG_SHAPE, message, "expected a list of steps");
            self.problems.push(*problem.at(list.at));
            return Vec::new();
        };
        if elements.is_empty() {
            let problem = Problem::new(code::EMPTY, "no steps", "expected at least one step");
            self.problems.push(*problem.at(list.at));
        }
        let mut steps = Vec::new();
        for element in elements {
            if let Err(problem) = self.scope.spend(1) {
                self.problems.push(*problem.at(element.at));
                break;
            }
            steps.extend(self.step(element));
        }
        steps
    }

    fn step(&mut self, node: &'a Node) -> Option<Located<Step>> {
        let [entry] = node.entries() else {
            self.problems.push(*not_a_step(node));
            return None;
        };
        let at = entry.key.at;
        match Step::deserialize(Reader::new(node, self.scope, at)) {
            Ok(mut value) => {
                self.save(&value, &entry.value);
                if let Step::Repeat(repeat) = &mut value {
                    repeat.steps = self.read(entry.value.get("steps"));
                }
                Some(Located { value, at })
            }
            Err(ReadError(mut problem)) => {
                if problem.at == Some(at) && problem.code == code::UNKNOWN_WORD {
                    problem.code = code::UNKNOWN_VERB;
                    problem.message = format!("unknown verb `{}`", entry.key.text);
                }
                self.problems.push(*problem);
                // What it would have saved counts as saved: one mistake, one diagnostic.
                let name = entry.value.get("save").and_then(Node::text);
                self.scope.saved.extend(name.map(str::to_owned));
                None
            }
        }
    }

    fn save(&mut self, step: &Step, inside: &Node) {
        let (name, key) = match step {
            Step::SdoRead(read) => (&read.save, "save"),
            Step::Modbus(modbus) => (&modbus.save, "save"),
            Step::Repeat(repeat) => (&repeat.count_as, "count-as"),
            _ => return,
        };
        let Some(name) = name else { return };
        let at = inside.get(key).map_or(inside.at, |node| node.at);
        let is_column = self.scope.row.is_some_and(|row| row.get(name).is_some());
        if !is_name(name) || is_column || crate::expand::BENCH_NAMES.contains(&name.as_str()) {
            let problem = Problem::new(
                code::NAME,
                format!("a value cannot be saved as `{name}`"),
                "expected a word of letters, digits, `_` and `-` that stands for nothing yet",
            );
            self.problems.push(*problem.at(at));
        }
        self.scope.saved.insert(name.clone());
    }
}

fn not_a_step(node: &Node) -> Box<Problem> {
    let label = "expected a map with one key, the verb";
    match (&node.kind, node.entries()) {
        (Kind::Text(word), _) => {
            let problem = Problem::new(code::NOT_A_STEP, "a step is a map, not a text", label);
            problem.at(node.at).help(format!("did you mean `{word}:`?"))
        }
        (_, [first, second, ..]) => {
            let message = format!(
                "a step has one key, and this has `{}` and `{}`",
                first.key.text, second.key.text
            );
            Problem::new(code::NOT_A_STEP, message, label)
                .at(second.key.at)
                .also(first.key.at, "the first key")
                .help(format!(
                    "what belongs to the verb stands inside it: `{}: {{..., {}: ...}}`",
                    first.key.text, second.key.text
                ))
        }
        (Kind::Map(_), _) => Problem::new(code::NOT_A_STEP, "an empty step", label).at(node.at),
        _ => {
            let message = format!("a step is a map, not {}", node.kind_in_words());
            Problem::new(code::NOT_A_STEP, message, label).at(node.at)
        }
    }
}
