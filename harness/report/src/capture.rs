//! The traffic of a lane: as a candump log, and as pcapng for Wireshark.

use std::borrow::Cow;
use std::io::{self, Write};
use std::time::Duration;

use fieldproof_record::{Direction, Event, FrameEvent, LaneStarted, SerialEvent};
use pcap_file::pcapng::blocks::enhanced_packet::{EnhancedPacketBlock, EnhancedPacketOption};
use pcap_file::pcapng::blocks::interface_description::{
    InterfaceDescriptionBlock, InterfaceDescriptionOption,
};
use pcap_file::pcapng::blocks::section_header::{SectionHeaderBlock, SectionHeaderOption};
use pcap_file::pcapng::{Block, PcapNgWriter};
use pcap_file::{DataLink, PcapError};

/// Writes the CAN frames of a lane as `candump -L -x` does.
#[derive(Debug)]
pub struct Candump<W: Write> {
    out: W,
    started: Duration,
    ports: Vec<String>,
}

impl<W: Write> Candump<W> {
    /// A log of a lane that was opened `started` after 1970-01-01 00:00 UTC.
    pub fn new(out: W, started: Duration) -> Candump<W> {
        Candump {
            out,
            started,
            ports: Vec::new(),
        }
    }

    /// One more event.
    ///
    /// # Errors
    /// What the output says.
    pub fn event(&mut self, event: &Event) -> io::Result<()> {
        match event {
            Event::LaneStarted(lane) => {
                self.ports = lane.ports.iter().map(|port| port.name.clone()).collect();
                Ok(())
            }
            Event::Frame(frame) => {
                let at = self.started + Duration::from_nanos(frame.at_ns);
                let port = self.ports.get(usize::from(frame.port));
                let port = port.map_or("can", String::as_str);
                let direction = match frame.direction {
                    Direction::Sent => 'T',
                    Direction::Received | Direction::Companion => 'R',
                };
                let (seconds, micros) = (at.as_secs(), at.subsec_micros());
                let text = notation(frame);
                writeln!(
                    self.out,
                    "({seconds}.{micros:06}) {port} {text} {direction}"
                )
            }
            _ => Ok(()),
        }
    }

    /// The output.
    ///
    /// # Errors
    /// What it says when it is flushed.
    pub fn finish(mut self) -> io::Result<W> {
        self.out.flush()?;
        Ok(self.out)
    }
}

/// A frame as can-utils write it: `601#4000100000000000`, `701#R1`.
pub(crate) fn notation(frame: &FrameEvent) -> String {
    let mut text = match frame.extended {
        true => format!("{:08X}#", frame.id),
        false => format!("{:03X}#", frame.id),
    };
    match (frame.remote, frame.len) {
        (true, 0) => text.push('R'),
        (true, len) => text.push_str(&format!("R{len}")),
        (false, _) => hex(&mut text, data_of(frame), ""),
    }
    text
}

/// `20 03 02 0F B4`
pub(crate) fn spaced(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(3 * bytes.len());
    hex(&mut text, bytes, " ");
    text
}

fn data_of(frame: &FrameEvent) -> &[u8] {
    let used = usize::from(frame.len).min(frame.data.len());
    &frame.data[..used]
}

fn hex(text: &mut String, bytes: &[u8], between: &str) {
    const DIGITS: &[u8; 16] = b"0123456789ABCDEF";
    for (index, byte) in bytes.iter().enumerate() {
        if index > 0 {
            text.push_str(between);
        }
        text.push(char::from(DIGITS[usize::from(byte >> 4)]));
        text.push(char::from(DIGITS[usize::from(byte & 0xF)]));
    }
}

/// CAN frames as Linux hands them to programs.
const LINKTYPE_CAN_SOCKETCAN: u32 = 227;
/// Bytes that are for a dissector named before them.
const LINKTYPE_WIRESHARK_UPPER_PDU: u32 = 252;

/// Which dissector the bytes of a port are for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Carries {
    Can,
    Rtu,
    Tcp,
}

/// Writes all traffic of a lane as pcapng with nanoseconds; each frame carries its case as a comment.
pub struct Pcapng<W: Write> {
    out: PcapNgWriter<W>,
    started: Duration,
    ports: Vec<Carries>,
    case: String,
}

impl<W: Write> Pcapng<W> {
    /// A capture of a lane that was opened `started` after 1970-01-01 00:00 UTC.
    ///
    /// # Errors
    /// What the output says.
    pub fn new(out: W, started: Duration, tool: &str) -> io::Result<Pcapng<W>> {
        let header = SectionHeaderBlock {
            options: vec![SectionHeaderOption::UserApplication(Cow::Owned(
                tool.to_owned(),
            ))],
            ..SectionHeaderBlock::default()
        };
        Ok(Pcapng {
            out: PcapNgWriter::with_section_header(out, header).map_err(io_error)?,
            started,
            ports: Vec::new(),
            case: String::new(),
        })
    }

