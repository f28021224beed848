//! Finds the device when a lane begins: whether it is there, and in which NMT state. Another master may have left it in
//! any; a node that is right must not be blamed for that.

use std::time::Duration;

use fieldproof_can::{Frame, Id};
use fieldproof_link::Instant;
use fieldproof_suite::device::Feature;
use fieldproof_suite::model::NmtState;
use fieldproof_wire::canopen::{Multiplexer, Service, identify};

use crate::node::HEARTBEAT;
use crate::sdo::Outcome;
use crate::session::Message;
use crate::stop::Stop;
use crate::tester::{DEVICE_TYPE, Tester};
use crate::unexpected::nmt_state;

const GUARD_TIME: Multiplexer = Multiplexer::new(0x100C, 0);
const LIFE_TIME_FACTOR: Multiplexer = Multiplexer::new(0x100D, 0);

/// How long a device is listened to between two looks whether it answers.
const PROBE: Duration = Duration::from_millis(100);

/// A heartbeat that takes longer is not waited for.
const LONGEST_HEARTBEAT: Duration = Duration::from_secs(10);

/// How a node was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Found {
    /// The state it was in, as far as that could be seen.
    state: Option<NmtState>,
}

/// The state that every case finds the node in.
pub(crate) const PLAYED_IN: NmtState = NmtState::PreOperational;

