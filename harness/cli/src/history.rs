//! How long cases took in the run before, which the journal in the folder of reports tells.

use std::collections::HashMap;
use std::path::Path;

use fieldproof_record::{Entry, Event, Verdict};

use crate::journal::JOURNAL;
use crate::reports;

/// The times of the run before.
#[derive(Default)]
pub(crate) struct History {
    times_ns: HashMap<(String, String), u64>,
    sum_ns: u64,
}

impl History {
    /// What the journal in `folder` tells; nothing, if there is none that can be read.
    pub(crate) fn read(folder: &Path) -> History {
        let mut history = History::default();
        let Ok(mut reader) = reports::reader(&folder.join(JOURNAL)) else {
            return history;
        };
        let lanes = reader.start().lanes.clone();
        while let Ok(Some(entry)) = reader.entry(None) {
            let Entry::Lane(lane, Event::CaseFinished(case)) = entry else {
                continue;
            };
            if let Some(lane) = lanes.get(lane as usize)
                && case.verdict != Verdict::Skipped
            {
                history.add(&lane.device, &case.id, case.duration_ns);
            }
        }
        history
    }

    pub(crate) fn add(&mut self, device: &str, id: &str, time_ns: u64) {
        self.sum_ns = self.sum_ns.saturating_add(time_ns);
        self.times_ns
            .insert((device.to_owned(), id.to_owned()), time_ns);
    }

    /// How long the case took.
    pub(crate) fn of(&self, device: &str, id: &str) -> Option<u64> {
        self.times_ns
            .get(&(device.to_owned(), id.to_owned()))
            .copied()
    }

    /// How long a case took on average; 0 if nothing is known.
    pub(crate) fn mean_ns(&self) -> u64 {
        self.sum_ns
            .checked_div(self.times_ns.len() as u64)
            .unwrap_or(0)
    }
}
