//! The NMT slave state machine.

use fieldproof_can::Frame;

use super::queue::Service;
use super::{Behaviour, NmtAddress};

/// The NMT state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum State {
    Initialising,
    PreOperational,
    Operational,
    Stopped,
}

impl State {
    pub(crate) const fn name(self) -> &'static str {
        match self {
            State::Initialising => "initialising",
            State::PreOperational => "pre-operational",
            State::Operational => "operational",
            State::Stopped => "stopped",
        }
    }

    /// The state byte of heartbeat and guarding.
    pub(crate) const fn code(self, behaviour: &Behaviour) -> u8 {
        match self {
            State::Initialising => 0,
            State::PreOperational => behaviour.state_codes.pre_operational,
            State::Operational => behaviour.state_codes.operational,
            State::Stopped => behaviour.state_codes.stopped,
        }
    }

    /// Whether the service works in this state.
    pub(crate) fn permits(self, service: Service, behaviour: &Behaviour) -> bool {
        let exchanged = behaviour.nmt.exchanged == Some((self, service));
        let permits = match (self, service) {
            (_, Service::Lss) => true,
            (State::Initialising, _) => matches!(service, Service::BootUp),
            (_, Service::BootUp | Service::ErrorControl) => true,
            (State::Stopped, Service::Sdo) => behaviour.sdo_in_stopped,
            (State::Stopped, Service::Pdo) => behaviour.pdo_in_stopped,
            (State::Stopped, Service::Sync) => behaviour.departs.sync_in_stopped,
            (State::Stopped, Service::Emergency) => behaviour.departs.emergency_in_stopped,
            (State::Stopped, Service::Time) => behaviour.departs.time_in_stopped,
            (State::PreOperational, Service::Pdo) => behaviour.pdo_in_pre_operational,
            (State::PreOperational, Service::Sync) => !behaviour.departs.sync_in_operational_only,
            (State::PreOperational, Service::Emergency) => {
                !behaviour.departs.emergency_in_operational_only
            }
            (State::PreOperational | State::Operational, _) => true,
        };
        permits != exchanged
    }
}

/// An NMT command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Command {
    Enter(State),
    ResetNode,
    ResetCommunication,
}

impl Command {
    /// The command of `frame` if it is one for `node`.
    ///
    /// | byte | holds |
    /// | --- | --- |
    /// | 0 | 01h start, 02h stop, 80h enter pre-operational, 81h reset node, 82h reset communication |
    /// | 1 | node-ID; 0 means all |
    pub(crate) fn of(frame: &Frame, node: u8, behaviour: &Behaviour) -> Option<Command> {
        let (command, addressed) = match *frame.bytes() {
            [command, addressed] => (command, addressed),
            [command, addressed, ..] if behaviour.nmt.long_commands_taken => (command, addressed),
            [_, _, _, ..] if behaviour.nmt.long_commands_reset => (0x81, node),
            [command] if behaviour.nmt.one_byte_taken => (command, 0),
            _ => return None,
        };
        let meant = match behaviour.nmt_address {
            NmtAddress::All => addressed == 0 || addressed == node,
            NmtAddress::OwnOnly => addressed == node,
            NmtAddress::Any => true,
        };
        if !meant {
            return None;
        }
        Some(match command {
            0x01 => Command::Enter(State::Operational),
            0x02 => Command::Enter(State::Stopped),
            0x80 => Command::Enter(State::PreOperational),
            0x81 => Command::ResetNode,
            0x82 => Command::ResetCommunication,
            _ if behaviour.unknown_nmt_command_stops => Command::Enter(State::Stopped),
            _ => return None,
        })
    }
}
