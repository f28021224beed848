//! What the slaves send.

use std::fmt;

use fieldproof_can::Frame;

use super::{IdentityPart, node_byte, number_of, parse_node_byte, with_number};
use crate::canopen::data_frame::broadcast;
use crate::canopen::{NodeId, Service, cob_id};
use crate::violation::{exactly, reserved_is_zero};
use crate::{Rule, Violation};

/// Whether a configuration command was carried out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Outcome {
    /// 0: done; 1: not supported or out of range; 2: the storage failed; 255: see `specific`.
    pub error: u8,
    /// The manufacturer's own error code.
    pub specific: u8,
}

impl Outcome {
    /// It was carried out.
    pub const DONE: Outcome = Outcome {
        error: 0,
        specific: 0,
    };
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.error {
            0 => write!(f, "done"),
            255 => write!(f, "error of the manufacturer's, {:02X}h", self.specific),
            error => write!(f, "error {error}"),
        }
    }
}

/// A message of a slave.
///
/// | command | bytes 1.. |
/// | --- | --- |
/// | 11h configure node-ID, 13h configure bit timing, 17h store configuration | error, specific error |
/// | 44h switch state selective | |
/// | 4Fh identify slave, fastscan | |
/// | 50h identify non-configured slave | |
/// | 5Ah..5Dh inquire identity | vendor-ID, product code, revision number, serial number (4) |
/// | 5Eh inquire node-ID | node-ID, FFh for none |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Response {
    /// 11h
    ConfigureNodeId(Outcome),
    /// 13h
    ConfigureBitTiming(Outcome),
    /// 17h
    StoreConfiguration(Outcome),
    /// 44h: the slave is in configuration now.
    SwitchSelective,
    /// 4Fh: a slave is meant, by identify or by fastscan.
    IdentifySlave,
    /// 50h: a slave has no node-ID.
    IdentifyNonConfigured,
    /// 5Ah to 5Dh
    InquireIdentity {
        /// Which part of the identity.
        part: IdentityPart,
        /// Its value.
        value: u32,
    },
    /// 5Eh
    InquireNodeId(
        /// The node-ID; `None` for none.
        Option<NodeId>,
    ),
}

impl Response {
    /// The 8 bytes.
    pub fn encode_bytes(&self) -> [u8; 8] {
        match *self {
            Response::ConfigureNodeId(outcome) => with_outcome(0x11, outcome),
            Response::ConfigureBitTiming(outcome) => with_outcome(0x13, outcome),
            Response::StoreConfiguration(outcome) => with_outcome(0x17, outcome),
            Response::SwitchSelective => with_number(0x44, 0),
            Response::IdentifySlave => with_number(0x4F, 0),
            Response::IdentifyNonConfigured => with_number(0x50, 0),
            Response::InquireIdentity { part, value } => with_number(0x5A + part.number(), value),
            Response::InquireNodeId(node) => with_number(0x5E, u32::from(node_byte(node))),
        }
    }

    /// Reads 8 bytes.
    ///
    /// # Errors
    /// [`Violation`]: another length, an unknown command, or a node-ID out of range.
    pub fn parse_bytes(bytes: &[u8]) -> Result<Response, Violation> {
        let bytes: [u8; 8] = exactly(bytes)?;
        let outcome = Outcome {
            error: bytes[1],
            specific: bytes[2],
        };
        let identity = |part| Response::InquireIdentity {
            part,
            value: number_of(bytes),
        };
        Ok(match bytes[0] {
            0x11 => Response::ConfigureNodeId(outcome),
            0x13 => Response::ConfigureBitTiming(outcome),
            0x17 => Response::StoreConfiguration(outcome),
            0x44 => Response::SwitchSelective,
            0x4F => Response::IdentifySlave,
            0x50 => Response::IdentifyNonConfigured,
            0x5A => identity(IdentityPart::VendorId),
            0x5B => identity(IdentityPart::ProductCode),
            0x5C => identity(IdentityPart::RevisionNumber),
            0x5D => identity(IdentityPart::SerialNumber),
            0x5E => Response::InquireNodeId(parse_node_byte(bytes[1])?),
            command => {
                let expected = "a command of an LSS slave";
                return Err(Violation::byte(Rule::Command, 0, command, expected));
            }
        })
    }

