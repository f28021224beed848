//! The faults that the PDOs of a CANopen slave can have, each one departure from one clause.

use crate::Fault;

pub(crate) const IDENTIFIER_CHANGED_WHILE_VALID: Fault = Fault {
    name: "pdo-identifier-changed-while-valid",
    breaks: "CiA 301: PDO COB-ID, bits 0 to 29 stay while the PDO exists",
    words: "gives a PDO that exists another identifier",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.identifier_locked = false,
};

pub(crate) const INHIBIT_TIME_CHANGED_WHILE_VALID: Fault = Fault {
    name: "inhibit-time-changed-while-valid",
    breaks: "CiA 301: PDO communication parameter, inhibit time",
    words: "takes a new inhibit time for a TPDO that exists",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.inhibit_time_locked = false,
};

pub(crate) const START_VALUE_CHANGED_WHILE_VALID: Fault = Fault {
    name: "start-value-changed-while-valid",
    breaks: "CiA 301: PDO communication parameter, SYNC start value",
    words: "takes a new SYNC start value for a TPDO that exists",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.start_value_locked = false,
};

pub(crate) const EXTENDED_IDENTIFIER_CONFIRMED: Fault = Fault {
    name: "extended-identifier-confirmed",
    breaks: "CiA 301: PDO COB-ID, bit 29",
    words: "confirms a COB-ID of 29 bits, and keeps the one it had",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.extended_identifier_refused = false,
};

pub(crate) const PDO_IDENTIFIER_NOT_USED: Fault = Fault {
    name: "pdo-identifier-not-used",
    breaks: "CiA 301: PDO COB-ID, bits 0 to 10",
    words: "stores a new identifier for a PDO, and goes on with the predefined one",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.identifier_used = false,
};

pub(crate) const TRANSMISSION_TYPE_NOT_STORED: Fault = Fault {
    name: "transmission-type-not-stored",
    breaks: "CiA 301: PDO communication parameter, transmission type",
    words: "confirms a transmission type, and keeps the one it had",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.type_stored = false,
};

pub(crate) const EXTENDED_FRAME_TAKEN: Fault = Fault {
    name: "extended-frame-taken",
    breaks: "CiA 301: PDO COB-ID, bit 29 not set: an identifier of 11 bits",
    words: "takes a frame of 29 bits for the RPDO with the same low 11",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.extended_frames_passed_over = false,
};

pub(crate) const MAPPING_CHANGED_WHILE_VALID: Fault = Fault {
    name: "mapping-changed-while-valid",
    breaks: "CiA 301: PDO mapping parameter, procedure",
    words: "takes a new mapping for a PDO that exists",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.mapping_locked = false,
};

pub(crate) const ENTRY_CHANGED_WHILE_COUNTED: Fault = Fault {
    name: "mapping-entry-changed-while-counted",
    breaks: "CiA 301: PDO mapping parameter, procedure",
    words: "takes a mapping entry while sub-index 0 is not 0",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.entries_locked = false,
};

pub(crate) const MAPPING_COUNT_UNCHECKED: Fault = Fault {
    name: "mapping-count-unchecked",
    breaks: "CiA 301: PDO mapping parameter, sub-index 0",
    words: "takes any number of mapped objects",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.count_checked = false,
};

pub(crate) const MAPPING_LENGTH_UNCHECKED: Fault = Fault {
    name: "mapping-length-unchecked",
    breaks: "CiA 301: PDO mapping parameter, at most 64 bits",
    words: "takes a mapping of more than 64 bits",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.length_checked = false,
};

pub(crate) const UNMAPPABLE_MAPPED: Fault = Fault {
    name: "unmappable-mapped",
    breaks: "CiA 301: SDO abort code 06040041h",
    words: "maps an object that its EDS does not let into a PDO",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.mappable_checked = false,
};

pub(crate) const MAPPING_DIRECTION_IGNORED: Fault = Fault {
    name: "mapping-direction-ignored",
    breaks: "CiA 301: SDO abort code 06040041h",
    words: "maps a read-only object in an RPDO, and a write-only one in a TPDO",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.direction_checked = false,
};

pub(crate) const ABSENT_OBJECT_MAPPED: Fault = Fault {
    name: "absent-object-mapped",
    breaks: "CiA 301: SDO abort codes 06020000h and 06040041h",
    words: "maps an object that does not exist",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.existence_checked = false,
};

