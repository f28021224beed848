//! Block uploads.

use fieldproof_link::Instant;

use super::super::{Asked, Refusal, SEGMENT, Transfer};
use super::crc::crc;
use super::{CRC, SIZE, out_of_place};
use crate::canopen::{Abort, Address, Application, Slave};

/// What a client asks for that wants a value in blocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::canopen::sdo) struct AskedBlocks {
    /// Both sides can do CRCs.
    crc: bool,
    /// Segments of a block.
    block_size: u8,
    /// Up to this many bytes the value may go by the ordinary upload; 0: it may not.
    threshold: u8,
}

/// A block upload that has begun.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::canopen::sdo) struct BlockUpload {
    pub(super) address: Address,
    crc: bool,
    block_size: u8,
    /// Bytes that the client has.
    offset: usize,
    /// Segments of the block that was sent; none before the start.
    sent: Option<u8>,
    /// Everything has been acknowledged, and the end was sent.
    ended: bool,
}

impl AskedBlocks {
    /// Whether a value of `size` bytes goes by the ordinary upload.
    pub(in crate::canopen::sdo) fn switches(self, slave: &Slave, size: usize) -> bool {
        let block = &slave.behaviour.block;
        let short = size <= usize::from(self.threshold) && self.threshold > 0;
        (block.switches && short) || (block.switches_unasked && self.threshold == 0)
    }
}

impl Slave {
    /// | byte | holds |
    /// | --- | --- |
    /// | 0 | bit 2: the client checks a CRC |
    /// | 1 to 3 | index and sub-index |
    /// | 4 | segments of a block |
    /// | 5 | threshold for the ordinary upload |
    pub(super) fn initiate_block_upload(
        &mut self,
        now: Instant,
        request: &[u8; 8],
        application: &mut dyn Application,
    ) -> Result<(), Refusal> {
        let [command, m0, m1, m2, block_size, threshold, ..] = *request;
        let address = Address::from_multiplexer([m0, m1, m2]);
        self.forget_segments();
        self.sdo.transfer = Transfer::None;
        let block_size = self
            .block_size(block_size)
            .map_err(|abort| (address, abort))?;
        let blocks = AskedBlocks {
            crc: command & CRC != 0 && self.behaviour.block.crc,
            block_size: if self.behaviour.block.block_size_obeyed {
                block_size
            } else {
                super::LARGEST_BLOCK
            },
            threshold,
        };
        self.begin_upload(now, address, Asked::Blocks(blocks), application)
    }

    pub(in crate::canopen::sdo) fn answer_block_upload(
        &mut self,
        now: Instant,
        address: Address,
        value: &[u8],
        blocks: AskedBlocks,
    ) {
        let block = &self.behaviour.block;
        let own_crc = if block.crc { CRC } else { 0 };
        let size = u32::try_from(value.len()).unwrap_or(u32::MAX) + block.surplus_size;
        let (flag, size) = if block.size_given {
            (SIZE, size)
        } else {
            (0, 0)
        };
        let [m0, m1, m2] = address.multiplexer();
        let [s0, s1, s2, s3] = size.to_le_bytes();
        self.sdo.buffer.clear();
        self.sdo.buffer.extend_from_slice(value);
        self.sdo.transfer = Transfer::BlockUpload(BlockUpload {
            address,
            crc: blocks.crc,
            block_size: blocks.block_size,
            offset: 0,
            sent: None,
            ended: false,
        });
        self.respond(now, [0xC0 | own_crc | flag, m0, m1, m2, s0, s1, s2, s3]);
    }

    pub(super) fn start_block_upload(
        &mut self,
        now: Instant,
        named: Address,
    ) -> Result<(), Refusal> {
        match self.sdo.transfer {
            Transfer::BlockUpload(upload) if upload.sent.is_none() => {
                self.send_block(now, upload);
                Ok(())
            }
            _ => Err(out_of_place(named)),
        }
    }

