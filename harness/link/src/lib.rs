//! How frames and bytes travel, with the instant each arrived.
//!
//! A [`Lane`] joins the ports of one device under test. It has two primitives: *send on this port at this instant* and
//! *receive until this instant*. What answers on the other side (a reference device in simulation) and what the tester
//! does meanwhile (a SYNC producer, an inverter behind a gateway) are [`Participant`]s: driven from outside, with no
//! clock and no I/O of their own.
//!
//! [`real`] is a lane on SocketCAN, SLCAN adapters, serial ports and TCP. [`sim`] is a lane on simulated buses, exact to the bit time and in no wall time. [`FaultyLine`] is a lane before a
//! lane that spoils what comes through it.

mod bus_error;
mod connected;
mod joined;
mod lane;
mod participant;
pub mod real;
mod signal;
pub mod sim;
mod state;
mod time;
mod wrap;

pub use bus_error::BusError;
pub use connected::Connected;
pub use joined::Joined;
pub use lane::{
    Arrival, CompanionIndex, Farewell, Lane, LinkError, Origin, PortIndex, PortProperties, Sent,
    StimulusError,
};
pub use participant::{NotOffered, Outbox, Participant, Stimulus, StimulusKind};
pub use signal::{
    Character, Framing, Line, Parity, Reception, SerialSettings, StopBits, Transmission,
};
pub use state::{State, StateDifference, StateName, StateValue};
pub use time::Instant;
pub use wrap::{FaultyLine, LineFault};
