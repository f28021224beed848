//! Faults of SYNC, EMCY, TIME, storing and COB-IDs, each one departure from one clause.

use crate::Fault;

pub(crate) const SYNC_COB_ID_LOST: Fault = Fault {
    name: "sync-cob-id-lost",
    breaks: "CiA 301: object 1005h, default 80h",
    words: "begins with 0 in 1005h, and hears no SYNC",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.sync_identifier_lost = true,
};

pub(crate) const SYNC_PERIOD_IN_10_US: Fault = Fault {
    name: "sync-period-in-10-us",
    breaks: "CiA 301: object 1006h counts microseconds",
    words: "counts 1006h in 10 us",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.sync_period_in_10_us = true,
};

pub(crate) const SYNC_OUTLIVES_PERIOD: Fault = Fault {
    name: "sync-outlives-period",
    breaks: "CiA 301: object 1006h, 0 disables the production of SYNC",
    words: "goes on producing SYNC when 1006h becomes 0",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.sync_outlives_period = true,
};

pub(crate) const SYNC_STARTS_LATE: Fault = Fault {
    name: "sync-starts-late",
    breaks: "CiA 301: object 1005h, the first SYNC within one period",
    words: "waits for five periods before its first SYNC",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.sync_starts_late = true,
};

pub(crate) const SYNC_IDENTIFIER_UNPROTECTED: Fault = Fault {
    name: "sync-identifier-unprotected",
    breaks: "CiA 301: object 1005h, the identifier of a SYNC that is produced",
    words: "lets the identifier of SYNC be changed while it produces SYNC",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.sync_identifier_unprotected = true,
};

pub(crate) const SYNC_IDENTIFIER_FIXED: Fault = Fault {
    name: "sync-identifier-fixed",
    breaks: "CiA 301: object 1005h, bits 0 to 10",
    words: "produces and takes SYNC under 080h, whatever 1005h holds",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.sync_identifier_fixed = true,
};

pub(crate) const SYNC_IN_STOPPED: Fault = Fault {
    name: "sync-in-stopped",
    breaks: "CiA 301: NMT states and communication objects",
    words: "goes on producing SYNC when it is stopped",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.sync_in_stopped = true,
};

pub(crate) const SYNC_IN_OPERATIONAL_ONLY: Fault = Fault {
    name: "sync-in-operational-only",
    breaks: "CiA 301: NMT states and communication objects",
    words: "produces no SYNC in Pre-operational",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.sync_in_operational_only = true,
};

pub(crate) const SYNC_RESTS_AFTER_RESET: Fault = Fault {
    name: "sync-rests-after-reset",
    breaks: "CiA 301: object 1010h, what is saved is in force after a reset",
    words: "has its saved 1005h again after a reset, and produces no SYNC until it is written again",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.sync_rests_after_reset = true,
};

pub(crate) const SYNC_BY_REMOTE_FRAME: Fault = Fault {
    name: "sync-by-remote-frame",
    breaks: "CiA 301: SYNC protocol, a data frame",
    words: "takes a remote frame for SYNC",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.sync_by_remote_frame = true,
};

pub(crate) const SYNC_LENGTH_UNCHECKED: Fault = Fault {
    name: "sync-length-unchecked",
    breaks: "CiA 301: object 1019h, the length of SYNC",
    words: "uses a SYNC of the wrong length",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.sync_length_unchecked = true,
};

pub(crate) const SYNC_WINDOW_IN_NS: Fault = Fault {
    name: "sync-window-in-ns",
    breaks: "CiA 301: object 1007h counts microseconds",
    words: "counts 1007h in nanoseconds, and has no time for its synchronous PDOs",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.sync_window_in_ns = true,
};

pub(crate) const SYNC_COUNTER_OF_1_TAKEN: Fault = Fault {
    name: "sync-counter-of-1-taken",
    breaks: "CiA 301: object 1019h, the value 1 is reserved",
    words: "takes 1 for the highest value of the SYNC counter",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.counter_of_1_taken = true,
};

