//! Characters into frames: on a serial line by the silence between them (3.5 characters end a frame), on a connection,
//! where silence means little, by the length that a frame says it has.

use std::time::Duration;

use fieldproof_link::{Character, Framing, Instant, Line, Origin, SerialSettings};
use fieldproof_wire::modbus::tcp::{self, RawTcp};
use fieldproof_wire::modbus::{Extent, response_extent};

/// On a connection: nothing more for so long, and a frame that does not say how long it is has ended.
const NOTHING_MORE: Duration = Duration::from_millis(50);

/// Bytes that belong together.
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
    line: ByteLine,
    /// How long a character is on the line.
    character_time: Duration,
    frame: Option<SerialFrame>,
}

/// What carries the characters.
#[derive(Debug, Clone, Copy)]
enum ByteLine {
    Serial(SerialSettings),
    Stream(Framing),
}

impl Assembler {
    /// For a line that carries characters: one on which bits take time, or one on which they take none, whatever it is
    /// set to.
    pub(crate) fn new(line: Line, has_bit_times: bool) -> Option<Assembler> {
        let line = match line {
            Line::Serial(settings) => ByteLine::Serial(settings),
            Line::Stream(framing) => ByteLine::Stream(framing),
            Line::Off | Line::Can { .. } => return None,
        };
        let character_time = match line {
            ByteLine::Serial(settings) if has_bit_times => settings.character_time(),
            ByteLine::Serial(_) | ByteLine::Stream(_) => Duration::ZERO,
        };
        Some(Assembler {
            line,
            character_time,
            frame: None,
        })
    }

    /// How the serial line is set, if it is one.
    pub(crate) fn settings(&self) -> Option<SerialSettings> {
        match self.line {
            ByteLine::Serial(settings) => Some(settings),
            ByteLine::Stream(_) => None,
        }
    }

    /// The silence that ends a frame which nothing else ends.
    fn silence(&self) -> Duration {
        match self.line {
            ByteLine::Serial(settings) => settings.silence_3_5(),
            ByteLine::Stream(_) => NOTHING_MORE,
        }
    }