pub(crate) const MAPPING_ENTRY_LENGTH_IGNORED: Fault = Fault {
    name: "mapping-entry-length-ignored",
    breaks: "CiA 301: PDO mapping parameter, length of the object",
    words: "maps an object with a length that it does not have",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.entry_length_checked = false,
};

pub(crate) const DUMMY_REFUSED: Fault = Fault {
    name: "dummy-refused",
    breaks: "CiA 301: dummy mapping",
    words: "refuses the dummies that its EDS lists",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.dummies_taken = false,
};

pub(crate) const DUMMY_SENT: Fault = Fault {
    name: "dummy-sent",
    breaks: "CiA 301: dummy mapping, for RPDOs",
    words: "maps a dummy in a TPDO",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.dummies_received_only = false,
};

pub(crate) const REFUSED_ENTRY_CLEARS: Fault = Fault {
    name: "refused-entry-clears",
    breaks: "CiA 301: SDO abort transfer, the object stays as it was",
    words: "refuses a mapping entry, and clears the one that was there",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.refused_entry_kept = false,
};

pub(crate) const MAPPING_NOT_STORED: Fault = Fault {
    name: "mapping-not-stored",
    breaks: "CiA 301: object 1010h",
    words: "stores its communication parameters without the mappings",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.mapping_stored = false,
};

pub(crate) const PDO_KEPT_BY_RESET: Fault = Fault {
    name: "pdo-kept-by-reset",
    breaks: "CiA 301: NMT, reset communication sets the power-on values",
    words: "keeps the parameters of its PDOs over reset communication",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.reset_restores = false,
};

pub(crate) const INVALID_RPDO_TAKEN: Fault = Fault {
    name: "invalid-rpdo-taken",
    breaks: "CiA 301: PDO COB-ID, bit 31",
    words: "takes an RPDO though bit 31 of its COB-ID is set",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.invalid_rpdo_passed_over = false,
};

pub(crate) const SHORT_RPDO_TAKEN: Fault = Fault {
    name: "short-rpdo-taken",
    breaks: "CiA 301: RPDO with fewer bytes than mapped",
    words: "takes the bytes that there are of a short RPDO, and 0 for the others",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.short_passed_over = false,
};

pub(crate) const SHORT_RPDO_UNREPORTED: Fault = Fault {
    name: "short-rpdo-unreported",
    breaks: "CiA 301: EMCY 8210h",
    words: "passes over a short RPDO without an EMCY",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.short_reported = false,
};

pub(crate) const LONG_RPDO_PASSED_OVER: Fault = Fault {
    name: "long-rpdo-passed-over",
    breaks: "CiA 301: RPDO with more bytes than mapped",
    words: "takes nothing of an RPDO that is longer than its mapping",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.long_taken = false,
};

pub(crate) const LATE_RPDO_UNREPORTED: Fault = Fault {
    name: "late-rpdo-unreported",
    breaks: "CiA 301: RPDO communication parameter, event timer; EMCY 8250h",
    words: "does not say that an RPDO is late",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.deadline_noticed = false,
};

pub(crate) const RPDO_LATE_FROM_START: Fault = Fault {
    name: "rpdo-late-from-start",
    breaks: "CiA 301: RPDO communication parameter, event timer runs from a reception",
    words: "reports an RPDO as late that has never come",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.deadline_from_first = false,
};

pub(crate) const EVENT_RPDO_WAITS: Fault = Fault {
    name: "event-rpdo-waits",
    breaks: "CiA 301: event-driven RPDO, actuated at once",
    words: "keeps the values of an event-driven RPDO until SYNC",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.event_rpdo_at_once = false,
};

pub(crate) const ACYCLIC_RPDO_AT_ONCE: Fault = Fault {
    name: "acyclic-rpdo-at-once",
    breaks: "CiA 301: RPDO transmission type 0, actuated with the next SYNC",
    words: "takes the values of an RPDO of type 0 when it arrives",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.acyclic_rpdo_waits = false,
};

pub(crate) const FIRST_RPDO_COUNTS: Fault = Fault {
    name: "first-rpdo-counts",
    breaks: "CiA 301: synchronous RPDO, the data received last",
    words: "takes the first of several RPDOs before a SYNC, not the last",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.last_rpdo_counts = false,
};

