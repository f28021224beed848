//! The compliance report: one HTML file without outside references.
//!
//! Its head says what was found and on what; this is plain HTML. The cases, of which there may be a hundred thousand, are
//! packed: an index of all, and the exchanges of a few hundred at a time, which a script unpacks when they are looked at.
//! So no more than one case is held in memory while the report is made, and no more than is looked at when it is read.

mod bus_load;
mod coverage;
mod exchange;
mod facts;
mod failures;
mod lane;
mod markup;
mod measured;
mod pack;
mod page;
mod plots;
mod series;
mod shell;

pub(crate) use failures::breakable;
pub(crate) use markup::{badge, escape, time};
pub(crate) use plots::percent;
pub(crate) use shell::shell;

use std::io::{self, Read, Seek, Write};

use fieldproof_record::{Event, RunStarted};

use crate::summary::LaneSummary;
use lane::Lane;
use pack::Packed;

/// Makes the report as the events of one lane after the other come.
pub struct Html<S> {
    run: RunStarted,
    lanes: Vec<Lane>,
    packed: Packed<S>,
}

impl<S: Read + Write + Seek> Html<S> {
    /// What is packed waits in `spool`, which is empty, until the head can be written.
    pub fn new(run: &RunStarted, spool: S) -> Html<S> {
        Html {
            run: run.clone(),
            lanes: Vec::new(),
            packed: Packed::new(spool),
        }
    }

    /// Begins the lane of `device`.
    pub fn begin_lane(&mut self, device: &str) {
        self.packed.begin_lane(device);
        self.lanes.push(Lane::new(device, self.lanes.len()));
    }

    /// One more event of the lane.
    ///
    /// # Errors
    /// What the spool says.
    pub fn event(&mut self, event: &Event) -> io::Result<()> {
        let Some(lane) = self.lanes.last_mut() else {
            return Ok(());
        };
        if let Event::SuiteStarted(suite) = event {
            self.packed.begin_suite(&suite.suite, &suite.title);
        }
        match lane.event(event, self.packed.cases()) {
            Some(case) => self.packed.case(&case),
            None => Ok(()),
        }
    }

    /// Writes the report.
    ///
    /// # Errors
    /// What the output or the spool says.
    pub fn finish(self, out: &mut impl Write, incomplete: Option<&str>) -> io::Result<()> {
        page::write(out, &self.run, &self.lanes, incomplete)?;
        self.packed.finish(out)?;
        page::write_end(out)
    }
}

/// A verdict on a whole lane, in words that an auditor uses.
fn verdict_of(summary: &LaneSummary, strict: bool) -> (&'static str, &'static str) {
    let counts = summary.counts;
    let deviations = if strict { counts.deviation } else { 0 };
    match () {
        () if counts.fail + deviations > 0 => ("fail", "Failed"),
        () if counts.error > 0 => ("error", "Bench error"),
        () if !summary.complete || summary.stopped.is_some() => ("error", "Incomplete"),
        () if counts.inconclusive > 0 => ("inconclusive", "Inconclusive"),
        () if counts.total() == counts.skipped => ("inconclusive", "Nothing played"),
        () => ("pass", "Passed"),
    }
}
