//! One file into a [`Suite`]: its head, its cases with their tables, and the check of every row.

use std::collections::{BTreeMap, BTreeSet};

use serde::Deserialize;

use super::rows::RowCheck;
use super::{CaseTemplate, SourceFile, Suite, case};
use crate::expand::{BENCH_NAMES, Scope, is_name, placeholders};
use crate::file::SuiteFile;
use crate::forms::OneOrMany;
use crate::model::{Located, SuiteHead};
use crate::node::{Entry, Kind, Node};
use crate::problem::{Problem, with_nearest};
use crate::read::Reader;
use crate::yaml;
use crate::{Diagnostic, Position, code};

/// The suite in `file`, as far as it can be read, and what is wrong. `names` are the suites so far, with their places.
pub(super) fn read(
    file: &SourceFile,
    names: &mut BTreeMap<String, String>,
) -> (Option<Suite>, Vec<Diagnostic>) {
    let root = match yaml::read(&file.path, &file.text) {
        Ok(root) => root,
        Err(diagnostics) => return (None, diagnostics),
    };
    let mut problems = Vec::new();
    let suite = read_root(file, root, names, &mut problems);
    if let Some(suite) = &suite {
        let mut check = RowCheck::new(suite);
        for template in suite.cases.iter() {
            check.case(template, &mut problems);
        }
    }
    let diagnostics = problems
        .into_iter()
        .map(|problem| problem.into_diagnostic(&file.path))
        .collect();
    (suite, diagnostics)
}

fn read_root(
    file: &SourceFile,
    mut root: Node,
    names: &mut BTreeMap<String, String>,
    problems: &mut Vec<Problem>,
) -> Option<Suite> {
    if let Err(problem) = check_language(&root) {
        problems.push(*problem);
        return None;
    }
    let scope = Scope::default();
    let head = SuiteFile::deserialize(Reader::new(&root, &scope, root.at));
    let head = match head {
        Ok(head) => {
            check_suite_name(&head.suite, &file.path, names, problems);
            Some(SuiteHead {
                language: head.language.value,
                suite: head.suite.value,
                title: head.title,
                protocol: head.protocol,
                device: head.device,
                sources: head.sources,
            })
        }
        Err(error) => {
            problems.push(*error.0);
            None
        }
    };
    let cases = take(&mut root, "cases");
    let cases = cases.map(|entry| read_cases(entry, problems))?;
    Some(Suite::new(head?, file, cases))
}

/// That the file is of the language this program reads.
pub(crate) fn check_language(root: &Node) -> Result<(), Box<Problem>> {
    if !matches!(root.kind, Kind::Map(_)) {
        let message = format!("this file is {}", root.kind_in_words());
        return Err(Problem::new(code::WRONG_SHAPE, message, "expected a map").at(root.at));
    }
    let Some(language) = root.get("language") else {
        let message = "the file does not say its version of the language";
        let problem = Problem::new(code::LANGUAGE, message, "needs `language: 1`");
        return Err(problem.at(root.at));
    };
    if language.text() != Some("1") {
        let found = language.text().unwrap_or(language.kind_in_words());
        let message = format!("this file is of version `{found}` of the language");
        return Err(Problem::new(code::LANGUAGE, message, "expected 1").at(language.at));
    }
    Ok(())
}

/// Lower-case words with `-` and `.` between them.
pub(crate) fn check_name(name: &str, at: Position) -> Result<(), Box<Problem>> {
    let is_word = |word: &str| {
        !word.is_empty()
            && word
                .chars()
                .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit())
    };
    if name.split(['-', '.']).all(is_word) {
        return Ok(());
    }
    let problem = Problem::new(
        code::NAME,
        format!("`{name}` is not a name"),
        "expected lower-case words and digits with `-` or `.` between them",
    );
    Err(problem.at(at))
}

fn check_suite_name(
    suite: &Located<String>,
    path: &str,
    names: &mut BTreeMap<String, String>,
    problems: &mut Vec<Problem>,
) {
    if let Err(problem) = check_name(&suite.value, suite.at) {
        problems.push(*problem);
    }
    if let Some(other) = names.get(&suite.value) {
        let message = format!("the suite `{}` is already in {other}", suite.value);
        let problem = Problem::new(code::DUPLICATE_SUITE, message, "a second time");
        problems.push(*problem.at(suite.at));
    } else {
        names.insert(suite.value.clone(), format!("{path}:{}", suite.at.line));
    }
}

/// Takes an entry out of a map.
fn take(map: &mut Node, key: &str) -> Option<Entry> {
    let Kind::Map(entries) = &mut map.kind else {
        return None;
    };
    let index = entries
        .iter()
        .position(|entry| entry.key.text.as_ref() == key)?;
    Some(entries.remove(index))
}

