//! The clock of a lane on real links.

use std::cell::Cell;
use std::time::{self, Duration, SystemTime};

use crate::Instant;

/// How long the processor's counter is trusted before it is compared with the system's clock again. Its rate is known
/// to some parts in 100,000, so it is never more than a few microseconds off.
const COUNTER_AGE_NS: u64 = 100_000_000;

/// How long a comparison with the wall clock is good for: that may be set or slewed.
const WALL_AGE: Duration = Duration::from_secs(1);

/// The monotonic clock, counted from the opening of the lane, and what a stamp of the wall clock is on it.
///
/// Reading it is no system call, which on some kernels costs as much as a frame: between readings of the system's clock
/// the processor's counter is used. The kernel stamps frames with the wall clock, which may be set while a lane is open;
/// so the two are compared again and again, and a stamp is only used as the short time between it and the comparison.
#[derive(Debug)]
pub struct Clock {
    opened: time::Instant,
    counter: quanta::Clock,
    /// What the counter said at an instant of this clock.
    counted: Cell<(u64, Instant)>,
    /// The last instant that was given.
    last: Cell<Instant>,
    /// What the wall clock said at an instant of this clock.
    wall: (SystemTime, Instant),
}

impl Clock {
    /// A clock that starts now.
    pub fn start() -> Clock {
        let counter = quanta::Clock::new();
        let opened = time::Instant::now();
        Clock {
            counted: Cell::new((counter.raw(), Instant::START)),
            last: Cell::new(Instant::START),
            wall: (SystemTime::now(), Instant::START),
            opened,
            counter,
        }
    }

    /// The present instant; never before one that was given already, even if the counter went a little too fast.
    pub fn now(&self) -> Instant {
        let raw = self.counter.raw();
        let (counted, instant) = self.counted.get();
        let since_ns = self.counter.delta_as_nanos(counted, raw);
        let now = if since_ns < COUNTER_AGE_NS {
            instant.after_nanos(since_ns)
        } else {
            let now = Instant::START + self.opened.elapsed();
            self.counted.set((raw, now));
            now
        };
        let now = now.max(self.last.get());
        self.last.set(now);
        now
    }

    /// The instant at which the wall clock said `stamp`, not later than now.
    pub fn at(&mut self, stamp: SystemTime) -> Instant {
        let (wall, instant) = self.wall;
        if let Ok(since) = stamp.duration_since(wall)
            && since < WALL_AGE
        {
            return instant + since;
        }
        self.wall = (SystemTime::now(), self.now());
        let (wall, instant) = self.wall;
        match wall.duration_since(stamp) {
            Ok(ago) => instant - ago,
            Err(_) => instant,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stamp_of_just_now_is_just_now() {
        let mut clock = Clock::start();
        let stamp = SystemTime::now();
        let at = clock.at(stamp);
        let now = clock.now();
        assert!(at <= now, "{at} is later than {now}");
        assert!(now.since(at) < Duration::from_secs(1), "{at}, {now}");
    }

    #[test]
    fn a_stamp_from_before_the_wall_clock_was_set_back_is_not_later_than_now() {
        let mut clock = Clock::start();
        let at = clock.at(SystemTime::now() + Duration::from_secs(3600));
        assert!(at <= clock.now());
    }

    #[test]
    fn stamps_keep_their_distance() {
        let mut clock = Clock::start();
        let stamp = SystemTime::now();
        let first = clock.at(stamp);
        let second = clock.at(stamp + Duration::from_micros(130));
        assert_eq!(second.since(first), Duration::from_micros(130));
    }

    #[test]
    fn time_never_goes_back() {
        let clock = Clock::start();
        let mut last = clock.now();
        // Over several comparisons with the system's clock.
        while last < Instant::START + Duration::from_millis(350) {
            let now = clock.now();
            assert!(now >= last);
            last = now;
        }
    }
}
