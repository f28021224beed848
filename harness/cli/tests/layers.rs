//! Which crate may know which: the layers of docs/architecture.md, read from cargo.

#![allow(clippy::unwrap_used)]

use std::collections::{BTreeMap, BTreeSet};

use cargo_metadata::{DependencyKind, MetadataCommand, Package};

/// Each crate of the project and those of the project it may use. A crate that is not here fails the test.
const MAY_USE: [(&str, &[&str]); 11] = [
    ("fieldproof-can", &[]),
    ("fieldproof-record", &[]),
    ("fieldproof-wire", &["fieldproof-can"]),
    ("fieldproof-dictionary", &[]),
    (
        "fieldproof-suite",
        &["fieldproof-can", "fieldproof-dictionary"],
    ),
    ("fieldproof-link", &["fieldproof-can"]),
    (
        "fieldproof-run",
        &[
            "fieldproof-can",
            "fieldproof-wire",
            "fieldproof-dictionary",
            "fieldproof-link",
            "fieldproof-suite",
            "fieldproof-record",
        ],
    ),
    ("fieldproof-report", &["fieldproof-record"]),
    (
        "fieldproof-devices",
        &["fieldproof-can", "fieldproof-link", "fieldproof-dictionary"],
    ),
    ("fieldproof-peers", &[]),
    (
        "fieldproof",
        &[
            "fieldproof-can",
            "fieldproof-dictionary",
            "fieldproof-link",
            "fieldproof-suite",
            "fieldproof-record",
            "fieldproof-run",
            "fieldproof-report",
            "fieldproof-devices",
        ],
    ),
];

/// Crates that touch no clock, file, socket or environment, and so need none of these either.
const PURE: [&str; 5] = [
    "fieldproof-can",
    "fieldproof-wire",
    "fieldproof-dictionary",
    "fieldproof-suite",
    "fieldproof-record",
];

/// What would bring a clock, a file, a socket or a terminal with it.
const IMPURE: [&str; 12] = [
    "anstream",
    "chrono",
    "clap",
    "ctrlc",
    "indicatif",
    "mio",
    "serialport",
    "socket2",
    "socketcan",
    "tempfile",
    "time",
    "tokio",
];

fn packages() -> Vec<Package> {
    let mut command = MetadataCommand::new();
    command.manifest_path(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"));
    // Only the manifests of the workspace are asked for: nothing is resolved or downloaded.
    command.no_deps();
    command.exec().unwrap().packages
}

/// The names of what `package` itself depends on to be built, its tests left out.
fn uses(package: &Package) -> BTreeSet<String> {
    let dependencies = package.dependencies.iter();
    dependencies
        .filter(|dependency| dependency.kind != DependencyKind::Development)
        .map(|dependency| dependency.name.clone())
        .collect()
}

#[test]
fn no_crate_knows_more_than_its_layer() {
    let allowed: BTreeMap<&str, &[&str]> = MAY_USE.into_iter().collect();
    let packages = packages();
    let ours: BTreeSet<String> = packages
        .iter()
        .map(|package| package.name.to_string())
        .collect();
    let mut wrong = Vec::new();
    for package in &packages {
        let name = package.name.as_str();
        let Some(allowed) = allowed.get(name) else {
            wrong.push(format!("{name} has no layer"));
            continue;
        };
        let forbidden = uses(package)
            .into_iter()
            .filter(|used| ours.contains(used) && !allowed.contains(&used.as_str()));
        wrong.extend(forbidden.map(|used| format!("{name} may not use {used}")));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(ours.len(), MAY_USE.len());
}

#[test]
fn pure_crates_depend_on_nothing_that_acts() {
    let packages = packages();
    let pure: Vec<&Package> = packages
        .iter()
        .filter(|package| PURE.contains(&package.name.as_str()))
        .collect();
    assert_eq!(pure.len(), PURE.len());
    for package in pure {
        let acting: Vec<String> = uses(package)
            .into_iter()
            .filter(|used| IMPURE.contains(&used.as_str()))
            .collect();
        assert!(
            acting.is_empty(),
            "{} uses {}",
            package.name,
            acting.join(", ")
        );
    }
}

#[test]
fn every_crate_keeps_the_lints_of_the_workspace() {
    for package in packages() {
        let manifest = std::fs::read_to_string(&package.manifest_path).unwrap();
        assert!(
            manifest.contains("[lints]\nworkspace = true"),
            "{} sets its own lints",
            package.name
        );
    }
}
