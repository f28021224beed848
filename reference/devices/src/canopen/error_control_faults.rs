//! The faults of heartbeat, guarding and error behaviour, each one departure from one clause.

use crate::Fault;

pub(crate) const HEARTBEAT_PERIOD_DOUBLED: Fault = Fault {
    name: "heartbeat-period-doubled",
    breaks: "CiA 301: object 1017h counts milliseconds",
    words: "sends its heartbeat half as often as 1017h says",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.heartbeat_percent = 200,
};

pub(crate) const HEARTBEAT_CHANGE_IGNORED: Fault = Fault {
    name: "heartbeat-change-ignored",
    breaks: "CiA 301: object 1017h",
    words: "keeps the period of a heartbeat that runs when another is written to 1017h",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.heartbeat_change_taken = false,
};

pub(crate) const STORED_HEARTBEAT_NOT_STARTED: Fault = Fault {
    name: "stored-heartbeat-not-started",
    breaks: "CiA 301: heartbeat protocol, starts with the boot-up message",
    words: "begins its heartbeat when 1017h is written, not when a reset gives it a value",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.stored_heartbeat_starts = false,
};

pub(crate) const HEARTBEAT_OF_EIGHT_BYTES: Fault = Fault {
    name: "heartbeat-of-eight-bytes",
    breaks: "CiA 301: heartbeat protocol, one byte",
    words: "sends eight bytes in a heartbeat",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.heartbeat_length = 8,
};

pub(crate) const HEARTBEAT_TOGGLES: Fault = Fault {
    name: "heartbeat-toggles",
    breaks: "CiA 301: heartbeat protocol, bit 7 is 0",
    words: "alternates bit 7 of its heartbeat as if it were guarded",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.heartbeat_toggles = true,
};

pub(crate) const CONSUMER_BEFORE_FIRST_HEARTBEAT: Fault = Fault {
    name: "consumer-before-first-heartbeat",
    breaks: "CiA 301: object 1016h, monitoring starts after the first heartbeat",
    words: "misses a heartbeat of a node that has sent none yet",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.consumer_waits_for_first = false,
};

pub(crate) const CONSUMER_TAKES_ANY_NODE: Fault = Fault {
    name: "consumer-takes-any-node",
    breaks: "CiA 301: object 1016h, node-ID",
    words: "takes the heartbeat of any node for that of the node in 1016h",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.consumer_compares_node = false,
};

pub(crate) const CONSUMER_ENTRY_TWICE_TAKEN: Fault = Fault {
    name: "consumer-entry-twice-taken",
    breaks: "CiA 301: object 1016h, abort code 06040043h",
    words: "takes two entries of 1016h for the same node",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.consumer_entry_once = false,
};

pub(crate) const CONSUMER_TIME_HALVED: Fault = Fault {
    name: "consumer-time-halved",
    breaks: "CiA 301: object 1016h counts milliseconds",
    words: "misses a heartbeat after half the time that 1016h says",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.consumer_percent = 50,
};

pub(crate) const CONSUMER_SECOND_ENTRY_IGNORED: Fault = Fault {
    name: "consumer-second-entry-ignored",
    breaks: "CiA 301: object 1016h",
    words: "listens to the node in the first entry of 1016h alone",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.consumer_entries = 1,
};

pub(crate) const CONSUMER_NOT_STOPPED: Fault = Fault {
    name: "consumer-not-stopped",
    breaks: "CiA 301: object 1016h, 0 disables an entry",
    words: "goes on listening to a node whose entry of 1016h is set to 0",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.consumer_can_be_stopped = false,
};

pub(crate) const CONSUMER_WANTS_OPERATIONAL: Fault = Fault {
    name: "consumer-wants-operational",
    breaks: "CiA 301: heartbeat protocol, heartbeat event",
    words: "takes the heartbeats of a node that is not operational for none",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.consumer_takes_any_state = false,
};

pub(crate) const CONSUMER_DOES_NOT_RESUME: Fault = Fault {
    name: "consumer-does-not-resume",
    breaks: "CiA 301: heartbeat protocol, heartbeat event resolved",
    words: "monitors a node no more once it has been missing",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.consumer_resumes = false,
};

pub(crate) const LOST_HEARTBEAT_REPORTED_AGAIN: Fault = Fault {
    name: "lost-heartbeat-reported-again",
    breaks: "CiA 301: emergency object, once for an error event",
    words: "reports a missing heartbeat again and again",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.lost_heartbeat_reported_once = false,
};

pub(crate) const LOST_HEARTBEAT_CODE_WRONG: Fault = Fault {
    name: "lost-heartbeat-code-wrong",
    breaks: "CiA 301: emergency error code 8130h",
    words: "reports a missing heartbeat as 8100h",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.lost_heartbeat_code = 0x8100,
};

pub(crate) const GUARDING_TOGGLE_STARTS_WITH_1: Fault = Fault {
    name: "guarding-toggle-starts-with-1",
    breaks: "CiA 301: node guarding protocol, toggle bit",
    words: "gives its first guarding answer the toggle bit 1",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.first_toggle = true,
};

