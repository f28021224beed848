//! The stamps of an adapter, which begin anew again and again, on the clock of the lane.

use std::time::Duration;

use super::super::hardware_clock::HardwareClock;
use super::codec::Stamp;
use crate::Instant;

/// After how many microseconds stamps of milliseconds begin anew.
const MINUTE_US: i128 = 60_000_000;

/// After how many microseconds stamps of microseconds begin anew, by adapter.
const HOUR_US: i128 = 3_600_000_000;
const WORD_US: i128 = 1 << 32;

/// Puts the stamps of an adapter on the lane's clock. How often they have begun anew since the last one follows from the
/// time between the arrivals.
#[derive(Debug, Default)]
pub(super) struct AdapterClock {
    last: Option<Last>,
    hardware: HardwareClock,
}

#[derive(Debug, Clone, Copy)]
struct Last {
    stamp_us: i128,
    /// Without beginning anew. It begins at a day, so that an early stamp cannot be before zero.
    counted_us: i128,
    arrived: Instant,
}

impl AdapterClock {
    /// The instant of `stamp`, of something that arrived at `arrived`.
    pub(super) fn at(&mut self, stamp: Stamp, arrived: Instant) -> Instant {
        let (stamp_us, anew) = match stamp {
            Stamp::Milliseconds(stamp) => (i128::from(stamp) * 1_000, [MINUTE_US; 2]),
            Stamp::Microseconds(stamp) => (stamp.into(), [HOUR_US, WORD_US]),
        };
        let counted_us = match self.last {
            None => 24 * HOUR_US,
            Some(last) => {
                let passed_us = arrived.since(last.arrived).as_micros() as i128;
                let candidates = anew.map(|anew| {
                    let ahead = (stamp_us - last.stamp_us).rem_euclid(anew);
                    let times = (passed_us - ahead + anew / 2).div_euclid(anew);
                    ahead + times * anew
                });
                let nearest = candidates
                    .into_iter()
                    .min_by_key(|it| it.abs_diff(passed_us));
                last.counted_us + nearest.unwrap_or(0)
            }
        };
        self.last = Some(Last {
            stamp_us,
            counted_us,
            arrived,
        });
        let counted_us = u64::try_from(counted_us).unwrap_or(0);
        self.hardware.at(Duration::from_micros(counted_us), arrived)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const START: Instant = Instant::from_nanos(5_000_000_000);

    fn us(microseconds: u64) -> Duration {
        Duration::from_micros(microseconds)
    }

    #[test]
    fn a_minute_that_begins_anew_is_no_step_back() {
        let mut clock = AdapterClock::default();
        let first = clock.at(Stamp::Milliseconds(59_999), START);
        let second = clock.at(Stamp::Milliseconds(4), START + us(5_300));
        assert_eq!(second.since(first), us(5_000));
    }

    #[test]
    fn a_step_back_is_not_a_minute() {
        let mut clock = AdapterClock::default();
        let first = clock.at(Stamp::Milliseconds(500), START);
        let second = clock.at(Stamp::Milliseconds(499), START + us(10));
        assert_eq!(first.since(second), us(1_000));
    }

    #[test]
    fn both_kinds_of_microseconds_begin_anew() {
        for anew in [HOUR_US, WORD_US] {
            let mut clock = AdapterClock::default();
            let before = u32::try_from(anew - 100).unwrap();
            let first = clock.at(Stamp::Microseconds(before), START);
            let second = clock.at(Stamp::Microseconds(200), START + us(300));
            assert_eq!(second.since(first), us(300));
        }
    }

    proptest! {
        /// Whatever the pauses and the delays: an instant is never later than the arrival, and never earlier than the
        /// stamp could be by more than the resolution of the stamp and the longest delay.
        #[test]
        fn an_instant_is_off_by_the_resolution_at_most(
            phase_us in 0..60_000_000u64,
            steps in proptest::collection::vec((0..200_000_000u64, 0..900u64), 1..40),
        ) {
            let mut clock = AdapterClock::default();
            let mut time_us = 0;
            for (pause_us, delay_us) in steps {
                time_us += pause_us;
                let stamp = ((time_us + phase_us) / 1_000 % 60_000) as u16;
                let arrived = START + us(time_us + delay_us);
                let at = clock.at(Stamp::Milliseconds(stamp), arrived);
                prop_assert!(at <= arrived);
                let true_instant = START + us(time_us);
                let off = true_instant.since(at).max(at.since(true_instant));
                prop_assert!(off <= us(1_900), "{off:?}");
            }
        }
    }
}
