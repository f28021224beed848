//! Block downloads.

use fieldproof_link::Instant;

use super::super::{LONGEST_VALUE, Refusal, SEGMENT, Transfer};
use super::crc::crc;
use super::{CRC, END, SIZE, out_of_place};
use crate::canopen::{Abort, Address, Application, Slave};

/// A block download that has begun.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::canopen::sdo) struct BlockDownload {
    pub(super) address: Address,
    crc: bool,
    /// The size that the client gave.
    size: Option<usize>,
    /// The number of the last segment of this block that came in order, 0 if none did.
    received: u8,
    /// Some segment of this block came.
    begun: bool,
    /// The last segment of the transfer came in order.
    has_all: bool,
}

impl BlockDownload {
    /// A part of a block has come, and not all of it.
    pub(super) const fn has_come(self) -> bool {
        self.begun
    }

    pub(super) const fn has_all(self) -> bool {
        self.has_all
    }
}

impl Slave {
    /// | byte | holds |
    /// | --- | --- |
    /// | 0 | bit 2: the client makes a CRC; bit 1: the size is given |
    /// | 1 to 3 | index and sub-index |
    /// | 4 to 7 | size |
    pub(super) fn initiate_block_download(
        &mut self,
        now: Instant,
        request: &[u8; 8],
    ) -> Result<(), Refusal> {
        let [command, m0, m1, m2, data @ ..] = *request;
        let address = Address::from_multiplexer([m0, m1, m2]);
        self.forget_segments();
        self.sdo.transfer = Transfer::None;
        let size = (command & SIZE != 0).then(|| u32::from_le_bytes(data) as usize);
        self.check_download(address, size)
            .map_err(|abort| (address, abort))?;
        let own_crc = self.behaviour.block.crc;
        self.sdo.buffer.clear();
        self.sdo.transfer = Transfer::BlockDownload(BlockDownload {
            address,
            crc: command & CRC != 0 && own_crc,
            size,
            received: 0,
            begun: false,
            has_all: false,
        });
        let command = 0xA0 | if own_crc { CRC } else { 0 };
        let size = self.behaviour.block.block_size;
        self.respond(now, [command, m0, m1, m2, size, 0, 0, 0]);
        Ok(())
    }

    pub(super) fn download_block_segment(
        &mut self,
        now: Instant,
        request: &[u8; 8],
        application: &mut dyn Application,
    ) -> Result<(), Refusal> {
        let Transfer::BlockDownload(mut download) = self.sdo.transfer else {
            return Ok(());
        };
        let refused = |abort| (download.address, abort);
        let [command, data @ ..] = request;
        let (last, number) = (command & 0x80 != 0, command & 0x7F);
        let block = &self.behaviour.block;
        if number == 0 || number > block.block_size {
            return Err(refused(Abort::SEQUENCE_NUMBER));
        }
        let block_ends = last || number == block.block_size;
        let in_order = number == download.received + 1 || !block.order_checked;
        download.begun = true;
        if in_order {
            download.received = number;
            download.has_all = last;
            self.sdo.buffer.extend_from_slice(data);
            let slot = self.objects.find(download.address).map_err(refused)?;
            let fixed = self.objects.at(slot).and_then(|object| object.size());
            let longest = download.size.or(fixed).unwrap_or(LONGEST_VALUE);
            if self.sdo.buffer.len() >= longest.max(1) + SEGMENT {
                return Err(refused(Abort::TOO_LONG));
            }
        }
        self.sdo.transfer = Transfer::BlockDownload(download);
        if !block_ends {
            return Ok(());
        }
        if download.has_all && !self.behaviour.block.written_at_end {
            self.write_early(now, download, application);
        }
        self.acknowledge_block(now, download);
        Ok(())
    }

    /// Acknowledges what came in order; the next segment has number 1 again.
    pub(super) fn acknowledge_block(&mut self, now: Instant, download: BlockDownload) {
        let (received, size) = (download.received, self.behaviour.block.block_size);
        self.sdo.transfer = Transfer::BlockDownload(BlockDownload {
            received: 0,
            begun: false,
            ..download
        });
        let [_, _, _, rest @ ..] = self.reserved_bytes();
        let [r3, r4, r5, r6, r7] = rest;
        self.respond(now, [0xA2, received, size, r3, r4, r5, r6, r7]);
    }

    fn stray_end(&mut self, now: Instant, named: Address) -> Result<(), Refusal> {
        if self.behaviour.block.stray_end_refused {
            return Err(out_of_place(named));
        }
        self.respond(now, [END, 0, 0, 0, 0, 0, 0, 0]);
        Ok(())
    }

    /// Writes what has come, before the transfer has ended.
    pub(super) fn write_early(
        &mut self,
        now: Instant,
        download: BlockDownload,
        application: &mut dyn Application,
    ) {
        let Ok(slot) = self.objects.find(download.address) else {
            return;
        };
        let mut value = self.sdo.buffer.clone();
        value.truncate(download.size.unwrap_or(value.len()));
        // What is wrong with the value is said at the end.
        let _ = self.write(now, download.address, slot, &value, application);
    }

    /// | byte | holds |
    /// | --- | --- |
    /// | 0 | bits 4 to 2: bytes of the last segment that are not data |
    /// | 1, 2 | CRC |
    pub(super) fn end_block_download(
        &mut self,
        now: Instant,
        request: &[u8; 8],
        application: &mut dyn Application,
    ) -> Result<(), Refusal> {
        let [command, c0, c1, m2, ..] = *request;
        let Transfer::BlockDownload(download) = self.sdo.transfer else {
            return self.stray_end(now, Address::from_multiplexer([c0, c1, m2]));
        };
        let refused = |abort| (download.address, abort);
        let block = &self.behaviour.block;
        let (checks_size, checks_crc) = (block.size_checked, block.crc_checked && download.crc);
        let initial = block.crc_initial;
        let mut value = std::mem::take(&mut self.sdo.buffer);
        self.sdo.transfer = Transfer::None;
        let unused = usize::from(command >> 2 & 0x07);
        let size = value.len().checked_sub(unused);
        let as_given = |size| download.size.is_none_or(|given| given == size);
        let size = size.filter(|size| !checks_size || as_given(*size));
        value.truncate(size.ok_or(refused(Abort::LENGTH))?);
        if checks_crc && crc(initial, &value) != u16::from_le_bytes([c0, c1]) {
            return Err(refused(Abort::CRC));
        }
        let slot = self.objects.find(download.address).map_err(refused)?;
        let outcome = self.commit(now, END, download.address, slot, &value, application);
        self.sdo.buffer = value;
        outcome
    }
}
