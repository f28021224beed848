//! The faults that a drive can be given, each one departure from CiA 402 or from its manual.

use super::TargetReached;
use super::power::{Command, Power};
use crate::Fault;

/// A fault of the power state machine or of the modes.
const fn fault(
    name: &'static str,
    breaks: &'static str,
    words: &'static str,
    apply: fn(&mut crate::Behaviour),
) -> Fault {
    Fault {
        name,
        breaks,
        words,
        caught_by: "cia402",
        apply,
    }
}

/// Those of every drive.
pub(crate) const COMMON: &[Fault] = &[
    fault(
        "drive-enabled-without-shutdown",
        "CiA 402: switch on disabled is left by shutdown alone",
        "takes 000Fh in switch on disabled and enables the motor",
        |behaviour| {
            behaviour.drive.surplus_transitions = &[(
                Power::SwitchOnDisabled,
                Command::EnableOperation,
                Power::OperationEnabled,
            )];
        },
    ),
    fault(
        "drive-switched-on-without-shutdown",
        "CiA 402: switch on disabled is left by shutdown alone",
        "takes 0007h in switch on disabled and is switched on",
        |behaviour| {
            behaviour.drive.surplus_transitions = &[(
                Power::SwitchOnDisabled,
                Command::SwitchOn,
                Power::SwitchedOn,
            )];
        },
    ),
    fault(
        "drive-shutdown-ignored",
        "CiA 402: transition 2",
        "stays in switch on disabled at 0006h until it has been powered again",
        |behaviour| {
            behaviour.drive.missing_transitions = &[(Power::SwitchOnDisabled, Command::Shutdown)];
        },
    ),
    fault(
        "drive-direct-enable-ignored",
        "CiA 402: switch on and enable operation, transitions 3 and 4",
        "stays in ready to switch on when 000Fh follows 0006h without 0007h between",
        |behaviour| {
            behaviour.drive.missing_transitions =
                &[(Power::ReadyToSwitchOn, Command::EnableOperation)];
        },
    ),
    fault(
        "drive-disable-operation-ignored",
        "CiA 402: transition 5",
        "goes on when it is told to disable operation (0007h)",
        |behaviour| {
            behaviour.drive.missing_transitions = &[(Power::OperationEnabled, Command::SwitchOn)];
        },
    ),
    fault(
        "drive-shutdown-from-switched-on-ignored",
        "CiA 402: transition 6",
        "stays switched on at 0006h",
        |behaviour| {
            behaviour.drive.missing_transitions = &[(Power::SwitchedOn, Command::Shutdown)];
        },
    ),
    fault(
        "drive-shutdown-while-enabled-ignored",
        "CiA 402: transition 8",
        "stays enabled at 0006h",
        |behaviour| {
            behaviour.drive.missing_transitions = &[(Power::OperationEnabled, Command::Shutdown)];
        },
    ),
    fault(
        "drive-ready-state-kept",
        "CiA 402: transitions 7 and 10",
        "stays ready or switched on when bit 1 of the controlword goes",
        |behaviour| {
            behaviour.drive.missing_transitions = &[
                (Power::ReadyToSwitchOn, Command::DisableVoltage),
                (Power::SwitchedOn, Command::DisableVoltage),
            ];
        },
    ),
    fault(
        "drive-quick-stop-at-rest-ignored",
        "CiA 402: transitions 7 and 10",
        "stays ready or switched on at a quick stop (0002h)",
        |behaviour| {
            behaviour.drive.missing_transitions = &[
                (Power::ReadyToSwitchOn, Command::QuickStop),
                (Power::SwitchedOn, Command::QuickStop),
            ];
        },
    ),
    fault(
        "drive-disable-voltage-ignored",
        "CiA 402: transition 9",
        "stays enabled at 0000h",
        |behaviour| {
            behaviour.drive.missing_transitions =
                &[(Power::OperationEnabled, Command::DisableVoltage)];
        },
    ),
    fault(
        "drive-quick-stop-ignored",
        "CiA 402: transition 11",
        "goes on at a quick stop (0002h)",
        |behaviour| {
            behaviour.drive.missing_transitions = &[(Power::OperationEnabled, Command::QuickStop)];
        },
    ),
    fault(
        "drive-fault-left-by-disable-voltage",
        "CiA 402: fault is left by fault reset alone",
        "forgets a fault when the controlword is 0000h",
        |behaviour| {
            behaviour.drive.surplus_transitions = &[(
                Power::Fault,
                Command::DisableVoltage,
                Power::SwitchOnDisabled,
            )];
        },
    ),
    fault(
        "drive-fault-reset-by-level",
        "CiA 402: fault reset is the rising edge of bit 7",
        "resets a fault whenever bit 7 of the controlword is 1, so that a master that leaves it 1 never sees one",
        |behaviour| behaviour.drive.fault_reset_on_edge = false,
    ),
    fault(
        "drive-fault-reset-with-cause",
        "CiA 402: transition 15, no fault is present",
        "leaves fault though what caused it is still there",
        |behaviour| behaviour.drive.fault_waits_for_cause = false,
    ),
    fault(
        "drive-ready-after-fault-reset",
        "CiA 402: transition 15 leads to switch on disabled",
        "is ready to switch on at once after a fault reset, so that 000Fh starts the motor",
        |behaviour| behaviour.drive.after_fault_reset = Power::ReadyToSwitchOn,
    ),
    fault(
        "drive-enabled-through-fault",
        "CiA 402: transitions 13 and 14",
        "tells of a fault by an EMCY and stays in the state it is in",
        |behaviour| behaviour.drive.fault_disables = false,
    ),
    fault(
        "drive-fault-without-emergency",
        "CiA 402: transition 13; CiA 301: EMCY",
        "sends no EMCY when it faults",
        |behaviour| behaviour.drive.fault_reported = false,
    ),
    fault(
        "drive-quick-stop-bit-missing",
        "CiA 402: statusword, bit 5",
        "shows bit 5 of the statusword as 0 though no quick stop is active",
        |behaviour| behaviour.drive.quick_stop_bit_shown = false,
    ),
    fault(
        "drive-commands-by-whole-word",
        "CiA 402: coding of the controlword",
        "knows the controlwords 0000h, 0002h, 0006h, 0007h and 000Fh, and no other with the same bits that matter",
        |behaviour| behaviour.drive.commands_decoded = false,
    ),
    fault(
        "drive-remote-bit-missing",
        "CiA 402: statusword, bit 9",
        "shows that the controlword is not obeyed, and obeys it",
        |behaviour| behaviour.drive.remote_bit_shown = false,
    ),
    fault(
        "drive-voltage-bit-missing",
        "CiA 402: statusword, bit 4",
        "shows no voltage while the motor has torque",
        |behaviour| behaviour.drive.voltage_bit_shown = false,
    ),
    fault(
        "drive-local-control-not-told",
        "CiA 402: statusword, bit 9",
        "shows remote and obeys the controlword while its panel has control",
        |behaviour| behaviour.drive.local_control_told = false,
    ),
    fault(
        "drive-enabled-through-reset",
        "CiA 402: transitions 0 and 1; CiA 301: reset node",
        "keeps the motor enabled when the node is reset",
        |behaviour| behaviour.drive.reset_disables = false,
    ),
    fault(
        "drive-mode-display-stuck",
        "CiA 402: modes of operation display",
        "never changes 6061h",
        |behaviour| behaviour.drive.mode_display_follows = false,
    ),
    fault(
        "drive-any-mode-taken",
        "CiA 402: modes of operation",
        "shows any number that is written to 6060h as its mode",
        |behaviour| behaviour.drive.any_mode_taken = true,
    ),
    fault(
        "drive-set-point-not-acknowledged",
        "CiA 402: profile position, set-point acknowledge",
        "never sets bit 12 for a new set-point",
        |behaviour| behaviour.drive.set_point_acknowledged = false,
    ),
    fault(
        "drive-acknowledge-not-withdrawn",
        "CiA 402: profile position, set-point acknowledge",
        "leaves bit 12 set when bit 4 of the controlword is 0 again",
        |behaviour| behaviour.drive.acknowledge_withdrawn = false,
    ),
    fault(
        "drive-set-point-by-level",
        "CiA 402: profile position, new set-point",
        "takes a set-point with every controlword that has bit 4, not with its rising edge",
        |behaviour| behaviour.drive.set_point_on_edge = false,
    ),
    fault(
        "drive-target-reached-always",
        "CiA 402: statusword, bit 10",
        "says that the target is reached while it is under way",
        |behaviour| behaviour.drive.target_reached = TargetReached::Always,
    ),
    fault(
        "drive-target-reached-never",
        "CiA 402: statusword, bit 10",
        "never says that the target is reached",
        |behaviour| behaviour.drive.target_reached = TargetReached::Never,
    ),
    fault(
        "drive-speed-zero-inverted",
        "CiA 402: profile velocity, speed",
        "sets bit 12 of profile velocity while the motor turns, and clears it at rest",
        |behaviour| behaviour.drive.speed_zero_shown = false,
    ),
    fault(
        "drive-halt-ignored",
        "CiA 402: controlword, bit 8",
        "goes on at halt",
        |behaviour| behaviour.drive.halts = false,
    ),
];

