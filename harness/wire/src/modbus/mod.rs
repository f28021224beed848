//! Modbus: the PDUs of the application protocol, and the ADUs of RTU and TCP around them.

mod crc;

pub use crc::{crc16, crc16_bytes};
