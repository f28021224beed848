//! The simulated lane as the engine sees it.

use std::time::Duration;

use super::medium::Medium;
use super::world::{Hung, World};
use crate::lane::not_a_connection;
use crate::{
    Arrival, CompanionIndex, Farewell, Instant, Lane, Line, LinkError, NotOffered, Participant,
    PortIndex, PortProperties, Sent, State, Stimulus, StimulusError, StimulusKind, Transmission,
};

/// How long a CAN frame of the tester's may wait for its start: for the bus, and for a node to acknowledge it.
const GIVE_UP: Duration = Duration::from_millis(100);

/// A [`Lane`] on simulated media. See [`super`] for what is simulated, and [`super::Builder`] for how to make one.
pub struct SimLane {
    world: World,
    ports: Vec<PortProperties>,
    /// The device's place in the world.
    device: Option<usize>,
    attached: usize,
    /// The ports of connections that were opened beside the first.
    further: Vec<usize>,
}

impl SimLane {
    pub(super) fn new(world: World, ports: Vec<PortProperties>, device: Option<usize>) -> SimLane {
        SimLane {
            world,
            ports,
            device,
            attached: 0,
            further: Vec::new(),
        }
    }

    fn name(&self, port: usize) -> String {
        let port_name = self.ports.get(port).map(|port| port.name.clone());
        port_name.unwrap_or_else(|| format!("number {port}"))
    }

    fn hung(&self, hung: &Hung) -> LinkError {
        self.down(
            hung.bus,
            "a participant asks to be woken again and again at one instant",
        )
    }

    fn down(&self, port: usize, reason: &str) -> LinkError {
        LinkError::Down {
            port: self.name(port),
            reason: reason.to_owned(),
        }
    }

    fn wrong_kind(&self, port: usize) -> LinkError {
        let port = self.name(port);
        LinkError::WrongKind { port }
    }

    fn is_closed(&self, port: usize) -> bool {
        matches!(self.world.medium(port), Some(Medium::Stream(stream)) if stream.is_closed())
    }

    fn no_such_port(&self, port: usize) -> LinkError {
        self.down(port, "the lane has no such port")
    }
}

impl Lane for SimLane {
    fn now(&self) -> Instant {
        self.world.now()
    }

    fn ports(&self) -> &[PortProperties] {
        &self.ports
    }

    fn send(
        &mut self,
        port: PortIndex,
        at: Instant,
        what: Transmission,
    ) -> Result<Sent, LinkError> {
        let PortIndex(port) = port;
        let (Some(medium), Some(properties)) = (self.world.medium(port), self.ports.get(port))
        else {
            return Err(self.no_such_port(port));
        };
        if !medium.carries(&what) {
            return Err(self.wrong_kind(port));
        }
        if properties.line == Line::Off {
            return Err(self.down(port, "the tester's port is switched off"));
        }
        if self.is_closed(port) {
            return Err(self.down(port, "the connection is closed"));
        }
        self.world.run_to(at).map_err(|hung| self.hung(&hung))?;
        let give_up = match what {
            Transmission::Frame(_) => self.world.now() + GIVE_UP,
            Transmission::Characters(_) | Transmission::Close => Instant::NEVER,
        };
        match self.world.send(port, what, give_up) {
            Ok(Some(sent)) => Ok(sent),
            Ok(None) => Err(LinkError::NotAcknowledged {
                port: self.name(port),
            }),
            Err(hung) => Err(self.hung(&hung)),
        }
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Arrival>, LinkError> {
        self.world.receive(until).map_err(|hung| self.hung(&hung))
    }

    fn set_line(&mut self, port: PortIndex, line: Line) -> Result<(), LinkError> {
        let PortIndex(port) = port;
        let Some(medium) = self.world.medium(port) else {
            return Err(self.no_such_port(port));
        };
        if !medium.takes(line) {
            return Err(self.wrong_kind(port));
        }
        self.world.set_tester_line(port, line);
        if let Some(properties) = self.ports.get_mut(port) {
            properties.line = line;
        }
        Ok(())
    }

    fn offers(&self) -> Vec<StimulusKind> {
        let device = self
            .device
            .and_then(|device| self.world.participant(device));
        device.map(Participant::offers).unwrap_or_default()
    }

    fn stimulate(&mut self, stimulus: &Stimulus) -> Result<(), StimulusError> {
        let device = self.device.ok_or(StimulusError::NotOffered)?;
        self.world
            .call(device, |device, now, out| {
                device.stimulate(now, stimulus, out)
            })
            .map_err(|_| StimulusError::NotOffered)
    }

    fn stimulate_companion(
        &mut self,
        port: PortIndex,
        stimulus: &Stimulus,
    ) -> Result<(), NotOffered> {
        for member in self.world.companions_on(port.0) {
            let done = self.world.call(member, |companion, now, out| {
                companion.stimulate(now, stimulus, out)
            });
            if done.is_ok() {
                return Ok(());
            }
        }
        Err(NotOffered)
    }

    fn attach(&mut self, port: PortIndex, companion: Box<dyn Participant>) -> CompanionIndex {
        let index = CompanionIndex(self.attached);
        self.attached += 1;
        self.world.add_companion(index, port.0, companion);
        index
    }

    fn detach(&mut self, companion: CompanionIndex) {
        self.world.remove_companion(companion);
    }

    fn connect(&mut self, port: PortIndex, name: &str) -> Result<PortIndex, LinkError> {
        let base = self.ports.get(port.0);
        let base = base.filter(|base| matches!(base.line, Line::Stream(_)));
        let (Some(base), Some(device)) = (base.cloned(), self.device) else {
            return Err(not_a_connection(&self.ports, port));
        };
        let closed = self.further.iter().copied();
        let place = match closed.into_iter().find(|port| self.is_closed(*port)) {
            Some(place) => place,
            None => {
                let place = self.world.add_connection(device, base.line);
                self.ports.push(base);
                self.further.push(place);
                place
            }
        };
        self.ports[place].name = name.to_owned();
        self.world.open_connection(place);
        Ok(PortIndex(place))
    }

    fn disconnect(&mut self, port: PortIndex, how: Farewell) -> Result<(), LinkError> {
        if !self.further.contains(&port.0) {
            return Err(not_a_connection(&self.ports, port));
        }
        if !self.is_closed(port.0) {
            self.world.close_connection(port.0, how);
        }
        Ok(())
    }

    fn device_state(&self) -> State {
        let device = self
            .device
            .and_then(|device| self.world.participant(device));
        device.map(Participant::state).unwrap_or_default()
    }
}