pub(crate) const SYNC_COUNTER_ABOVE_127_REFUSED: Fault = Fault {
    name: "sync-counter-above-127-refused",
    breaks: "CiA 301: object 1019h, values up to 240",
    words: "refuses a SYNC counter up to 240",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.counter_above_127_refused = true,
};

pub(crate) const SYNC_COUNTER_UNPROTECTED: Fault = Fault {
    name: "sync-counter-unprotected",
    breaks: "CiA 301: object 1019h, no change while 1006h is not 0",
    words: "changes the SYNC counter while 1006h holds a period",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.counter_unprotected = true,
};

pub(crate) const SYNC_COUNTER_FROM_0: Fault = Fault {
    name: "sync-counter-from-0",
    breaks: "CiA 301: object 1019h, the counter begins with 1",
    words: "counts SYNC from 0",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.counter_from_0 = true,
};

pub(crate) const SYNC_COUNTER_OUTLIVES_STOPPED: Fault = Fault {
    name: "sync-counter-outlives-stopped",
    breaks: "CiA 301: SYNC protocol, the counter after Stopped",
    words: "goes on with its SYNC counter where it was before Stopped",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.counter_outlives_stopped = true,
};

pub(crate) const EXTENDED_FRAMES_CUT: Fault = Fault {
    name: "extended-frames-cut",
    breaks: "CiA 301: CAN-IDs of 11 bits; ISO 11898-1: frames of 29 bits are others",
    words: "takes a frame of 29 bits for one with its lowest 11",
    caught_by: "sync",
    apply: |behaviour| behaviour.canopen.departs.extended_frames_cut = true,
};

pub(crate) const EMERGENCY_WITHOUT_NODE: Fault = Fault {
    name: "emergency-without-node",
    breaks: "CiA 301: object 1014h, default 80h and the node-ID",
    words: "begins with 80h in 1014h",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.departs.emergency_identifier_without_node = true,
};

pub(crate) const SHORT_PDO_UNREPORTED: Fault = Fault {
    name: "short-pdo-unreported",
    breaks: "CiA 301: emergency error code 8210h",
    words: "passes over an RPDO that is too short without an EMCY",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.departs.short_pdo_unreported = true,
};

pub(crate) const CLEARED_ERRORS_STAY: Fault = Fault {
    name: "cleared-errors-stay",
    breaks: "CiA 301: object 1003h, 0 deletes the whole history",
    words: "sets the count of 1003h to 0 and keeps the errors",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.departs.cleared_errors_stay = true,
};

pub(crate) const ERRORS_APPENDED: Fault = Fault {
    name: "errors-appended",
    breaks: "CiA 301: object 1003h, the newest error at sub-index 1",
    words: "enters new errors behind the older ones in 1003h",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.departs.errors_appended = true,
};

pub(crate) const HISTORY_COUNT_TAKEN: Fault = Fault {
    name: "history-count-taken",
    breaks: "CiA 301: object 1003h, only 0 may be written to sub-index 0",
    words: "takes any number at 1003h:00",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.departs.history_count_taken = true,
};

pub(crate) const EMERGENCY_REPEATED: Fault = Fault {
    name: "emergency-repeated",
    breaks: "CiA 301: one EMCY for an error event",
    words: "sends each EMCY again after 100 ms",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.departs.emergency_repeated = true,
};

pub(crate) const EMERGENCY_CUT: Fault = Fault {
    name: "emergency-cut",
    breaks: "CiA 301: emergency protocol, 8 bytes",
    words: "sends an EMCY of three bytes",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.departs.emergency_cut = true,
};

pub(crate) const EMERGENCY_WHILE_INVALID: Fault = Fault {
    name: "emergency-while-invalid",
    breaks: "CiA 301: object 1014h, bit 31",
    words: "sends EMCY though bit 31 of 1014h is set",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.departs.emergency_while_invalid = true,
};

