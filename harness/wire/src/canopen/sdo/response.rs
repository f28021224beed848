//! What the server sends.

use super::block::{self, acknowledge, crc_and_size};
use super::data::toggle_bit;
use super::{ABORT, BlockSize, RawSdo, Segment, SegmentNumber, Transfer, UnusedBytes};
use crate::canopen::{AbortCode, Multiplexer};
use crate::violation::reserved_is_zero;
use crate::{Rule, Violation};

/// A message of the server.
///
/// | bits 7..5 of byte 0 | service |
/// | --- | --- |
/// | 0 | upload segment |
/// | 1 | download segment |
/// | 2 | initiate upload |
/// | 3 | initiate download |
/// | 4 | abort |
/// | 5 | block download: bits 1..0 say 0 initiate, 1 end, 2 acknowledge |
/// | 6 | block upload: bit 0 says 0 initiate, 1 end |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Response {
    /// Gives the value, or says how it will come.
    InitiateUpload {
        /// The object.
        object: Multiplexer,
        /// The value, or how it will come.
        transfer: Transfer,
    },
    /// Carries a part of the value.
    UploadSegment(Segment),
    /// The value is written, or its segments may come.
    InitiateDownload(Multiplexer),
    /// Confirms a segment.
    DownloadSegment {
        /// That of the segment.
        toggle: bool,
    },
    /// Refuses, or gives the transfer up.
    Abort {
        /// The object.
        object: Multiplexer,
        /// Why.
        code: AbortCode,
    },
    /// Says that the value will come in blocks.
    InitiateBlockUpload {
        /// The object.
        object: Multiplexer,
        /// Whether the server can make a CRC.
        crc: bool,
        /// How many bytes will come, if said.
        size: Option<u32>,
    },
    /// Says that all has been sent.
    EndBlockUpload {
        /// Bytes of the last segment that are not data.
        unused: UnusedBytes,
        /// CRC of the value; 0 if not agreed.
        crc: u16,
    },
    /// The first block may come.
    InitiateBlockDownload {
        /// The object.
        object: Multiplexer,
        /// Whether the server can check a CRC.
        crc: bool,
        /// Segments in a block.
        block_size: BlockSize,
    },
    /// Confirms a block.
    AcknowledgeBlockDownload {
        /// The last segment received in order.
        acknowledged: Option<SegmentNumber>,
        /// Segments in the next block.
        block_size: BlockSize,
    },
    /// Confirms the end.
    EndBlockDownload,
}

impl Response {
    /// The 8 bytes.
    pub fn encode(&self) -> [u8; 8] {
        self.to_raw().0
    }

    fn to_raw(self) -> RawSdo {
        match self {
            Response::UploadSegment(segment) => segment.encode(),
            Response::DownloadSegment { toggle } => RawSdo::bare(0x20 | toggle_bit(toggle)),
            Response::InitiateUpload { object, transfer } => {
                let (flags, data) = transfer.encode();
                RawSdo::with_object(0x40 | flags, object, data)
            }
            Response::InitiateDownload(object) => RawSdo::with_object(0x60, object, [0; 4]),
            Response::Abort { object, code } => {
                RawSdo::with_object(ABORT, object, code.0.to_le_bytes())
            }
            Response::InitiateBlockDownload {
                object,
                crc,
                block_size,
            } => RawSdo::with_object(
                0xA0 | u8::from(crc) << 2,
                object,
                [block_size.raw(), 0, 0, 0],
            ),
            Response::EndBlockDownload => RawSdo::bare(0xA1),
            Response::AcknowledgeBlockDownload {
                acknowledged,
                block_size,
            } => acknowledge(0xA2, acknowledged, block_size),
            Response::InitiateBlockUpload { object, crc, size } => {
                let (flags, size) = crc_and_size(crc, size);
                RawSdo::with_object(0xC0 | flags, object, size)
            }
            Response::EndBlockUpload { unused, crc } => block::end(0xC1, unused, crc),
        }
    }

