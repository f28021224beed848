//! How heartbeat, guarding and error behaviour differ between devices.

/// How a slave does error control. The default conforms to CiA 301.
#[derive(Debug, Clone)]
pub struct ErrorControlSettings {
    /// With a producer heartbeat time that is not 0 after a reset, the first heartbeat comes right behind the boot-up
    /// message; it may also wait for its first period.
    pub heartbeat_with_boot_up: bool,
    /// Guarding requests are answered while there is a heartbeat; a node with a heartbeat need not.
    pub guarding_answered_beside_heartbeat: bool,
    /// A guarding request with another length than 1 is answered; a node may also ignore it.
    pub guarding_answers_any_length: bool,

    /// The heartbeat period, in hundredths of what 1017h says.
    pub heartbeat_percent: u32,
    /// A new producer heartbeat time counts while there is a heartbeat.
    pub heartbeat_change_taken: bool,
    /// A producer heartbeat time that was there before the reset counts after it.
    pub stored_heartbeat_starts: bool,
    /// Bytes of a heartbeat: 1.
    pub heartbeat_length: usize,
    /// Bit 7 of the heartbeat alternates as that of guarding.
    pub heartbeat_toggles: bool,

    /// A node is monitored from its first heartbeat on, and not before.
    pub consumer_waits_for_first: bool,
    /// Only the node of an entry counts for that entry.
    pub consumer_compares_node: bool,
    /// A node that one entry listens to is refused in another.
    pub consumer_entry_once: bool,
    /// The time after which a heartbeat is missing, in hundredths of what 1016h says.
    pub consumer_percent: u32,
    /// The entries of 1016h that are used.
    pub consumer_entries: usize,
    /// An entry that is set to 0 ends the monitoring.
    pub consumer_can_be_stopped: bool,
    /// A heartbeat counts whatever state it carries.
    pub consumer_takes_any_state: bool,
    /// A node that was lost is monitored again from its next heartbeat on.
    pub consumer_resumes: bool,
    /// A missing heartbeat is reported once, and not for every period.
    pub lost_heartbeat_reported_once: bool,
    /// The error code of a missing heartbeat: 8130h.
    pub lost_heartbeat_code: u16,

    /// The first toggle bit of guarding.
    pub first_toggle: bool,
    /// The toggle bit begins again after a reset of the communication.
    pub toggle_restarts: bool,
    /// The master is waited for from its first request on, and not before.
    pub life_time_waits_for_first: bool,
    /// The life time is guard time times factor, and not the guard time.
    pub life_time_factor_used: bool,
    /// The master is not waited for where the life time factor is 0.
    pub life_time_needs_factor: bool,
    /// The answer has as many bytes as the request says.
    pub guarding_answer_as_long_as_request: bool,
    /// A guarding request to another node is answered.
    pub guarding_answers_for_any_node: bool,
    /// A guarding request ends the heartbeat.
    pub guarding_ends_heartbeat: bool,

    /// What 1029h is taken for, whatever it holds.
    pub error_behaviour_fixed: Option<u32>,
    /// A communication error with 1029h = 0 leads to Pre-operational out of any state, and not only out of Operational.
    pub error_behaviour_everywhere: bool,
}

impl Default for ErrorControlSettings {
    fn default() -> ErrorControlSettings {
        ErrorControlSettings {
            heartbeat_with_boot_up: false,
            guarding_answered_beside_heartbeat: false,
            guarding_answers_any_length: true,
            heartbeat_percent: 100,
            heartbeat_change_taken: true,
            stored_heartbeat_starts: true,
            heartbeat_length: 1,
            heartbeat_toggles: false,
            consumer_waits_for_first: true,
            consumer_compares_node: true,
            consumer_entry_once: true,
            consumer_percent: 100,
            consumer_entries: 127,
            consumer_can_be_stopped: true,
            consumer_takes_any_state: true,
            consumer_resumes: true,
            lost_heartbeat_reported_once: true,
            lost_heartbeat_code: 0x8130,
            first_toggle: false,
            toggle_restarts: true,
            life_time_waits_for_first: true,
            life_time_factor_used: true,
            life_time_needs_factor: true,
            guarding_answer_as_long_as_request: false,
            guarding_answers_for_any_node: false,
            guarding_ends_heartbeat: false,
            error_behaviour_fixed: None,
            error_behaviour_everywhere: false,
        }
    }
}
