//! `fieldproof serve`

use std::path::Path;

use fieldproof_devices::inverter::Inverter;
use fieldproof_devices::{DeviceKind, Medium, Settings};
use fieldproof_link::real::serve::{Control, serve as run_server};
use fieldproof_link::real::{OpenError, Port, TcpServer};
use fieldproof_link::{Connected, Framing, Joined, Parity, Participant, SerialSettings, StopBits};
use fieldproof_report::{Problem, Severity};
use fieldproof_suite::bench::{Link, LinkKind};
use fieldproof_suite::device::{self, PortDescription};

use crate::complaint::{Complaint, with_choice};
use crate::control::ControlSocket;
use crate::exit::Exit;
use crate::options::ServeOptions;
use crate::screen::Screen;
use crate::{links, stop};

/// Runs a reference device on real links until interrupted.
pub(crate) fn serve(options: &ServeOptions, screen: &mut Screen) -> Result<Exit, Complaint> {
    let kind = kind(&options.device)?;
    let on = options.on.iter().map(|text| split(text));
    let on = on.collect::<Result<Vec<_>, Complaint>>()?;
    let over_tcp = on.iter().find(|on| on.link.kind == LinkKind::Tcp);
    let settings = Settings {
        node: options.node,
        address: options.address,
        seed: options.seed,
        fault: options.fault.clone(),
        variant: options.variant.clone(),
        framing: over_tcp.map(|on| links::framing(&on.link)),
    };
    let device = (kind.build)(&settings).map_err(|error| {
        Complaint::input(
            Problem::new(Severity::Error, error.to_string())
                .help("`fieldproof faults` lists the faults, `fieldproof devices` the variants"),
        )
    })?;
    let ports = open_ports(kind, &on)?;
    let (numbers, ports): (Vec<usize>, Vec<Box<dyn Port>>) = ports.into_iter().unzip();
    let device = with_inverter(kind, device, &numbers, options.seed);
    let device = Box::new(Connected::new(device, numbers));
    let mut control = open_control(options.control.as_deref())?;
    let stop = stop::on_interrupt()?;
    let mut links: Vec<&str> = ports
        .iter()
        .map(|port| port.properties().link.as_str())
        .collect();
    links.dedup();
    for link in links {
        screen.print(&format!("{} is on {link}\n", kind.name));
    }
    // Scripts wait for this line before they talk to the device.
    screen.print("ready\n");
    screen.flush();
    run_server(device, ports, control.as_mut(), stop)
        .map_err(|error| Complaint::bench(error.to_string()))?;
    Ok(Exit::Passed)
}

fn kind(name: &str) -> Result<&'static DeviceKind, Complaint> {
    fieldproof_devices::kind(name).ok_or_else(|| {
        let known: Vec<&str> = fieldproof_devices::kinds()
            .iter()
            .map(|kind| kind.name)
            .collect();
        Complaint::unknown("reference device", name, &known)
    })
}

/// A module that is a part of an inverter has one behind it, unless its port to it is connected to something else.
fn with_inverter(
    kind: &DeviceKind,
    device: Box<dyn Participant>,
    connected: &[usize],
    seed: u64,
) -> Box<dyn Participant> {
    let to_inverter = kind.ports.iter().position(|port| port.role == INVERTER);
    match to_inverter {
        Some(number) if !connected.contains(&number) => {
            Box::new(Joined::new(device, number, Box::new(Inverter::new(seed))))
        }
        _ => device,
    }
}

/// The role of a port to an inverter.
const INVERTER: &str = "inverter";

fn open_control(path: Option<&Path>) -> Result<Box<dyn Control>, Complaint> {
    match path {
        None => Ok(Box::new(())),
        Some(path) => match ControlSocket::listen(path) {
            Ok(socket) => Ok(Box::new(socket)),
            Err(error) => Err(Complaint::unwritable(path.display(), &error)),
        },
    }
}

/// The number that a port has for the device, and what is open for it.
type OpenPort = (usize, Box<dyn Port>);

