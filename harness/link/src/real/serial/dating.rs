//! When the characters ended that the system gave together.

use std::time::Duration;

use crate::Instant;

/// Dates characters back: the last one that was read has just ended, the one before it a character earlier.
#[derive(Debug)]
pub(super) struct Dating {
    /// How long a character is on the line; zero where bits take no time.
    character_time: Duration,
    /// When the last character ended.
    last: Instant,
    /// When what was sent has left.
    sent: Instant,
}

impl Dating {
    pub(super) fn new(character_time: Duration) -> Dating {
        Dating {
            character_time,
            last: Instant::START,
            sent: Instant::START,
        }
    }

    pub(super) fn set_character_time(&mut self, character_time: Duration) {
        self.character_time = character_time;
    }

    /// Something is being sent, and will have left at `end`. What had come by then has been read by then; what is read
    /// later came later.
    pub(super) fn sent(&mut self, end: Instant) {
        self.sent = end;
    }

    /// The ends of `count` characters that were read together at `read`.
    pub(super) fn ends(&mut self, read: Instant, count: usize) -> impl Iterator<Item = Instant> {
        let count = u32::try_from(count).unwrap_or(u32::MAX);
        if read >= self.sent {
            self.last = self.last.max(self.sent.after_nanos(1));
        }
        let later_characters = (0..count).rev();
        later_characters.map(move |later| {
            let end = read - self.character_time.saturating_mul(later);
            self.last = self.last.max(end);
            self.last
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CHARACTER: Duration = Duration::from_micros(500);

    fn us(microseconds: u64) -> Instant {
        Instant::from_nanos(microseconds * 1_000)
    }

    fn ends(dating: &mut Dating, read: Instant, count: usize) -> Vec<Instant> {
        dating.ends(read, count).collect()
    }

    #[test]
    fn characters_that_were_read_together_ended_one_after_the_other() {
        let mut dating = Dating::new(CHARACTER);
        assert_eq!(
            ends(&mut dating, us(10_000), 3),
            [us(9_000), us(9_500), us(10_000)]
        );
    }

    #[test]
    fn none_ended_before_the_one_before_it() {
        let mut dating = Dating::new(CHARACTER);
        assert_eq!(ends(&mut dating, us(10_000), 1), [us(10_000)]);
        assert_eq!(
            ends(&mut dating, us(10_600), 3),
            [us(10_000), us(10_100), us(10_600)]
        );
    }

    #[test]
    fn none_that_is_read_later_ended_before_what_was_sent() {
        let mut dating = Dating::new(CHARACTER);
        dating.sent(us(9_800));
        let after = Instant::from_nanos(9_800_001);
        assert_eq!(ends(&mut dating, us(10_000), 3), [after, after, us(10_000)]);
    }

    #[test]
    fn what_comes_while_something_is_sent_is_not_dated_after_it() {
        let mut dating = Dating::new(CHARACTER);
        dating.sent(us(9_800));
        assert_eq!(ends(&mut dating, us(9_000), 1), [us(9_000)]);
    }

    #[test]
    fn without_bit_times_all_ended_when_they_were_read() {
        let mut dating = Dating::new(Duration::ZERO);
        assert_eq!(ends(&mut dating, us(10), 3), [us(10); 3]);
        assert!(ends(&mut dating, us(11), 0).is_empty());
    }
}
