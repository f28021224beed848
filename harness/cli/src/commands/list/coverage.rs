//! `fieldproof list --coverage`: what should be tested, and what tests it.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use fieldproof_suite::catalogue::{Catalogue, CatalogueEntry};
use serde::Serialize;

use super::environment;
use crate::complaint::Complaint;
use crate::exit::Exit;
use crate::library::Library;
use crate::options::{Format, ListOptions};
use crate::player::{self, Plan};
use crate::screen::Screen;
use crate::select;

/// A case as written, and the devices on which at least one of its rows is played.
type Cases = BTreeMap<String, BTreeSet<String>>;

#[derive(Serialize)]
struct Covered<'a> {
    catalogue: &'a str,
    title: &'a str,
    document: &'a str,
    entries: Vec<CoveredEntry<'a>>,
}

#[derive(Serialize)]
struct CoveredEntry<'a> {
    id: &'a str,
    title: &'a str,
    state: State,
    #[serde(skip_serializing_if = "Option::is_none")]
    because: Option<&'a str>,
    cases: Vec<CoveringCase>,
}

#[derive(Serialize)]
struct CoveringCase {
    case: String,
    devices: BTreeSet<String>,
}

/// How an entry is covered.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
enum State {
    /// By a case that is played on at least one device.
    Covered,
    /// By cases that none of the devices can be played with.
    NotPlayed,
    /// By something that is no case.
    Elsewhere,
    /// By nothing, and the catalogue says why.
    NotCovered,
    /// By nothing, and nothing says why.
    Missing,
}

/// Shows every entry of the catalogues with its cases.
pub(super) fn show(
    library: &Library,
    plan: &Plan,
    options: &ListOptions,
    screen: &mut Screen,
) -> Result<Exit, Complaint> {
    let known: Vec<&str> = library
        .catalogues
        .iter()
        .map(|catalogue| catalogue.catalogue.value.as_str())
        .collect();
    if let Some(unknown) = options
        .catalogues
        .iter()
        .find(|name| !known.contains(&name.as_str()))
    {
        return Err(Complaint::unknown("catalogue", unknown, &known));
    }
    let covering = covering(library, plan)?;
    let covered: Vec<Covered<'_>> = library
        .catalogues
        .iter()
        .filter(|catalogue| {
            let name = &catalogue.catalogue.value;
            options.catalogues.is_empty() || options.catalogues.contains(name)
        })
        .map(|catalogue| cover(catalogue, &covering))
        .collect();
    match options.format {
        Format::Json => screen.print_json(&covered),
        Format::Text => screen.print(&text(&covered)),
    }
    let missing = |it: &Covered<'_>| it.entries.iter().any(|entry| entry.state == State::Missing);
    Ok(match covered.iter().any(missing) {
        true => Exit::Failed,
        false => Exit::Passed,
    })
}

/// The cases of every entry, by catalogue and number.
fn covering(
    library: &Library,
    plan: &Plan,
) -> Result<BTreeMap<(String, String), Cases>, Complaint> {
    let mut covering: BTreeMap<(String, String), Cases> = BTreeMap::new();
    // Also those that are played on no device.
    for suite in &library.suites {
        let environment = environment(library, suite);
        for case in suite.cases().filter(|case| plan.selects(&case.id())) {
            // What cannot be read without a device is seen with it.
            let Ok(case) = case.lower(&environment) else {
                continue;
            };
            for covers in case.covers {
                let cases = covering.entry(covers).or_default();
                cases.entry(case.written_id.clone()).or_default();
            }
        }
    }
    let devices: Vec<_> = library.devices.iter().collect();
    select::must_be_simulated(&devices)?;
    for device in devices {
        let preview =
            player::preview(device, plan).map_err(|error| Complaint::bench(error.to_string()))?;
        let cases = preview.into_iter().flat_map(|(_, cases)| cases);
        for case in cases.filter(|case| case.skipped.is_none()) {
            for covers in case.covers {
                let cases = covering.entry(covers).or_default();
                let devices = cases.entry(case.written_id.clone()).or_default();
                devices.insert(device.name().to_owned());
            }
        }
    }
    Ok(covering)
}

fn cover<'a>(
    catalogue: &'a Catalogue,
    covering: &BTreeMap<(String, String), Cases>,
) -> Covered<'a> {
    let name = &catalogue.catalogue.value;
    let entry = |entry: &'a CatalogueEntry| {
        let cases = covering.get(&(name.clone(), entry.id.value.clone()));
        let cases: Vec<CoveringCase> = cases
            .into_iter()
            .flatten()
            .map(|(case, devices)| CoveringCase {
                case: case.clone(),
                devices: devices.clone(),
            })
            .collect();
        let (state, because) = match (&entry.elsewhere, &entry.not_covered) {
            _ if cases.iter().any(|case| !case.devices.is_empty()) => (State::Covered, None),
            _ if !cases.is_empty() => (State::NotPlayed, None),
            (Some(elsewhere), _) => (State::Elsewhere, Some(elsewhere.as_str())),
            (None, Some(why)) => (State::NotCovered, Some(why.as_str())),
            (None, None) => (State::Missing, None),
        };
        CoveredEntry {
            id: &entry.id.value,
            title: &entry.title,
            state,
            because,
            cases,
        }
    };
    Covered {
        catalogue: name,
        title: &catalogue.title,
        document: &catalogue.source.document,
        entries: catalogue.entries.value.iter().map(entry).collect(),
    }
}

fn text(covered: &[Covered<'_>]) -> String {
    let mut text = String::new();
    for catalogue in covered {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}: {}", catalogue.catalogue, catalogue.title);
        let width = catalogue.entries.iter().map(|entry| entry.id.len()).max();
        for entry in &catalogue.entries {
            let _ = writeln!(
                text,
                "  {:width$}  {}",
                entry.id,
                entry.title,
                width = width.unwrap_or(0)
            );
            entry_text(&mut text, entry, width.unwrap_or(0) + 6);
        }
        let count = |state| {
            let entries = catalogue.entries.iter();
            entries.filter(|entry| entry.state == state).count()
        };
        let _ = writeln!(
            text,
            "{} entries: {} covered, {} elsewhere, {} played on no device, {} not covered, {} missing\n",
            catalogue.entries.len(),
            count(State::Covered),
            count(State::Elsewhere),
            count(State::NotPlayed),
            count(State::NotCovered),
            count(State::Missing),
        );
    }
    text
}

fn entry_text(text: &mut String, entry: &CoveredEntry<'_>, indent: usize) {
    let mut line = |words: &str| {
        let _ = writeln!(text, "{:indent$}{words}", "");
    };
    for case in &entry.cases {
        let devices: Vec<&str> = case.devices.iter().map(String::as_str).collect();
        match devices.is_empty() {
            true => line(&format!("{}  (played on no device)", case.case)),
            false => line(&format!("{}  ({})", case.case, devices.join(", "))),
        }
    }
    let because = entry.because.unwrap_or_default();
    match entry.state {
        State::Covered | State::NotPlayed => {}
        State::Elsewhere => line(&format!("elsewhere: {because}")),
        State::NotCovered => line(&format!("not covered: {because}")),
        State::Missing => line("MISSING"),
    }
}
