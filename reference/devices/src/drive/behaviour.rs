//! How a drive behaves where drives differ.

use std::time::Duration;

use super::power::{Command, Power};

/// The settings of a drive's behaviour. The default conforms to CiA 402.
#[derive(Debug, Clone)]
pub struct Behaviour {
    /// From enable operation to operation enabled: a brake opens meanwhile.
    pub enabling: Duration,
    /// Enable operation in ready to switch on goes on to operation enabled; older editions end in switched on.
    pub enables_directly: bool,
    /// Enable operation leaves quick stop active; the standard advises against it.
    pub quick_stop_resumable: bool,
    /// Bit 5 of the statusword where the state leaves it open.
    pub quick_stop_bit_at_rest: bool,
    /// From a new mode of operation to its display.
    pub mode_switching: Duration,
    /// A mode of operation that there is not is refused, and not only passed over.
    pub unsupported_mode_refused: bool,

    /// Transitions that there are not.
    pub missing_transitions: &'static [(Power, Command)],
    /// Transitions that there should not be.
    pub surplus_transitions: &'static [(Power, Command, Power)],
    /// What follows a quick stop, whatever 605Ah says.
    pub quick_stop_option: Option<u32>,
    /// A command is known by the bits that matter to it, and not by the whole low half byte.
    pub commands_decoded: bool,
    /// Bit 9 of the statusword says that the controlword is obeyed.
    pub remote_bit_shown: bool,
    /// Bit 5 of the statusword is 1 but while a quick stop is active.
    pub quick_stop_bit_shown: bool,
    /// Bit 4 of the statusword says that there is voltage.
    pub voltage_bit_shown: bool,
    /// Bit 9 of the statusword is 0 while the panel has control, and no controlword is obeyed.
    pub local_control_told: bool,
    /// A fault takes the torque away.
    pub fault_disables: bool,
    /// A fault is told by an EMCY.
    pub fault_reported: bool,
    /// What 603Fh has beside the error code of the EMCY: the difference of both.
    pub error_code_difference: u16,
    /// 603Fh has the error code of a fault.
    pub error_code_shown: bool,
    /// Fault reset is the rising edge of bit 7.
    pub fault_reset_on_edge: bool,
    /// A fault whose cause is still there stays.
    pub fault_waits_for_cause: bool,
    /// The state after a fault reset.
    pub after_fault_reset: Power,
    /// A reset of the node takes the torque away.
    pub reset_disables: bool,
    /// 6061h follows 6060h.
    pub mode_display_follows: bool,
    /// A mode of operation that there is not is taken and displayed.
    pub any_mode_taken: bool,
    /// Modes that 6502h has beside those there are.
    pub surplus_modes: u32,
    /// A new set-point is acknowledged by bit 12.
    pub set_point_acknowledged: bool,
    /// The acknowledge ends with bit 4 of the controlword.
    pub acknowledge_withdrawn: bool,
    /// A new set-point begins with the rising edge of bit 4, and not with any controlword that has it.
    pub set_point_on_edge: bool,
    /// What bit 10 shows.
    pub target_reached: TargetReached,
    /// Bit 12 of profile velocity says that the speed is zero, and not the contrary.
    pub speed_zero_shown: bool,
    /// Bit 8 of the controlword halts the axis.
    pub halts: bool,
    /// The actual velocity has the sign of the target.
    pub velocity_signed: bool,
    /// 6083h is a time, as the manual of its drive has it, and not an acceleration.
    pub ramp_is_time: bool,
}

/// What bit 10 of the statusword shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TargetReached {
    /// Whether the target is reached.
    Honest,
    /// That it is.
    Always,
    /// That it is not.
    Never,
}

impl Default for Behaviour {
    fn default() -> Behaviour {
        Behaviour {
            enabling: Duration::ZERO,
            enables_directly: true,
            quick_stop_resumable: true,
            quick_stop_bit_at_rest: false,
            mode_switching: Duration::ZERO,
            unsupported_mode_refused: true,
            missing_transitions: &[],
            surplus_transitions: &[],
            quick_stop_option: None,
            commands_decoded: true,
            remote_bit_shown: true,
            quick_stop_bit_shown: true,
            voltage_bit_shown: true,
            local_control_told: true,
            fault_disables: true,
            fault_reported: true,
            error_code_difference: 0,
            error_code_shown: true,
            fault_reset_on_edge: true,
            fault_waits_for_cause: true,
            after_fault_reset: Power::SwitchOnDisabled,
            reset_disables: true,
            mode_display_follows: true,
            any_mode_taken: false,
            surplus_modes: 0,
            set_point_acknowledged: true,
            acknowledge_withdrawn: true,
            set_point_on_edge: true,
            target_reached: TargetReached::Honest,
            speed_zero_shown: true,
            halts: true,
            velocity_signed: true,
            ramp_is_time: true,
        }
    }
}
