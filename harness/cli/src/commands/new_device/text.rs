//! The files of a new device, with comments that say what is taken from where and what nobody said.

use std::fmt::Write;

use super::infer::Claims;

/// What is known of the device.
pub(super) struct Device<'a> {
    pub(super) name: &'a str,
    pub(super) eds: Option<&'a str>,
    pub(super) claims: Option<&'a Claims>,
    pub(super) registers: Option<&'a str>,
}

/// The text in quotes. What JSON quotes, YAML reads.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// The device.yaml.
pub(super) fn description(device: &Device<'_>) -> String {
    let mut text = format!("language: 1\ndevice: {}\n", device.name);
    // Writing to a string cannot fail.
    let _ = writeln!(text, "title: {}", quoted(&title(device)));
    if let Some(claims) = device.claims {
        for (what, number) in &claims.identity {
            let _ = writeln!(
                text,
                "# The EDS gives {number} ({number:#010X}) as {what} number, as 1018h should read."
            );
        }
    }
    text.push_str("sources:\n");
    if let Some(eds) = device.eds {
        let _ = writeln!(text, "  eds: {{document: {}}}", quoted(eds));
    }
    if let Some(registers) = device.registers {
        let _ = writeln!(text, "  registers: {{document: {}}}", quoted(registers));
    }
    text.push_str("ports:\n");
    if device.eds.is_some() {
        match device.claims.and_then(|claims| claims.bit_rate) {
            Some(rate) => {
                let _ = writeln!(
                    text,
                    "  # The highest bit rate of the EDS; which one is set on the device is NOT KNOWN.\n  can: {{can: {rate} kbit/s}}"
                );
            }
            None => text
                .push_str("  # NOT KNOWN: the EDS names no bit rate.\n  can: {can: 125 kbit/s}\n"),
        }
    }
    if device.registers.is_some() {
        text.push_str("  # NOT KNOWN: a register map says nothing of the line. These are the settings that Modbus has where nothing is said.\n  serial: {serial: 19200, parity: even, stop-bits: 1}\n");
    }
    if let Some(eds) = device.eds {
        let _ = writeln!(
            text,
            "# NOT KNOWN: the node-ID, which an EDS does not say.\ncanopen: {{node: 1, eds: {}}}",
            quoted(eds)
        );
    }
    if let Some(registers) = device.registers {
        let _ = writeln!(
            text,
            "# NOT KNOWN: the address, which a register map does not say.\nmodbus: {{address: 1, registers: {}}}",
            quoted(registers)
        );
    }
    text.push_str("features:\n");
    for (feature, why) in device.claims.iter().flat_map(|claims| &claims.features) {
        let _ = writeln!(text, "  # {why}\n  - {feature}");
    }
    if device.registers.is_some() {
        text.push_str("  - modbus-rtu\n");
    }
    if device.eds.is_some() {
        text.push_str("  # NOT KNOWN from an EDS; take the # away where the manual claims it.\n  # - sdo-block\n  # - sync-producer\n");
    }
    text.push_str("# NOT KNOWN: how fast the device promises to be. Where nothing stands here, the defaults of the language hold.\n# timing: {sdo-response: 50 ms, boot-up: 2 s}\n# NOT KNOWN: what can happen to things and people. Look here before anything is permitted on a bench.\n# dangers: {moves: the shaft turns}\n");
    text
}

fn title(device: &Device<'_>) -> String {
    let claims = device.claims;
    let words = [
        claims.and_then(|claims| claims.vendor.as_deref()),
        claims.and_then(|claims| claims.product.as_deref()),
    ];
    let words: Vec<&str> = words
        .into_iter()
        .flatten()
        .map(str::trim)
        .filter(|word| !word.is_empty())
        .collect();
    match words.is_empty() {
        true => device.name.to_owned(),
        false => words.join(" "),
    }
}

/// The bench.yaml.
pub(super) fn bench(device: &Device<'_>) -> String {
    let ports = [
        device.eds.map(|_| "can: \"sim:\""),
        device.registers.map(|_| "serial: \"sim:\""),
    ];
    let ports: Vec<&str> = ports.into_iter().flatten().collect();
    format!(
        "language: 1
bench: {name}-bench
devices:
  - name: {name}
    # The description beside this file.
    device: .
    # Simulated, which needs a reference device of this name.
    ports: {{{ports}}}
    # What cases may do beside reading: writes, persists, readdresses, moves, resets, disturbs-bus.
    permits: []
",
        name = device.name,
        ports = ports.join(", "),
    )
}
