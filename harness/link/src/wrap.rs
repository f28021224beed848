//! Lanes that stand before a lane.

use std::collections::VecDeque;
use std::fmt;
use std::num::NonZeroU32;
use std::time::Duration;

use fieldproof_can::{Frame, Id};

use crate::{
    Arrival, BusError, Character, CompanionIndex, Farewell, Instant, Lane, Line, LinkError,
    NotOffered, Origin, Parity, Participant, PortIndex, PortProperties, Reception, Sent, State,
    Stimulus, StimulusError, StimulusKind, Transmission,
};

/// What a bad line does. Every fault strikes every so manieth frame or character; 1 is all of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineFault {
    /// What the device sends is lost.
    Drop {
        /// Which.
        every: NonZeroU32,
    },
    /// What the tester sends takes its time on the line and tells nobody anything: a CAN frame has another identifier, and
    /// characters other bits.
    Deafen {
        /// Which.
        every: NonZeroU32,
    },
    /// What the device sends arrives twice.
    Double {
        /// Which.
        every: NonZeroU32,
    },
    /// The bits of the mask are inverted: in a character, or in one byte of a frame. CAN does not let a damaged frame
    /// through, but an adapter may damage it behind the bus. Parity, where the line has it, notices an odd number of bits:
    /// such a character is spoilt.
    Flip {
        /// Which.
        every: NonZeroU32,
        /// The data bits to invert.
        mask: u8,
    },
    /// It arrives later, and what comes meanwhile passes it.
    Delay {
        /// Which.
        every: NonZeroU32,
        /// By so much.
        by: Duration,
    },
    /// It waits so long for what has a higher priority: of frames that come that close together the one with the lower
    /// identifier is handed over first. A controller with a buffer for each identifier does this.
    ByPriority {
        /// How long.
        within: Duration,
    },
    /// The tester's controller tells of an error on the bus before it.
    Disturb {
        /// Which.
        every: NonZeroU32,
        /// What it tells.
        error: BusError,
    },
}

/// A lane with a bad line: the fault is between one of its ports and everybody but the tester's own companions. What
/// these send and hear is not changed.
pub struct FaultyLine {
    lane: Box<dyn Lane>,
    port: PortIndex,
    /// Connections that were opened beside it.
    connections: Vec<PortIndex>,
    fault: LineFault,
    /// Frames or characters that came through the port.
    count: u32,
    /// Frames or characters that the tester has sent through it.
    sent: u32,
    /// What came through the line and is not fetched yet, in the order in which it is due.
    held: VecDeque<Arrival>,
}

/// An identifier that no CANopen service has.
const NOBODY: u32 = 0x1FFF_FFFF;

impl fmt::Debug for FaultyLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FaultyLine")
            .field("port", &self.port)
            .field("fault", &self.fault)
            .finish_non_exhaustive()
    }
}

impl FaultyLine {
    /// `lane` with `fault` on its port `port`.
    pub fn new(lane: Box<dyn Lane>, port: PortIndex, fault: LineFault) -> FaultyLine {
        FaultyLine {
            lane,
            port,
            connections: Vec::new(),
            fault,
            count: 0,
            sent: 0,
            held: VecDeque::new(),
        }
    }

    fn is_bad(&self, port: PortIndex) -> bool {
        port == self.port || self.connections.contains(&port)
    }

    /// Holds the arrival as the bad line lets it through, if it does.
    fn take(&mut self, arrival: Arrival) {
        self.count = self.count.wrapping_add(1);
        let hit = |every: NonZeroU32| self.count.is_multiple_of(every.get());
        match self.fault {
            LineFault::Drop { every } if hit(every) => {}
            LineFault::Double { every } if hit(every) => {
                self.hold(arrival);
                self.hold(arrival);
            }
            LineFault::Flip { every, mask } if hit(every) => {
                let what = match arrival.what {
                    Reception::Character(character) => {
                        Reception::Character(self.flip(character, mask))
                    }
                    Reception::Frame(frame) => Reception::Frame(self.damage(frame, mask)),
                    other => other,
                };
                self.hold(Arrival { what, ..arrival });
            }
            LineFault::Delay { every, by } if hit(every) => {
                let at = arrival.at + by;
                self.hold(Arrival { at, ..arrival });
            }
            LineFault::ByPriority { within } => self.hold_by_priority(arrival, within),
            LineFault::Disturb { every, error } if hit(every) => {
                let what = Reception::BusError(error);
                self.hold(Arrival { what, ..arrival });
                self.hold(arrival);
            }
            _ => self.hold(arrival),
        }
    }

    fn hold(&mut self, arrival: Arrival) {
        let place = self.held.partition_point(|held| held.at <= arrival.at);
        self.held.insert(place, arrival);
    }

