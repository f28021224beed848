//! CAN frames by the predefined connection set.

use fieldproof_can::{Frame, Id};

use super::spaced;
use crate::Violation;
use crate::canopen::data_frame::{broadcast, from_node};
use crate::canopen::emergency::Emergency;
use crate::canopen::error_control::ErrorControl;
use crate::canopen::lss;
use crate::canopen::nmt::{Command, NmtMessage};
use crate::canopen::sdo::{self, Segment, Transfer};
use crate::canopen::sync::Sync;
use crate::canopen::time::TimeOfDay;
use crate::canopen::{Multiplexer, NodeId, Service, identify};
use crate::violation::plural;

/// What `frame` says, by the predefined connection set: `SDO abort 6041h:00 06090011h sub-index does not exist`. Which
/// transfer is running is not known, so segments of a block read as whatever their first byte is elsewhere.
pub fn describe_frame(frame: &Frame) -> String {
    let Some((service, node)) = frame.standard_id().and_then(identify) else {
        let id = frame.id();
        return match id {
            Id::Standard(_) => format!("no predefined service on {id}h"),
            Id::Extended(_) => format!("extended frame {id}h, which is no service"),
        };
    };
    let described = match service {
        Service::Nmt => NmtMessage::parse(frame).map(nmt),
        Service::Sync => Sync::parse(frame).map(sync),
        Service::Time => TimeOfDay::parse(frame).map(|time| format!("TIME {time}")),
        Service::Emergency => Emergency::parse(frame).map(|(node, e)| emergency(node, e)),
        Service::TransmitPdo(_) | Service::ReceivePdo(_) => Ok(pdo(frame, service, node)),
        Service::SdoRequest | Service::SdoResponse => sdo_frame(frame, service),
        Service::ErrorControl => ErrorControl::parse(frame).map(|(node, e)| error_control(node, e)),
        Service::LssRequest | Service::LssResponse => lss_frame(frame, service),
    };
    described.unwrap_or_else(|violation| format!("malformed {service}: {violation}"))
}

/// Reads what has bytes that a receiver passes over, and tells of them where they are not as they must be.
fn checked<T>(
    bytes: &[u8],
    parse: fn(&[u8]) -> Result<T, Violation>,
    check_reserved: fn(&[u8]) -> Result<(), Violation>,
    describe: fn(T) -> String,
) -> Result<String, Violation> {
    let line = describe(parse(bytes)?);
    Ok(match check_reserved(bytes) {
        Ok(()) => line,
        Err(Violation {
            offset,
            found,
            expected,
            ..
        }) => format!("{line}, reserved byte {offset} {found} instead of {expected}"),
    })
}

fn sdo_frame(frame: &Frame, service: Service) -> Result<String, Violation> {
    let (_, bytes) = from_node(frame, service)?;
    if service == Service::SdoRequest {
        let check = sdo::Request::check_reserved;
        checked(bytes, sdo::Request::parse, check, sdo_request)
    } else {
        let check = sdo::Response::check_reserved;
        checked(bytes, sdo::Response::parse, check, sdo_response)
    }
}

fn lss_frame(frame: &Frame, service: Service) -> Result<String, Violation> {
    let bytes = broadcast(frame, service)?;
    let described = if service == Service::LssRequest {
        let check = lss::Request::check_reserved;
        checked(bytes, lss::Request::parse_bytes, check, lss_request)
    } else {
        let check = lss::Response::check_reserved;
        checked(bytes, lss::Response::parse_bytes, check, lss_response)
    };
    match (described, bytes.first().copied().and_then(lss_command)) {
        (Err(violation), Some(command)) => {
            Ok(format!("malformed {service}, {command}: {violation}"))
        }
        (described, _) => described,
    }
}

/// What a command specifier is called.
const fn lss_command(specifier: u8) -> Option<&'static str> {
    Some(match specifier {
        0x04 => "switch state global",
        0x11 => "configure node-ID",
        0x13 => "configure bit timing",
        0x15 => "activate bit timing",
        0x17 => "store configuration",
        0x40..=0x44 => "switch state selective",
        0x46..=0x4B | 0x4F => "identify remote slave",
        0x4C | 0x50 => "identify non-configured remote slave",
        0x51 => "fastscan",
        0x5A..=0x5D => "inquire identity",
        0x5E => "inquire node-ID",
        _ => return None,
    })
}