    /// One more event.
    ///
    /// # Errors
    /// What the output says.
    pub fn event(&mut self, event: &Event) -> io::Result<()> {
        match event {
            Event::LaneStarted(lane) => self.interfaces(lane),
            Event::CaseStarted(case) => {
                self.case.clone_from(&case.id);
                Ok(())
            }
            Event::CaseFinished(_) => {
                self.case.clear();
                Ok(())
            }
            Event::Frame(frame) => self.packet(frame.at_ns, frame.port, &can_bytes(frame)),
            Event::Serial(serial) => {
                let carries = self.ports.get(usize::from(serial.port));
                let bytes = upper_pdu(serial, carries == Some(&Carries::Tcp));
                self.packet(serial.at_ns, serial.port, &bytes)
            }
            _ => Ok(()),
        }
    }

    fn interfaces(&mut self, lane: &LaneStarted) -> io::Result<()> {
        for port in &lane.ports {
            let carries = match port.line.as_str() {
                line if line.contains("bit/s") => Carries::Can,
                "Modbus TCP" => Carries::Tcp,
                _ => Carries::Rtu,
            };
            self.ports.push(carries);
            let link_type = match carries {
                Carries::Can => LINKTYPE_CAN_SOCKETCAN,
                Carries::Rtu | Carries::Tcp => LINKTYPE_WIRESHARK_UPPER_PDU,
            };
            let description = format!("{} {}, {}", port.link, port.line, lane.device);
            let block = InterfaceDescriptionBlock {
                linktype: DataLink::from(link_type),
                snaplen: 0,
                options: vec![
                    InterfaceDescriptionOption::IfName(Cow::Borrowed(&port.name)),
                    InterfaceDescriptionOption::IfDescription(Cow::Owned(description)),
                    InterfaceDescriptionOption::IfTsResol(9),
                ],
            };
            self.write(Block::InterfaceDescription(block))?;
        }
        Ok(())
    }

    fn packet(&mut self, at_ns: u64, port: u8, bytes: &[u8]) -> io::Result<()> {
        if usize::from(port) >= self.ports.len() {
            return Ok(());
        }
        let options = match self.case.as_str() {
            "" => Vec::new(),
            case => vec![EnhancedPacketOption::Comment(Cow::Owned(case.to_owned()))],
        };
        let block = EnhancedPacketBlock {
            interface_id: port.into(),
            timestamp: self.started + Duration::from_nanos(at_ns),
            original_len: u32::try_from(bytes.len()).unwrap_or(u32::MAX),
            data: Cow::Borrowed(bytes),
            options,
        };
        self.out
            .write_block(&Block::EnhancedPacket(block))
            .map(drop)
            .map_err(io_error)
    }

    fn write(&mut self, block: Block<'_>) -> io::Result<()> {
        self.out.write_block(&block).map(drop).map_err(io_error)
    }

    /// The output.
    ///
    /// # Errors
    /// What it says when it is flushed.
    pub fn finish(self) -> io::Result<W> {
        let mut out = self.out.into_inner();
        out.flush()?;
        Ok(out)
    }
}

fn io_error(error: PcapError) -> io::Error {
    match error {
        PcapError::IoError(error) => error,
        other => io::Error::other(other.to_string()),
    }
}

/// A frame as SocketCAN has it, the identifier in network order.
fn can_bytes(frame: &FrameEvent) -> Vec<u8> {
    const EXTENDED: u32 = 0x8000_0000;
    const REMOTE: u32 = 0x4000_0000;
    let mut id = frame.id;
    if frame.extended {
        id |= EXTENDED;
    }
    if frame.remote {
        id |= REMOTE;
    }
    let mut bytes = id.to_be_bytes().to_vec();
    bytes.extend([frame.len, 0, 0, 0]);
    if !frame.remote {
        bytes.extend_from_slice(data_of(frame));
    }
    bytes
}

/// The bytes after what tells Wireshark whose they are: the dissector's name, and a port that says which is the server.
fn upper_pdu(serial: &SerialEvent, tcp: bool) -> Vec<u8> {
    const DISSECTOR_NAME: u16 = 12;
    const PORT_TYPE: u16 = 24;
    const SOURCE_PORT: u16 = 25;
    const DESTINATION_PORT: u16 = 26;
    const TCP: u32 = 2;
    const CLIENT: u32 = 50_000;
    // What Wireshark takes for a server: it has no port of its own for RTU.
    let server: u32 = if tcp { 502 } else { 0 };
    let mut bytes = Vec::with_capacity(serial.bytes.len() + 48);
    let mut tag = |tag: u16, value: &[u8]| {
        bytes.extend(tag.to_be_bytes());
        let len = u16::try_from(value.len()).unwrap_or_default();
        bytes.extend(len.to_be_bytes());
        bytes.extend_from_slice(value);
    };
    tag(
        DISSECTOR_NAME,
        if tcp { b"mbtcp\0\0\0" } else { b"mbrtu\0\0\0" },
    );
    let (from, to) = match serial.direction {
        Direction::Sent => (CLIENT, server),
        Direction::Received | Direction::Companion => (server, CLIENT),
    };
    tag(PORT_TYPE, &TCP.to_be_bytes());
    tag(SOURCE_PORT, &from.to_be_bytes());
    tag(DESTINATION_PORT, &to.to_be_bytes());
    tag(0, &[]);
    bytes.extend_from_slice(&serial.bytes);
    bytes
}
