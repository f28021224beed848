//! What a right CANopen device may do otherwise.

use std::time::Duration;

use super::{SecondInitiate, ShortRequest, StraySegment};
use crate::Variant;

pub(crate) const NO_TPDO_ON_START: Variant = Variant {
    name: "no-tpdo-on-start",
    words: "sends an event-driven TPDO at its first event, not on entering Operational: CiA 301 leaves that open",
    apply: |behaviour| behaviour.canopen.tpdo_on_start = false,
};

pub(crate) const TPDO_WITH_FIRST_SYNC: Variant = Variant {
    name: "tpdo-with-first-sync",
    words: "sends a cyclic TPDO with the first SYNC, then with every n-th: CiA 301 leaves open which is the first",
    apply: |behaviour| behaviour.canopen.tpdo_with_first_sync = true,
};

pub(crate) const REMOTE_FRAMES_IGNORED: Variant = Variant {
    name: "remote-frames-ignored",
    words: "does not answer a remote frame for a TPDO: CiA advises against them, a device need not",
    apply: |behaviour| behaviour.canopen.remote_frames_answered = false,
};

pub(crate) const HEARTBEAT_AT_ONCE: Variant = Variant {
    name: "heartbeat-at-once",
    words: "sends its first heartbeat when 1017h is written or right behind its boot-up, the next a period later",
    apply: |behaviour| {
        behaviour.canopen.heartbeat_on_write = true;
        behaviour.canopen.error_control.heartbeat_with_boot_up = true;
    },
};

pub(crate) const SMALL_BLOCKS: Variant = Variant {
    name: "small-blocks",
    words: "takes blocks of 4 segments, gives no size before a block upload and never switches to the ordinary one",
    apply: |behaviour| {
        behaviour.canopen.block.block_size = 4;
        behaviour.canopen.block.size_given = false;
        behaviour.canopen.block.switches = false;
    },
};

pub(crate) const GENERAL_ABORT_CODES: Variant = Variant {
    name: "general-abort-codes",
    words: "says that access, length or value are wrong, and not in which way: CiA 301 has a code for each",
    apply: |behaviour| {
        behaviour.canopen.abort_codes = &[
            (0x0601_0001, 0x0601_0000),
            (0x0601_0002, 0x0601_0000),
            (0x0607_0012, 0x0607_0010),
            (0x0607_0013, 0x0607_0010),
            (0x0609_0031, 0x0609_0030),
            (0x0609_0032, 0x0609_0030),
            (0x0609_0036, 0x0609_0030),
        ];
    },
};

pub(crate) const CAREFUL_SDO: Variant = Variant {
    name: "careful-sdo",
    words: "gives up a segmented transfer after 500 ms, and when another request comes; refuses a short request",
    apply: |behaviour| {
        let sdo = &mut behaviour.canopen.sdo;
        sdo.timeout = Some(Duration::from_millis(500));
        sdo.second_initiate = SecondInitiate::Aborted;
        sdo.short_request = ShortRequest::Refused;
    },
};

pub(crate) const TERSE_SDO: Variant = Variant {
    name: "terse-sdo",
    words: "gives no size before a segmented upload, and does not answer a segment request with no transfer open",
    apply: |behaviour| {
        let sdo = &mut behaviour.canopen.sdo;
        sdo.size_given = false;
        sdo.stray_segment = StraySegment::Ignored;
    },
};

pub(crate) const SLOW: Variant = Variant {
    name: "slow",
    words: "takes 10 to 15 ms for every answer",
    apply: |behaviour| behaviour.canopen.response_us = 10_000..15_000,
};

pub(crate) const LONG_NMT_COMMANDS: Variant = Variant {
    name: "long-nmt-commands",
    words: "takes an NMT command of more than two bytes by its first two: CiA 301 does not say what becomes of it",
    apply: |behaviour| behaviour.canopen.nmt.long_commands_taken = true,
};

pub(crate) const GUARDED_BESIDE_HEARTBEAT: Variant = Variant {
    name: "guarded-beside-heartbeat",
    words: "answers guarding requests while it sends heartbeats: it need not, and misses no master then",
    apply: |behaviour| {
        behaviour
            .canopen
            .error_control
            .guarding_answered_beside_heartbeat = true
    },
};

pub(crate) const GUARDED_BY_ONE_BYTE: Variant = Variant {
    name: "guarded-by-one-byte",
    words: "ignores a guarding request whose length is not 1: the remote frame has the length of what it asks for",
    apply: |behaviour| behaviour.canopen.error_control.guarding_answers_any_length = false,
};
