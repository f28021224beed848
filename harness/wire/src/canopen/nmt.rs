//! NMT node control.

use std::fmt;

use fieldproof_can::Frame;

use super::data_frame::broadcast;
use super::{NodeId, Service, cob_id};
use crate::Violation;
use crate::violation::exactly;

/// What a node is told to do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Command {
    /// 01h: to operational.
    Start,
    /// 02h: to stopped.
    Stop,
    /// 80h: to pre-operational.
    EnterPreOperational,
    /// 81h: restart the application.
    ResetNode,
    /// 82h: restart the communication.
    ResetCommunication,
    /// Any other.
    Unknown(u8),
}

impl Command {
    /// The command specifier.
    pub const fn code(self) -> u8 {
        match self {
            Command::Start => 0x01,
            Command::Stop => 0x02,
            Command::EnterPreOperational => 0x80,
            Command::ResetNode => 0x81,
            Command::ResetCommunication => 0x82,
            Command::Unknown(code) => code,
        }
    }

    /// The command with this specifier.
    pub const fn from_code(code: u8) -> Command {
        match code {
            0x01 => Command::Start,
            0x02 => Command::Stop,
            0x80 => Command::EnterPreOperational,
            0x81 => Command::ResetNode,
            0x82 => Command::ResetCommunication,
            code => Command::Unknown(code),
        }
    }
}

impl fmt::Display for Command {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Command::Start => write!(f, "start"),
            Command::Stop => write!(f, "stop"),
            Command::EnterPreOperational => write!(f, "enter pre-operational"),
            Command::ResetNode => write!(f, "reset node"),
            Command::ResetCommunication => write!(f, "reset communication"),
            Command::Unknown(code) => write!(f, "unknown command {code:02X}h"),
        }
    }
}

/// The NMT state that a node reports, 7 bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum State {
    /// 04h
    Stopped,
    /// 05h
    Operational,
    /// 7Fh
    PreOperational,
    /// Any other.
    Unknown(u8),
}

impl State {
    /// The code, `00h..=7Fh`; of an unknown one the low 7 bits.
    pub const fn code(self) -> u8 {
        match self {
            State::Stopped => 0x04,
            State::Operational => 0x05,
            State::PreOperational => 0x7F,
            State::Unknown(code) => code & 0x7F,
        }
    }

    /// The state with this code; bit 7 is not part of it.
    pub const fn from_code(code: u8) -> State {
        match code & 0x7F {
            0x04 => State::Stopped,
            0x05 => State::Operational,
            0x7F => State::PreOperational,
            code => State::Unknown(code),
        }
    }
}

impl fmt::Display for State {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            State::Stopped => write!(f, "stopped"),
            State::Operational => write!(f, "operational"),
            State::PreOperational => write!(f, "pre-operational"),
            State::Unknown(code) => write!(f, "unknown state {code:02X}h"),
        }
    }
}

/// The NMT message on 000h.
///
/// | byte | content |
/// | --- | --- |
/// | 0 | command specifier |
/// | 1 | node-ID, 0 for all nodes |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct NmtMessage {
    /// What to do.
    pub command: Command,
    /// Who; `None` means all nodes.
    pub node: Option<NodeId>,
}

impl NmtMessage {
    /// The frame.
    pub fn encode(&self) -> Frame {
        let node = self.node.map_or(0, NodeId::raw);
        Frame::of(cob_id(Service::Nmt, None), [self.command.code(), node])
    }

    /// Reads a frame.
    ///
    /// # Errors
    /// [`Violation`]: not on 000h, a remote frame, not 2 bytes, or a node-ID over 127.
    pub fn parse(frame: &Frame) -> Result<NmtMessage, Violation> {
        let bytes = broadcast(frame, Service::Nmt)?;
        let [command, node] = exactly(bytes)?;
        let node = match node {
            0 => None,
            node => Some(
                NodeId::new(node).ok_or_else(|| Violation::range(1, u64::from(node), 0, 127))?,
            ),
        };
        Ok(NmtMessage {
            command: Command::from_code(command),
            node,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn frame(text: &str) -> Frame {
        text.parse().unwrap()
    }

    #[test]
    fn messages_are_these_bytes() {
        let cases = [
            ("000#0101", Command::Start, 1),
            ("000#027F", Command::Stop, 127),
            ("000#8020", Command::EnterPreOperational, 32),
            ("000#8105", Command::ResetNode, 5),
            ("000#8200", Command::ResetCommunication, 0),
            ("000#4200", Command::Unknown(0x42), 0),
        ];
        for (text, command, node) in cases {
            let message = NmtMessage {
                command,
                node: NodeId::new(node),
            };
            assert_eq!(NmtMessage::parse(&frame(text)), Ok(message), "{text}");
            assert_eq!(message.encode(), frame(text));
        }
    }

    #[test]
    fn what_is_not_a_message_says_why() {
        let cases = [
            (
                "001#0101",
                "identifier: found 001h, expected an identifier of NMT",
            ),
            (
                "00000000#0101",
                "identifier: found 00000000h, expected an identifier of NMT",
            ),
            (
                "000#R2",
                "kind of frame: found a remote frame, expected a data frame",
            ),
            ("000#01", "length: found 1 byte, expected 2 bytes"),
            ("000#010101", "length: found 3 bytes, expected 2 bytes"),
            ("000#0180", "range: found 128 at byte 1, expected 0 to 127"),
        ];
        for (text, message) in cases {
            let violation = NmtMessage::parse(&frame(text)).unwrap_err();
            assert_eq!(violation.to_string(), message);
        }
    }

    proptest! {
        #[test]
        fn what_is_read_is_written_again(command: u8, node in 0u8..=127) {
            let frame = Frame::of(cob_id(Service::Nmt, None), [command, node]);
            prop_assert_eq!(NmtMessage::parse(&frame).unwrap().encode(), frame);
        }

        #[test]
        fn states_keep_their_code(code in 0u8..=127) {
            prop_assert_eq!(State::from_code(code).code(), code);
        }
    }
}
