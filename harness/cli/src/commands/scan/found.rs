//! What was found, as it is shown.

use std::time::Duration;

use fieldproof_run::scan::{
    CanopenFound, FoundNode, FoundServer, HeardIdentifier, LssFound, LssSlave, ModbusFound,
};
use serde::Serialize;

use super::known::Known;

/// Everything that was found on a link.
#[derive(Debug, Serialize)]
pub(super) struct Found {
    /// The link, with how it was set.
    pub(super) link: String,
    /// Nodes or servers.
    pub(super) devices: Vec<FoundDevice>,
    /// What else there is to say.
    pub(super) notes: Vec<String>,
    #[serde(skip)]
    pub(super) on_can: bool,
}

/// A node or a server. What it did not say is `None`.
#[derive(Debug, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) struct FoundDevice {
    /// The name of the description that it has.
    pub(super) device: Option<String>,
    /// Its CANopen node-ID.
    pub(super) node: Option<u8>,
    /// Its Modbus address, or unit.
    pub(super) address: Option<u8>,
    pub(super) device_type: Option<u32>,
    pub(super) vendor_id: Option<u32>,
    pub(super) product_code: Option<u32>,
    pub(super) revision_number: Option<u32>,
    pub(super) serial_number: Option<u32>,
    /// 1008h, the device identification or the server ID.
    pub(super) name: Option<String>,
    /// What it sends by itself, or how it answers.
    pub(super) heard: Vec<String>,
}

/// With the text of the bench.
#[derive(Serialize)]
pub(super) struct WithBench<'a> {
    #[serde(flatten)]
    found: &'a Found,
    bench: Option<&'a str>,
}

impl Found {
    pub(super) fn with_bench<'a>(&'a self, bench: Option<&'a str>) -> WithBench<'a> {
        WithBench { found: self, bench }
    }

    /// `None`: nobody acknowledged anything.
    pub(super) fn on_canopen(link: String, scan: &Option<CanopenFound>, known: &Known) -> Found {
        let mut found = Found {
            link,
            devices: Vec::new(),
            notes: Vec::new(),
            on_can: true,
        };
        let Some(scan) = scan else {
            let text = "nobody acknowledges a frame: no device is there, or none with power at this bit rate";
            found.notes.push(text.to_owned());
            return found;
        };
        found.devices = scan.nodes.iter().map(|it| node(it, known)).collect();
        if !scan.identifiers.is_empty() {
            let also: Vec<String> = scan.identifiers.iter().map(identifier).collect();
            found
                .notes
                .push(format!("also on the bus: {}", also.join(", ")));
        }
        if scan.bus_errors > 0 {
            let number = scan.bus_errors;
            found.notes.push(format!(
                "{number} errors on the bus: is it the right bit rate?"
            ));
        }
        match &scan.lss {
            None if scan.unconfigured => found.notes.push(
                "a slave without a node-ID is there; `--lss` asks for its identity".to_owned(),
            ),
            None => {}
            Some(LssFound::TooMany(nodes)) => found.notes.push(format!(
                "LSS: nobody was asked, for {nodes} slaves would answer at the same time"
            )),
            Some(LssFound::Slaves(slaves)) if slaves.is_empty() => {
                found.notes.push("LSS: no slave answers".to_owned());
            }
            Some(LssFound::Slaves(slaves)) => {
                found.notes.extend(slaves.iter().map(slave));
            }
        }
        found
    }

    pub(super) fn on_modbus(link: String, scan: &ModbusFound, known: &Known) -> Found {
        let mut notes = Vec::new();
        if scan.every_unit {
            notes.push("it answers whatever the unit is".to_owned());
        }
        if !scan.noise.is_empty() {
            let addresses: Vec<String> = scan.noise.iter().map(u8::to_string).collect();
            notes.push(format!(
                "what came from {} is no answer: two devices with one address, or another baud rate or parity",
                addresses.join(", ")
            ));
        }
        Found {
            link,
            devices: scan.servers.iter().map(|it| server(it, known)).collect(),
            notes,
            on_can: false,
        }
    }
}

fn node(node: &FoundNode, known: &Known) -> FoundDevice {
    let description = known.over_canopen(node.answers.as_ref());
    let mut heard = Vec::new();
    if node.heard.boot_up {
        heard.push("boot-up".to_owned());
    }
    if let Some(state) = node.heard.state {
        let period = node.heard.period.map(|it| format!(" every {}", shown(it)));
        heard.push(format!("heartbeat{} ({state})", period.unwrap_or_default()));
    }
    if let Some(code) = node.heard.emergency {
        heard.push(format!("EMCY {code}"));
    }
    if node.answers.is_none() {
        heard.push("no SDO answer".to_owned());
    }
    let answers = node.answers.clone().unwrap_or_default();
    let [vendor_id, product_code, revision_number, serial_number] = answers.identity;
    FoundDevice {
        device: description.map(|it| it.device.clone()),
        node: Some(node.node.raw()),
        address: None,
        device_type: answers.device_type,
        vendor_id,
        product_code,
        revision_number,
        serial_number,
        name: answers.name,
        heard,
    }
}

fn server(server: &FoundServer, known: &Known) -> FoundDevice {
    let description = known.over_modbus(&server.identification);
    let objects = server.identification.iter();
    let objects: Vec<&str> = objects.map(|(_, text)| text.as_str()).collect();
    let name = match objects.is_empty() {
        true => server.server_id.clone(),
        false => Some(objects.join(", ")),
    };
    let register_0 = match server.register_0 {
        Ok(value) => format!("{value:04X}h"),
        Err(code) => format!("exception {code}"),
    };
    FoundDevice {
        device: description.map(|it| it.device.clone()),
        address: Some(server.address),
        name,
        heard: vec![format!("register 0000h: {register_0}")],
        ..FoundDevice::default()
    }
}

/// To the millisecond.
fn shown(time: Duration) -> String {
    format!("{} ms", time.as_micros().div_ceil(500) / 2)
}

/// `1A0h TPDO1 of node 32 (5)`
fn identifier(heard: &HeardIdentifier) -> String {
    let service = match heard.service() {
        Some((service, Some(node))) => format!(" {service} of node {node}"),
        Some((service, None)) => format!(" {service}"),
        None => String::new(),
    };
    let frames = match heard.frames {
        1 => "1 frame".to_owned(),
        frames => format!("{frames} frames"),
    };
    format!("{}h{service} ({frames})", heard.id)
}

fn slave(slave: &LssSlave) -> String {
    let node = match slave.node {
        Some(node) => format!("node {node}"),
        None => "without a node-ID".to_owned(),
    };
    let [vendor, product, revision, serial] = slave.identity.map(number);
    format!(
        "LSS: a slave, {node}: vendor {vendor}, product {product}, revision {revision}, serial {serial}"
    )
}

/// As 1018h has it.
pub(super) fn number(number: Option<u32>) -> String {
    match number {
        Some(number) => format!("0x{number:08X}"),
        None => "-".to_owned(),
    }
}
