//! The files of a new device, with comments that say what is taken from where and what nobody said.

use std::fmt::Write;

use super::infer::{BitRate, Claims};

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
    text.push_str("sources:\n");
    if let Some(eds) = device.eds {
        let _ = writeln!(text, "  eds: {{document: {}}}", quoted(eds));
    }
    if let Some(registers) = device.registers {
        let _ = writeln!(text, "  registers: {{document: {}}}", quoted(registers));
    }
    if let Some(claims) = device.claims {
        text.push_str(&identity(claims));
    }
    text.push_str("ports:\n");
    if let Some(claims) = device.claims {
        let (why, rate) = match claims.bit_rate {
            Some(BitRate::Set(rate)) => ("As the DCF was made for.", rate),
            Some(BitRate::Highest(rate)) => (
                "The highest bit rate of the EDS; which one is set on the device is NOT KNOWN.",
                rate,
            ),
            None => ("NOT KNOWN: the EDS names no bit rate.", 125),
        };
        let _ = writeln!(text, "  # {why}\n  can: {{can: {rate} kbit/s}}");
    }
    if device.registers.is_some() {
        text.push_str("  # NOT KNOWN: a register map says nothing of the line. These are the settings that Modbus has where nothing is said.\n  serial: {serial: 19200, parity: even, stop-bits: 1}\n");
    }
    if let Some(eds) = device.eds {
        let (why, node) = match device.claims.and_then(|claims| claims.node) {
            Some(node) => ("The node-ID that the DCF was made for.", node),
            None => ("NOT KNOWN: the node-ID, which an EDS does not say.", 1),
        };
        let _ = writeln!(
            text,
            "# {why}\ncanopen: {{node: {node}, eds: {}}}",
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
    for feature in device.claims.iter().flat_map(|claims| &claims.features) {
        let off = if feature.is_claimed { "" } else { "# " };
        let _ = writeln!(text, "  # {}\n  {off}- {}", feature.why, feature.name);
    }
    if device.registers.is_some() {
        text.push_str("  - modbus-rtu\n");
    }
    if device.eds.is_some() {
        text.push_str("  # NOT KNOWN from an EDS; take the # away where the manual claims it.\n  # - sdo-block\n");
    }
    text.push_str("# NOT KNOWN: how fast the device promises to be. Where nothing stands here, the defaults of the language hold.\n# timing: {sdo-response: 50 ms, boot-up: 2 s}\n# NOT KNOWN: what can happen to things and people. Look here before anything is permitted on a bench.\n# dangers: {moves: the shaft turns}\n");
    text
}

fn identity(claims: &Claims) -> String {
    let is_claimed = claims.identity.iter().any(|part| part.is_claimed);
    let (mut text, off) = match is_claimed {
        true => (
            "# What stands here is compared with the device; what does not is not.\nidentity:\n"
                .to_owned(),
            "",
        ),
        false => (
            "# NOT KNOWN: who the device says it is. What does not stand here is not compared.\n# identity:\n"
                .to_owned(),
            "# ",
        ),
    };
    for part in &claims.identity {
        let off_too = if part.is_claimed { "" } else { "# " };
        let off_too = if off.is_empty() { off_too } else { "" };
        let _ = writeln!(
            text,
            "{off}  # {}\n{off}  {off_too}{}: {}",
            part.why, part.name, part.value
        );
    }
    if claims.identity.is_empty() {
        text.push_str("#   vendor-id: 0x12345678\n");
    }
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
    let ports = |can: &str, serial: &str| {
        let can = device.eds.map(|_| format!("can: \"{can}\""));
        let serial = device.registers.map(|_| format!("serial: \"{serial}\""));
        let ports: Vec<String> = can.into_iter().chain(serial).collect();
        format!("ports: {{{}}}", ports.join(", "))
    };
    let mut real = vec![ports("socketcan:can0", "serial:/dev/ttyUSB0")];
    if device.eds.is_some() {
        real.push(ports("slcan:/dev/ttyACM0", "serial:/dev/ttyUSB0"));
    }
    if device.registers.is_some() {
        real.push(ports("socketcan:can0", "tcp:192.168.0.5:502"));
    }
    let real: String = real.iter().map(|it| format!("    # {it}\n")).collect();
    format!(
        "language: 1
bench: {name}-bench
devices:
  - name: {name}
    # The description beside this file.
    device: .
    # What it is connected to: put the true line in the place of this one, which needs a reference device of this name.
    {simulated}
{real}    # What is set on the device, where it is not what the description has:
{numbers}    # What cases may do beside reading: writes, persists, readdresses, moves, resets, disturbs-bus.
    permits: []
",
        name = device.name,
        simulated = ports("sim:", "sim:"),
        numbers = [
            device.eds.map_or("", |_| "    # node: 1\n"),
            device.registers.map_or("", |_| "    # address: 1\n"),
        ]
        .concat(),
    )
}
