//! Finds out what is on a bus, before anything is known of it, and changes nothing there.

mod bus;
mod canopen;
mod exchange;
mod lss;
mod modbus;
mod questions;
#[cfg(test)]
mod tests;
mod traffic;

pub use canopen::{CanopenFound, CanopenScan, FoundNode, scan_canopen};
pub use lss::{LssFound, LssSlave};
pub use modbus::{FoundServer, MOST_ADDRESSES, ModbusFound, ModbusScan, scan_modbus};
pub use questions::Answers;
pub use traffic::{HeardFrom, HeardIdentifier, Traffic};
