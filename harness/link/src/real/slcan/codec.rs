//! What goes to an SLCAN adapter and what comes from it, one line each.

use fieldproof_can::{Frame, Id};

/// Ends a line that is in order.
pub const END: u8 = b'\r';

/// Ends what an adapter refuses.
pub const BELL: u8 = 0x07;

/// What a host tells an adapter, ended by [`END`]; digits are hexadecimal.
///
/// | bytes | meaning |
/// | --- | --- |
/// | `tiiildd…` `Tiiiiiiiildd…` | send a data frame: identifier of 11 or 29 bits, length `0..=8`, data |
/// | `riiil` `Riiiiiiiil` | send a remote frame |
/// | `Sn` | bit rate: `0..=8` is 10, 20, 50, 100, 125, 250, 500, 800, 1000 kbit/s |
/// | `sxxyy` | bit rate by the bus timing registers 0 and 1 of an SJA1000 at 16 MHz |
/// | `O` `L` `C` | open the channel, open it for listening only, close it |
/// | `Z0` `Z1` `Z2` | stamps on received frames: none, milliseconds, microseconds |
/// | `F` | which [status](Answer::Status)? |
/// | `V` `v` `N` | version, version of the firmware, serial number |
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Command {
    /// An empty line; it ends whatever was begun before.
    Nothing,
    /// Send a frame.
    Transmit(Frame),
    /// Set the bit rate.
    BitRate(BitRateCode),
    /// Set the bit rate by registers.
    Registers([u8; 2]),
    /// Open the channel.
    Open,
    /// Open the channel for listening only.
    Listen,
    /// Close the channel.
    Close,
    /// With which stamps frames come.
    Stamps(Stamps),
    /// Ask for the status, which is cleared by that.
    Status,
    /// Ask for the version.
    Version,
    /// Ask for the version of the firmware.
    FirmwareVersion,
    /// Ask for the serial number.
    SerialNumber,
    /// Something else.
    Other(Vec<u8>),
}

/// What an adapter answers or tells, ended by [`END`], or by [`BELL`] if it refuses.
///
/// | bytes | meaning |
/// | --- | --- |
/// | | done |
/// | `z` `Z` | the frame of 11 or 29 bits is taken; our own bus adds the stamp at which it was on the bus |
/// | `tiiildd…` and so on | a frame, as in [`Command`]; then nothing, 4 digits of milliseconds or 8 of microseconds |
/// | `Fxx` | status |
/// | `Vxxxx` `vxxxx` `Nxxxx` | versions, serial number |
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// Done.
    Done,
    /// A frame of 11 bits, or of 29, is taken.
    Taken {
        /// Whether it is one of 29 bits.
        extended: bool,
        /// When it was on the bus.
        stamp: Option<Stamp>,
    },
    /// A frame has arrived.
    Received {
        /// The frame.
        frame: Frame,
        /// When.
        stamp: Option<Stamp>,
    },
    /// The flags of the adapter: bit 0 receive queue full, 1 transmit queue full, 2 error warning, 3 frames lost,
    /// 5 error passive, 6 arbitration lost, 7 bus error.
    Status(u8),
    /// A version or serial number, with the letter in front.
    Text(Vec<u8>),
    /// It refuses; what stands before the bell.
    Refused(Vec<u8>),
    /// Something else.
    Other(Vec<u8>),
}

/// A bit rate that has a digit of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BitRateCode(u8);

/// In bits a second, by digit.
const BIT_RATES: [u32; 9] = [
    10_000, 20_000, 50_000, 100_000, 125_000, 250_000, 500_000, 800_000, 1_000_000,
];

impl BitRateCode {
    /// The digit of `bit_rate` bits a second, if it has one.
    pub fn of(bit_rate: u32) -> Option<BitRateCode> {
        let code = BIT_RATES.iter().position(|known| *known == bit_rate)?;
        Some(BitRateCode(code as u8))
    }

    /// Bits a second.
    pub fn bit_rate(self) -> u32 {
        BIT_RATES[usize::from(self.0)]
    }
}

/// With which stamps an adapter sends frames.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stamps {
    /// None.
    None,
    /// Milliseconds.
    Milliseconds,
    /// Microseconds.
    Microseconds,
}

