//! Measured values against limits.

use std::time::Duration;

use fieldproof_record::{Limits, Verdict};

/// Inside the limits with the whole uncertainty: pass. Outside with the whole uncertainty: fail. Else nobody can say.
pub(crate) fn judge(measured: Duration, uncertainty: Duration, limits: Limits) -> Verdict {
    let measured_ns = nanoseconds(measured);
    let uncertainty_ns = nanoseconds(uncertainty);
    let lowest = measured_ns.saturating_sub(uncertainty_ns);
    let highest = measured_ns.saturating_add(uncertainty_ns);
    let min_ns = limits.min_ns.unwrap_or(0);
    let max_ns = limits.max_ns.unwrap_or(u64::MAX);
    if lowest >= min_ns && highest <= max_ns {
        Verdict::Pass
    } else if highest < min_ns || lowest > max_ns {
        Verdict::Fail
    } else {
        Verdict::Inconclusive
    }
}

pub(crate) fn nanoseconds(duration: Duration) -> u64 {
    u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX)
}

/// `213 us`, `1.5 ms`, `2 s`: at most three decimals of the largest fitting unit.
pub(crate) fn show(duration: Duration) -> String {
    let nanoseconds = duration.as_nanos();
    let (unit, name) = match nanoseconds {
        0 => return "0 ms".into(),
        1..1_000 => (1, "ns"),
        1_000..1_000_000 => (1_000, "us"),
        1_000_000..1_000_000_000 => (1_000_000, "ms"),
        _ => (1_000_000_000, "s"),
    };
    let whole = nanoseconds / unit;
    let thousandths = nanoseconds % unit * 1_000 / unit;
    let text = format!("{whole}.{thousandths:03}");
    format!(
        "{} {name}",
        text.trim_end_matches('0').trim_end_matches('.')
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ms(value: u64) -> Duration {
        Duration::from_millis(value)
    }

    fn between(min: u64, max: u64) -> Limits {
        Limits {
            min_ns: Some(min * 1_000_000),
            max_ns: Some(max * 1_000_000),
        }
    }

    #[test]
    fn uncertainty_across_a_limit_decides_nothing() {
        assert_eq!(judge(ms(100), ms(5), between(95, 105)), Verdict::Pass);
        assert_eq!(
            judge(ms(101), ms(5), between(95, 105)),
            Verdict::Inconclusive
        );
        assert_eq!(
            judge(ms(94), ms(5), between(95, 105)),
            Verdict::Inconclusive
        );
        assert_eq!(judge(ms(89), ms(5), between(95, 105)), Verdict::Fail);
        assert_eq!(judge(ms(111), ms(5), between(95, 105)), Verdict::Fail);
        assert_eq!(
            judge(
                ms(111),
                ms(5),
                Limits {
                    min_ns: Some(1),
                    max_ns: None
                }
            ),
            Verdict::Pass
        );
    }

    #[test]
    fn durations_read_well() {
        assert_eq!(show(Duration::from_nanos(213_400)), "213.4 us");
        assert_eq!(show(Duration::from_millis(1_500)), "1.5 s");
        assert_eq!(show(Duration::from_micros(2_000)), "2 ms");
        assert_eq!(show(Duration::ZERO), "0 ms");
    }
}
