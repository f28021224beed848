//! The simulated bench: a reference device on simulated buses, with what its description connects to it.

use std::collections::BTreeSet;

use fieldproof_devices::inverter::Inverter;
use fieldproof_devices::{Medium, Settings, UnknownFault};
use fieldproof_link::sim::{Builder, SimLane};
use fieldproof_link::{Lane, Parity, Participant, PortIndex, SerialSettings, StopBits};
use fieldproof_run::Bench;
use fieldproof_suite::device::{self, PortDescription};
use fieldproof_suite::model::Effect;

use crate::library::Device;

/// How the reference device is built.
#[derive(Debug, Clone, Default)]
pub struct Behaviour {
    /// The fault it has, by name.
    pub fault: Option<String>,
    /// The legal variant it is, by name.
    pub variant: Option<String>,
    /// The seed of its response times.
    pub seed: u64,
}

/// Connects `device` to simulated buses, set as its description says, with all that stands around it.
///
/// # Errors
/// It has no such fault or variant.
pub(crate) fn connect(device: &Device, behaviour: &Behaviour) -> Result<SimLane, UnknownFault> {
    let description = &device.description;
    let settings = Settings {
        node: description.canopen.as_ref().map(|canopen| canopen.node),
        address: description.modbus.as_ref().map(|modbus| modbus.address),
        seed: behaviour.seed,
        fault: behaviour.fault.clone(),
        variant: behaviour.variant.clone(),
    };
    let participant = (device.kind.build)(&settings)?;
    let mut builder = Builder::new();
    let mut ports = Vec::new();
    let mut companions: Vec<(PortIndex, Box<dyn Participant>)> = Vec::new();
    for port in device.kind.ports {
        let described = description.ports.get(port.role);
        ports.push(match described {
            Some(PortDescription::Can { bit_rate }) => builder.can_bus(port.role, *bit_rate),
            Some(PortDescription::Serial {
                baud,
                parity,
                stop_bits,
                ..
            }) => builder.serial_line(port.role, serial(*baud, *parity, *stop_bits)),
            None => match port.medium {
                Medium::Can { bit_rate } => builder.can_bus(port.role, bit_rate),
                Medium::Serial(settings) => builder.serial_line(port.role, settings),
            },
        });
        if let (
            Some(PortDescription::Serial {
                companion: Some(name),
                ..
            }),
            Some(port),
        ) = (described, ports.last())
        {
            companions.extend(companion(name, behaviour.seed).map(|it| (*port, it)));
        }
    }
    builder.device(participant, &ports);
    let mut lane = builder.build();
    for (port, companion) in companions {
        lane.attach(port, companion);
    }
    Ok(lane)
}

/// The companions that a description can name.
pub(crate) const COMPANIONS: [&str; 1] = ["teco-inverter"];

fn companion(name: &str, seed: u64) -> Option<Box<dyn Participant>> {
    (name == COMPANIONS[0]).then(|| Box::new(Inverter::new(seed)) as Box<dyn Participant>)
}

fn serial(baud: u32, parity: device::Parity, stop_bits: u8) -> SerialSettings {
    SerialSettings {
        baud,
        parity: match parity {
            device::Parity::None => Parity::None,
            device::Parity::Even => Parity::Even,
            device::Parity::Odd => Parity::Odd,
        },
        stop_bits: if stop_bits == 2 {
            StopBits::Two
        } else {
            StopBits::One
        },
    }
}

/// What `lane` has and permits, for the engine.
pub(crate) fn bench(device: &Device, lane: &dyn Lane, permits: &BTreeSet<Effect>) -> Bench {
    Bench {
        ports: lane.ports().iter().map(|port| port.name.clone()).collect(),
        stimuli: lane.offers().into_iter().collect(),
        permits: permits.clone(),
        node: device
            .description
            .canopen
            .as_ref()
            .map(|canopen| canopen.node),
        address: device
            .description
            .modbus
            .as_ref()
            .map(|modbus| modbus.address),
    }
}
