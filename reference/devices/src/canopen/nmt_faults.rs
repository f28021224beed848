//! The faults of the NMT slave, each one departure from one clause.

use super::nmt::{Command, State};
use super::queue::Service;
use crate::Fault;

pub(crate) const START_IGNORED_IN_STOPPED: Fault = Fault {
    name: "start-ignored-in-stopped",
    breaks: "CiA 301: NMT state machine, start remote node",
    words: "does not obey start in Stopped, only in Pre-operational",
    caught_by: "nmt",
    apply: |behaviour| {
        behaviour.canopen.nmt.ignored = Some((State::Stopped, Command::Enter(State::Operational)));
    },
};

pub(crate) const STOP_IGNORED_IN_PRE_OPERATIONAL: Fault = Fault {
    name: "stop-ignored-in-pre-operational",
    breaks: "CiA 301: NMT state machine, stop remote node",
    words: "does not obey stop in Pre-operational, only in Operational",
    caught_by: "nmt",
    apply: |behaviour| {
        behaviour.canopen.nmt.ignored =
            Some((State::PreOperational, Command::Enter(State::Stopped)));
    },
};

pub(crate) const PRE_OPERATIONAL_IGNORED_IN_STOPPED: Fault = Fault {
    name: "pre-operational-ignored-in-stopped",
    breaks: "CiA 301: NMT state machine, enter pre-operational",
    words: "does not obey enter pre-operational in Stopped",
    caught_by: "nmt",
    apply: |behaviour| {
        behaviour.canopen.nmt.ignored =
            Some((State::Stopped, Command::Enter(State::PreOperational)));
    },
};

pub(crate) const RESET_NODE_IGNORED_IN_STOPPED: Fault = Fault {
    name: "reset-node-ignored-in-stopped",
    breaks: "CiA 301: NMT state machine, reset node",
    words: "does not obey reset node in Stopped",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.nmt.ignored = Some((State::Stopped, Command::ResetNode)),
};

pub(crate) const RESET_COMMUNICATION_IGNORED_IN_OPERATIONAL: Fault = Fault {
    name: "reset-communication-ignored-in-operational",
    breaks: "CiA 301: NMT state machine, reset communication",
    words: "does not obey reset communication in Operational",
    caught_by: "nmt",
    apply: |behaviour| {
        behaviour.canopen.nmt.ignored = Some((State::Operational, Command::ResetCommunication));
    },
};

pub(crate) const NMT_COMMAND_OF_ONE_BYTE_OBEYED: Fault = Fault {
    name: "nmt-command-of-one-byte-obeyed",
    breaks: "CiA 301: NMT protocols, two bytes",
    words: "takes a command without a node-ID for one to all nodes",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.nmt.one_byte_taken = true,
};

pub(crate) const NMT_COMMAND_OF_THREE_BYTES_RESETS: Fault = Fault {
    name: "nmt-command-of-three-bytes-resets",
    breaks: "CiA 301: NMT protocols, two bytes",
    words: "resets itself when an NMT command has more than two bytes",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.nmt.long_commands_reset = true,
};

pub(crate) const NMT_EXTENDED_IDENTIFIER_OBEYED: Fault = Fault {
    name: "nmt-extended-identifier-obeyed",
    breaks: "CiA 301: NMT protocols, identifier 0 of 11 bits",
    words: "takes a frame with the 29-bit identifier 0 for an NMT command",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.nmt.extended_identifier_taken = true,
};

pub(crate) const BOOT_UP_REPEATED: Fault = Fault {
    name: "boot-up-repeated",
    breaks: "CiA 301: boot-up protocol, after initialisation",
    words: "sends its boot-up message whenever it is told to enter Pre-operational",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.nmt.boot_up_repeated = true,
};

pub(crate) const STARTS_BY_ITSELF: Fault = Fault {
    name: "starts-by-itself",
    breaks: "CiA 301: NMT state machine, from Initialisation to Pre-operational",
    words: "becomes operational after its boot-up with no command",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.nmt.starts_itself = true,
};

pub(crate) const APPLICATION_KEPT_BY_RESET_NODE: Fault = Fault {
    name: "application-kept-by-reset-node",
    breaks: "CiA 301: NMT state Reset application, power-on values from 2000h on",
    words: "resets its communication alone with reset node",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.nmt.restored_by_reset_node = 0x1000..=0x1FFF,
};

