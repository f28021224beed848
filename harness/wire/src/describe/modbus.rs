//! Modbus ADUs, RTU and TCP.

use crate::modbus::pdu::DeviceIdentification;
use crate::modbus::rtu::RtuAdu;
use crate::modbus::tcp::{HEADER_LEN, RawTcp, TcpAdu};
use crate::modbus::{FunctionCode, Request, Response};
use crate::violation::plural;
use crate::{Rule, Violation};

use super::spaced;

/// Which way an ADU goes; it cannot be seen in the ADU.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Direction {
    /// From client to server.
    Request,
    /// From server to client.
    Response,
}

/// What the RTU ADU `bytes` says: `read 2 holding registers from 00D4h`, `CRC wrong: 89EC, should be B9EC`.
pub fn describe_modbus(bytes: &[u8], direction: Direction) -> String {
    // The PDU begins at byte 1.
    let described = RtuAdu::parse(bytes).and_then(|adu| describe_pdu(adu.pdu(), 1, direction));
    described.unwrap_or_else(malformed)
}

/// What the Modbus TCP ADU `bytes` says: `transaction 0007h: read 2 holding registers from 00D4h`.
pub fn describe_modbus_tcp(bytes: &[u8], direction: Direction) -> String {
    let described =
        TcpAdu::parse(bytes).and_then(|adu| describe_pdu(adu.pdu(), HEADER_LEN, direction));
    let described = described.unwrap_or_else(malformed);
    match RawTcp(bytes).transaction() {
        Some(transaction) => format!("transaction {transaction:04X}h: {described}"),
        None => described,
    }
}

/// What a PDU says that begins at byte `at` of its ADU.
fn describe_pdu(pdu: &[u8], at: usize, direction: Direction) -> Result<String, Violation> {
    let line = match direction {
        Direction::Request => Request::parse(pdu).map(|request| describe_request(&request)),
        Direction::Response => Response::parse(pdu).map(|response| describe_response(&response)),
    };
    let violation = match line {
        Ok(line) => return Ok(line),
        Err(violation) => Violation {
            offset: violation.offset + at,
            ..violation
        },
    };
    match (direction, pdu.first()) {
        (Direction::Request, Some(function)) => Ok(format!(
            "{}, {}",
            describe_function(FunctionCode(*function)),
            malformed(violation)
        )),
        _ => Err(violation),
    }
}

/// `diagnostics, sub-function 000Bh (bus message count): 0000h`
fn describe_diagnostics(sub_function: u16, data: &[u16]) -> String {
    let name = match sub_function {
        0x00 => " (return query data)",
        0x01 => " (restart communications)",
        0x02 => " (return diagnostic register)",
        0x03 => " (change ASCII delimiter)",
        0x04 => " (force listen only mode)",
        0x0A => " (clear counters)",
        0x0B => " (bus message count)",
        0x0C => " (bus communication error count)",
        0x0D => " (bus exception error count)",
        0x0E => " (server message count)",
        0x0F => " (server no response count)",
        0x10 => " (server NAK count)",
        0x11 => " (server busy count)",
        0x12 => " (bus character overrun count)",
        0x14 => " (clear overrun counter)",
        _ => "",
    };
    let data = registers(data);
    format!("diagnostics, sub-function {sub_function:04X}h{name}: {data}")
}

/// `function 41h: 07 08`, `read exception status`
fn describe_other(function: FunctionCode, data: &[u8]) -> String {
    let name = describe_function(function);
    match data {
        [] => name,
        data => format!("{name}: {}", spaced(data)),
    }
}

fn describe_function(function: FunctionCode) -> String {
    match function.name() {
        Some(name) => name.to_owned(),
        None => format!("function {function}"),
    }
}

fn malformed(violation: Violation) -> String {
    match violation.rule {
        Rule::Checksum => format!(
            "CRC wrong: {}, should be {}",
            violation.found, violation.expected
        ),
        _ => format!("malformed: {violation}"),
    }
}

