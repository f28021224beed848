//! Modbus as the reference devices speak it, RTU and TCP: a slave, a small master, and what they may be made to do wrong.
//!
//! Nothing here knows a clock: characters come in with the instant their last bit ended, frames go out from the instant
//! the caller was told to wake at.

pub mod behaviour;
mod counters;
pub mod crc;
mod departure;
mod exception;
pub mod faults;
pub mod framing;
mod function_faults;
mod functions;
pub mod master;
mod register_fault;
mod registers;
#[cfg(test)]
pub(crate) mod script;
pub mod slave;
pub mod stream;
mod tcp_faults;
mod tcp_side;
pub(crate) mod variants;

pub use behaviour::{
    AddressChangeReply, Behaviour, ByteCount, CrcOrder, EchoedValue, ExceptionCodes, Remains,
    SpeedSign,
};
pub use departure::Departure;
pub use exception::Exception;
pub use faults::FAULTS;
pub use master::{Failure, ModbusMaster, Reply, RequestId};
pub use register_fault::{RegisterFault, RegisterFaultKind};
pub use registers::{Command, Registers};
pub use slave::ModbusSlave;
pub use tcp_side::TcpFault;

#[cfg(test)]
mod tests;
