//! Opens the links that a bench names.

use fieldproof_link::real::{OpenError, Port, SocketCan};
use fieldproof_suite::bench::{Link, LinkKind};
use fieldproof_suite::device::PortDescription;

/// Opens `link` for the port `role`, set as the link says, or else as the device's description does.
///
/// # Errors
/// [`OpenError`]: there is no such thing, or it cannot be set so.
pub(crate) fn open(
    role: &str,
    link: &Link,
    described: &PortDescription,
) -> Result<Box<dyn Port>, OpenError> {
    let uncertainty = link.parameters.uncertainty;
    match (link.kind, described) {
        (LinkKind::SocketCan, PortDescription::Can { bit_rate }) => {
            let port = SocketCan::open(role, &link.target, *bit_rate, uncertainty)?;
            Ok(Box::new(port))
        }
        _ => Err(OpenError::new(
            &format!("{}:{}", link.kind.name(), link.target),
            "this version cannot open it",
        )),
    }
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
