//! A CANopen slave, driven from outside: object dictionary, SDO server, NMT, error control, PDO, SYNC, EMCY, LSS.
//!
//! A device gives it a profile (what it can do), an application (what its objects mean) and a [`Behaviour`].

mod abort;
mod address;
mod behaviour;
pub(crate) mod block_faults;
mod cob_id;
mod consumers;
mod emergency;
mod error_control;
pub(crate) mod faults;
mod lss;
mod lss_departures;
pub(crate) mod lss_faults;
mod lss_services;
mod memory;
mod nmt;
mod object_fault;
mod objects;
mod pdo;
mod pdo_rules;
mod profile;
mod queue;
mod robustness;
pub(crate) mod robustness_faults;
mod sdo;
pub(crate) mod service_faults;
mod services;
mod slave;
mod state;
mod sync;
mod time;
mod tpdo;
pub(crate) mod variants;
mod write;

pub(crate) use abort::Abort;
pub(crate) use address::Address;
pub use behaviour::{AbortMultiplexer, Behaviour, NmtAddress, NodeActivation, StateCodes};
pub(crate) use emergency::{DeviceError, HARDWARE};
pub use lss_departures::LssDepartures;
use nmt::State;
pub use object_fault::{ObjectFault, ObjectFaultKind};
pub(crate) use objects::Objects;
pub(crate) use profile::{Answer, Application, LssAbilities, Profile, TransmitEvent};
pub use robustness::Robustness;
pub use sdo::{BlockTransfer, Recovery};
pub(crate) use slave::{Factory, Slave};
