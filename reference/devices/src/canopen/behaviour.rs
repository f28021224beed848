//! How a slave behaves where devices differ.

use std::ops::Range;

use super::{
    BlockTransfer, Departures, ErrorControlSettings, LssDepartures, Manners, NmtSettings,
    ObjectFault, OrdinaryTransfer, PdoBehaviour, Robustness,
};

/// The settings of a CANopen slave's behaviour. The default conforms to CiA 301 and CiA 305.
#[derive(Debug, Clone)]
pub struct Behaviour {
    /// Bytes 4 to 7 of a download response repeat the data. A documented deviation of one device; reserved otherwise.
    pub echo_download_data: bool,
    /// Microseconds between a request and its answer.
    pub response_us: Range<u64>,
    /// An event-driven TPDO is sent once on entering Operational; it may also wait for its first event.
    pub tpdo_on_start: bool,
    /// A remote frame is answered with the TPDO it names, where bit 30 of the COB-ID allows it; a device may stay
    /// silent.
    pub remote_frames_answered: bool,
    /// A cyclic TPDO is sent with the first SYNC that counts, and not only with the n-th; CiA 301 leaves that open.
    pub tpdo_with_first_sync: bool,
    /// A heartbeat is sent at once when 1017h is written; it may also wait for its first period.
    pub heartbeat_on_write: bool,
    /// SDO block transfer.
    pub block: BlockTransfer,
    /// PDOs.
    pub pdo: PdoBehaviour,
    /// What else a right slave may do one way or the other.
    pub manners: Manners,
    /// Departures from the rules of SYNC, EMCY, TIME, storing and COB-IDs.
    pub departs: Departures,
    /// NMT.
    pub nmt: NmtSettings,
    /// Heartbeat and guarding.
    pub error_control: ErrorControlSettings,
    /// Expedited and segmented SDO transfer.
    pub sdo: OrdinaryTransfer,
    /// Abort codes, and what is said in their place.
    pub abort_codes: &'static [(u32, u32)],
    /// LSS.
    pub lss: LssDepartures,
    /// What frames that mean nothing do to it.
    pub robustness: Robustness,
    /// One value is not as the dictionary says.
    pub object_fault: Option<ObjectFault>,

