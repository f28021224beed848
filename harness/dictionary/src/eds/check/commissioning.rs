//! How a DCF sets up one device.

use super::super::{Commissioning, Eds, Finding, rules};
use super::at;
use crate::{Default, Entry, Number};

const NODE_NAME_LENGTH: usize = 246;

pub(super) fn check(eds: &Eds, findings: &mut Vec<Finding>) {
    if let Some(device) = &eds.commissioning {
        node(eds, device, findings);
        bit_rate(eds, device, findings);
    }
    for (index, sub, entry) in eds.dictionary.entries() {
        value(eds, index, sub, entry, findings);
    }
}

fn node(eds: &Eds, device: &Commissioning, findings: &mut Vec<Finding>) {
    if let Some(node) = device.node_id.filter(|node| !(1..=127).contains(node)) {
        findings.push(Finding::new(
            &rules::NODE_OF_DEVICE,
            eds.line_of(device.line, "NodeID"),
            format!("NodeID is {node}"),
            "write 1 to 127",
        ));
    }
    // An empty name has its line too.
    let section = eds.section_at(device.line);
    let key = section.and_then(|section| section.key("NodeName"));
    let name = device.node_name.as_deref().unwrap_or_default();
    let length = name.chars().count();
    if length == 0 || length > NODE_NAME_LENGTH {
        findings.push(Finding::new(
            &rules::NAME_OF_NODE,
            key.map_or(device.line, |key| key.line),
            format!("NodeName has {length} characters"),
            format!("write 1 to {NODE_NAME_LENGTH} of them"),
        ));
    }
}

fn bit_rate(eds: &Eds, device: &Commissioning, findings: &mut Vec<Finding>) {
    let rates = &eds.device_info.bit_rates_kbit_per_s;
    if let Some(rate) = device.bit_rate_kbit_per_s
        && !rates.is_empty()
        && !rates.contains(&rate)
    {
        let rates: Vec<String> = rates.iter().map(u32::to_string).collect();
        findings.push(Finding::new(
            &rules::BIT_RATE_OF_DEVICE,
            eds.line_of(device.line, "Baudrate"),
            format!("Baudrate is {rate}, but the device has no {rate} kbit/s"),
            format!("the device has {} kbit/s", rates.join(", ")),
        ));
    }
}

fn value(eds: &Eds, index: u16, sub: u8, entry: &Entry, findings: &mut Vec<Finding>) {
    let Some(Default::Number(value)) = entry.parameter_value else {
        return;
    };
    if entry.data_type.is_real() {
        return;
    }
    let node = eds.node_id().unwrap_or(1);
    let low = entry.low_limit.map(|limit| limit.value(node));
    let high = entry.high_limit.map(|limit| limit.value(node));
    let said = value.value(node);
    if low.is_some_and(|low| said < low) || high.is_some_and(|high| said > high) {
        findings.push(Finding::new(
            &rules::VALUE_OUTSIDE,
            line(eds, index, sub, entry),
            format!(
                "the value {} of {} is outside its limits",
                shown(value),
                at(index, sub)
            ),
            "correct it; the device would refuse it",
        ));
    }
}

fn shown(value: Number) -> String {
    match value.relative_to_node {
        true => format!("$NODEID+{}", value.offset),
        false => value.offset.to_string(),
    }
}

/// Where the value of an entry is said: in its own section, or in the list of values of its object.
fn line(eds: &Eds, index: u16, sub: u8, entry: &Entry) -> usize {
    let own = eds.key_at(entry.line, "ParameterValue");
    let listed = || {
        let list = eds.section(&format!("{index:04X}Value"))?;
        list.filled(&sub.to_string())
    };
    own.or_else(listed).map_or(entry.line, |key| key.line)
}
