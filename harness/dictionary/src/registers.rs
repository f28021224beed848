//! Modbus register maps, from a table a person can read.
//!
//! One register a line, columns apart by `|`, comments after `#`:
//!
//! ```text
//! # address | access | type | range         | default | unit | persists | name
//! 0x0004    | r      | i16  | -15000..15000 | -       | rpm  | -        | speed
//! 325       | rw     | i16  | -6000..6000   | 0       | rpm  | no       | internal speed command 1
//! ```
//!
//! | column | says |
//! | --- | --- |
//! | address | of the (first) register in the PDU, from 0; decimal or `0x` |
//! | access | `r`, `w` or `rw` |
//! | type | `u16`, `i16`, `u32`, `i32`; a 32-bit value takes two registers |
//! | range | lowest and highest value, both allowed; `-` for all that the type holds |
//! | default | after a reset to defaults; `-` if not known |
//! | unit | of one count; `-` if it has none |
//! | persists | whether a value written survives power-off: `yes`, `no`, `-` if not known |
//! | name | of the register |

use std::collections::BTreeMap;

use crate::Access;
use crate::integer::Integer;

/// The registers a device claims to have, in address order.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RegisterMap {
    registers: BTreeMap<u16, Register>,
}

/// One value of a register map.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Register {
    /// The address of its (first) register in the PDU.
    pub address: u16,
    /// How many registers it takes: 1 or 2.
    pub words: u16,
    /// What it is called.
    pub name: String,
    /// What may be done with it: read only, write only, or read and write.
    pub access: Access,
    /// Whether it is in two's complement.
    pub signed: bool,
    /// The lowest value.
    pub low: i64,
    /// The highest value.
    pub high: i64,
    /// The value after a reset to defaults, if it is known.
    pub default: Option<i64>,
    /// The unit of one count; empty if it has none.
    pub unit: String,
    /// Whether a value written survives power-off, if it is known.
    pub persists: Option<bool>,
    /// The line of the table, from 1.
    pub line: usize,
}

/// A line of a table that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {text}")]
pub struct TableError {
    /// The line, from 1.
    pub line: usize,
    /// What is wrong.
    pub text: String,
}

impl RegisterMap {
    /// Reads a register table.
    ///
    /// # Errors
    /// The first line that is no register, or whose register overlaps one of an earlier line.
    pub fn parse(text: &str) -> Result<RegisterMap, TableError> {
        let mut map = RegisterMap::default();
        for (number, text) in text.lines().enumerate() {
            let line = number + 1;
            let text = text.split('#').next().unwrap_or_default().trim();
            if text.is_empty() {
                continue;
            }
            let register = register(text, line).map_err(|text| TableError { line, text })?;
            map.insert(register)?;
        }
        Ok(map)
    }

    fn insert(&mut self, register: Register) -> Result<(), TableError> {
        let taken = (0..register.words)
            .filter_map(|word| self.containing(register.address.checked_add(word)?))
            .next();
        if let Some(other) = taken {
            return Err(TableError {
                line: register.line,
                text: format!("overlaps the register of line {}", other.line),
            });
        }
        self.registers.insert(register.address, register);
        Ok(())
    }

    /// The value that starts at `address`.
    pub fn register(&self, address: u16) -> Option<&Register> {
        self.registers.get(&address)
    }

    /// The value that `address` belongs to: its only register, or one of two.
    pub fn containing(&self, address: u16) -> Option<&Register> {
        let (start, register) = self.registers.range(..=address).next_back()?;
        (address - start < register.words).then_some(register)
    }

    /// Every value, in address order.
    pub fn registers(&self) -> impl Iterator<Item = &Register> {
        self.registers.values()
    }

    /// How many values there are.
    pub fn len(&self) -> usize {
        self.registers.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.registers.is_empty()
    }
}

fn register(text: &str, line: usize) -> Result<Register, String> {
    let columns: Vec<&str> = text.split('|').map(str::trim).collect();
    let [address, access, kind, range, default, unit, persists, name] = columns[..] else {
        return Err(format!("{} columns instead of 8", columns.len()));
    };
    let (signed, words) = match kind {
        "u16" => (false, 1),
        "i16" => (true, 1),
        "u32" => (false, 2),
        "i32" => (true, 2),
        other => return Err(format!("`{other}` is no type: u16, i16, u32, i32")),
    };
    let (low, high) = limits(range, signed, words)?;
    let default = match default {
        "-" => None,
        text => Some(integer(text)?),
    };
    if let Some(value) = default.filter(|value| !(low..=high).contains(value)) {
        return Err(format!("the default {value} is outside {low}..{high}"));
    }
    let address = u16::try_from(integer(address)?)
        .ok()
        .filter(|address| address.checked_add(words - 1).is_some())
        .ok_or_else(|| format!("`{address}` is no register address"))?;
    Ok(Register {
        address,
        words,
        name: name.to_owned(),
        access: access_of(access)?,
        signed,
        low,
        high,
        default,
        unit: if unit == "-" { "" } else { unit }.to_owned(),
        persists: persists_of(persists)?,
        line,
    })
}

fn limits(text: &str, signed: bool, words: u16) -> Result<(i64, i64), String> {
    let bits = 16 * u32::from(words);
    let (lowest, highest) = if signed {
        (-(1_i64 << (bits - 1)), (1_i64 << (bits - 1)) - 1)
    } else {
        (0, (1_i64 << bits) - 1)
    };
    if text == "-" {
        return Ok((lowest, highest));
    }
    let (low, high) = text
        .split_once("..")
        .ok_or_else(|| format!("`{text}` is no range: low..high"))?;
    let (low, high) = (integer(low)?, integer(high)?);
    if low > high || low < lowest || high > highest {
        return Err(format!("the range {low}..{high} does not fit the type"));
    }
    Ok((low, high))
}

fn integer(text: &str) -> Result<i64, String> {
    Integer::parse(text)
        .and_then(|integer| i64::try_from(integer.value).ok())
        .ok_or_else(|| format!("`{text}` is no number"))
}

fn access_of(text: &str) -> Result<Access, String> {
    match text {
        "r" => Ok(Access::ReadOnly),
        "w" => Ok(Access::WriteOnly),
        "rw" => Ok(Access::ReadWrite),
        other => Err(format!("`{other}` is no access: r, w, rw")),
    }
}

fn persists_of(text: &str) -> Result<Option<bool>, String> {
    match text {
        "-" => Ok(None),
        "yes" => Ok(Some(true)),
        "no" => Ok(Some(false)),
        other => Err(format!("`{other}` is neither yes, no nor -")),
    }
}
