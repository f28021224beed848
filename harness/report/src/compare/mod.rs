//! Two runs side by side: what fails now, what does no more, and which times have moved.

mod collect;
mod html;
mod statistics;
mod text;

use std::collections::BTreeMap;

use fieldproof_record::{RunStarted, Setting, Verdict};
use schemars::JsonSchema;
use serde::Serialize;

pub use collect::{CollectedCase, CollectedLane, Collector};
pub use html::comparison_html;
pub use text::comparison_text;

use statistics::{holm, moved};

/// Accepted failures, as far as a comparison needs to know of them.
pub trait Accepts {
    /// Why a failure of `case` on `device` with `firmware` is accepted, if it is.
    fn reason(&mut self, device: &str, firmware: Option<&str>, case: &str) -> Option<String>;
    /// Takes note of a case that did not fail, for waivers that are not needed any more.
    fn passes(&mut self, device: &str, firmware: Option<&str>, case: &str);
}

/// Two runs side by side.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Comparison {
    /// The run before.
    pub old: ComparedRun,
    /// The run after.
    pub new: ComparedRun,
    /// Device by device.
    pub devices: Vec<DeviceComparison>,
    /// What there is to say of the waivers.
    pub waivers: Vec<String>,
    /// Whether an accepted failure is accepted no more.
    pub waiver_expired: bool,
    /// Whether something is worse than before.
    pub regressed: bool,
}

/// One of two runs.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ComparedRun {
    /// Where its journal is.
    pub path: String,
    /// When it started.
    pub started: String,
    /// What played it.
    pub tool: String,
    /// What was said about it.
    pub settings: Vec<Setting>,
    /// Whether every lane came to its end.
    pub complete: bool,
}

/// One device in both runs.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct DeviceComparison {
    /// Its name.
    pub device: String,
    /// Its firmware before, as it was read or as `--set firmware` says.
    pub old_firmware: Option<String>,
    /// Its firmware after.
    pub new_firmware: Option<String>,
    /// Passed or was not played, and fails.
    pub newly_failing: Vec<Change>,
    /// Failed, and passes.
    pub fixed: Vec<Change>,
    /// Fails as before.
    pub still_failing: Vec<Change>,
    /// Was not there.
    pub new: Vec<Change>,
    /// Is not there any more, or is not played any more.
    pub gone: Vec<Change>,
    /// Passes and deviates from its standard as documented, or the other way round; or is played now.
    pub otherwise: Vec<Change>,
    /// How many cases came to the same.
    pub same: u64,
    /// Measurements that have moved.
    pub moved: Vec<MovedSeries>,
    /// Measurements that could be compared and have not moved.
    pub steady: Vec<MovedSeries>,
}

/// A case that did not come to the same.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Change {
    /// Its id.
    pub id: String,
    /// One line.
    pub title: String,
    /// Its verdict before.
    pub old: Option<Verdict>,
    /// Its verdict after.
    pub new: Option<Verdict>,
    /// What was found, in one sentence; of the new run, or else of the old.
    pub what: String,
    /// Why its failure is accepted.
    pub waived: Option<String>,
}

/// A measurement in both runs: the median of each case, case by case.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct MovedSeries {
    /// What was measured.
    pub name: String,
    /// In how many cases of both runs.
    pub cases: usize,
    /// The median of the cases before.
    pub old_median_ns: u64,
    /// And after.
    pub new_median_ns: u64,
    /// The median of how much each case changed: 0.1 for a tenth more.
    pub change: f64,
    /// How likely so much is by chance alone, corrected for the number of measurements.
    pub p: f64,
    /// The largest share of its limit that a value took before and after.
    pub of_limit: (Option<f64>, Option<f64>),
}

/// The JSON Schema of a comparison.
pub fn comparison_schema() -> serde_json::Value {
    schemars::schema_for!(Comparison).to_value()
}

/// A run, read from its journal.
#[derive(Debug, Clone, Default)]
pub struct CollectedRun {
    /// Where its journal is.
    pub path: String,
    /// Its first line.
    pub start: RunStarted,
    /// Its lanes.
    pub lanes: Vec<CollectedLane>,
}

impl CollectedRun {
    fn head(&self) -> ComparedRun {
        ComparedRun {
            path: self.path.clone(),
            started: self.start.started.clone(),
            tool: self.start.tool.clone(),
            settings: self.start.settings.clone(),
            complete: self.lanes.iter().all(|lane| lane.complete),
        }
    }

    fn firmware(&self, lane: &CollectedLane) -> Option<String> {
        let said = self.start.settings.iter().find(|it| it.key == "firmware");
        said.map(|it| it.value.clone())
            .or_else(|| lane.firmware.clone())
    }
}

