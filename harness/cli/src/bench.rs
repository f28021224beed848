//! The bench: a reference device on simulated buses, or a device on real links, with what its description connects to it.

use std::collections::BTreeSet;
use std::fmt;

use fieldproof_devices::inverter::Inverter;
use fieldproof_devices::neighbour::Neighbour;
use fieldproof_devices::{Medium, PortKind, Settings, UnknownFault};
use fieldproof_link::real::{NoStimuli, OpenError, RealLane, Stimuli};
use fieldproof_link::sim::{Builder, SimLane};
use fieldproof_link::{
    Framing, Lane, Line, Parity, Participant, PortIndex, PortProperties, SerialSettings,
    StimulusKind, StopBits,
};
use fieldproof_run::Bench;
use fieldproof_suite::bench::{self, LinkKind};
use fieldproof_suite::device::{self, DeviceDescription, PortDescription};
use fieldproof_suite::model::{Depth, Effect, StimulusName};

use crate::library::{Device, Place};
use crate::line_trouble::LineTrouble;
use crate::links;
use crate::operator::{ByCommand, ByHand, Operator};

/// How the reference device is built.
#[derive(Debug, Clone, Default)]
pub struct Behaviour {
    /// The fault it has, by name.
    pub fault: Option<String>,
    /// The legal variant it is, by name.
    pub variant: Option<String>,
    /// The seed of its response times.
    pub seed: u64,
    /// What is wrong with the line between it and the tester.
    pub line: Option<LineTrouble>,
}

/// Why a device could not be connected.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NotConnected {
    /// It has no such fault or variant.
    Unknown(UnknownFault),
    /// There is no reference device of this name that could be simulated.
    NotSimulated(String),
    /// A link cannot be opened.
    Link(OpenError),
}

impl fmt::Display for NotConnected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NotConnected::Unknown(error) => error.fmt(f),
            NotConnected::Link(error) => error.fmt(f),
            NotConnected::NotSimulated(name) => {
                write!(f, "there is no reference device \"{name}\" to simulate it")
            }
        }
    }
}

impl std::error::Error for NotConnected {}

/// Connects `device` as its bench says.
///
/// # Errors
/// It has no such fault or variant, or no reference device, or a link cannot be opened.
pub(crate) fn open(
    device: &Device,
    behaviour: &Behaviour,
    operator: &Operator,
) -> Result<Box<dyn Lane>, NotConnected> {
    match &device.place {
        Some(place) if !device.is_simulated() => {
            let lane = open_real(device, place, behaviour.seed, operator)?;
            Ok(Box::new(lane))
        }
        _ => {
            let lane = Box::new(connect(device, behaviour)?);
            Ok(match behaviour.line {
                Some(trouble) => trouble.between(lane, &device.description),
                None => lane,
            })
        }
    }
}

fn open_real(
    device: &Device,
    place: &Place,
    seed: u64,
    operator: &Operator,
) -> Result<RealLane, NotConnected> {
    let mut ports = Vec::new();
    let mut companions = Vec::new();
    for (role, link) in &place.links {
        let Some(described) = device.description.ports.get(role) else {
            continue;
        };
        ports.push(links::open(role, link, described).map_err(NotConnected::Link)?);
        if let PortDescription::Serial {
            companion: Some(name),
            ..
        } = described
        {
            let port = PortIndex(ports.len() - 1);
            companions.extend(companion(name, seed).map(|it| (port, it)));
        }
    }
    let mut lane = RealLane::new(ports, stimuli(place, operator));
    for (port, companion) in companions {
        lane.attach(port, companion);
    }
    Ok(lane)
}

/// Only what the bench lists, by its command or else by the operator's hand.
fn stimuli(place: &Place, operator: &Operator) -> Box<dyn Stimuli> {
    let offers = offered(place);
    if let Some(command) = &place.stimulus_command {
        return Box::new(ByCommand::new(command.clone(), offers));
    }
    match ByHand::new(operator, &place.name, offers) {
        Some(by_hand) => Box::new(by_hand),
        None => Box::new(NoStimuli),
    }
}

fn offered(place: &Place) -> Vec<StimulusKind> {
    let there = place.stimuli.iter().flatten();
    there.map(|name| stimulus_kind(*name)).collect()
}