pub(crate) const SYNCHRONOUS_RPDO_LOST: Fault = Fault {
    name: "synchronous-rpdo-lost",
    breaks: "CiA 301: synchronous RPDO, actuated with the next SYNC",
    words: "does not take synchronous RPDOs at all",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.rpdo_actuated = false,
};

pub(crate) const ACYCLIC_TPDO_CYCLIC: Fault = Fault {
    name: "acyclic-tpdo-every-sync",
    breaks: "CiA 301: TPDO transmission type 0",
    words: "sends a TPDO of type 0 with every SYNC, changed or not",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.acyclic_needs_event = false,
};

pub(crate) const ACYCLIC_TPDO_AT_ONCE: Fault = Fault {
    name: "acyclic-tpdo-at-once",
    breaks: "CiA 301: TPDO transmission type 0, synchronous",
    words: "sends a TPDO of type 0 when something changes, not with SYNC",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.acyclic_waits_for_sync = false,
};

pub(crate) const CHANGE_UNNOTICED: Fault = Fault {
    name: "change-unnoticed",
    breaks: "CiA 301: event-driven TPDO",
    words: "does not send an event-driven TPDO when what it carries changes",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.changes_noticed = false,
};

pub(crate) const INHIBITED_EVENT_LOST: Fault = Fault {
    name: "inhibited-event-lost",
    breaks: "CiA 301: PDO communication parameter, inhibit time",
    words: "forgets a change that came before the inhibit time was over",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.inhibited_event_kept = false,
};

pub(crate) const EVENT_TPDO_WITH_SYNC: Fault = Fault {
    name: "event-tpdo-with-sync",
    breaks: "CiA 301: TPDO transmission types 254 and 255",
    words: "sends an event-driven TPDO with every SYNC too",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.sync_sends_synchronous_only = false,
};

pub(crate) const TIMER_OF_SYNCHRONOUS: Fault = Fault {
    name: "timer-of-synchronous-tpdo",
    breaks: "CiA 301: PDO communication parameter, event timer for types 254 and 255",
    words: "sends a synchronous TPDO with its event timer too",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.timer_event_driven_only = false,
};

pub(crate) const EVENT_TIMER_STANDS: Fault = Fault {
    name: "event-timer-stands",
    breaks: "CiA 301: PDO communication parameter, event timer",
    words: "sends no TPDO when its event timer is over",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.timer_runs = false,
};

pub(crate) const REMOTE_TPDO_WITH_SYNC: Fault = Fault {
    name: "remote-tpdo-with-sync",
    breaks: "CiA 301: TPDO transmission types 252 and 253, on a remote frame only",
    words: "sends a TPDO of type 252 or 253 with SYNC",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.sync_sends_no_remote = false,
};

pub(crate) const REMOTE_FRAME_UNANSWERED: Fault = Fault {
    name: "remote-frame-unanswered",
    breaks: "CiA 301: TPDO transmission types 252 and 253",
    words: "takes transmission types 252 and 253, and answers no remote frame",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.remote_answered = false,
};

pub(crate) const LONG_RATIO_CUT: Fault = Fault {
    name: "long-ratio-cut",
    breaks: "CiA 301: TPDO transmission type 1 to 240",
    words: "counts SYNCs in seven bits: type 130 is sent with every second",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.long_ratios_counted = false,
};

pub(crate) const SYNCHRONOUS_ON_START: Fault = Fault {
    name: "synchronous-tpdo-on-start",
    breaks: "CiA 301: synchronous TPDO, sent with SYNC",
    words: "sends a synchronous TPDO on entering Operational",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.synchronous_waits_for_first = false,
};

pub(crate) const ONE_TPDO_PER_SYNC: Fault = Fault {
    name: "one-tpdo-per-sync",
    breaks: "CiA 301: synchronous TPDO",
    words: "sends one TPDO with a SYNC, though several are due",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.every_due_sent = false,
};

pub(crate) const MAPPING_ORDER_TURNED: Fault = Fault {
    name: "mapping-order-turned",
    breaks: "CiA 301: PDO mapping, the order of the entries",
    words: "sends the mapped objects in the opposite order",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.mapping_order_kept = false,
};

pub(crate) const TPDO_ALWAYS_EIGHT: Fault = Fault {
    name: "tpdo-always-eight",
    breaks: "CiA 301: PDO, as long as its mapping",
    words: "sends 8 bytes, whatever is mapped",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.tpdo_length_kept = false,
};

