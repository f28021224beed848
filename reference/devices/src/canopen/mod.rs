//! A CANopen slave, driven from outside: object dictionary, SDO server, NMT, error control, PDO, SYNC, EMCY, LSS.
//!
//! A device gives it a profile (what it can do), an application (what its objects mean) and a [`Behaviour`].

mod abort;
mod address;
mod behaviour;
pub(crate) mod block_faults;
mod cob_id;
pub(crate) mod communication_faults;
mod consumers;
mod departures;
mod emergency;
mod error_control;
pub(crate) mod error_control_faults;
mod error_control_settings;
pub(crate) mod faults;
mod lss;
mod lss_departures;
pub(crate) mod lss_faults;
mod lss_services;
mod memory;
mod nmt;
pub(crate) mod nmt_faults;
mod nmt_settings;
mod object_fault;
mod objects;
mod pdo;
mod pdo_behaviour;
pub(crate) mod pdo_faults;
mod pdo_rules;
mod profile;
mod queue;
mod robustness;
pub(crate) mod robustness_faults;
mod sdo;
pub(crate) mod sdo_faults;
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
pub use departures::{Departures, Manners};
pub(crate) use emergency::{DeviceError, HARDWARE};
pub use error_control_settings::ErrorControlSettings;
pub use lss_departures::LssDepartures;
use nmt::State;
pub use nmt_settings::NmtSettings;
pub use object_fault::{ObjectFault, ObjectFaultKind};
pub(crate) use objects::Objects;
pub use pdo_behaviour::PdoBehaviour;
pub(crate) use profile::{Answer, Application, LssAbilities, Profile, TransmitEvent};
pub use robustness::Robustness;
pub use sdo::{
    BlockTransfer, ClientAbort, OrdinaryTransfer, ReadOnly, Recovery, SecondInitiate, ShortRequest,
    StraySegment,
};
pub(crate) use slave::{Factory, Slave};
