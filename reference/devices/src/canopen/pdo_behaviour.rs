//! How a slave treats its PDOs where devices differ.

use super::Abort;

/// How a slave treats its PDOs. The default conforms to CiA 301.
#[derive(Debug, Clone)]
pub struct PdoBehaviour {
    /// The abort code for what cannot be mapped.
    pub abort_not_mappable: u32,
    /// The abort code for a parameter that must stay as it is for now.
    pub abort_not_now: u32,
    /// The abort code for a mapping that is longer than a PDO.
    pub abort_too_long: u32,

    /// The identifier of a PDO that exists stays as it is.
    pub identifier_locked: bool,
    /// The inhibit time of a PDO that exists stays as it is.
    pub inhibit_time_locked: bool,
    /// The SYNC start value of a PDO that exists stays as it is.
    pub start_value_locked: bool,
    /// A COB-ID of 29 bits is refused, and not only passed over.
    pub extended_identifier_refused: bool,
    /// An identifier that is none of the predefined ones is used.
    pub identifier_used: bool,
    /// A transmission type that is confirmed is stored.
    pub type_stored: bool,
    /// A frame with an identifier of 29 bits is no RPDO.
    pub extended_frames_passed_over: bool,

    /// The mapping of a PDO that exists stays as it is.
    pub mapping_locked: bool,
    /// An entry stays as it is while the count of its mapping is not 0.
    pub entries_locked: bool,
    /// The count of a mapping is checked.
    pub count_checked: bool,
    /// The length of a whole mapping is checked.
    pub length_checked: bool,
    /// What the dictionary does not let into a PDO is not mapped.
    pub mappable_checked: bool,
    /// What a PDO may only read is not received, what it may only write is not sent.
    pub direction_checked: bool,
    /// An object that does not exist is not mapped.
    pub existence_checked: bool,
    /// An entry has the length of its object.
    pub entry_length_checked: bool,
    /// A dummy can be mapped in an RPDO.
    pub dummies_taken: bool,
    /// A dummy cannot be mapped in a TPDO.
    pub dummies_received_only: bool,
    /// An entry that is refused leaves the one that was there.
    pub refused_entry_kept: bool,
    /// A mapping is among the parameters that 1010h stores.
    pub mapping_stored: bool,
    /// Reset communication gives the parameters of PDOs their power-on values.
    pub reset_restores: bool,

    /// An RPDO whose COB-ID has bit 31 is not taken.
    pub invalid_rpdo_passed_over: bool,
    /// An RPDO with fewer bytes than its mapping has is not taken.
    pub short_passed_over: bool,
    /// It is reported (8210h).
    pub short_reported: bool,
    /// Of an RPDO with more bytes than its mapping has the first are taken.
    pub long_taken: bool,
    /// An RPDO that is late is reported (8250h).
    pub deadline_noticed: bool,
    /// Only what has come once can be late.
    pub deadline_from_first: bool,
    /// An event-driven RPDO takes effect at once.
    pub event_rpdo_at_once: bool,
    /// An RPDO of type 0 waits for SYNC.
    pub acyclic_rpdo_waits: bool,
    /// Of several RPDOs before a SYNC the last takes effect.
    pub last_rpdo_counts: bool,
    /// A synchronous RPDO takes effect with SYNC.
    pub rpdo_actuated: bool,

