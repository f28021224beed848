//! What a right CANopen device may do otherwise.

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
    words: "sends its first heartbeat when 1017h is written, the next a period later",
    apply: |behaviour| behaviour.canopen.heartbeat_on_write = true,
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

pub(crate) const SLOW: Variant = Variant {
    name: "slow",
    words: "takes 10 to 15 ms for every answer",
    apply: |behaviour| behaviour.canopen.response_us = 10_000..15_000,
};

pub(crate) const LSS_ADDRESS_COMPARED_AT_THE_END: Variant = Variant {
    name: "lss-address-compared-at-the-end",
    words: "compares an LSS address when its fourth number has come, not number by number",
    apply: |behaviour| behaviour.canopen.lss.compares_at_the_end = true,
};