pub(crate) const TPDO_STALE: Fault = Fault {
    name: "tpdo-stale",
    breaks: "CiA 301: TPDO, process data of now",
    words: "sends the values of the time before",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.tpdo_fresh = false,
};

pub(crate) const IDENTIFIERS_NEARLY_COMPARED: Fault = Fault {
    name: "identifier-nearly-compared",
    breaks: "CiA 301: PDO COB-ID, bits 0 to 10",
    words: "takes an RPDO whose identifier differs from its own in the lowest two bits",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.identifiers_compared = false,
};

pub(crate) const DEFAULT_MAPPING_WRONG: Fault = Fault {
    name: "default-mapping-wrong",
    breaks: "CiA 301: PDO mapping parameter, length of the object",
    words: "maps the first object of TPDO1 and RPDO1 by default with twice its length",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.default_mapping_right = false,
};

pub(crate) const PDO_SUB_INDICES_WRONG: Fault = Fault {
    name: "pdo-sub-index-count-wrong",
    breaks: "CiA 301: PDO communication parameter, sub-index 0",
    words: "gives 32 for the highest sub-index of a PDO communication parameter, as if it were a length in bits",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.sub_indices_right = false,
};

pub(crate) const START_VALUE_WITHOUT_COUNTER: Fault = Fault {
    name: "start-value-without-counter",
    breaks: "CiA 301: PDO communication parameter, SYNC start value without a counter",
    words: "waits for the SYNC with its start value though SYNC has no counter",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.start_value_needs_counter = false,
};

pub(crate) const BITS_NOT_PACKED: Fault = Fault {
    name: "bits-not-packed",
    breaks: "CiA 301: PDO mapping, transfer syntax of bit sequences",
    words: "gives a BOOLEAN in a PDO a whole byte",
    caught_by: "pdo",
    apply: |behaviour| behaviour.canopen.pdo.bits_packed = false,
};

/// All of them.
pub(crate) const ALL: &[Fault] = &[
    IDENTIFIER_CHANGED_WHILE_VALID,
    INHIBIT_TIME_CHANGED_WHILE_VALID,
    START_VALUE_CHANGED_WHILE_VALID,
    EXTENDED_IDENTIFIER_CONFIRMED,
    PDO_IDENTIFIER_NOT_USED,
    TRANSMISSION_TYPE_NOT_STORED,
    EXTENDED_FRAME_TAKEN,
    MAPPING_CHANGED_WHILE_VALID,
    ENTRY_CHANGED_WHILE_COUNTED,
    MAPPING_COUNT_UNCHECKED,
    MAPPING_LENGTH_UNCHECKED,
    UNMAPPABLE_MAPPED,
    MAPPING_DIRECTION_IGNORED,
    ABSENT_OBJECT_MAPPED,
    MAPPING_ENTRY_LENGTH_IGNORED,
    DUMMY_REFUSED,
    DUMMY_SENT,
    REFUSED_ENTRY_CLEARS,
    MAPPING_NOT_STORED,
    PDO_KEPT_BY_RESET,
    INVALID_RPDO_TAKEN,
    SHORT_RPDO_TAKEN,
    SHORT_RPDO_UNREPORTED,
    LONG_RPDO_PASSED_OVER,
    LATE_RPDO_UNREPORTED,
    RPDO_LATE_FROM_START,
    EVENT_RPDO_WAITS,
    ACYCLIC_RPDO_AT_ONCE,
    FIRST_RPDO_COUNTS,
    SYNCHRONOUS_RPDO_LOST,
    ACYCLIC_TPDO_CYCLIC,
    ACYCLIC_TPDO_AT_ONCE,
    CHANGE_UNNOTICED,
    INHIBITED_EVENT_LOST,
    EVENT_TPDO_WITH_SYNC,
    TIMER_OF_SYNCHRONOUS,
    EVENT_TIMER_STANDS,
    REMOTE_TPDO_WITH_SYNC,
    REMOTE_FRAME_UNANSWERED,
    LONG_RATIO_CUT,
    SYNCHRONOUS_ON_START,
    ONE_TPDO_PER_SYNC,
    MAPPING_ORDER_TURNED,
    TPDO_ALWAYS_EIGHT,
    TPDO_STALE,
    IDENTIFIERS_NEARLY_COMPARED,
    DEFAULT_MAPPING_WRONG,
    PDO_SUB_INDICES_WRONG,
    START_VALUE_WITHOUT_COUNTER,
    BITS_NOT_PACKED,
];