fn nmt(message: NmtMessage) -> String {
    let who = match message.node {
        Some(node) => format!("node {node}"),
        None => "all nodes".into(),
    };
    match message.command {
        command @ (Command::Start | Command::Stop) => format!("NMT {command} {who}"),
        Command::EnterPreOperational => format!("NMT enter pre-operational, {who}"),
        Command::ResetNode => format!("NMT reset {who}"),
        Command::ResetCommunication => format!("NMT reset communication of {who}"),
        command @ Command::Unknown(_) => format!("NMT {command}, {who}"),
    }
}

fn sync(sync: Sync) -> String {
    match sync.counter {
        Some(counter) => format!("SYNC {}", counter.raw()),
        None => "SYNC".into(),
    }
}

fn emergency(node: NodeId, emergency: Emergency) -> String {
    format!(
        "EMCY of node {node}: {}, error register {:02X}h, {}",
        emergency.code,
        emergency.register.0,
        spaced(&emergency.manufacturer)
    )
}

fn pdo(frame: &Frame, service: Service, node: Option<NodeId>) -> String {
    let node = node.map_or_else(String::new, |node| format!(" of node {node}"));
    if frame.is_remote() {
        format!("request for {service}{node}")
    } else {
        format!("{service}{node}")
    }
}

fn error_control(node: NodeId, content: ErrorControl) -> String {
    match content {
        ErrorControl::GuardRequest => format!("guarding request to node {node}"),
        ErrorControl::BootUp => format!("boot-up of node {node}"),
        ErrorControl::Status {
            toggle: false,
            state,
        } => format!("heartbeat {state}"),
        ErrorControl::Status {
            toggle: true,
            state,
        } => format!("guarding {state}, toggle 1"),
    }
}

fn sdo_request(request: sdo::Request) -> String {
    use sdo::Request;
    match request {
        Request::InitiateUpload(object) => format!("SDO read {object}"),
        Request::UploadSegment { toggle } => {
            format!("SDO read next segment, toggle {}", u8::from(toggle))
        }
        Request::InitiateDownload { object, transfer } => sdo_transfer("write", object, transfer),
        Request::DownloadSegment(segment) => sdo_segment("write", segment),
        Request::Abort { object, code } => format!("SDO abort {object} {code}"),
        Request::InitiateBlockUpload {
            object, block_size, ..
        } => format!(
            "SDO block read {object}, blocks of {}",
            plural(usize::from(block_size.raw()), "segment")
        ),
        Request::StartBlockUpload => "SDO block read start".into(),
        Request::AcknowledgeBlockUpload { acknowledged, .. } => {
            sdo_acknowledge("read", acknowledged)
        }
        Request::EndBlockUpload => "SDO block read end confirmed".into(),
        Request::InitiateBlockDownload { object, size, .. } => {
            format!("SDO block write {object}{}", of_size(size))
        }
        Request::EndBlockDownload { crc, .. } => format!("SDO block write end, CRC {crc:04X}h"),
    }
}

fn sdo_response(response: sdo::Response) -> String {
    use sdo::Response;
    match response {
        Response::InitiateUpload { object, transfer } => sdo_transfer("value", object, transfer),
        Response::UploadSegment(segment) => sdo_segment("value", segment),
        Response::InitiateDownload(object) => format!("SDO written {object}"),
        Response::DownloadSegment { toggle } => {
            format!("SDO segment written, toggle {}", u8::from(toggle))
        }
        Response::Abort { object, code } => format!("SDO abort {object} {code}"),
        Response::InitiateBlockUpload { object, size, .. } => {
            format!("SDO block value {object}{}", of_size(size))
        }
        Response::EndBlockUpload { crc, .. } => format!("SDO block value end, CRC {crc:04X}h"),
        Response::InitiateBlockDownload {
            object, block_size, ..
        } => format!(
            "SDO block write {object} accepted, blocks of {}",
            plural(usize::from(block_size.raw()), "segment")
        ),
        Response::AcknowledgeBlockDownload { acknowledged, .. } => {
            sdo_acknowledge("write", acknowledged)
        }
        Response::EndBlockDownload => "SDO block written".into(),
    }
}

