//! What the client sends.

use super::block::{self, acknowledge, crc_and_size};
use super::data::toggle_bit;
use super::{ABORT, BlockSize, RawSdo, Segment, SegmentNumber, Transfer, UnusedBytes};
use crate::canopen::{AbortCode, Multiplexer};
use crate::violation::reserved_is_zero;
use crate::{Rule, Violation};

/// A message of the client.
///
/// | bits 7..5 of byte 0 | service |
/// | --- | --- |
/// | 0 | download segment |
/// | 1 | initiate download |
/// | 2 | initiate upload |
/// | 3 | upload segment |
/// | 4 | abort |
/// | 5 | block upload: bits 1..0 say 0 initiate, 1 end, 2 acknowledge, 3 start |
/// | 6 | block download: bit 0 says 0 initiate, 1 end |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Request {
    /// Asks for the value of an object.
    InitiateUpload(Multiplexer),
    /// Asks for the next segment.
    UploadSegment {
        /// Changes with every segment; clear in the first.
        toggle: bool,
    },
    /// Writes a value, or says that it will.
    InitiateDownload {
        /// The object.
        object: Multiplexer,
        /// The value, or how it will come.
        transfer: Transfer,
    },
    /// Carries a part of the value.
    DownloadSegment(Segment),
    /// Gives the transfer up.
    Abort {
        /// The object.
        object: Multiplexer,
        /// Why.
        code: AbortCode,
    },
    /// Asks for a value in blocks.
    InitiateBlockUpload {
        /// The object.
        object: Multiplexer,
        /// Whether the client can check a CRC.
        crc: bool,
        /// Segments in a block.
        block_size: BlockSize,
        /// Up to this many bytes the server may answer with the ordinary upload; 0: it may not.
        switch_threshold: u8,
    },
    /// Asks for the first block.
    StartBlockUpload,
    /// Confirms a block.
    AcknowledgeBlockUpload {
        /// The last segment received in order.
        acknowledged: Option<SegmentNumber>,
        /// Segments in the next block.
        block_size: BlockSize,
    },
    /// Confirms the end.
    EndBlockUpload,
    /// Says that a value will come in blocks.
    InitiateBlockDownload {
        /// The object.
        object: Multiplexer,
        /// Whether the client can make a CRC.
        crc: bool,
        /// How many bytes will come, if said.
        size: Option<u32>,
    },
    /// Says that all has been sent.
    EndBlockDownload {
        /// Bytes of the last segment that are not data.
        unused: UnusedBytes,
        /// CRC of the value; 0 if not agreed.
        crc: u16,
    },
}

impl Request {
    /// The 8 bytes.
    pub fn encode(&self) -> [u8; 8] {
        self.to_raw().0
    }

    fn to_raw(self) -> RawSdo {
        match self {
            Request::DownloadSegment(segment) => segment.encode(),
            Request::InitiateDownload { object, transfer } => {
                let (flags, data) = transfer.encode();
                RawSdo::with_object(0x20 | flags, object, data)
            }
            Request::InitiateUpload(object) => RawSdo::with_object(0x40, object, [0; 4]),
            Request::UploadSegment { toggle } => RawSdo::bare(0x60 | toggle_bit(toggle)),
            Request::Abort { object, code } => {
                RawSdo::with_object(ABORT, object, code.0.to_le_bytes())
            }
            Request::InitiateBlockUpload {
                object,
                crc,
                block_size,
                switch_threshold,
            } => RawSdo::with_object(
                0xA0 | u8::from(crc) << 2,
                object,
                [block_size.raw(), switch_threshold, 0, 0],
            ),
            Request::EndBlockUpload => RawSdo::bare(0xA1),
            Request::AcknowledgeBlockUpload {
                acknowledged,
                block_size,
            } => acknowledge(0xA2, acknowledged, block_size),
            Request::StartBlockUpload => RawSdo::bare(0xA3),
            Request::InitiateBlockDownload { object, crc, size } => {
                let (flags, size) = crc_and_size(crc, size);
                RawSdo::with_object(0xC0 | flags, object, size)
            }
            Request::EndBlockDownload { unused, crc } => block::end(0xC1, unused, crc),
        }
    }