fn read_cases(cases: Entry, problems: &mut Vec<Problem>) -> Vec<CaseTemplate> {
    let Kind::List(nodes) = cases.value.kind else {
        let message = format!("{} cannot stand here", cases.value.kind_in_words());
        let problem = Problem::new(code::WRONG_SHAPE, message, "expected a list of cases");
        problems.push(*problem.at(cases.value.at));
        return Vec::new();
    };
    if nodes.is_empty() {
        let problem = Problem::new(code::EMPTY, "no cases", "expected at least one case");
        problems.push(*problem.at(cases.value.at));
    }
    let mut templates: Vec<CaseTemplate> = Vec::new();
    let mut names: BTreeMap<String, Position> = BTreeMap::new();
    for node in nodes {
        let template = match read_template(node, problems) {
            Ok(template) => template,
            Err(problem) => {
                problems.push(*problem);
                continue;
            }
        };
        if let Some(first) = names.get(&template.name) {
            let message = format!("the case `{}` is already in this suite", template.name);
            let problem = Problem::new(code::DUPLICATE_CASE, message, "a second time");
            problems.push(*problem.at(template.at).also(*first, "first here"));
        }
        names.entry(template.name.clone()).or_insert(template.at);
        templates.push(template);
    }
    templates
}

fn read_template(
    mut node: Node,
    problems: &mut Vec<Problem>,
) -> Result<CaseTemplate, Box<Problem>> {
    if !matches!(node.kind, Kind::Map(_)) {
        let message = format!("a case is a map, not {}", node.kind_in_words());
        return Err(Problem::new(code::WRONG_SHAPE, message, "expected a case").at(node.at));
    }
    let Some(name) = node.get("case") else {
        let message = "the key `case` is missing";
        let label = "needs `case`, the name of the case";
        return Err(Problem::new(code::MISSING_KEY, message, label).at(node.at));
    };
    let at = name.at;
    let Some(text) = name.text().map(str::to_owned) else {
        let message = format!("{} cannot stand here", name.kind_in_words());
        return Err(Problem::new(code::WRONG_SHAPE, message, "expected a name").at(at));
    };
    check_name(&text, at)?;
    let table = take(&mut node, "each");
    let choose = take(&mut node, "choose");
    let mut template = CaseTemplate {
        name: text,
        at,
        body: node,
        rows: Vec::new(),
        without_rows: false,
        key: Vec::new(),
        fillings: Vec::new(),
        open: false,
        absent: None,
    };
    let (table, query) = match table {
        Some(each) if matches!(each.value.kind, Kind::Map(_)) => (None, Some(each)),
        table => (table, None),
    };
    match table {
        Some(table) => read_table(table, &mut template, problems),
        None => {
            if let Some(key) = template.body.entry("key") {
                let message = "`key` is about a table, and the case has none";
                let problem = Problem::new(code::KEYS_TOGETHER, message, "needs `each`");
                problems.push(*problem.at(key.key.at));
            }
        }
    }
    template.read_fillings(choose.as_ref(), query.as_ref(), problems);
    if let Some(query) = query {
        let names = query.value.entries().iter().take(1);
        template.key = names.map(|entry| entry.key.text.to_string()).collect();
    }
    find_unused(&template, problems);
    Ok(template)
}

/// What is chosen must be used, as columns must; the name of each of many need not be.
fn find_unused(template: &CaseTemplate, problems: &mut Vec<Problem>) {
    let mut used: BTreeSet<&str> = template.key.iter().map(String::as_str).collect();
    collect_names(&template.body, &mut used);
    let of = |name: &str, used: &str| {
        let rest = used.strip_prefix(name);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('-'))
    };
    for (name, at) in template.filled_names() {
        if !used.iter().any(|used| of(name, used)) {
            let message = format!("nothing uses what is chosen as `{name}`");
            let label = format!("`{{{name}}}` does not occur in the case");
            problems.push(*Problem::new(code::UNUSED_COLUMN, message, label).at(at));
        }
    }
}

fn read_table(table: Entry, template: &mut CaseTemplate, problems: &mut Vec<Problem>) {
    let (rows, columns) = match read_rows(table.value) {
        Ok(table) => table,
        Err(problem) => {
            problems.push(*problem);
            template.without_rows = true;
            return;
        }
    };
    template.rows = rows;
    let checked = read_key(&template.body, &columns).and_then(|key| {
        template.key = key;
        check_rows_are_unique(&template.rows, &template.key)
    });
    match checked {
        Ok(()) => find_unused_columns(template, problems),
        Err(problem) => problems.push(*problem),
    }
}

/// The rows of a table and its columns.
fn read_rows(table: Node) -> Result<(Vec<Node>, Vec<String>), Box<Problem>> {
    let Kind::List(rows) = table.kind else {
        let message = format!("{} cannot stand here", table.kind_in_words());
        let problem = Problem::new(code::WRONG_SHAPE, message, "expected a list of rows");
        return Err(problem.at(table.at));
    };
    let columns = columns(&rows, table.at)?;
    Ok((rows, columns))
}