    /// The boot-up message is sent.
    pub boot_up: bool,
    /// Writing 0 to 1017h ends the heartbeat.
    pub heartbeat_can_be_stopped: bool,
    /// Which NMT commands are obeyed beside those to the own node-ID.
    pub nmt_address: NmtAddress,
    /// An NMT command specifier that does not exist stops the node.
    pub unknown_nmt_command_stops: bool,
    /// The state byte of heartbeat and guarding.
    pub state_codes: StateCodes,
    /// A value beyond the limits of its object is refused.
    pub limits_checked: bool,
    /// A request with an unknown command specifier is refused, and not ignored.
    pub unknown_command_refused: bool,
    /// A number travels in an expedited upload with its most significant byte first.
    pub upload_big_endian: bool,
    /// What bytes 1 to 3 of an abort name.
    pub abort_multiplexer: AbortMultiplexer,
    /// The toggle bit alternates in the answers of a segmented upload.
    pub toggle_alternates: bool,
    /// The size that an expedited upload response gives is one too high, of four bytes one too low.
    pub expedited_size_off_by_one: bool,
    /// An upload after a download gives the value from before it.
    pub upload_lags_download: bool,
    /// A download is confirmed.
    pub download_confirmed: bool,
    /// A mapping entry travels in an SDO with its most significant byte first.
    pub mapping_entry_big_endian: bool,
    /// The SDO server answers in Stopped.
    pub sdo_in_stopped: bool,
    /// PDOs are sent and taken in Pre-operational.
    pub pdo_in_pre_operational: bool,
    /// PDOs are sent and taken in Stopped.
    pub pdo_in_stopped: bool,
    /// A remote frame fetches a TPDO though bit 30 of its COB-ID is set.
    pub remote_bit_ignored: bool,
    /// A synchronous TPDO leaves one SYNC after the one it was due with.
    pub tpdo_one_sync_late: bool,
    /// The toggle bit alternates in the answers of guarding.
    pub guarding_toggles: bool,
    /// Clearing bit 30 of 1005h ends the production of SYNC.
    pub sync_can_be_stopped: bool,
    /// The third byte of an EMCY is the error register.
    pub emergency_shows_register: bool,
    /// SYNCs beyond its transmission type that a cyclic TPDO waits for.
    pub surplus_syncs: u8,
    /// A TPDO is sent though bit 31 of its COB-ID is set.
    pub invalid_tpdo_sent: bool,
    /// A number travels in a TPDO with its most significant byte first.
    pub tpdo_big_endian: bool,
    /// Milliseconds that an event timer counts.
    pub event_timer_unit_ms: u32,
    /// What 1018h holds at sub-indexes 1 to 4 in place of the dictionary's values.
    pub identity: Option<[u32; 4]>,
    /// When a new node-ID takes effect.
    pub node_activation: NodeActivation,
    /// Store configuration stores, and does not only say so.
    pub lss_stores: bool,
    /// The serial number that is named selects or does not select the slave.
    pub lss_serial_matters: bool,
    /// A selection by the whole LSS address is confirmed.
    pub lss_selection_confirmed: bool,
    /// A node-ID or bit timing that there is not is refused, and not only passed over.
    pub lss_configuration_checked: bool,
    /// An index of the bit timing table that is refused though the table has it.
    pub lss_refused_index: Option<u8>,
    /// A number of the identity travels with its most significant byte first.
    pub lss_identity_big_endian: bool,
    /// Activate bit timing switches the bit rate.
    pub lss_activates: bool,
    /// The serial number that is named counts when slaves are to identify themselves.
    pub lss_identify_compares: bool,
    /// A slave that has a node-ID stays out of a fastscan.
    pub lss_fastscan_unconfigured_only: bool,
    /// Transmission types 241 to 251 are taken.
    pub reserved_types_taken: bool,
    /// With transmission type 252 a remote frame fetches what the last SYNC found, not what there is.
    pub remote_sample_kept: bool,
    /// A TPDO carries what there is when it leaves, and not what there was when it was started.
    pub tpdo_refreshed: bool,
    /// A TPDO waits for the SYNC with its start value.
    pub sync_start_value_kept: bool,
    /// A SYNC that is produced has the counter that 1019h asks for.
    pub sync_counter_sent: bool,
    /// A TPDO waits for its inhibit time.
    pub inhibit_time_kept: bool,
    /// An EMCY waits for the inhibit time of 1015h.
    pub emergency_inhibit_kept: bool,
    /// An error is entered in 1003h.
    pub errors_remembered: bool,
    /// Writing 0 to 1003h clears it.
    pub errors_can_be_cleared: bool,
    /// The end of an error is reported with the error code 0.
    pub error_end_reported: bool,
    /// A consumer notices that a heartbeat is missing.
    pub lost_heartbeat_noticed: bool,
    /// A guarded slave notices that its master is missing.
    pub lost_master_noticed: bool,
    /// A communication error has the consequence that 1029h says.
    pub error_behaviour_kept: bool,
    /// A TIME is taken.
    pub time_taken: bool,
    /// `save` written to 1010h saves.
    pub stores: bool,
    /// 1010h takes any value for `save`.
    pub stores_without_signature: bool,
    /// `load` written to 1011h restores the defaults.
    pub restores: bool,
    /// A dummy in a mapping takes its bits of a PDO.
    pub dummies_take_room: bool,
    /// A synchronous RPDO waits for SYNC.
    pub rpdo_waits_for_sync: bool,
    /// The command specifier of the answer to inquire revision number.
    pub lss_revision_specifier: u8,
}

