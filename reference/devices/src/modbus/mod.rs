//! Modbus as the reference devices speak it, RTU and TCP: a slave, a small master, and what they may be made to do wrong.
//!
//! Nothing here knows a clock: characters come in with the instant their last bit ended, frames go out from the instant
//! the caller was told to wake at.

pub mod behaviour;
pub mod crc;
pub mod faults;
pub mod framing;
pub mod master;
#[cfg(test)]
pub(crate) mod script;
pub mod slave;
pub mod stream;

pub use behaviour::{
    AddressChangeReply, Behaviour, ByteCount, CrcOrder, EchoedValue, ExceptionCodes, SpeedSign,
};
pub use faults::FAULTS;
pub use master::{Failure, ModbusMaster, Reply, RequestId};
pub use slave::{Command, Exception, ModbusSlave, Registers};

#[cfg(test)]
mod tests;
