//! The lane on real links.

use std::time::Duration;

use super::port::Port;
use super::ports::{GivesUp, Heard, Ports};
use crate::{
    Arrival, CompanionIndex, Farewell, Instant, Lane, Line, LinkError, NotOffered, Origin, Outbox,
    Participant, PortIndex, PortProperties, Sent, State, Stimulus, StimulusError, StimulusKind,
    Transmission,
};

/// How often a stimulus that takes its time is asked whether it is done.
const STIMULUS_POLL: Duration = Duration::from_millis(20);

/// What a bench can do to a device beside the bus: by an operator's hand, or by a command of the bench's.
pub trait Stimuli: Send {
    /// The kinds it offers.
    fn offers(&self) -> Vec<StimulusKind>;

    /// Begins to give a stimulus.
    ///
    /// # Errors
    /// [`StimulusError`]: not offered here, or it could not be begun.
    fn begin(&mut self, stimulus: &Stimulus) -> Result<(), StimulusError>;

    /// Whether what was begun is done. Asked again and again while the lane goes on.
    ///
    /// # Errors
    /// [`StimulusError`]: it failed, or nobody did it in time.
    fn is_done(&mut self) -> Result<bool, StimulusError>;
}

/// A bench that can do nothing beside the bus.
#[derive(Debug, Clone, Copy, Default)]
pub struct NoStimuli;

impl Stimuli for NoStimuli {
    fn offers(&self) -> Vec<StimulusKind> {
        Vec::new()
    }

    fn begin(&mut self, _: &Stimulus) -> Result<(), StimulusError> {
        Err(StimulusError::NotOffered)
    }

    fn is_done(&mut self) -> Result<bool, StimulusError> {
        Err(StimulusError::NotOffered)
    }
}

/// Who sends through the lane's ports.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sender {
    Tester,
    Companion(usize),
}

struct Companion {
    port: usize,
    participant: Box<dyn Participant>,
}

/// A [`Lane`] on real links, in the thread of its caller: it waits for all its ports at once, and lets the companions
/// take part while the caller sends or receives.
pub struct RealLane {
    ports: Ports<Sender>,
    stimuli: Box<dyn Stimuli>,
    companions: Vec<Option<Companion>>,
    outbox: Outbox,
}

impl RealLane {
    /// A lane of these ports, in the order of their indices.
    pub fn new(ports: Vec<Box<dyn Port>>, stimuli: Box<dyn Stimuli>) -> RealLane {
        RealLane {
            ports: Ports::new(ports, GivesUp::WithAnError),
            stimuli,
            companions: Vec::new(),
            outbox: Outbox::default(),
        }
    }

    /// The next thing that the tester hears until `until`.
    fn hear(&mut self, until: Instant) -> Result<Option<Arrival>, LinkError> {
        loop {
            self.wake_companions()?;
            if let Some(heard) = self.ports.next_heard(until) {
                if let Some(arrival) = self.pass_on(heard)? {
                    return Ok(Some(arrival));
                }
                continue;
            }
            if self.ports.clock.now() >= until {
                // What arrived before `until` may not have been taken yet.
                self.ports.take();
                match self.ports.next_heard(until) {
                    None => return Ok(None),
                    Some(heard) => match self.pass_on(heard)? {
                        Some(arrival) => return Ok(Some(arrival)),
                        None => continue,
                    },
                }
            }
            self.ports.wait(self.next_wake().min(until))?;
        }
    }

    /// Lets every other on the port hear it: the companions, and the tester. Of its own the tester hears what it cannot
    /// know: when it left.
    fn pass_on(&mut self, heard: Heard<Sender>) -> Result<Option<Arrival>, LinkError> {
        for index in 0..self.companions.len() {
            let is_own = heard.from == Some(Sender::Companion(index));
            let Some(companion) = self.companions[index].as_mut() else {
                continue;
            };
            if companion.port == heard.port && !is_own {
                let outbox = &mut self.outbox;
                companion
                    .participant
                    .receive(heard.at, 0, heard.what, outbox);
                self.send_for(index)?;
            }
        }
        let origin = match heard.from {
            None => Origin::Bus,
            Some(Sender::Companion(index)) => Origin::Companion(CompanionIndex(index)),
            Some(Sender::Tester) if self.ports.tells_departure(heard.port) => Origin::Tester,
            Some(Sender::Tester) => return Ok(None),
        };
        Ok(Some(Arrival {
            port: PortIndex(heard.port),
            at: heard.at,
            origin,
            what: heard.what,
        }))
    }

