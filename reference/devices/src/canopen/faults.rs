//! The faults that a CANopen side can be given, each one departure from one clause.

use super::{AbortMultiplexer, NmtAddress, NodeActivation, StateCodes};
use crate::Fault;

pub(crate) const ABORT_CODE_WRONG: Fault = Fault {
    name: "abort-code-wrong",
    breaks: "CiA 301: SDO abort transfer, abort code 06090011h",
    words: "says that the object does not exist (06020000h) where only the sub-index does not",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.abort_codes = &[(0x0609_0011, 0x0602_0000)],
};

pub(crate) const ABORT_NAMES_ANOTHER_OBJECT: Fault = Fault {
    name: "abort-names-another-object",
    breaks: "CiA 301: SDO abort transfer, multiplexer",
    words: "names the next index in bytes 1 and 2 of an abort",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.abort_multiplexer = AbortMultiplexer::NextIndex,
};

pub(crate) const BOOT_UP_MISSING: Fault = Fault {
    name: "boot-up-missing",
    breaks: "CiA 301: boot-up protocol",
    words: "enters Pre-operational without its boot-up message",
    caught_by: "boot-up",
    apply: |behaviour| behaviour.canopen.boot_up = false,
};

pub(crate) const HEARTBEAT_STATE_WRONG: Fault = Fault {
    name: "heartbeat-state-wrong",
    breaks: "CiA 301: heartbeat protocol, state of the producer",
    words: "gives its state in the codes of the NMT commands: 80h operational, 81h pre-operational, 02h stopped",
    caught_by: "error-control",
    apply: |behaviour| {
        behaviour.canopen.state_codes = StateCodes {
            stopped: 0x02,
            operational: 0x80,
            pre_operational: 0x81,
        };
    },
};

pub(crate) const TPDO_ONE_SYNC_LATE: Fault = Fault {
    name: "tpdo-one-sync-late",
    breaks: "CiA 301: PDO transmission type 1 to 240",
    words: "sends a synchronous TPDO one SYNC after the one it was due with",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.tpdo_one_sync_late = true,
};

pub(crate) const LSS_REVISION_ANSWERS_5B: Fault = Fault {
    name: "lss-revision-answers-5b",
    breaks: "CiA 305: inquire identity revision number protocol, command specifier",
    words: "answers the inquiry for the revision number (5Ch) with 5Bh",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss_revision_specifier = 0x5B,
};

pub(crate) const TPDO_NOT_REFRESHED: Fault = Fault {
    name: "tpdo-not-refreshed",
    breaks: "CiA 301: PDO, the data of the application objects that are mapped",
    words: "sends in every TPDO what its objects held when the node was started",
    caught_by: "cia406",
    apply: |behaviour| behaviour.canopen.tpdo_refreshed = false,
};

pub(crate) const TOGGLE_NOT_ALTERNATED: Fault = Fault {
    name: "toggle-not-alternated",
    breaks: "CiA 301: SDO upload segment, toggle bit",
    words: "leaves the toggle bit at 0 in every segment it sends",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.toggle_alternates = false,
};

pub(crate) const EXPEDITED_SIZE_WRONG: Fault = Fault {
    name: "expedited-size-wrong",
    breaks: "CiA 301: SDO upload initiate, number of bytes without data",
    words: "says that an expedited value has one byte more than it has, and that four are three",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.expedited_size_off_by_one = true,
};

pub(crate) const STALE_VALUE_AFTER_WRITE: Fault = Fault {
    name: "stale-value-after-write",
    breaks: "CiA 301: SDO download",
    words: "confirms a download, and then reads the value from before it",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.upload_lags_download = true,
};

pub(crate) const SDO_ANSWERED_IN_STOPPED: Fault = Fault {
    name: "sdo-answered-in-stopped",
    breaks: "CiA 301: NMT states and communication objects",
    words: "answers SDO requests while it is stopped",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.sdo_in_stopped = true,
};

pub(crate) const PDO_IN_PRE_OPERATIONAL: Fault = Fault {
    name: "pdo-in-pre-operational",
    breaks: "CiA 301: NMT states and communication objects",
    words: "sends and takes PDOs before it is started",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo_in_pre_operational = true,
};