    /// Sends a block from where the client is.
    fn send_block(&mut self, now: Instant, mut upload: BlockUpload) {
        let block = &self.behaviour.block;
        let rest = self.sdo.buffer.get(upload.offset..).unwrap_or_default();
        let count = rest.len().div_ceil(SEGMENT).max(1);
        let (first, marks_last) = (block.first_number, block.last_marked);
        let mut segments = Vec::new();
        for number in 0..count.min(usize::from(upload.block_size)) {
            let part = rest.get(number * SEGMENT..).unwrap_or_default();
            let mut segment = [0; 8];
            let [command, data @ ..] = &mut segment;
            data.iter_mut().zip(part).for_each(|(to, from)| *to = *from);
            let last = marks_last && number + 1 == count;
            let [number, ..] = number.to_le_bytes();
            *command = u8::from(last) << 7 | (number + first) & 0x7F;
            segments.push(segment);
        }
        upload.sent = segments.len().to_le_bytes().first().copied();
        self.sdo.transfer = Transfer::BlockUpload(upload);
        let at = now + self.turnaround();
        for segment in segments {
            self.respond_at(at, self.node, segment);
        }
    }

    /// | byte | holds |
    /// | --- | --- |
    /// | 1 | the number of the last segment that came in order, 0 if none did |
    /// | 2 | segments of the next block |
    pub(super) fn acknowledge_block_upload(
        &mut self,
        now: Instant,
        request: &[u8; 8],
    ) -> Result<(), Refusal> {
        let [_, acknowledged, block_size, m2, ..] = *request;
        let named = Address::from_multiplexer([acknowledged, block_size, m2]);
        let Transfer::BlockUpload(mut upload) = self.sdo.transfer else {
            return Err(out_of_place(named));
        };
        let refused = |abort| (upload.address, abort);
        let Some(sent) = upload.sent.filter(|_| !upload.ended) else {
            return Err(refused(Abort::UNKNOWN_COMMAND));
        };
        if acknowledged > sent && self.behaviour.block.acknowledge_checked {
            return Err(refused(Abort::SEQUENCE_NUMBER));
        }
        let block_size = self.block_size(block_size).map_err(refused)?;
        if self.behaviour.block.next_block_size_obeyed {
            upload.block_size = block_size;
        }
        let taken = if self.behaviour.block.resends {
            acknowledged.min(sent)
        } else {
            sent
        };
        upload.offset += usize::from(taken) * SEGMENT;
        let has_all = upload.offset >= self.sdo.buffer.len() && taken > 0;
        if !has_all {
            self.send_block(now, upload);
            return Ok(());
        }
        upload.ended = true;
        self.sdo.transfer = Transfer::BlockUpload(upload);
        self.end_upload(now, upload);
        Ok(())
    }

    fn end_upload(&mut self, now: Instant, upload: BlockUpload) {
        let block = &self.behaviour.block;
        let [unused, ..] = (upload.offset - self.sdo.buffer.len()).to_le_bytes();
        let unused = if block.unused_given { unused } else { 0 };
        let crc = if upload.crc {
            crc(block.crc_initial, &self.sdo.buffer)
        } else {
            0
        };
        let [c0, c1] = crc.to_le_bytes();
        let [_, _, _, rest @ ..] = self.reserved_bytes();
        let [r3, r4, r5, r6, r7] = rest;
        self.respond(now, [0xC1 | unused << 2, c0, c1, r3, r4, r5, r6, r7]);
    }

    pub(super) fn end_block_upload(&mut self, named: Address) -> Result<(), Refusal> {
        match self.sdo.transfer {
            Transfer::BlockUpload(upload) if upload.ended => {
                self.sdo.transfer = Transfer::None;
                Ok(())
            }
            Transfer::BlockUpload(upload) => Err((upload.address, Abort::UNKNOWN_COMMAND)),
            _ => Err(out_of_place(named)),
        }
    }
}