fn describe_request(request: &Request) -> String {
    match request {
        Request::ReadCoils { start, quantity } => read(quantity.raw(), "coil", *start),
        Request::ReadDiscreteInputs { start, quantity } => {
            read(quantity.raw(), "discrete input", *start)
        }
        Request::ReadHoldingRegisters { start, quantity } => {
            read(quantity.raw(), "holding register", *start)
        }
        Request::ReadInputRegisters { start, quantity } => {
            read(quantity.raw(), "input register", *start)
        }
        Request::WriteSingleCoil { address, on } => {
            format!("write coil {address:04X}h {}", on_off(*on))
        }
        Request::WriteSingleRegister { address, value } => {
            format!("write register {address:04X}h = {value:04X}h")
        }
        Request::Diagnostics { sub_function, data } => describe_diagnostics(*sub_function, data),
        Request::GetCommEventCounter => "get communication event counter".into(),
        Request::WriteMultipleCoils { start, values } => format!(
            "write {} from {start:04X}h: {}",
            plural(values.len(), "coil"),
            bits(values)
        ),
        Request::WriteMultipleRegisters { start, values } => write_registers(*start, values),
        Request::ReportServerId => "report server ID".into(),
        Request::MaskWriteRegister { address, and, or } => {
            format!("mask register {address:04X}h AND {and:04X}h OR {or:04X}h")
        }
        Request::ReadWriteMultipleRegisters {
            read_start,
            read_quantity,
            write_start,
            values,
        } => format!(
            "read/write multiple: {}, then {}",
            write_registers(*write_start, values),
            read(read_quantity.raw(), "register", *read_start)
        ),
        Request::ReadDeviceIdentification { read, object } => format!(
            "read device identification, code {:02X}h from object {object:02X}h",
            read.code()
        ),
        Request::Other { function, data } => describe_other(*function, data),
    }
}

fn describe_response(response: &Response) -> String {
    match response {
        Response::ReadCoils(bytes) => format!("coils: {}", spaced(bytes)),
        Response::ReadDiscreteInputs(bytes) => format!("discrete inputs: {}", spaced(bytes)),
        Response::ReadHoldingRegisters(values)
        | Response::ReadInputRegisters(values)
        | Response::ReadWriteMultipleRegisters(values) => {
            format!(
                "{}: {}",
                plural(values.len(), "register"),
                registers(values)
            )
        }
        Response::WriteSingleCoil { address, on } => {
            format!("coil {address:04X}h written {}", on_off(*on))
        }
        Response::WriteSingleRegister { address, value } => {
            format!("register {address:04X}h written = {value:04X}h")
        }
        Response::Diagnostics { sub_function, data } => describe_diagnostics(*sub_function, data),
        Response::GetCommEventCounter { status, count } => {
            format!("communication event counter {count}, status {status:04X}h")
        }
        Response::WriteMultipleCoils { start, quantity } => {
            written(usize::from(quantity.raw()), "coil", *start)
        }
        Response::WriteMultipleRegisters { start, quantity } => {
            written(usize::from(quantity.raw()), "register", *start)
        }
        Response::ReportServerId(bytes) => format!("server ID: {}", spaced(bytes)),
        Response::MaskWriteRegister { address, and, or } => {
            format!("register {address:04X}h masked AND {and:04X}h OR {or:04X}h")
        }
        Response::ReadDeviceIdentification(identification) => {
            describe_identification(identification)
        }
        Response::Exception { code, .. } => format!("exception {code}"),
        Response::Other { function, data } => describe_other(*function, data),
    }
}

fn describe_identification(identification: &DeviceIdentification) -> String {
    let objects: Vec<String> = identification
        .objects
        .iter()
        .map(|object| {
            let text = String::from_utf8_lossy(&object.value);
            format!("{:02X}h {:?}", object.id, text)
        })
        .collect();
    format!("device identification: {}", objects.join(", "))
}

