//! `fieldproof report`

use fieldproof_report::left_text;

use crate::complaint::Complaint;
use crate::exit::Exit;
use crate::options::{Format, ReportOptions};
use crate::reports;
use crate::screen::{INK, Screen};

/// Makes all reports from the journal of a run, whether or not it came to its end.
pub(crate) fn report(options: &ReportOptions, screen: &mut Screen) -> Result<Exit, Complaint> {
    let made = reports::make(&options.folder)?;
    let strict = made.start.strict;
    match options.format {
        Format::Json => screen.print_json(&made.lanes),
        Format::Text => {
            screen.print(&left_text(&made.lanes, strict, INK));
            screen.print(&format!("reports are in {}\n", options.folder.display()));
        }
    }
    Ok(Exit::of_run(&made.lanes, strict))
}
