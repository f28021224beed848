//! The faults of LSS, each one departure from one clause.

use crate::Fault;

pub(crate) const LSS_ANY_MODE_CONFIGURES: Fault = Fault {
    name: "lss-any-mode-configures",
    breaks: "CiA 305: switch state global protocol, mode",
    words: "goes into configuration at a mode of switch state global that is reserved",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.any_mode_configures = true,
};

pub(crate) const LSS_STAYS_IN_CONFIGURATION: Fault = Fault {
    name: "lss-stays-in-configuration",
    breaks: "CiA 305: switch state global protocol, mode 0",
    words: "does not leave configuration when it is told to wait",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.stays_in_configuration = true,
};

pub(crate) const LSS_CONFIGURATION_SURVIVES_RESET: Fault = Fault {
    name: "lss-configuration-survives-reset",
    breaks: "CiA 305: LSS states, waiting after NMT initialisation",
    words: "is still in configuration after a reset of the communication",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.configuration_survives_reset = true,
};

pub(crate) const LSS_VENDOR_IGNORED: Fault = Fault {
    name: "lss-vendor-ignored",
    breaks: "CiA 305: switch state selective protocol, vendor-ID",
    words: "is selected by any vendor-ID",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.part_ignored = Some(0),
};

pub(crate) const LSS_PRODUCT_IGNORED: Fault = Fault {
    name: "lss-product-ignored",
    breaks: "CiA 305: switch state selective protocol, product code",
    words: "is selected by any product code",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.part_ignored = Some(1),
};

pub(crate) const LSS_REVISION_IGNORED: Fault = Fault {
    name: "lss-revision-ignored",
    breaks: "CiA 305: switch state selective protocol, revision number",
    words: "is selected by any revision number",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.part_ignored = Some(2),
};

pub(crate) const LSS_ORDER_IGNORED: Fault = Fault {
    name: "lss-order-ignored",
    breaks: "CiA 305: switch state selective protocol, order of the four requests",
    words: "is selected by the four numbers of its identity in any order",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.order_ignored = true,
};

pub(crate) const LSS_EVERY_NUMBER_CONFIRMED: Fault = Fault {
    name: "lss-every-number-confirmed",
    breaks: "CiA 305: switch state selective protocol, one response to the fourth request",
    words: "confirms each number of its LSS address and not only the last",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.every_part_confirmed = true,
};

pub(crate) const LSS_LOW_WORDS_COMPARED: Fault = Fault {
    name: "lss-low-words-compared",
    breaks: "CiA 305: switch state selective protocol, numbers of 32 bits",
    words: "is selected by an LSS address of whose numbers the low 16 bits are right",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.low_words_compared = true,
};

pub(crate) const LSS_SERIAL_SELECTS_ALONE: Fault = Fault {
    name: "lss-serial-selects-alone",
    breaks: "CiA 305: switch state selective protocol, four requests",
    words: "is selected by its serial number alone",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.serial_selects_alone = true,
};

pub(crate) const LSS_ANSWERS_TWICE: Fault = Fault {
    name: "lss-answers-twice",
    breaks: "CiA 305: LSS protocols, one response",
    words: "sends every answer twice",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.answers_twice = true,
};

pub(crate) const LSS_SELECTION_GOES_ON: Fault = Fault {
    name: "lss-selection-goes-on",
    breaks: "CiA 305: switch state global protocol, waiting",
    words: "goes on with a selection that a switch to waiting has ended",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.selection_goes_on = true,
};

pub(crate) const LSS_INQUIRED_IN_WAITING: Fault = Fault {
    name: "lss-inquired-in-waiting",
    breaks: "CiA 305: LSS states and services, inquiries only in configuration",
    words: "answers inquiries while it is waiting",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.inquired_in_waiting = true,
};

pub(crate) const LSS_CONFIGURED_IN_WAITING: Fault = Fault {
    name: "lss-configured-in-waiting",
    breaks: "CiA 305: LSS states and services, configuration only in configuration",
    words: "takes a node-ID and a bit timing while it is waiting",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.configured_in_waiting = true,
};

pub(crate) const LSS_RESERVED_BYTES_STALE: Fault = Fault {
    name: "lss-reserved-bytes-stale",
    breaks: "CiA 305: LSS messages, reserved bytes are zero",
    words: "leaves what its last answer held in the reserved bytes of the next",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.reserved_bytes_stale = true,
};

