//! What the master sends.

use fieldproof_can::Frame;

use super::{IdentityPart, node_byte, number_of, parse_node_byte, with_number};
use crate::canopen::data_frame::broadcast;
use crate::canopen::{NodeId, Service, cob_id};
use crate::violation::{exactly, reserved_is_zero};
use crate::{Rule, Violation};

bounded! {
    /// The lowest bit that fastscan compares, `0..=31`.
    pub struct BitCheck(u8) in 0..=31
}

/// A step of fastscan.
///
/// | byte | content |
/// | --- | --- |
/// | 0 | 51h |
/// | 1..=4 | the number compared |
/// | 5 | the lowest bit compared, or 80h: all slaves begin anew |
/// | 6 | which part is compared |
/// | 7 | which part comes next |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct FastScan {
    /// The number compared.
    pub number: u32,
    /// The lowest bit compared; `None`: all slaves begin anew.
    pub bit_check: Option<BitCheck>,
    /// Which part is compared.
    pub part: IdentityPart,
    /// Which part comes next.
    pub next: IdentityPart,
}

/// A message of the master.
///
/// | command | bytes 1.. |
/// | --- | --- |
/// | 04h switch state global | 00h waiting, 01h configuration |
/// | 11h configure node-ID | node-ID, FFh for none |
/// | 13h configure bit timing | table, index in it |
/// | 15h activate bit timing | delay in ms (2) |
/// | 17h store configuration | |
/// | 40h..43h switch state selective | vendor-ID, product code, revision number, serial number (4) |
/// | 46h..4Bh identify remote slave | vendor-ID, product code, lowest and highest revision, lowest and highest serial number (4) |
/// | 4Ch identify non-configured remote slave | |
/// | 51h fastscan | [`FastScan`] |
/// | 5Ah..5Dh inquire identity | |
/// | 5Eh inquire node-ID | |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Request {
    /// 04h: all slaves.
    SwitchGlobal {
        /// To configuration, else to waiting.
        configuration: bool,
    },
    /// 40h to 43h: with the fourth, the slave with all four switches to configuration and answers.
    SwitchSelective {
        /// Which part of the identity.
        part: IdentityPart,
        /// Its value.
        value: u32,
    },
    /// 11h
    ConfigureNodeId(
        /// The node-ID; `None` for none.
        Option<NodeId>,
    ),
    /// 13h
    ConfigureBitTiming {
        /// The table, 0 for that of CiA 305.
        table: u8,
        /// The entry.
        index: u8,
    },
    /// 15h
    ActivateBitTiming {
        /// Milliseconds before and again after the switch.
        delay_ms: u16,
    },
    /// 17h
    StoreConfiguration,
    /// 5Ah to 5Dh
    InquireIdentity(
        /// Which part of the identity.
        IdentityPart,
    ),
    /// 5Eh
    InquireNodeId,
    /// 46h and 47h: vendor-ID or product code, alike.
    Identify {
        /// Whether it is the product code, else the vendor-ID.
        product_code: bool,
        /// Its value.
        value: u32,
    },
    /// 48h to 4Bh: a limit of revision or serial number.
    IdentifyRange {
        /// Whether it is the serial number, else the revision number.
        serial_number: bool,
        /// Whether it is the highest, else the lowest.
        highest: bool,
        /// Its value.
        value: u32,
    },
    /// 4Ch
    IdentifyNonConfigured,
    /// 51h
    FastScan(FastScan),
}

impl Request {
    /// The 8 bytes.
    pub fn encode_bytes(&self) -> [u8; 8] {
        match *self {
            Request::SwitchGlobal { configuration } => with_number(0x04, u32::from(configuration)),
            Request::ConfigureNodeId(node) => with_number(0x11, u32::from(node_byte(node))),
            Request::ConfigureBitTiming { table, index } => [0x13, table, index, 0, 0, 0, 0, 0],
            Request::ActivateBitTiming { delay_ms } => with_number(0x15, u32::from(delay_ms)),
            Request::StoreConfiguration => with_number(0x17, 0),
            Request::SwitchSelective { part, value } => with_number(0x40 + part.number(), value),
            Request::Identify {
                product_code,
                value,
            } => with_number(0x46 + u8::from(product_code), value),
            Request::IdentifyRange {
                serial_number,
                highest,
                value,
            } => {
                let command = 0x48 + 2 * u8::from(serial_number) + u8::from(highest);
                with_number(command, value)
            }
            Request::IdentifyNonConfigured => with_number(0x4C, 0),
            Request::FastScan(scan) => {
                let [a, b, c, d] = scan.number.to_le_bytes();
                let bit_check = scan.bit_check.map_or(0x80, BitCheck::raw);
                let (part, next) = (scan.part.number(), scan.next.number());
                [0x51, a, b, c, d, bit_check, part, next]
            }
            Request::InquireIdentity(part) => with_number(0x5A + part.number(), 0),
            Request::InquireNodeId => with_number(0x5E, 0),
        }
    }

