//! Block transfers: requests and answers for a block of up to 127 segments, not for each.
//!
//! | bits 7..5 of byte 0 | of the client | of the server |
//! | --- | --- | --- |
//! | 5 | upload: bits 1..0 say 0 initiate, 1 end, 2 acknowledge, 3 start | download: 0 initiate, 1 end, 2 acknowledge |
//! | 6 | download: bit 0 says 0 initiate, 1 end | upload: bit 0 says 0 initiate, 1 end |
//!
//! Within a block bit 7 of byte 0 says that a segment is the last, the rest is its number; 80h is an abort.

mod crc;
mod download;
mod settings;
#[cfg(test)]
mod tests;
mod upload;

use fieldproof_link::Instant;

use super::{Refusal, Transfer};
use crate::canopen::{Abort, Address, Application, Slave};
pub(super) use download::BlockDownload;
pub use settings::{BlockTransfer, Recovery};
pub(super) use upload::{AskedBlocks, BlockUpload};

/// The most segments of a block.
const LARGEST_BLOCK: u8 = 127;
const ABORT: u8 = 0x80;
/// The answer to the end of a download.
pub(super) const END: u8 = 0xA1;
/// Bit 2 of byte 0 when a transfer begins: a CRC can be made or checked.
const CRC: u8 = 0x04;
/// Bit 1 of byte 0 when a transfer begins: the size is given.
const SIZE: u8 = 0x02;

impl Slave {
    /// Takes a request if it belongs to a block transfer.
    pub(super) fn serve_blocks(
        &mut self,
        now: Instant,
        request: &[u8; 8],
        application: &mut dyn Application,
    ) -> Option<Result<(), Refusal>> {
        if !self.behaviour.block.offered {
            return None;
        }
        let [command, m0, m1, m2, ..] = *request;
        let recovery = self.behaviour.block.recovery;
        if self.sdo.transfer.is_within_block() {
            return match command {
                ABORT => {
                    if let Transfer::BlockDownload(download) = self.sdo.transfer
                        && recovery == Recovery::AbortedWritten
                    {
                        self.write_early(now, download, application);
                    }
                    None
                }
                _ => Some(self.download_block_segment(now, request, application)),
            };
        }
        let begins = matches!(
            (command >> 5, command & 0x03),
            (1 | 2, _) | (5, 0) | (6, 0 | 2)
        );
        if begins && recovery == Recovery::AbortOnly && self.sdo.transfer.is_block() {
            return Some(Ok(()));
        }
        let named = Address::from_multiplexer([m0, m1, m2]);
        if matches!((command >> 5, command & 0x03), (5, 0) | (6, 0 | 2))
            && let Some(outcome) = self.begins(named)
        {
            return Some(outcome);
        }
        match (command >> 5, command & 0x03) {
            (5, 0) => Some(self.initiate_block_upload(now, request, application)),
            (5, 1) => Some(self.end_block_upload(named)),
            (5, 2) => Some(self.acknowledge_block_upload(now, request)),
            (5, _) => Some(self.start_block_upload(now, named)),
            (6, 0 | 2) => Some(self.initiate_block_download(now, request)),
            (6, _) => Some(self.end_block_download(now, request, application)),
            _ => None,
        }
    }

    /// Waits for the next request of a transfer, if one is open.
    pub(super) fn await_request(&mut self, now: Instant) {
        let block = &self.behaviour.block;
        self.sdo.deadline = match self.sdo.transfer {
            Transfer::BlockDownload(download) if download.has_come() => Some(now + block.pause),
            transfer if transfer.is_block() => Some(now + block.timeout),
            Transfer::Upload { .. } | Transfer::Download { .. } => {
                self.behaviour.sdo.timeout.map(|timeout| now + timeout)
            }
            _ => None,
        };
    }

    /// A block that pauses is acknowledged as far as it came; a transfer that does not go on is given up.
    pub(in crate::canopen) fn wake_sdo(&mut self, now: Instant) {
        if self.sdo.deadline.is_none_or(|at| at > now) {
            return;
        }
        self.sdo.deadline = None;
        match self.sdo.transfer {
            Transfer::BlockDownload(download) if download.has_come() => {
                self.acknowledge_block(now, download);
                self.await_request(now);
            }
            Transfer::Upload { address, .. }
            | Transfer::Download { address, .. }
            | Transfer::BlockDownload(BlockDownload { address, .. })
            | Transfer::BlockUpload(BlockUpload { address, .. }) => {
                self.abort(now, address, Abort::TIMED_OUT);
                self.sdo.stuck = !self.behaviour.sdo.serves_after_time_out;
            }
            _ => {}
        }
    }

    /// What stands in the bytes of an answer that hold nothing.
    fn reserved_bytes(&self) -> [u8; 8] {
        if self.behaviour.block.reserved_bytes_zero {
            [0; 8]
        } else {
            self.sdo.request
        }
    }

    /// A number of segments, `1..=127`.
    fn block_size(&self, asked: u8) -> Result<u8, Abort> {
        match asked {
            1..=LARGEST_BLOCK => Ok(asked),
            _ if self.behaviour.block.block_size_checked => Err(Abort::BLOCK_SIZE),
            _ => Ok(LARGEST_BLOCK),
        }
    }

    /// Answers that wait to be sent belong to a transfer that has ended.
    pub(super) fn forget_segments(&mut self) {
        if self.sdo.transfer.is_block() {
            self.queue.forget(self.answers_from(self.node));
        }
    }
}

impl Transfer {
    fn is_block(self) -> bool {
        matches!(self, Transfer::BlockUpload(_) | Transfer::BlockDownload(_))
    }

    /// Whether what comes is a segment.
    fn is_within_block(self) -> bool {
        matches!(self, Transfer::BlockDownload(download) if !download.has_all())
    }
}

/// An index, a sub-index, and what says that a request is out of place.
const fn out_of_place(named: Address) -> Refusal {
    (named, Abort::UNKNOWN_COMMAND)
}