/// Those of a drive with 605Ah and 6502h.
pub(crate) const OPTIONS: &[Fault] = &[
    fault(
        "drive-quick-stop-option-ignored",
        "CiA 402: quick stop option code",
        "is in switch on disabled after a quick stop though 605Ah = 6 has it stay",
        |behaviour| behaviour.drive.quick_stop_option = Some(2),
    ),
    fault(
        "drive-quick-stop-never-ends",
        "CiA 402: quick stop option code; transition 12",
        "stays in quick stop active though 605Ah = 2 ends it",
        |behaviour| behaviour.drive.quick_stop_option = Some(6),
    ),
    fault(
        "drive-quick-stop-left-by-shutdown",
        "CiA 402: quick stop active",
        "goes from quick stop active to ready to switch on at 0006h",
        |behaviour| {
            behaviour.drive.surplus_transitions = &[(
                Power::QuickStopActive,
                Command::Shutdown,
                Power::ReadyToSwitchOn,
            )];
        },
    ),
    fault(
        "drive-quick-stop-kept",
        "CiA 402: transition 12",
        "stays in quick stop active at 0000h",
        |behaviour| {
            behaviour.drive.missing_transitions =
                &[(Power::QuickStopActive, Command::DisableVoltage)];
        },
    ),
    fault(
        "drive-modes-overstated",
        "CiA 402: supported drive modes",
        "has homing among its supported modes (6502h) and does not home",
        |behaviour| behaviour.drive.surplus_modes = 1 << 5,
    ),
];

/// Those of a drive with 603Fh, 606Ch and 6083h.
pub(crate) const VALUES: &[Fault] = &[
    fault(
        "drive-error-code-missing",
        "CiA 402: error code",
        "leaves 603Fh at 0 when it faults",
        |behaviour| behaviour.drive.error_code_shown = false,
    ),
    fault(
        "drive-velocity-without-sign",
        "CiA 402: velocity actual value",
        "shows 606Ch without its sign",
        |behaviour| behaviour.drive.velocity_signed = false,
    ),
    fault(
        "drive-ramp-inverted",
        "the manual of the drive: 6083h is the time for 1000 rpm",
        "takes 6083h as an acceleration, so that a greater value makes a shorter ramp",
        |behaviour| behaviour.drive.ramp_is_time = false,
    ),
];
