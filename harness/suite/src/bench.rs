//! What stands on a bench: which devices, on which links, under which node-ID or address, and what may be done to them.

use std::collections::{BTreeMap, BTreeSet};

use crate::Position;
use crate::model::{Effect, Located, StimulusName};

/// A bench.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BenchDescription {
    /// The version of the language: 1.
    pub language: u32,
    /// Its name.
    pub bench: String,
    /// What stands on it; at least one.
    pub devices: Vec<BenchDevice>,
}

/// A device on a bench.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BenchDevice {
    /// What the bench calls it; reports are named so.
    pub name: Located<String>,
    /// The name of a description that the program carries, or the folder of one.
    pub device: Located<String>,
    /// The links of its ports, by role; at least one.
    pub ports: BTreeMap<String, Located<Link>>,
    /// Its node-ID here; without one, that of the description.
    pub node: Option<Located<u8>>,
    /// Its Modbus address here; without one, that of the description.
    pub address: Option<Located<u8>>,
    /// The stimuli there are; without a list, those that the links offer by themselves.
    pub stimuli: Option<BTreeSet<StimulusName>>,
    /// What cases may do to it. Reading is always permitted, and nothing else that is not listed.
    pub permits: BTreeSet<Effect>,
    /// Where it stands.
    pub at: Position,
}

/// What carries a port: `sim:`, `socketcan:can0`, `slcan:/dev/ttyACM0`, `serial:/dev/ttyUSB0`, `tcp:host:502`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Link {
    /// Of which kind it is.
    pub kind: LinkKind,
    /// What stands after the colon; empty for `sim:`.
    pub target: String,
}

/// What stands after host and port where RTU frames travel instead of Modbus TCP.
pub(crate) const RTU: &str = "?framing=rtu";

impl Link {
    /// Host and port of a TCP link, and whether they take RTU frames instead of Modbus TCP; `None` for another link.
    pub fn tcp(&self) -> Option<(&str, bool)> {
        if self.kind != LinkKind::Tcp {
            return None;
        }
        Some(match self.target.strip_suffix(RTU) {
            Some(host_port) => (host_port, true),
            None => (&self.target, false),
        })
    }
}

/// A kind of link.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LinkKind {
    /// Simulated, with the reference device on it; carries CAN as well as serial ports.
    Sim,
    /// A CAN interface of Linux.
    SocketCan,
    /// A CAN adapter that speaks SLCAN.
    Slcan,
    /// A serial line.
    Serial,
    /// A connection to a host and port.
    Tcp,
}

impl LinkKind {
    /// All of them.
    pub(crate) const ALL: [LinkKind; 5] = [
        LinkKind::Sim,
        LinkKind::SocketCan,
        LinkKind::Slcan,
        LinkKind::Serial,
        LinkKind::Tcp,
    ];

    /// The word before the colon.
    pub const fn name(self) -> &'static str {
        match self {
            LinkKind::Sim => "sim",
            LinkKind::SocketCan => "socketcan",
            LinkKind::Slcan => "slcan",
            LinkKind::Serial => "serial",
            LinkKind::Tcp => "tcp",
        }
    }

    /// Whether a CAN port can be connected to it.
    pub const fn carries_can(self) -> bool {
        matches!(self, LinkKind::Sim | LinkKind::SocketCan | LinkKind::Slcan)
    }

    /// Whether a serial port can be connected to it.
    pub const fn carries_serial(self) -> bool {
        matches!(self, LinkKind::Sim | LinkKind::Serial | LinkKind::Tcp)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Text as _;

    #[test]
    fn a_tcp_link_says_which_frames_travel_on_it() {
        let tcp = |text: &str| {
            let link = Link::parse(text).ok()?;
            link.tcp()
                .map(|(host_port, is_rtu)| (host_port.to_owned(), is_rtu))
        };
        assert_eq!(tcp("tcp:plc:502"), Some(("plc:502".into(), false)));
        assert_eq!(
            tcp("tcp:[::1]:502?framing=rtu"),
            Some(("[::1]:502".into(), true))
        );
        assert_eq!(tcp("tcp:plc:502?framing=ascii"), None);
        assert_eq!(tcp("tcp:plc?framing=rtu"), None);
        assert_eq!(tcp("serial:/dev/ttyUSB0"), None);
    }
}
