//! `fieldproof eds`

use std::path::Path;
use std::sync::Arc;

use fieldproof_dictionary::eds::{self, manual};
use fieldproof_report::{Problem, Severity};

use crate::complaint::Complaint;
use crate::exit::Exit;
use crate::input;
use crate::options::{EdsCheckOptions, Format};
use crate::problems;
use crate::screen::Screen;

/// Checks EDS files: 0 without errors, 1 with one, 2 if a file cannot be read.
pub(crate) fn check(options: &EdsCheckOptions, screen: &mut Screen) -> Result<Exit, Complaint> {
    let against = options.against.as_deref().map(read_table).transpose()?;
    let mut found = Vec::new();
    let mut exit = Exit::Passed;
    for path in &options.files {
        match input::read_bytes(path) {
            Ok(bytes) => {
                let problems = check_file(path, &bytes, against.as_ref());
                if problems
                    .iter()
                    .any(|problem| problem.severity == Severity::Error)
                {
                    exit = exit.max(Exit::Failed);
                }
                found.extend(problems);
            }
            Err(problem) => {
                exit = Exit::WrongInput;
                found.push(*problem);
            }
        }
    }
    match options.format {
        Format::Json => screen.print_json(&found),
        Format::Text => {
            screen.complain_all(&found);
            screen.print(&summary(options.files.len(), &found));
        }
    }
    Ok(exit)
}

/// What a manual claims.
struct Against {
    path: String,
    text: Arc<str>,
    table: manual::Table,
}

fn read_table(path: &Path) -> Result<Against, Complaint> {
    let file = input::read(path).map_err(|problem| Complaint::input(*problem))?;
    let text: Arc<str> = file.text.into();
    let complain = |error| problems::of_table_error(&error, &file.path, &text);
    match manual::Table::parse(&text) {
        Ok(table) => Ok(Against {
            path: file.path,
            text,
            table,
        }),
        Err(errors) => Err(Complaint::inputs(
            errors.into_iter().map(complain).collect(),
        )),
    }
}

/// The findings in the order of the lines.
fn check_file(path: &Path, bytes: &[u8], against: Option<&Against>) -> Vec<Problem> {
    let text: Arc<str> = eds::decode(bytes).into();
    let shown = path.display().to_string();
    let eds = eds::read(&text);
    let name = path.file_name().and_then(|name| name.to_str());
    let mut found: Vec<Problem> = eds::check(&eds)
        .iter()
        .chain(&name.and_then(|name| eds::check_file_name(&eds, name)))
        .map(|finding| problems::of_finding(finding, &shown, &text))
        .collect();
    if let Some(against) = against {
        found.extend(
            manual::compare(&eds, &against.table)
                .iter()
                .map(|difference| {
                    let table = (against.path.as_str(), &against.text);
                    problems::of_difference(difference, (&shown, &text), table)
                }),
        );
    }
    found.sort_by_key(|problem| problem.at.line);
    found
}

fn summary(files: usize, problems: &[Problem]) -> String {
    let count = |severity| {
        problems
            .iter()
            .filter(|problem| problem.severity == severity)
            .count()
    };
    let parts: Vec<String> = [
        (count(Severity::Error), "error"),
        (count(Severity::Warning), "warning"),
        (count(Severity::Note), "note"),
    ]
    .into_iter()
    .filter(|(count, _)| *count > 0)
    .map(|(count, what)| number(count, what))
    .collect();
    let found = match parts.is_empty() {
        true => "no findings".to_owned(),
        false => parts.join(", "),
    };
    format!("{}: {found}\n", number(files, "file"))
}

fn number(count: usize, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    }
}
