//! The lane: one device under test with all its ports, as the engine sees it.

use std::time::Duration;

use crate::{
    Instant, Line, NotOffered, Participant, Reception, State, Stimulus, StimulusKind, Transmission,
};

/// Which of the lane's ports, by its place in [`Lane::ports`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PortIndex(pub usize);

/// Which of the tester's participants that were attached to the lane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CompanionIndex(pub usize);

/// What a caller may know of a port. The engine asks these, never which kind of link it is on.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PortProperties {
    /// The role that suites use: `can`, `serial`, `inverter`.
    pub name: String,
    /// The link as a bench file writes it: `sim:`, `socketcan:can0`.
    pub link: String,
    /// How the tester is set on it.
    pub line: Line,
    /// Where instants come from: `simulated`, `kernel`, `hardware`, `adapter`, `user space`; with what is in between, in brackets.
    pub timestamps: &'static str,
    /// How far an instant may be off.
    pub uncertainty: Duration,
    /// Whether [`Lane::set_line`] can give it another bit rate. On a bus without bits there is none.
    pub sets_bit_rate: bool,
    /// Whether [`Lane::send`] does not wait for the frame to leave, and what it gives back is when the frame was handed
    /// over. Then it comes back as an [`Arrival`] of [`Origin::Tester`] with the instant at which it left, after all that
    /// came before it and before all that came after it.
    pub tells_departure: bool,
}

impl PortProperties {
    /// Whether bits take time on it. On a bus without bits whatever is sent comes all at once, and the silence after it
    /// tells nothing of whoever kept it.
    pub fn has_bit_times(&self) -> bool {
        self.sets_bit_rate
    }
}

/// Who sent what arrived.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// The device under test, or another on the bus.
    Bus,
    /// One of the tester's own participants.
    Companion(CompanionIndex),
    /// [`Lane::send`]: on a port that [tells](PortProperties::tells_departure) when a frame has left.
    Tester,
}

/// Something that arrived at a port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Arrival {
    /// Where.
    pub port: PortIndex,
    /// The end of its last bit.
    pub at: Instant,
    /// From whom.
    pub origin: Origin,
    /// What.
    pub what: Reception,
}

/// When a transmission was on the wire.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sent {
    /// The start of its first bit.
    pub start: Instant,
    /// The end of its last bit.
    pub end: Instant,
}

/// The link failed: neither a wrong device nor a wrong suite.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum LinkError {
    /// A frame on a serial port, characters on a CAN port, or a spoilt character where there is no parity to be wrong.
    #[error("port {port} cannot carry this")]
    WrongKind {
        /// The port's name.
        port: String,
    },
    /// No other node took the frame (no acknowledge) until the lane gave up.
    #[error("nobody on port {port} acknowledged the frame")]
    NotAcknowledged {
        /// The port's name.
        port: String,
    },
    /// What arrived was not fetched in time, and is lost.
    #[error("port {port} lost {lost} frames because its receive queue was full")]
    Overflow {
        /// The port's name.
        port: String,
        /// How many, as far as the system tells; at least 1.
        lost: u32,
    },
    /// The link is gone.
    #[error("port {port} is down: {reason}")]
    Down {
        /// The port's name.
        port: String,
        /// Why, in the words of the system.
        reason: String,
    },
}

/// A stimulus could not be given.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum StimulusError {
    /// Nothing on this bench offers it.
    #[error("this bench does not offer it")]
    NotOffered,
    /// It was tried and failed.
    #[error("{0}")]
    Failed(String),
}

/// How a connection is ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Farewell {
    /// In order: what was sent still arrives.
    Close,
    /// With a reset: what is on the way is lost.
    Reset,
}

/// Why `port` cannot be connected again, or closed.
pub(crate) fn not_a_connection(ports: &[PortProperties], port: PortIndex) -> LinkError {
    let name = ports.get(port.0).map(|port| port.name.clone());
    LinkError::Down {
        port: name.unwrap_or_else(|| format!("number {}", port.0)),
        reason: "it is no connection of which there could be more".to_owned(),
    }
}

/// One device under test with all its ports, played by one thread.
pub trait Lane {
    /// The present instant.
    fn now(&self) -> Instant;

    /// The ports; a [`PortIndex`] counts them.
    fn ports(&self) -> &[PortProperties];

    /// Sends `what` on `port` at `at`, or at once if that has passed, and returns when it has left: on CAN after
    /// arbitration and acknowledge, or at once if the port [tells](PortProperties::tells_departure) when that was. What
    /// arrives meanwhile is kept for [`Lane::receive`].
    ///
    /// # Errors
    /// [`LinkError`]: the link failed, or nobody acknowledged a frame.
    fn send(&mut self, port: PortIndex, at: Instant, what: Transmission)
    -> Result<Sent, LinkError>;

    /// The next thing that arrived on any port, in the order of arrival; `None` once `until` has come without one.
    ///
    /// # Errors
    /// [`LinkError`]: the link failed.
    fn receive(&mut self, until: Instant) -> Result<Option<Arrival>, LinkError>;

    /// Sets the tester's own side of a port: another bit rate, say.
    ///
    /// # Errors
    /// [`LinkError`]: the link cannot be set so.
    fn set_line(&mut self, port: PortIndex, line: Line) -> Result<(), LinkError>;

    /// The kinds of stimulus the bench offers.
    fn offers(&self) -> Vec<StimulusKind>;

    /// Does something to the device beside the bus.
    ///
    /// # Errors
    /// [`StimulusError`]: not offered here, or it failed.
    fn stimulate(&mut self, stimulus: &Stimulus) -> Result<(), StimulusError>;

    /// Does something to a companion on `port`. It is the tester's own, so no bench need offer that.
    ///
    /// # Errors
    /// [`NotOffered`]: there is none, or it has no such thing.
    fn stimulate_companion(
        &mut self,
        port: PortIndex,
        stimulus: &Stimulus,
    ) -> Result<(), NotOffered>;

    /// Lets `companion` take part through the tester's port `port`; its own port 0 is that port.
    fn attach(&mut self, port: PortIndex, companion: Box<dyn Participant>) -> CompanionIndex;

    /// Ends its part.
    fn detach(&mut self, companion: CompanionIndex);

    /// Opens a further connection to what the connection `port` leads to: a port of its own, called `name`, until it is
    /// closed. A [`PortIndex`] that is closed may be given again.
    ///
    /// # Errors
    /// [`LinkError`]: `port` is no connection, or no other is taken.
    fn connect(&mut self, port: PortIndex, name: &str) -> Result<PortIndex, LinkError> {
        let _ = name;
        Err(not_a_connection(self.ports(), port))
    }

    /// Ends a connection that [`Lane::connect`] has opened.
    ///
    /// # Errors
    /// [`LinkError`]: it is none.
    fn disconnect(&mut self, port: PortIndex, how: Farewell) -> Result<(), LinkError> {
        let _ = how;
        Err(not_a_connection(self.ports(), port))
    }

    /// What the device would show if it could be opened: see [`Participant::state`]. Empty where it cannot.
    fn device_state(&self) -> State {
        State::default()
    }
}