    /// Reads 8 bytes; reserved bits and bytes are passed over.
    ///
    /// # Errors
    /// [`Violation`]: another length, an unknown command, a block size or segment number out of range.
    pub fn parse(data: &[u8]) -> Result<Request, Violation> {
        let raw = RawSdo::from_slice(data)?;
        let object = raw.multiplexer();
        Ok(match raw.specifier() {
            0 => Request::DownloadSegment(Segment::parse(raw)),
            1 => Request::InitiateDownload {
                object,
                transfer: Transfer::parse(raw),
            },
            2 => Request::InitiateUpload(object),
            3 => Request::UploadSegment {
                toggle: raw.flag(4),
            },
            4 => Request::Abort {
                object,
                code: AbortCode(raw.number()),
            },
            5 => Request::parse_block_upload(raw)?,
            6 if raw.flag(0) => {
                let (unused, crc) = block::parse_end(raw)?;
                Request::EndBlockDownload { unused, crc }
            }
            6 => Request::InitiateBlockDownload {
                object,
                crc: raw.flag(2),
                size: block::parse_size(raw),
            },
            _ => {
                let expected = "a client command specifier from 0 to 6 in bits 7..5";
                return Err(Violation::byte(Rule::Command, 0, raw.command(), expected));
            }
        })
    }

    fn parse_block_upload(raw: RawSdo) -> Result<Request, Violation> {
        Ok(match (raw.flag(1), raw.flag(0)) {
            (false, false) => Request::InitiateBlockUpload {
                object: raw.multiplexer(),
                crc: raw.flag(2),
                block_size: BlockSize::parse(raw.0[4], 4)?,
                switch_threshold: raw.0[5],
            },
            (false, true) => Request::EndBlockUpload,
            (true, false) => Request::AcknowledgeBlockUpload {
                acknowledged: block::parse_acknowledged(raw)?,
                block_size: BlockSize::parse(raw.0[2], 2)?,
            },
            (true, true) => Request::StartBlockUpload,
        })
    }

    /// Whether every reserved bit and byte of `data` is zero.
    ///
    /// # Errors
    /// [`Violation`]: the first byte that is not as [`Request::encode`] puts it, or what [`Request::parse`] says.
    pub fn check_reserved(data: &[u8]) -> Result<(), Violation> {
        reserved_is_zero(data, &Request::parse(data)?.encode())
    }

