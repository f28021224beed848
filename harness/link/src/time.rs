//! Instants on the lane's monotonic clock.

use std::fmt;
use std::ops::{Add, Sub};
use std::time::Duration;

/// An instant in nanoseconds since the lane was opened. In simulation the discrete-event clock, on hardware the
/// monotonic clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Instant(u64);

impl Instant {
    /// The instant the lane was opened.
    pub const START: Instant = Instant(0);
    /// Later than everything that happens.
    pub const NEVER: Instant = Instant(u64::MAX);

    /// The instant `nanoseconds` after the lane was opened.
    pub const fn from_nanos(nanoseconds: u64) -> Instant {
        Instant(nanoseconds)
    }

    /// Nanoseconds since the lane was opened.
    pub const fn as_nanos(self) -> u64 {
        self.0
    }

    /// The instant `nanoseconds` later, or [`Instant::NEVER`]: addition without the detour over [`Duration`].
    pub(crate) const fn after_nanos(self, nanoseconds: u64) -> Instant {
        Instant(self.0.saturating_add(nanoseconds))
    }

    /// The time from `earlier` to this instant; zero if `earlier` is later.
    pub const fn since(self, earlier: Instant) -> Duration {
        Duration::from_nanos(self.0.saturating_sub(earlier.0))
    }
}

impl Add<Duration> for Instant {
    type Output = Instant;

    /// The instant `duration` later; [`Instant::NEVER`] if that does not fit.
    fn add(self, duration: Duration) -> Instant {
        let nanoseconds = u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX);
        Instant(self.0.saturating_add(nanoseconds))
    }
}

impl Sub<Duration> for Instant {
    type Output = Instant;

    /// The instant `duration` earlier; [`Instant::START`] if that was before the lane was opened.
    fn sub(self, duration: Duration) -> Instant {
        let nanoseconds = u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX);
        Instant(self.0.saturating_sub(nanoseconds))
    }
}

impl fmt::Display for Instant {
    /// Seconds with nine decimals: `12.345678901`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}.{:09}",
            self.0 / 1_000_000_000,
            self.0 % 1_000_000_000
        )
    }
}
