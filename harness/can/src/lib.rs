//! CAN frames and identifiers: the classic CAN data and remote frame, as ISO 11898-1 has them.
//!
//! Nothing here knows a protocol, a clock or a socket.

mod frame;
mod id;

pub use frame::Frame;
pub use id::{ExtendedId, Id, StandardId};