    /// Reads 8 bytes.
    ///
    /// # Errors
    /// [`Violation`]: another length, an unknown command, a mode, node-ID, bit or part out of range.
    pub fn parse_bytes(bytes: &[u8]) -> Result<Request, Violation> {
        let bytes: [u8; 8] = exactly(bytes)?;
        let value = number_of(bytes);
        Ok(match bytes[0] {
            0x04 => Request::SwitchGlobal {
                configuration: parse_mode(bytes[1])?,
            },
            0x11 => Request::ConfigureNodeId(parse_node_byte(bytes[1])?),
            0x13 => Request::ConfigureBitTiming {
                table: bytes[1],
                index: bytes[2],
            },
            0x15 => Request::ActivateBitTiming {
                delay_ms: u16::from_le_bytes([bytes[1], bytes[2]]),
            },
            0x17 => Request::StoreConfiguration,
            command @ 0x40..=0x43 => Request::SwitchSelective {
                part: parse_part(command - 0x40, 0)?,
                value,
            },
            command @ 0x46..=0x47 => Request::Identify {
                product_code: command == 0x47,
                value,
            },
            command @ 0x48..=0x4B => Request::IdentifyRange {
                serial_number: command >= 0x4A,
                highest: command & 1 == 1,
                value,
            },
            0x4C => Request::IdentifyNonConfigured,
            0x51 => Request::FastScan(parse_fast_scan(bytes)?),
            command @ 0x5A..=0x5D => Request::InquireIdentity(parse_part(command - 0x5A, 0)?),
            0x5E => Request::InquireNodeId,
            command => {
                let expected = "a command of the LSS master";
                return Err(Violation::byte(Rule::Command, 0, command, expected));
            }
        })
    }

    /// Whether every byte that the message does not use is zero.
    ///
    /// # Errors
    /// [`Violation`]: the first that is not, or what [`Request::parse_bytes`] says.
    pub fn check_reserved(bytes: &[u8]) -> Result<(), Violation> {
        reserved_is_zero(bytes, &Request::parse_bytes(bytes)?.encode_bytes())
    }

    /// The frame.
    pub fn encode(&self) -> Frame {
        Frame::of_eight(cob_id(Service::LssRequest, None), self.encode_bytes())
    }

    /// Reads a frame.
    ///
    /// # Errors
    /// [`Violation`]: not on 7E5h, a remote frame, or what [`Request::parse_bytes`] says.
    pub fn parse(frame: &Frame) -> Result<Request, Violation> {
        Request::parse_bytes(broadcast(frame, Service::LssRequest)?)
    }
}

fn parse_mode(mode: u8) -> Result<bool, Violation> {
    match mode {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(Violation::range(1, u64::from(mode), 0, 1)),
    }
}

fn parse_part(number: u8, offset: usize) -> Result<IdentityPart, Violation> {
    IdentityPart::from_number(number)
        .ok_or_else(|| Violation::range(offset, u64::from(number), 0, 3))
}

