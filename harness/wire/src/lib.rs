//! What bytes mean: CANopen services, Modbus PDUs and ADUs, CRC-16, the SSI frame. No I/O, no clock.
//!
//! Two kinds of types. A raw view ([`canopen::sdo::RawSdo`], say) holds any bytes and names every field: with it a test
//! says something illegal on purpose. A value ([`canopen::sdo::Request`]) holds only what is legal; its `parse` says
//! which rule the bytes break, where, what was found and what expected ([`Violation`]). Codes that no standard names are
//! kept, never dropped.

#[macro_use]
mod bounded;

pub mod canopen;
pub mod describe;
pub mod modbus;
pub mod ssi;
mod violation;

pub use violation::{Rule, Violation};
