//! What there is to build, and how a device may be told to behave.

use std::fmt;

use fieldproof_link::{Framing, Participant, SerialSettings};

use crate::liaomiao_encoder::Behaviour as EncoderBehaviour;
use crate::teco_jn5_cm_can::Behaviour as GatewayBehaviour;
use crate::{canopen, drive, modbus, named};

/// A kind of reference device.
#[derive(Debug, Clone, Copy)]
pub struct DeviceKind {
    /// Its name in a bench file: `kinco-servo`.
    pub name: &'static str,
    /// What it is, for people.
    pub title: &'static str,
    /// Its ports; a participant's port number counts them.
    pub ports: &'static [PortKind],
    /// The ways it can be made to depart from one clause, in lists by subject.
    pub faults: &'static [&'static [Fault]],
    /// The other things a right device of this kind may do.
    pub variants: &'static [Variant],
    /// Builds one, powered on since the lane was opened.
    ///
    /// # Errors
    /// [`UnknownFault`]: it has no fault or no variant of the name asked for.
    pub build: fn(&Settings) -> Result<Box<dyn Participant>, UnknownFault>,
}

/// One port of a kind of device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PortKind {
    /// The role that suites use: `can`, `serial`, `inverter`.
    pub role: &'static str,
    /// What it is, as the device leaves the factory.
    pub medium: Medium,
}

/// What a port is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Medium {
    /// A CAN port.
    Can {
        /// Bits a second.
        bit_rate: u32,
    },
    /// A serial port.
    Serial(SerialSettings),
    /// A port of Modbus TCP; further connections are ports behind all that a device has.
    Tcp,
}

/// How one device is to be built.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Settings {
    /// The CANopen node-ID, `1..=127`; the kind's own if `None`.
    pub node: Option<u8>,
    /// The Modbus address, `1..=247`; the kind's own if `None`.
    pub address: Option<u8>,
    /// The seed of its response times.
    pub seed: u64,
    /// The fault it has, by name.
    pub fault: Option<String>,
    /// The legal variant it is, by name.
    pub variant: Option<String>,
    /// How Modbus frames are told apart, if its Modbus port is a connection and not a serial line.
    pub framing: Option<Framing>,
}

/// One departure from one clause.
#[derive(Debug, Clone, Copy)]
pub struct Fault {
    /// Its name: `boot-up-missing`.
    pub name: &'static str,
    /// The clause or service it departs from.
    pub breaks: &'static str,
    /// What one sees, in the words of a bug report.
    pub words: &'static str,
    /// The suite or service that must catch it: `sdo`, `nmt`, `boot-up`, `error-control`, `pdo`, `lss`, `modbus`,
    /// `sync`, `time`, `store`, `emergency`, `cob-id`, `robustness`, `gateway`, `cia402`, `cia406`.
    pub caught_by: &'static str,
    pub(crate) apply: fn(&mut Behaviour),
}

impl Fault {
    /// What the first line of a failure names, one of these: the object, state or field that is wrong. Empty where nobody
    /// has said it yet.
    pub fn named(&self) -> &'static [&'static str] {
        named::of(self.name)
    }
}

/// Something else that a right device may do.
#[derive(Debug, Clone, Copy)]
pub struct Variant {
    /// Its name: `first-tpdo-after-an-event`.
    pub name: &'static str,
    /// What one sees, and why it is right.
    pub words: &'static str,
    pub(crate) apply: fn(&mut Behaviour),
}

/// Every setting of a device's behaviour. What a device has no use for stays at its default.
#[derive(Debug, Clone, Default)]
pub struct Behaviour {
    /// Its CANopen side.
    pub canopen: canopen::Behaviour,
    /// Its Modbus side.
    pub modbus: modbus::Behaviour,
    /// What an encoder measures, and how it shows that on CAN.
    pub encoder: EncoderBehaviour,
    /// A gateway between the two.
    pub gateway: GatewayBehaviour,
    /// A drive behind it.
    pub drive: drive::Behaviour,
}

/// The device has no fault or variant of this name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownFault {
    /// The kind of device.
    pub device: &'static str,
    /// The name asked for.
    pub name: String,
}

impl fmt::Display for UnknownFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} has no behaviour `{}`", self.device, self.name)
    }
}

impl std::error::Error for UnknownFault {}

impl DeviceKind {
    /// The ways it can be made to depart from one clause.
    pub fn faults(&self) -> impl Iterator<Item = &'static Fault> + use<> {
        self.faults.iter().copied().flatten()
    }

    /// `documented`, changed as `settings` ask.
    pub(crate) fn behaviour(
        &self,
        documented: Behaviour,
        settings: &Settings,
    ) -> Result<Behaviour, UnknownFault> {
        let mut behaviour = documented;
        if let Some(name) = &settings.variant {
            let variant = self.variants.iter().find(|variant| variant.name == name);
            (variant.ok_or_else(|| self.unknown(name))?.apply)(&mut behaviour);
        }
        if let Some(name) = &settings.fault {
            let fault = self.faults().find(|fault| fault.name == name);
            let applied = match fault {
                Some(fault) => {
                    (fault.apply)(&mut behaviour);
                    true
                }
                None => self.apply_fault_of_one_value(name, &mut behaviour),
            };
            if !applied {
                return Err(self.unknown(name));
            }
        }
        Ok(behaviour)
    }

    /// Whether `name` is one.
    fn apply_fault_of_one_value(&self, name: &str, behaviour: &mut Behaviour) -> bool {
        if let Some(fault) = canopen::ObjectFault::parse(name).filter(|_| self.is_canopen()) {
            behaviour.canopen.object_fault = Some(fault);
            return true;
        }
        if let Some(fault) = modbus::RegisterFault::parse(name).filter(|_| self.is_modbus_slave()) {
            behaviour.modbus.register_fault = Some(fault);
            return true;
        }
        false
    }

    fn is_modbus_slave(&self) -> bool {
        self.ports.iter().any(|port| port.role == "serial")
    }

    fn is_canopen(&self) -> bool {
        let is_can = |port: &PortKind| matches!(port.medium, Medium::Can { .. });
        self.ports.iter().any(is_can)
    }

    fn unknown(&self, name: &str) -> UnknownFault {
        UnknownFault {
            device: self.name,
            name: name.to_owned(),
        }
    }
}
