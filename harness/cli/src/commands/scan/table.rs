//! What was found, for people.

use std::fmt::Write;

use super::found::{Found, FoundDevice, number};

/// What stands where nothing is known.
const UNKNOWN: &str = "-";

/// A table of the devices, and what else there is to say.
pub(super) fn text(found: &Found) -> String {
    let mut text = format!("{}\n", found.link);
    if found.devices.is_empty() {
        text.push_str("nothing found\n");
    } else {
        table(&mut text, found);
    }
    // Writing to a string cannot fail.
    for note in &found.notes {
        let _ = writeln!(text, "note: {note}");
    }
    if found.devices.iter().any(|it| it.device.is_none()) {
        let claims = if found.on_can {
            "--eds FILE"
        } else {
            "--registers FILE"
        };
        let _ = writeln!(
            text,
            "note: what has no device is not known: `--device NAME` says which it is,\n      \
             `fieldproof new-device DIR {claims}` describes it"
        );
    }
    text
}

fn table(text: &mut String, found: &Found) {
    let head: &[&str] = match found.on_can {
        true => &[
            "node", "device", "vendor", "product", "revision", "serial", "name", "heard",
        ],
        false => &["address", "device", "identification", "answer"],
    };
    let head = head.iter().map(|word| (*word).to_owned()).collect();
    let rows = found.devices.iter().map(|it| match found.on_can {
        true => node(it),
        false => server(it),
    });
    let rows: Vec<Vec<String>> = std::iter::once(head).chain(rows).collect();
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    for row in &rows {
        let cells = row.iter().zip(&widths);
        let line: Vec<String> = cells
            .map(|(cell, width)| format!("{cell:<width$}"))
            .collect();
        let _ = writeln!(text, "{}", line.join("  ").trim_end());
    }
}

fn node(device: &FoundDevice) -> Vec<String> {
    vec![
        shown(device.node),
        shown(device.device.as_ref()),
        number(device.vendor_id),
        number(device.product_code),
        number(device.revision_number),
        number(device.serial_number),
        shown(device.name.as_ref()),
        device.heard.join(", "),
    ]
}

fn server(device: &FoundDevice) -> Vec<String> {
    vec![
        shown(device.address),
        shown(device.device.as_ref()),
        shown(device.name.as_ref()),
        device.heard.join(", "),
    ]
}

fn shown(value: Option<impl ToString>) -> String {
    value.map_or_else(|| UNKNOWN.to_owned(), |value| value.to_string())
}
