//! The predefined connection set: which identifier belongs to which service of which node.
//!
//! | service | function code | identifiers |
//! | --- | --- | --- |
//! | NMT | 0000b | 000h |
//! | SYNC | 0001b | 080h |
//! | TIME | 0010b | 100h |
//! | EMCY | 0001b | 081h..0FFh |
//! | TPDO1, RPDO1 | 0011b, 0100b | 181h..1FFh, 201h..27Fh |
//! | TPDO2, RPDO2 | 0101b, 0110b | 281h..2FFh, 301h..37Fh |
//! | TPDO3, RPDO3 | 0111b, 1000b | 381h..3FFh, 401h..47Fh |
//! | TPDO4, RPDO4 | 1001b, 1010b | 481h..4FFh, 501h..57Fh |
//! | SDO response, request | 1011b, 1100b | 581h..5FFh, 601h..67Fh |
//! | NMT error control | 1110b | 701h..77Fh |
//! | LSS response, request (CiA 305) | | 7E4h, 7E5h |

use std::fmt;

use fieldproof_can::StandardId;

use super::NodeId;

bounded! {
    /// The number of a PDO that has a predefined identifier, `1..=4`.
    pub struct PdoNumber(u8) in 1..=4
}

/// A communication service with a predefined identifier. Transmit and receive are meant from the node's side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Service {
    /// NMT node control, from the NMT master.
    Nmt,
    /// SYNC.
    Sync,
    /// TIME.
    Time,
    /// EMCY, from a node.
    Emergency,
    /// A PDO that the node sends.
    TransmitPdo(PdoNumber),
    /// A PDO that the node receives.
    ReceivePdo(PdoNumber),
    /// The default SDO, server to client.
    SdoResponse,
    /// The default SDO, client to server.
    SdoRequest,
    /// Boot-up, heartbeat and node guarding.
    ErrorControl,
    /// LSS, slave to master.
    LssResponse,
    /// LSS, master to slaves.
    LssRequest,
}

impl Service {
    /// Whether every node has an identifier of its own for it.
    pub const fn is_per_node(self) -> bool {
        !matches!(
            self,
            Service::Nmt
                | Service::Sync
                | Service::Time
                | Service::LssResponse
                | Service::LssRequest
        )
    }

    /// The identifier without the node-ID, at most 780h where there is one per node.
    const fn base(self) -> u16 {
        match self {
            Service::Nmt => 0x000,
            Service::Sync | Service::Emergency => 0x080,
            Service::Time => 0x100,
            Service::TransmitPdo(number) => 0x080 + 0x100 * number.raw() as u16,
            Service::ReceivePdo(number) => 0x100 + 0x100 * number.raw() as u16,
            Service::SdoResponse => 0x580,
            Service::SdoRequest => 0x600,
            Service::ErrorControl => 0x700,
            Service::LssResponse => 0x7E4,
            Service::LssRequest => 0x7E5,
        }
    }
}

impl fmt::Display for Service {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Service::Nmt => write!(f, "NMT"),
            Service::Sync => write!(f, "SYNC"),
            Service::Time => write!(f, "TIME"),
            Service::Emergency => write!(f, "EMCY"),
            Service::TransmitPdo(number) => write!(f, "TPDO{}", number.raw()),
            Service::ReceivePdo(number) => write!(f, "RPDO{}", number.raw()),
            Service::SdoResponse => write!(f, "SDO response"),
            Service::SdoRequest => write!(f, "SDO request"),
            Service::ErrorControl => write!(f, "error control"),
            Service::LssResponse => write!(f, "LSS response"),
            Service::LssRequest => write!(f, "LSS request"),
        }
    }
}

/// The identifier of `service` for `node`. Without a node the identifier of a per-node service is its function code
/// alone; a node is ignored where there is one identifier for all.
pub const fn cob_id(service: Service, node: Option<NodeId>) -> StandardId {
    let node = match node {
        Some(node) if service.is_per_node() => node.raw() as u16,
        _ => 0,
    };
    match StandardId::new(service.base() + node) {
        Some(id) => id,
        None => StandardId::MAX,
    }
}

/// Which service of which node `id` belongs to; `None` if it is not in the predefined set.
pub const fn identify(id: StandardId) -> Option<(Service, Option<NodeId>)> {
    let all = match id.raw() {
        0x000 => Some(Service::Nmt),
        0x080 => Some(Service::Sync),
        0x100 => Some(Service::Time),
        0x7E4 => Some(Service::LssResponse),
        0x7E5 => Some(Service::LssRequest),
        _ => None,
    };
    if let Some(service) = all {
        return Some((service, None));
    }
    let function_code = (id.raw() >> 7) as u8;
    let service = match function_code {
        0b0001 => Service::Emergency,
        0b0011 | 0b0101 | 0b0111 | 0b1001 => match PdoNumber::new((function_code - 1) / 2) {
            Some(number) => Service::TransmitPdo(number),
            None => return None,
        },
        0b0100 | 0b0110 | 0b1000 | 0b1010 => match PdoNumber::new(function_code / 2 - 1) {
            Some(number) => Service::ReceivePdo(number),
            None => return None,
        },
        0b1011 => Service::SdoResponse,
        0b1100 => Service::SdoRequest,
        0b1110 => Service::ErrorControl,
        _ => return None,
    };
    match NodeId::new((id.raw() & 0x7F) as u8) {
        Some(node) => Some((service, Some(node))),
        None => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pdo(number: u8) -> PdoNumber {
        PdoNumber::new(number).unwrap()
    }

    #[test]
    fn identifiers_are_those_of_the_table() {
        let per_node = [
            (Service::Emergency, 0x081, 0x0FF),
            (Service::TransmitPdo(pdo(1)), 0x181, 0x1FF),
            (Service::ReceivePdo(pdo(1)), 0x201, 0x27F),
            (Service::TransmitPdo(pdo(2)), 0x281, 0x2FF),
            (Service::ReceivePdo(pdo(2)), 0x301, 0x37F),
            (Service::TransmitPdo(pdo(3)), 0x381, 0x3FF),
            (Service::ReceivePdo(pdo(3)), 0x401, 0x47F),
            (Service::TransmitPdo(pdo(4)), 0x481, 0x4FF),
            (Service::ReceivePdo(pdo(4)), 0x501, 0x57F),
            (Service::SdoResponse, 0x581, 0x5FF),
            (Service::SdoRequest, 0x601, 0x67F),
            (Service::ErrorControl, 0x701, 0x77F),
        ];
        for (service, first, last) in per_node {
            assert_eq!(cob_id(service, Some(NodeId::MIN)).raw(), first, "{service}");
            assert_eq!(cob_id(service, Some(NodeId::MAX)).raw(), last, "{service}");
        }
        let broadcast = [
            (Service::Nmt, 0x000),
            (Service::Sync, 0x080),
            (Service::Time, 0x100),
            (Service::LssResponse, 0x7E4),
            (Service::LssRequest, 0x7E5),
        ];
        for (service, id) in broadcast {
            assert_eq!(cob_id(service, None).raw(), id, "{service}");
            assert_eq!(cob_id(service, Some(NodeId::MAX)).raw(), id, "{service}");
        }
    }

    #[test]
    fn every_identifier_is_identified_as_what_it_is_the_identifier_of() {
        let mut identified = 0;
        for raw in 0..=0x7FF {
            let id = StandardId::new(raw).unwrap();
            if let Some((service, node)) = identify(id) {
                assert_eq!(cob_id(service, node), id, "{raw:03X}");
                identified += 1;
            }
        }
        assert_eq!(identified, 12 * 127 + 5);
    }
}
