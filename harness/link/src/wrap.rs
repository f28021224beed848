//! Lanes that stand before a lane.

use std::collections::VecDeque;
use std::num::NonZeroU32;
use std::time::Duration;

use crate::{
    Arrival, Character, CompanionIndex, Instant, Lane, Line, LinkError, NotOffered, Origin, Parity,
    Participant, PortIndex, PortProperties, Reception, Sent, State, Stimulus, StimulusError,
    StimulusKind, Transmission,
};

/// What a bad line does to what the tester hears.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineFault {
    /// Every so manieth frame or character is lost.
    Drop {
        /// 1 is all of them.
        every: NonZeroU32,
    },
    /// In every so manieth character the bits of the mask are inverted; frames stay whole, for CAN does not let a
    /// damaged one through. Parity, where the line has it, notices an odd number of bits: such a character is spoilt.
    Flip {
        /// 1 is all of them.
        every: NonZeroU32,
        /// The data bits to invert.
        mask: u8,
    },
    /// Everything arrives later.
    Delay(Duration),
}

/// A lane with a bad line: the fault is between one of its ports and everybody but the tester's own companions. What
/// the tester sends, and what its companions hear, is not changed.
#[derive(Debug)]
pub struct FaultyLine<L> {
    lane: L,
    port: PortIndex,
    fault: LineFault,
    /// Frames or characters that came through the port.
    count: u32,
    /// What came through the line and is not due yet, in the order of arrival.
    held: VecDeque<Arrival>,
}

impl<L: Lane> FaultyLine<L> {
    /// `lane` with `fault` on its port `port`.
    pub fn new(lane: L, port: PortIndex, fault: LineFault) -> FaultyLine<L> {
        FaultyLine {
            lane,
            port,
            fault,
            count: 0,
            held: VecDeque::new(),
        }
    }

    /// The arrival as the bad line lets it through, if it does.
    fn pass(&mut self, arrival: Arrival) -> Option<Arrival> {
        self.count = self.count.wrapping_add(1);
        let hit = |every: NonZeroU32| self.count.is_multiple_of(every.get());
        match (self.fault, arrival.what) {
            (LineFault::Drop { every }, _) => (!hit(every)).then_some(arrival),
            (LineFault::Flip { every, mask }, Reception::Character(character)) if hit(every) => {
                let what = Reception::Character(self.flip(character, mask));
                Some(Arrival { what, ..arrival })
            }
            (LineFault::Flip { .. }, _) => Some(arrival),
            (LineFault::Delay(delay), _) => {
                let at = arrival.at + delay;
                Some(Arrival { at, ..arrival })
            }
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

impl<L: Lane> Lane for FaultyLine<L> {
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
        self.lane.send(port, at, what)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Arrival>, LinkError> {
        loop {
            let due = self.held.front().map(|held| held.at);
            // No further than what is held, so that what comes before it is seen first.
            let limit = due.map_or(until, |due| due.min(until));
            match self.lane.receive(limit)? {
                Some(arrival) if arrival.port == self.port && arrival.origin == Origin::Bus => {
                    let passed = self.pass(arrival);
                    self.held.extend(passed);
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

    fn device_state(&self) -> State {
        self.lane.device_state()
    }
}
