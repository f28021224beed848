//! Whether a measurement has moved between two runs (docs/decisions/0011).

use super::MovedSeries;

/// What is rarer by chance than this has moved.
pub(super) const SIGNIFICANT: f64 = 0.001;

/// A change of less than this share is not worth a line, however sure it is.
const LEAST_CHANGE: f64 = 0.05;

/// Fewer pairs than this decide nothing.
const LEAST_PAIRS: usize = 10;

/// The medians of the cases of both runs, and whether they differ by so much that it matters; `None` where there are too
/// few of them. The chance is not corrected yet.
pub(super) fn moved(
    name: &str,
    pairs: &[(u64, u64)],
    uncertainty_ns: u64,
) -> Option<(MovedSeries, bool)> {
    if pairs.len() < LEAST_PAIRS {
        return None;
    }
    let ratio = |(old, new): &(u64, u64)| (*new).max(1) as f64 / (*old).max(1) as f64;
    let logs: Vec<f64> = pairs.iter().map(|pair| ratio(pair).ln()).collect();
    let change = median(logs.clone())?.exp() - 1.0;
    let differences = pairs.iter().map(|(old, new)| old.abs_diff(*new) as f64);
    let difference = median(differences.collect())?;
    let old = median(pairs.iter().map(|(old, _)| *old as f64).collect())?;
    let new = median(pairs.iter().map(|(_, new)| *new as f64).collect())?;
    let matters = change.abs() >= LEAST_CHANGE && difference > uncertainty_ns as f64;
    let series = MovedSeries {
        name: name.to_owned(),
        cases: pairs.len(),
        old_median_ns: old as u64,
        new_median_ns: new as u64,
        change,
        p: signed_rank(&logs),
        of_limit: (None, None),
    };
    Some((series, matters))
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_unstable_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() % 2 {
        0 => Some((values.get(middle.checked_sub(1)?)? + values.get(middle)?) / 2.0),
        _ => values.get(middle).copied(),
    }
}

/// Wilcoxon's signed-rank test, two-sided: how likely differences that are as often above as below zero are so lopsided.
/// Normal approximation with the corrections for ties and continuity; pairs that do not differ are left out.
fn signed_rank(differences: &[f64]) -> f64 {
    let mut differences: Vec<f64> = differences
        .iter()
        .copied()
        .filter(|it| *it != 0.0)
        .collect();
    differences.sort_unstable_by(|one, other| one.abs().total_cmp(&other.abs()));
    let count = differences.len() as f64;
    if differences.len() < LEAST_PAIRS {
        return 1.0;
    }
    let (mut positive, mut ties) = (0.0, 0.0);
    let mut first = 0;
    while let Some(value) = differences.get(first) {
        let like = differences[first..].iter();
        let same = like.take_while(|it| it.abs() == value.abs()).count();
        // Ranks count from 1; those of equal differences are shared.
        let rank = first as f64 + (same as f64 + 1.0) / 2.0;
        let above = differences[first..first + same].iter();
        positive += rank * above.filter(|it| **it > 0.0).count() as f64;
        ties += (same as f64).powi(3) - same as f64;
        first += same;
    }
    let mean = count * (count + 1.0) / 4.0;
    let variance = count * (count + 1.0) * (2.0 * count + 1.0) / 24.0 - ties / 48.0;
    if variance <= 0.0 {
        return 1.0;
    }
    let distance = ((positive - mean).abs() - 0.5).max(0.0);
    libm::erfc(distance / variance.sqrt() / std::f64::consts::SQRT_2)
}

