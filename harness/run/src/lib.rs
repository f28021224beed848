//! Plays cases step by step against a device over a lane, and emits what happens as events of the record.
//!
//! [`play_lane`] is the whole of it: it finds the device, then for each case that applies ([`skip_reason`]) brings the
//! device there, plays control and steps, judges what came and nobody expected, and puts everything back. It never asks
//! which kind of link it is on; what differs it reads from the ports' properties. [`scan`] finds out what is on a bus
//! of which nothing is known.

mod applies;
mod case;
mod coils;
mod companions;
mod entries;
mod excerpt;
mod find;
mod found;
mod history;
mod identity;
mod lane;
mod limits;
mod modbus;
mod modbus_tcp;
mod modbus_words;
mod node;
mod object_names;
mod pdo_procedure;
mod relocate;
mod restore;
pub mod scan;
mod sdo;
mod sdo_block;
mod selected;
mod serial;
mod session;
mod steps;
mod stop;
mod tester;
mod undo;
mod unexpected;
mod value;
mod words;

pub use applies::{Bench, effect_name, feature_name, skip_reason};
pub use find::{Known, fill, fill_some, spread};
pub use lane::{LaneJob, LaneOutcome, play_lane, suites_for};
