//! CAN frames and identifiers: the classic CAN data and remote frame, as ISO 11898-1 has them, the can-utils notation
//! for them (exact, and with wildcards), and how many bits they take on the bus.
//!
//! Nothing here knows a protocol, a clock or a socket.

mod frame;
mod id;
mod length;
mod notation;
mod pattern;

pub use frame::Frame;
pub use id::{ExtendedId, Id, StandardId};
pub use length::INTERMISSION_BITS;
pub use notation::NotationError;
pub use pattern::{BytePattern, MaskedByte, Pattern};