/// The columns that name a case: those of `key`, else the first.
fn read_key(body: &Node, columns: &[String]) -> Result<Vec<String>, Box<Problem>> {
    let Some(entry) = body.entry("key") else {
        return Ok(columns.first().cloned().into_iter().collect());
    };
    let scope = Scope::default();
    let reader = Reader::new(&entry.value, &scope, entry.key.at);
    let key: OneOrMany<Located<String>> =
        OneOrMany::deserialize(reader).map_err(|error| error.0)?;
    if key.0.is_empty() {
        let problem = Problem::new(
            code::KEY_COLUMN,
            "no column",
            "expected at least one column",
        );
        return Err(problem.at(entry.value.at));
    }
    for column in &key.0 {
        if !columns.contains(&column.value) {
            let message = format!("the table has no column `{}`", column.value);
            let problem = Problem::new(code::KEY_COLUMN, message, "not a column").at(column.at);
            return Err(with_nearest(problem, &column.value, columns));
        }
    }
    Ok(key.0.into_iter().map(|column| column.value).collect())
}

/// The columns of a table: those of its first row, which every row must have.
fn columns(rows: &[Node], at: Position) -> Result<Vec<String>, Box<Problem>> {
    let Some(first) = rows.first() else {
        return Err(Problem::new(
            code::TABLE,
            "a table without rows",
            "expected at least one row",
        )
        .at(at));
    };
    for row in rows {
        let Kind::Map(cells) = &row.kind else {
            let message = format!("a row is a map, not {}", row.kind_in_words());
            let label = "expected a map from columns to cells";
            return Err(Problem::new(code::TABLE, message, label).at(row.at));
        };
        let missing = first
            .entries()
            .iter()
            .find(|cell| row.get(&cell.key.text).is_none());
        if let Some(missing) = missing {
            let message = format!("this row has no `{}`", missing.key.text);
            let label = "expected the columns of the first row";
            let problem = Problem::new(code::TABLE, message, label).at(row.at);
            return Err(problem.also(missing.key.at, "the first row has it"));
        }
        let strange = cells
            .iter()
            .find(|cell| first.get(&cell.key.text).is_none());
        if let Some(strange) = strange {
            let message = format!("the first row has no `{}`", strange.key.text);
            let label = "expected the columns of the first row";
            return Err(Problem::new(code::TABLE, message, label).at(strange.key.at));
        }
    }
    for cell in first.entries() {
        let name = cell.key.text.as_ref();
        if !is_name(name) || BENCH_NAMES.contains(&name) {
            let message = format!("a column cannot be named `{name}`");
            let label =
                "expected a word of letters, digits, `_` and `-` other than `node` and `address`";
            return Err(Problem::new(code::NAME, message, label).at(cell.key.at));
        }
    }
    let names = first.entries().iter();
    Ok(names.map(|cell| cell.key.text.to_string()).collect())
}

fn check_rows_are_unique(rows: &[Node], key: &[String]) -> Result<(), Box<Problem>> {
    let mut seen: BTreeMap<String, Position> = BTreeMap::new();
    for row in rows {
        for column in key {
            let cell = row.get(column);
            if let Some(cell) = cell.filter(|cell| cell.text().is_none()) {
                let message = format!("`{column}` names the case and is {}", cell.kind_in_words());
                let problem = Problem::new(code::KEY_COLUMN, message, "expected a single value");
                return Err(problem.at(cell.at));
            }
        }
        let id = case::row_key(row, key);
        if let Some(first) = seen.get(&id) {
            let message = format!("two rows make the case `{id}`");
            return Err(
                Problem::new(code::ROWS_NOT_UNIQUE, message, "a second time")
                    .at(row.at)
                    .also(*first, "first here")
                    .help("name the columns that tell the rows apart: `key: [one, other]`"),
            );
        }
        seen.insert(id, row.at);
    }
    Ok(())
}

fn find_unused_columns(template: &CaseTemplate, problems: &mut Vec<Problem>) {
    let mut used: BTreeSet<&str> = template.key.iter().map(String::as_str).collect();
    collect_names(&template.body, &mut used);
    let first = template.rows.first().map(Node::entries).unwrap_or_default();
    for column in first {
        if !used.contains(column.key.text.as_ref()) {
            let message = format!("nothing uses the column `{}`", column.key.text);
            let label = format!("`{{{}}}` does not occur in the case", column.key.text);
            let problem = Problem::new(code::UNUSED_COLUMN, message, label);
            problems.push(*problem.at(column.key.at));
        }
    }
}

fn collect_names<'a>(node: &'a Node, names: &mut BTreeSet<&'a str>) {
    match &node.kind {
        Kind::Empty => {}
        Kind::Text(text) => {
            names.extend(placeholders(text).map(|placeholder| placeholder.name));
        }
        Kind::List(elements) => {
            for element in elements {
                collect_names(element, names);
            }
        }
        Kind::Map(entries) => {
            for entry in entries {
                collect_names(&entry.value, names);
            }
        }
    }
}
