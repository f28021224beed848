//! A round that does not end is ended, and counts as wrong.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// A round takes less than a second, and a few in a build that is not optimised.
pub(super) const LIMIT: Duration = Duration::from_secs(120);

/// How often the rounds that are played are looked at.
const LOOK: Duration = Duration::from_millis(20);

/// One round under watch.
#[derive(Debug, Default)]
pub(super) struct Watched {
    begun: OnceLock<Instant>,
    ended: AtomicBool,
    hung: AtomicBool,
    /// Tells the round to end.
    pub(super) stop: AtomicBool,
}

impl Watched {
    pub(super) fn begin(&self) {
        self.begun.get_or_init(Instant::now);
    }

    pub(super) fn end(&self) {
        self.ended.store(true, Ordering::Relaxed);
    }

    /// Whether it was told to end because it took too long.
    pub(super) fn hung(&self) -> bool {
        self.hung.load(Ordering::Relaxed)
    }

    fn look(&self, limit: Duration, stop: bool) {
        let is_played = !self.ended.load(Ordering::Relaxed);
        let Some(begun) = self.begun.get().filter(|_| is_played) else {
            return;
        };
        let hangs = begun.elapsed() > limit;
        self.hung.fetch_or(hangs, Ordering::Relaxed);
        if hangs || stop {
            self.stop.store(true, Ordering::Relaxed);
        }
    }
}

/// Looks at the rounds until `done`; when the user wants to stop, all of them end.
pub(super) fn watch(rounds: &[Watched], limit: Duration, stop: &AtomicBool, done: &AtomicBool) {
    while !done.load(Ordering::Relaxed) {
        let stop = stop.load(Ordering::Relaxed);
        for round in rounds {
            round.look(limit, stop);
        }
        thread::sleep(LOOK);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LONG: Duration = Duration::from_secs(3_600);

    fn after(look: impl Fn(&Watched)) -> (bool, bool) {
        let round = Watched::default();
        look(&round);
        (round.stop.load(Ordering::Relaxed), round.hung())
    }

    #[test]
    fn a_round_ends_when_it_takes_too_long_or_the_user_wants_it() {
        assert_eq!(
            after(|round| round.look(Duration::ZERO, true)),
            (false, false),
            "not begun"
        );
        let begun = |limit, stop| {
            after(|round| {
                round.begin();
                round.look(limit, stop);
            })
        };
        assert_eq!(begun(LONG, false), (false, false));
        assert_eq!(begun(LONG, true), (true, false));
        assert_eq!(begun(Duration::ZERO, false), (true, true));
        let ended = after(|round| {
            round.begin();
            round.end();
            round.look(Duration::ZERO, true);
        });
        assert_eq!(ended, (false, false));
    }
}