fn parse_fast_scan(bytes: [u8; 8]) -> Result<FastScan, Violation> {
    let bit_check = match bytes[5] {
        0x80 => None,
        bit => {
            let expected = "a bit from 0 to 31, or 80h";
            let bit =
                BitCheck::new(bit).ok_or_else(|| Violation::byte(Rule::Range, 5, bit, expected))?;
            Some(bit)
        }
    };
    Ok(FastScan {
        number: number_of(bytes),
        bit_check,
        part: parse_part(bytes[6], 6)?,
        next: parse_part(bytes[7], 7)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    #[rustfmt::skip]
    fn requests_are_these_frames() {
        use IdentityPart::{ProductCode, RevisionNumber, SerialNumber, VendorId};
        let range = |serial_number, highest| Request::IdentifyRange { serial_number, highest, value: 1 };
        let cases = [
            ("7E5#0400000000000000", Request::SwitchGlobal { configuration: false }),
            ("7E5#0401000000000000", Request::SwitchGlobal { configuration: true }),
            ("7E5#1105000000000000", Request::ConfigureNodeId(NodeId::new(5))),
            ("7E5#11FF000000000000", Request::ConfigureNodeId(None)),
            ("7E5#1300040000000000", Request::ConfigureBitTiming { table: 0, index: 4 }),
            ("7E5#15E8030000000000", Request::ActivateBitTiming { delay_ms: 1000 }),
            ("7E5#1700000000000000", Request::StoreConfiguration),
            ("7E5#403C060000000000", Request::SwitchSelective { part: VendorId, value: 0x63C }),
            ("7E5#4101000000000000", Request::SwitchSelective { part: ProductCode, value: 1 }),
            ("7E5#4201000000000000", Request::SwitchSelective { part: RevisionNumber, value: 1 }),
            ("7E5#43B8615D0E000000", Request::SwitchSelective { part: SerialNumber, value: 241_000_888 }),
            ("7E5#463C060000000000", Request::Identify { product_code: false, value: 0x63C }),
            ("7E5#4701000000000000", Request::Identify { product_code: true, value: 1 }),
            ("7E5#4801000000000000", range(false, false)),
            ("7E5#4901000000000000", range(false, true)),
            ("7E5#4A01000000000000", range(true, false)),
            ("7E5#4B01000000000000", range(true, true)),
            ("7E5#4C00000000000000", Request::IdentifyNonConfigured),
            (
                "7E5#5100000000800000",
                Request::FastScan(FastScan { number: 0, bit_check: None, part: VendorId, next: VendorId }),
            ),
            (
                "7E5#513C060000000001",
                Request::FastScan(FastScan {
                    number: 0x63C,
                    bit_check: Some(BitCheck::MIN),
                    part: VendorId,
                    next: ProductCode,
                }),
            ),
            ("7E5#5A00000000000000", Request::InquireIdentity(VendorId)),
            ("7E5#5D00000000000000", Request::InquireIdentity(SerialNumber)),
            ("7E5#5E00000000000000", Request::InquireNodeId),
        ];
        for (text, request) in cases {
            let frame: Frame = text.parse().unwrap();
            assert_eq!(Request::parse(&frame), Ok(request), "{text}");
            assert_eq!(request.encode(), frame, "{text}");
        }
    }

    #[test]
    fn what_is_not_a_request_says_why() {
        let cases = [
            (
                "7E4#0401000000000000",
                "identifier: found 7E4h, expected an identifier of LSS request",
            ),
            ("7E5#0401", "length: found 2 bytes, expected 8 bytes"),
            (
                "7E5#0402000000000000",
                "range: found 2 at byte 1, expected 0 to 1",
            ),
            (
                "7E5#1180000000000000",
                "range: found 128 at byte 1, expected 1 to 127, or 255 for none",
            ),
            (
                "7E5#1200000000000000",
                "command: found 12h at byte 0, expected a command of the LSS master",
            ),
            (
                "7E5#5100000000200000",
                "range: found 20h at byte 5, expected a bit from 0 to 31, or 80h",
            ),
            (
                "7E5#5100000000000400",
                "range: found 4 at byte 6, expected 0 to 3",
            ),
        ];
        for (text, message) in cases {
            let violation = Request::parse(&text.parse().unwrap()).unwrap_err();
            assert_eq!(violation.to_string(), message);
        }
    }

    proptest! {
        #[test]
        fn what_is_read_is_read_again_from_what_is_written(command in 0..0x60u8, rest: [u8; 7]) {
            let [a, b, c, d, e, f, g] = rest;
            let bytes = [command, a, b, c, d, e, f, g];
            if let Ok(request) = Request::parse_bytes(&bytes) {
                prop_assert_eq!(Request::parse(&request.encode()), Ok(request));
                let clean = request.encode_bytes() == bytes;
                prop_assert_eq!(Request::check_reserved(&bytes).is_ok(), clean);
            }
        }
    }
}
