//! Real links: a [`RealLane`] joins open [`Port`]s, and [`serve`](mod@serve) lets a device take part in them.

mod clock;
mod connection;
mod hardware_clock;
mod hub;
mod lane;
mod open_error;
mod port;
mod ports;
mod raw_frame;
mod serial;
pub mod serve;
pub mod slcan;
mod socketcan;
mod tcp;
mod tcp_server;

pub use clock::Clock;
pub use hub::{Hub, HubOptions};
pub use lane::{NoStimuli, RealLane, Stimuli};
pub use open_error::OpenError;
pub use port::{Departure, News, Port, SHORT_WAIT, SendError};
pub use serial::{LocalEcho, Serial, SerialOptions};
pub use slcan::Slcan;
pub use socketcan::SocketCan;
pub use tcp::Tcp;
pub use tcp_server::TcpServer;
