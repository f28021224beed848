//! Everything a step needs: the session, the device's claim, what the case has saved and must put back.

use std::time::Duration;

use fieldproof_can::{Frame, Id, StandardId};
use fieldproof_dictionary::Dictionary;
use fieldproof_link::{CompanionIndex, PortIndex};
use fieldproof_record::{Event, Limits, Measurement, Observation, Verdict};
use fieldproof_suite::device::{DeviceDescription, Feature};
use fieldproof_suite::scalar::ObjectAddress;
use fieldproof_wire::canopen::{Multiplexer, NodeId, Service, cob_id, identify};

use crate::history::History;
use crate::limits::{judge, nanoseconds, show};
use crate::node::NodeWatch;
use crate::session::{Message, Received, Session};
use crate::stop::{Came, Stop};
use crate::undo::UndoStack;
use crate::value::Saved;

/// The port roles of suites.
pub(crate) const CAN: &str = "can";
pub(crate) const SERIAL: &str = "serial";
pub(crate) const TCP: &str = "tcp";

/// Every CANopen device has it, and reading it changes nothing.
pub(crate) const DEVICE_TYPE: Multiplexer = Multiplexer::new(0x1000, 0);

/// How long past its limit an answer is still waited for: so that "late" and "never" can be told apart, and so that a
/// late one is not taken for the answer to what puts the device back.
pub(crate) const LATE_ANSWER: Duration = Duration::from_millis(200);

/// Everything a step needs.
pub(crate) struct Tester<'a> {
    pub(crate) session: Session<'a>,
    pub(crate) device: &'a DeviceDescription,
    pub(crate) dictionary: Option<&'a Dictionary>,
    /// The device's present node-ID.
    pub(crate) node: Option<NodeId>,
    /// The device's present Modbus address.
    pub(crate) address: Option<u8>,
    /// Whether only the strict abort code passes.
    pub(crate) strict: bool,
    pub(crate) watch: NodeWatch,
    pub(crate) saved: Saved,
    pub(crate) undo: UndoStack,
    /// The port that a suite means when it names none.
    pub(crate) main_role: &'static str,
    /// The SYNC producer of the case, if one runs.
    pub(crate) sync_producer: Option<CompanionIndex>,
    /// Its period.
    pub(crate) sync_period: Option<Duration>,
    /// The case says itself how what it changes is put back.
    pub(crate) restores_by_steps: bool,
    /// What the case has done so far.
    pub(crate) history: History,
    /// The last request to an SDO server.
    pub(crate) sdo_request: Option<Frame>,
    /// The object of a segmented or block transfer that has not ended.
    pub(crate) open_transfer: Option<Multiplexer>,
    /// Whether a step of the case itself, not only of its control, has begun.
    pub(crate) steps_begun: bool,
    /// Lines for the report that decide nothing.
    pub(crate) notes: Vec<String>,
}

