//! `fieldproof devices` and `fieldproof faults`

use std::collections::BTreeMap;
use std::fmt::Write;

use fieldproof_run::feature_name;
use fieldproof_suite::identity::{Claim, Identity};
use fieldproof_suite::scalar::Value;
use serde::Serialize;

use crate::complaint::Complaint;
use crate::exit::Exit;
use crate::library::{Device, Library};
use crate::options::{Format, Selection};
use crate::screen::Screen;

#[derive(Serialize)]
struct ListedDevice<'a> {
    device: &'a str,
    title: &'a str,
    ports: Vec<&'a str>,
    node: Option<u8>,
    address: Option<u8>,
    identity: BTreeMap<&'static str, String>,
    features: Vec<&'static str>,
    deviations: Vec<&'a str>,
    faults: Vec<&'static str>,
    variants: Vec<&'static str>,
}

/// Lists the devices.
pub(crate) fn devices(format: Format, screen: &mut Screen) -> Result<Exit, Complaint> {
    let library = Library::load(&Selection::default())?;
    let devices: Vec<ListedDevice<'_>> = library.devices.iter().map(listed).collect();
    match format {
        Format::Json => screen.print_json(&devices),
        Format::Text => {
            let mut text = String::new();
            for device in &devices {
                describe(&mut text, device);
            }
            screen.print(&text);
        }
    }
    Ok(Exit::Passed)
}

fn listed(device: &Device) -> ListedDevice<'_> {
    let description = &device.description;
    ListedDevice {
        device: &description.device,
        title: &description.title,
        ports: description.ports.keys().map(String::as_str).collect(),
        node: description.canopen.as_ref().map(|canopen| canopen.node),
        address: description.modbus.as_ref().map(|modbus| modbus.address),
        identity: identity(&description.identity),
        features: description
            .features
            .iter()
            .map(|feature| feature_name(*feature))
            .collect(),
        deviations: description
            .deviates
            .iter()
            .map(|deviation| deviation.check.as_str())
            .collect(),
        faults: device.faults().map(|fault| fault.name).collect(),
        variants: device
            .variants()
            .iter()
            .map(|variant| variant.name)
            .collect(),
    }
}

/// What is claimed, as it is written in a description.
fn identity(identity: &Identity) -> BTreeMap<&'static str, String> {
    let claims = Claim::ALL.into_iter().filter_map(|claim| {
        let shown = match identity.claimed(claim)?.value {
            Value::Number(number) => format!("{number:#010X}"),
            Value::Text(text) => text,
            Value::Saved(_) | Value::Duration(_) | Value::Bytes(_) => return None,
        };
        Some((claim.name(), shown))
    });
    let mut claims: BTreeMap<&'static str, String> = claims.collect();
    if let Some(modbus) = &identity.modbus {
        let texts = [
            ("modbus vendor-name", &modbus.vendor_name),
            ("modbus product-code", &modbus.product_code),
            ("modbus revision", &modbus.revision),
        ];
        claims.extend(
            texts
                .into_iter()
                .filter_map(|(name, text)| Some((name, text.clone()?))),
        );
    }
    claims
}

fn describe(text: &mut String, device: &ListedDevice<'_>) {
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{}  {}", device.device, device.title);
    let mut line = |name: &str, words: String| {
        if !words.is_empty() {
            let _ = writeln!(text, "    {name:<10} {words}");
        }
    };
    let number = |number: Option<u8>| number.map(|it| it.to_string()).unwrap_or_default();
    line("ports", device.ports.join(", "));
    line("node", number(device.node));
    line("address", number(device.address));
    let claims = device
        .identity
        .iter()
        .map(|(name, value)| format!("{name} {value}"));
    line("identity", claims.collect::<Vec<_>>().join(", "));
    line("features", device.features.join(", "));
    line("deviates", device.deviations.join(", "));
    line("variants", device.variants.join(", "));
    line("faults", device.faults.len().to_string());
}

#[derive(Serialize)]
struct ListedFault {
    device: &'static str,
    fault: &'static str,
    breaks: &'static str,
    words: &'static str,
    caught_by: &'static str,
}

/// Lists the faults of the reference devices.
pub(crate) fn faults(format: Format, screen: &mut Screen) -> Result<Exit, Complaint> {
    let faults: Vec<ListedFault> = fieldproof_devices::kinds()
        .iter()
        .flat_map(|kind| {
            kind.faults().map(|fault| ListedFault {
                device: kind.name,
                fault: fault.name,
                breaks: fault.breaks,
                words: fault.words,
                caught_by: fault.caught_by,
            })
        })
        .collect();
    match format {
        Format::Json => screen.print_json(&faults),
        Format::Text => {
            let mut text = String::new();
            let width = faults
                .iter()
                .map(|fault| fault.fault.len())
                .max()
                .unwrap_or(0);
            let mut device = "";
            for fault in &faults {
                if fault.device != device {
                    let gap = if device.is_empty() { "" } else { "\n" };
                    let _ = writeln!(text, "{gap}{}", fault.device);
                    device = fault.device;
                }
                let _ = writeln!(text, "  {:<width$}  {}", fault.fault, fault.words);
                let _ = writeln!(text, "  {:<width$}  breaks {}", "", fault.breaks);
            }
            screen.print(&text);
        }
    }
    Ok(Exit::Passed)
}
