//! Reads every row of every table once, for its mistakes.

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};

use super::{CaseRef, CaseTemplate, Suite, case};
use crate::expand::Environment;
use crate::model::Protocol;
use crate::node::Node;
use crate::problem::Problem;
use crate::{Position, code};

/// The most diagnostics that one case gives; more of them help nobody.
const MOST_SHOWN: usize = 50;
/// The most that are held before it is known whether every row has them.
const MOST_FOUND: usize = 2_000;
/// The most values that are read for all rows of a file.
const MOST_READS: u64 = 20_000_000;
/// What a problem counts for, for it takes that much longer.
const READS_OF_A_PROBLEM: u64 = 50;

/// The check of the rows of one suite.
pub(super) struct RowCheck<'a> {
    suite: &'a Suite,
    environment: Environment,
    reads_left: u64,
}

/// What the rows of one case have wrong.
#[derive(Default)]
struct Found {
    rows: usize,
    problems: BTreeMap<(Option<Position>, &'static str, String), Problem>,
    /// How many rows fail at each placeholder of the case.
    at_placeholders: BTreeMap<(&'static str, Position), usize>,
}

impl<'a> RowCheck<'a> {
    pub(super) fn new(suite: &'a Suite) -> RowCheck<'a> {
        let protocol = suite.head.protocol;
        RowCheck {
            suite,
            environment: Environment {
                node: (protocol != Protocol::Modbus).then_some(1),
                address: (protocol != Protocol::Canopen).then_some(1),
                ..Environment::default()
            },
            reads_left: MOST_READS,
        }
    }

    /// Pushes what is wrong with the rows of a case.
    pub(super) fn case(&mut self, template: &'a CaseTemplate, problems: &mut Vec<Problem>) {
        let whole = template.rows.is_empty().then_some(None);
        let mut found = Found::default();
        for row in whole.into_iter().chain(template.rows.iter().map(Some)) {
            found.take(self.row(template, row));
            if found.problems.len() >= MOST_FOUND && found.rows > 1 {
                break;
            }
            if self.reads_left == 0 {
                let message = "the cases up to here are too large with all rows of their tables";
                let problem = Problem::new(code::TOO_LARGE, message, "too much");
                problems.push(*problem.at(template.at));
                break;
            }
        }
        found.show(problems);
    }

    fn row(&mut self, template: &'a CaseTemplate, row: Option<&'a Node>) -> Vec<Problem> {
        let case = CaseRef {
            suite: self.suite,
            template,
            row,
        };
        let reads = Cell::new(case::MOST_READS);
        let mut problems = case::read(case, &self.environment, &reads)
            .err()
            .unwrap_or_default();
        // Nothing can be said of the placeholders of a table that could not be read.
        problems
            .retain(|problem| !template.without_rows || problem.code != code::UNKNOWN_PLACEHOLDER);
        let spent = case::MOST_READS - reads.get() + READS_OF_A_PROBLEM * problems.len() as u64;
        self.reads_left = self.reads_left.saturating_sub(spent);
        problems
    }
}

impl Found {
    fn take(&mut self, problems: Vec<Problem>) {
        self.rows += 1;
        for problem in problems {
            if let Some(placeholder) = problem.template {
                let key = (problem.code, placeholder);
                *self.at_placeholders.entry(key).or_default() += 1;
            }
            if self.problems.len() < MOST_FOUND {
                let key = (problem.at, problem.code, problem.message.clone());
                self.problems.entry(key).or_insert(problem);
            }
        }
    }

    /// Where every row fails, the case is wrong and not its rows.
    fn show(self, problems: &mut Vec<Problem>) {
        let mut shown = BTreeSet::new();
        for mut problem in self.problems.into_values() {
            let mut message = problem.message.clone();
            let placeholder = problem.template.filter(|placeholder| {
                let count = self.at_placeholders.get(&(problem.code, *placeholder));
                self.rows > 1 && count == Some(&self.rows)
            });
            if let Some(placeholder) = placeholder {
                let cell = problem.at.replace(placeholder);
                problem.template = None;
                message.clear();
                let cell = cell.map(|cell| (cell, "with this, for one".to_owned()));
                problem.also.extend(cell);
            }
            if shown.len() < MOST_SHOWN && shown.insert((problem.code, problem.at, message)) {
                problems.push(problem);
            }
        }
    }
}