pub(crate) const GUARDING_TOGGLE_NOT_RESTARTED: Fault = Fault {
    name: "guarding-toggle-not-restarted",
    breaks: "CiA 301: node guarding protocol, toggle bit after Reset communication",
    words: "goes on alternating the toggle bit over reset communication",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.toggle_restarts = false,
};

pub(crate) const LIFE_TIME_BEFORE_FIRST_REQUEST: Fault = Fault {
    name: "life-time-before-first-request",
    breaks: "CiA 301: life guarding protocol, starts with the first guarding request",
    words: "misses a master that has not begun to guard",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.life_time_waits_for_first = false,
};

pub(crate) const LIFE_TIME_WITHOUT_FACTOR: Fault = Fault {
    name: "life-time-without-factor",
    breaks: "CiA 301: object 100Dh, life time is guard time times factor",
    words: "misses its master after the guard time, whatever the factor",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.life_time_factor_used = false,
};

pub(crate) const LIFE_TIME_FACTOR_ZERO_TAKEN: Fault = Fault {
    name: "life-time-factor-zero-taken",
    breaks: "CiA 301: object 100Dh, 0 disables life guarding",
    words: "misses its master though the life time factor is 0",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.life_time_needs_factor = false,
};

pub(crate) const GUARDING_ANSWER_AS_LONG_AS_REQUEST: Fault = Fault {
    name: "guarding-answer-as-long-as-request",
    breaks: "CiA 301: node guarding protocol, one byte",
    words: "answers a guarding request with as many bytes as that says",
    caught_by: "error-control",
    apply: |behaviour| {
        behaviour
            .canopen
            .error_control
            .guarding_answer_as_long_as_request = true
    },
};

pub(crate) const GUARDING_ANSWERS_FOR_ANY_NODE: Fault = Fault {
    name: "guarding-answers-for-any-node",
    breaks: "CiA 301: node guarding protocol, identifier 700h and the node-ID",
    words: "answers a guarding request to another node",
    caught_by: "error-control",
    apply: |behaviour| {
        behaviour
            .canopen
            .error_control
            .guarding_answers_for_any_node = true
    },
};

pub(crate) const GUARDING_ENDS_HEARTBEAT: Fault = Fault {
    name: "guarding-ends-heartbeat",
    breaks: "CiA 301: error control, a heartbeat goes before guarding",
    words: "ends its heartbeat when it is guarded",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.guarding_ends_heartbeat = true,
};

pub(crate) const ERROR_BEHAVIOUR_FIXED: Fault = Fault {
    name: "error-behaviour-fixed",
    breaks: "CiA 301: object 1029h, 2 leads to Stopped",
    words: "becomes pre-operational after a communication error, whatever 1029h holds",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.error_behaviour_fixed = Some(0),
};

pub(crate) const ERROR_BEHAVIOUR_STOPS: Fault = Fault {
    name: "error-behaviour-stops",
    breaks: "CiA 301: object 1029h, default",
    words: "becomes stopped after a communication error, whatever 1029h holds",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.error_behaviour_fixed = Some(2),
};

pub(crate) const ERROR_BEHAVIOUR_OUT_OF_STOPPED: Fault = Fault {
    name: "error-behaviour-out-of-stopped",
    breaks: "CiA 301: object 1029h, 0 leads from Operational to Pre-operational",
    words: "becomes pre-operational in Stopped when it misses a heartbeat",
    caught_by: "error-control",
    apply: |behaviour| behaviour.canopen.error_control.error_behaviour_everywhere = true,
};

/// Those that every CANopen slave here can have.
pub(crate) const COMMON: &[Fault] = &[HEARTBEAT_PERIOD_DOUBLED, HEARTBEAT_TOGGLES];

/// Those of a slave that has everything.
pub(crate) const REST: &[Fault] = &[
    HEARTBEAT_CHANGE_IGNORED,
    STORED_HEARTBEAT_NOT_STARTED,
    HEARTBEAT_OF_EIGHT_BYTES,
    CONSUMER_BEFORE_FIRST_HEARTBEAT,
    CONSUMER_TAKES_ANY_NODE,
    CONSUMER_ENTRY_TWICE_TAKEN,
    CONSUMER_TIME_HALVED,
    CONSUMER_SECOND_ENTRY_IGNORED,
    CONSUMER_NOT_STOPPED,
    CONSUMER_WANTS_OPERATIONAL,
    CONSUMER_DOES_NOT_RESUME,
    LOST_HEARTBEAT_REPORTED_AGAIN,
    LOST_HEARTBEAT_CODE_WRONG,
    GUARDING_TOGGLE_STARTS_WITH_1,
    GUARDING_TOGGLE_NOT_RESTARTED,
    LIFE_TIME_BEFORE_FIRST_REQUEST,
    LIFE_TIME_WITHOUT_FACTOR,
    LIFE_TIME_FACTOR_ZERO_TAKEN,
    GUARDING_ANSWER_AS_LONG_AS_REQUEST,
    GUARDING_ANSWERS_FOR_ANY_NODE,
    GUARDING_ENDS_HEARTBEAT,
    ERROR_BEHAVIOUR_FIXED,
    ERROR_BEHAVIOUR_STOPS,
    ERROR_BEHAVIOUR_OUT_OF_STOPPED,
];