pub(crate) const EMERGENCY_IDENTIFIER_FIXED: Fault = Fault {
    name: "emergency-identifier-fixed",
    breaks: "CiA 301: object 1014h, bits 0 to 10",
    words: "sends EMCY under 080h and its node-ID, whatever 1014h holds",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.departs.emergency_identifier_fixed = true,
};

pub(crate) const EMERGENCY_IDENTIFIER_UNPROTECTED: Fault = Fault {
    name: "emergency-identifier-unprotected",
    breaks: "CiA 301: object 1014h, no change while it is valid",
    words: "lets the identifier of EMCY be changed while it is valid",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.departs.emergency_identifier_unprotected = true,
};

pub(crate) const EMERGENCY_IN_STOPPED: Fault = Fault {
    name: "emergency-in-stopped",
    breaks: "CiA 301: NMT states and communication objects",
    words: "sends EMCY when it is stopped",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.departs.emergency_in_stopped = true,
};

pub(crate) const EMERGENCY_IN_OPERATIONAL_ONLY: Fault = Fault {
    name: "emergency-in-operational-only",
    breaks: "CiA 301: NMT states and communication objects",
    words: "sends no EMCY in Pre-operational",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.departs.emergency_in_operational_only = true,
};

pub(crate) const ERROR_REGISTER_STUCK: Fault = Fault {
    name: "error-register-stuck",
    breaks: "CiA 301: object 1001h",
    words: "keeps the bits of 1001h when the error is over",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.departs.error_register_stuck = true,
};

pub(crate) const ERROR_REGISTER_BLIND: Fault = Fault {
    name: "error-register-blind",
    breaks: "CiA 301: object 1001h, the generic error bit",
    words: "shows 0 in 1001h while there is an error",
    caught_by: "emergency",
    apply: |behaviour| behaviour.canopen.departs.error_register_blind = true,
};

pub(crate) const TIME_COB_ID_LOST: Fault = Fault {
    name: "time-cob-id-lost",
    breaks: "CiA 301: object 1012h, default 100h",
    words: "begins with 0 in 1012h",
    caught_by: "time",
    apply: |behaviour| behaviour.canopen.departs.time_identifier_lost = true,
};

pub(crate) const TIME_OF_EIGHT_BYTES: Fault = Fault {
    name: "time-of-eight-bytes",
    breaks: "CiA 301: TIME protocol, 6 bytes",
    words: "produces TIME with eight bytes",
    caught_by: "time",
    apply: |behaviour| behaviour.canopen.departs.time_of_eight_bytes = true,
};

pub(crate) const TIME_NOT_STOPPED: Fault = Fault {
    name: "time-not-stopped",
    breaks: "CiA 301: object 1012h, bit 30",
    words: "goes on producing TIME when bit 30 of 1012h is cleared",
    caught_by: "time",
    apply: |behaviour| behaviour.canopen.departs.time_not_stopped = true,
};

pub(crate) const TIME_IN_STOPPED: Fault = Fault {
    name: "time-in-stopped",
    breaks: "CiA 301: NMT states and communication objects",
    words: "goes on producing TIME when it is stopped",
    caught_by: "time",
    apply: |behaviour| behaviour.canopen.departs.time_in_stopped = true,
};

pub(crate) const TIME_IDENTIFIER_FIXED: Fault = Fault {
    name: "time-identifier-fixed",
    breaks: "CiA 301: object 1012h, bits 0 to 10",
    words: "produces and takes TIME under 100h, whatever 1012h holds",
    caught_by: "time",
    apply: |behaviour| behaviour.canopen.departs.time_identifier_fixed = true,
};

pub(crate) const TIME_IDENTIFIER_UNPROTECTED: Fault = Fault {
    name: "time-identifier-unprotected",
    breaks: "CiA 301: object 1012h, no change while it is in use",
    words: "lets the identifier of TIME be changed while it is in use",
    caught_by: "time",
    apply: |behaviour| behaviour.canopen.departs.time_identifier_unprotected = true,
};

