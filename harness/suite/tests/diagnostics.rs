//! Every diagnostic has a file that shows it and a section that explains it.
//!
//! A file in fixtures/suites-invalid is a suite, or with the ending `.device.yaml` a device description, with
//! `.bench.yaml` a bench; the text beside it is what must be said of it, one line a diagnostic:
//! `line:column: code message | label | help`, and indented the other places that matter. With `UPDATE_GOLDEN` set, what
//! comes is written in the place of what is expected.

#![allow(clippy::unwrap_used, clippy::panic)]
#![allow(clippy::disallowed_methods, reason = "the files are beside the test")]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use fieldproof_suite::catalogue::Catalogue;
use fieldproof_suite::{
    Diagnostic, SourceFile, code, load, load_bench, load_catalogue, load_device, unknown_checks,
    unknown_entries,
};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn fixtures() -> Vec<PathBuf> {
    let folder = root().join("fixtures/suites-invalid");
    let paths = std::fs::read_dir(folder).unwrap();
    let mut paths: Vec<PathBuf> = paths.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

fn name(path: &Path) -> &str {
    path.file_name().unwrap().to_str().unwrap()
}

/// The text of a file. Too long a file is written short: its last line stands for two million of its kind.
fn text(path: &Path) -> String {
    let mut text = std::fs::read_to_string(path).unwrap();
    if text.starts_with("# The last line stands here 2000000 times") {
        let last = format!("{}\n", text.lines().last().unwrap());
        text.push_str(&last.repeat(2_000_000));
    }
    text
}

fn diagnostics(path: &Path) -> Vec<Diagnostic> {
    let file = SourceFile {
        path: name(path).to_owned(),
        text: text(path),
    };
    if file.path.ends_with(".device.yaml") {
        return match load_device(&file) {
            Ok(device) => unknown_checks(&device, &file.path, &checks()),
            Err(diagnostics) => diagnostics,
        };
    }
    if file.path.ends_with(".bench.yaml") {
        return load_bench(&file).unwrap_err();
    }
    if file.path.ends_with(".catalogue.yaml") {
        return load_catalogue(&file).unwrap_err();
    }
    if file.path.starts_with("S071") {
        let loaded = load(&[file]);
        assert_eq!(loaded.diagnostics, []);
        return unknown_entries(&loaded.suites[0], &[catalogue()]);
    }
    // A second suite of the same name is a second file.
    let times = if file.path.starts_with("S032") { 2 } else { 1 };
    load(&vec![file; times]).diagnostics
}

/// The catalogue that a case could name.
fn catalogue() -> Catalogue {
    let text = "language: 1\ncatalogue: cct\ntitle: T\nsource: {document: D}\nentries: [{id: 2.10, title: E}]";
    let file = SourceFile {
        path: "c.yaml".to_owned(),
        text: text.to_owned(),
    };
    load_catalogue(&file).unwrap()
}

/// The checks that a suite could have.
fn checks() -> BTreeSet<String> {
    ["nmt.no-sdo-in-stopped", "sdo.long-string"]
        .map(str::to_owned)
        .into()
}

fn shown(diagnostics: &[Diagnostic]) -> String {
    let mut shown = String::new();
    for one in diagnostics {
        let help = one.help.as_deref().unwrap_or_default();
        shown.push_str(&format!(
            "{}:{}: {} {} | {} | {help}\n",
            one.at.line, one.at.column, one.code, one.message, one.label
        ));
        for (at, words) in &one.also {
            shown.push_str(&format!("    {}:{}: {words}\n", at.line, at.column));
        }
    }
    shown
}

#[test]
fn every_mistake_is_reported_as_expected() {
    let mut wrong = Vec::new();
    let mut seen = 0;
    for path in fixtures() {
        if path.extension().is_none_or(|ending| ending != "yaml") {
            continue;
        }
        seen += 1;
        let expected = std::fs::read_to_string(path.with_extension("txt")).unwrap_or_default();
        let found = shown(&diagnostics(&path));
        if std::env::var_os("UPDATE_GOLDEN").is_some() {
            std::fs::write(path.with_extension("txt"), &found).unwrap();
        }
        if found.is_empty() || found != expected {
            let name = name(&path);
            wrong.push(format!("{name}\nexpected\n{expected}\nfound\n{found}"));
        }
    }
    assert!(seen > 0);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_code_has_a_file_and_a_section() {
    let document = std::fs::read_to_string(root().join("docs/diagnostics.md")).unwrap();
    let sections: BTreeSet<&str> = document
        .lines()
        .filter_map(|line| line.strip_prefix("### ")?.split(' ').next())
        .filter(|word| word.starts_with('S'))
        .collect();
    let shown: BTreeSet<String> = fixtures()
        .iter()
        .filter(|path| path.extension().is_some_and(|ending| ending == "txt"))
        .filter_map(|path| {
            let code = name(path).split('-').next()?.to_owned();
            let text = std::fs::read_to_string(path).unwrap();
            text.contains(&format!(": {code} ")).then_some(code)
        })
        .collect();
    let codes: BTreeSet<&str> = code::ALL.iter().copied().collect();
    assert_eq!(sections, codes, "sections of docs/diagnostics.md");
    let shown: BTreeSet<&str> = shown.iter().map(String::as_str).collect();
    assert_eq!(shown, codes, "files in fixtures/suites-invalid");
}

#[test]
fn every_code_is_given_once() {
    let mut codes = code::ALL.to_vec();
    codes.sort_unstable();
    codes.dedup();
    assert_eq!(codes, code::ALL, "in order, without duplicates");
}