fn sdo_transfer(what: &str, object: Multiplexer, transfer: Transfer) -> String {
    match transfer {
        Transfer::Expedited(value) => format!("SDO {what} {object} = {}", number(value.bytes())),
        Transfer::ExpeditedUnsized(bytes) => {
            format!("SDO {what} {object} = {}, size not given", spaced(&bytes))
        }
        Transfer::Segmented { size } => format!("SDO {what} {object} in segments{}", of_size(size)),
    }
}

fn sdo_segment(what: &str, segment: Segment) -> String {
    format!(
        "SDO {what} segment, toggle {}: {}{}",
        u8::from(segment.toggle),
        spaced(segment.data.bytes()),
        if segment.last { ", last" } else { "" }
    )
}

fn sdo_acknowledge(what: &str, acknowledged: Option<sdo::SegmentNumber>) -> String {
    match acknowledged {
        Some(number) => format!("SDO block {what}, segments to {} received", number.raw()),
        None => format!("SDO block {what}, no segment received"),
    }
}

fn of_size(size: Option<u32>) -> String {
    size.map_or_else(String::new, |size| {
        format!(", {}", plural(size as usize, "byte"))
    })
}

/// A value of 1 to 4 bytes, low byte first, as a hexadecimal number of its size.
fn number(bytes: &[u8]) -> String {
    let digits: String = bytes
        .iter()
        .rev()
        .map(|byte| format!("{byte:02X}"))
        .collect();
    digits + "h"
}

fn lss_request(request: lss::Request) -> String {
    use lss::Request;
    match request {
        Request::SwitchGlobal {
            configuration: true,
        } => "LSS switch all to configuration".into(),
        Request::SwitchGlobal {
            configuration: false,
        } => "LSS switch all to waiting".into(),
        Request::SwitchSelective { part, value } => {
            format!("LSS switch selective, {part} {value:08X}h")
        }
        Request::ConfigureNodeId(node) => format!("LSS configure {}", node_id(node)),
        Request::ConfigureBitTiming { table, index } => {
            format!("LSS configure bit timing, table {table} index {index}")
        }
        Request::ActivateBitTiming { delay_ms } => {
            format!("LSS activate bit timing, delay {delay_ms} ms")
        }
        Request::StoreConfiguration => "LSS store configuration".into(),
        Request::InquireIdentity(part) => format!("LSS inquire {part}"),
        Request::InquireNodeId => "LSS inquire node-ID".into(),
        Request::Identify {
            product_code,
            value,
        } => {
            let part = if product_code {
                "product code"
            } else {
                "vendor-ID"
            };
            format!("LSS identify, {part} {value:08X}h")
        }
        Request::IdentifyRange {
            serial_number,
            highest,
            value,
        } => {
            let limit = if highest { "highest" } else { "lowest" };
            let part = if serial_number {
                "serial number"
            } else {
                "revision number"
            };
            format!("LSS identify, {limit} {part} {value:08X}h")
        }
        Request::IdentifyNonConfigured => "LSS identify nodes without node-ID".into(),
        Request::FastScan(scan) => match scan.bit_check {
            Some(bit) => format!(
                "LSS fastscan, {} {:08X}h from bit {}",
                scan.part,
                scan.number,
                bit.raw()
            ),
            None => "LSS fastscan, begin".into(),
        },
    }
}

fn lss_response(response: lss::Response) -> String {
    use lss::Response;
    match response {
        Response::ConfigureNodeId(outcome) => format!("LSS configure node-ID: {outcome}"),
        Response::ConfigureBitTiming(outcome) => format!("LSS configure bit timing: {outcome}"),
        Response::StoreConfiguration(outcome) => format!("LSS store configuration: {outcome}"),
        Response::SwitchSelective => "LSS selected, in configuration".into(),
        Response::IdentifySlave => "LSS slave identified".into(),
        Response::IdentifyNonConfigured => "LSS node without node-ID".into(),
        Response::InquireIdentity { part, value } => format!("LSS {part} {value:08X}h"),
        Response::InquireNodeId(node) => format!("LSS {}", node_id(node)),
    }
}

