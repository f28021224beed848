//! `fieldproof run --dry-run`

use std::fmt::Write;

use serde::Serialize;

use crate::complaint::Complaint;
use crate::exit::Exit;
use crate::library::Device;
use crate::options::{Format, RunOptions};
use crate::player::{self, Plan, PlannedCase};
use crate::screen::Screen;

#[derive(Serialize)]
struct Planned<'a> {
    device: &'a str,
    suite: &'a str,
    case: String,
    skipped: Option<String>,
}

/// Shows what would be played on what, and what is skipped and why.
pub(super) fn show(
    devices: &[&Device],
    plan: &Plan,
    options: &RunOptions,
    screen: &mut Screen,
) -> Result<Exit, Complaint> {
    let mut text = String::new();
    let mut all = Vec::new();
    for device in devices {
        let preview =
            player::preview(device, plan).map_err(|error| Complaint::bench(error.to_string()))?;
        for (suite, cases) in preview {
            let suite = suite.head.suite.as_str();
            text.push_str(&suite_text(suite, device.name(), &cases, options.quiet));
            all.extend(cases.into_iter().map(|case| Planned {
                device: device.name(),
                suite,
                case: case.id,
                skipped: case.skipped,
            }));
        }
    }
    match options.format {
        Format::Json => screen.print_json(&all),
        Format::Text => {
            let skipped = all.iter().filter(|case| case.skipped.is_some()).count();
            let played = all.len() - skipped;
            screen.print(&format!(
                "{text}\n{played} would be played, {skipped} skipped\n"
            ));
        }
    }
    Ok(Exit::Passed)
}

fn suite_text(suite: &str, device: &str, cases: &[PlannedCase], quiet: bool) -> String {
    let skipped = cases.iter().filter(|case| case.skipped.is_some()).count();
    let played = cases.len() - skipped;
    let mut text = format!("{suite} on {device}: {played} to play, {skipped} to skip\n");
    for case in cases {
        // Writing to a string cannot fail.
        let _ = match &case.skipped {
            Some(reason) => writeln!(text, "  skip  {}\n        {reason}", case.id),
            None if quiet => Ok(()),
            None => writeln!(text, "  play  {}\n        {}", case.id, case.title),
        };
    }
    text
}
