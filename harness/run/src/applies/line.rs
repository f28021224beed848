//! What a Modbus link cannot carry: bytes of the other framing, silences, parity bits, connections.

use fieldproof_suite::device::{DeviceDescription, FunctionCode, Parity, PortDescription};
use fieldproof_suite::model::{Case, ExpectBytes, Located, Modbus, PauseLength, SendBytes, Step};

use super::Bench;
use crate::tester::{SERIAL, TCP};

/// Why the case makes no sense on the links of the bench.
pub(super) fn cannot_carry(
    case: &Case,
    device: &DeviceDescription,
    bench: &Bench,
) -> Option<String> {
    rtu_alone(case, bench)
        .or_else(|| missing_connections(case, device))
        .or_else(|| no_parity(case, device, bench))
        .or_else(|| no_characters(case, bench))
        .or_else(|| no_silences(case, bench))
}

/// Whether Modbus is spoken over TCP where a step names no port.
pub(super) fn is_over_tcp(bench: &Bench) -> bool {
    match bench.ports.contains(SERIAL) {
        true => bench.modbus_tcp.contains(SERIAL),
        false => bench.modbus_tcp.contains(TCP),
    }
}

/// Functions that the specification has for serial lines only.
const SERIAL_LINE_ONLY: [u8; 5] = [0x07, 0x08, 0x0B, 0x0C, 0x11];

pub(super) fn serial_line_only(functions: &[FunctionCode], bench: &Bench) -> Option<String> {
    let mut of_lines = functions
        .iter()
        .filter(|it| SERIAL_LINE_ONLY.contains(&it.function));
    let function = of_lines.next().filter(|_| is_over_tcp(bench))?;
    Some(format!("function {function} is for serial lines"))
}

/// What makes sense on a serial line alone is not played on Modbus TCP.
fn rtu_alone(case: &Case, bench: &Bench) -> Option<String> {
    let steps = case.control.iter().chain(&case.steps);
    steps
        .chain(&case.restore.steps)
        .find_map(|step| rtu_step(&step.value, bench))
}

/// More connections are open at once, with that of the bench, than the device serves.
fn missing_connections(case: &Case, device: &DeviceDescription) -> Option<String> {
    let (mut open, mut most) = (0, 0);
    let steps: Vec<&Located<Step>> = case.control.iter().chain(&case.steps).collect();
    count_connections(&steps, &mut open, &mut most);
    let needed = most + 1;
    let served = device.modbus.as_ref().and_then(|it| it.connections);
    match served {
        _ if most == 0 => None,
        None => {
            Some("the description does not say how many connections the device serves".to_owned())
        }
        Some(served) if served < needed => Some(format!(
            "the device serves {served} connections, and {needed} are needed"
        )),
        Some(_) => None,
    }
}

fn count_connections(steps: &[&Located<Step>], open: &mut u16, most: &mut u16) {
    for step in steps {
        match &step.value {
            Step::Connect(_) => *open += 1,
            Step::Disconnect(_) => *open = open.saturating_sub(1),
            Step::Repeat(repeat) => {
                let inside: Vec<&Located<Step>> = repeat.steps.iter().collect();
                count_connections(&inside, open, most);
            }
            _ => {}
        }
        *most = (*most).max(*open);
    }
}

/// A parity bit is sent wrong where there is none.
fn no_parity(case: &Case, device: &DeviceDescription, bench: &Bench) -> Option<String> {
    let spoils = |step: &Located<Step>| {
        matches!(
            &step.value,
            Step::SendBytes(SendBytes { spoil: Some(_), .. })
        )
    };
    let has_parity = matches!(
        device.ports.get(SERIAL),
        Some(PortDescription::Serial { parity, .. }) if *parity != Parity::None
    );
    let carries = has_parity && !bench.fixed_rates.contains(SERIAL);
    let mut steps = case.control.iter().chain(&case.steps);
    (steps.any(spoils) && !carries).then(|| "the line has no parity bit".to_owned())
}

/// What follows a frame without a silence belongs to it only where silence ends a frame.
fn no_silences(case: &Case, bench: &Bench) -> Option<String> {
    let follows = |step: &Located<Step>| matches!(&step.value, Step::SendBytes(SendBytes { then, port: None, .. }) if !then.is_empty());
    let mut steps = case.control.iter().chain(&case.steps);
    (steps.any(follows) && bench.streams.contains(SERIAL))
        .then(|| "no silence ends a frame on this link".to_owned())
}

/// A silence is counted in characters where characters take no time.
fn no_characters(case: &Case, bench: &Bench) -> Option<String> {
    let counts = |step: &Located<Step>| match &step.value {
        Step::SendBytes(SendBytes {
            pause: Some(pause), ..
        }) => matches!(pause.lasting, PauseLength::Characters(_)),
        _ => false,
    };
    let mut steps = case.control.iter().chain(&case.steps);
    (steps.any(counts) && bench.fixed_rates.contains(SERIAL))
        .then(|| "characters take no time on this link".to_owned())
}

fn rtu_step(step: &Step, bench: &Bench) -> Option<String> {
    // A port that the bench does not have is a connection that the case has opened.
    let is_tcp = |port: &Option<String>| match port.as_deref() {
        Some(port) => bench.modbus_tcp.contains(port),
        None => is_over_tcp(bench),
    };
    match step {
        Step::Connect(_) if bench.modbus_tcp.is_empty() => Some("no port of Modbus TCP".to_owned()),
        Step::SendBytes(SendBytes { port, .. }) | Step::ExpectBytes(ExpectBytes { port, .. })
            if is_tcp(port) =>
        {
            Some("written as an RTU frame; this link is Modbus TCP".to_owned())
        }
        Step::Modbus(Modbus {
            to: Some(to), port, ..
        }) if port.is_none() && is_over_tcp(bench) && bench.address != Some(*to) => Some(format!(
            "sent to address {to}; this link is Modbus TCP, with one device at its end"
        )),
        Step::Repeat(repeat) => {
            let mut steps = repeat.steps.iter();
            steps.find_map(|step| rtu_step(&step.value, bench))
        }
        _ => None,
    }
}