fn node_id(node: Option<NodeId>) -> String {
    node.map_or_else(|| "no node-ID".into(), |node| format!("node-ID {node}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    #[rustfmt::skip]
    fn frames_in_one_line() {
        let cases = [
            ("000#0101", "NMT start node 1"),
            ("000#0200", "NMT stop all nodes"),
            ("000#8020", "NMT enter pre-operational, node 32"),
            ("000#8105", "NMT reset node 5"),
            ("000#8200", "NMT reset communication of all nodes"),
            ("000#4205", "NMT unknown command 42h, node 5"),
            ("000#01", "malformed NMT: length: found 1 byte, expected 2 bytes"),
            ("080#", "SYNC"),
            ("080#11", "SYNC 17"),
            ("100#952CB302B036", "TIME day 14000, 12:34:56.789"),
            ("085#3081110102030405", "EMCY of node 5: 8130h life guarding or heartbeat failed, error register 11h, 01 02 03 04 05"),
            ("1A0#D7C7000034075201", "TPDO1 of node 32"),
            ("1A0#R8", "request for TPDO1 of node 32"),
            ("301#64006400", "RPDO2 of node 1"),
            ("701#R1", "guarding request to node 1"),
            ("705#00", "boot-up of node 5"),
            ("701#05", "heartbeat operational"),
            ("701#02", "heartbeat unknown state 02h"),
            ("701#FF", "guarding pre-operational, toggle 1"),
            ("601#4041600000000000", "SDO read 6041h:00"),
            ("581#4B41600031020000", "SDO value 6041h:00 = 0231h"),
            ("581#4363600013D1FFFF", "SDO value 6063h:00 = FFFFD113h"),
            ("601#2F60600001000000", "SDO write 6060h:00 = 01h"),
            ("601#2260600001000000", "SDO write 6060h:00 = 01 00 00 00, size not given"),
            ("581#607A6000A0860100", "SDO written 607Ah:00, reserved byte 4 A0h instead of 00h"),
            ("581#8041600011000906", "SDO abort 6041h:00 06090011h sub-index does not exist"),
            ("581#410810000A000000", "SDO value 1008h:00 in segments, 10 bytes"),
            ("601#7000000000000000", "SDO read next segment, toggle 1"),
            ("581#1943414E00000000", "SDO value segment, toggle 1: 43 41 4E, last"),
            ("581#3000000000000000", "SDO segment written, toggle 1"),
            ("601#A00810007F000000", "SDO block read 1008h:00, blocks of 127 segments"),
            ("581#C2081000E8030000", "SDO block value 1008h:00, 1000 bytes"),
            ("601#A2057F0000000000", "SDO block read, segments to 5 received"),
            ("601#E000000000000000", "malformed SDO request: command: found E0h at byte 0, expected a client command specifier from 0 to 6 in bits 7..5"),
            ("581#60", "malformed SDO response: length: found 1 byte, expected 8 bytes"),
            ("601#R8", "malformed SDO request: kind of frame: found a remote frame, expected a data frame"),
            ("7E4#4400000000000009", "LSS selected, in configuration, reserved byte 7 09h instead of 00h"),
            ("7E5#0401000000000000", "LSS switch all to configuration"),
            ("7E5#1105000000000000", "LSS configure node-ID 5"),
            ("7E4#1101000000000000", "LSS configure node-ID: error 1"),
            ("7E5#1300040000000000", "LSS configure bit timing, table 0 index 4"),
            ("7E5#43B8615D0E000000", "LSS switch selective, serial number 0E5D61B8h"),
            ("7E4#5A3C060000000000", "LSS vendor-ID 0000063Ch"),
            ("7E4#5EFF000000000000", "LSS no node-ID"),
            ("7E5#513C0600001F0001", "LSS fastscan, vendor-ID 0000063Ch from bit 31"),
            ("7E5#4B01000000000000", "LSS identify, highest serial number 00000001h"),
            ("780#", "no predefined service on 780h"),
            ("00000601#40", "extended frame 00000601h, which is no service"),
        ];
        for (text, line) in cases {
            assert_eq!(describe_frame(&text.parse().unwrap()), line, "{text}");
        }
    }

    proptest! {
        #[test]
        fn any_frame_has_one_line(
            id in 0..=0x7FFu16,
            remote: bool,
            data in proptest::collection::vec(any::<u8>(), 0..=8),
        ) {
            let id = fieldproof_can::StandardId::new(id).unwrap();
            let frame = if remote {
                Frame::remote(id, data.len() as u8).unwrap()
            } else {
                Frame::data(id, &data).unwrap()
            };
            let line = describe_frame(&frame);
            prop_assert!(!line.is_empty() && !line.contains('\n'), "{}", line);
        }
    }
}
