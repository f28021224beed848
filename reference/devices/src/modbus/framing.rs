//! Where a frame ends on a line that has no delimiter: by silence.

use std::time::Duration;

use fieldproof_link::{Character, Instant, SerialSettings};

use super::Remains;

/// The longest frame: address, 253 bytes of PDU, CRC.
pub const LONGEST_FRAME: usize = 256;

/// The shortest frame: address, function, CRC.
const SHORTEST_FRAME: usize = 4;

/// Instants are whole nanoseconds and so are the times of characters: sums of them may differ by a few.
const ROUNDING: Duration = Duration::from_nanos(20);

/// Characters between two silences.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Received {
    /// What they carry; at most [`LONGEST_FRAME`] of them.
    pub bytes: Vec<u8>,
    /// Not a frame whatever the bytes are: a character was spoilt, a gap too long, or there were too many.
    pub flawed: bool,
    /// The end of the last character.
    pub end: Instant,
}

/// Collects characters until the silence after them.
///
/// A character is known only when it has ended, so the silence is known to be one only a character later: that is when
/// the framer wants to be woken.
#[derive(Debug, Clone)]
pub struct Framer {
    line: SerialSettings,
    end_silence: Duration,
    remains: Option<Remains>,
    /// What remains of a frame that was too short.
    runt: Vec<u8>,
    collected: Option<Received>,
    finished: Option<(Instant, Received)>,
}

impl Framer {
    /// A framer for a line set so.
    pub fn new(line: SerialSettings) -> Framer {
        Framer {
            line,
            end_silence: line.silence_3_5(),
            remains: None,
            runt: Vec::new(),
            collected: None,
            finished: None,
        }
    }

    /// One that is content with 1.5 characters of silence: it takes a frame to have ended before it has.
    pub fn hasty(line: SerialSettings) -> Framer {
        Framer {
            end_silence: line.silence_1_5(),
            ..Framer::new(line)
        }
    }

    /// One that takes a frame to have ended before a character could follow.
    pub fn impatient(line: SerialSettings) -> Framer {
        Framer {
            end_silence: line.character_time() * 9 / 10,
            ..Framer::new(line)
        }
    }

    /// One that waits for more for 20 ms, and minds no silence before that.
    pub fn patient(line: SerialSettings) -> Framer {
        Framer {
            end_silence: Duration::from_millis(20).max(line.silence_3_5()),
            remains: Some(Remains::OfTornFrames),
            ..Framer::new(line)
        }
    }

    /// One that keeps something of frames that are none.
    pub fn keeping(self, remains: Remains) -> Framer {
        Framer {
            remains: Some(remains),
            ..self
        }
    }

    /// `character` ended at `now`.
    pub fn receive(&mut self, now: Instant, character: Character) {
        let gap = self
            .collected
            .as_ref()
            .map(|collected| now.since(collected.end + self.line.character_time()) + ROUNDING);
        if gap.is_some_and(|gap| gap >= self.end_silence) {
            self.finished = self.collected.take().map(|received| (now, received));
        }
        let torn = gap.is_some_and(|gap| gap > self.line.silence_1_5() + 2 * ROUNDING);
        let too_long = torn && self.remains != Some(Remains::OfTornFrames);
        let collected = self.collected.get_or_insert_with(|| Received {
            bytes: Vec::new(),
            flawed: false,
            end: now,
        });
        collected.end = now;
        collected.flawed |= character.spoilt || (too_long && !collected.bytes.is_empty());
        if collected.bytes.len() < LONGEST_FRAME {
            collected.bytes.push(character.byte);
        } else {
            collected.flawed |= self.remains != Some(Remains::OfLongFrames);
        }
    }

    /// When it wants to be woken: once what it has collected is known to be all.
    pub fn wake_at(&self) -> Option<Instant> {
        let finished = self.finished.as_ref().map(|(since, _)| *since);
        finished.or_else(|| {
            let collected = self.collected.as_ref()?;
            Some(collected.end + self.end_silence + self.line.character_time())
        })
    }

