//! Finds the device when a lane begins: whether it is there, and in which NMT state. Another master may have left it in
//! any; a node that is right must not be blamed for that.

use std::time::Duration;

use fieldproof_can::{Frame, Id};
use fieldproof_link::Instant;
use fieldproof_suite::device::Feature;
use fieldproof_suite::model::{Case, Need, NmtState};
use fieldproof_wire::canopen::{Multiplexer, Service, identify};

use crate::node::HEARTBEAT;
use crate::sdo::Outcome;
use crate::session::Message;
use crate::stop::Stop;
use crate::tester::{CAN, DEVICE_TYPE, Tester};
use crate::unexpected::nmt_state;

const GUARD_TIME: Multiplexer = Multiplexer::new(0x100C, 0);
const LIFE_TIME_FACTOR: Multiplexer = Multiplexer::new(0x100D, 0);

/// How long a device is listened to between two looks whether it answers.
const PROBE: Duration = Duration::from_millis(100);

/// A heartbeat that takes longer is not waited for.
const LONGEST_HEARTBEAT: Duration = Duration::from_secs(10);

/// How a node was found.
#[derive(Debug, PartialEq, Eq, Default)]
pub(crate) struct Found {
    /// The state it was in, as far as that could be seen.
    state: Option<NmtState>,
    /// Services that are not under their predefined identifiers, with what the object holds that says so.
    moved: Vec<(&'static Predefined, u32)>,
}

/// A service whose identifier an object of the device holds.
#[derive(Debug, PartialEq, Eq)]
struct Predefined {
    service: Service,
    object: Multiplexer,
    /// Bits of the object that are not part of the identifier, or of whether there is one.
    other_bits: u32,
    /// Cases that need one of these rest on the predefined identifier.
    features: &'static [Feature],
}

static PREDEFINED: [Predefined; 3] = [
    Predefined {
        service: Service::Emergency,
        object: Multiplexer::new(0x1014, 0),
        other_bits: 1 << 30,
        features: &[Feature::Emergency],
    },
    Predefined {
        service: Service::Sync,
        object: Multiplexer::new(0x1005, 0),
        other_bits: 1 << 31 | 1 << 30,
        features: &[Feature::SyncConsumer, Feature::SyncProducer],
    },
    Predefined {
        service: Service::Time,
        object: Multiplexer::new(0x1012, 0),
        other_bits: 1 << 31 | 1 << 30,
        features: &[Feature::TimeConsumer, Feature::TimeProducer],
    },
];

impl Found {
    /// Why a case cannot be played with the node as it was found.
    pub(crate) fn skip_reason(&self, case: &Case) -> Option<String> {
        let is_needed = |feature: &Feature| case.needs.contains(&Need::Feature(*feature));
        let mut moved = self.moved.iter();
        let (predefined, held) = moved.find(|(it, _)| it.features.iter().any(is_needed))?;
        Some(format!(
            "{} was found to hold {held:08X}h: {} is not under its predefined identifier",
            predefined.object, predefined.service
        ))
    }
}

/// The state that every case finds the node in.
pub(crate) const PLAYED_IN: NmtState = NmtState::PreOperational;

impl Tester<'_> {
    /// Waits until a CANopen device is there, for it may have been powered with the lane, and boots first then; and brings
    /// it into the state that cases find it in. `None` for what has no NMT state, or if the link fails.
    pub(crate) fn find_device(&mut self) -> Option<Found> {
        if !self.is_nmt_slave_here() {
            return None;
        }
        let found = self.look().ok();
        self.session.begin_case();
        found
    }

    /// Whether the device has an NMT state that this bench can see: its CAN port may not be connected.
    pub(crate) fn is_nmt_slave_here(&self) -> bool {
        let is_connected = self.session.port(CAN).is_some() && self.node.is_some();
        is_connected && self.claims(Feature::NmtSlave)
    }

    fn look(&mut self) -> Result<Found, Stop> {
        let mut heard = None;
        let answers = self.await_answer(&mut heard)?;
        if answers {
            self.read_heartbeat(&mut heard)?;
            self.ask_for_state(&mut heard)?;
        }
        let now = self.session.now();
        self.listen_until(now, &mut heard)?;
        if answers && heard == Some(PLAYED_IN) {
            self.watch.found(PLAYED_IN, now);
        } else {
            self.command_into(PLAYED_IN)?;
            let settled = self.session.now() + self.device.timing.nmt_transition;
            self.session.collect_until(settled)?;
        }
        // A node in Stopped answers no SDO request; if nothing else was heard of it, that was why.
        if !answers && self.claims(Feature::SdoServer) && self.is_answered()? {
            heard = heard.or(Some(NmtState::Stopped));
            self.read_heartbeat(&mut heard)?;
        }
        Ok(Found {
            state: heard,
            moved: self.moved_services()?,
        })
    }

    /// Somebody may have changed identifiers. A node that was never configured has no excuse.
    fn moved_services(&mut self) -> Result<Vec<(&'static Predefined, u32)>, Stop> {
        let mut moved = Vec::new();
        if !self.claims(Feature::SdoServer) || self.claims(Feature::FactorySettings) {
            return Ok(moved);
        }
        for service in PREDEFINED.iter() {
            if !service.features.iter().any(|it| self.claims(*it)) {
                continue;
            }
            let identifier = u32::from(self.identifier(service.service)?.raw());
            let held = self.number_in(service.object)?;
            moved.extend(
                held.filter(|held| held & !service.other_bits != identifier)
                    .map(|held| (service, held)),
            );
        }
        Ok(moved)
    }

    /// Leaves the node in the state it was found in. If the link is down that cannot be helped.
    pub(crate) fn leave_device(&mut self, found: &Found) {
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
        if self.number_in(HEARTBEAT)? == Some(u32::from(milliseconds)) {
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
        let period = self.number_in(HEARTBEAT)?;
        let Some(milliseconds) = period.and_then(|period| u16::try_from(period).ok()) else {
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

    /// The number that an object holds, where it can be read.
    fn number_in(&mut self, object: Multiplexer) -> Result<Option<u32>, Stop> {
        let value = match self.sdo_upload(object, self.device.timing.sdo_response) {
            Ok(Outcome::Done(value)) => value,
            Ok(Outcome::Refused(_)) | Err(Stop::Mismatch(_) | Stop::Undecided(_)) => {
                return Ok(None);
            }
            Err(stop) => return Err(stop),
        };
        let size = self.size_of(object);
        let bytes = value.of_size(size).iter().take(4).rev();
        Ok(Some(
            bytes.fold(0, |number, byte| number << 8 | u32::from(*byte)),
        ))
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
