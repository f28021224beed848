//! What stands on a bench: which devices, on which links, under which node-ID or address, and what may be done to them.

use std::collections::{BTreeMap, BTreeSet};
use std::time::Duration;

use crate::Position;
use crate::device::Parity;
use crate::model::{Effect, Located, StimulusName};
use crate::scalar::Text;

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
    /// The serial number of the unit that stands here, where the description claims none.
    pub serial_number: Option<Located<u32>>,
    /// The stimuli there are; without a list, those that the links offer by themselves.
    pub stimuli: Option<BTreeSet<StimulusName>>,
    /// The program that gives them on real links, with its first arguments; without one, an operator is asked.
    pub stimulus_command: Option<Vec<String>>,
    /// What cases may do to it. Reading is always permitted, and nothing else that is not listed.
    pub permits: BTreeSet<Effect>,
    /// Where it stands.
    pub at: Position,
}

/// What carries a port: `sim:`, `socketcan:can0`, `slcan:/dev/ttyACM0@250000`,
/// `serial:/dev/ttyUSB0?baud=19200&parity=even`, `tcp:host:502?framing=rtu`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Link {
    /// Of which kind it is.
    pub kind: LinkKind,
    /// What stands between the colon and the `?`; empty for `sim:`.
    pub target: String,
    /// What stands after the `?`, and the rate after an `@`.
    pub parameters: LinkParameters,
}

/// How a link is set, where it is not set as the description of the device says.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct LinkParameters {
    /// `@250000`: bits a second of a CAN bus.
    pub bit_rate: Option<u32>,
    /// `baud=19200`: bits a second of a serial line.
    pub baud: Option<u32>,
    /// `parity=even`
    pub parity: Option<Parity>,
    /// `stop-bits=2`
    pub stop_bits: Option<u8>,
    /// `echo=yes`: whether the tester hears what it sends itself, as on many RS-485 adapters.
    pub echo: Option<Echo>,
    /// `framing=rtu`: how Modbus frames are carried by a connection.
    pub framing: Option<Framing>,
    /// `uncertainty=5ms`: how far an instant may be off, where one knows better than the link.
    pub uncertainty: Option<Duration>,
}

/// Whether the tester hears what it sends itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Echo {
    /// It is found out.
    Auto,
    /// It does.
    Yes,
    /// It does not.
    No,
}

/// How Modbus frames are carried by a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Framing {
    /// With the header of Modbus TCP.
    Tcp,
    /// As on a serial line.
    Rtu,
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

    /// Whether a port of Modbus TCP can be connected to it.
    pub const fn carries_tcp(self) -> bool {
        matches!(self, LinkKind::Sim | LinkKind::Tcp)
    }

    /// Whether a serial port can be connected to it.
    pub const fn carries_serial(self) -> bool {
        matches!(self, LinkKind::Sim | LinkKind::Serial | LinkKind::Tcp)
    }
}

/// Why a text is no link.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NoLink {
    /// What is wrong.
    pub message: String,
    /// What was expected.
    pub expected: String,
    /// What to do, if that is known.
    pub help: Option<String>,
}

impl std::str::FromStr for Link {
    type Err = NoLink;

    /// Reads a link as a bench file writes it, from a command line.
    fn from_str(text: &str) -> Result<Link, NoLink> {
        <Link as Text>::parse(text).map_err(|wrong| NoLink {
            message: wrong.message,
            expected: wrong.label,
            help: wrong.help,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_say_how_a_link_is_set() {
        let link =
            "serial:/dev/ttyUSB0?baud=19200&parity=even&stop-bits=2&echo=yes&uncertainty=5ms";
        let Ok(Link {
            kind,
            target,
            parameters,
        }) = link.parse()
        else {
            panic!("{link} is a link");
        };
        assert_eq!((kind, target.as_str()), (LinkKind::Serial, "/dev/ttyUSB0"));
        let expected = LinkParameters {
            bit_rate: None,
            baud: Some(19_200),
            parity: Some(Parity::Even),
            stop_bits: Some(2),
            echo: Some(Echo::Yes),
            framing: None,
            uncertainty: Some(Duration::from_millis(5)),
        };
        assert_eq!(parameters, expected);
    }

    #[test]
    fn a_tcp_link_says_which_frames_travel_on_it() {
        let tcp = |text: &str| {
            let link: Link = text.parse().ok()?;
            Some((link.target, link.parameters.framing))
        };
        assert_eq!(tcp("tcp:plc:502"), Some(("plc:502".into(), None)));
        assert_eq!(
            tcp("tcp:[::1]:502?framing=rtu"),
            Some(("[::1]:502".into(), Some(Framing::Rtu)))
        );
        assert_eq!(tcp("tcp:plc:502?framing=ascii"), None);
        assert_eq!(tcp("tcp:plc?framing=rtu"), None);
    }

    #[test]
    fn a_bit_rate_stands_after_an_at_sign() {
        let link: Result<Link, NoLink> = "slcan:/dev/ttyACM0@250000".parse();
        let link = link.unwrap();
        assert_eq!(
            (link.target.as_str(), link.parameters.bit_rate),
            ("/dev/ttyACM0", Some(250_000))
        );
    }
}
