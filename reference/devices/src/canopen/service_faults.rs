//! The faults of services that only some CANopen slaves have, each one departure from one clause.

use crate::Fault;

pub(crate) const RESERVED_TYPE_TAKEN: Fault = Fault {
    name: "reserved-type-taken",
    breaks: "CiA 301: PDO transmission types 241 to 251 are reserved",
    words: "takes a reserved transmission type",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.reserved_types_taken = true,
};

pub(crate) const REMOTE_SAMPLE_FRESH: Fault = Fault {
    name: "remote-sample-fresh",
    breaks: "CiA 301: PDO transmission type 252",
    words: "answers a remote frame with the value of now, not with that of the last SYNC",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.remote_sample_kept = false,
};

pub(crate) const INHIBIT_TIME_IGNORED: Fault = Fault {
    name: "inhibit-time-ignored",
    breaks: "CiA 301: PDO communication parameter, inhibit time",
    words: "sends an event-driven TPDO at every event, however soon",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.inhibit_time_kept = false,
};

pub(crate) const DUMMY_TAKES_NO_ROOM: Fault = Fault {
    name: "dummy-takes-no-room",
    breaks: "CiA 301: dummy mapping",
    words: "looks for the object behind a dummy where the dummy is",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.dummies_take_room = false,
};

pub(crate) const RPDO_BEFORE_SYNC: Fault = Fault {
    name: "rpdo-before-sync",
    breaks: "CiA 301: synchronous RPDO, actuated with the next SYNC",
    words: "takes the values of a synchronous RPDO when it arrives",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.rpdo_waits_for_sync = false,
};

pub(crate) const SYNC_START_VALUE_IGNORED: Fault = Fault {
    name: "sync-start-value-ignored",
    breaks: "CiA 301: PDO communication parameter, SYNC start value",
    words: "sends a TPDO before the SYNC with its start value",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.sync_start_value_kept = false,
};

pub(crate) const SYNC_COUNTER_MISSING: Fault = Fault {
    name: "sync-counter-missing",
    breaks: "CiA 301: object 1019h",
    words: "produces SYNC without the counter that 1019h asks for",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.sync_counter_sent = false,
};

pub(crate) const EMERGENCY_INHIBIT_IGNORED: Fault = Fault {
    name: "emergency-inhibit-ignored",
    breaks: "CiA 301: object 1015h",
    words: "sends an EMCY right behind another, whatever 1015h holds",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.emergency_inhibit_kept = false,
};

pub(crate) const ERROR_NOT_REMEMBERED: Fault = Fault {
    name: "error-not-remembered",
    breaks: "CiA 301: object 1003h",
    words: "does not enter errors in 1003h",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.errors_remembered = false,
};

pub(crate) const ERRORS_NOT_CLEARED: Fault = Fault {
    name: "errors-not-cleared",
    breaks: "CiA 301: object 1003h, 0 at sub-index 0 clears it",
    words: "keeps 1003h when 0 is written to it",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.errors_can_be_cleared = false,
};

pub(crate) const ERROR_END_NOT_REPORTED: Fault = Fault {
    name: "error-end-not-reported",
    breaks: "CiA 301: emergency protocol, error code 0000h",
    words: "does not say that an error has gone",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.error_end_reported = false,
};

pub(crate) const LOST_HEARTBEAT_UNNOTICED: Fault = Fault {
    name: "lost-heartbeat-unnoticed",
    breaks: "CiA 301: object 1016h",
    words: "does not notice that a heartbeat it consumes is missing",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.lost_heartbeat_noticed = false,
};

pub(crate) const LOST_MASTER_UNNOTICED: Fault = Fault {
    name: "lost-master-unnoticed",
    breaks: "CiA 301: life guarding protocol",
    words: "does not notice that it is guarded no more",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.lost_master_noticed = false,
};

pub(crate) const ERROR_BEHAVIOUR_IGNORED: Fault = Fault {
    name: "error-behaviour-ignored",
    breaks: "CiA 301: object 1029h",
    words: "stays operational when it has lost a heartbeat, whatever 1029h holds",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_behaviour_kept = false,
};

pub(crate) const TIME_IGNORED: Fault = Fault {
    name: "time-ignored",
    breaks: "CiA 301: object 1012h, bit 31",
    words: "takes no TIME",
    caught_by: "time",
    apply: |behaviour| behaviour.canopen.time_taken = false,
};

pub(crate) const STORE_FORGETS: Fault = Fault {
    name: "store-forgets",
    breaks: "CiA 301: object 1010h",
    words: "confirms that it has stored its parameters, and has not",
    caught_by: "store",
    apply: |behaviour| behaviour.canopen.stores = false,
};

pub(crate) const STORE_WITHOUT_SIGNATURE: Fault = Fault {
    name: "store-without-signature",
    breaks: "CiA 301: object 1010h, the signature `save`",
    words: "stores its parameters whatever is written to 1010h",
    caught_by: "store",
    apply: |behaviour| behaviour.canopen.stores_without_signature = true,
};

pub(crate) const RESTORE_DOES_NOTHING: Fault = Fault {
    name: "restore-does-nothing",
    breaks: "CiA 301: object 1011h",
    words: "confirms that it restores its defaults, and does not",
    caught_by: "store",
    apply: |behaviour| behaviour.canopen.restores = false,
};

pub(crate) const LSS_ACTIVATION_IGNORED: Fault = Fault {
    name: "lss-activation-ignored",
    breaks: "CiA 305: activate bit timing parameters protocol",
    words: "keeps its bit rate when the new one is activated",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss_activates = false,
};

pub(crate) const LSS_IDENTIFIES_ANY: Fault = Fault {
    name: "lss-identifies-any-serial",
    breaks: "CiA 305: identify remote slave protocol, serial numbers",
    words: "identifies itself though its serial number is not between those that are named",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss_identify_compares = false,
};

pub(crate) const LSS_FASTSCAN_WITH_NODE: Fault = Fault {
    name: "lss-fastscan-with-node",
    breaks: "CiA 305: fastscan protocol, only for slaves without node-ID",
    words: "takes part in a fastscan though it has a node-ID",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss_fastscan_unconfigured_only = false,
};

/// All of them.
pub(crate) const ALL: &[Fault] = &[
    RESERVED_TYPE_TAKEN,
    REMOTE_SAMPLE_FRESH,
    INHIBIT_TIME_IGNORED,
    DUMMY_TAKES_NO_ROOM,
    RPDO_BEFORE_SYNC,
    SYNC_START_VALUE_IGNORED,
    SYNC_COUNTER_MISSING,
    EMERGENCY_INHIBIT_IGNORED,
    ERROR_NOT_REMEMBERED,
    ERRORS_NOT_CLEARED,
    ERROR_END_NOT_REPORTED,
    LOST_HEARTBEAT_UNNOTICED,
    LOST_MASTER_UNNOTICED,
    ERROR_BEHAVIOUR_IGNORED,
    TIME_IGNORED,
    STORE_FORGETS,
    STORE_WITHOUT_SIGNATURE,
    RESTORE_DOES_NOTHING,
    LSS_ACTIVATION_IGNORED,
    LSS_IDENTIFIES_ANY,
    LSS_FASTSCAN_WITH_NODE,
];