/// What bytes 1 to 3 of an abort name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AbortMultiplexer {
    /// The object that was asked for.
    OfRequest,
    /// The object at the next index.
    NextIndex,
    /// What bytes 1 to 3 of the request name, though a segment names nothing there.
    OfFrame,
}

/// Which NMT commands are obeyed beside those to the own node-ID.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NmtAddress {
    /// Those to all nodes.
    All,
    /// None.
    OwnOnly,
    /// Those to any node.
    Any,
}

/// When a new node-ID takes effect.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NodeActivation {
    /// At the next reset.
    AtReset,
    /// With the answer to the request that set it.
    AtOnce,
}

/// The state byte of heartbeat and guarding.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StateCodes {
    /// Stopped: 04h.
    pub stopped: u8,
    /// Operational: 05h.
    pub operational: u8,
    /// Pre-operational: 7Fh.
    pub pre_operational: u8,
}

impl StateCodes {
    /// As CiA 301 has them.
    pub const STANDARD: StateCodes = StateCodes {
        stopped: 0x04,
        operational: 0x05,
        pre_operational: 0x7F,
    };
}

impl Default for Behaviour {
    fn default() -> Behaviour {
        Behaviour {
            echo_download_data: false,
            response_us: 150..350,
            tpdo_on_start: true,
            remote_frames_answered: true,
            tpdo_with_first_sync: false,
            heartbeat_on_write: false,
            block: BlockTransfer::default(),
            pdo: PdoBehaviour::default(),
            manners: Manners::default(),
            departs: Departures::default(),
            nmt: NmtSettings::default(),
            error_control: ErrorControlSettings::default(),
            sdo: OrdinaryTransfer::default(),
            abort_codes: &[],
            lss: LssDepartures::default(),
            robustness: Robustness::default(),
            object_fault: None,
            boot_up: true,
            heartbeat_can_be_stopped: true,
            nmt_address: NmtAddress::All,
            unknown_nmt_command_stops: false,
            limits_checked: true,
            unknown_command_refused: true,
            upload_big_endian: false,
            surplus_syncs: 0,
            invalid_tpdo_sent: false,
            tpdo_big_endian: false,
            event_timer_unit_ms: 1,
            identity: None,
            lss_stores: true,
            lss_serial_matters: true,
            lss_selection_confirmed: true,
            lss_configuration_checked: true,
            lss_refused_index: None,
            lss_identity_big_endian: false,
            state_codes: StateCodes::STANDARD,
            abort_multiplexer: AbortMultiplexer::OfRequest,
            toggle_alternates: true,
            expedited_size_off_by_one: false,
            upload_lags_download: false,
            download_confirmed: true,
            mapping_entry_big_endian: false,
            sdo_in_stopped: false,
            pdo_in_pre_operational: false,
            pdo_in_stopped: false,
            remote_bit_ignored: false,
            tpdo_one_sync_late: false,
            guarding_toggles: true,
            sync_can_be_stopped: true,
            emergency_shows_register: true,
            node_activation: NodeActivation::AtReset,
            lss_revision_specifier: 0x5C,
            lss_activates: true,
            lss_identify_compares: true,
            lss_fastscan_unconfigured_only: true,
            reserved_types_taken: false,
            remote_sample_kept: true,
            tpdo_refreshed: true,
            sync_start_value_kept: true,
            sync_counter_sent: true,
            inhibit_time_kept: true,
            emergency_inhibit_kept: true,
            errors_remembered: true,
            errors_can_be_cleared: true,
            error_end_reported: true,
            lost_heartbeat_noticed: true,
            lost_master_noticed: true,
            error_behaviour_kept: true,
            time_taken: true,
            stores: true,
            stores_without_signature: false,
            restores: true,
            dummies_take_room: true,
            rpdo_waits_for_sync: true,
        }
    }
}
