//! Access to a frame that must be of a known service.

use fieldproof_can::Frame;

use super::{NodeId, Service, identify};
use crate::{Rule, Violation};

/// The bytes of `frame`, which must be a data frame on the one identifier of `service`.
pub(crate) fn broadcast(frame: &Frame, service: Service) -> Result<&[u8], Violation> {
    match frame.standard_id().and_then(identify) {
        Some((found, None)) if found == service => data_of(frame),
        _ => Err(wrong_identifier(frame, service)),
    }
}

/// The node and the bytes of `frame`, which must be a data frame on an identifier of `service`.
pub(crate) fn from_node(frame: &Frame, service: Service) -> Result<(NodeId, &[u8]), Violation> {
    Ok((node_of(frame, service)?, data_of(frame)?))
}

/// The node of `frame`, which must have an identifier of `service`.
pub(crate) fn node_of(frame: &Frame, service: Service) -> Result<NodeId, Violation> {
    match frame.standard_id().and_then(identify) {
        Some((found, Some(node))) if found == service => Ok(node),
        _ => Err(wrong_identifier(frame, service)),
    }
}

fn data_of(frame: &Frame) -> Result<&[u8], Violation> {
    if frame.is_remote() {
        let found = "a remote frame";
        return Err(Violation::new(Rule::FrameKind, 0, found, "a data frame"));
    }
    Ok(frame.bytes())
}

fn wrong_identifier(frame: &Frame, service: Service) -> Violation {
    Violation::new(
        Rule::Identifier,
        0,
        format!("{}h", frame.id()),
        format!("an identifier of {service}"),
    )
}