pub(crate) const COMMUNICATION_KEPT_BY_RESET_NODE: Fault = Fault {
    name: "communication-kept-by-reset-node",
    breaks: "CiA 301: NMT state Reset communication, which follows Reset application",
    words: "keeps its communication parameters over reset node",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.nmt.restored_by_reset_node = 0x2000..=0xFFFF,
};

pub(crate) const COMMUNICATION_KEPT_BY_RESET_COMMUNICATION: Fault = Fault {
    name: "communication-kept-by-reset-communication",
    breaks: "CiA 301: NMT state Reset communication, power-on values of 1000h to 1FFFh",
    words: "keeps its communication parameters over reset communication",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.nmt.restored_by_reset_communication = 0x0000..=0x0FFF,
};

pub(crate) const APPLICATION_LOST_BY_RESET_COMMUNICATION: Fault = Fault {
    name: "application-lost-by-reset-communication",
    breaks: "CiA 301: NMT state Reset communication, 1000h to 1FFFh alone",
    words: "gives all of its objects the values of power-on with reset communication",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.nmt.restored_by_reset_communication = 0x0000..=0xFFFF,
};

pub(crate) const BOOT_UP_TWICE: Fault = Fault {
    name: "boot-up-twice",
    breaks: "CiA 301: boot-up protocol",
    words: "sends its boot-up message twice",
    caught_by: "boot-up",
    apply: |behaviour| behaviour.canopen.nmt.boot_ups = 2,
};

pub(crate) const BOOT_UP_SHOWS_STATE: Fault = Fault {
    name: "boot-up-shows-state",
    breaks: "CiA 301: boot-up protocol, one byte of 0",
    words: "sends the state Pre-operational, 7Fh, in its boot-up message",
    caught_by: "boot-up",
    apply: |behaviour| behaviour.canopen.nmt.boot_up_byte = 0x7F,
};

pub(crate) const BOOT_UP_AFTER_HEARTBEAT: Fault = Fault {
    name: "boot-up-after-heartbeat",
    breaks: "CiA 301: boot-up protocol",
    words: "sends a heartbeat before its boot-up message",
    caught_by: "boot-up",
    apply: |behaviour| behaviour.canopen.nmt.heartbeat_before_boot_up = true,
};

pub(crate) const BOOT_UP_ONLY_AFTER_RESET_NODE: Fault = Fault {
    name: "boot-up-only-after-reset-node",
    breaks: "CiA 301: boot-up protocol",
    words: "sends no boot-up message after reset communication",
    caught_by: "boot-up",
    apply: |behaviour| behaviour.canopen.nmt.boot_up_after_reset_communication = false,
};

pub(crate) const SDO_SILENT_IN_OPERATIONAL: Fault = Fault {
    name: "sdo-silent-in-operational",
    breaks: "CiA 301: NMT states and communication objects, SDO in Operational",
    words: "answers SDO requests in Pre-operational alone",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.nmt.exchanged = Some((State::Operational, Service::Sdo)),
};

pub(crate) const SDO_OBEYED_IN_STOPPED: Fault = Fault {
    name: "sdo-obeyed-in-stopped",
    breaks: "CiA 301: NMT states and communication objects, no SDO in Stopped",
    words: "does what an SDO request says in Stopped, and only does not answer",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.nmt.requests_done_in_stopped = true,
};

pub(crate) const SYNC_PRODUCED_IN_STOPPED: Fault = Fault {
    name: "sync-produced-in-stopped",
    breaks: "CiA 301: NMT states and communication objects, no SYNC in Stopped",
    words: "goes on producing SYNC in Stopped",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.nmt.exchanged = Some((State::Stopped, Service::Sync)),
};

pub(crate) const SYNC_SILENT_IN_PRE_OPERATIONAL: Fault = Fault {
    name: "sync-silent-in-pre-operational",
    breaks: "CiA 301: NMT states and communication objects, SYNC in Pre-operational",
    words: "produces SYNC in Operational alone",
    caught_by: "nmt",
    apply: |behaviour| {
        behaviour.canopen.nmt.exchanged = Some((State::PreOperational, Service::Sync));
    },
};