pub(crate) const LSS_ANSWERS_CUT_SHORT: Fault = Fault {
    name: "lss-answers-cut-short",
    breaks: "CiA 305: LSS messages have eight bytes",
    words: "sends answers without their reserved bytes",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.answers_cut_short = true,
};

pub(crate) const LSS_PENDING_NODE_TOLD: Fault = Fault {
    name: "lss-pending-node-told",
    breaks: "CiA 305: inquire node-ID protocol, the active node-ID",
    words: "tells the node-ID that was configured before it is in use",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.pending_node_told = true,
};

pub(crate) const LSS_NODE_127_REFUSED: Fault = Fault {
    name: "lss-node-127-refused",
    breaks: "CiA 305: configure node-ID protocol, 1 to 127",
    words: "refuses node-ID 127",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.node_refused = Some(127),
};

pub(crate) const LSS_NODE_255_REFUSED: Fault = Fault {
    name: "lss-node-255-refused",
    breaks: "CiA 305: configure node-ID protocol, 255 makes a slave unconfigured",
    words: "refuses 255, no node-ID",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.node_refused = Some(255),
};

pub(crate) const LSS_NODE_0_TAKEN: Fault = Fault {
    name: "lss-node-0-taken",
    breaks: "CiA 305: configure node-ID protocol, error code 1",
    words: "says that it takes node-ID 0",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.node_taken = Some(0),
};

pub(crate) const LSS_NODE_128_TAKEN: Fault = Fault {
    name: "lss-node-128-taken",
    breaks: "CiA 305: configure node-ID protocol, error code 1",
    words: "says that it takes node-ID 128",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.node_taken = Some(128),
};

pub(crate) const LSS_REFUSED_NODE_KEPT: Fault = Fault {
    name: "lss-refused-node-kept",
    breaks: "CiA 305: configure node-ID protocol, error code 1",
    words: "has no node-ID after the next reset when it has refused one",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.refused_node_kept = true,
};

pub(crate) const LSS_NODE_OF_SIX_BITS: Fault = Fault {
    name: "lss-node-of-six-bits",
    breaks: "CiA 305: configure node-ID protocol, 1 to 127",
    words: "takes a node-ID above 63 for one that is 64 less",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.node_of_six_bits = true,
};

pub(crate) const LSS_NODE_WAITS_FOR_RESET_NODE: Fault = Fault {
    name: "lss-node-waits-for-reset-node",
    breaks: "CiA 305: configure node-ID protocol, active after reset communication",
    words: "keeps its node-ID over a reset of the communication",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.node_waits_for_reset_node = true,
};

pub(crate) const LSS_STORED_UNASKED: Fault = Fault {
    name: "lss-stored-unasked",
    breaks: "CiA 305: store configuration protocol",
    words: "stores a node-ID when it is configured",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.stored_unasked = true,
};

pub(crate) const LSS_STORE_UNANSWERED: Fault = Fault {
    name: "lss-store-unanswered",
    breaks: "CiA 305: store configuration protocol, response",
    words: "does not answer a request to store",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.store_unanswered = true,
};

pub(crate) const LSS_TABLE_IGNORED: Fault = Fault {
    name: "lss-table-ignored",
    breaks: "CiA 305: configure bit timing protocol, table selector",
    words: "takes an index of table 0 whatever table is named",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.table_ignored = true,
};

pub(crate) const LSS_LAST_INDEX_FOR_ALL: Fault = Fault {
    name: "lss-last-index-for-all",
    breaks: "CiA 305: configure bit timing protocol, table index",
    words: "takes an index beyond the table for its last",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.last_index_for_all = true,
};

pub(crate) const LSS_BIT_TIMING_AT_ONCE: Fault = Fault {
    name: "lss-bit-timing-at-once",
    breaks: "CiA 305: configure bit timing protocol, active after activation or reset",
    words: "uses a bit timing as soon as it is configured",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.bit_timing_at_once = true,
};

pub(crate) const LSS_SHORT_REQUESTS_TAKEN: Fault = Fault {
    name: "lss-short-requests-taken",
    breaks: "CiA 305: LSS messages have eight bytes",
    words: "takes requests of fewer than eight bytes",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.short_requests_taken = true,
};