    fn next_wake(&self) -> Instant {
        let wakes = self.companions.iter().flatten();
        let wakes = wakes.filter_map(|companion| companion.participant.wake_at());
        wakes.min().unwrap_or(Instant::NEVER)
    }

    fn wake_companions(&mut self) -> Result<(), LinkError> {
        if self.companions.is_empty() {
            return Ok(());
        }
        let now = self.ports.clock.now();
        for index in 0..self.companions.len() {
            let Some(companion) = self.companions[index].as_mut() else {
                continue;
            };
            if companion.participant.wake_at().is_some_and(|at| at <= now) {
                companion.participant.wake(now, &mut self.outbox);
                self.send_for(index)?;
            }
        }
        Ok(())
    }

    /// Sends what a companion has put into the outbox.
    fn send_for(&mut self, index: usize) -> Result<(), LinkError> {
        let port = self.companions[index].as_ref().map(|it| it.port);
        let pending: Vec<_> = self.outbox.drain().collect();
        for (_, what) in pending {
            if let Some(port) = port {
                self.ports.send(port, Sender::Companion(index), what)?;
            }
        }
        Ok(())
    }

    /// Lets the lane go on until `instant`; what arrives stays for [`Lane::receive`].
    fn run_to(&mut self, instant: Instant) -> Result<(), LinkError> {
        while self.ports.clock.now() < instant {
            self.wake_companions()?;
            self.ports.wait(self.next_wake().min(instant))?;
        }
        Ok(())
    }
}

impl Lane for RealLane {
    fn now(&self) -> Instant {
        self.ports.clock.now()
    }

    fn ports(&self) -> &[PortProperties] {
        self.ports.properties()
    }

    fn send(
        &mut self,
        port: PortIndex,
        at: Instant,
        what: Transmission,
    ) -> Result<Sent, LinkError> {
        self.run_to(at)?;
        let handed_over = self.ports.clock.now();
        match self.ports.send(port.0, Sender::Tester, what)? {
            Some(sent) => {
                self.run_to(sent.end)?;
                Ok(sent)
            }
            None => Ok(Sent {
                start: handed_over,
                end: handed_over,
            }),
        }
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Arrival>, LinkError> {
        self.hear(until)
    }

    fn set_line(&mut self, port: PortIndex, line: Line) -> Result<(), LinkError> {
        self.ports.set_line(port.0, line)
    }

    fn offers(&self) -> Vec<StimulusKind> {
        self.stimuli.offers()
    }

    fn stimulate(&mut self, stimulus: &Stimulus) -> Result<(), StimulusError> {
        self.stimuli.begin(stimulus)?;
        while !self.stimuli.is_done()? {
            let next_look = self.ports.clock.now() + STIMULUS_POLL;
            self.run_to(next_look)
                .map_err(|error| StimulusError::Failed(error.to_string()))?;
        }
        Ok(())
    }

    fn stimulate_companion(
        &mut self,
        port: PortIndex,
        stimulus: &Stimulus,
    ) -> Result<(), NotOffered> {
        let now = self.ports.clock.now();
        for index in 0..self.companions.len() {
            let Some(companion) = self.companions[index].as_mut() else {
                continue;
            };
            let done = companion.port == port.0
                && companion
                    .participant
                    .stimulate(now, stimulus, &mut self.outbox)
                    .is_ok();
            if done {
                // What fails to leave is missed by whoever waits for it.
                let _ = self.send_for(index);
                return Ok(());
            }
        }
        Err(NotOffered)
    }

    fn attach(&mut self, port: PortIndex, companion: Box<dyn Participant>) -> CompanionIndex {
        self.companions.push(Some(Companion {
            port: port.0,
            participant: companion,
        }));
        CompanionIndex(self.companions.len() - 1)
    }

    fn detach(&mut self, companion: CompanionIndex) {
        if let Some(place) = self.companions.get_mut(companion.0) {
            *place = None;
        }
    }

    fn connect(&mut self, port: PortIndex, name: &str) -> Result<PortIndex, LinkError> {
        self.ports.connect(port.0, name).map(PortIndex)
    }

    fn disconnect(&mut self, port: PortIndex, how: Farewell) -> Result<(), LinkError> {
        self.ports.disconnect(port.0, how)
    }

    fn device_state(&self) -> State {
        State::default()
    }
}
