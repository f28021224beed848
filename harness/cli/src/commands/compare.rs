//! `fieldproof compare`

use std::path::Path;

use fieldproof_record::Entry;
use fieldproof_report::compare::{
    CollectedRun, Collector, Comparison, compare_runs, comparison_html, comparison_text,
};

use crate::complaint::Complaint;
use crate::day;
use crate::exit::Exit;
use crate::options::{CompareFormat, CompareOptions};
use crate::reports;
use crate::screen::{INK, Screen};
use crate::waivers::Waived;

/// Puts two runs side by side.
pub(crate) fn compare(options: &CompareOptions, screen: &mut Screen) -> Result<Exit, Complaint> {
    let mut waived = match &options.waivers {
        Some(path) => Waived::read(path, &day::today())?,
        None => Waived::default(),
    };
    let old = collect(&options.old)?;
    let new = collect(&options.new)?;
    let strict = options.strict || new.start.strict;
    let mut comparison = compare_runs(&old, &new, strict, &mut waived);
    (comparison.waivers, comparison.waiver_expired) = waived.outcome();
    match options.format {
        CompareFormat::Text => screen.print(&comparison_text(&comparison, INK)),
        CompareFormat::Json => screen.print_json(&comparison),
        CompareFormat::Html => screen.print(&comparison_html(&comparison)),
    }
    Ok(exit(&comparison, options.fail_on_slower))
}

fn exit(comparison: &Comparison, fail_on_slower: bool) -> Exit {
    let mut moved = comparison.devices.iter().flat_map(|device| &device.moved);
    let slower = fail_on_slower && moved.any(|series| series.change > 0.0);
    if comparison.regressed || comparison.waiver_expired || slower {
        Exit::Failed
    } else if !comparison.new.complete {
        Exit::Broken
    } else {
        Exit::Passed
    }
}

/// Everything of the run in `path`, a folder of reports or a journal.
fn collect(path: &Path) -> Result<CollectedRun, Complaint> {
    let journal = match path.is_dir() {
        true => path.join(crate::journal::JOURNAL),
        false => path.to_owned(),
    };
    let mut reader = reports::reader(&journal)?;
    let start = reader.start().clone();
    let lanes = start.lanes.iter();
    let mut lanes: Vec<Collector> = lanes.map(|lane| Collector::new(&lane.device)).collect();
    loop {
        let entry = reader.entry(None);
        match entry.map_err(|error| reports::unreadable(&journal, &error))? {
            Some(Entry::Lane(lane, event)) => {
                if let Some(lane) = lanes.get_mut(lane as usize) {
                    lane.event(&event);
                }
            }
            Some(_) => {}
            None => break,
        }
    }
    Ok(CollectedRun {
        path: path.display().to_string(),
        start,
        lanes: lanes.into_iter().map(Collector::finish).collect(),
    })
}
