//! The clock of an adapter that stamps frames, on the clock of the lane.

use std::collections::VecDeque;
use std::time::Duration;

use crate::Instant;

/// How long a comparison counts: crystals drift by up to 100 us a second against each other.
const WINDOW: Duration = Duration::from_secs(2);

/// Puts the stamps of an adapter on the lane's clock. A stamp is never later than the frame's arrival at the kernel, so
/// of the latest frames the one that was handed over fastest says best how far the two clocks are apart.
#[derive(Debug, Clone, Default)]
pub(super) struct HardwareClock {
    /// Lane instants and how many nanoseconds the lane's clock was ahead of the stamp; ahead by less as they go on.
    ahead: VecDeque<(Instant, i128)>,
}

impl HardwareClock {
    /// The instant of `stamp`, of a frame that the kernel saw at `arrived`.
    pub(super) fn at(&mut self, stamp: Duration, arrived: Instant) -> Instant {
        let stamp_ns = stamp.as_nanos() as i128;
        let ahead = i128::from(arrived.as_nanos()) - stamp_ns;
        while self.ahead.back().is_some_and(|(_, other)| *other >= ahead) {
            self.ahead.pop_back();
        }
        self.ahead.push_back((arrived, ahead));
        while self
            .ahead
            .front()
            .is_some_and(|(at, _)| arrived.since(*at) > WINDOW)
        {
            self.ahead.pop_front();
        }
        let least = self.ahead.front().map_or(ahead, |(_, least)| *least);
        Instant::from_nanos(u64::try_from(stamp_ns + least).unwrap_or(0)).min(arrived)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn us(microseconds: u64) -> Duration {
        Duration::from_micros(microseconds)
    }

    #[test]
    fn the_way_through_the_adapter_does_not_show() {
        let mut clock = HardwareClock::default();
        let start = Instant::START + us(1_000_000);
        // Stamps 500 us apart, handed over 40, 900 and 130 us later.
        let first = clock.at(us(10_000), start + us(40));
        let second = clock.at(us(10_500), start + us(500 + 900));
        let third = clock.at(us(11_000), start + us(1_000 + 130));
        assert_eq!(second.since(first), us(500));
        assert_eq!(third.since(second), us(500));
        assert_eq!(first, start + us(40));
    }

    #[test]
    fn an_old_comparison_is_forgotten() {
        let mut clock = HardwareClock::default();
        clock.at(us(0), Instant::START + us(10));
        // Three seconds later the adapter's clock is 200 us behind.
        let at = clock.at(us(3_000_000 - 200), Instant::START + us(3_000_000 + 10));
        assert_eq!(at, Instant::START + us(3_000_010));
    }
}
