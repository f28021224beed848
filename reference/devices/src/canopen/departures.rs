//! How the SYNC, EMCY, TIME, store and COB-ID rules of a slave may be broken, or kept in another way.

/// Departures from the rules of SYNC, EMCY, TIME, storing and COB-IDs. Each is one sentence that is true of a wrong
/// device; the default has none.
#[derive(Debug, Clone, Default)]
pub struct Departures {
    /// 1005h begins with 0.
    pub sync_identifier_lost: bool,
    /// 1006h counts 10 us.
    pub sync_period_in_10_us: bool,
    /// SYNC goes on with its last period when 1006h becomes 0.
    pub sync_outlives_period: bool,
    /// The first SYNC comes after five periods.
    pub sync_starts_late: bool,
    /// The identifier of SYNC changes while SYNC is produced.
    pub sync_identifier_unprotected: bool,
    /// SYNC has the identifier 080h, whatever 1005h holds.
    pub sync_identifier_fixed: bool,
    /// SYNC is produced in Stopped.
    pub sync_in_stopped: bool,
    /// SYNC is produced in Operational alone.
    pub sync_in_operational_only: bool,
    /// A saved bit 30 of 1005h counts only when it is written again.
    pub sync_rests_after_reset: bool,
    /// A remote frame with its identifier counts as SYNC.
    pub sync_by_remote_frame: bool,
    /// A SYNC of the wrong length is used.
    pub sync_length_unchecked: bool,
    /// 1007h counts nanoseconds.
    pub sync_window_in_ns: bool,
    /// A counter of 1 is taken.
    pub counter_of_1_taken: bool,
    /// Counters from 128 on are refused.
    pub counter_above_127_refused: bool,
    /// The counter changes while 1006h is not 0.
    pub counter_unprotected: bool,
    /// The counter counts from 0.
    pub counter_from_0: bool,
    /// The counter goes on where it was after Stopped.
    pub counter_outlives_stopped: bool,
    /// A 29-bit frame counts as one with its lowest 11 bits.
    pub extended_frames_cut: bool,
    /// 1014h begins without the node-ID.
    pub emergency_identifier_without_node: bool,
    /// An RPDO that is too short is passed over in silence.
    pub short_pdo_unreported: bool,
    /// Clearing 1003h sets the count alone to 0.
    pub cleared_errors_stay: bool,
    /// New errors are put behind the older ones in 1003h.
    pub errors_appended: bool,
    /// 1003h:00 takes any number.
    pub history_count_taken: bool,
    /// Each EMCY is sent again after 100 ms.
    pub emergency_repeated: bool,
    /// An EMCY has its first three bytes only.
    pub emergency_cut: bool,
    /// EMCY is sent though bit 31 of 1014h is set.
    pub emergency_while_invalid: bool,
    /// EMCY has the identifier 080h and the node-ID, whatever 1014h holds.
    pub emergency_identifier_fixed: bool,
    /// The identifier of EMCY changes while it is valid.
    pub emergency_identifier_unprotected: bool,
    /// EMCY is sent in Stopped.
    pub emergency_in_stopped: bool,
    /// EMCY is sent in Operational alone.
    pub emergency_in_operational_only: bool,
    /// 1001h keeps its bits when the error is over.
    pub error_register_stuck: bool,
    /// 1001h is always 0.
    pub error_register_blind: bool,
    /// 1012h begins with 0.
    pub time_identifier_lost: bool,
    /// TIME has eight bytes.
    pub time_of_eight_bytes: bool,
    /// TIME goes on when bit 30 of 1012h is cleared.
    pub time_not_stopped: bool,
    /// TIME is produced in Stopped.
    pub time_in_stopped: bool,
    /// TIME has the identifier 100h, whatever 1012h holds.
    pub time_identifier_fixed: bool,
    /// The identifier of TIME changes while TIME is in use.
    pub time_identifier_unprotected: bool,
    /// A TIME that is too short is filled up with zeros.
    pub time_length_unchecked: bool,
    /// The clock does not go on.
    pub time_stands_still: bool,
    /// Bit 31 of 1012h makes no difference: TIME is taken.
    pub time_always_taken: bool,
    /// 1011h takes any value for `load`.
    pub restores_without_signature: bool,
    /// The signatures are taken and refused with their bytes in the other order.
    pub signatures_reversed: bool,
    /// `load` changes the parameters at once.
    pub restores_at_once: bool,
    /// Every sub-index of 1010h saves everything.
    pub store_groups_ignored: bool,
    /// Every sub-index of 1011h restores everything.
    pub restore_groups_ignored: bool,
    /// 1010h reads as what was written there last.
    pub store_shows_signature: bool,
    /// What is saved is gone without power.
    pub stores_in_ram: bool,
    /// PDO parameters are not saved with the others.
    pub pdo_parameters_unsaved: bool,
    /// 1020h is not saved with the others.
    pub configuration_date_unsaved: bool,
    /// What is not saved stays after an NMT reset.
    pub parameters_outlive_reset: bool,
    /// Any identifier may be given to any service.
    pub restricted_identifiers_taken: bool,
    /// Identifiers from 581h on may be given to any service.
    pub high_identifiers_taken: bool,
}

/// What a right slave may do one way or the other.
#[derive(Debug, Clone, Default)]
pub struct Manners {
    /// An empty place of 1003h is refused, and does not read 0.
    pub empty_places_refused: bool,
    /// The first SYNC comes at once.
    pub first_sync_at_once: bool,
    /// An EMCY takes 20 ms to be sent.
    pub emergency_late: bool,
    /// The EMCY of an error that has no end shows the bit of communication errors.
    pub passing_errors_shown: bool,
    /// An RPDO that is too long is used without a word.
    pub long_pdo_unreported: bool,
}
