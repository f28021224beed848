//! What travels on a port, and how a port is set.

use fieldproof_can::Frame;

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
}
