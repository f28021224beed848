//! Object dictionary tables, in a form that a person can read.
//!
//! One entry a line, columns apart by `|`, comments after `#`:
//!
//! ```text
//! # index:sub | type    | access | default       | status      | name
//! 1005:00     | u32     | ro     | 0x80          | -           | COB-ID SYNC message
//! 1014:00     | u32     | ro     | $NODEID+0x80  | -           | COB-ID emergency
//! 1016:01     | u32     | rw     | 0             | unsupported | consumer heartbeat time
//! 6040:00     | 16 bits | rw     | -             | -           | control word
//! ```
//!
//! | column | says |
//! | --- | --- |
//! | index:sub | index and sub-index in hexadecimal; a variable is at 00 |
//! | type | a word of the list below, `N bits` where only the size is printed, `-` if nothing is |
//! | access | `ro`, `wo`, `rw` or `const`; `-` if not printed |
//! | default | as an EDS writes it, `$NODEID` included; `-` if not printed |
//! | status | `unsupported` or `reserved` where the manual says so; else `-` |
//! | name | as the manual has it |
//!
//! The types are `bool`, `i8` to `i64` and `u8` to `u64` in steps of 8, `real32`, `real64`, `string`, `octets`,
//! `unicode`, `time`, `difference` and `domain`.

use std::collections::BTreeMap;

use crate::{Access, DataType};

/// A line of a table that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {text}")]
pub struct TableError {
    /// The line, from 1.
    pub line: usize,
    /// What is wrong.
    pub text: String,
}

/// The entries that a manual prints, in index order.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Table {
    rows: BTreeMap<(u16, u8), Row>,
}

/// One entry as the manual prints it; `None` where it prints nothing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Row {
    /// Its index.
    pub index: u16,
    /// Its sub-index.
    pub sub: u8,
    /// What it is called.
    pub name: String,
    /// Its type, or how large it is.
    pub size: Option<Size>,
    /// What may be done with it.
    pub access: Option<Access>,
    /// Its value after a reset to defaults, as an EDS writes it.
    pub default: Option<String>,
    /// Whether the manual says that the device has it.
    pub status: Status,
    /// The line of the table, from 1.
    pub line: usize,
}

/// What a manual says about the type of an entry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// The type.
    Type(DataType),
    /// The number of bits alone.
    Bits(u32),
}

/// Whether a manual that prints an entry says that the device has it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Status {
    /// It says nothing against it.
    Described,
    /// It says that the device does not support it.
    Unsupported,
    /// It says that it is reserved.
    Reserved,
}

impl Table {
    /// Reads a table.
    ///
    /// # Errors
    /// Every line that is no row, or that is a second row for an entry.
    pub fn parse(text: &str) -> Result<Table, Vec<TableError>> {
        let mut table = Table::default();
        let mut errors = Vec::new();
        for (number, text) in text.lines().enumerate() {
            let line = number + 1;
            let text = text.split('#').next().unwrap_or_default().trim();
            if text.is_empty() {
                continue;
            }
            if let Err(text) = row(text, line).and_then(|row| table.insert(row)) {
                errors.push(TableError { line, text });
            }
        }
        match errors.is_empty() {
            true => Ok(table),
            false => Err(errors),
        }
    }

    fn insert(&mut self, row: Row) -> Result<(), String> {
        let place = (row.index, row.sub);
        if let Some(first) = self.rows.get(&place) {
            return Err(format!("a second row for the entry of line {}", first.line));
        }
        self.rows.insert(place, row);
        Ok(())
    }

    /// The row of an entry.
    pub fn row(&self, index: u16, sub: u8) -> Option<&Row> {
        self.rows.get(&(index, sub))
    }

    /// Every row, in index order.
    pub fn rows(&self) -> impl Iterator<Item = &Row> {
        self.rows.values()
    }

    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }
}

fn row(text: &str, line: usize) -> Result<Row, String> {
    let columns: Vec<&str> = text.split('|').map(str::trim).collect();
    let [place, size, access, default, status, name] = columns[..] else {
        return Err(format!("{} columns instead of 6", columns.len()));
    };
    let (index, sub) = place_of(place)
        .ok_or_else(|| format!("`{place}` is no index and sub-index: 1018:01, in hexadecimal"))?;
    Ok(Row {
        index,
        sub,
        name: name.to_owned(),
        size: printed(size).map(size_of).transpose()?,
        access: printed(access).map(access_of).transpose()?,
        default: printed(default).map(str::to_owned),
        status: status_of(status)?,
        line,
    })
}

fn printed(text: &str) -> Option<&str> {
    (text != "-").then_some(text)
}

fn place_of(text: &str) -> Option<(u16, u8)> {
    let (index, sub) = text.split_once(':')?;
    let digits = |text: &str, count| {
        text.len() == count && text.bytes().all(|digit| digit.is_ascii_hexdigit())
    };
    if !digits(index, 4) || !digits(sub, 2) {
        return None;
    }
    let index = u16::from_str_radix(index, 16).ok()?;
    Some((index, u8::from_str_radix(sub, 16).ok()?))
}

fn size_of(text: &str) -> Result<Size, String> {
    if let Some(bits) = text.strip_suffix("bits") {
        let bits = bits.trim().parse();
        return bits
            .map(Size::Bits)
            .map_err(|_| format!("`{text}` is no size: 16 bits"));
    }
    let data_type = match text {
        "bool" => DataType::Boolean,
        "i8" => DataType::Integer8,
        "i16" => DataType::Integer16,
        "i24" => DataType::Integer24,
        "i32" => DataType::Integer32,
        "i40" => DataType::Integer40,
        "i48" => DataType::Integer48,
        "i56" => DataType::Integer56,
        "i64" => DataType::Integer64,
        "u8" => DataType::Unsigned8,
        "u16" => DataType::Unsigned16,
        "u24" => DataType::Unsigned24,
        "u32" => DataType::Unsigned32,
        "u40" => DataType::Unsigned40,
        "u48" => DataType::Unsigned48,
        "u56" => DataType::Unsigned56,
        "u64" => DataType::Unsigned64,
        "real32" => DataType::Real32,
        "real64" => DataType::Real64,
        "string" => DataType::VisibleString,
        "octets" => DataType::OctetString,
        "unicode" => DataType::UnicodeString,
        "time" => DataType::TimeOfDay,
        "difference" => DataType::TimeDifference,
        "domain" => DataType::Domain,
        other => return Err(format!("`{other}` is no type: u8, i16, string, 16 bits, …")),
    };
    Ok(Size::Type(data_type))
}

fn access_of(text: &str) -> Result<Access, String> {
    match Access::from_word(text) {
        Some(access) if access.word() == text => Ok(access),
        _ => Err(format!("`{text}` is no access: ro, wo, rw, const, -")),
    }
}

fn status_of(text: &str) -> Result<Status, String> {
    match text {
        "-" => Ok(Status::Described),
        "unsupported" => Ok(Status::Unsupported),
        "reserved" => Ok(Status::Reserved),
        other => Err(format!("`{other}` is neither unsupported, reserved nor -")),
    }
}
