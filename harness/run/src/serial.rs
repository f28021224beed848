//! Characters into frames, by the silence between them (Modbus serial line: 3.5 characters end a frame).

use std::time::Duration;

use fieldproof_link::{Character, Instant, Origin, SerialSettings};

/// Bytes between silences.
#[derive(Debug)]
pub(crate) struct SerialFrame {
    /// The start of the first character.
    pub(crate) start: Instant,
    /// The end of the last character.
    pub(crate) end: Instant,
    pub(crate) origin: Origin,
    pub(crate) bytes: Vec<u8>,
    /// A character had a wrong parity or stop bit.
    pub(crate) spoilt: bool,
}

/// Collects the characters of one port.
#[derive(Debug)]
pub(crate) struct Assembler {
    settings: SerialSettings,
    /// How long a character is on the line.
    character_time: Duration,
    frame: Option<SerialFrame>,
}

impl Assembler {
    /// For a line on which bits take time, or for one on which they take none, whatever it is set to.
    pub(crate) fn new(settings: SerialSettings, has_bit_times: bool) -> Assembler {
        Assembler {
            settings,
            character_time: match has_bit_times {
                true => settings.character_time(),
                false => Duration::ZERO,
            },
            frame: None,
        }
    }

    pub(crate) fn settings(&self) -> SerialSettings {
        self.settings
    }

    /// One more character that ended at `at`. Gives the frame before it, if this one begins another.
    pub(crate) fn take(
        &mut self,
        at: Instant,
        origin: Origin,
        character: Character,
    ) -> Option<SerialFrame> {
        let start = at - self.character_time;
        let before = match &self.frame {
            Some(frame)
                if frame.origin != origin
                    || start.since(frame.end) >= self.settings.silence_3_5() =>
            {
                self.frame.take()
            }
            _ => None,
        };
        let frame = self.frame.get_or_insert_with(|| SerialFrame {
            start,
            end: at,
            origin,
            bytes: Vec::with_capacity(16),
            spoilt: false,
        });
        frame.end = at;
        frame.bytes.push(character.byte);
        frame.spoilt |= character.spoilt;
        before
    }

    /// When the frame that has begun will have ended, if nothing follows.
    pub(crate) fn ends_at(&self) -> Option<Instant> {
        self.frame
            .as_ref()
            .map(|frame| frame.end + self.settings.silence_3_5())
    }

    /// The frame, if the silence after it is long enough by `now`.
    pub(crate) fn finish(&mut self, now: Instant) -> Option<SerialFrame> {
        if self.ends_at()? <= now {
            self.frame.take()
        } else {
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use fieldproof_link::{Parity, StopBits};

    use super::*;

    // 9600 8N1: a character is 1.0416 ms, 3.5 characters are 3.6458 ms.
    const SETTINGS: SerialSettings = SerialSettings {
        baud: 9600,
        parity: Parity::None,
        stop_bits: StopBits::One,
    };

    fn assembler() -> Assembler {
        Assembler::new(SETTINGS, true)
    }

    fn us(microseconds: u64) -> Instant {
        Instant::from_nanos(microseconds * 1_000)
    }

    #[test]
    fn silence_ends_a_frame() {
        let mut a = assembler();
        assert!(a.take(us(2_000), Origin::Bus, Character::new(1)).is_none());
        assert!(a.take(us(3_042), Origin::Bus, Character::new(2)).is_none());
        assert!(a.finish(us(6_000)).is_none());
        let frame = a.finish(us(6_700)).expect("3.65 ms of silence have passed");
        assert_eq!(frame.bytes, [1, 2]);
        assert_eq!(frame.end, us(3_042));
        assert!(a.ends_at().is_none());
    }

    #[test]
    fn a_character_after_the_silence_begins_another_frame() {
        let mut a = assembler();
        a.take(us(2_000), Origin::Bus, Character::new(1));
        // Its start is 5 ms later.
        let first = a
            .take(us(8_042), Origin::Bus, Character::new(2))
            .expect("the first frame has ended");
        assert_eq!(first.bytes, [1]);
        // Only 2 ms: the same frame goes on.
        assert!(
            a.take(
                us(11_084),
                Origin::Bus,
                Character {
                    byte: 3,
                    spoilt: true
                }
            )
            .is_none()
        );
        let second = a.finish(us(15_000)).expect("ended");
        assert_eq!(
            (second.bytes.as_slice(), second.spoilt),
            ([2, 3].as_slice(), true)
        );
    }

    #[test]
    fn without_bit_times_a_frame_begins_when_its_first_character_came() {
        let mut a = Assembler::new(SETTINGS, false);
        a.take(us(2_000), Origin::Bus, Character::new(1));
        a.take(us(2_000), Origin::Bus, Character::new(2));
        let frame = a.finish(us(5_700)).expect("3.65 ms of silence have passed");
        assert_eq!((frame.start, frame.end), (us(2_000), us(2_000)));
    }
}
