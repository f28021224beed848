//! NMT error control: boot-up, heartbeat and node guarding, on 700h + node-ID.
//!
//! | frame | content |
//! | --- | --- |
//! | remote, length 1 | guarding request |
//! | data, `00h` | boot-up |
//! | data, bit 7 clear | heartbeat, or guarding response with toggle 0; bits 6..0 are the state |
//! | data, bit 7 set | guarding response with toggle 1; bits 6..0 are the state |
//!
//! A heartbeat and a guarding response with toggle 0 are the same frame.

use fieldproof_can::Frame;

use super::data_frame::node_of;
use super::nmt::State;
use super::{NodeId, Service, cob_id};
use crate::Violation;
use crate::violation::exactly;

/// What an error control frame says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ErrorControl {
    /// The NMT master asks for the state.
    GuardRequest,
    /// The node has entered pre-operational after a reset.
    BootUp,
    /// Heartbeat, or the answer to a guarding request.
    Status {
        /// Always clear in a heartbeat; changes with every guarding response, clear in the first.
        toggle: bool,
        /// The node's state.
        state: State,
    },
}

impl ErrorControl {
    /// The heartbeat of a node in `state`.
    pub const fn heartbeat(state: State) -> ErrorControl {
        ErrorControl::Status {
            toggle: false,
            state,
        }
    }

    /// The frame of `node`, or to it.
    pub fn encode(&self, node: NodeId) -> Frame {
        let id = cob_id(Service::ErrorControl, Some(node));
        match self {
            ErrorControl::GuardRequest => Frame::remote_of::<1>(id),
            ErrorControl::BootUp => Frame::of(id, [0x00]),
            ErrorControl::Status { toggle, state } => {
                Frame::of(id, [u8::from(*toggle) << 7 | state.code()])
            }
        }
    }

    /// Reads a frame. The length that a remote frame asks for is passed over.
    ///
    /// # Errors
    /// [`Violation`]: not on an identifier of error control, or a data frame of another length than 1.
    pub fn parse(frame: &Frame) -> Result<(NodeId, ErrorControl), Violation> {
        let node = node_of(frame, Service::ErrorControl)?;
        if frame.is_remote() {
            return Ok((node, ErrorControl::GuardRequest));
        }
        let [byte] = exactly(frame.bytes())?;
        let content = match byte {
            0x00 => ErrorControl::BootUp,
            _ => ErrorControl::Status {
                toggle: byte & 0x80 != 0,
                state: State::from_code(byte),
            },
        };
        Ok((node, content))
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
    fn messages_are_these_frames() {
        let guarding = |toggle, state| ErrorControl::Status { toggle, state };
        let cases = [
            ("701#R1", 1, ErrorControl::GuardRequest),
            ("720#00", 32, ErrorControl::BootUp),
            ("701#04", 1, ErrorControl::heartbeat(State::Stopped)),
            ("701#05", 1, ErrorControl::heartbeat(State::Operational)),
            (
                "77F#7F",
                127,
                ErrorControl::heartbeat(State::PreOperational),
            ),
            ("701#85", 1, guarding(true, State::Operational)),
            ("701#FF", 1, guarding(true, State::PreOperational)),
            ("701#80", 1, guarding(true, State::Unknown(0))),
            ("701#02", 1, guarding(false, State::Unknown(2))),
        ];
        for (text, node, content) in cases {
            let node = NodeId::new(node).unwrap();
            assert_eq!(ErrorControl::parse(&frame(text)), Ok((node, content)));
            assert_eq!(content.encode(node), frame(text));
        }
        let (_, any_length) = ErrorControl::parse(&frame("701#R")).unwrap();
        assert_eq!(any_length, ErrorControl::GuardRequest);
    }

    #[test]
    fn what_is_not_a_message_says_why() {
        let cases = [
            ("701#", "length: found 0 bytes, expected 1 byte"),
            ("701#0505", "length: found 2 bytes, expected 1 byte"),
            (
                "700#05",
                "identifier: found 700h, expected an identifier of error control",
            ),
        ];
        for (text, message) in cases {
            let violation = ErrorControl::parse(&frame(text)).unwrap_err();
            assert_eq!(violation.to_string(), message);
        }
    }

    proptest! {
        #[test]
        fn any_byte_is_written_as_it_was_read(node in 1..=127u8, byte: u8) {
            let node = NodeId::new(node).unwrap();
            let frame = Frame::of(cob_id(Service::ErrorControl, Some(node)), [byte]);
            let (read, content) = ErrorControl::parse(&frame).unwrap();
            prop_assert_eq!(content.encode(read), frame);
        }
    }
}
