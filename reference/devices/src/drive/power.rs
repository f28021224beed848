//! The power state machine of CiA 402.

/// A state of the power state machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Power {
    /// Not ready to switch on: the drive initialises.
    #[default]
    NotReady,
    /// Switch on disabled.
    SwitchOnDisabled,
    /// Ready to switch on.
    ReadyToSwitchOn,
    /// Switched on.
    SwitchedOn,
    /// Operation enabled: the motor has torque.
    OperationEnabled,
    /// Quick stop active.
    QuickStopActive,
    /// Fault reaction active.
    FaultReaction,
    /// Fault.
    Fault,
}

impl Power {
    /// Bits 6, 5 and 3 to 0 of the statusword; those of bit 5 that the state leaves open are 0.
    pub(super) const fn bits(self) -> u16 {
        match self {
            Power::NotReady => 0x00,
            Power::SwitchOnDisabled => 0x40,
            Power::ReadyToSwitchOn => 0x21,
            Power::SwitchedOn => 0x23,
            Power::OperationEnabled => 0x27,
            Power::QuickStopActive => 0x07,
            Power::FaultReaction => 0x0F,
            Power::Fault => 0x08,
        }
    }

    pub(super) const fn name(self) -> &'static str {
        match self {
            Power::NotReady => "not ready to switch on",
            Power::SwitchOnDisabled => "switch on disabled",
            Power::ReadyToSwitchOn => "ready to switch on",
            Power::SwitchedOn => "switched on",
            Power::OperationEnabled => "operation enabled",
            Power::QuickStopActive => "quick stop active",
            Power::FaultReaction => "fault reaction active",
            Power::Fault => "fault",
        }
    }

    /// Whether the motor may have torque.
    pub(super) const fn is_powered(self) -> bool {
        matches!(self, Power::OperationEnabled | Power::QuickStopActive)
    }

    /// The state after `command`, and the same one where the command is not for it.
    ///
    /// | from | command | transition |
    /// | --- | --- | --- |
    /// | switch on disabled | shutdown | 2 |
    /// | ready to switch on | switch on, and enable operation with 4 behind it | 3 |
    /// | switched on | enable operation | 4 |
    /// | operation enabled | disable operation, which is coded as switch on | 5 |
    /// | switched on, operation enabled | shutdown | 6, 8 |
    /// | ready to switch on, switched on | quick stop, disable voltage | 7, 10 |
    /// | operation enabled, quick stop active | disable voltage | 9, 12 |
    /// | operation enabled | quick stop | 11 |
    /// | quick stop active | enable operation | 16 |
    pub(super) const fn after(self, command: Command) -> Power {
        match (self, command) {
            (Power::SwitchOnDisabled, Command::Shutdown)
            | (Power::SwitchedOn | Power::OperationEnabled, Command::Shutdown) => {
                Power::ReadyToSwitchOn
            }
            (Power::ReadyToSwitchOn | Power::OperationEnabled, Command::SwitchOn) => {
                Power::SwitchedOn
            }
            (
                Power::ReadyToSwitchOn | Power::SwitchedOn | Power::QuickStopActive,
                Command::EnableOperation,
            ) => Power::OperationEnabled,
            (
                Power::ReadyToSwitchOn
                | Power::SwitchedOn
                | Power::OperationEnabled
                | Power::QuickStopActive,
                Command::DisableVoltage,
            )
            | (Power::ReadyToSwitchOn | Power::SwitchedOn, Command::QuickStop) => {
                Power::SwitchOnDisabled
            }
            (Power::OperationEnabled, Command::QuickStop) => Power::QuickStopActive,
            _ => self,
        }
    }
}

/// What bits 0 to 3 of the controlword ask for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Command {
    /// Bit 1 is 0.
    DisableVoltage,
    /// Bit 1 is 1, bit 2 is 0.
    QuickStop,
    /// Bits 1 and 2 are 1, bit 0 is 0.
    Shutdown,
    /// Bits 0 to 2 are 1, bit 3 is 0; of an enabled drive this is disable operation.
    SwitchOn,
    /// Bits 0 to 3 are 1.
    EnableOperation,
}

impl Command {
    pub(super) const fn of(controlword: u16) -> Command {
        match controlword & 0x0F {
            word if word & 0x02 == 0 => Command::DisableVoltage,
            word if word & 0x04 == 0 => Command::QuickStop,
            word if word & 0x01 == 0 => Command::Shutdown,
            word if word & 0x08 == 0 => Command::SwitchOn,
            _ => Command::EnableOperation,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Command::{DisableVoltage, EnableOperation, QuickStop, Shutdown, SwitchOn};
    use super::Power::{
        Fault, FaultReaction, NotReady, OperationEnabled, QuickStopActive, ReadyToSwitchOn,
        SwitchOnDisabled, SwitchedOn,
    };
    use super::{Command, Power};

    const COMMANDS: [Command; 5] = [
        DisableVoltage,
        QuickStop,
        Shutdown,
        SwitchOn,
        EnableOperation,
    ];

    /// One row a state, one column a command, in the order of `COMMANDS`.
    #[rustfmt::skip]
    const TABLE: [(Power, [Power; 5]); 8] = [
        (NotReady,         [NotReady; 5]),
        (SwitchOnDisabled, [SwitchOnDisabled, SwitchOnDisabled, ReadyToSwitchOn, SwitchOnDisabled, SwitchOnDisabled]),
        (ReadyToSwitchOn,  [SwitchOnDisabled, SwitchOnDisabled, ReadyToSwitchOn, SwitchedOn,       OperationEnabled]),
        (SwitchedOn,       [SwitchOnDisabled, SwitchOnDisabled, ReadyToSwitchOn, SwitchedOn,       OperationEnabled]),
        (OperationEnabled, [SwitchOnDisabled, QuickStopActive,  ReadyToSwitchOn, SwitchedOn,       OperationEnabled]),
        (QuickStopActive,  [SwitchOnDisabled, QuickStopActive,  QuickStopActive, QuickStopActive,  OperationEnabled]),
        (FaultReaction,    [FaultReaction; 5]),
        (Fault,            [Fault; 5]),
    ];

    #[test]
    fn every_command_in_every_state() {
        for (from, row) in TABLE {
            for (command, to) in COMMANDS.into_iter().zip(row) {
                assert_eq!(from.after(command), to, "{from:?} {command:?}");
            }
        }
    }

    #[test]
    fn commands_by_their_bits() {
        let coded = [
            (0x00, DisableVoltage),
            (0x0D, DisableVoltage),
            (0x02, QuickStop),
            (0x0B, QuickStop),
            (0x06, Shutdown),
            (0x0E, Shutdown),
            (0x07, SwitchOn),
            (0x0F, EnableOperation),
            (0x11F, EnableOperation),
        ];
        for (controlword, command) in coded {
            assert_eq!(Command::of(controlword), command, "{controlword:04X}");
        }
    }
}
