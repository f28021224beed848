//! The NMT slave state machine.

use fieldproof_can::Frame;

use super::Behaviour;
use super::queue::Service;

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
    pub(crate) const fn permits(self, service: Service, behaviour: &Behaviour) -> bool {
        match (self, service) {
            (_, Service::Lss) => true,
            (State::Initialising, _) => matches!(service, Service::BootUp),
            (_, Service::BootUp | Service::ErrorControl) => true,
            (State::Stopped, Service::Sdo) => behaviour.sdo_in_stopped,
            (State::Stopped, _) => false,
            (State::PreOperational, Service::Pdo) => behaviour.pdo_in_pre_operational,
            (State::PreOperational | State::Operational, _) => true,
        }
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
    pub(crate) fn of(frame: &Frame, node: u8) -> Option<Command> {
        let &[command, addressed] = frame.bytes() else {
            return None;
        };
        if addressed != 0 && addressed != node {
            return None;
        }
        Some(match command {
            0x01 => Command::Enter(State::Operational),
            0x02 => Command::Enter(State::Stopped),
            0x80 => Command::Enter(State::PreOperational),
            0x81 => Command::ResetNode,
            0x82 => Command::ResetCommunication,
            _ => return None,
        })
    }
}
