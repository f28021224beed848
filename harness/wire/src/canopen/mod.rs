//! CANopen: the services of CiA 301 and CiA 305, as frames.

mod abort_code;
pub mod connection_set;
pub(crate) mod data_frame;
pub mod emergency;
pub mod error_control;
mod identifier_entry;
pub mod lss;
mod multiplexer;
pub mod nmt;
mod node_id;
pub mod pdo;
pub mod sdo;
pub mod sync;
pub mod time;

pub use abort_code::AbortCode;
pub use connection_set::{PdoNumber, Service, cob_id, identify};
pub use multiplexer::Multiplexer;
pub use node_id::NodeId;