impl Tester<'_> {
    /// Waits until a CANopen device is there, for it may have been powered with the lane, and boots first then; and brings
    /// it into the state that cases find it in. `None` for what has no NMT state, or if the link fails.
    pub(crate) fn find_device(&mut self) -> Option<Found> {
        if self.node.is_none() || !self.claims(Feature::NmtSlave) {
            return None;
        }
        let found = self.look().ok();
        self.session.begin_case();
        found
    }

    fn look(&mut self) -> Result<Found, Stop> {
        let mut heard = None;
        let answers = self.await_answer(&mut heard)?;
        if answers {
            self.read_heartbeat(&mut heard)?;
            self.ask_for_state(&mut heard)?;
        }
        if answers && heard == Some(PLAYED_IN) {
            let now = self.session.now();
            self.watch.found(PLAYED_IN, now);
        } else {
            self.command_into(PLAYED_IN)?;
            let settled = self.session.now() + self.device.timing.nmt_transition;
            self.session.collect_until(settled)?;
        }
        // A node in Stopped answers no SDO request; whether this was why is seen now.
        if !answers && self.claims(Feature::SdoServer) && self.is_answered()? {
            heard = Some(NmtState::Stopped);
            self.read_heartbeat(&mut heard)?;
        }
        Ok(Found { state: heard })
    }

    /// Leaves the node in the state it was found in. If the link is down that cannot be helped.
    pub(crate) fn leave_device(&mut self, found: Found) {
        if let Some(state) = found.state.filter(|state| *state != PLAYED_IN) {
            self.session.uninterruptible = true;
            let left = self.command_into(state);
            let _ = left.and_then(|_| self.session.settle());
            self.session.uninterruptible = false;
        }
    }

    /// A reset forgets what was not stored. What tells most of a node, and what others on its bus may rely on, is given
    /// back at once: its heartbeat.
    pub(crate) fn give_heartbeat_back(&mut self) -> Result<(), Stop> {
        let Some(milliseconds) = self.watch.forgotten_heartbeat() else {
            return Ok(());
        };
        let value = milliseconds.to_le_bytes();
        if self.number_in(HEARTBEAT)? == Some(milliseconds) {
            self.watch.wrote(HEARTBEAT, &value);
            return Ok(());
        }
        let within = self.device.timing.sdo_response;
        self.sdo_download(HEARTBEAT, &value, within).map(drop)
    }

    /// Whether it answers SDO requests before it must have booted.
    fn await_answer(&mut self, heard: &mut Option<NmtState>) -> Result<bool, Stop> {
        let patience = self.session.now() + self.device.timing.boot_up;
        loop {
            let next = self.session.now() + PROBE;
            self.listen_until(next, heard)?;
            if self.is_answered()? {
                return Ok(true);
            }
            // Silent for longer than it may take to boot: the cases will say what is wrong with it.
            if self.session.now() >= patience {
                return Ok(false);
            }
        }
    }

    fn is_answered(&mut self) -> Result<bool, Stop> {
        match self.sdo_upload(DEVICE_TYPE, self.device.timing.sdo_response) {
            Ok(_) => Ok(true),
            Err(Stop::Mismatch(_) | Stop::Undecided(_)) => Ok(false),
            Err(stop) => Err(stop),
        }
    }

    /// A node that produces heartbeats says its state.
    fn read_heartbeat(&mut self, heard: &mut Option<NmtState>) -> Result<(), Stop> {
        if !self.claims(Feature::HeartbeatProducer) {
            return Ok(());
        }
        let Some(milliseconds) = self.number_in(HEARTBEAT)? else {
            return Ok(());
        };
        self.watch.found_heartbeat(milliseconds);
        let period = Duration::from_millis(u64::from(milliseconds));
        if heard.is_none() && !period.is_zero() && period <= LONGEST_HEARTBEAT {
            let next = self.session.now() + period * 3 / 2;
            self.listen_until(next, heard)?;
        }
        Ok(())
    }

    /// One guarding request, where that does not make the node watch for more of them.
    fn ask_for_state(&mut self, heard: &mut Option<NmtState>) -> Result<(), Stop> {
        if heard.is_some() || self.watch.heartbeat || !self.claims(Feature::NodeGuarding) {
            return Ok(());
        }
        let (Some(guard_time), Some(factor)) = (
            self.number_in(GUARD_TIME)?,
            self.number_in(LIFE_TIME_FACTOR)?,
        ) else {
            return Ok(());
        };
        let id = self.identifier(Service::ErrorControl)?;
        let Some(request) = Frame::remote(id, 1).filter(|_| guard_time == 0 || factor == 0) else {
            return Ok(());
        };
        self.send_frame(request)?;
        let within = self.device.timing.sdo_response;
        if let Some((frame, _)) = self.first_frame(Id::Standard(id), within)? {
            // Bit 7 is the toggle bit.
            let state = frame.bytes().first();
            *heard = state.and_then(|byte| nmt_state(byte & 0x7F));
        }
        Ok(())
    }

    /// The first two bytes of an object, where it can be read.
    fn number_in(&mut self, object: Multiplexer) -> Result<Option<u16>, Stop> {
        let value = match self.sdo_upload(object, self.device.timing.sdo_response) {
            Ok(Outcome::Done(value)) => value,
            Ok(Outcome::Refused(_)) | Err(Stop::Mismatch(_) | Stop::Undecided(_)) => {
                return Ok(None);
            }
            Err(stop) => return Err(stop),
        };
        Ok(match value.of_size(Some(2)) {
            [low, high, ..] => Some(u16::from_le_bytes([*low, *high])),
            [low] => Some(u16::from(*low)),
            [] => None,
        })
    }

    /// Takes down what the node says of itself until `instant`.
    fn listen_until(&mut self, instant: Instant, heard: &mut Option<NmtState>) -> Result<(), Stop> {
        self.session.collect_until(instant)?;
        for received in self.session.take_unexpected() {
            let Message::Can(frame) = received.message else {
                continue;
            };
            match frame.standard_id().and_then(identify) {
                Some((Service::ErrorControl, from)) if from == self.node => {
                    *heard = state_in(&frame).or(*heard);
                }
                Some((Service::TransmitPdo(_), from)) if from == self.node => {
                    *heard = Some(NmtState::Operational);
                }
                _ => {}
            }
        }
        Ok(())
    }
}

/// The state that a frame of error control tells: a boot-up means Pre-operational.
fn state_in(frame: &Frame) -> Option<NmtState> {
    match frame.bytes() {
        [0] => Some(NmtState::PreOperational),
        [state] => nmt_state(*state),
        _ => None,
    }
}
