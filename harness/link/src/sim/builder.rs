//! Puts a simulated lane together.

use std::time::Duration;

use super::can::CanBus;
use super::lane::SimLane;
use super::medium::Medium;
use super::serial::SerialLine;
use super::stream::Stream;
use super::world::World;
use crate::{Framing, Line, Participant, PortIndex, PortProperties, SerialSettings};

/// Puts a [`SimLane`] together: first the media, then who is on them.
#[derive(Default)]
pub struct Builder {
    world: World,
    ports: Vec<PortProperties>,
    device: Option<usize>,
}

impl Builder {
    /// Nothing yet.
    pub fn new() -> Builder {
        Builder::default()
    }

    /// A CAN bus with the tester's port on it, in the role `name` and set to `bit_rate` bits a second.
    pub fn can_bus(&mut self, name: &str, bit_rate: u32) -> PortIndex {
        let medium = Medium::Can(CanBus::default());
        self.add(name, medium, Line::Can { bit_rate })
    }

    /// A serial line with the tester's port on it, in the role `name` and set to `settings`.
    pub fn serial_line(&mut self, name: &str, settings: SerialSettings) -> PortIndex {
        let medium = Medium::Serial(SerialLine::default());
        self.add(name, medium, Line::Serial(settings))
    }

    /// A connection of the tester's, in the role `name`.
    pub fn connection(&mut self, name: &str, framing: Framing) -> PortIndex {
        let medium = Medium::Stream(Stream::default());
        self.add(name, medium, Line::Stream(framing))
    }

    fn add(&mut self, name: &str, medium: Medium, line: Line) -> PortIndex {
        let sets_bit_rate = !matches!(line, Line::Stream(_));
        self.ports.push(PortProperties {
            name: name.to_owned(),
            link: "sim:".to_owned(),
            line,
            timestamps: "simulated",
            uncertainty: Duration::ZERO,
            sets_bit_rate,
            tells_departure: false,
        });
        PortIndex(self.world.add_bus(medium, line))
    }

    /// The device under test: its port 0 is where the first of `ports` is, and so on. A port that this builder did not
    /// give is connected to nothing. If called again, the later one is the device and the earlier a participant.
    pub fn device(&mut self, device: Box<dyn Participant>, ports: &[PortIndex]) {
        self.device = Some(self.join(device, ports));
    }

    /// A further participant on the media of `ports`, beside the device and the tester.
    pub fn participant(&mut self, participant: Box<dyn Participant>, ports: &[PortIndex]) {
        self.join(participant, ports);
    }

    fn join(&mut self, participant: Box<dyn Participant>, ports: &[PortIndex]) -> usize {
        let buses: Vec<usize> = ports.iter().map(|port| port.0).collect();
        self.world.add_member(participant, &buses)
    }

    /// The lane, at [`crate::Instant::START`].
    pub fn build(self) -> SimLane {
        SimLane::new(self.world, self.ports, self.device)
    }
}