pub(crate) const EMERGENCY_SENT_IN_STOPPED: Fault = Fault {
    name: "emergency-sent-in-stopped",
    breaks: "CiA 301: NMT states and communication objects, no EMCY in Stopped",
    words: "sends its EMCY in Stopped",
    caught_by: "nmt",
    apply: |behaviour| {
        behaviour.canopen.nmt.exchanged = Some((State::Stopped, Service::Emergency));
    },
};

pub(crate) const EMERGENCY_SILENT_IN_PRE_OPERATIONAL: Fault = Fault {
    name: "emergency-silent-in-pre-operational",
    breaks: "CiA 301: NMT states and communication objects, EMCY in Pre-operational",
    words: "sends its EMCY in Operational alone",
    caught_by: "nmt",
    apply: |behaviour| {
        behaviour.canopen.nmt.exchanged = Some((State::PreOperational, Service::Emergency));
    },
};

pub(crate) const TIME_TAKEN_IN_STOPPED: Fault = Fault {
    name: "time-taken-in-stopped",
    breaks: "CiA 301: NMT states and communication objects, no TIME in Stopped",
    words: "takes a TIME in Stopped",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.nmt.exchanged = Some((State::Stopped, Service::Time)),
};

pub(crate) const ERROR_CONTROL_SILENT_IN_STOPPED: Fault = Fault {
    name: "error-control-silent-in-stopped",
    breaks: "CiA 301: NMT states and communication objects, error control in Stopped",
    words: "sends no heartbeat and answers no guarding in Stopped",
    caught_by: "error-control",
    apply: |behaviour| {
        behaviour.canopen.nmt.exchanged = Some((State::Stopped, Service::ErrorControl));
    },
};

pub(crate) const ERROR_CONTROL_SILENT_IN_PRE_OPERATIONAL: Fault = Fault {
    name: "error-control-silent-in-pre-operational",
    breaks: "CiA 301: NMT states and communication objects, error control in Pre-operational",
    words: "sends heartbeats and answers guarding in Operational and Stopped alone",
    caught_by: "error-control",
    apply: |behaviour| {
        behaviour.canopen.nmt.exchanged = Some((State::PreOperational, Service::ErrorControl));
    },
};

pub(crate) const NO_BOOT_UP_AT_NODE_1: Fault = Fault {
    name: "no-boot-up-at-node-1",
    breaks: "CiA 301: boot-up protocol, of every node-ID from 1 to 127",
    words: "sends no boot-up message when its node-ID is 1",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.nmt.no_boot_up_at = Some(1),
};

/// Those that every CANopen slave here can have.
pub(crate) const COMMON: &[Fault] = &[
    NMT_COMMAND_OF_ONE_BYTE_OBEYED,
    START_IGNORED_IN_STOPPED,
    BOOT_UP_TWICE,
    BOOT_UP_ONLY_AFTER_RESET_NODE,
    ERROR_CONTROL_SILENT_IN_STOPPED,
];

/// Those of a slave that has everything.
pub(crate) const REST: &[Fault] = &[
    NO_BOOT_UP_AT_NODE_1,
    STOP_IGNORED_IN_PRE_OPERATIONAL,
    PRE_OPERATIONAL_IGNORED_IN_STOPPED,
    RESET_NODE_IGNORED_IN_STOPPED,
    RESET_COMMUNICATION_IGNORED_IN_OPERATIONAL,
    NMT_COMMAND_OF_THREE_BYTES_RESETS,
    NMT_EXTENDED_IDENTIFIER_OBEYED,
    BOOT_UP_REPEATED,
    STARTS_BY_ITSELF,
    APPLICATION_KEPT_BY_RESET_NODE,
    COMMUNICATION_KEPT_BY_RESET_NODE,
    COMMUNICATION_KEPT_BY_RESET_COMMUNICATION,
    APPLICATION_LOST_BY_RESET_COMMUNICATION,
    BOOT_UP_SHOWS_STATE,
    BOOT_UP_AFTER_HEARTBEAT,
    SDO_SILENT_IN_OPERATIONAL,
    SDO_OBEYED_IN_STOPPED,
    SYNC_PRODUCED_IN_STOPPED,
    SYNC_SILENT_IN_PRE_OPERATIONAL,
    EMERGENCY_SENT_IN_STOPPED,
    EMERGENCY_SILENT_IN_PRE_OPERATIONAL,
    TIME_TAKEN_IN_STOPPED,
    ERROR_CONTROL_SILENT_IN_PRE_OPERATIONAL,
];
