//! EMCY.

use std::fmt;

use fieldproof_can::{Frame, Id};

use super::data_frame::from_node;
use super::identifier_entry::RawIdentifierEntry;
use super::{NodeId, Service, cob_id};
use crate::Violation;
use crate::violation::exactly;

/// An emergency error code. Any number can be one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ErrorCode(
    /// The code.
    pub u16,
);

impl ErrorCode {
    /// All errors, or this one, are gone.
    pub const NO_ERROR: ErrorCode = ErrorCode(0x0000);
    /// A CAN message was lost.
    pub const CAN_OVERRUN: ErrorCode = ErrorCode(0x8110);
    /// The controller is error passive.
    pub const ERROR_PASSIVE: ErrorCode = ErrorCode(0x8120);
    /// Life guarding or heartbeat failed.
    pub const HEARTBEAT: ErrorCode = ErrorCode(0x8130);
    /// The controller is back from bus off.
    pub const RECOVERED_FROM_BUS_OFF: ErrorCode = ErrorCode(0x8140);
    /// A PDO was too short to be used.
    pub const PDO_TOO_SHORT: ErrorCode = ErrorCode(0x8210);
    /// A PDO was longer than mapped.
    pub const PDO_TOO_LONG: ErrorCode = ErrorCode(0x8220);
    /// A SYNC had an unexpected length.
    pub const SYNC_LENGTH: ErrorCode = ErrorCode(0x8240);
    /// An RPDO did not come in time.
    pub const RPDO_TIMEOUT: ErrorCode = ErrorCode(0x8250);

    /// What the code says: the code itself if it is one of the constants, else the class in its upper bits; `None` for
    /// a class that CiA 301 does not have.
    pub const fn meaning(self) -> Option<&'static str> {
        Some(match (self.0, self.0 >> 8) {
            (0x8110, _) => "CAN overrun",
            (0x8120, _) => "CAN error passive",
            (0x8130, _) => "life guarding or heartbeat failed",
            (0x8140, _) => "recovered from bus off",
            (0x8210, _) => "PDO too short",
            (0x8220, _) => "PDO too long",
            (0x8240, _) => "unexpected SYNC length",
            (0x8250, _) => "RPDO timeout",
            (_, 0x00) => "no error",
            (_, 0x10) => "generic error",
            (_, 0x20..=0x2F) => "current",
            (_, 0x30..=0x3F) => "voltage",
            (_, 0x40..=0x4F) => "temperature",
            (_, 0x50) => "device hardware",
            (_, 0x60..=0x6F) => "device software",
            (_, 0x70) => "additional modules",
            (_, 0x81) => "communication",
            (_, 0x82) => "protocol",
            (_, 0x80) => "monitoring",
            (_, 0x90) => "external error",
            (_, 0xF0) => "additional functions",
            (_, 0xFF) => "device specific",
            _ => return None,
        })
    }
}

impl fmt::Display for ErrorCode {
    /// `8130h life guarding or heartbeat failed`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04X}h", self.0)?;
        match self.meaning() {
            Some(meaning) => write!(f, " {meaning}"),
            None => Ok(()),
        }
    }
}

/// The error register, object 1001h.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ErrorRegister(
    /// The bits.
    pub u8,
);

impl ErrorRegister {
    /// Bit 0: any error.
    pub const GENERIC: u8 = 1 << 0;
    /// Bit 1.
    pub const CURRENT: u8 = 1 << 1;
    /// Bit 2.
    pub const VOLTAGE: u8 = 1 << 2;
    /// Bit 3.
    pub const TEMPERATURE: u8 = 1 << 3;
    /// Bit 4.
    pub const COMMUNICATION: u8 = 1 << 4;
    /// Bit 5: specific to the device profile.
    pub const PROFILE: u8 = 1 << 5;
    /// Bit 6: reserved, always clear.
    pub const RESERVED: u8 = 1 << 6;
    /// Bit 7: specific to the manufacturer.
    pub const MANUFACTURER: u8 = 1 << 7;

    /// Whether one of `bits` is set.
    pub const fn has(self, bits: u8) -> bool {
        self.0 & bits != 0
    }
}

/// An EMCY message.
///
/// | byte | content |
/// | --- | --- |
/// | 0, 1 | error code, low byte first |
/// | 2 | error register |
/// | 3..=7 | manufacturer's own |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Emergency {
    /// The error.
    pub code: ErrorCode,
    /// The error register at that time.
    pub register: ErrorRegister,
    /// What the manufacturer adds.
    pub manufacturer: [u8; 5],
}

