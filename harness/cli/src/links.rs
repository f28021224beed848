//! Opens the links that a bench names.

use fieldproof_link::SerialSettings;
use fieldproof_link::real::{LocalEcho, OpenError, Port, Serial, SerialOptions, Slcan, SocketCan};
use fieldproof_suite::bench::{Echo, Link, LinkKind};
use fieldproof_suite::device::PortDescription;

use crate::bench::serial;

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
        _ => return Err(cannot_carry(link, role)),
    })
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

/// Opens `link` for the port `role` of a reference device.
///
/// # Errors
/// As [`open`].
pub(crate) fn open_to_serve(
    role: &str,
    link: &Link,
    described: &PortDescription,
) -> Result<Box<dyn Port>, OpenError> {
    open(role, link, described)
}
