//! Simulated CAN buses and serial lines on one discrete-event clock.
//!
//! A [`SimLane`] is a [`crate::Lane`] whose clock moves only when it is asked to send or to receive, and then straight
//! to the next thing that happens: waiting costs no wall time, and the same calls give the same instants every time.
//!
//! ```
//! use fieldproof_link::{Instant, Lane, Transmission, sim};
//!
//! let mut builder = sim::Builder::new();
//! let can = builder.can_bus("can", 500_000);
//! let mut lane = builder.build();
//! assert_eq!(lane.receive(Instant::from_nanos(1_000_000)), Ok(None));
//! assert_eq!(lane.now(), Instant::from_nanos(1_000_000));
//! assert_eq!(lane.ports()[can.0].name, "can");
//! ```
//!
//! # On a CAN bus
//! - A frame takes its bits, from the start bit to the end of EOF, at its sender's bit rate, and three bits of
//!   intermission follow. It arrives at the end of EOF.
//! - When the bus is idle, the heads of all transmit queues (first in, first out, one a node) arbitrate: the lower
//!   identifier wins, a base frame over an extended one with the same first eleven bits, data over remote. Two nodes
//!   that send the same arbitration field do not disturb each other: the one that joined first goes first.
//! - A frame reaches every node that has been set to the same bit rate since its start bit, but not its sender. If
//!   there is none, nobody acknowledges it, and it stays in its queue until one is there. It takes no bus time
//!   meanwhile, for error frames are not simulated, and a later frame with its identifier takes its place, as in a
//!   controller's message buffer. The tester's own frame is given up after 100 ms.
//!
//! # On a serial line
//! - A node sends as soon as it has something to send, character after character without a gap, and all others hear
//!   each character at the end of its last stop bit.
//! - Where two send at once, both their characters arrive spoilt. So does a character from a node that is set
//!   differently, and one during which either side was set differently or its sender switched off.
//!
//! # On a connection
//! - What is sent arrives 100 us later, in order, at the other end alone. Further connections to the same device are
//!   opened by [`crate::Lane::connect`]; each is a further port of the device, behind those that it has by itself, and
//!   the device is told that it is there, and that it was closed. A device that is switched off is not told.
//!
//! # For all
//! - A participant that is [`crate::Line::Off`] neither hears nor sends, and what it had to send is lost. What it
//!   sends on a port that is connected to nothing, or cannot carry it, is lost too.
//! - Companions share the tester's node and its queue with [`crate::Lane::send`], and are set as it is, except that
//!   one whose own line is `Off` takes no part. They hear what arrives there, not what the tester or another companion
//!   sends. What a companion has sent comes to [`crate::Lane::receive`] as an arrival of that origin.
//! - At one instant, transmissions end first, then participants are woken, then transmissions start; media and
//!   participants in the order they were added.

mod builder;
mod can;
mod lane;
mod medium;
mod serial;
mod stream;
mod world;

pub use builder::Builder;
pub use lane::SimLane;
