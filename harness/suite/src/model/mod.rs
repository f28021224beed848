//! What a suite file may say: the words of the language as types. The JSON Schema is made from these, and the loader
//! reads into these.

mod canopen;
mod drive;
mod flood;
mod frames;
mod modbus;
mod query;
mod sdo;
mod step;
mod stimulate;
mod suite;

pub use canopen::*;
pub use drive::*;
pub use flood::*;
pub use frames::*;
pub use modbus::*;
pub use query::*;
pub use sdo::*;
pub use step::*;
pub use stimulate::*;
pub use suite::*;