    /// The object, where the message names one.
    pub const fn object(&self) -> Option<Multiplexer> {
        match self {
            Request::InitiateUpload(object)
            | Request::InitiateDownload { object, .. }
            | Request::Abort { object, .. }
            | Request::InitiateBlockUpload { object, .. }
            | Request::InitiateBlockDownload { object, .. } => Some(*object),
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

    fn expedited(bytes: &[u8]) -> Request {
        Request::InitiateDownload {
            object: OBJECT,
            transfer: Transfer::Expedited(Data::new(bytes).unwrap()),
        }
    }

    fn size(raw: u8) -> BlockSize {
        BlockSize::new(raw).unwrap()
    }

    #[test]
    fn requests_are_these_bytes() {
        let cases: [([u8; 8], Request); 21] = [
            (
                [0x40, 8, 0x10, 2, 0, 0, 0, 0],
                Request::InitiateUpload(OBJECT),
            ),
            (
                [0x60, 0, 0, 0, 0, 0, 0, 0],
                Request::UploadSegment { toggle: false },
            ),
            (
                [0x70, 0, 0, 0, 0, 0, 0, 0],
                Request::UploadSegment { toggle: true },
            ),
            ([0x23, 8, 0x10, 2, 1, 2, 3, 4], expedited(&[1, 2, 3, 4])),
            ([0x27, 8, 0x10, 2, 1, 2, 3, 0], expedited(&[1, 2, 3])),
            ([0x2B, 8, 0x10, 2, 1, 2, 0, 0], expedited(&[1, 2])),
            ([0x2F, 8, 0x10, 2, 1, 0, 0, 0], expedited(&[1])),
            (
                [0x22, 8, 0x10, 2, 1, 2, 3, 4],
                Request::InitiateDownload {
                    object: OBJECT,
                    transfer: Transfer::ExpeditedUnsized([1, 2, 3, 4]),
                },
            ),
            (
                [0x21, 8, 0x10, 2, 10, 0, 0, 0],
                Request::InitiateDownload {
                    object: OBJECT,
                    transfer: Transfer::Segmented { size: Some(10) },
                },
            ),
            (
                [0x20, 8, 0x10, 2, 0, 0, 0, 0],
                Request::InitiateDownload {
                    object: OBJECT,
                    transfer: Transfer::Segmented { size: None },
                },
            ),
            (
                [0x00, 1, 2, 3, 4, 5, 6, 7],
                Request::DownloadSegment(Segment {
                    toggle: false,
                    last: false,
                    data: Data::new(&[1, 2, 3, 4, 5, 6, 7]).unwrap(),
                }),
            ),
            (
                [0x19, 1, 2, 3, 0, 0, 0, 0],
                Request::DownloadSegment(Segment {
                    toggle: true,
                    last: true,
                    data: Data::new(&[1, 2, 3]).unwrap(),
                }),
            ),
            (
                [0x80, 8, 0x10, 2, 0, 0, 4, 5],
                Request::Abort {
                    object: OBJECT,
                    code: AbortCode::TIMED_OUT,
                },
            ),
            (
                [0xA4, 8, 0x10, 2, 127, 21, 0, 0],
                Request::InitiateBlockUpload {
                    object: OBJECT,
                    crc: true,
                    block_size: size(127),
                    switch_threshold: 21,
                },
            ),
            ([0xA1, 0, 0, 0, 0, 0, 0, 0], Request::EndBlockUpload),
            (
                [0xA2, 5, 7, 0, 0, 0, 0, 0],
                Request::AcknowledgeBlockUpload {
                    acknowledged: SegmentNumber::new(5),
                    block_size: size(7),
                },
            ),
            (
                [0xA2, 0, 7, 0, 0, 0, 0, 0],
                Request::AcknowledgeBlockUpload {
                    acknowledged: None,
                    block_size: size(7),
                },
            ),
            ([0xA3, 0, 0, 0, 0, 0, 0, 0], Request::StartBlockUpload),
            (
                [0xC6, 8, 0x10, 2, 0, 1, 0, 0],
                Request::InitiateBlockDownload {
                    object: OBJECT,
                    crc: true,
                    size: Some(256),
                },
            ),
            (
                [0xC0, 8, 0x10, 2, 0, 0, 0, 0],
                Request::InitiateBlockDownload {
                    object: OBJECT,
                    crc: false,
                    size: None,
                },
            ),
            (
                [0xD5, 0xC3, 0x31, 0, 0, 0, 0, 0],
                Request::EndBlockDownload {
                    unused: UnusedBytes::new(5).unwrap(),
                    crc: 0x31C3,
                },
            ),
        ];
        for (bytes, request) in cases {
            assert_eq!(Request::parse(&bytes), Ok(request), "{bytes:02X?}");
            assert_eq!(request.encode(), bytes, "{request:?}");
            assert_eq!(Request::check_reserved(&bytes), Ok(()), "{bytes:02X?}");
        }
    }

    #[test]
    fn what_is_not_a_request_says_why() {
        let cases: [(&[u8], &str); 5] = [
            (
                &[0xE0, 0, 0, 0, 0, 0, 0, 0],
                "command: found E0h at byte 0, expected a client command specifier from 0 to 6 in bits 7..5",
            ),
            (&[0x40, 0, 0, 0], "length: found 4 bytes, expected 8 bytes"),
            (
                &[0xA0, 0, 0x10, 0, 128, 0, 0, 0],
                "range: found 128 at byte 4, expected 1 to 127",
            ),
            (
                &[0xA2, 0, 0, 0, 0, 0, 0, 0],
                "range: found 0 at byte 2, expected 1 to 127",
            ),
            (
                &[0xA2, 128, 1, 0, 0, 0, 0, 0],
                "range: found 128 at byte 1, expected 0 to 127",
            ),
        ];
        for (bytes, message) in cases {
            assert_eq!(Request::parse(bytes).unwrap_err().to_string(), message);
        }
    }

    #[test]
    fn reserved_bytes_are_read_over_and_reported() {
        let cases = [
            (
                [0x40, 8, 0x10, 2, 0, 0, 7, 0],
                "reserved: found 07h at byte 6, expected 00h",
            ),
            (
                [0x41, 8, 0x10, 2, 0, 0, 0, 0],
                "reserved: found 41h at byte 0, expected 40h",
            ),
            (
                [0x2B, 8, 0x10, 2, 1, 2, 3, 0],
                "reserved: found 03h at byte 6, expected 00h",
            ),
        ];
        for (bytes, message) in cases {
            assert_eq!(Request::parse(&bytes).unwrap().object(), Some(OBJECT));
            let violation = Request::check_reserved(&bytes).unwrap_err();
            assert_eq!(violation.to_string(), message);
        }
    }

    proptest! {
        #[test]
        fn what_is_read_is_read_again_from_what_is_written(bytes: [u8; 8]) {
            if let Ok(request) = Request::parse(&bytes) {
                prop_assert_eq!(Request::parse(&request.encode()), Ok(request));
                let clean = request.encode() == bytes;
                prop_assert_eq!(Request::check_reserved(&bytes).is_ok(), clean);
            } else {
                prop_assert!(bytes[0] >= 0xA0);
            }
        }

        #[test]
        fn any_length_but_eight_is_refused(bytes in proptest::collection::vec(any::<u8>(), 0..16)) {
            let read = Request::parse(&bytes);
            prop_assert!(bytes.len() == 8 || read.is_err());
        }
    }
}
