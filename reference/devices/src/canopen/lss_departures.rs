//! How an LSS slave behaves where devices differ.

/// What an LSS slave does otherwise than CiA 305 says, and what it may do one way or the other. The default conforms.
#[derive(Debug, Clone, Default)]
pub struct LssDepartures {
    /// The four numbers of an LSS address are compared when the last has come, and not one by one: both are right.
    pub compares_at_the_end: bool,

    /// Any mode of switch state global but 0 leads into configuration.
    pub any_mode_configures: bool,
    /// Switch state global does not lead out of configuration.
    pub stays_in_configuration: bool,
    /// A reset of the communication does not lead out of configuration.
    pub configuration_survives_reset: bool,
    /// The part of an LSS address, 0 to 2, that may be any number.
    pub part_ignored: Option<u8>,
    /// Of every number of an LSS address the low 16 bits count.
    pub low_words_compared: bool,
    /// The serial number alone selects the slave.
    pub serial_selects_alone: bool,
    /// Four numbers that match select the slave in whatever order they come.
    pub order_ignored: bool,
    /// Every number of an LSS address that matches is confirmed.
    pub every_part_confirmed: bool,
    /// A switch to waiting does not end a selection that has begun.
    pub selection_goes_on: bool,
    /// Inquiries are answered in waiting.
    pub inquired_in_waiting: bool,
    /// Node-ID and bit timing are configured, and stored, in waiting.
    pub configured_in_waiting: bool,
    /// A bit timing is activated in waiting.
    pub activated_in_waiting: bool,
    /// Every answer is sent twice.
    pub answers_twice: bool,
    /// Reserved bytes of answers hold what an answer before left there.
    pub reserved_bytes_stale: bool,
    /// An answer has as many bytes as it needs.
    pub answers_cut_short: bool,
    /// The node-ID that is told is the one that was configured last, not the one in use.
    pub pending_node_told: bool,
    /// A node-ID that is refused though it is none.
    pub node_refused: Option<u8>,
    /// A node-ID that is taken though it is none.
    pub node_taken: Option<u8>,
    /// A node-ID that is refused becomes the next one all the same: the slave has none after a reset.
    pub refused_node_kept: bool,
    /// A node-ID has six bits.
    pub node_of_six_bits: bool,
    /// A reset of the communication does not bring a configured node-ID into use.
    pub node_waits_for_reset_node: bool,
    /// What is configured is stored unasked.
    pub stored_unasked: bool,
    /// Nothing answers a request to store.
    pub store_unanswered: bool,
    /// The selector of the bit timing table may be anything.
    pub table_ignored: bool,
    /// An index beyond the table is its last one.
    pub last_index_for_all: bool,
    /// A bit timing is in use when it is configured.
    pub bit_timing_at_once: bool,
    /// Frames are sent while a bit timing is being activated.
    pub talks_while_switching: bool,
    /// The number of an identify sequence, 0 to 5, that may be anything.
    pub identify_step_ignored: Option<u8>,
    /// The bounds of an identify sequence are no longer within it.
    pub identify_bounds_exclusive: bool,
    /// The last number of an identify sequence is enough.
    pub identify_begins_anywhere: bool,
    /// A slave with a node-ID says that it has none.
    pub unconfigured_with_node: bool,
    /// A slave without node-ID does not say so.
    pub unconfigured_silent: bool,
    /// Fastscan: every number is the own.
    pub scan_number_ignored: bool,
    /// Fastscan: bits below the one that is checked count.
    pub scan_low_bits_compared: bool,
    /// Fastscan: a part that is not the one to be asked for is answered.
    pub scan_part_ignored: bool,
    /// Fastscan: the request that begins does not begin again.
    pub scan_goes_on: bool,
    /// Fastscan: the slave that was found stays in waiting.
    pub scan_does_not_select: bool,
    /// Fastscan: a slave in configuration takes part.
    pub scan_in_configuration: bool,
    /// Requests of fewer than eight bytes are taken, the rest being zero.
    pub short_requests_taken: bool,
    /// A request with an unknown command specifier is answered.
    pub unknown_answered: bool,
    /// LSS does not work in Operational.
    pub not_in_operational: bool,
    /// LSS does not work in Stopped.
    pub not_in_stopped: bool,
    /// After so many answers there are no more until a reset.
    pub answers_at_most: Option<u32>,
}
