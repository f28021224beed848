//! What frames that mean nothing do to a slave with a fault.

use crate::Fault;

pub(crate) const STOPS_AT_UNKNOWN_COMMAND: Fault = Fault {
    name: "stops-at-unknown-command",
    breaks: "CiA 301: SDO protocol, command specifiers",
    words: "takes nothing more after an SDO request with a command specifier that there is none of",
    caught_by: "robustness",
    apply: |behaviour| behaviour.canopen.robustness.stops_at_unknown_command = true,
};

pub(crate) const STOPS_AT_REMOTE_REQUEST: Fault = Fault {
    name: "stops-at-remote-request",
    breaks: "CiA 301: SDO requests are data frames",
    words: "takes nothing more after a remote frame on the identifier of its SDO requests",
    caught_by: "robustness",
    apply: |behaviour| behaviour.canopen.robustness.stops_at_remote_request = true,
};

pub(crate) const STOPS_AT_EMPTY_REQUEST: Fault = Fault {
    name: "stops-at-empty-request",
    breaks: "CiA 301: SDO requests have eight bytes",
    words: "takes nothing more after an SDO request without data",
    caught_by: "robustness",
    apply: |behaviour| behaviour.canopen.robustness.stops_at_empty_request = true,
};

pub(crate) const STOPS_AT_REMOTE_NMT: Fault = Fault {
    name: "stops-at-remote-nmt",
    breaks: "CiA 301: NMT messages are data frames",
    words: "takes nothing more after a remote frame with identifier 000h",
    caught_by: "robustness",
    apply: |behaviour| behaviour.canopen.robustness.stops_at_remote_nmt = true,
};

pub(crate) const STOPS_AT_BURST: Fault = Fault {
    name: "stops-at-burst",
    breaks: "CiA 301: COB-IDs of others are not received",
    words: "takes nothing more after a burst of 65 frames",
    caught_by: "robustness",
    apply: |behaviour| behaviour.canopen.robustness.stops_at_burst = true,
};

pub(crate) const STOPS_AFTER_127_STRANGE_FRAMES: Fault = Fault {
    name: "stops-after-127-strange-frames",
    breaks: "CiA 301: COB-IDs of others are not received",
    words: "takes nothing more after 127 frames that were for nobody",
    caught_by: "robustness",
    apply: |behaviour| behaviour.canopen.robustness.leaks = true,
};

pub(crate) const EXTENDED_TAKEN_AS_STANDARD: Fault = Fault {
    name: "extended-taken-as-standard",
    breaks: "CiA 301: identifiers of 11 and of 29 bits are apart",
    words: "takes an extended frame for the standard one with the low 11 bits of its identifier",
    caught_by: "robustness",
    apply: |behaviour| behaviour.canopen.robustness.extended_taken_as_standard = true,
};

pub(crate) const NMT_WITHOUT_NODE_OBEYED: Fault = Fault {
    name: "nmt-without-node-obeyed",
    breaks: "CiA 301: NMT messages have two bytes",
    words: "obeys an NMT command of one byte as one to all nodes",
    caught_by: "robustness",
    apply: |behaviour| behaviour.canopen.robustness.nmt_without_node_obeyed = true,
};

pub(crate) const LONG_SYNC_RESETS: Fault = Fault {
    name: "long-sync-resets",
    breaks: "CiA 301: SYNC has no data, or a counter",
    words: "resets when a SYNC has more than one byte",
    caught_by: "robustness",
    apply: |behaviour| behaviour.canopen.robustness.long_sync_resets = true,
};

pub(crate) const SHORT_TIME_RESETS: Fault = Fault {
    name: "short-time-resets",
    breaks: "CiA 301: TIME has six bytes",
    words: "resets when a TIME has fewer than six bytes",
    caught_by: "robustness",
    apply: |behaviour| behaviour.canopen.robustness.short_time_resets = true,
};

pub(crate) const EMPTY_PDO_RESETS: Fault = Fault {
    name: "empty-pdo-resets",
    breaks: "CiA 301: a PDO that is too short is not processed",
    words: "resets when an RPDO has no data",
    caught_by: "robustness",
    apply: |behaviour| behaviour.canopen.robustness.empty_pdo_resets = true,
};

pub(crate) const FOREIGN_HEARTBEAT_ENDS_OWN: Fault = Fault {
    name: "foreign-heartbeat-ends-own",
    breaks: "CiA 301: heartbeat producer",
    words: "sends no heartbeat any more after one of another node that is not one byte",
    caught_by: "robustness",
    apply: |behaviour| behaviour.canopen.robustness.foreign_heartbeat_ends_own = true,
};

pub(crate) const UNKNOWN_IDENTIFIER_REPORTED: Fault = Fault {
    name: "unknown-identifier-reported",
    breaks: "CiA 301: COB-IDs of others are not received",
    words: "sends an EMCY when a frame comes that is for nobody",
    caught_by: "robustness",
    apply: |behaviour| behaviour.canopen.robustness.unknown_identifier_reported = true,
};

pub(crate) const SDO_FILTER_OF_SIX_BITS: Fault = Fault {
    name: "sdo-filter-of-six-bits",
    breaks: "CiA 301: predefined connection set, node-ID of seven bits",
    words: "answers SDO requests to the node whose node-ID differs by 64",
    caught_by: "robustness",
    apply: |behaviour| behaviour.canopen.robustness.sdo_filter_of_six_bits = true,
};

pub(crate) const NO_SDO_AT_NODE_127: Fault = Fault {
    name: "no-sdo-at-node-127",
    breaks: "CiA 301: predefined connection set, SDO of every node-ID from 1 to 127",
    words: "takes no SDO requests when its node-ID is 127",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.robustness.no_sdo_at = Some(127),
};

/// All of them.
pub(crate) const ALL: &[Fault] = &[
    STOPS_AT_UNKNOWN_COMMAND,
    STOPS_AT_REMOTE_REQUEST,
    STOPS_AT_EMPTY_REQUEST,
    STOPS_AT_REMOTE_NMT,
    STOPS_AT_BURST,
    STOPS_AFTER_127_STRANGE_FRAMES,
    EXTENDED_TAKEN_AS_STANDARD,
    NMT_WITHOUT_NODE_OBEYED,
    LONG_SYNC_RESETS,
    SHORT_TIME_RESETS,
    EMPTY_PDO_RESETS,
    FOREIGN_HEARTBEAT_ENDS_OWN,
    UNKNOWN_IDENTIFIER_REPORTED,
    SDO_FILTER_OF_SIX_BITS,
    NO_SDO_AT_NODE_127,
];