/// Corrects chances for how many there are, after Holm: the smallest counts as often as there are chances, the next once
/// less, and none may come out smaller than one before it.
pub(super) fn holm(chances: &mut [f64]) {
    let mut order: Vec<usize> = (0..chances.len()).collect();
    order.sort_by(|one, other| chances[*one].total_cmp(&chances[*other]));
    let mut least: f64 = 0.0;
    for (place, index) in order.iter().enumerate() {
        let corrected = chances[*index] * (chances.len() - place) as f64;
        least = least.max(corrected.min(1.0));
        chances[*index] = least;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Draws from 0 to 1, the same each time.
    fn draws() -> impl Iterator<Item = f64> {
        let mut state: u64 = 0x9E37_79B9_7F4A_7C15;
        std::iter::repeat_with(move || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1_u64 << 53) as f64
        })
    }

    fn pairs(count: usize, factor: f64) -> Vec<(u64, u64)> {
        let mut draws = draws();
        let mut value = |factor: f64| {
            let draw = draws.next().unwrap();
            (400_000.0 * factor * (1.0 + 0.2 * draw)) as u64
        };
        (0..count).map(|_| (value(1.0), value(factor))).collect()
    }

    #[test]
    fn test_agrees_with_published_values() {
        // The differences of Wilcoxon's own example of 1945 in the form of Hollander and Wolfe; R gives 0.03976 with
        // the normal approximation and its correction for continuity.
        let differences = [
            -0.952, 0.147, -1.022, -0.430, -0.620, -0.590, -0.490, 0.080, -0.010,
        ];
        assert_eq!(signed_rank(&differences), 1.0, "nine pairs decide nothing");
        let ten: Vec<f64> = differences.iter().copied().chain([-0.3]).collect();
        // W+ = 5, mean 27.5, variance 96.25: z = (22.5 - 0.5) / 9.811.
        let expected = libm::erfc(22.0 / 96.25_f64.sqrt() / std::f64::consts::SQRT_2);
        assert!((signed_rank(&ten) - expected).abs() < 1e-12);
        assert!((expected - 0.02494).abs() < 5e-5, "{expected}");
    }

    #[test]
    fn ties_share_their_ranks() {
        let all_up = [1.0; 12];
        // W+ = 78, mean 39, variance 12·13·25/24 - (12³ - 12)/48 = 126.75.
        let expected = libm::erfc(38.5 / 126.75_f64.sqrt() / std::f64::consts::SQRT_2);
        assert!((signed_rank(&all_up) - expected).abs() < 1e-12);
        assert_eq!(signed_rank(&[0.0; 100]), 1.0);
    }

    #[test]
    fn a_tenth_more_is_seen_and_the_same_again_is_not() {
        let (series, matters) = moved("SDO response time", &pairs(200, 1.1), 1_000).unwrap();
        assert!(matters && series.p < 1e-6, "{series:?}");
        assert!((series.change - 0.1).abs() < 0.03, "{series:?}");
        let (series, matters) = moved("SDO response time", &pairs(200, 1.0), 1_000).unwrap();
        assert!(!matters || series.p > SIGNIFICANT, "{series:?}");
        // What is below the uncertainty of the link is no news.
        let (_, matters) = moved("SDO response time", &pairs(200, 1.1), 1_000_000).unwrap();
        assert!(!matters);
        assert!(moved("SDO response time", &pairs(9, 2.0), 0).is_none());
    }

    #[test]
    fn the_same_firmware_is_seldom_blamed() {
        let mut draws = draws();
        let mut blamed = 0;
        for _ in 0..2_000 {
            let mut value = || (1e6 * (1.0 + draws.next().unwrap())) as u64;
            let pairs: Vec<(u64, u64)> = (0..30).map(|_| (value(), value())).collect();
            let (series, matters) = moved("it", &pairs, 0).unwrap();
            blamed += u32::from(matters && series.p < SIGNIFICANT);
        }
        // One in a thousand by definition: 2, and 9 or more once in five thousand times.
        assert!(blamed < 9, "{blamed}");
    }

    #[test]
    fn chances_are_corrected_for_their_number() {
        let mut chances = [0.03, 0.01, 0.5];
        holm(&mut chances);
        assert_eq!(chances, [0.06, 0.03, 0.5]);
        let mut chances = [0.9, 0.8];
        holm(&mut chances);
        assert_eq!(chances, [1.0, 1.0]);
        holm(&mut []);
    }
}