fn read(quantity: u16, what: &str, start: u16) -> String {
    format!(
        "read {} from {start:04X}h",
        plural(usize::from(quantity), what)
    )
}

fn write_registers(start: u16, values: &[u16]) -> String {
    format!(
        "write {} from {start:04X}h: {}",
        plural(values.len(), "register"),
        registers(values)
    )
}

fn written(quantity: usize, what: &str, start: u16) -> String {
    format!("{} from {start:04X}h written", plural(quantity, what))
}

fn on_off(on: bool) -> &'static str {
    if on { "on" } else { "off" }
}

/// So many registers are shown of a long row.
const MOST_REGISTERS: usize = 16;

/// `01F4h 03E8h`
fn registers(values: &[u16]) -> String {
    let (shown, more) = match values.get(..MOST_REGISTERS) {
        Some(shown) if values.len() > MOST_REGISTERS => (shown, " .."),
        _ => (values, ""),
    };
    let shown: Vec<String> = shown.iter().map(|value| format!("{value:04X}h")).collect();
    shown.join(" ") + more
}

/// `1011`, the first coil first.
fn bits(values: &[bool]) -> String {
    values
        .iter()
        .map(|on| if *on { '1' } else { '0' })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modbus::crc16_bytes;
    use proptest::prelude::*;

    fn with_crc(bytes: &[u8]) -> Vec<u8> {
        [bytes, &crc16_bytes(bytes)].concat()
    }

    #[test]
    #[rustfmt::skip]
    fn requests_in_one_line() {
        let cases: [(&[u8], &str); 17] = [
            (&[2, 1, 0, 0x13, 0, 1], "read 1 coil from 0013h"),
            (&[2, 2, 0, 0x13, 0, 9], "read 9 discrete inputs from 0013h"),
            (&[2, 3, 0, 0xD4, 0, 2], "read 2 holding registers from 00D4h"),
            (&[2, 4, 0, 0xD4, 0, 1], "read 1 input register from 00D4h"),
            (&[2, 5, 0, 0xAC, 0xFF, 0], "write coil 00ACh on"),
            (&[1, 6, 1, 0x45, 3, 0xE8], "write register 0145h = 03E8h"),
            (&[1, 8, 0, 0, 0xA5, 0x37], "diagnostics, sub-function 0000h (return query data): A537h"),
            (&[1, 0x0B], "get communication event counter"),
            (&[1, 0x0F, 0, 0x13, 0, 4, 1, 0x0D], "write 4 coils from 0013h: 1011"),
            (&[1, 0x10, 1, 0x45, 0, 2, 4, 3, 0xE8, 7, 0xD0], "write 2 registers from 0145h: 03E8h 07D0h"),
            (&[1, 0x11], "report server ID"),
            (&[1, 0x16, 0, 4, 0, 0xF2, 0, 0x25], "mask register 0004h AND 00F2h OR 0025h"),
            (
                &[1, 0x17, 0, 3, 0, 6, 0, 14, 0, 1, 2, 0, 0xFF],
                "read/write multiple: write 1 register from 000Eh: 00FFh, then read 6 registers from 0003h",
            ),
            (&[1, 0x2B, 0x0E, 1, 0], "read device identification, code 01h from object 00h"),
            (&[1, 0x41, 7, 8], "function 41h: 07 08"),
            (&[1, 3, 0, 0, 0, 126], "read holding registers, malformed: range: found 126 at byte 4, expected 1 to 125"),
            (&[1], "malformed: length: found 3 bytes, expected 4 to 256 bytes"),
        ];
        for (bytes, line) in cases {
            assert_eq!(describe_modbus(&with_crc(bytes), Direction::Request), line);
        }
    }

    #[test]
    #[rustfmt::skip]
    fn responses_in_one_line() {
        let cases: [(&[u8], &str); 15] = [
            (&[2, 1, 1, 0x05], "coils: 05"),
            (&[2, 2, 2, 0x05, 0x01], "discrete inputs: 05 01"),
            (&[2, 3, 4, 1, 0xF4, 3, 0xE8], "2 registers: 01F4h 03E8h"),
            (&[2, 4, 2, 0, 1], "1 register: 0001h"),
            (&[2, 5, 0, 0xAC, 0, 0], "coil 00ACh written off"),
            (&[1, 6, 1, 0x45, 3, 0xE8], "register 0145h written = 03E8h"),
            (&[1, 8, 0, 0, 0xA5, 0x37], "diagnostics, sub-function 0000h (return query data): A537h"),
            (&[1, 0x0B, 0, 0, 1, 8], "communication event counter 264, status 0000h"),
            (&[1, 0x0F, 0, 0x13, 0, 10], "10 coils from 0013h written"),
            (&[1, 0x10, 1, 0x45, 0, 2], "2 registers from 0145h written"),
            (&[1, 0x11, 2, 9, 0xFF], "server ID: 09 FF"),
            (&[1, 0x16, 0, 4, 0, 0xF2, 0, 0x25], "register 0004h masked AND 00F2h OR 0025h"),
            (&[1, 0x86, 2], "exception 02 illegal data address"),
            (&[1, 0x86, 0x7C], "exception 7C"),
            (&[1, 0x2B, 0x0E, 1, 1, 0, 0, 1, 0, 2, b'A', b'\n'], "device identification: 00h \"A\\n\""),
        ];
        for (bytes, line) in cases {
            assert_eq!(describe_modbus(&with_crc(bytes), Direction::Response), line);
        }
    }

    #[test]
    fn a_wrong_crc_is_shown_beside_the_right_one() {
        let stale = [1, 0x10, 1, 0x45, 0, 2, 4, 3, 0xE8, 7, 0xD0, 0x89, 0xEC];
        assert_eq!(
            describe_modbus(&stale, Direction::Request),
            "CRC wrong: 89EC, should be B9EC"
        );
    }

    #[test]
    #[rustfmt::skip]
    fn modbus_tcp_in_one_line() {
        let request = [0, 7, 0, 0, 0, 6, 0x20, 3, 0, 0, 0, 1];
        let cases: [(&[u8], Direction, &str); 5] = [
            (&request, Direction::Request, "transaction 0007h: read 1 holding register from 0000h"),
            (&[0, 7, 0, 0, 0, 5, 0x20, 3, 2, 0x0F, 0xB4], Direction::Response, "transaction 0007h: 1 register: 0FB4h"),
            (&[1, 2, 0, 0, 0, 3, 1, 0x83, 2], Direction::Response, "transaction 0102h: exception 02 illegal data address"),
            (&[0, 7, 0, 1, 0, 3, 1, 0x83, 2], Direction::Response, "transaction 0007h: malformed: range: found protocol 1 at byte 2, expected protocol 0"),
            (&[0, 7, 0, 0, 0, 6, 1, 3, 0, 0, 0, 126], Direction::Request, "transaction 0007h: read holding registers, malformed: range: found 126 at byte 10, expected 1 to 125"),
        ];
        for (bytes, direction, line) in cases {
            assert_eq!(describe_modbus_tcp(bytes, direction), line);
        }
        assert_eq!(describe_modbus_tcp(&request[..1], Direction::Request), "malformed: length: found 1 byte, expected 8 to 260 bytes");
    }

    proptest! {
        #[test]
        fn any_bytes_have_one_line(bytes in proptest::collection::vec(any::<u8>(), 0..20), crc: bool) {
            let bytes = if crc { with_crc(&bytes) } else { bytes };
            for direction in [Direction::Request, Direction::Response] {
                let line = describe_modbus(&bytes, direction);
                prop_assert!(!line.is_empty() && !line.contains('\n'), "{}", line);
                let line = describe_modbus_tcp(&bytes, direction);
                prop_assert!(!line.is_empty() && !line.contains('\n'), "{}", line);
            }
        }
    }
}
