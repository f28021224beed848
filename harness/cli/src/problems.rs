//! Mistakes that other crates find, in the one form that is shown.

use std::sync::Arc;

use fieldproof_dictionary::eds::manual::{self, TableError};
use fieldproof_dictionary::eds::{self, Finding};
use fieldproof_report::{Also, Elsewhere, Problem, Severity, SourceText, Span};
use fieldproof_suite::{Diagnostic, Position};

pub(crate) fn of_diagnostic(diagnostic: &Diagnostic, text: &Arc<str>) -> Problem {
    Problem {
        severity: match diagnostic.severity {
            fieldproof_suite::Severity::Error => Severity::Error,
            fieldproof_suite::Severity::Warning => Severity::Warning,
        },
        code: Some(diagnostic.code.to_owned()),
        message: diagnostic.message.clone(),
        path: diagnostic.path.clone(),
        at: span(diagnostic.at),
        source: SourceText::Whole(Arc::clone(text)),
        label: diagnostic.label.clone(),
        also: diagnostic
            .also
            .iter()
            .map(|(at, words)| Also {
                at: span(*at),
                words: words.clone(),
            })
            .collect(),
        elsewhere: Vec::new(),
        notes: Vec::new(),
        help: diagnostic.help.clone(),
    }
}

/// A finding in an EDS file that is checked for its own sake.
pub(crate) fn of_finding(finding: &Finding, path: &str, text: &Arc<str>) -> Problem {
    let severity = match finding.rule.severity {
        eds::Severity::Error => Severity::Error,
        eds::Severity::Warning => Severity::Warning,
        eds::Severity::Note => Severity::Note,
    };
    Problem {
        code: Some(finding.rule.code.to_owned()),
        ..whole_line(severity, finding.line, finding.text.clone(), path, text)
            .note(format!("the rule: {}", finding.rule.title))
            .help(finding.help.clone())
    }
}

/// A difference between an EDS file and the table of a manual: a path and a text for each.
pub(crate) fn of_difference(
    difference: &manual::Difference,
    (path, text): (&str, &Arc<str>),
    (table_path, table): (&str, &Arc<str>),
) -> Problem {
    let row = difference.row.map(|line| Elsewhere {
        path: table_path.to_owned(),
        at: line_span(line),
        source: SourceText::Whole(Arc::clone(table)),
        words: "the manual".to_owned(),
    });
    Problem {
        elsewhere: row.into_iter().collect(),
        ..of_finding(&difference.finding, path, text)
    }
}

/// A finding in an EDS file that is read to be used, which it can be.
pub(crate) fn of_used_finding(finding: &Finding, path: &str, text: &Arc<str>) -> Problem {
    let problem = of_finding(finding, path, text);
    Problem {
        severity: problem.severity.min(Severity::Warning),
        ..problem
    }
}

pub(crate) fn of_table_error(error: &TableError, path: &str, text: &Arc<str>) -> Problem {
    whole_line(Severity::Error, error.line, error.text.clone(), path, text)
}

fn whole_line(
    severity: Severity,
    line: usize,
    message: String,
    path: &str,
    text: &Arc<str>,
) -> Problem {
    Problem {
        at: line_span(line),
        source: SourceText::Whole(Arc::clone(text)),
        ..Problem::new(severity, message).in_file(path)
    }
}

fn line_span(line: usize) -> Span {
    Span {
        line: u32::try_from(line).unwrap_or(0),
        column: 0,
        end_column: 0,
    }
}

/// `problem` at its place in `text`.
pub(crate) fn placed(problem: Problem, at: Position, label: &str, text: &Arc<str>) -> Problem {
    Problem {
        at: span(at),
        source: SourceText::Whole(Arc::clone(text)),
        label: label.to_owned(),
        ..problem
    }
}

/// `problem` with another place in the same file.
pub(crate) fn also(mut problem: Problem, at: Position, words: &str) -> Problem {
    problem.also.push(Also {
        at: span(at),
        words: words.to_owned(),
    });
    problem
}

fn span(at: Position) -> Span {
    Span {
        line: at.line,
        column: at.column,
        end_column: at.end_column,
    }
}