    /// Reads 8 bytes; reserved bits and bytes are passed over.
    ///
    /// # Errors
    /// [`Violation`]: another length, an unknown command, a block size or segment number out of range.
    pub fn parse(data: &[u8]) -> Result<Response, Violation> {
        let raw = RawSdo::from_slice(data)?;
        let object = raw.multiplexer();
        Ok(match raw.specifier() {
            0 => Response::UploadSegment(Segment::parse(raw)),
            1 => Response::DownloadSegment {
                toggle: raw.flag(4),
            },
            2 => Response::InitiateUpload {
                object,
                transfer: Transfer::parse(raw),
            },
            3 => Response::InitiateDownload(object),
            4 => Response::Abort {
                object,
                code: AbortCode(raw.number()),
            },
            5 => Response::parse_block_download(raw)?,
            6 if raw.flag(0) => {
                let (unused, crc) = block::parse_end(raw)?;
                Response::EndBlockUpload { unused, crc }
            }
            6 => Response::InitiateBlockUpload {
                object,
                crc: raw.flag(2),
                size: block::parse_size(raw),
            },
            _ => {
                let expected = "a server command specifier from 0 to 6 in bits 7..5";
                return Err(Violation::byte(Rule::Command, 0, raw.command(), expected));
            }
        })
    }

    fn parse_block_download(raw: RawSdo) -> Result<Response, Violation> {
        Ok(match (raw.flag(1), raw.flag(0)) {
            (false, false) => Response::InitiateBlockDownload {
                object: raw.multiplexer(),
                crc: raw.flag(2),
                block_size: BlockSize::parse(raw.0[4], 4)?,
            },
            (false, true) => Response::EndBlockDownload,
            (true, false) => Response::AcknowledgeBlockDownload {
                acknowledged: block::parse_acknowledged(raw)?,
                block_size: BlockSize::parse(raw.0[2], 2)?,
            },
            (true, true) => {
                let expected = "a server subcommand from 0 to 2 in bits 1..0";
                return Err(Violation::byte(Rule::Command, 0, raw.command(), expected));
            }
        })
    }

    /// Whether every reserved bit and byte of `data` is zero.
    ///
    /// # Errors
    /// [`Violation`]: the first byte that is not as [`Response::encode`] puts it, or what [`Response::parse`] says.
    pub fn check_reserved(data: &[u8]) -> Result<(), Violation> {
        reserved_is_zero(data, &Response::parse(data)?.encode())
    }