/// Opens every link for the port of the device that it names, or for the first free one that it can carry.
fn open_ports(kind: &DeviceKind, on: &[On<'_>]) -> Result<Vec<OpenPort>, Complaint> {
    let mut ports: Vec<OpenPort> = Vec::new();
    for On { text, role, link } in on {
        let carries = |number: &usize| match kind.ports[*number].medium {
            Medium::Can { .. } => link.kind.carries_can(),
            Medium::Serial(_) => link.kind.carries_serial(),
            Medium::Tcp => is_modbus_tcp(link),
        };
        let is_meant = |number: &usize| role.is_none_or(|role| kind.ports[*number].role == role);
        let is_free = |number: &usize| ports.iter().all(|(taken, _)| taken != number);
        let fits = |number: &usize| is_meant(number) && carries(number) && is_free(number);
        let numbers = || (0..kind.ports.len()).filter(fits);
        let is_own = |number: &usize| kind.ports[*number].medium == Medium::Tcp;
        let Some(number) = numbers().find(is_own).or_else(|| numbers().next()) else {
            return Err(no_port(kind, text, *role));
        };
        let port = kind.ports[number];
        if port.medium == Medium::Tcp {
            ports.extend(connections(kind, number, link)?);
            continue;
        }
        let port = links::open_to_serve(port.role, link, &described(port.medium))
            .map_err(|error| Complaint::bench(error.to_string()))?;
        ports.push((number, port));
    }
    Ok(ports)
}

/// So many connections are served at once.
const CONNECTIONS: usize = 16;

/// The ports of as many connections: the device's own port, and those behind all that it has.
fn connections(kind: &DeviceKind, number: usize, link: &Link) -> Result<Vec<OpenPort>, Complaint> {
    let role = kind.ports[number].role;
    let broken = |error: OpenError| Complaint::bench(error.to_string());
    let first = TcpServer::listen(role, &link.target, links::framing(link)).map_err(broken)?;
    let mut further: Vec<OpenPort> = Vec::new();
    for place in 1..CONNECTIONS {
        let beside = first.beside().map_err(broken)?;
        further.push((kind.ports.len() + place - 1, Box::new(beside)));
    }
    let mut all: Vec<OpenPort> = vec![(number, Box::new(first))];
    all.append(&mut further);
    Ok(all)
}

fn is_modbus_tcp(link: &Link) -> bool {
    link.kind == LinkKind::Tcp && links::framing(link) == Framing::ModbusTcp
}

/// What a device is put on.
struct On<'t> {
    text: &'t str,
    role: Option<&'t str>,
    link: Link,
}

/// `can=socketcan:vcan0` names the port, `socketcan:vcan0` leaves it open.
fn split(text: &str) -> Result<On<'_>, Complaint> {
    let (role, link) = match text.split_once('=') {
        Some((role, link)) if !role.contains(':') => (Some(role), link),
        _ => (None, text),
    };
    let link = links::read(link)?;
    Ok(On { text, role, link })
}

fn no_port(kind: &DeviceKind, text: &str, role: Option<&str>) -> Complaint {
    let known: Vec<&str> = kind.ports.iter().map(|port| port.role).collect();
    let message = format!("{} has no free port for \"{text}\"", kind.name);
    let problem = Problem::new(Severity::Error, message);
    Complaint::input(with_choice(problem, role.unwrap_or_default(), &known))
}

/// As the device leaves the factory.
fn described(medium: Medium) -> PortDescription {
    match medium {
        Medium::Can { bit_rate } => PortDescription::Can { bit_rate },
        // Nothing says where it listens until it does.
        Medium::Tcp => PortDescription::Tcp { port: 0 },
        Medium::Serial(SerialSettings {
            baud,
            parity,
            stop_bits,
        }) => PortDescription::Serial {
            baud,
            parity: match parity {
                Parity::None => device::Parity::None,
                Parity::Even => device::Parity::Even,
                Parity::Odd => device::Parity::Odd,
            },
            stop_bits: match stop_bits {
                StopBits::One => 1,
                StopBits::Two => 2,
            },
            companion: None,
        },
    }
}
