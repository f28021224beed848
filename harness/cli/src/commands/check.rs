//! `fieldproof check`

use fieldproof_report::Problem;

use crate::complaint::Complaint;
use crate::exit::Exit;
use crate::library::Library;
use crate::options::{CheckOptions, Format, Selection};
use crate::screen::Screen;

/// Reads and checks everything; plays nothing.
pub(crate) fn check(options: &CheckOptions, screen: &mut Screen) -> Result<Exit, Complaint> {
    let selection = Selection {
        suites: options.paths.clone(),
        ..Selection::default()
    };
    let (problems, exit, read) = match Library::load_closely(&selection) {
        Ok(library) => {
            let read = counted(&library);
            (library.warnings, Exit::Passed, read)
        }
        Err(complaint) => (complaint.problems, complaint.exit, String::new()),
    };
    match options.format {
        Format::Json => screen.print_json(&problems),
        Format::Text => {
            screen.complain(&problems);
            match exit {
                Exit::Passed => screen.print(&format!("{read}{}\n", found(&problems))),
                _ => screen.print(&format!("{} found\n", number(problems.len(), "problem"))),
            }
        }
    }
    Ok(exit)
}

fn counted(library: &Library) -> String {
    let cases = library
        .suites
        .iter()
        .map(|suite| suite.cases().count())
        .sum();
    let benches = match library.benches {
        0 => String::new(),
        1 => ", 1 bench".to_owned(),
        count => format!(", {count} benches"),
    };
    format!(
        "{} with {}, {}{benches}: ",
        number(library.suites.len(), "suite"),
        number(cases, "case"),
        number(library.devices.len(), "device"),
    )
}

fn found(problems: &[Problem]) -> String {
    match problems.len() {
        0 => "no mistakes".to_owned(),
        count => number(count, "warning"),
    }
}

fn number(count: usize, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        _ => format!("{count} {what}s"),
    }
}