/// Connects `device` to simulated buses, set as its description says, with all that stands around it.
///
/// # Errors
/// It has no such fault or variant, or no reference device.
pub(crate) fn connect(device: &Device, behaviour: &Behaviour) -> Result<SimLane, NotConnected> {
    let description = &device.description;
    let Some(kind) = device.kind else {
        return Err(NotConnected::NotSimulated(description.device.clone()));
    };
    let settings = Settings {
        node: description.canopen.as_ref().map(|canopen| canopen.node),
        address: description.modbus.as_ref().map(|modbus| modbus.address),
        seed: behaviour.seed,
        fault: behaviour.fault.clone(),
        variant: behaviour.variant.clone(),
        framing: None,
    };
    let participant = (kind.build)(&settings).map_err(NotConnected::Unknown)?;
    let mut builder = Builder::new();
    let mut ports = Vec::new();
    let mut companions: Vec<(PortIndex, Box<dyn Participant>)> = Vec::new();
    for port in kind.ports {
        let described = description.ports.get(port.role);
        ports.push(match described {
            Some(PortDescription::Can { bit_rate }) => builder.can_bus(port.role, *bit_rate),
            Some(PortDescription::Serial {
                baud,
                parity,
                stop_bits,
                ..
            }) => builder.serial_line(port.role, serial(*baud, *parity, *stop_bits)),
            Some(PortDescription::Tcp { .. }) => builder.connection(port.role, Framing::ModbusTcp),
            None => match port.medium {
                Medium::Tcp => builder.connection(port.role, Framing::ModbusTcp),
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
    if behaviour.line == Some(LineTrouble::Neighbour) {
        for (kind, port) in kind.ports.iter().zip(&ports) {
            if let Some(bit_rate) = can_bit_rate(description, kind) {
                builder.participant(Box::new(Neighbour::new(bit_rate)), &[*port]);
            }
        }
    }
    let mut lane = builder.build();
    for (port, companion) in companions {
        lane.attach(port, companion);
    }
    Ok(lane)
}

/// What its CAN port is set to as the device leaves the factory, or as the description says.
fn can_bit_rate(description: &DeviceDescription, kind: &PortKind) -> Option<u32> {
    match (description.ports.get(kind.role), kind.medium) {
        (Some(PortDescription::Can { bit_rate }), _) => Some(*bit_rate),
        (None, Medium::Can { bit_rate }) => Some(bit_rate),
        _ => None,
    }
}

/// The companions that a description can name.
pub(crate) const COMPANIONS: [&str; 1] = ["teco-inverter"];

fn companion(name: &str, seed: u64) -> Option<Box<dyn Participant>> {
    (name == COMPANIONS[0]).then(|| Box::new(Inverter::new(seed)) as Box<dyn Participant>)
}

pub(crate) fn serial(baud: u32, parity: device::Parity, stop_bits: u8) -> SerialSettings {
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
    let ports = lane.ports().iter().map(|port| port.name.clone()).collect();
    let roles = |wanted: fn(&PortProperties) -> bool| {
        let ports = lane.ports().iter().filter(move |port| wanted(port));
        ports.map(|port| port.name.clone()).collect()
    };
    Bench {
        fixed_rates: roles(|port| !port.sets_bit_rate),
        modbus_tcp: roles(|port| port.line == Line::Stream(Framing::ModbusTcp)),
        streams: roles(|port| matches!(port.line, Line::Stream(_))),
        ..bench_of(device, ports, lane.offers().into_iter().collect(), permits)
    }
}

/// As far as it is known of a device that is not simulated, before its links are opened: its ports, and the stimuli that
/// somebody can give.
pub(crate) fn described_bench(
    device: &Device,
    permits: &BTreeSet<Effect>,
    operator: &Operator,
) -> Bench {
    let ports = device.description.ports.keys().cloned().collect();
    let place = device.place.as_ref();
    let place = place.filter(|it| it.stimulus_command.is_some() || !operator.is_none());
    let stimuli = place.map(offered).unwrap_or_default();
    bench_of(device, ports, stimuli.into_iter().collect(), permits)
}

/// A bench file takes away what it does not mention.
fn bench_of(
    device: &Device,
    mut ports: BTreeSet<String>,
    mut stimuli: BTreeSet<StimulusKind>,
    permits: &BTreeSet<Effect>,
) -> Bench {
    let mut permits = permits.clone();
    if let Some(place) = &device.place {
        ports.retain(|role| place.links.contains_key(role));
        permits.retain(|effect| place.permits.contains(effect));
        if let Some(there) = &place.stimuli {
            let there: BTreeSet<StimulusKind> =
                there.iter().map(|name| stimulus_kind(*name)).collect();
            stimuli.retain(|kind| there.contains(kind));
        }
    }
    let description = &device.description;
    let links = || device.place.iter().flat_map(|place| &place.links);
    let links_over_tcp = links()
        .filter(|(_, link)| link.kind == LinkKind::Tcp)
        .map(|(role, _)| role.clone())
        .collect();
    let over_tcp = links().filter(|(_, link)| {
        link.kind == LinkKind::Tcp && link.parameters.framing != Some(bench::Framing::Rtu)
    });
    let over_tcp = over_tcp.map(|(role, _)| role);
    let described = description.ports.iter();
    let described = described.filter(|(_, port)| matches!(port, PortDescription::Tcp { .. }));
    let described = described.map(|(role, _)| role);
    let described = described.filter(|role| ports.contains(*role));
    Bench {
        modbus_tcp: over_tcp.chain(described).cloned().collect(),
        ports,
        streams: links_over_tcp,
        fixed_rates: BTreeSet::new(),
        stimuli,
        permits,
        depth: Depth::Default,
        node: description.canopen.as_ref().map(|canopen| canopen.node),
        address: description.modbus.as_ref().map(|modbus| modbus.address),
    }
}

const fn stimulus_kind(name: StimulusName) -> StimulusKind {
    match name {
        StimulusName::Power => StimulusKind::Power,
        StimulusName::ProcessValue => StimulusKind::ProcessValue,
        StimulusName::Condition => StimulusKind::Condition,
        StimulusName::Setting => StimulusKind::Setting,
    }
}