/// Compares two runs, device by device.
pub fn compare_runs(
    old: &CollectedRun,
    new: &CollectedRun,
    strict: bool,
    accepts: &mut dyn Accepts,
) -> Comparison {
    let mut devices = Vec::new();
    for lane in &new.lanes {
        let before = old.lanes.iter().find(|it| it.device == lane.device);
        let mut device = DeviceComparison {
            device: lane.device.clone(),
            old_firmware: before.and_then(|before| old.firmware(before)),
            new_firmware: new.firmware(lane),
            ..DeviceComparison::default()
        };
        let none = CollectedLane::default();
        let before = before.unwrap_or(&none);
        device.cases(before, lane, strict, accepts);
        device.measurements(before, lane);
        devices.push(device);
    }
    for lane in &old.lanes {
        if new.lanes.iter().any(|it| it.device == lane.device) {
            continue;
        }
        let mut device = DeviceComparison {
            device: lane.device.clone(),
            old_firmware: old.firmware(lane),
            ..DeviceComparison::default()
        };
        device.cases(lane, &CollectedLane::default(), strict, accepts);
        devices.push(device);
    }
    let fails = |device: &DeviceComparison| {
        let mut newly = device.newly_failing.iter();
        newly.any(|it| it.waived.is_none())
    };
    Comparison {
        regressed: devices.iter().any(fails),
        old: old.head(),
        new: new.head(),
        devices,
        waivers: Vec::new(),
        waiver_expired: false,
    }
}

fn fails(verdict: Verdict, strict: bool) -> bool {
    match verdict {
        Verdict::Pass | Verdict::Skipped => false,
        Verdict::Deviation => strict,
        Verdict::Inconclusive | Verdict::Fail | Verdict::Error => true,
    }
}

impl DeviceComparison {
    fn cases(
        &mut self,
        old: &CollectedLane,
        new: &CollectedLane,
        strict: bool,
        accepts: &mut dyn Accepts,
    ) {
        let firmware = self.new_firmware.clone();
        let firmware = firmware.as_deref();
        for (id, now) in &new.cases {
            let before = old.cases.get(id);
            let mut change = Change {
                id: id.clone(),
                title: now.title.clone(),
                old: before.map(|it| it.verdict),
                new: Some(now.verdict),
                what: now.what.clone(),
                waived: None,
            };
            let fails_now = fails(now.verdict, strict);
            if fails_now {
                change.waived = accepts.reason(&new.device, firmware, id);
            } else if now.verdict != Verdict::Skipped {
                accepts.passes(&new.device, firmware, id);
            }
            let Some(before) = before else {
                self.new.push(change);
                continue;
            };
            let list = match (fails(before.verdict, strict), fails_now) {
                (true, true) => &mut self.still_failing,
                (false, true) => &mut self.newly_failing,
                (_, false) if now.verdict == before.verdict => {
                    self.same += 1;
                    continue;
                }
                (_, false) if now.verdict == Verdict::Skipped => &mut self.gone,
                (true, false) => &mut self.fixed,
                (false, false) => &mut self.otherwise,
            };
            list.push(change);
        }
        let left = old
            .cases
            .iter()
            .filter(|(id, _)| !new.cases.contains_key(*id));
        self.gone.extend(left.map(|(id, before)| Change {
            id: id.clone(),
            title: before.title.clone(),
            old: Some(before.verdict),
            new: None,
            what: before.what.clone(),
            waived: None,
        }));
    }

    fn measurements(&mut self, old: &CollectedLane, new: &CollectedLane) {
        let mut compared = Vec::new();
        for (name, after) in &new.measured {
            let Some(before) = old.measured.get(name) else {
                continue;
            };
            let pairs = pairs(&before.medians, &after.medians);
            let uncertainty = before.uncertainty_ns.max(after.uncertainty_ns);
            if let Some(mut series) = moved(name, &pairs, uncertainty) {
                series.0.of_limit = (before.of_limit, after.of_limit);
                compared.push(series);
            }
        }
        let mut chances: Vec<f64> = compared.iter().map(|(series, _)| series.p).collect();
        holm(&mut chances);
        for ((mut series, matters), p) in compared.into_iter().zip(chances) {
            series.p = p;
            match matters && p < statistics::SIGNIFICANT {
                true => self.moved.push(series),
                false => self.steady.push(series),
            }
        }
    }
}

/// The values of the cases that both have.
fn pairs(old: &BTreeMap<String, u64>, new: &BTreeMap<String, u64>) -> Vec<(u64, u64)> {
    let of_both = old.iter().filter_map(|(id, before)| {
        let after = new.get(id)?;
        Some((*before, *after))
    });
    of_both.collect()
}
