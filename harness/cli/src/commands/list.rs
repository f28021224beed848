//! `fieldproof list`

mod coverage;

use std::fmt::Write;

use fieldproof_run::{effect_name, feature_name};
use fieldproof_suite::model::{Case, Citation, Need, StimulusName};
use fieldproof_suite::{Environment, Suite};
use serde::Serialize;

use crate::complaint::Complaint;
use crate::exit::Exit;
use crate::library::Library;
use crate::options::{Format, ListOptions};
use crate::player::Plan;
use crate::screen::Screen;
use crate::select;

#[derive(Serialize)]
struct ListedCase<'a> {
    id: String,
    title: String,
    suite: &'a str,
    sources: Vec<ListedSource>,
    against: Vec<ListedSource>,
    examples: Vec<String>,
    needs: Vec<String>,
    effects: Vec<&'static str>,
    path: &'a str,
    line: u32,
}

#[derive(Serialize)]
struct ListedSource {
    document: String,
    section: Option<String>,
}

/// Lists the selected cases of the selected suites; of all devices if none is selected.
pub(crate) fn list(options: &ListOptions, screen: &mut Screen) -> Result<Exit, Complaint> {
    let library = Library::load(&options.selection)?;
    let plan = Plan {
        cases: options.selection.cases.clone(),
        ..Plan::default()
    };
    select::patterns_must_match(&library, &plan)?;
    if options.coverage {
        return coverage::show(&library, &plan, options, screen);
    }
    let for_some_device = |suite: &&Suite| {
        options.selection.devices.is_empty()
            || library
                .devices
                .iter()
                .any(|device| select::is_for(suite, device))
    };
    // What a description fills is known where one device is asked for.
    let suites = match library.devices.as_slice() {
        [device] if !options.selection.devices.is_empty() => &device.suites,
        _ => &library.suites,
    };
    let mut listed = Vec::new();
    for suite in suites.iter().filter(for_some_device) {
        let environment = environment(&library, suite);
        let cases = suite.cases().filter(|case| case.absent().is_none());
        for case in cases.filter(|case| plan.selects(&case.id())) {
            match case.lower(&environment) {
                Ok(lowered) => listed.push(ListedCase {
                    title: match case.is_open() {
                        true => case.title_as_written().to_owned(),
                        false => lowered.title.clone(),
                    },
                    ..listed_case(suite, lowered)
                }),
                Err(diagnostics) => {
                    let text = std::sync::Arc::default();
                    let problems = diagnostics
                        .iter()
                        .map(|it| crate::problems::of_diagnostic(it, &text));
                    return Err(Complaint::inputs(problems.collect()));
                }
            }
        }
    }
    if listed.is_empty() {
        return Err(select::nothing_selected());
    }
    match options.format {
        Format::Json => screen.print_json(&listed),
        Format::Text => screen.print(&text(&listed)),
    }
    Ok(Exit::Passed)
}

/// The node and address of a device that the suite is for; any numbers if there is none.
fn environment(library: &Library, suite: &Suite) -> Environment {
    let device = library
        .devices
        .iter()
        .find(|device| select::is_for(suite, device));
    let description = device.map(|device| &device.description);
    let node = description
        .and_then(|it| it.canopen.as_ref())
        .map(|canopen| canopen.node);
    let address = description
        .and_then(|it| it.modbus.as_ref())
        .map(|modbus| modbus.address);
    Environment {
        node: node.or(Some(1)),
        address: address.or(Some(1)),
        identity: description.map_or([None; 4], |it| it.identity.numbers()),
    }
}

fn listed_case(suite: &Suite, case: Case) -> ListedCase<'_> {
    let sources = |cites: Vec<Citation>| {
        let listed = |cite: Citation| ListedSource {
            document: cite.document,
            section: cite.section,
        };
        cites.into_iter().map(listed).collect()
    };
    let need = |need: &Need| match need {
        Need::Feature(feature) => feature_name(*feature).to_owned(),
        Need::Stimulus(stimulus) => match stimulus {
            StimulusName::Power => "stimulus: power",
            StimulusName::ProcessValue => "stimulus: process-value",
            StimulusName::Condition => "stimulus: condition",
            StimulusName::Setting => "stimulus: setting",
        }
        .to_owned(),
        Need::Objects(objects) => {
            let shown = objects
                .iter()
                .map(|object| format!("{:04X}:{:02X}", object.index, object.sub));
            format!("object: {}", shown.collect::<Vec<_>>().join(", "))
        }
        Need::Functions(functions) => {
            let shown = functions.iter().map(ToString::to_string);
            format!("function: {}", shown.collect::<Vec<_>>().join(", "))
        }
        Need::AnotherNode(node) => format!("another-node: {node}"),
        Need::AnotherAddress(address) => format!("another-address: {address}"),
    };
    ListedCase {
        suite: &suite.head.suite,
        sources: sources(case.cites),
        against: sources(case.against),
        examples: case.examples,
        needs: case.needs.iter().map(need).collect(),
        effects: case
            .effects
            .iter()
            .map(|effect| effect_name(*effect))
            .collect(),
        path: &suite.path,
        line: case.at.line,
        id: case.id,
        title: case.title,
    }
}

fn text(listed: &[ListedCase<'_>]) -> String {
    let mut text = String::new();
    let mut suite = "";
    for case in listed {
        if case.suite != suite {
            let gap = if suite.is_empty() { "" } else { "\n" };
            suite = case.suite;
            let count = listed.iter().filter(|other| other.suite == suite).count();
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{gap}{suite}  ({count}, {})", case.path);
        }
        let _ = writeln!(text, "  {}\n      {}", case.id, case.title);
        let mut more: Vec<String> = Vec::new();
        if !case.needs.is_empty() {
            more.push(format!("needs {}", case.needs.join(", ")));
        }
        if !case.effects.is_empty() {
            more.push(format!("effects {}", case.effects.join(", ")));
        }
        if !more.is_empty() {
            let _ = writeln!(text, "      {}", more.join("; "));
        }
    }
    let _ = writeln!(text, "\n{} cases", listed.len());
    text
}
