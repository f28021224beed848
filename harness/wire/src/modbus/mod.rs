//! Modbus: the PDUs of the application protocol, and the ADUs of RTU and TCP around them.
//!
//! Numbers of more than one byte go high byte first, the CRC of an RTU ADU low byte first. Addresses are those on the
//! wire, from 0.

mod crc;
mod exception;
mod extent;
mod function;
pub mod pdu;
mod reader;
pub mod rtu;
pub mod tcp;

pub use crc::{crc16, crc16_bytes};
pub use exception::ExceptionCode;
pub use extent::{Extent, response_extent};
pub use function::FunctionCode;
pub use pdu::{Request, Response};
