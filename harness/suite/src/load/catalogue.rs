//! Catalogues, and what cases say of them.

use std::collections::{BTreeMap, BTreeSet};

use serde::Deserialize;

use super::suite::{check_language, check_name};
use super::{SourceFile, Suite, case};
use crate::catalogue::Catalogue;
use crate::expand::Environment;
use crate::model::Case;
use crate::node::Node;
use crate::problem::{Problem, with_nearest};
use crate::read::Reader;
use crate::{Diagnostic, Position, code, yaml};

/// Reads a catalogue.
///
/// # Errors
/// Everything that is wrong with it.
pub fn load_catalogue(file: &SourceFile) -> Result<Catalogue, Vec<Diagnostic>> {
    let root = yaml::read(&file.path, &file.text)?;
    let mut problems = Vec::new();
    match read(&root, &mut problems) {
        Some(catalogue) if problems.is_empty() => Ok(catalogue),
        _ => {
            problems.sort_by_key(|problem| problem.at);
            let problems = problems.into_iter();
            Err(problems
                .map(|problem| problem.into_diagnostic(&file.path))
                .collect())
        }
    }
}

fn read(root: &Node, problems: &mut Vec<Problem>) -> Option<Catalogue> {
    let scope = crate::expand::Scope::default();
    let catalogue = check_language(root).and_then(|()| {
        Catalogue::deserialize(Reader::new(root, &scope, root.at)).map_err(|error| error.0)
    });
    let catalogue = match catalogue {
        Ok(catalogue) => catalogue,
        Err(problem) => {
            problems.push(*problem);
            return None;
        }
    };
    if let Err(problem) = check_name(&catalogue.catalogue.value, catalogue.catalogue.at) {
        problems.push(*problem);
    }
    if catalogue.entries.value.is_empty() {
        let problem = Problem::new(code::EMPTY, "no entries", "expected at least one entry");
        problems.push(*problem.at(catalogue.entries.at));
    }
    let mut seen: BTreeMap<&str, Position> = BTreeMap::new();
    for entry in &catalogue.entries.value {
        if let Some(first) = seen.get(entry.id.value.as_str()) {
            let message = format!("the entry `{}` is already there", entry.id.value);
            let problem = Problem::new(code::DUPLICATE_ENTRY, message, "a second time");
            problems.push(*problem.at(entry.id.at).also(*first, "first here"));
        }
        seen.entry(&entry.id.value).or_insert(entry.id.at);
        if entry.elsewhere.is_some() && entry.not_covered.is_some() {
            let message = "an entry is either tested elsewhere or not covered";
            let problem = Problem::new(code::KEYS_TOGETHER, message, "says both");
            problems.push(*problem.at(entry.id.at));
        }
    }
    Some(catalogue)
}

/// What the cases of `suite` say they cover that is in none of `catalogues`.
pub fn unknown_entries(suite: &Suite, catalogues: &[Catalogue]) -> Vec<Diagnostic> {
    let environment = Environment {
        node: Some(1),
        address: Some(1),
        ..Environment::default()
    };
    let mut told = BTreeSet::new();
    let mut found = Vec::new();
    for case in suite.cases() {
        let reads = std::cell::Cell::new(case::MOST_READS);
        let Ok(lowered) = case::read(case, &environment, &reads) else {
            continue;
        };
        for problem in unknown_in(&lowered, catalogues) {
            if told.insert((problem.at, problem.message.clone())) {
                found.push(problem.into_diagnostic(&suite.path));
            }
        }
    }
    found
}

fn unknown_in(case: &Case, catalogues: &[Catalogue]) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (name, entry) in &case.covers {
        let catalogue = catalogues.iter().find(|it| it.catalogue.value == *name);
        let (message, wrong, known): (String, &str, Vec<&str>) = match catalogue {
            None => (
                format!("there is no catalogue `{name}`"),
                name,
                catalogues
                    .iter()
                    .map(|it| it.catalogue.value.as_str())
                    .collect(),
            ),
            Some(catalogue) => {
                let entries = catalogue.entries.value.iter();
                let ids: Vec<&str> = entries.map(|it| it.id.value.as_str()).collect();
                if ids.contains(&entry.as_str()) {
                    continue;
                }
                let message = format!("the catalogue `{name}` has no entry `{entry}`");
                (message, entry, ids)
            }
        };
        let problem = Problem::new(code::UNKNOWN_ENTRY, message, "says so under `covers`");
        problems.push(*with_nearest(problem.at(case.at), wrong, &known));
    }
    problems
}