pub(crate) const PDO_IN_STOPPED: Fault = Fault {
    name: "pdo-in-stopped",
    breaks: "CiA 301: NMT states and communication objects",
    words: "goes on sending and taking PDOs when it is stopped",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo_in_stopped = true,
};

pub(crate) const REMOTE_BIT_IGNORED: Fault = Fault {
    name: "remote-bit-ignored",
    breaks: "CiA 301: PDO COB-ID, bit 30",
    words: "answers a remote frame with a TPDO whose COB-ID does not allow it",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.remote_bit_ignored = true,
};

pub(crate) const NODE_ID_ACTIVE_BEFORE_RESET: Fault = Fault {
    name: "node-id-active-before-reset",
    breaks: "CiA 305: configure node-ID protocol; active after a reset",
    words: "takes a new node-ID with the answer to the request, not at the next reset",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.node_activation = NodeActivation::AtOnce,
};

pub(crate) const DOWNLOAD_ACK_MISSING: Fault = Fault {
    name: "download-ack-missing",
    breaks: "CiA 301: SDO download initiate, response",
    words: "takes a value and does not confirm it",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.download_confirmed = false,
};

pub(crate) const MAPPING_ENTRY_BYTE_ORDER: Fault = Fault {
    name: "mapping-entry-byte-order",
    breaks: "CiA 301: transfer syntax of UNSIGNED32, least significant byte first",
    words: "sends and takes the entries of a PDO mapping with the most significant byte first",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.mapping_entry_big_endian = true,
};

pub(crate) const GUARDING_TOGGLE_STUCK: Fault = Fault {
    name: "guarding-toggle-stuck",
    breaks: "CiA 301: node guarding protocol, toggle bit",
    words: "answers every guarding request with the toggle bit 0",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.guarding_toggles = false,
};

pub(crate) const SYNC_NOT_STOPPED: Fault = Fault {
    name: "sync-not-stopped",
    breaks: "CiA 301: object 1005h, bit 30",
    words: "goes on producing SYNC when bit 30 of 1005h is cleared",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.sync_can_be_stopped = false,
};

pub(crate) const EMERGENCY_WITHOUT_REGISTER: Fault = Fault {
    name: "emergency-without-register",
    breaks: "CiA 301: emergency protocol, error register",
    words: "leaves the third byte of an EMCY 0",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.emergency_shows_register = false,
};

pub(crate) const HEARTBEAT_NOT_STOPPED: Fault = Fault {
    name: "heartbeat-not-stopped",
    breaks: "CiA 301: object 1017h, 0 disables the heartbeat",
    words: "goes on sending its heartbeat when 0 is written to 1017h",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.heartbeat_can_be_stopped = false,
};

pub(crate) const NMT_TO_ALL_IGNORED: Fault = Fault {
    name: "nmt-to-all-ignored",
    breaks: "CiA 301: NMT commands, node-ID 0 addresses all nodes",
    words: "ignores an NMT command to node-ID 0",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.nmt_address = NmtAddress::OwnOnly,
};

pub(crate) const NMT_TO_ANOTHER_OBEYED: Fault = Fault {
    name: "nmt-to-another-obeyed",
    breaks: "CiA 301: NMT commands, node-ID",
    words: "obeys NMT commands to other nodes",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.nmt_address = NmtAddress::Any,
};

pub(crate) const UNKNOWN_NMT_COMMAND_STOPS: Fault = Fault {
    name: "unknown-nmt-command-stops",
    breaks: "CiA 301: NMT commands, command specifier",
    words: "takes a command specifier that does not exist for stop",
    caught_by: "nmt",
    apply: |behaviour| behaviour.canopen.unknown_nmt_command_stops = true,
};

pub(crate) const UNKNOWN_COMMAND_IGNORED: Fault = Fault {
    name: "unknown-command-ignored",
    breaks: "CiA 301: SDO abort transfer, abort code 05040001h",
    words: "does not answer an SDO request with an unknown command specifier",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.unknown_command_refused = false,
};