/// What the clock of an adapter said.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stamp {
    /// Milliseconds, which begin anew after a minute.
    Milliseconds(u16),
    /// Microseconds; some begin anew after an hour, some after 2^32.
    Microseconds(u32),
}

impl Command {
    /// Reads a line without its end. It never fails: what is not known is [`Command::Other`].
    pub fn read(line: &[u8]) -> Command {
        match line {
            [] => Command::Nothing,
            [b'S', digit @ b'0'..=b'8'] => Command::BitRate(BitRateCode(digit - b'0')),
            [b's', registers @ ..] if registers.len() == 4 => match number(registers) {
                Some(registers) => Command::Registers((registers as u16).to_be_bytes()),
                None => Command::Other(line.to_vec()),
            },
            b"O" => Command::Open,
            b"L" => Command::Listen,
            b"C" => Command::Close,
            b"Z0" => Command::Stamps(Stamps::None),
            b"Z1" => Command::Stamps(Stamps::Milliseconds),
            b"Z2" => Command::Stamps(Stamps::Microseconds),
            b"F" => Command::Status,
            b"V" => Command::Version,
            b"v" => Command::FirmwareVersion,
            b"N" => Command::SerialNumber,
            _ => match read_frame(line) {
                Some((frame, [])) => Command::Transmit(frame),
                _ => Command::Other(line.to_vec()),
            },
        }
    }

    /// Appends the line with its end to `to`.
    pub fn write(&self, to: &mut Vec<u8>) {
        match self {
            Command::Nothing => {}
            Command::Transmit(frame) => write_frame(frame, to),
            Command::BitRate(code) => to.extend([b'S', b'0' + code.0]),
            Command::Registers(registers) => {
                to.push(b's');
                write_bytes(registers, to);
            }
            Command::Open => to.push(b'O'),
            Command::Listen => to.push(b'L'),
            Command::Close => to.push(b'C'),
            Command::Stamps(Stamps::None) => to.extend(b"Z0"),
            Command::Stamps(Stamps::Milliseconds) => to.extend(b"Z1"),
            Command::Stamps(Stamps::Microseconds) => to.extend(b"Z2"),
            Command::Status => to.push(b'F'),
            Command::Version => to.push(b'V'),
            Command::FirmwareVersion => to.push(b'v'),
            Command::SerialNumber => to.push(b'N'),
            Command::Other(line) => to.extend(line),
        }
        to.push(END);
    }
}

impl Answer {
    /// Reads a line without its `end`. It never fails: what is not known is [`Answer::Other`].
    pub fn read(line: &[u8], end: u8) -> Answer {
        if end == BELL {
            return Answer::Refused(line.to_vec());
        }
        let known = match line {
            [] => Some(Answer::Done),
            [letter @ (b'z' | b'Z'), stamp @ ..] => read_stamp(stamp).map(|stamp| Answer::Taken {
                extended: *letter == b'Z',
                stamp,
            }),
            [b'F', flags @ ..] if flags.len() == 2 => {
                number(flags).map(|flags| Answer::Status(flags as u8))
            }
            [b'V' | b'v' | b'N', _, ..] => Some(Answer::Text(line.to_vec())),
            _ => read_frame(line).and_then(|(frame, rest)| {
                read_stamp(rest).map(|stamp| Answer::Received { frame, stamp })
            }),
        };
        known.unwrap_or_else(|| Answer::Other(line.to_vec()))
    }

    /// Appends the line with its end to `to`.
    pub fn write(&self, to: &mut Vec<u8>) {
        match self {
            Answer::Done => {}
            Answer::Taken { extended, stamp } => {
                to.push(if *extended { b'Z' } else { b'z' });
                write_stamp(*stamp, to);
            }
            Answer::Received { frame, stamp } => {
                write_frame(frame, to);
                write_stamp(*stamp, to);
            }
            Answer::Status(flags) => {
                to.push(b'F');
                write_bytes(&[*flags], to);
            }
            Answer::Text(line) | Answer::Refused(line) | Answer::Other(line) => to.extend(line),
        }
        to.push(match self {
            Answer::Refused(_) => BELL,
            _ => END,
        });
    }
}

