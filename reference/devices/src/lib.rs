//! Reference devices: slaves that conform, of the kinds whose manuals the suites were written from.
//!
//! They are [`Participant`]s (sans-IO) with codecs of their own: a slave that shared the harness's codec would share its
//! mistakes. What a device does beside the plain standard is said in one [`Behaviour`]: its documented deviations, its
//! legal [`Variant`]s and its [`Fault`]s, each of which departs from one clause and from nothing else.

pub mod canopen;
mod canopen_complete;
pub mod catalogue;
mod conditions;
pub mod drive;
mod huacheng_ssts1;
pub mod inverter;
mod kinco_servo;
mod liaomiao_encoder;
pub mod modbus;
mod modbus_complete;
mod named;
pub mod neighbour;
#[cfg(test)]
mod script;
mod teco_jn5_cm_can;

pub use catalogue::{
    Behaviour, DeviceKind, Fault, Medium, PortKind, Settings, UnknownFault, Variant,
};

pub use liaomiao_encoder::{Behaviour as EncoderBehaviour, PresetEffect};
pub use teco_jn5_cm_can::{Behaviour as GatewayBehaviour, Lost, RunState, TargetSign};

#[cfg(doc)]
use fieldproof_link::Participant;

/// Every kind of reference device, by name.
pub fn kinds() -> &'static [DeviceKind] {
    &[
        canopen_complete::KIND,
        huacheng_ssts1::KIND,
        kinco_servo::KIND,
        liaomiao_encoder::KIND,
        modbus_complete::KIND,
        inverter::KIND,
        teco_jn5_cm_can::KIND,
    ]
}

/// The kind called `name`, if there is one.
pub fn kind(name: &str) -> Option<&'static DeviceKind> {
    kinds().iter().find(|kind| kind.name == name)
}
