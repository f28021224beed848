//! How a slave does block transfers.

use std::time::Duration;

/// How an SDO server does block transfers. The default does none; with [`BlockTransfer::offered`] it conforms to
/// CiA 301.
#[derive(Debug, Clone)]
pub struct BlockTransfer {
    /// It does them; else their command specifiers are unknown to it.
    pub offered: bool,
    /// Segments of a block that it takes, `1..=127`.
    pub block_size: u8,
    /// It makes and checks CRCs, where the client does.
    pub crc: bool,
    /// It says before an upload how many bytes will come.
    pub size_given: bool,
    /// A value that is no longer than the client's threshold goes by the ordinary upload.
    pub switches: bool,
    /// How long it waits for the next request before it gives a transfer up.
    pub timeout: Duration,
    /// How long a block may pause before it acknowledges what has come.
    pub pause: Duration,

    /// A block size that there is not is refused, and not taken for 127.
    pub block_size_checked: bool,
    /// The block size that the client asks for at the beginning counts.
    pub block_size_obeyed: bool,
    /// The block size of an acknowledge counts for the next block.
    pub next_block_size_obeyed: bool,
    /// An acknowledge of more segments than were sent is refused.
    pub acknowledge_checked: bool,
    /// Segments that were not acknowledged are sent again.
    pub resends: bool,
    /// A segment out of order is not stored.
    pub order_checked: bool,
    /// The CRC of a download is checked.
    pub crc_checked: bool,
    /// What a CRC begins with: 0.
    pub crc_initial: u16,
    /// The end of an upload says how many bytes of the last segment are not data.
    pub unused_given: bool,
    /// The last segment of an upload says that it is the last.
    pub last_marked: bool,
    /// The number of the first segment of a block: 1.
    pub first_number: u8,
    /// Bytes that it says will come beyond those that do.
    pub surplus_size: u32,
    /// It switches to the ordinary upload though the client's threshold is 0.
    pub switches_unasked: bool,
    /// The size that a download was to have is compared with what came.
    pub size_checked: bool,
    /// A download is written when it has ended, and not with its last segment.
    pub written_at_end: bool,
    /// The end of a download is confirmed.
    pub end_confirmed: bool,
    /// The reserved bytes of its acknowledges and ends are 0, and not what the request had there.
    pub reserved_bytes_zero: bool,
    /// The end of a download that was never begun is refused.
    pub stray_end_refused: bool,
    /// How it gets out of a transfer that is not carried on.
    pub recovery: Recovery,
}

/// How an SDO server gets out of a block transfer that the client does not carry on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Recovery {
    /// An abort ends it; between blocks so does a new request.
    Full,
    /// A new request does not end it.
    AbortOnly,
    /// At an abort within a block what has come is written.
    AbortedWritten,
}

impl Default for BlockTransfer {
    fn default() -> BlockTransfer {
        BlockTransfer {
            offered: false,
            block_size: 127,
            crc: true,
            size_given: true,
            switches: true,
            timeout: Duration::from_secs(2),
            pause: Duration::from_millis(100),
            block_size_checked: true,
            block_size_obeyed: true,
            next_block_size_obeyed: true,
            acknowledge_checked: true,
            resends: true,
            order_checked: true,
            crc_checked: true,
            crc_initial: 0,
            unused_given: true,
            last_marked: true,
            first_number: 1,
            surplus_size: 0,
            switches_unasked: false,
            size_checked: true,
            written_at_end: true,
            end_confirmed: true,
            reserved_bytes_zero: true,
            stray_end_refused: true,
            recovery: Recovery::Full,
        }
    }
}