    /// What has ended by `now`, if anything.
    pub fn wake(&mut self, now: Instant) -> Option<Received> {
        if let Some((_, received)) = self.finished.take() {
            return Some(received).map(|received| self.with_remains(received));
        }
        if self.wake_at().is_some_and(|at| at <= now) {
            let received = self.collected.take();
            return received.map(|received| self.with_remains(received));
        }
        None
    }

    fn with_remains(&mut self, mut received: Received) -> Received {
        if self.remains == Some(Remains::OfRunts) {
            received.bytes.splice(0..0, self.runt.drain(..));
            if received.bytes.len() < SHORTEST_FRAME {
                self.runt.clone_from(&received.bytes);
            }
        }
        received
    }

    /// Forgets what it has collected.
    pub fn clear(&mut self) {
        self.collected = None;
        self.finished = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fieldproof_link::{Parity, StopBits};

    /// 10 bits at 10,000 bit/s: one character is one millisecond.
    const LINE: SerialSettings = SerialSettings {
        baud: 10_000,
        parity: Parity::None,
        stop_bits: StopBits::One,
    };

    fn at_microseconds(microseconds: u64) -> Instant {
        Instant::START + Duration::from_micros(microseconds)
    }

    /// Gives one character a number, each with its end in microseconds.
    fn framer_after(ends: &[u64]) -> Framer {
        let mut framer = Framer::new(LINE);
        for (byte, end) in (1_u8..).zip(ends) {
            framer.receive(at_microseconds(*end), Character::new(byte));
        }
        framer
    }

    #[test]
    fn frame_ends_after_the_silence() {
        let mut framer = framer_after(&[1_000, 2_000]);
        assert_eq!(framer.wake_at(), Some(at_microseconds(6_500)));
        assert_eq!(framer.wake(at_microseconds(6_499)), None);
        let received = framer.wake(at_microseconds(6_500)).unwrap();
        assert_eq!((received.bytes, received.flawed), (vec![1, 2], false));
        assert_eq!(framer.wake_at(), None);
    }

    #[test]
    fn gap_inside_a_frame() {
        for (gap, flawed) in [(0, false), (1_500, false), (1_501, true), (3_499, true)] {
            let mut framer = framer_after(&[1_000, 2_000 + gap]);
            let received = framer.wake(at_microseconds(100_000)).unwrap();
            assert_eq!(
                (received.bytes, received.flawed),
                (vec![1, 2], flawed),
                "gap of {gap} µs"
            );
        }
    }

    #[test]
    fn frames_are_told_apart_though_nobody_woke_it_between() {
        let mut framer = framer_after(&[1_000, 5_500]);
        assert_eq!(framer.wake_at(), Some(at_microseconds(5_500)));
        let now = at_microseconds(5_500);
        assert_eq!(framer.wake(now).unwrap().bytes, [1]);
        assert_eq!(framer.wake(now), None);
        assert_eq!(framer.wake(at_microseconds(10_000)).unwrap().bytes, [2]);
    }

    #[test]
    fn spoilt_character_spoils_the_frame() {
        let mut framer = framer_after(&[1_000]);
        let character = Character {
            byte: 2,
            spoilt: true,
        };
        framer.receive(at_microseconds(2_000), character);
        assert!(framer.wake(at_microseconds(100_000)).unwrap().flawed);
    }

    #[test]
    fn no_more_than_the_longest_frame_is_kept() {
        let mut framer = Framer::new(LINE);
        for count in 1..=257 {
            framer.receive(at_microseconds(count * 1_000), Character::new(0));
            let received = framer.clone().wake(at_microseconds(1_000_000)).unwrap();
            assert_eq!(received.flawed, count > 256);
            assert!(received.bytes.len() <= 256);
        }
    }

    #[test]
    fn hasty_one_does_not_wait_for_the_silence() {
        let mut framer = Framer::hasty(LINE);
        framer.receive(at_microseconds(1_000), Character::new(1));
        assert_eq!(framer.wake_at(), Some(at_microseconds(3_500)));
    }
}
