//! How an NMT slave behaves where devices differ.

use std::ops::RangeInclusive;

use super::nmt::{Command, State};
use super::queue::Service;

/// How an NMT slave behaves. The default conforms to CiA 301.
#[derive(Debug, Clone)]
pub struct NmtSettings {
    /// A command with more than two bytes is taken by its first two; it may also be ignored.
    pub long_commands_taken: bool,

    /// A command that is not obeyed in this state.
    pub(crate) ignored: Option<(State, Command)>,
    /// A service that works in this state where it must not, or does not work where it must.
    pub(crate) exchanged: Option<(State, Service)>,
    /// A command of one byte is taken for one to all nodes.
    pub one_byte_taken: bool,
    /// A command with more than two bytes resets the node.
    pub long_commands_reset: bool,
    /// A frame with the 29-bit identifier 0 is taken for an NMT command.
    pub extended_identifier_taken: bool,
    /// SDO requests are done in Stopped, though not answered.
    pub requests_done_in_stopped: bool,
    /// Boot-up messages after a reset: 1.
    pub boot_ups: u8,
    /// The node-ID with which there are none.
    pub no_boot_up_at: Option<u8>,
    /// The byte of the boot-up message: 0.
    pub boot_up_byte: u8,
    /// A heartbeat comes before the boot-up message.
    pub heartbeat_before_boot_up: bool,
    /// The boot-up message is sent after a reset of the communication, too.
    pub boot_up_after_reset_communication: bool,
    /// The boot-up message is sent again with every command that leads to Pre-operational.
    pub boot_up_repeated: bool,
    /// It becomes operational with no command.
    pub starts_itself: bool,
    /// The objects that reset node gives the values of power-on: all.
    pub restored_by_reset_node: RangeInclusive<u16>,
    /// The objects that reset communication gives the values of power-on: 1000h to 1FFFh.
    pub restored_by_reset_communication: RangeInclusive<u16>,
}

impl Default for NmtSettings {
    fn default() -> NmtSettings {
        NmtSettings {
            long_commands_taken: false,
            ignored: None,
            exchanged: None,
            one_byte_taken: false,
            long_commands_reset: false,
            extended_identifier_taken: false,
            requests_done_in_stopped: false,
            boot_ups: 1,
            no_boot_up_at: None,
            boot_up_byte: 0,
            heartbeat_before_boot_up: false,
            boot_up_after_reset_communication: true,
            boot_up_repeated: false,
            starts_itself: false,
            restored_by_reset_node: 0x0000..=0xFFFF,
            restored_by_reset_communication: 0x1000..=0x1FFF,
        }
    }
}
