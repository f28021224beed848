//! Access to a frame that must be a data frame of a known service.

use fieldproof_can::Frame;

use super::{NodeId, Service, identify};
use crate::{Rule, Violation};

/// The node and the bytes of `frame`, which must be a data frame on an identifier of `service`.
pub(super) fn bytes_of(
    frame: &Frame,
    service: Service,
) -> Result<(Option<NodeId>, &[u8]), Violation> {
    let node = node_of(frame, service)?;
    if frame.is_remote() {
        return Err(Violation::new(
            Rule::FrameKind,
            0,
            "a remote frame",
            "a data frame",
        ));
    }
    Ok((node, frame.bytes()))
}

/// The node of `frame`, which must have an identifier of `service`.
pub(super) fn node_of(frame: &Frame, service: Service) -> Result<Option<NodeId>, Violation> {
    match frame.standard_id().and_then(identify) {
        Some((found, node)) if found == service => Ok(node),
        _ => Err(Violation::new(
            Rule::Identifier,
            0,
            format!("{}h", frame.id()),
            format!("an identifier of {service}"),
        )),
    }
}