/// The frame that `line` begins with, and what follows it.
fn read_frame(line: &[u8]) -> Option<(Frame, &[u8])> {
    let (letter, line) = line.split_first()?;
    let (digits, remote) = match letter {
        b't' => (3, false),
        b'T' => (8, false),
        b'r' => (3, true),
        b'R' => (8, true),
        _ => return None,
    };
    let (id, line) = line.split_at_checked(digits)?;
    let id = match digits {
        3 => Id::standard(number(id)? as u16)?,
        _ => Id::extended(number(id)?)?,
    };
    let (length, line) = line.split_first()?;
    let length = match length {
        b'0'..=b'8' => length - b'0',
        _ => return None,
    };
    if remote {
        return Some((Frame::remote(id, length)?, line));
    }
    let (digits, line) = line.split_at_checked(2 * usize::from(length))?;
    let mut data = [0; 8];
    for (byte, digits) in data.iter_mut().zip(digits.chunks(2)) {
        *byte = number(digits)? as u8;
    }
    Some((Frame::data(id, &data[..usize::from(length)])?, line))
}

fn write_frame(frame: &Frame, to: &mut Vec<u8>) {
    to.push(match (frame.id().is_extended(), frame.is_remote()) {
        (false, false) => b't',
        (true, false) => b'T',
        (false, true) => b'r',
        (true, true) => b'R',
    });
    let id = frame.id().raw();
    write_digits(id, if frame.id().is_extended() { 8 } else { 3 }, to);
    to.push(b'0' + frame.len() as u8);
    write_bytes(frame.bytes(), to);
}

/// `None` if `digits` is no stamp; no digits are no stamp, and in order.
fn read_stamp(digits: &[u8]) -> Option<Option<Stamp>> {
    match digits.len() {
        0 => Some(None),
        4 => Some(Some(Stamp::Milliseconds(number(digits)? as u16))),
        8 => Some(Some(Stamp::Microseconds(number(digits)?))),
        _ => None,
    }
}

fn write_stamp(stamp: Option<Stamp>, to: &mut Vec<u8>) {
    match stamp {
        None => {}
        Some(Stamp::Milliseconds(stamp)) => write_digits(stamp.into(), 4, to),
        Some(Stamp::Microseconds(stamp)) => write_digits(stamp, 8, to),
    }
}

/// The number that up to 8 digits are.
fn number(digits: &[u8]) -> Option<u32> {
    digits.iter().try_fold(0, |number, digit| {
        let digit = char::from(*digit).to_digit(16)?;
        Some(number << 4 | digit)
    })
}

fn write_digits(number: u32, count: u32, to: &mut Vec<u8>) {
    const DIGITS: &[u8; 16] = b"0123456789ABCDEF";
    let digit = |place: u32| DIGITS[(number >> (4 * place) & 0xF) as usize];
    to.extend((0..count).rev().map(digit));
}

