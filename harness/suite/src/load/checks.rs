//! Which named checks a case has.

use std::collections::BTreeSet;

use crate::node::{Kind, Node};

/// Adds the names of the checks in `body`, a case with these rows.
pub(super) fn names(body: &Node, rows: &[Node], names: &mut BTreeSet<String>) {
    match &body.kind {
        Kind::Empty | Kind::Text(_) => {}
        Kind::List(elements) => {
            for element in elements {
                self::names(element, rows, names);
            }
        }
        Kind::Map(entries) => {
            for entry in entries {
                match entry.value.text().filter(|_| *entry.key.text == *"check") {
                    Some(name) if name.contains('{') => {
                        names.extend(rows.iter().map(|row| in_row(name, row)));
                    }
                    Some(name) => drop(names.insert(name.to_owned())),
                    None => self::names(&entry.value, rows, names),
                }
            }
        }
    }
}

fn in_row(name: &str, row: &Node) -> String {
    row.entries().iter().fold(name.to_owned(), |name, cell| {
        let column = format!("{{{}}}", cell.key.text);
        name.replace(&column, cell.value.text().unwrap_or_default())
    })
}
