//! What another master, or another client, left in a device before the tester came.

use std::time::Duration;

use fieldproof_devices::modbus::crc::crc16;
use fieldproof_link::{Instant, Lane, Line, LinkError, PortIndex, PortProperties, Transmission};
use fieldproof_suite::device::DeviceDescription;

/// A drive that another master has enabled, in velocity mode.
pub(super) const ENABLED: &[&str] = &[
    "000#0100",
    "SDO#2F60600003000000",
    "SDO#2B40600006000000",
    "SDO#2B40600007000000",
    "SDO#2B4060000F000000",
];

/// Much that another master may have stored: heartbeat, guarding, heartbeats that are watched, inhibit time of EMCY,
/// and EMCY, SYNC, TIME, RPDO1 and TPDO1 under other identifiers. A device refuses what it does not have.
pub(super) const CONFIGURATION: &[&str] = &[
    "SDO#2B171000C8000000",
    "SDO#2B0C100064000000",
    "SDO#2F0D100003000000",
    "SDO#23161001E8037000",
    "SDO#2B151000F4010000",
    "SDO#2305100092060000",
    "SDO#2312100093060000",
    "SDO#2314100091060080",
    "SDO#2314100091060000",
    "SDO#2300140180060080",
    "SDO#2300140180060000",
    "SDO#2300180190060080",
    "SDO#2F00180201000000",
    "SDO#2300180190060040",
    "SDO#2310100173617665",
    "000#8100",
];

/// Values in registers and coils that each of the reference devices has at some of these addresses. A device refuses what it
/// does not have.
pub(super) const WRITES: &[&[u8]] = &[
    b"\x10\x00\x00\x00\x04\x08\x12\x34\x56\x78\x9A\xBC\xDE\xF0",
    b"\x0F\x00\x00\x00\x08\x01\xA5",
    b"\x06\x00\x06\x00\x01",
    b"\x06\x01\x45\x01\x23",
    b"\x06\x25\x02\x07\xD0",
];

/// How long a device is let go on between two frames.
const PAUSE: Duration = Duration::from_millis(50);

/// Sends frames on the CAN port of a device that has booted; nobody hears what it says.
pub(super) fn by_master(
    lane: &mut dyn Lane,
    device: &DeviceDescription,
    frames: &[&str],
) -> Result<(), LinkError> {
    let is_can = |port: &PortProperties| matches!(port.line, Line::Can { .. });
    let node = device.canopen.as_ref().map(|canopen| canopen.node);
    let (Some(port), Some(node)) = (lane.ports().iter().position(is_can), node) else {
        return Ok(());
    };
    let request = format!("{:03X}", 0x600 + u16::from(node));
    let frames = frames.iter().map(|frame| frame.replace("SDO", &request));
    let frames = frames.filter_map(|frame| frame.parse().ok());
    send_all(
        lane,
        PortIndex(port),
        device,
        frames.map(Transmission::Frame),
    )
}

/// Sends PDUs on the serial port of a device.
pub(super) fn by_client(
    lane: &mut dyn Lane,
    device: &DeviceDescription,
    requests: &[&[u8]],
) -> Result<(), LinkError> {
    let is_serial = |port: &PortProperties| matches!(port.line, Line::Serial(_));
    let address = device.modbus.as_ref().map(|modbus| modbus.address);
    let (Some(port), Some(address)) = (lane.ports().iter().position(is_serial), address) else {
        return Ok(());
    };
    let frames = requests.iter().map(|pdu| {
        let mut bytes = [&[address], *pdu].concat();
        bytes.extend(crc16(&bytes).to_le_bytes());
        Transmission::bytes(&bytes)
    });
    send_all(lane, PortIndex(port), device, frames)
}

fn send_all(
    lane: &mut dyn Lane,
    port: PortIndex,
    device: &DeviceDescription,
    frames: impl Iterator<Item = Transmission>,
) -> Result<(), LinkError> {
    let booted = lane.now() + device.timing.boot_up;
    pass(lane, booted)?;
    for frame in frames {
        let now = lane.now();
        let sent = lane.send(port, now, frame)?;
        pass(lane, sent.end + PAUSE)?;
    }
    Ok(())
}

fn pass(lane: &mut dyn Lane, until: Instant) -> Result<(), LinkError> {
    while lane.receive(until)?.is_some() {}
    Ok(())
}