impl Tester<'_> {
    pub(crate) fn claims(&self, feature: Feature) -> bool {
        self.device.features.contains(&feature)
    }

    pub(crate) fn can_port(&self) -> Result<PortIndex, Stop> {
        self.port(CAN)
    }

    pub(crate) fn port(&self, role: &str) -> Result<PortIndex, Stop> {
        self.session
            .port(role)
            .ok_or_else(|| Stop::Bench(format!("this bench has no port {role:?}")))
    }

    /// The port that Modbus is spoken on: the serial one, or else that of Modbus TCP.
    pub(crate) fn modbus_port(&self) -> Result<PortIndex, Stop> {
        match self.session.port(SERIAL) {
            Some(port) => Ok(port),
            None => self.port(TCP),
        }
    }

    pub(crate) fn node_id(&self) -> Result<NodeId, Stop> {
        self.node
            .ok_or_else(|| Stop::Bench("the device has no node-ID on this bench".into()))
    }

    /// The identifier of a service of the device under test.
    pub(crate) fn identifier(&self, service: Service) -> Result<StandardId, Stop> {
        Ok(cob_id(service, Some(self.node_id()?)))
    }

    /// Sends a frame on the CAN port, and follows what it does to the node.
    pub(crate) fn send_frame(&mut self, frame: Frame) -> Result<(), Stop> {
        let port = self.can_port()?;
        let sent = self.session.send_frame(port, frame)?;
        self.watch.sent(&frame, sent.end, self.node);
        Ok(())
    }

    /// The first CAN frame since the last send with this identifier.
    pub(crate) fn first_frame(
        &mut self,
        id: Id,
        within: Duration,
    ) -> Result<Option<(Frame, Received)>, Stop> {
        let port = self.can_port()?;
        let deadline = self.session.last_sent().end + within + self.session.uncertainty(port);
        let wanted = |received: &Received| {
            received.port == port
                && matches!(received.message, Message::Can(frame) if frame.id() == id)
        };
        let found = self.session.first(deadline, wanted)?;
        let found = found.and_then(|received| match received.message {
            Message::Can(frame) => Some((frame, received)),
            Message::Serial { .. } => None,
        });
        if let Some((frame, received)) = &found
            && frame.standard_id().and_then(identify) == Some((Service::ErrorControl, self.node))
        {
            let within = self.device.timing.sdo_response;
            self.watch.expected_error_control(received.at, within);
        }
        Ok(found)
    }

    /// Records how long something took since the last send, and judges it.
    pub(crate) fn measure(
        &mut self,
        name: &'static str,
        measured: Duration,
        uncertainty: Duration,
        limits: Limits,
    ) -> Result<(), Stop> {
        let verdict = judge(measured, uncertainty, limits);
        self.session.emit(Event::Measurement(Box::new(Measurement {
            at_ns: self.session.now().as_nanos(),
            name: name.into(),
            value_ns: nanoseconds(measured),
            uncertainty_ns: nanoseconds(uncertainty),
            limits,
            verdict,
        })));
        match verdict {
            Verdict::Pass => Ok(()),
            Verdict::Fail => Err(Stop::differs(
                format!("{name} is outside its limits"),
                show_limits(limits),
                show(measured),
                Came::Other,
            )),
            _ => Err(Stop::undecided(
                format!("{name} cannot be decided on this link"),
                show_limits(limits),
                format!("{} ± {}", show(measured), show(uncertainty)),
            )),
        }
    }

    /// Measures from the last send to `at`.
    pub(crate) fn measure_response(
        &mut self,
        name: &'static str,
        received: &Received,
        within: Duration,
    ) -> Result<(), Stop> {
        let measured = received.start.since(self.session.last_sent().end);
        let uncertainty = self.session.uncertainty(received.port);
        self.measure(name, measured, uncertainty, at_most(within))
    }

    pub(crate) fn observe(&mut self, name: &str, value: String) {
        let at_ns = self.session.now().as_nanos();
        self.session.emit(Event::Observation(Box::new(Observation {
            at_ns,
            name: name.into(),
            value,
        })));
    }
}

/// An object of the suite language as the wire has it.
pub(crate) const fn multiplexer(object: ObjectAddress) -> Multiplexer {
    Multiplexer::new(object.index, object.sub)
}

/// An upper limit alone.
pub(crate) fn at_most(limit: Duration) -> Limits {
    Limits {
        min_ns: None,
        max_ns: Some(nanoseconds(limit)),
    }
}

pub(crate) fn show_limits(limits: Limits) -> String {
    let show_ns = |nanoseconds| show(Duration::from_nanos(nanoseconds));
    match (limits.min_ns, limits.max_ns) {
        (None, None) => "any".into(),
        (Some(min), None) => format!("at least {}", show_ns(min)),
        (None, Some(max)) => format!("at most {}", show_ns(max)),
        (Some(min), Some(max)) => format!("{} to {}", show_ns(min), show_ns(max)),
    }
}