    /// A TPDO of type 0 is sent only after an event.
    pub acyclic_needs_event: bool,
    /// A TPDO of type 0 waits for SYNC.
    pub acyclic_waits_for_sync: bool,
    /// A change of what it carries is an event of an event-driven TPDO.
    pub changes_noticed: bool,
    /// An event that has to wait for the inhibit time is not lost.
    pub inhibited_event_kept: bool,
    /// SYNC does not send an event-driven TPDO.
    pub sync_sends_synchronous_only: bool,
    /// The event timer sends only event-driven TPDOs.
    pub timer_event_driven_only: bool,
    /// An event timer sends its TPDO.
    pub timer_runs: bool,
    /// SYNC does not send a TPDO of type 252 or 253.
    pub sync_sends_no_remote: bool,
    /// A remote frame that may fetch a TPDO does.
    pub remote_answered: bool,
    /// SYNCs are counted up to 240, and not only to 127.
    pub long_ratios_counted: bool,
    /// A synchronous TPDO is not sent on entering Operational.
    pub synchronous_waits_for_first: bool,
    /// Every synchronous TPDO that is due is sent with a SYNC, not only the first.
    pub every_due_sent: bool,
    /// The first object that is mapped has the lowest bits.
    pub mapping_order_kept: bool,
    /// A TPDO has the length of its mapping, and not 8 bytes always.
    pub tpdo_length_kept: bool,
    /// An RPDO is taken only with just its identifier.
    pub identifiers_compared: bool,
    /// What is mapped by default has the length of its object.
    pub default_mapping_right: bool,
    /// Sub-index 0 of a communication parameter is the highest that there is.
    pub sub_indices_right: bool,
    /// A start value is looked at only while SYNC has a counter.
    pub start_value_needs_counter: bool,
    /// A BOOLEAN takes one bit of a PDO.
    pub bits_packed: bool,
    /// A TPDO carries what is there when it is sent, not when it was sent last.
    pub tpdo_fresh: bool,
}

impl PdoBehaviour {
    /// The bits of an identifier that are compared with an RPDO's.
    pub(super) const fn compared(&self) -> u16 {
        if self.identifiers_compared {
            0x7FF
        } else {
            0x7FC
        }
    }

    /// Whether SYNC sends a TPDO of this type above 240: no such type, in a right device.
    pub(super) const fn sent_with_sync(&self, kind: u8) -> bool {
        match kind {
            252 | 253 => !self.sync_sends_no_remote,
            254.. => !self.sync_sends_synchronous_only,
            _ => false,
        }
    }
}

impl Default for PdoBehaviour {
    fn default() -> PdoBehaviour {
        PdoBehaviour {
            abort_not_mappable: Abort::NOT_MAPPABLE.0,
            abort_not_now: Abort::DEVICE_STATE.0,
            abort_too_long: Abort::MAPPING_TOO_LONG.0,
            identifier_locked: true,
            inhibit_time_locked: true,
            start_value_locked: true,
            extended_identifier_refused: true,
            identifier_used: true,
            type_stored: true,
            extended_frames_passed_over: true,
            mapping_locked: true,
            entries_locked: true,
            count_checked: true,
            length_checked: true,
            mappable_checked: true,
            direction_checked: true,
            existence_checked: true,
            entry_length_checked: true,
            dummies_taken: true,
            dummies_received_only: true,
            refused_entry_kept: true,
            mapping_stored: true,
            reset_restores: true,
            invalid_rpdo_passed_over: true,
            short_passed_over: true,
            short_reported: true,
            long_taken: true,
            deadline_noticed: true,
            deadline_from_first: true,
            event_rpdo_at_once: true,
            acyclic_rpdo_waits: true,
            last_rpdo_counts: true,
            rpdo_actuated: true,
            acyclic_needs_event: true,
            acyclic_waits_for_sync: true,
            changes_noticed: true,
            inhibited_event_kept: true,
            sync_sends_synchronous_only: true,
            timer_event_driven_only: true,
            timer_runs: true,
            sync_sends_no_remote: true,
            remote_answered: true,
            long_ratios_counted: true,
            synchronous_waits_for_first: true,
            every_due_sent: true,
            mapping_order_kept: true,
            tpdo_length_kept: true,
            identifiers_compared: true,
            default_mapping_right: true,
            sub_indices_right: true,
            start_value_needs_counter: true,
            bits_packed: true,
            tpdo_fresh: true,
        }
    }
}