pub(crate) const LSS_UNKNOWN_ANSWERED: Fault = Fault {
    name: "lss-unknown-answered",
    breaks: "CiA 305: command specifiers",
    words: "answers a request with a command specifier that there is none of",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.unknown_answered = true,
};

pub(crate) const LSS_NOT_IN_OPERATIONAL: Fault = Fault {
    name: "lss-not-in-operational",
    breaks: "CiA 305: LSS in every NMT state",
    words: "takes no LSS requests in Operational",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.not_in_operational = true,
};

pub(crate) const LSS_NOT_IN_STOPPED: Fault = Fault {
    name: "lss-not-in-stopped",
    breaks: "CiA 305: LSS in every NMT state",
    words: "takes no LSS requests in Stopped",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.not_in_stopped = true,
};

pub(crate) const LSS_SILENT_AFTER_127_ANSWERS: Fault = Fault {
    name: "lss-silent-after-127-answers",
    breaks: "CiA 305: LSS protocols, responses",
    words: "answers 127 requests and no more",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.answers_at_most = Some(127),
};

pub(crate) const LSS_ACTIVATED_IN_WAITING: Fault = Fault {
    name: "lss-activated-in-waiting",
    breaks: "CiA 305: LSS states and services, activate bit timing only in configuration",
    words: "activates a bit timing while it is waiting",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.activated_in_waiting = true,
};

pub(crate) const LSS_TALKS_WHILE_SWITCHING: Fault = Fault {
    name: "lss-talks-while-switching",
    breaks: "CiA 305: activate bit timing parameters protocol, switch delay",
    words: "goes on sending while a bit timing is being activated",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.talks_while_switching = true,
};

pub(crate) const LSS_IDENTIFY_VENDOR_IGNORED: Fault = Fault {
    name: "lss-identify-vendor-ignored",
    breaks: "CiA 305: identify remote slave protocol, vendor-ID",
    words: "identifies itself whatever vendor-ID is named",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.identify_step_ignored = Some(0),
};

pub(crate) const LSS_IDENTIFY_REVISION_HIGH_IGNORED: Fault = Fault {
    name: "lss-identify-revision-high-ignored",
    breaks: "CiA 305: identify remote slave protocol, highest revision number",
    words: "identifies itself though its revision number is above the highest that is named",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.identify_step_ignored = Some(3),
};

pub(crate) const LSS_IDENTIFY_BOUNDS_EXCLUSIVE: Fault = Fault {
    name: "lss-identify-bounds-exclusive",
    breaks: "CiA 305: identify remote slave protocol, the bounds belong to the range",
    words: "does not identify itself where a bound is its own number",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.identify_bounds_exclusive = true,
};

pub(crate) const LSS_IDENTIFY_BEGINS_ANYWHERE: Fault = Fault {
    name: "lss-identify-begins-anywhere",
    breaks: "CiA 305: identify remote slave protocol, six requests",
    words: "identifies itself at the last of six numbers, whether the others have come or not",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.identify_begins_anywhere = true,
};

pub(crate) const LSS_UNCONFIGURED_WITH_NODE: Fault = Fault {
    name: "lss-unconfigured-with-node",
    breaks: "CiA 305: identify non-configured remote slave protocol",
    words: "says that it has no node-ID though it has one",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.unconfigured_with_node = true,
};

pub(crate) const LSS_UNCONFIGURED_SILENT: Fault = Fault {
    name: "lss-unconfigured-silent",
    breaks: "CiA 305: identify non-configured slave protocol",
    words: "does not say that it has no node-ID",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.unconfigured_silent = true,
};

pub(crate) const LSS_FASTSCAN_NUMBER_IGNORED: Fault = Fault {
    name: "lss-fastscan-number-ignored",
    breaks: "CiA 305: fastscan protocol, IDNumber",
    words: "answers a fastscan whatever number is named",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.scan_number_ignored = true,
};

pub(crate) const LSS_FASTSCAN_LOW_BITS_COMPARED: Fault = Fault {
    name: "lss-fastscan-low-bits-compared",
    breaks: "CiA 305: fastscan protocol, BitChecked",
    words: "compares the bits below the one that is checked, too",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.scan_low_bits_compared = true,
};