fn write_bytes(bytes: &[u8], to: &mut Vec<u8>) {
    bytes
        .iter()
        .for_each(|byte| write_digits((*byte).into(), 2, to));
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn frame(text: &str) -> Frame {
        text.parse().unwrap()
    }

    fn written(command: &Command) -> String {
        let mut line = Vec::new();
        command.write(&mut line);
        String::from_utf8(line).unwrap()
    }

    #[test]
    fn frames_are_written_as_the_adapter_reads_them() {
        let line = |text| written(&Command::Transmit(frame(text)));
        assert_eq!(line("60A#4000100000000000"), "t60A84000100000000000\r");
        assert_eq!(line("080#"), "t0800\r");
        assert_eq!(line("0000060A#40"), "T0000060A140\r");
        assert_eq!(line("701#R"), "r7010\r");
        assert_eq!(line("1FFFFFFF#R8"), "R1FFFFFFF8\r");
    }

    #[test]
    fn stamps_are_told_by_their_length() {
        let received = |line: &[u8]| Answer::read(line, END);
        let frame = frame("181#AABB");
        let stamped = |stamp| Answer::Received { frame, stamp };
        assert_eq!(received(b"t1812AABB"), stamped(None));
        let milliseconds = Some(Stamp::Milliseconds(59_999));
        assert_eq!(received(b"t1812aabbEA5F"), stamped(milliseconds));
        let microseconds = Some(Stamp::Microseconds(0xD693_A3FF));
        assert_eq!(received(b"t1812AABBD693A3FF"), stamped(microseconds));
    }

    #[test]
    fn what_is_no_frame_is_kept_as_it_is() {
        for line in [
            "t",
            "t8001AA",
            "t18",
            "t1819",
            "t1812AA",
            "t1812AAB",
            "t1812AABBC",
            "T20000000",
            "t18G0",
            "r1819",
            "x",
            "t1812AABB+123",
        ] {
            let line = line.as_bytes();
            assert_eq!(Answer::read(line, END), Answer::Other(line.to_vec()));
            assert_eq!(Command::read(line), Command::Other(line.to_vec()));
        }
        // A stamp is no part of a command.
        assert!(matches!(Command::read(b"t1812AABB1234"), Command::Other(_)));
    }

    #[test]
    fn bit_rates_have_digits() {
        assert_eq!(
            written(&Command::BitRate(BitRateCode::of(500_000).unwrap())),
            "S6\r"
        );
        assert_eq!(BitRateCode::of(83_333), None);
        for bit_rate in BIT_RATES {
            assert_eq!(BitRateCode::of(bit_rate).unwrap().bit_rate(), bit_rate);
        }
    }

    fn any_frame() -> impl Strategy<Value = Frame> {
        let id = prop_oneof![
            (0..=0x7FFu16).prop_map(|raw| Id::standard(raw).unwrap()),
            (0..=0x1FFF_FFFFu32).prop_map(|raw| Id::extended(raw).unwrap()),
        ];
        let data = proptest::collection::vec(any::<u8>(), 0..=8);
        prop_oneof![
            4 => (id.clone(), data).prop_map(|(id, data)| Frame::data(id, &data).unwrap()),
            1 => (id, 0..=8u8).prop_map(|(id, len)| Frame::remote(id, len).unwrap()),
        ]
    }

    fn any_command() -> impl Strategy<Value = Command> {
        prop_oneof![
            6 => any_frame().prop_map(Command::Transmit),
            1 => (0..BIT_RATES.len()).prop_map(|it| Command::BitRate(BitRateCode(it as u8))),
            1 => any::<[u8; 2]>().prop_map(Command::Registers),
            4 => proptest::sample::select(vec![
                Command::Nothing,
                Command::Open,
                Command::Listen,
                Command::Close,
                Command::Stamps(Stamps::None),
                Command::Stamps(Stamps::Milliseconds),
                Command::Stamps(Stamps::Microseconds),
                Command::Status,
                Command::Version,
                Command::FirmwareVersion,
                Command::SerialNumber,
            ]),
        ]
    }

    fn any_answer() -> impl Strategy<Value = Answer> {
        let stamp = prop_oneof![
            Just(None),
            any::<u16>().prop_map(|it| Some(Stamp::Milliseconds(it))),
            any::<u32>().prop_map(|it| Some(Stamp::Microseconds(it))),
        ];
        prop_oneof![
            4 => (any_frame(), stamp.clone()).prop_map(|(frame, stamp)| Answer::Received { frame, stamp }),
            2 => (any::<bool>(), stamp).prop_map(|(extended, stamp)| Answer::Taken { extended, stamp }),
            1 => any::<u8>().prop_map(Answer::Status),
            1 => Just(Answer::Done),
            1 => "[VvN][0-9A-Z]{4}".prop_map(|it| Answer::Text(it.into_bytes())),
            1 => "[a-z]{0,4}".prop_map(|it| Answer::Refused(it.into_bytes())),
        ]
    }

    proptest! {
        #[test]
        fn a_command_is_read_as_it_was_written(command in any_command()) {
            let mut line = Vec::new();
            command.write(&mut line);
            prop_assert_eq!(line.pop(), Some(END));
            prop_assert_eq!(Command::read(&line), command);
        }

        #[test]
        fn an_answer_is_read_as_it_was_written(answer in any_answer()) {
            let mut line = Vec::new();
            answer.write(&mut line);
            let end = line.pop().unwrap();
            prop_assert_eq!(Answer::read(&line, end), answer);
        }

        #[test]
        fn any_bytes_are_read_as_something_that_writes_them(line: Vec<u8>) {
            let mut command = Vec::new();
            Command::read(&line).write(&mut command);
            command.pop();
            prop_assert!(command.eq_ignore_ascii_case(&line));
            let mut answer = Vec::new();
            Answer::read(&line, END).write(&mut answer);
            answer.pop();
            prop_assert!(answer.eq_ignore_ascii_case(&line));
        }
    }
}
