//! The bench to start from.

use std::fmt::Write;
use std::path::Path;

use fieldproof_suite::bench::{Link, LinkKind};
use fieldproof_suite::device::{Parity, PortDescription};

use super::found::{Found, FoundDevice};
use super::known::{Known, role};

/// `link` as a bench file writes it, with how it was set for the scan, which descriptions may have otherwise.
pub(super) fn link(text: &str, link: &Link, set: &PortDescription) -> String {
    let (place, parameters) = match text.split_once('?') {
        Some((place, parameters)) => (place, Some(parameters)),
        None => (text, None),
    };
    let mut place = place.to_owned();
    let mut parameters: Vec<String> = parameters.iter().map(|it| (*it).to_owned()).collect();
    match (link.kind, set) {
        (LinkKind::Slcan, PortDescription::Can { bit_rate }) => {
            place = format!("slcan:{}@{bit_rate}", link.target);
        }
        (
            LinkKind::Serial,
            PortDescription::Serial {
                baud,
                parity,
                stop_bits,
                ..
            },
        ) => {
            let said = &link.parameters;
            let mut add = |is_said: bool, parameter: String| {
                if !is_said {
                    parameters.push(parameter);
                }
            };
            add(said.baud.is_some(), format!("baud={baud}"));
            add(said.parity.is_some(), format!("parity={}", word(*parity)));
            add(said.stop_bits.is_some(), format!("stop-bits={stop_bits}"));
        }
        _ => {}
    }
    match parameters.is_empty() {
        true => place,
        false => format!("{place}?{}", parameters.join("&")),
    }
}

const fn word(parity: Parity) -> &'static str {
    match parity {
        Parity::None => "none",
        Parity::Even => "even",
        Parity::Odd => "odd",
    }
}

/// The bench of what was found, in the file at `path` if it is to be one; `None` if there is no description of any.
/// What cannot stand there is a comment: what no description is known of, and all but one device on a link that only one
/// can use.
pub(super) fn text(found: &Found, known: &Known, path: Option<&Path>) -> Option<String> {
    let mut text = "language: 1\nbench: found\ndevices:\n".to_owned();
    let mut is_empty = true;
    for device in &found.devices {
        // Writing to a string cannot fail.
        match entry(device, found, known, path) {
            None => drop(writeln!(text, "  # {} is not described.", number(device))),
            Some(entry) if is_empty || !opens_once(&found.link) => {
                text.push_str(&entry);
                is_empty = false;
            }
            Some(entry) => {
                text.push_str("  # The link can be opened once only, so one of these at a time:\n");
                for line in entry.lines() {
                    let _ = writeln!(text, "  #{}", line.strip_prefix(' ').unwrap_or(line));
                }
            }
        }
    }
    (!is_empty).then_some(text)
}

/// An adapter and a serial line have one user.
fn opens_once(link: &str) -> bool {
    link.starts_with("serial:") || link.starts_with("slcan:")
}

fn number(device: &FoundDevice) -> String {
    match (device.node, device.address) {
        (Some(node), _) => format!("Node {node}"),
        (None, address) => format!("Address {}", address.unwrap_or_default()),
    }
}

/// A device on the bench, if it can stand there.
fn entry(
    device: &FoundDevice,
    found: &Found,
    known: &Known,
    path: Option<&Path>,
) -> Option<String> {
    let name = device.device.as_deref()?;
    let role = role(known.named(name)?, found.on_can, &found.link)?;
    let (key, number) = match (device.node, device.address) {
        (Some(node), _) => ("node", node),
        (None, Some(address @ 1..=247)) => ("address", address),
        (None, _) => return None,
    };
    let described = match known.folder(name) {
        Some(folder) => seen_from(folder, path),
        None => name.to_owned(),
    };
    Some(format!(
        "  - name: {name}-{number}
    device: {}
    ports: {{{role}: {}}}
    {key}: {number}
    # What cases may do beside reading: writes, persists, readdresses, moves, resets, disturbs-bus.
    permits: []
",
        quoted(&described),
        quoted(&found.link),
    ))
}

/// The folder as the bench file at `path` sees it.
fn seen_from(folder: &str, path: Option<&Path>) -> String {
    let folder = folder.trim_end_matches("device.yaml").trim_end_matches('/');
    let here = path
        .and_then(Path::parent)
        .is_none_or(|it| it.as_os_str().is_empty());
    let is_relative = Path::new(folder).is_relative();
    match (here, folder) {
        (true, "" | ".") => ".".to_owned(),
        (true, _) if is_relative && !folder.starts_with('.') => format!("./{folder}"),
        (true, _) => folder.to_owned(),
        (false, _) => {
            let folder = if folder.is_empty() { "." } else { folder };
            let whole = Path::new(folder).canonicalize();
            whole.map_or_else(|_| folder.to_owned(), |it| it.display().to_string())
        }
    }
}

/// A text in YAML. What JSON quotes, YAML reads.
fn quoted(text: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '-';
    match text.chars().all(is_plain) && text.starts_with(|c: char| c.is_ascii_alphabetic()) {
        true => text.to_owned(),
        false => serde_json::Value::from(text).to_string(),
    }
}