pub(crate) const LSS_FASTSCAN_PART_IGNORED: Fault = Fault {
    name: "lss-fastscan-part-ignored",
    breaks: "CiA 305: fastscan protocol, LSSSub",
    words: "answers for a part of its identity that is not the one to be asked for",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.scan_part_ignored = true,
};

pub(crate) const LSS_FASTSCAN_GOES_ON: Fault = Fault {
    name: "lss-fastscan-goes-on",
    breaks: "CiA 305: fastscan protocol, BitChecked 128",
    words: "does not begin again with its vendor-ID when a fastscan begins",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.scan_goes_on = true,
};

pub(crate) const LSS_FASTSCAN_DOES_NOT_SELECT: Fault = Fault {
    name: "lss-fastscan-does-not-select",
    breaks: "CiA 305: fastscan protocol, the slave that was found is in configuration",
    words: "is found by a fastscan and stays in waiting",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.scan_does_not_select = true,
};

pub(crate) const LSS_FASTSCAN_IN_CONFIGURATION: Fault = Fault {
    name: "lss-fastscan-in-configuration",
    breaks: "CiA 305: LSS states and services, fastscan only in waiting",
    words: "takes part in a fastscan while it is in configuration",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.lss.scan_in_configuration = true,
};

/// What every LSS slave can have.
pub(crate) const EVERY: &[Fault] = &[
    LSS_ANY_MODE_CONFIGURES,
    LSS_STAYS_IN_CONFIGURATION,
    LSS_CONFIGURATION_SURVIVES_RESET,
    LSS_VENDOR_IGNORED,
    LSS_PRODUCT_IGNORED,
    LSS_REVISION_IGNORED,
    LSS_ORDER_IGNORED,
    LSS_EVERY_NUMBER_CONFIRMED,
    LSS_LOW_WORDS_COMPARED,
    LSS_SERIAL_SELECTS_ALONE,
    LSS_ANSWERS_TWICE,
    LSS_SELECTION_GOES_ON,
    LSS_INQUIRED_IN_WAITING,
    LSS_CONFIGURED_IN_WAITING,
    LSS_RESERVED_BYTES_STALE,
    LSS_ANSWERS_CUT_SHORT,
    LSS_PENDING_NODE_TOLD,
    LSS_NODE_127_REFUSED,
    LSS_NODE_255_REFUSED,
    LSS_NODE_0_TAKEN,
    LSS_NODE_128_TAKEN,
    LSS_REFUSED_NODE_KEPT,
    LSS_NODE_OF_SIX_BITS,
    LSS_NODE_WAITS_FOR_RESET_NODE,
    LSS_STORED_UNASKED,
    LSS_STORE_UNANSWERED,
    LSS_TABLE_IGNORED,
    LSS_LAST_INDEX_FOR_ALL,
    LSS_BIT_TIMING_AT_ONCE,
    LSS_SHORT_REQUESTS_TAKEN,
    LSS_UNKNOWN_ANSWERED,
    LSS_NOT_IN_OPERATIONAL,
    LSS_NOT_IN_STOPPED,
    LSS_SILENT_AFTER_127_ANSWERS,
];

/// What a slave can have that finds, identifies and activates.
pub(crate) const COMPLETE: &[Fault] = &[
    LSS_ACTIVATED_IN_WAITING,
    LSS_TALKS_WHILE_SWITCHING,
    LSS_IDENTIFY_VENDOR_IGNORED,
    LSS_IDENTIFY_REVISION_HIGH_IGNORED,
    LSS_IDENTIFY_BOUNDS_EXCLUSIVE,
    LSS_IDENTIFY_BEGINS_ANYWHERE,
    LSS_UNCONFIGURED_WITH_NODE,
    LSS_UNCONFIGURED_SILENT,
    LSS_FASTSCAN_NUMBER_IGNORED,
    LSS_FASTSCAN_LOW_BITS_COMPARED,
    LSS_FASTSCAN_PART_IGNORED,
    LSS_FASTSCAN_GOES_ON,
    LSS_FASTSCAN_DOES_NOT_SELECT,
    LSS_FASTSCAN_IN_CONFIGURATION,
];