pub(crate) const UPLOAD_BYTE_ORDER: Fault = Fault {
    name: "upload-byte-order",
    breaks: "CiA 301: transfer syntax of numbers, least significant byte first",
    words: "sends numbers in an SDO with the most significant byte first",
    caught_by: "sdo",
    apply: |behaviour| behaviour.canopen.upload_big_endian = true,
};

pub(crate) const SYNC_COUNTED_WRONG: Fault = Fault {
    name: "sync-counted-wrong",
    breaks: "CiA 301: PDO transmission type 1 to 240",
    words: "waits for one SYNC more than the transmission type says",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.surplus_syncs = 1,
};

pub(crate) const INVALID_TPDO_SENT: Fault = Fault {
    name: "invalid-tpdo-sent",
    breaks: "CiA 301: PDO COB-ID, bit 31",
    words: "sends a TPDO though bit 31 of its COB-ID is set",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.invalid_tpdo_sent = true,
};

pub(crate) const TPDO_BYTE_ORDER: Fault = Fault {
    name: "tpdo-byte-order",
    breaks: "CiA 301: transfer syntax of numbers, least significant byte first",
    words: "sends numbers in a TPDO with the most significant byte first",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.tpdo_big_endian = true,
};

pub(crate) const EVENT_TIMER_UNIT: Fault = Fault {
    name: "event-timer-unit",
    breaks: "CiA 301: PDO communication parameter, the event timer counts milliseconds",
    words: "counts its event timers in 10 ms",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.event_timer_unit_ms = 10,
};

pub(crate) const LSS_STORE_FORGETS: Fault = Fault {
    name: "lss-store-forgets",
    breaks: "CiA 305: store configuration protocol",
    words: "says that it has stored node-ID and bit rate, and has not",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss_stores = false,
};

pub(crate) const LSS_SELECTION_NOT_CONFIRMED: Fault = Fault {
    name: "lss-selection-not-confirmed",
    breaks: "CiA 305: switch state selective protocol, response 44h",
    words: "is selected by its LSS address and does not say so",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss_selection_confirmed = false,
};

pub(crate) const LSS_CONFIGURATION_UNCHECKED: Fault = Fault {
    name: "lss-configuration-unchecked",
    breaks: "CiA 305: configure node-ID and bit timing protocols, error code",
    words: "says that all is well with a node-ID or a bit timing that there is not",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss_configuration_checked = false,
};

pub(crate) const LSS_BIT_TIMING_MISSING: Fault = Fault {
    name: "lss-bit-timing-missing",
    breaks: "CiA 305: configure bit timing protocol, table 0",
    words: "refuses index 1, 800 kbit/s",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss_refused_index = Some(1),
};

pub(crate) const LSS_IDENTITY_BYTE_ORDER: Fault = Fault {
    name: "lss-identity-byte-order",
    breaks: "CiA 305: inquire identity protocols, least significant byte first",
    words: "answers the inquiries for its identity with the most significant byte first",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss_identity_big_endian = true,
};

pub(crate) const LSS_SERIAL_IGNORED: Fault = Fault {
    name: "lss-serial-ignored",
    breaks: "CiA 305: switch state selective protocol, serial number",
    words: "is selected by any serial number",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss_serial_matters = false,
};

/// What every CANopen slave here can have.
pub(crate) const COMMON: &[Fault] = &[
    ABORT_CODE_WRONG,
    ABORT_NAMES_ANOTHER_OBJECT,
    BOOT_UP_MISSING,
    HEARTBEAT_STATE_WRONG,
    TPDO_ONE_SYNC_LATE,
    EXPEDITED_SIZE_WRONG,
    STALE_VALUE_AFTER_WRITE,
    PDO_IN_PRE_OPERATIONAL,
    PDO_IN_STOPPED,
    REMOTE_BIT_IGNORED,
    DOWNLOAD_ACK_MISSING,
    HEARTBEAT_NOT_STOPPED,
    NMT_TO_ALL_IGNORED,
    NMT_TO_ANOTHER_OBEYED,
    UNKNOWN_NMT_COMMAND_STOPS,
    UNKNOWN_COMMAND_IGNORED,
    UPLOAD_BYTE_ORDER,
    SYNC_COUNTED_WRONG,
    INVALID_TPDO_SENT,
    TPDO_BYTE_ORDER,
];