pub(crate) const TIME_LENGTH_UNCHECKED: Fault = Fault {
    name: "time-length-unchecked",
    breaks: "CiA 301: TIME protocol, 6 bytes",
    words: "fills up a TIME that is too short",
    caught_by: "time",
    apply: |behaviour| behaviour.canopen.departs.time_length_unchecked = true,
};

pub(crate) const TIME_STANDS_STILL: Fault = Fault {
    name: "time-stands-still",
    breaks: "CiA 301: TIME_OF_DAY",
    words: "produces the time it was set to, again and again",
    caught_by: "time",
    apply: |behaviour| behaviour.canopen.departs.time_stands_still = true,
};

pub(crate) const TIME_ALWAYS_TAKEN: Fault = Fault {
    name: "time-always-taken",
    breaks: "CiA 301: object 1012h, bit 31",
    words: "takes TIME though bit 31 of 1012h is 0",
    caught_by: "time",
    apply: |behaviour| behaviour.canopen.departs.time_always_taken = true,
};

pub(crate) const RESTORE_WITHOUT_SIGNATURE: Fault = Fault {
    name: "restore-without-signature",
    breaks: "CiA 301: object 1011h, the signature `load`",
    words: "restores its defaults whatever is written to 1011h",
    caught_by: "store",
    apply: |behaviour| behaviour.canopen.departs.restores_without_signature = true,
};

pub(crate) const SIGNATURES_REVERSED: Fault = Fault {
    name: "signatures-reversed",
    breaks: "CiA 301: objects 1010h and 1011h, least significant byte first",
    words: "takes the signatures with their bytes in the other order",
    caught_by: "store",
    apply: |behaviour| behaviour.canopen.departs.signatures_reversed = true,
};

pub(crate) const RESTORE_AT_ONCE: Fault = Fault {
    name: "restore-at-once",
    breaks: "CiA 301: object 1011h, in force after a reset",
    words: "has its defaults as soon as `load` is written",
    caught_by: "store",
    apply: |behaviour| behaviour.canopen.departs.restores_at_once = true,
};

pub(crate) const STORE_GROUPS_IGNORED: Fault = Fault {
    name: "store-groups-ignored",
    breaks: "CiA 301: object 1010h, sub-indexes 2 to 4",
    words: "saves all parameters by every sub-index of 1010h",
    caught_by: "store",
    apply: |behaviour| behaviour.canopen.departs.store_groups_ignored = true,
};

pub(crate) const RESTORE_GROUPS_IGNORED: Fault = Fault {
    name: "restore-groups-ignored",
    breaks: "CiA 301: object 1011h, sub-indexes 2 to 4",
    words: "restores all parameters by every sub-index of 1011h",
    caught_by: "store",
    apply: |behaviour| behaviour.canopen.departs.restore_groups_ignored = true,
};

pub(crate) const STORE_SHOWS_SIGNATURE: Fault = Fault {
    name: "store-shows-signature",
    breaks: "CiA 301: object 1010h, what it reads as",
    words: "shows in 1010h the signature that was written last",
    caught_by: "store",
    apply: |behaviour| behaviour.canopen.departs.store_shows_signature = true,
};

pub(crate) const STORES_IN_RAM: Fault = Fault {
    name: "stores-in-ram",
    breaks: "CiA 301: object 1010h, non-volatile memory",
    words: "has lost what it saved when power returns",
    caught_by: "store",
    apply: |behaviour| behaviour.canopen.departs.stores_in_ram = true,
};

pub(crate) const PDO_PARAMETERS_UNSAVED: Fault = Fault {
    name: "pdo-parameters-unsaved",
    breaks: "CiA 301: object 1010h, sub-indexes 1 and 2",
    words: "saves the communication parameters without those of its PDOs",
    caught_by: "store",
    apply: |behaviour| behaviour.canopen.departs.pdo_parameters_unsaved = true,
};

pub(crate) const CONFIGURATION_DATE_UNSAVED: Fault = Fault {
    name: "configuration-date-unsaved",
    breaks: "CiA 301: object 1020h",
    words: "loses 1020h though it was saved",
    caught_by: "store",
    apply: |behaviour| behaviour.canopen.departs.configuration_date_unsaved = true,
};