    /// The object, where the message names one.
    pub const fn object(&self) -> Option<Multiplexer> {
        match self {
            Response::InitiateUpload { object, .. }
            | Response::InitiateDownload(object)
            | Response::Abort { object, .. }
            | Response::InitiateBlockUpload { object, .. }
            | Response::InitiateBlockDownload { object, .. } => Some(*object),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canopen::sdo::Data;
    use proptest::prelude::*;

    const OBJECT: Multiplexer = Multiplexer::new(0x1008, 0x02);

    fn upload(transfer: Transfer) -> Response {
        Response::InitiateUpload {
            object: OBJECT,
            transfer,
        }
    }

    fn expedited(bytes: &[u8]) -> Response {
        upload(Transfer::Expedited(Data::new(bytes).unwrap()))
    }

    #[test]
    fn responses_are_these_bytes() {
        let cases: [([u8; 8], Response); 19] = [
            ([0x43, 8, 0x10, 2, 1, 2, 3, 4], expedited(&[1, 2, 3, 4])),
            ([0x47, 8, 0x10, 2, 1, 2, 3, 0], expedited(&[1, 2, 3])),
            ([0x4B, 8, 0x10, 2, 1, 2, 0, 0], expedited(&[1, 2])),
            ([0x4F, 8, 0x10, 2, 1, 0, 0, 0], expedited(&[1])),
            (
                [0x42, 8, 0x10, 2, 1, 2, 3, 4],
                upload(Transfer::ExpeditedUnsized([1, 2, 3, 4])),
            ),
            (
                [0x41, 8, 0x10, 2, 10, 0, 0, 0],
                upload(Transfer::Segmented { size: Some(10) }),
            ),
            (
                [0x40, 8, 0x10, 2, 0, 0, 0, 0],
                upload(Transfer::Segmented { size: None }),
            ),
            (
                [0x00, 1, 2, 3, 4, 5, 6, 7],
                Response::UploadSegment(Segment {
                    toggle: false,
                    last: false,
                    data: Data::new(&[1, 2, 3, 4, 5, 6, 7]).unwrap(),
                }),
            ),
            (
                [0x19, b'C', b'A', b'N', 0, 0, 0, 0],
                Response::UploadSegment(Segment {
                    toggle: true,
                    last: true,
                    data: Data::new(b"CAN").unwrap(),
                }),
            ),
            (
                [0x60, 8, 0x10, 2, 0, 0, 0, 0],
                Response::InitiateDownload(OBJECT),
            ),
            (
                [0x20, 0, 0, 0, 0, 0, 0, 0],
                Response::DownloadSegment { toggle: false },
            ),
            (
                [0x30, 0, 0, 0, 0, 0, 0, 0],
                Response::DownloadSegment { toggle: true },
            ),
            (
                [0x80, 8, 0x10, 2, 0x11, 0, 9, 6],
                Response::Abort {
                    object: OBJECT,
                    code: AbortCode::SUB_INDEX_DOES_NOT_EXIST,
                },
            ),
            (
                [0xC6, 8, 0x10, 2, 0, 1, 0, 0],
                Response::InitiateBlockUpload {
                    object: OBJECT,
                    crc: true,
                    size: Some(256),
                },
            ),
            (
                [0xC0, 8, 0x10, 2, 0, 0, 0, 0],
                Response::InitiateBlockUpload {
                    object: OBJECT,
                    crc: false,
                    size: None,
                },
            ),
            (
                [0xDD, 0xC3, 0x31, 0, 0, 0, 0, 0],
                Response::EndBlockUpload {
                    unused: UnusedBytes::MAX,
                    crc: 0x31C3,
                },
            ),
            (
                [0xA4, 8, 0x10, 2, 127, 0, 0, 0],
                Response::InitiateBlockDownload {
                    object: OBJECT,
                    crc: true,
                    block_size: BlockSize::MAX,
                },
            ),
            (
                [0xA2, 127, 1, 0, 0, 0, 0, 0],
                Response::AcknowledgeBlockDownload {
                    acknowledged: Some(SegmentNumber::MAX),
                    block_size: BlockSize::MIN,
                },
            ),
            ([0xA1, 0, 0, 0, 0, 0, 0, 0], Response::EndBlockDownload),
        ];
        for (bytes, response) in cases {
            assert_eq!(Response::parse(&bytes), Ok(response), "{bytes:02X?}");
            assert_eq!(response.encode(), bytes, "{response:?}");
            assert_eq!(Response::check_reserved(&bytes), Ok(()), "{bytes:02X?}");
        }
    }

    #[test]
    fn what_is_not_a_response_says_why() {
        let cases: [(&[u8], &str); 4] = [
            (
                &[0xFF; 8],
                "command: found FFh at byte 0, expected a server command specifier from 0 to 6 in bits 7..5",
            ),
            (
                &[0xA3, 0, 0, 0, 0, 0, 0, 0],
                "command: found A3h at byte 0, expected a server subcommand from 0 to 2 in bits 1..0",
            ),
            (
                &[0xA0, 0, 0x10, 0, 0, 0, 0, 0],
                "range: found 0 at byte 4, expected 1 to 127",
            ),
            (
                &[0x60, 0, 0x10, 0, 0, 0, 0, 0, 0],
                "length: found 9 bytes, expected 8 bytes",
            ),
        ];
        for (bytes, message) in cases {
            assert_eq!(Response::parse(bytes).unwrap_err().to_string(), message);
        }
    }

    #[test]
    fn a_download_response_that_repeats_the_value_is_read_and_reported() {
        let bytes = [0x60, 0x7A, 0x60, 0x00, 0xA0, 0x86, 0x01, 0x00];
        let object = Multiplexer::new(0x607A, 0);
        assert_eq!(
            Response::parse(&bytes),
            Ok(Response::InitiateDownload(object))
        );
        assert_eq!(
            Response::check_reserved(&bytes).unwrap_err().to_string(),
            "reserved: found A0h at byte 4, expected 00h"
        );
    }

    proptest! {
        #[test]
        fn what_is_read_is_read_again_from_what_is_written(bytes: [u8; 8]) {
            if let Ok(response) = Response::parse(&bytes) {
                prop_assert_eq!(Response::parse(&response.encode()), Ok(response));
                let clean = response.encode() == bytes;
                prop_assert_eq!(Response::check_reserved(&bytes).is_ok(), clean);
            } else {
                prop_assert!(bytes[0] >= 0xA0);
            }
        }

        #[test]
        fn any_length_but_eight_is_refused(bytes in proptest::collection::vec(any::<u8>(), 0..16)) {
            let read = Response::parse(&bytes);
            prop_assert!(bytes.len() == 8 || read.is_err());
        }
    }
}
