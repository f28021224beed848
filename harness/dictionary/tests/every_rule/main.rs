//! For every rule a file that breaks it and nothing else, made by one small edit from one that breaks none.

#![allow(clippy::unwrap_used, clippy::panic)]

mod rows;

use std::collections::BTreeSet;
use std::fmt::Write;

use fieldproof_dictionary::eds::manual::{self, Table};
use fieldproof_dictionary::eds::{self, Finding, RULES};

use rows::{Edit, ROWS, Row};

const BASE: &str = include_str!("base.dcf");

/// The base as the manual would print it: which entries there are, and their access.
fn table() -> String {
    let eds = eds::read(BASE);
    let mut table = String::new();
    for (index, sub, entry) in eds.dictionary.entries() {
        let access = if entry.access.writable() { "rw" } else { "ro" };
        let _ = writeln!(table, "{index:04X}:{sub:02X} | - | {access} | - | - | it");
    }
    table
}

/// Everything that can be found in a file, with another name and the manual at hand.
fn findings(text: &str, name: &str, table: &str) -> Vec<Finding> {
    let eds = eds::read(text);
    let table = Table::parse(table).unwrap();
    let mut findings = eds::check(&eds);
    findings.extend(eds::check_file_name(&eds, name));
    let differences = manual::compare(&eds, &table);
    findings.extend(differences.into_iter().map(|difference| difference.finding));
    findings
}

/// `text` with the one place where `old` stands made `new`.
fn replaced(text: &str, old: &str, new: &str) -> String {
    assert_eq!(text.matches(old).count(), 1, "`{old}` must be there once");
    text.replacen(old, new, 1)
}

/// `text` without the section `[name]` and its keys.
fn without(text: &str, name: &str) -> String {
    let head = format!("[{name}]\n");
    let (before, rest) = text.split_once(&head).unwrap();
    let (_, after) = rest.split_once("\n\n").unwrap();
    format!("{before}{after}")
}

/// The number of the one line `[section]` or `key=value`; with `[section] key=value` the first such one in it.
fn line_of(text: &str, wanted: &str) -> usize {
    let (section, key) = wanted.split_once("] ").unwrap_or(("", wanted));
    let mut lines = (1..).zip(text.lines());
    if section.is_empty() {
        assert_eq!(
            text.lines().filter(|line| *line == wanted).count(),
            1,
            "`{wanted}`"
        );
    } else {
        let head = format!("{section}]");
        assert!(lines.any(|(_, line)| line == head), "no {head}");
    }
    let found = lines.find(|(_, line)| *line == key);
    found.unwrap_or_else(|| panic!("no `{wanted}`")).0
}

fn found_by(row: &Row) -> (String, Vec<Finding>) {
    let mut text = BASE.to_owned();
    let mut printed = table();
    let mut name = "base.dcf";
    for edit in row.edits {
        match *edit {
            Edit::Replace(old, new) => text = replaced(&text, old, new),
            Edit::Remove(section) => text = without(&text, section),
            Edit::Append(more) => text.push_str(more),
            Edit::Manual(old, new) => printed = replaced(&printed, old, new),
            Edit::Rename(to) => name = to,
        }
    }
    let findings = findings(&text, name, &printed);
    (text, findings)
}

#[test]
fn the_base_breaks_no_rule() {
    assert_eq!(findings(BASE, "base.dcf", &table()), []);
}

#[test]
fn every_rule_is_broken_by_a_row_and_every_row_names_a_rule() {
    let rules: BTreeSet<&str> = RULES.iter().map(|rule| rule.code).collect();
    let rows: BTreeSet<&str> = ROWS.iter().map(|row| row.code).collect();
    assert_eq!(rules, rows);
}

#[test]
fn each_row_breaks_its_rule_and_no_other() {
    let mut wrong = Vec::new();
    for row in ROWS {
        let (text, findings) = found_by(row);
        let line = |wanted: &str| line_of(&text, wanted);
        let mut wanted = vec![(row.code, row.severity, line(row.at))];
        wanted.extend(
            row.implied
                .iter()
                .map(|(code, severity, at)| (*code, *severity, line(at))),
        );
        wanted.sort_by_key(|(code, ..)| *code);
        let mut found: Vec<_> = findings
            .iter()
            .map(|finding| (finding.rule.code, finding.rule.severity, finding.line))
            .collect();
        found.sort_by_key(|(code, ..)| *code);
        if found != wanted {
            wrong.push(format!(
                "{}: wanted {wanted:?}, found {found:?}: {:?}",
                row.code,
                findings
                    .iter()
                    .map(|finding| &finding.text)
                    .collect::<Vec<_>>()
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
