//! What is heard on a CAN bus without asking.

use std::collections::BTreeMap;
use std::time::Duration;

use fieldproof_can::{Frame, Id};
use fieldproof_link::Instant;
use fieldproof_wire::canopen::emergency::{Emergency, ErrorCode};
use fieldproof_wire::canopen::error_control::ErrorControl;
use fieldproof_wire::canopen::nmt::State;
use fieldproof_wire::canopen::{NodeId, Service, identify};

/// What nodes send by themselves.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Traffic {
    /// By node: what its error control and its EMCY say.
    pub nodes: BTreeMap<NodeId, HeardFrom>,
    /// Identifiers of other frames that nobody asked for, in the order of arbitration: 11 bits before 29.
    pub identifiers: Vec<HeardIdentifier>,
    /// How often the tester's own controller told of trouble on the bus.
    pub bus_errors: u32,
}

/// What a node says by itself.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct HeardFrom {
    /// It booted.
    pub boot_up: bool,
    /// The state in its last heartbeat.
    pub state: Option<State>,
    /// Between its last two heartbeats.
    pub period: Option<Duration>,
    /// Its last EMCY, by the predefined identifier.
    pub emergency: Option<ErrorCode>,
    last_heartbeat: Option<Instant>,
}

/// An identifier that frames were heard on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HeardIdentifier {
    /// The identifier.
    pub id: Id,
    /// How many frames.
    pub frames: u32,
}

impl HeardIdentifier {
    /// Whose it is in the predefined connection set.
    pub fn service(&self) -> Option<(Service, Option<NodeId>)> {
        service(self.id)
    }
}

fn service(id: Id) -> Option<(Service, Option<NodeId>)> {
    match id {
        Id::Standard(id) => identify(id),
        Id::Extended(_) => None,
    }
}

impl Traffic {
    /// A frame that another sent arrived at `at`.
    pub(super) fn hear(&mut self, at: Instant, frame: &Frame) {
        if let Ok((node, said)) = ErrorControl::parse(frame) {
            // Who guards it is not the node itself.
            if said != ErrorControl::GuardRequest {
                self.nodes.entry(node).or_default().hear(at, said);
            }
            return;
        }
        if let Ok((node, emergency)) = Emergency::parse(frame) {
            self.nodes.entry(node).or_default().emergency = Some(emergency.code);
            return;
        }
        // Answers are somebody's whom they were given to.
        if let Some((Service::SdoResponse | Service::LssResponse, _)) = service(frame.id()) {
            return;
        }
        let key = |id: Id| (id.is_extended(), id.raw());
        let place = self
            .identifiers
            .binary_search_by_key(&key(frame.id()), |heard| key(heard.id));
        match place {
            Ok(place) => self.identifiers[place].frames += 1,
            Err(place) => {
                let heard = HeardIdentifier {
                    id: frame.id(),
                    frames: 1,
                };
                self.identifiers.insert(place, heard);
            }
        }
    }
}

impl HeardFrom {
    fn hear(&mut self, at: Instant, said: ErrorControl) {
        match said {
            ErrorControl::GuardRequest => {}
            ErrorControl::BootUp => self.boot_up = true,
            ErrorControl::Status { state, .. } => {
                self.period = self.last_heartbeat.map(|last| at.since(last));
                self.last_heartbeat = Some(at);
                self.state = Some(state);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_tell_of_nodes_and_of_identifiers() {
        let mut traffic = Traffic::default();
        let frames = [
            "705#00",
            "705#7F",
            "18FEF100#00",
            "1A5#0102",
            "705#05",
            "706#R1",
            "085#3081010000000000",
            "1A5#0304",
            "085#0000",
            "585#6000180000000000",
        ];
        for (number, frame) in frames.iter().enumerate() {
            let at = Instant::from_nanos(number as u64 * 1_000_000);
            traffic.hear(at, &frame.parse().expect("a frame"));
        }
        assert_eq!(traffic.nodes.len(), 1);
        let node = &traffic.nodes[&NodeId::new(5).expect("a node-ID")];
        assert!(node.boot_up);
        assert_eq!(node.state, Some(State::Operational));
        assert_eq!(node.period, Some(Duration::from_millis(3)));
        assert_eq!(node.emergency, Some(ErrorCode::HEARTBEAT));
        let heard: Vec<(u32, u32)> = traffic
            .identifiers
            .iter()
            .map(|heard| (heard.id.raw(), heard.frames))
            .collect();
        // An EMCY of another length is none.
        assert_eq!(heard, [(0x085, 1), (0x1A5, 2), (0x18FE_F100, 1)]);
        let service = traffic.identifiers[1].service();
        assert_eq!(service.and_then(|(_, node)| node), NodeId::new(0x25));
    }
}