    /// One more character that ended at `at`. Gives the frame before it, if this one begins another, or the frame that
    /// is whole with it.
    pub(crate) fn take(
        &mut self,
        at: Instant,
        origin: Origin,
        character: Character,
    ) -> Option<SerialFrame> {
        let start = at - self.character_time;
        let silence = self.silence();
        let before = match &self.frame {
            Some(frame) if frame.origin != origin || start.since(frame.end) >= silence => {
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
        // A frame of one character is never whole, so there are not two to give.
        match self.line {
            ByteLine::Stream(framing) if is_whole(framing, &frame.bytes) => self.frame.take(),
            _ => before,
        }
    }

    /// When the frame that has begun will have ended, if nothing follows.
    pub(crate) fn ends_at(&self) -> Option<Instant> {
        let frame = self.frame.as_ref()?;
        Some(frame.end + self.silence())
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

/// Whether an answer on a connection is as long as it says.
fn is_whole(framing: Framing, bytes: &[u8]) -> bool {
    match framing {
        Framing::ModbusTcp => {
            let claimed = RawTcp(bytes).claimed_len();
            // What no header may say is believed by nobody: then only silence tells where it ends.
            let possible = claimed.filter(|len| (tcp::HEADER_LEN..=tcp::MAX_ADU_LEN).contains(len));
            possible.is_some_and(|len| bytes.len() >= len)
        }
        Framing::Rtu => match bytes.get(1..).map(response_extent) {
            Some(Extent::Bytes(pdu)) => bytes.len() >= pdu + 3,
            Some(Extent::NotYet | Extent::Open) | None => false,
        },
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
        serial(true)
    }

    fn serial(has_bit_times: bool) -> Assembler {
        let line = Line::Serial(SETTINGS);
        Assembler::new(line, has_bit_times).expect("a serial line carries characters")
    }

    fn stream(framing: Framing) -> Assembler {
        Assembler::new(Line::Stream(framing), false).expect("a connection carries characters")
    }

    /// What comes out of an assembler when these bytes come at these microseconds, and nothing after them.
    fn assembled(framing: Framing, chunks: &[(u64, &[u8])]) -> Vec<Vec<u8>> {
        let mut assembler = stream(framing);
        let mut frames = Vec::new();
        for (at, bytes) in chunks {
            for byte in *bytes {
                frames.extend(assembler.take(us(*at), Origin::Bus, Character::new(*byte)));
            }
        }
        frames.extend(assembler.finish(us(10_000_000)));
        assert!(assembler.ends_at().is_none());
        frames.into_iter().map(|frame| frame.bytes).collect()
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
        let mut a = serial(false);
        a.take(us(2_000), Origin::Bus, Character::new(1));
        a.take(us(2_000), Origin::Bus, Character::new(2));
        let frame = a.finish(us(5_700)).expect("3.65 ms of silence have passed");
        assert_eq!((frame.start, frame.end), (us(2_000), us(2_000)));
    }

    const TCP_ANSWER: [u8; 11] = [0, 7, 0, 0, 0, 5, 0x20, 3, 2, 0x0F, 0xB4];
    const RTU_ANSWER: [u8; 7] = [0x20, 3, 2, 0x0F, 0xB4, 0x01, 0xC4];

    #[test]
    fn a_header_says_where_a_frame_ends_however_the_bytes_come() {
        let whole: &[u8] = &TCP_ANSWER;
        let twice = [TCP_ANSWER, TCP_ANSWER].concat();
        let cases: [&[(u64, &[u8])]; 3] = [
            &[(1, &twice)],
            &[(1, &twice[..3]), (2, &twice[3..14]), (3, &twice[14..])],
            &[(1, whole), (200_000, whole)],
        ];
        for chunks in cases {
            assert_eq!(assembled(Framing::ModbusTcp, chunks), [whole, whole]);
        }
        let mut assembler = stream(Framing::ModbusTcp);
        let frames: Vec<SerialFrame> = TCP_ANSWER
            .iter()
            .filter_map(|byte| assembler.take(us(1), Origin::Bus, Character::new(*byte)))
            .collect();
        assert_eq!(frames.len(), 1, "no silence is waited for");
    }

    #[test]
    fn a_header_that_cannot_be_is_ended_by_nothing_more() {
        for length in [[0, 0], [0, 1], [1, 0], [0xFF, 0xFF]] {
            let mut bytes = TCP_ANSWER;
            bytes[4..6].copy_from_slice(&length);
            // A length of 1 is possible: a unit and nothing else.
            let expected: Vec<&[u8]> = match length {
                [0, 1] => vec![&bytes[..7], &bytes[7..]],
                _ => vec![&bytes],
            };
            assert_eq!(assembled(Framing::ModbusTcp, &[(1, &bytes)]), expected);
        }
        let (first, second) = TCP_ANSWER.split_at(9);
        let late = [(1, first), (60_000, second)];
        assert_eq!(assembled(Framing::ModbusTcp, &late), [first, second]);
    }

    #[test]
    fn an_rtu_answer_says_how_long_it_is_unless_its_function_does_not() {
        let twice = [RTU_ANSWER, RTU_ANSWER].concat();
        assert_eq!(
            assembled(Framing::Rtu, &[(1, &twice)]),
            [RTU_ANSWER, RTU_ANSWER]
        );
        let refused: &[u8] = &[1, 0x86, 2, 0xC3, 0xA1];
        let chunks = [(1, refused), (1, refused)];
        assert_eq!(assembled(Framing::Rtu, &chunks), [refused, refused]);
        let identification: &[u8] = &[1, 0x2B, 0x0E, 1];
        let chunks = [(1, identification), (60_000, identification)];
        assert_eq!(assembled(Framing::Rtu, &chunks), [identification; 2]);
    }
}
