//! Measured times: how they are distributed, and where in their limits periods lie.

use std::collections::BTreeMap;

use fieldproof_record::{Measurement, Verdict};

/// So many periods are drawn.
const MOST_PERIODS: usize = 2_000;

/// All times of one name.
#[derive(Debug, Default)]
pub(super) struct Series {
    pub(super) values_ns: Vec<u64>,
    /// The tightest upper limit, if all have one.
    pub(super) max_ns: Option<u64>,
    /// The largest share of its own limit that a value took.
    pub(super) nearest: Option<f64>,
}

impl Series {
    /// The value that this share of all does not exceed; the values are sorted.
    pub(super) fn quantile(&self, share: f64) -> u64 {
        let last = self.values_ns.len().saturating_sub(1);
        let index = (share * last as f64).round() as usize;
        self.values_ns.get(index).copied().unwrap_or(0)
    }
}

/// A period with limits on both sides.
#[derive(Debug)]
pub(super) struct Period {
    pub(super) name: String,
    pub(super) case: String,
    pub(super) value_ns: u64,
    pub(super) uncertainty_ns: u64,
    pub(super) min_ns: u64,
    pub(super) max_ns: u64,
    pub(super) verdict: Verdict,
}

/// Everything that was measured on a lane.
#[derive(Debug, Default)]
pub(super) struct Measured {
    pub(super) series: BTreeMap<String, Series>,
    pub(super) periods: Vec<Period>,
    pub(super) periods_left_out: u64,
}

impl Measured {
    pub(super) fn measurement(&mut self, it: &Measurement, case: &str) {
        if let (Some(min_ns), Some(max_ns)) = (it.limits.min_ns, it.limits.max_ns)
            && it.name.contains("period")
        {
            if self.periods.len() == MOST_PERIODS {
                self.periods_left_out += 1;
                return;
            }
            self.periods.push(Period {
                name: it.name.to_string(),
                case: case.to_owned(),
                value_ns: it.value_ns,
                uncertainty_ns: it.uncertainty_ns,
                min_ns,
                max_ns,
                verdict: it.verdict,
            });
            return;
        }
        let series = match self.series.get_mut(it.name.as_ref()) {
            Some(series) => series,
            None => self.series.entry(it.name.to_string()).or_default(),
        };
        series.max_ns = match (series.max_ns, it.limits.max_ns) {
            (Some(one), Some(other)) => Some(one.min(other)),
            (one, other) => one.or(other),
        };
        if let Some(max) = it.limits.max_ns.filter(|max| *max > 0) {
            let share = it.value_ns as f64 / max as f64;
            series.nearest = Some(series.nearest.map_or(share, |nearest| nearest.max(share)));
        }
        series.values_ns.push(it.value_ns);
    }
}
