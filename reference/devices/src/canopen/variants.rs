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

pub(crate) const OTHER_PDO_ABORTS: Variant = Variant {
    name: "other-pdo-aborts",
    words: "refuses PDO parameters with other codes that fit: 06010000h and 06020000h",
    apply: |behaviour| {
        behaviour.canopen.pdo.abort_not_now = 0x0601_0000;
        behaviour.canopen.pdo.abort_not_mappable = 0x0602_0000;
        behaviour.canopen.pdo.abort_too_long = 0x0604_0041;
    },
};

pub(crate) const EMPTY_PLACES_READ_0: Variant = Variant {
    name: "empty-places-read-0",
    words: "reads 0 in a place of 1003h that holds no error, where others refuse",
    apply: |behaviour| behaviour.canopen.manners.empty_places_refused = false,
};

pub(crate) const FIRST_SYNC_AT_ONCE: Variant = Variant {
    name: "first-sync-at-once",
    words: "produces its first SYNC at once, not after one period: CiA 301 has it within a period",
    apply: |behaviour| behaviour.canopen.manners.first_sync_at_once = true,
};

pub(crate) const EMERGENCY_LATE: Variant = Variant {
    name: "emergency-late",
    words: "sends an EMCY 20 ms after its error: CiA 301 sets no time",
    apply: |behaviour| behaviour.canopen.manners.emergency_late = true,
};

pub(crate) const PASSING_ERRORS_SHOWN: Variant = Variant {
    name: "passing-errors-shown",
    words: "shows a communication error in the EMCY for a PDO of the wrong length, though 1001h has forgotten it",
    apply: |behaviour| behaviour.canopen.manners.passing_errors_shown = true,
};

pub(crate) const LONG_PDO_UNREPORTED: Variant = Variant {
    name: "long-pdo-unreported",
    words: "uses the first bytes of an RPDO that is too long without an EMCY: 8220h is optional",
    apply: |behaviour| behaviour.canopen.manners.long_pdo_unreported = true,
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

pub(crate) const LSS_ADDRESS_COMPARED_AT_THE_END: Variant = Variant {
    name: "lss-address-compared-at-the-end",
    words: "compares an LSS address when its fourth number has come, not number by number",
    apply: |behaviour| behaviour.canopen.lss.compares_at_the_end = true,
};