    /// A frame takes the place, and the time, of the first that waits and has a lower priority.
    fn hold_by_priority(&mut self, arrival: Arrival, within: Duration) {
        let mut due = Arrival {
            at: arrival.at + within,
            ..arrival
        };
        let mut waiting = self.held.iter();
        let passed = waiting.position(|held| match (held.what, arrival.what) {
            (Reception::Frame(held), Reception::Frame(frame)) => held.id().raw() > frame.id().raw(),
            _ => false,
        });
        match passed {
            Some(place) => {
                due.at = self.held[place].at;
                self.held.insert(place, due);
            }
            None => self.hold(due),
        }
    }

    /// One byte after the other has its turn.
    fn damage(&self, frame: Frame, mask: u8) -> Frame {
        let mut bytes = [0; 8];
        let data = frame.bytes();
        let (Some(copy), false) = (bytes.get_mut(..data.len()), frame.is_remote()) else {
            return frame;
        };
        copy.copy_from_slice(data);
        let turn = self.count as usize % data.len().max(1);
        if let Some(byte) = copy.get_mut(turn) {
            *byte ^= mask;
        }
        Frame::data(frame.id(), copy).unwrap_or(frame)
    }

    /// What is on the line when the tester sends `what`.
    fn deafen(&mut self, what: Transmission) -> Transmission {
        let LineFault::Deafen { every } = self.fault else {
            return what;
        };
        self.sent = self.sent.wrapping_add(1);
        if !self.sent.is_multiple_of(every.get()) {
            return what;
        }
        match what {
            Transmission::Frame(frame) => {
                let other = Id::extended(NOBODY).and_then(|id| Frame::data(id, frame.bytes()));
                Transmission::Frame(other.unwrap_or(frame))
            }
            Transmission::Characters(characters) => {
                let other = |it: Character| Character {
                    byte: !it.byte,
                    ..it
                };
                Transmission::Characters(characters.into_iter().map(other).collect())
            }
            Transmission::Close => Transmission::Close,
        }
    }

    fn flip(&self, character: Character, mask: u8) -> Character {
        let line = self.lane.ports().get(self.port.0).map(|port| port.line);
        let parity =
            matches!(line, Some(Line::Serial(settings)) if settings.parity != Parity::None);
        let noticed = parity && mask.count_ones() % 2 == 1;
        Character {
            byte: character.byte ^ mask,
            spoilt: character.spoilt || noticed,
        }
    }
}

impl Lane for FaultyLine {
    fn now(&self) -> Instant {
        self.lane.now()
    }

    fn ports(&self) -> &[PortProperties] {
        self.lane.ports()
    }

    fn send(
        &mut self,
        port: PortIndex,
        at: Instant,
        what: Transmission,
    ) -> Result<Sent, LinkError> {
        let what = match self.is_bad(port) {
            true => self.deafen(what),
            false => what,
        };
        self.lane.send(port, at, what)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Arrival>, LinkError> {
        loop {
            let due = self.held.front().map(|held| held.at);
            // No further than what is held, so that what comes before it is seen first.
            let limit = due.map_or(until, |due| due.min(until));
            match self.lane.receive(limit)? {
                Some(arrival) if self.is_bad(arrival.port) && arrival.origin == Origin::Bus => {
                    self.take(arrival);
                }
                Some(arrival) => return Ok(Some(arrival)),
                None if due.is_some_and(|due| due <= until) => return Ok(self.held.pop_front()),
                None => return Ok(None),
            }
        }
    }

    fn set_line(&mut self, port: PortIndex, line: Line) -> Result<(), LinkError> {
        self.lane.set_line(port, line)
    }

    fn offers(&self) -> Vec<StimulusKind> {
        self.lane.offers()
    }

    fn stimulate(&mut self, stimulus: &Stimulus) -> Result<(), StimulusError> {
        self.lane.stimulate(stimulus)
    }

    fn stimulate_companion(
        &mut self,
        port: PortIndex,
        stimulus: &Stimulus,
    ) -> Result<(), NotOffered> {
        self.lane.stimulate_companion(port, stimulus)
    }

    fn attach(&mut self, port: PortIndex, companion: Box<dyn Participant>) -> CompanionIndex {
        self.lane.attach(port, companion)
    }

    fn detach(&mut self, companion: CompanionIndex) {
        self.lane.detach(companion);
    }

    fn connect(&mut self, port: PortIndex, name: &str) -> Result<PortIndex, LinkError> {
        let opened = self.lane.connect(port, name)?;
        if port == self.port {
            self.connections.push(opened);
        }
        Ok(opened)
    }

    fn disconnect(&mut self, port: PortIndex, how: Farewell) -> Result<(), LinkError> {
        self.connections.retain(|it| *it != port);
        self.held
            .retain(|held| held.port != port || port == self.port);
        self.lane.disconnect(port, how)
    }

    fn device_state(&self) -> State {
        self.lane.device_state()
    }
}