    /// Whether every byte that the message does not use is zero.
    ///
    /// # Errors
    /// [`Violation`]: the first that is not, or what [`Response::parse_bytes`] says.
    pub fn check_reserved(bytes: &[u8]) -> Result<(), Violation> {
        reserved_is_zero(bytes, &Response::parse_bytes(bytes)?.encode_bytes())
    }

    /// The frame.
    pub fn encode(&self) -> Frame {
        Frame::of_eight(cob_id(Service::LssResponse, None), self.encode_bytes())
    }

    /// Reads a frame.
    ///
    /// # Errors
    /// [`Violation`]: not on 7E4h, a remote frame, or what [`Response::parse_bytes`] says.
    pub fn parse(frame: &Frame) -> Result<Response, Violation> {
        Response::parse_bytes(broadcast(frame, Service::LssResponse)?)
    }
}

fn with_outcome(command: u8, outcome: Outcome) -> [u8; 8] {
    [command, outcome.error, outcome.specific, 0, 0, 0, 0, 0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    #[rustfmt::skip]
    fn responses_are_these_frames() {
        let identity = |part, value| Response::InquireIdentity { part, value };
        let refused = Outcome { error: 1, specific: 0 };
        let own = Outcome { error: 255, specific: 7 };
        let cases = [
            ("7E4#1100000000000000", Response::ConfigureNodeId(Outcome::DONE)),
            ("7E4#1301000000000000", Response::ConfigureBitTiming(refused)),
            ("7E4#17FF070000000000", Response::StoreConfiguration(own)),
            ("7E4#4400000000000000", Response::SwitchSelective),
            ("7E4#4F00000000000000", Response::IdentifySlave),
            ("7E4#5000000000000000", Response::IdentifyNonConfigured),
            ("7E4#5A3C060000000000", identity(IdentityPart::VendorId, 1596)),
            ("7E4#5B01000000000000", identity(IdentityPart::ProductCode, 1)),
            ("7E4#5C01000000000000", identity(IdentityPart::RevisionNumber, 1)),
            ("7E4#5DB8615D0E000000", identity(IdentityPart::SerialNumber, 241_000_888)),
            ("7E4#5E20000000000000", Response::InquireNodeId(NodeId::new(32))),
            ("7E4#5EFF000000000000", Response::InquireNodeId(None)),
        ];
        for (text, response) in cases {
            let frame: Frame = text.parse().unwrap();
            assert_eq!(Response::parse(&frame), Ok(response), "{text}");
            assert_eq!(response.encode(), frame, "{text}");
        }
    }

    #[test]
    fn what_is_not_a_response_says_why() {
        let cases = [
            (
                "7E5#1100000000000000",
                "identifier: found 7E5h, expected an identifier of LSS response",
            ),
            (
                "7E4#11000000000000",
                "length: found 7 bytes, expected 8 bytes",
            ),
            (
                "7E4#0400000000000000",
                "command: found 04h at byte 0, expected a command of an LSS slave",
            ),
            (
                "7E4#5E00000000000000",
                "range: found 0 at byte 1, expected 1 to 127, or 255 for none",
            ),
        ];
        for (text, message) in cases {
            let violation = Response::parse(&text.parse().unwrap()).unwrap_err();
            assert_eq!(violation.to_string(), message);
        }
    }

    #[test]
    fn unused_bytes_are_read_over_and_reported() {
        let bytes = [0x44, 0, 0, 0, 0, 0, 0, 9];
        assert_eq!(Response::parse_bytes(&bytes), Ok(Response::SwitchSelective));
        assert_eq!(
            Response::check_reserved(&bytes).unwrap_err().to_string(),
            "reserved: found 09h at byte 7, expected 00h"
        );
    }

    proptest! {
        #[test]
        fn what_is_read_is_read_again_from_what_is_written(command in 0..0x60u8, rest: [u8; 7]) {
            let [a, b, c, d, e, f, g] = rest;
            let bytes = [command, a, b, c, d, e, f, g];
            if let Ok(response) = Response::parse_bytes(&bytes) {
                prop_assert_eq!(Response::parse(&response.encode()), Ok(response));
                let clean = response.encode_bytes() == bytes;
                prop_assert_eq!(Response::check_reserved(&bytes).is_ok(), clean);
            }
        }
    }
}
