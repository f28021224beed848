//! Prints what this crate reads from an EDS, one entry a line, for a comparison with another reader:
//! `index sub type access mappable low high default`, numbers for node-ID 5, `-` where there is none, the default as its
//! bytes.
//!
//! `cargo run --example dump_eds < FILE`

#![allow(clippy::print_stdout, reason = "that is what it is for")]

use std::io::{self, Read};

use fieldproof_dictionary::{Access, Entry, Number, eds};

/// That of the comparison.
const NODE: u8 = 5;

fn main() -> io::Result<()> {
    let mut text = String::new();
    io::stdin().read_to_string(&mut text)?;
    for (index, sub, entry) in eds::read(&text).dictionary.entries() {
        println!("{}", line(index, sub, entry));
    }
    Ok(())
}

fn line(index: u16, sub: u8, entry: &Entry) -> String {
    let number = |number: Option<Number>| {
        number.map_or_else(|| "-".to_owned(), |number| number.value(NODE).to_string())
    };
    let default = entry.default_bytes(NODE).map_or_else(
        || "-".to_owned(),
        |bytes| bytes.iter().map(|byte| format!("{byte:02x}")).collect(),
    );
    let access = match entry.access {
        Access::ReadOnly => "ro",
        Access::WriteOnly => "wo",
        Access::ReadWrite => "rw",
        Access::ReadWriteOnRead => "rwr",
        Access::ReadWriteOnWrite => "rww",
        Access::Constant => "const",
    };
    format!(
        "{index:04x} {sub:02x} {:04x} {access} {} {} {} {default}",
        entry.data_type.code(),
        u8::from(entry.pdo_mapping),
        number(entry.low_limit),
        number(entry.high_limit),
    )
}