pub(crate) const PARAMETERS_OUTLIVE_RESET: Fault = Fault {
    name: "parameters-outlive-reset",
    breaks: "CiA 301: NMT reset, power-on values",
    words: "keeps what was written and not saved over an NMT reset",
    caught_by: "store",
    apply: |behaviour| behaviour.canopen.departs.parameters_outlive_reset = true,
};

pub(crate) const RESTRICTED_IDENTIFIERS_TAKEN: Fault = Fault {
    name: "restricted-identifiers-taken",
    breaks: "CiA 301: restricted CAN-IDs",
    words: "gives SYNC, EMCY, TIME and PDOs any identifier",
    caught_by: "cob-id",
    apply: |behaviour| behaviour.canopen.departs.restricted_identifiers_taken = true,
};

pub(crate) const HIGH_IDENTIFIERS_TAKEN: Fault = Fault {
    name: "high-identifiers-taken",
    breaks: "CiA 301: restricted CAN-IDs",
    words: "gives SYNC, EMCY, TIME and PDOs the identifiers of SDO, LSS and error control",
    caught_by: "cob-id",
    apply: |behaviour| behaviour.canopen.departs.high_identifiers_taken = true,
};

/// All of them.
pub(crate) const ALL: &[Fault] = &[
    SYNC_COB_ID_LOST,
    SYNC_PERIOD_IN_10_US,
    SYNC_OUTLIVES_PERIOD,
    SYNC_STARTS_LATE,
    SYNC_IDENTIFIER_UNPROTECTED,
    SYNC_IDENTIFIER_FIXED,
    SYNC_IN_STOPPED,
    SYNC_IN_OPERATIONAL_ONLY,
    SYNC_RESTS_AFTER_RESET,
    SYNC_BY_REMOTE_FRAME,
    SYNC_LENGTH_UNCHECKED,
    SYNC_WINDOW_IN_NS,
    SYNC_COUNTER_OF_1_TAKEN,
    SYNC_COUNTER_ABOVE_127_REFUSED,
    SYNC_COUNTER_UNPROTECTED,
    SYNC_COUNTER_FROM_0,
    SYNC_COUNTER_OUTLIVES_STOPPED,
    EXTENDED_FRAMES_CUT,
    EMERGENCY_WITHOUT_NODE,
    SHORT_PDO_UNREPORTED,
    CLEARED_ERRORS_STAY,
    ERRORS_APPENDED,
    HISTORY_COUNT_TAKEN,
    EMERGENCY_REPEATED,
    EMERGENCY_CUT,
    EMERGENCY_WHILE_INVALID,
    EMERGENCY_IDENTIFIER_FIXED,
    EMERGENCY_IDENTIFIER_UNPROTECTED,
    EMERGENCY_IN_STOPPED,
    EMERGENCY_IN_OPERATIONAL_ONLY,
    ERROR_REGISTER_STUCK,
    ERROR_REGISTER_BLIND,
    TIME_COB_ID_LOST,
    TIME_OF_EIGHT_BYTES,
    TIME_NOT_STOPPED,
    TIME_IN_STOPPED,
    TIME_IDENTIFIER_FIXED,
    TIME_IDENTIFIER_UNPROTECTED,
    TIME_LENGTH_UNCHECKED,
    TIME_STANDS_STILL,
    TIME_ALWAYS_TAKEN,
    RESTORE_WITHOUT_SIGNATURE,
    SIGNATURES_REVERSED,
    RESTORE_AT_ONCE,
    STORE_GROUPS_IGNORED,
    RESTORE_GROUPS_IGNORED,
    STORE_SHOWS_SIGNATURE,
    STORES_IN_RAM,
    PDO_PARAMETERS_UNSAVED,
    CONFIGURATION_DATE_UNSAVED,
    PARAMETERS_OUTLIVE_RESET,
    RESTRICTED_IDENTIFIERS_TAKEN,
    HIGH_IDENTIFIERS_TAKEN,
];
