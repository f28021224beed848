//! What came and nothing expected: a fault on SDO, LSS, error control and Modbus, a note on EMCY and PDO.

use std::collections::BTreeMap;
use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::{Instant, Origin, PortIndex};
use fieldproof_suite::model::{Forbidden, NmtState};
use fieldproof_wire::canopen::nmt::State;
use fieldproof_wire::canopen::{NodeId, Service, identify};
use fieldproof_wire::describe::describe_frame;

use crate::modbus::show_bytes;
use crate::node::NodeWatch;
use crate::session::{Message, Received};
use crate::stop::{Came, Stop};
use crate::tester::{SERIAL, TCP, Tester};

/// What an unexpected frame amounts to.
enum Judgement {
    /// Nothing: a heartbeat as it should be, traffic of others.
    Proper,
    /// A PDO under this identifier, to be counted.
    Pdo(u32),
    /// A line in the report.
    Noted(String),
    /// A fault.
    Wrong(Stop),
}

impl Tester<'_> {
    /// Judges everything that came and nothing expected; the first fault ends it.
    pub(crate) fn judge_unexpected(&mut self, forbids: &[Forbidden]) -> Result<(), Stop> {
        let mut pdos: BTreeMap<u32, usize> = BTreeMap::new();
        for received in self.session.take_unexpected() {
            if self.is_optional_answer(&received) {
                continue;
            }
            match self.judge_one(&received, forbids) {
                Judgement::Proper => {}
                Judgement::Pdo(id) => *pdos.entry(id).or_default() += 1,
                Judgement::Noted(text) => self.notes.push(text),
                Judgement::Wrong(stop) => return Err(stop),
            }
        }
        // One line for all of them: a device that sends PDOs sends many.
        self.notes
            .extend(pdos.into_iter().map(|(id, count)| match count {
                1 => format!("a PDO on {id:03X}h that no step expected"),
                _ => format!("{count} PDOs on {id:03X}h that no step expected"),
            }));
        Ok(())
    }

    fn judge_one(&self, received: &Received, forbids: &[Forbidden]) -> Judgement {
        if received.origin != Origin::Bus {
            return Judgement::Proper;
        }
        match &received.message {
            Message::Can(frame) => self.judge_frame(frame, received.at, forbids),
            Message::Serial { bytes, .. } if self.is_master_on(received.port) => {
                Judgement::Wrong(unexpected("Modbus frame", &show_bytes(bytes), Came::Answer))
            }
            // Behind a gateway the device is the master and may ask what it likes.
            Message::Serial { .. } => Judgement::Proper,
        }
    }

    /// Whether the device only answers there.
    fn is_master_on(&self, port: PortIndex) -> bool {
        let name = self.session.port_name(port);
        name == SERIAL || name == TCP || self.session.is_connection(port)
    }

    fn judge_frame(&self, frame: &Frame, at: Instant, forbids: &[Forbidden]) -> Judgement {
        let Some((service, node)) = frame.standard_id().and_then(identify) else {
            return Judgement::Proper;
        };
        let from_device = node.is_none() || node == self.node;
        let show = || format!("{frame}  {}", describe_frame(frame));
        match service {
            Service::SdoResponse if from_device => {
                Judgement::Wrong(unexpected("SDO answer", &show(), Came::Frame(*frame)))
            }
            Service::LssResponse => {
                Judgement::Wrong(unexpected("LSS answer", &show(), Came::Frame(*frame)))
            }
            Service::ErrorControl => self.judge_error_control(frame, at, node),
            Service::Emergency if from_device && forbids.contains(&Forbidden::Emergency) => {
                Judgement::Wrong(unexpected("EMCY", &show(), Came::Frame(*frame)))
            }
            Service::TransmitPdo(_) if from_device && forbids.contains(&Forbidden::Pdo) => {
                Judgement::Wrong(unexpected("PDO", &show(), Came::Frame(*frame)))
            }
            Service::Emergency if from_device => Judgement::Noted(show()),
            Service::TransmitPdo(_) if from_device => Judgement::Pdo(frame.id().raw()),
            _ => Judgement::Proper,
        }
    }

    /// An answer to a guarding request that no step expected, with a state that the node may have: whether a node with a
    /// heartbeat or without a guard time answers is its own affair.
    fn is_optional_answer(&mut self, received: &Received) -> bool {
        let Message::Can(frame) = &received.message else {
            return false;
        };
        let service = frame.standard_id().and_then(identify);
        let own = self.node.is_some() && service == Some((Service::ErrorControl, self.node));
        let (Some(at), [state]) = (own.then_some(received.at), frame.bytes()) else {
            return false;
        };
        let known = nmt_state(*state).is_some_and(|state| {
            let transition = self.device.timing.nmt_transition;
            self.watch.agrees(state, at, transition)
        });
        known
            && self
                .watch
                .takes_guarding_answer(at, self.device.timing.sdo_response)
    }

    fn judge_error_control(&self, frame: &Frame, at: Instant, node: Option<NodeId>) -> Judgement {
        let transition = self.device.timing.nmt_transition;
        if is_proper_heartbeat(frame, at, &self.watch, self.node, transition) {
            return Judgement::Proper;
        }
        let show = format!("{frame}  {}", describe_frame(frame));
        // The boot-up of a node that was reset is due, only not waited for.
        if frame.bytes() == [0] && self.watch.boot_up_due {
            return Judgement::Proper;
        }
        // Others on the bus live their own lives; a boot-up is worth a line, for it may be the device under a wrong ID.
        if node != self.node {
            return match frame.bytes() {
                [0] => Judgement::Noted(show),
                _ => Judgement::Proper,
            };
        }
        Judgement::Wrong(unexpected(
            "error control message",
            &show,
            Came::Frame(*frame),
        ))
    }
}

/// Whether a frame is a heartbeat of the node that is on, with the state that the node was told to be in.
pub(crate) fn is_proper_heartbeat(
    frame: &Frame,
    at: Instant,
    watch: &NodeWatch,
    node: Option<NodeId>,
    transition: Duration,
) -> bool {
    let Some((Service::ErrorControl, from)) = frame.standard_id().and_then(identify) else {
        return false;
    };
    let [state] = frame.bytes() else { return false };
    // Bit 7 belongs to guarding.
    let Some(state) = nmt_state(*state).filter(|_| *state < 0x80) else {
        return false;
    };
    from == node && watch.had_heartbeat(at) && watch.agrees(state, at, transition)
}

/// The state that a byte of error control names; bit 7 is not part of it.
pub(crate) const fn nmt_state(code: u8) -> Option<NmtState> {
    match State::from_code(code) {
        State::Stopped => Some(NmtState::Stopped),
        State::Operational => Some(NmtState::Operational),
        State::PreOperational => Some(NmtState::PreOperational),
        _ => None,
    }
}

fn unexpected(kind: &str, came: &str, what: Came) -> Stop {
    Stop::mismatch(
        match &what {
            Came::Frame(frame) => format!("an unexpected {kind} came: {}", describe_frame(frame)),
            _ => format!("an unexpected {kind} came: {came}"),
        },
        "nothing more",
        came,
        what,
    )
}
