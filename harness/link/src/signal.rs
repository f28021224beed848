//! What travels on a port, and how a port is set.

use std::time::Duration;

use fieldproof_can::Frame;

use crate::BusError;

/// One character on a serial line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Character {
    /// The eight data bits.
    pub byte: u8,
    /// The parity bit or the stop bit is wrong: sent so on purpose, or received so.
    pub spoilt: bool,
}

impl Character {
    /// A well-formed character.
    pub const fn new(byte: u8) -> Character {
        Character {
            byte,
            spoilt: false,
        }
    }
}

/// What is given to a port to send.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Transmission {
    /// One CAN frame; it wins or loses arbitration by its identifier.
    Frame(Frame),
    /// Characters without a gap between them.
    Characters(Vec<Character>),
    /// Of a participant: it ends the connection.
    Close,
}

impl Transmission {
    /// Well-formed characters without a gap between them.
    pub fn bytes(bytes: &[u8]) -> Transmission {
        Transmission::Characters(bytes.iter().copied().map(Character::new).collect())
    }
}

/// What arrives at a port. Its instant is the end of its last bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reception {
    /// One CAN frame.
    Frame(Frame),
    /// One character.
    Character(Character),
    /// The tester's own CAN controller tells of trouble on the bus.
    BusError(BusError),
    /// A connection was opened to this port of a participant.
    Connected,
    /// The other side has ended the connection.
    Closed,
}

/// Parity of a serial line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parity {
    /// No parity bit.
    None,
    /// Even parity, the Modbus default.
    Even,
    /// Odd parity.
    Odd,
}

/// Stop bits of a serial line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StopBits {
    /// One stop bit.
    One,
    /// Two stop bits.
    Two,
}

/// How a serial line is set; always eight data bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SerialSettings {
    /// Bits a second.
    pub baud: u32,
    /// Parity.
    pub parity: Parity,
    /// Stop bits.
    pub stop_bits: StopBits,
}

impl SerialSettings {
    /// Bits of one character on the line: start, eight data bits, parity, stop.
    pub const fn bits_per_character(self) -> u32 {
        let parity = match self.parity {
            Parity::None => 0,
            Parity::Even | Parity::Odd => 1,
        };
        let stop = match self.stop_bits {
            StopBits::One => 1,
            StopBits::Two => 2,
        };
        1 + 8 + parity + stop
    }

    /// One bit on the line, to the nearest nanosecond. A baud rate of 0 counts as 1.
    pub const fn bit_time(self) -> Duration {
        Duration::from_nanos(bits_in_nanos(1, self.baud))
    }

    /// One character on the line, to the nearest nanosecond. A baud rate of 0 counts as 1.
    pub const fn character_time(self) -> Duration {
        Duration::from_nanos(bits_in_nanos(self.bits_per_character() as u64, self.baud))
    }

    /// The longest silence between two characters of one Modbus RTU frame, t1.5: one and a half characters, or 750 us
    /// above 19200 baud.
    pub const fn silence_1_5(self) -> Duration {
        self.silence(3, Duration::from_micros(750))
    }

    /// The least silence between two Modbus RTU frames, t3.5: three and a half characters, or 1.75 ms above 19200 baud.
    pub const fn silence_3_5(self) -> Duration {
        self.silence(7, Duration::from_micros(1750))
    }

    const fn silence(self, half_characters: u64, above_19200: Duration) -> Duration {
        if self.baud > 19_200 {
            return above_19200;
        }
        let half_bits = half_characters * self.bits_per_character() as u64;
        Duration::from_nanos(bits_in_nanos(half_bits, 2 * at_least_one(self.baud)))
    }
}

/// How many nanoseconds `bits` bits take at `rate` bits a second, to the nearest; a rate of 0 counts as 1.
pub(crate) const fn bits_in_nanos(bits: u64, rate: u32) -> u64 {
    let rate = at_least_one(rate) as u64;
    (bits.saturating_mul(1_000_000_000).saturating_add(rate / 2)) / rate
}

/// How a participant or the tester is set on a port right now. Two that are set differently do not understand each
/// other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Line {
    /// Not there: powered off, or unplugged.
    Off,
    /// On a CAN bus.
    Can {
        /// Bits a second.
        bit_rate: u32,
    },
    /// On a serial line.
    Serial(SerialSettings),
    /// On a connection that carries bytes in order and without time of their own.
    Stream(Framing),
}

/// How Modbus frames are told apart on a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Framing {
    /// Modbus TCP: a header in front says how long.
    ModbusTcp,
    /// RTU frames, with address and CRC: by the CRC and by nothing more coming.
    Rtu,
}

const fn at_least_one(rate: u32) -> u32 {
    if rate == 0 { 1 } else { rate }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn settings(baud: u32, parity: Parity, stop_bits: StopBits) -> SerialSettings {
        SerialSettings {
            baud,
            parity,
            stop_bits,
        }
    }

    #[test]
    fn a_character_takes_its_bits() {
        // 1 start + 8 data + 1 parity + 1 stop = 11 bits; 11 / 9600 s = 1.145833.. ms.
        let even = settings(9_600, Parity::Even, StopBits::One);
        assert_eq!(even.character_time(), Duration::from_nanos(1_145_833));
        assert_eq!(even.bit_time(), Duration::from_nanos(104_167));
        // 1 + 8 + 1 = 10 bits at 10 kBd: 1 ms.
        let none = settings(10_000, Parity::None, StopBits::One);
        assert_eq!(none.character_time(), Duration::from_millis(1));
    }

    #[test]
    fn the_silences_are_characters_up_to_19200_baud_and_fixed_above() {
        // 11 bits at 19200 Bd: 572.9166.. us a character; 1.5 of them 859.375 us, 3.5 of them 2.005208.. ms.
        let slow = settings(19_200, Parity::Even, StopBits::One);
        assert_eq!(slow.silence_1_5(), Duration::from_nanos(859_375));
        assert_eq!(slow.silence_3_5(), Duration::from_nanos(2_005_208));
        let fast = settings(19_201, Parity::Even, StopBits::One);
        assert_eq!(fast.silence_1_5(), Duration::from_micros(750));
        assert_eq!(fast.silence_3_5(), Duration::from_micros(1_750));
    }

    #[test]
    fn a_rate_of_zero_is_slow_and_does_not_panic() {
        let stopped = settings(0, Parity::None, StopBits::Two);
        assert_eq!(stopped.character_time(), Duration::from_secs(11));
        assert!(stopped.silence_3_5() > Duration::from_secs(11));
    }
}