impl Emergency {
    /// The frame of `node`, on its predefined identifier.
    pub fn encode(&self, node: NodeId) -> Frame {
        let [low, high] = self.code.0.to_le_bytes();
        let [a, b, c, d, e] = self.manufacturer;
        let data = [low, high, self.register.0, a, b, c, d, e];
        Frame::of_eight(cob_id(Service::Emergency, Some(node)), data)
    }

    /// Reads a frame on a predefined identifier.
    ///
    /// # Errors
    /// [`Violation`]: not on an identifier of EMCY, a remote frame, not 8 bytes.
    pub fn parse(frame: &Frame) -> Result<(NodeId, Emergency), Violation> {
        let (node, bytes) = from_node(frame, Service::Emergency)?;
        let [low, high, register, manufacturer @ ..]: [u8; 8] = exactly(bytes)?;
        let emergency = Emergency {
            code: ErrorCode(u16::from_le_bytes([low, high])),
            register: ErrorRegister(register),
            manufacturer,
        };
        Ok((node, emergency))
    }
}

/// The value of object 1014h: which identifier EMCY has.
///
/// | bits | content |
/// | --- | --- |
/// | 31 | 1: there is no EMCY |
/// | 29 | 1: 29-bit identifier |
/// | 28..0 | identifier |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct EmergencyIdentifier {
    /// Whether EMCY is sent.
    pub valid: bool,
    /// On which identifier.
    pub id: Id,
}

impl EmergencyIdentifier {
    /// The value.
    pub fn encode(&self) -> u32 {
        RawIdentifierEntry::new(!self.valid, false, self.id).0
    }

    /// Reads the value; bit 30 is passed over.
    ///
    /// # Errors
    /// [`Violation`]: bits above an 11-bit identifier.
    pub fn parse(value: u32) -> Result<EmergencyIdentifier, Violation> {
        let raw = RawIdentifierEntry(value);
        Ok(EmergencyIdentifier {
            valid: !raw.bit_31(),
            id: raw.id()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_message_is_this_frame() {
        let frame: Frame = "085#3081110102030405".parse().unwrap();
        let node = NodeId::new(5).unwrap();
        let emergency = Emergency {
            code: ErrorCode::HEARTBEAT,
            register: ErrorRegister(0x11),
            manufacturer: [1, 2, 3, 4, 5],
        };
        assert_eq!(Emergency::parse(&frame), Ok((node, emergency)));
        assert_eq!(emergency.encode(node), frame);
        assert!(emergency.register.has(ErrorRegister::COMMUNICATION));
        assert!(!emergency.register.has(ErrorRegister::VOLTAGE));
    }

    #[test]
    fn what_is_not_a_message_says_why() {
        let cases = [
            (
                "080#",
                "identifier: found 080h, expected an identifier of EMCY",
            ),
            ("081#0000", "length: found 2 bytes, expected 8 bytes"),
            (
                "081#R8",
                "kind of frame: found a remote frame, expected a data frame",
            ),
        ];
        for (text, message) in cases {
            let violation = Emergency::parse(&text.parse().unwrap()).unwrap_err();
            assert_eq!(violation.to_string(), message);
        }
    }

    #[test]
    fn codes_have_a_meaning_or_a_class() {
        let cases = [
            (0x0000, "0000h no error"),
            (0x8130, "8130h life guarding or heartbeat failed"),
            (0x8199, "8199h communication"),
            (0x2310, "2310h current"),
            (0xFF01, "FF01h device specific"),
            (0xA000, "A000h"),
        ];
        for (code, text) in cases {
            assert_eq!(ErrorCode(code).to_string(), text);
        }
    }

    #[test]
    fn the_identifier_entry_is_this_value() {
        let entry = EmergencyIdentifier {
            valid: false,
            id: Id::standard(0x085).unwrap(),
        };
        assert_eq!(entry.encode(), 0x8000_0085);
        assert_eq!(EmergencyIdentifier::parse(0x8000_0085), Ok(entry));
    }

    proptest! {
        #[test]
        fn any_message_is_written_as_it_was_read(node in 1..=127u8, data: [u8; 8]) {
            let id = cob_id(Service::Emergency, NodeId::new(node));
            let frame = Frame::of_eight(id, data);
            let (node, emergency) = Emergency::parse(&frame).unwrap();
            prop_assert_eq!(emergency.encode(node), frame);
        }
    }
}
