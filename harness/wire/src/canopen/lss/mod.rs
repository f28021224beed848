//! LSS (CiA 305): setting node-ID and bit rate over the bus, and finding devices by their identity.
//!
//! Every message has 8 bytes, the master's on 7E5h, the slaves' on 7E4h. Byte 0 is the command specifier; numbers go
//! low byte first; what a message does not use is zero. `parse` passes over what is not used; `check_reserved` looks at
//! it.

mod request;
mod response;

pub use request::{BitCheck, FastScan, Request};
pub use response::{Outcome, Response};

use std::fmt;

use super::NodeId;
use crate::{Rule, Violation};

/// A part of the LSS address: one entry of the identity object 1018h.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum IdentityPart {
    /// 1018h:01
    VendorId,
    /// 1018h:02
    ProductCode,
    /// 1018h:03
    RevisionNumber,
    /// 1018h:04
    SerialNumber,
}

impl IdentityPart {
    /// The parts in the order of the identity object.
    pub const ALL: [IdentityPart; 4] = [
        IdentityPart::VendorId,
        IdentityPart::ProductCode,
        IdentityPart::RevisionNumber,
        IdentityPart::SerialNumber,
    ];

    /// `0..=3`, as fastscan counts and as the commands of a group follow each other.
    pub const fn number(self) -> u8 {
        match self {
            IdentityPart::VendorId => 0,
            IdentityPart::ProductCode => 1,
            IdentityPart::RevisionNumber => 2,
            IdentityPart::SerialNumber => 3,
        }
    }

    /// The part with this number.
    pub const fn from_number(number: u8) -> Option<IdentityPart> {
        match number {
            0 => Some(IdentityPart::VendorId),
            1 => Some(IdentityPart::ProductCode),
            2 => Some(IdentityPart::RevisionNumber),
            3 => Some(IdentityPart::SerialNumber),
            _ => None,
        }
    }
}

impl fmt::Display for IdentityPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            IdentityPart::VendorId => "vendor-ID",
            IdentityPart::ProductCode => "product code",
            IdentityPart::RevisionNumber => "revision number",
            IdentityPart::SerialNumber => "serial number",
        })
    }
}

/// The bit rate in bit/s that the table of CiA 305 (selector 0) has at `index`; `None` for reserved indices and for 9,
/// automatic detection.
pub const fn bit_rate(index: u8) -> Option<u32> {
    match index {
        0 => Some(1_000_000),
        1 => Some(800_000),
        2 => Some(500_000),
        3 => Some(250_000),
        4 => Some(125_000),
        6 => Some(50_000),
        7 => Some(20_000),
        8 => Some(10_000),
        _ => None,
    }
}

/// The node-ID as LSS writes it: FFh is no node-ID.
fn node_byte(node: Option<NodeId>) -> u8 {
    node.map_or(0xFF, NodeId::raw)
}

fn parse_node_byte(byte: u8) -> Result<Option<NodeId>, Violation> {
    match (byte, NodeId::new(byte)) {
        (0xFF, _) => Ok(None),
        (_, Some(node)) => Ok(Some(node)),
        _ => Err(Violation::new(
            Rule::Range,
            1,
            byte.to_string(),
            "1 to 127, or 255 for none",
        )),
    }
}

/// A message with a command and a number in bytes 1 to 4.
fn with_number(command: u8, number: u32) -> [u8; 8] {
    let [a, b, c, d] = number.to_le_bytes();
    [command, a, b, c, d, 0, 0, 0]
}

/// Bytes 1 to 4 as a number.
fn number_of(bytes: [u8; 8]) -> u32 {
    let [_, a, b, c, d, ..] = bytes;
    u32::from_le_bytes([a, b, c, d])
}
