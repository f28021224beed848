//! Opens the links that a bench names.

use std::time::Duration;

use fieldproof_link::real::{
    LocalEcho, OpenError, Port, Serial, SerialOptions, Slcan, SocketCan, Tcp, TcpServer,
};
use fieldproof_link::{Framing, SerialSettings};
use fieldproof_report::{Problem, Severity};
use fieldproof_suite::bench::{self, Echo, Link, LinkKind};
use fieldproof_suite::device::PortDescription;

use crate::bench::serial;
use crate::complaint::Complaint;

/// Reads a link from the command line.
///
/// # Errors
/// It is none.
pub(crate) fn read(text: &str) -> Result<Link, Complaint> {
    text.parse::<Link>().map_err(|wrong| {
        let problem = Problem::new(Severity::Error, wrong.message).note(wrong.expected);
        Complaint::input(match wrong.help {
            Some(help) => problem.help(help),
            None => problem,
        })
    })
}

/// Opens `link` for the port `role`, set as the link says, or else as the device's description does.
///
/// # Errors
/// [`OpenError`]: there is no such thing, or it cannot be set so.
pub(crate) fn open(
    role: &str,
    link: &Link,
    described: &PortDescription,
) -> Result<Box<dyn Port>, OpenError> {
    let parameters = &link.parameters;
    let (target, uncertainty) = (link.target.as_str(), parameters.uncertainty);
    Ok(match (link.kind, described) {
        (LinkKind::SocketCan, PortDescription::Can { bit_rate }) => {
            Box::new(SocketCan::open(role, target, *bit_rate, uncertainty)?)
        }
        (LinkKind::Slcan, PortDescription::Can { bit_rate }) => {
            let bit_rate = parameters.bit_rate.unwrap_or(*bit_rate);
            Box::new(Slcan::open(role, target, bit_rate, uncertainty)?)
        }
        (LinkKind::Serial, PortDescription::Serial { .. }) => {
            let options = SerialOptions {
                echo: match parameters.echo {
                    Some(Echo::Yes) => LocalEcho::Yes,
                    Some(Echo::No) => LocalEcho::No,
                    Some(Echo::Auto) | None => LocalEcho::Auto,
                },
                uncertainty,
            };
            let settings = settings(link, described)?;
            Box::new(Serial::open(role, target, settings, options)?)
        }
        (LinkKind::Tcp, PortDescription::Serial { .. }) => Box::new(Tcp::open(
            role,
            target,
            framing(link),
            CONNECT_TIMEOUT,
            uncertainty,
        )?),
        (LinkKind::Tcp, PortDescription::Tcp { .. }) => Box::new(Tcp::open(
            role,
            target,
            Framing::ModbusTcp,
            CONNECT_TIMEOUT,
            uncertainty,
        )?),
        _ => return Err(cannot_carry(link, role)),
    })
}

/// How long a server may take to accept a connection.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(3);

/// Modbus TCP, unless the link says otherwise.
pub(crate) fn framing(link: &Link) -> Framing {
    match link.parameters.framing {
        Some(bench::Framing::Rtu) => Framing::Rtu,
        Some(bench::Framing::Tcp) | None => Framing::ModbusTcp,
    }
}

fn settings(link: &Link, described: &PortDescription) -> Result<SerialSettings, OpenError> {
    let PortDescription::Serial {
        baud,
        parity,
        stop_bits,
        ..
    } = described
    else {
        return Err(cannot_carry(link, "CAN"));
    };
    let parameters = &link.parameters;
    Ok(serial(
        parameters.baud.unwrap_or(*baud),
        parameters.parity.unwrap_or(*parity),
        parameters.stop_bits.unwrap_or(*stop_bits),
    ))
}

fn cannot_carry(link: &Link, role: &str) -> OpenError {
    let text = format!("{}:{}", link.kind.name(), link.target);
    OpenError::new(&text, format!("it carries no {role} port"))
}

/// Opens `link` for the port `role` of a reference device, which listens where a tester connects.
///
/// # Errors
/// As [`open`].
pub(crate) fn open_to_serve(
    role: &str,
    link: &Link,
    described: &PortDescription,
) -> Result<Box<dyn Port>, OpenError> {
    match link.kind {
        LinkKind::Tcp => Ok(Box::new(TcpServer::listen(
            role,
            &link.target,
            framing(link),
        )?)),
        _ => open(role, link, described),
    }
}
