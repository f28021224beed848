//! The faults that SDO block transfers can be given, each one departure from one clause.

use super::Recovery;
use crate::Fault;

const BLOCK_SIZE_UNCHECKED: Fault = Fault {
    name: "block-size-unchecked",
    breaks: "CiA 301: SDO block upload initiate and response, abort code 05040002h",
    words: "takes a block size of 0 or above 127 for 127",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.block_size_checked = false,
};

const BLOCK_SIZE_IGNORED: Fault = Fault {
    name: "block-size-ignored",
    breaks: "CiA 301: SDO block upload initiate, block size",
    words: "sends blocks of 127 segments, whatever was asked for",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.block_size_obeyed = false,
};

const NEXT_BLOCK_SIZE_IGNORED: Fault = Fault {
    name: "next-block-size-ignored",
    breaks: "CiA 301: SDO block upload response, block size",
    words: "keeps the block size of the beginning, whatever an acknowledge asks for",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.next_block_size_obeyed = false,
};

const BLOCK_ACKNOWLEDGE_UNCHECKED: Fault = Fault {
    name: "block-acknowledge-unchecked",
    breaks: "CiA 301: SDO block upload response, abort code 05040003h",
    words: "takes an acknowledge of more segments than it sent for one of all",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.acknowledge_checked = false,
};

const BLOCK_NOT_RESENT: Fault = Fault {
    name: "block-not-resent",
    breaks: "CiA 301: SDO block upload response, last segment received in order",
    words: "goes on with the next block when a part of one was not received",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.resends = false,
};

const BLOCK_ORDER_IGNORED: Fault = Fault {
    name: "block-order-ignored",
    breaks: "CiA 301: SDO block download segment, sequence number",
    words: "stores segments as they come, and does not notice that one is missing",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.order_checked = false,
};

const BLOCK_CRC_UNCHECKED: Fault = Fault {
    name: "block-crc-unchecked",
    breaks: "CiA 301: SDO block download end, abort code 05040004h",
    words: "takes a download whose CRC is wrong",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.crc_checked = false,
};

const BLOCK_CRC_WRONG: Fault = Fault {
    name: "block-crc-wrong",
    breaks: "CiA 301: SDO block transfer, CRC",
    words: "begins its CRC with FFFFh in place of 0",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.crc_initial = 0xFFFF,
};

const BLOCK_UNUSED_WRONG: Fault = Fault {
    name: "block-unused-wrong",
    breaks: "CiA 301: SDO block upload end, bytes without data",
    words: "says that every byte of the last segment is data",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.unused_given = false,
};

const BLOCK_LAST_NOT_MARKED: Fault = Fault {
    name: "block-last-not-marked",
    breaks: "CiA 301: SDO block upload segment, bit 7",
    words: "does not say that the last segment is the last",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.last_marked = false,
};

const BLOCK_NUMBERED_FROM_ZERO: Fault = Fault {
    name: "block-numbered-from-zero",
    breaks: "CiA 301: SDO block upload segment, sequence number",
    words: "gives the first segment of a block number 0",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.first_number = 0,
};

const BLOCK_UPLOAD_SIZE_WRONG: Fault = Fault {
    name: "block-upload-size-wrong",
    breaks: "CiA 301: SDO block upload initiate, size",
    words: "says that one byte more will come than does",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.surplus_size = 1,
};

const BLOCK_SWITCHES_UNASKED: Fault = Fault {
    name: "block-switches-unasked",
    breaks: "CiA 301: SDO block upload initiate, protocol switch threshold 0",
    words: "answers with the ordinary upload though the threshold is 0",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.switches_unasked = true,
};

const BLOCK_DOWNLOAD_SIZE_UNCHECKED: Fault = Fault {
    name: "block-download-size-unchecked",
    breaks: "CiA 301: SDO block download initiate, size",
    words: "takes a download that is not as long as was said",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.size_checked = false,
};

const BLOCK_WRITTEN_EARLY: Fault = Fault {
    name: "block-written-early",
    breaks: "CiA 301: SDO block download end",
    words: "writes a value when its last segment comes, and not when the transfer ends well",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.written_at_end = false,
};

const BLOCK_END_NOT_CONFIRMED: Fault = Fault {
    name: "block-end-not-confirmed",
    breaks: "CiA 301: SDO block download end, response",
    words: "does not confirm the end of a download",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.end_confirmed = false,
};

const BLOCK_ABANDONED_STAYS: Fault = Fault {
    name: "block-abandoned-stays",
    breaks: "CiA 301: SDO initiate requests",
    words: "answers no new request until a block transfer that the client has dropped is aborted",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.recovery = Recovery::AbortOnly,
};

const BLOCK_ABORTED_WRITTEN: Fault = Fault {
    name: "block-aborted-written",
    breaks: "CiA 301: SDO abort transfer",
    words: "writes what has come of a download when it is aborted within a block",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.recovery = Recovery::AbortedWritten,
};

const BLOCK_ANSWER_DIRTY: Fault = Fault {
    name: "block-answer-dirty",
    breaks: "CiA 301: SDO block protocols, reserved bytes are 0",
    words: "leaves bytes of the request in the reserved bytes of an acknowledge or an end",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.reserved_bytes_zero = false,
};

const BLOCK_STRAY_END_CONFIRMED: Fault = Fault {
    name: "block-stray-end-confirmed",
    breaks: "CiA 301: SDO abort code 05040001h",
    words: "confirms the end of a block download that was never begun",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.block.stray_end_refused = false,
};

/// What a CANopen slave here can have that does SDO block transfers.
pub(crate) const BLOCK: &[Fault] = &[
    BLOCK_SIZE_UNCHECKED,
    BLOCK_SIZE_IGNORED,
    NEXT_BLOCK_SIZE_IGNORED,
    BLOCK_ACKNOWLEDGE_UNCHECKED,
    BLOCK_NOT_RESENT,
    BLOCK_ORDER_IGNORED,
    BLOCK_CRC_UNCHECKED,
    BLOCK_CRC_WRONG,
    BLOCK_UNUSED_WRONG,
    BLOCK_LAST_NOT_MARKED,
    BLOCK_NUMBERED_FROM_ZERO,
    BLOCK_UPLOAD_SIZE_WRONG,
    BLOCK_SWITCHES_UNASKED,
    BLOCK_DOWNLOAD_SIZE_UNCHECKED,
    BLOCK_WRITTEN_EARLY,
    BLOCK_END_NOT_CONFIRMED,
    BLOCK_ABANDONED_STAYS,
    BLOCK_ABORTED_WRITTEN,
    BLOCK_ANSWER_DIRTY,
    BLOCK_STRAY_END_CONFIRMED,
];
