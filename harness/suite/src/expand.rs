//! Placeholders: what `{name}` in a case stands for.
//!
//! | written | stands for |
//! | --- | --- |
//! | `{period}` | the cell of the column `period` in the row of the table |
//! | `{node}`, `{address}` | the node-ID or the Modbus address of the device; in frames and bytes two digits |
//! | `{580+node}` | 580h and the node-ID; in frames with the digits of `580` |
//! | `{serial-number:u32le}` | a number of the identity that the description claims |
//! | `{80000000+serial-number:u32le}`, `{FF000000&serial-number:u32le}` | with a number added, or only these bits of it |
//! | `{speed:i32le}` | the number `speed` as the bytes of a signed 32-bit number, low byte first |
//! | `{device_type}` | the value that an earlier step saved; only where a value stands |

use std::borrow::Cow;
use std::cell::Cell;
use std::collections::BTreeSet;

use crate::identity::Claim;
use crate::node::{Kind, Node};
use crate::problem::{Problem, with_nearest};
use crate::scalar::whole_number;
use crate::{Position, code};

/// What the bench gives a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Environment {
    /// The node-ID of the device, 1 to 127, if it has a CANopen side.
    pub node: Option<u8>,
    /// The Modbus address of the device, 1 to 247, if it has a Modbus side.
    pub address: Option<u8>,
    /// The numbers that the device claims of its identity, as [`Claim::NUMBERS`] has them. One that it does not claim
    /// is read as 0; the case says that it needs it ([`crate::model::Case::claims`]).
    pub identity: [Option<u32>; 4],
}

/// The names that the bench and the description give; no column may have one.
pub(crate) const BENCH_NAMES: [&str; 6] = [
    "node",
    "address",
    Claim::VendorId.name(),
    Claim::ProductCode.name(),
    Claim::RevisionNumber.name(),
    Claim::SerialNumber.name(),
];

/// The longest text that placeholders may make, in bytes.
const LONGEST_TEXT: usize = 16 << 10;

/// What the placeholders of a case stand for.
#[derive(Debug, Clone, Default)]
pub(crate) struct Scope<'a> {
    /// The row of the table; a map.
    pub(crate) row: Option<&'a Node>,
    pub(crate) environment: Environment,
    /// The names that steps have saved so far.
    pub(crate) saved: BTreeSet<String>,
    /// The names that later steps of the case save.
    pub(crate) saved_later: BTreeSet<String>,
    /// How much may still be read, so that a few long cells used many times do not fill the memory.
    pub(crate) reads: Option<&'a Cell<u64>>,
}

/// How a number is written where it replaces a placeholder.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Notation {
    /// Decimal.
    Text,
    /// Two hexadecimal digits a byte.
    Hex,
}

/// One `{...}` in a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Placeholder<'t> {
    /// Where it starts and ends, in bytes, braces included.
    range: (usize, usize),
    /// The hexadecimal digits before a `+` or `&`, and which of them it is.
    operand: Option<(&'t str, Operator)>,
    pub(crate) name: &'t str,
    /// What follows a `:`.
    format: Option<&'t str>,
}

/// What is done with a number and the digits before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Operator {
    Plus,
    And,
}

impl Operator {
    const fn apply(self, number: i128, operand: u32) -> i128 {
        match self {
            Operator::Plus => number + operand as i128,
            Operator::And => number & operand as i128,
        }
    }
}

/// The placeholders in a text, in order. Braces around anything else are ordinary text.
pub(crate) fn placeholders(text: &str) -> impl Iterator<Item = Placeholder<'_>> {
    text.match_indices('{').filter_map(|(start, _)| {
        let inside = &text[start + 1..];
        let length = inside.find(|c: char| !(c.is_ascii_alphanumeric() || "+&:_-".contains(c)))?;
        let end = start + 1 + length;
        if !text[end..].starts_with('}') {
            return None;
        }
        let inside = &inside[..length];
        let (rest, format) = match inside.split_once(':') {
            Some((rest, format)) => (rest, Some(format)),
            None => (inside, None),
        };
        let (operand, name) = match rest.split_once(['+', '&']) {
            Some((digits, name)) if rest[digits.len()..].starts_with('+') => {
                (Some((digits, Operator::Plus)), name)
            }
            Some((digits, name)) => (Some((digits, Operator::And)), name),
            None => (None, rest),
        };
        let is_hexadecimal = |(digits, _): (&str, Operator)| {
            !digits.is_empty() && digits.chars().all(|digit| digit.is_ascii_hexdigit())
        };
        let well_formed = is_name(name)
            && operand.is_none_or(is_hexadecimal)
            && format.is_none_or(|format| format.chars().all(|c| c.is_ascii_alphanumeric()));
        well_formed.then_some(Placeholder {
            range: (start, end + 1),
            operand,
            name,
            format,
        })
    })
}

/// Whether `text` may name a column or a saved value.
pub(crate) fn is_name(text: &str) -> bool {
    text.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_')
        && text
            .chars()
            .all(|c| c.is_ascii_alphanumeric() || c == '-' || c == '_')
}

/// The name, if the whole text is one plain `{name}`.
pub(crate) fn whole(text: &str) -> Option<&str> {
    let name = text.strip_prefix('{')?.strip_suffix('}')?;
    is_name(name).then_some(name)
}

impl<'a> Scope<'a> {
    /// Takes note that something of this size is read.
    pub(crate) fn spend(&self, reads: u64) -> Result<(), Box<Problem>> {
        let Some(left) = self.reads else {
            return Ok(());
        };
        left.set(left.get().saturating_sub(reads));
        if left.get() > 0 {
            return Ok(());
        }
        let message = "this case is too large with this row of its table";
        Err(Problem::new(code::TOO_LARGE, message, "too much"))
    }

    /// The cell that stands for `node`, if `node` is one plain `{column}`.
    pub(crate) fn cell(&self, node: &Node) -> Option<&'a Node> {
        self.row?.get(whole(node.text()?)?)
    }

    /// The first cell that stands for a part of `text`.
    pub(crate) fn first_cell(&self, text: &str) -> Option<&'a Node> {
        let row = self.row?;
        placeholders(text).find_map(|placeholder| row.get(placeholder.name))
    }

    /// `text` with its placeholders replaced. In a cell of the table, `in_cell`, columns stand for nothing.
    pub(crate) fn replace<'t>(
        &self,
        text: &'t str,
        notation: Notation,
        in_cell: bool,
    ) -> Result<Cow<'t, str>, Box<Problem>> {
        if !text.contains('{') {
            return Ok(Cow::Borrowed(text));
        }
        let mut replaced = String::with_capacity(text.len());
        let mut done = 0;
        for placeholder in placeholders(text) {
            let (start, end) = placeholder.range;
            replaced.push_str(&text[done..start]);
            replaced.push_str(&self.value(placeholder, notation, in_cell)?);
            done = end;
            if replaced.len() > LONGEST_TEXT {
                let message = format!("this text becomes longer than {LONGEST_TEXT} bytes");
                return Err(Problem::new(code::TOO_LARGE, message, "too long"));
            }
        }
        self.spend(replaced.len() as u64 / 8)?;
        replaced.push_str(&text[done..]);
        Ok(Cow::Owned(replaced))
    }

    fn value(
        &self,
        placeholder: Placeholder<'_>,
        notation: Notation,
        in_cell: bool,
    ) -> Result<String, Box<Problem>> {
        let name = placeholder.name;
        let cell = self
            .row
            .filter(|_| !in_cell)
            .and_then(|row| row.get(name).map(|cell| (row, cell)));
        let text = match (cell, name) {
            (Some((_, cell)), _) => match &cell.kind {
                Kind::Text(text) => self.replace(text, notation, true)?,
                Kind::Empty => Cow::Borrowed(""),
                Kind::List(_) | Kind::Map(_) => {
                    return Err(Problem::new(
                        code::UNKNOWN_PLACEHOLDER,
                        format!("`{{{name}}}` is {} here", cell.kind_in_words()),
                        "expected a single value inside a text",
                    )
                    .also(cell.at, "this stands for it"));
                }
            },
            (None, "node") => {
                return bench_number(placeholder, self.environment.node, notation);
            }
            (None, "address") => {
                return bench_number(placeholder, self.environment.address, notation);
            }
            (None, _) => {
                let identity = Claim::NUMBERS.into_iter().zip(self.environment.identity);
                return match { identity }.find(|(claim, _)| claim.name() == name) {
                    Some((_, number)) => identity_number(placeholder, number, notation),
                    None => Err(self.unknown(name, in_cell)),
                };
            }
        };
        if placeholder.operand.is_none() && placeholder.format.is_none() {
            return Ok(text.into_owned());
        }
        let number = whole_number(&text).ok_or_else(|| {
            Problem::new(
                code::UNKNOWN_PLACEHOLDER,
                format!("`{text}` stands for `{{{name}}}` and is not a number"),
                "expected a whole number",
            )
        })?;
        number_in(placeholder, number, notation)
    }

    /// What is said of a name that stands for nothing.
    pub(crate) fn unknown(&self, name: &str, in_cell: bool) -> Box<Problem> {
        if self.saved.contains(name) {
            let message = format!("`{{{name}}}` is a saved value, and only a value can be one");
            return Problem::new(
                code::UNKNOWN_PLACEHOLDER,
                message,
                "known while the case plays",
            );
        }
        if self.saved_later.contains(name) {
            let message = format!("`{{{name}}}` is used before a step has saved it");
            return Problem::new(code::NOT_YET_SAVED, message, "saved by a later step");
        }
        let mut known: Vec<&str> = Vec::new();
        if let Some(row) = self.row.filter(|_| !in_cell) {
            known.extend(row.entries().iter().map(|entry| entry.key.text.as_ref()));
        }
        known.extend(BENCH_NAMES);
        known.extend(self.saved.iter().map(String::as_str));
        let problem = Problem::new(
            code::UNKNOWN_PLACEHOLDER,
            format!("`{{{name}}}` stands for nothing"),
            "not a column of the case's table, and nothing that a step saved",
        );
        with_nearest(problem, name, &known)
    }
}

fn bench_number(
    placeholder: Placeholder<'_>,
    number: Option<u8>,
    notation: Notation,
) -> Result<String, Box<Problem>> {
    match number {
        Some(number) => number_in(placeholder, i128::from(number), notation),
        None => Err(Problem::new(
            code::UNKNOWN_PLACEHOLDER,
            format!("`{{{}}}` stands for nothing here", placeholder.name),
            "the device does not have one in this suite's protocol",
        )),
    }
}

/// A number of 32 bits: what is added to it may carry no further.
fn identity_number(
    placeholder: Placeholder<'_>,
    number: Option<u32>,
    notation: Notation,
) -> Result<String, Box<Problem>> {
    let number = i128::from(number.unwrap_or_default());
    let number = match operand(placeholder)? {
        Some((operand, operator, _)) => operator.apply(number, operand),
        None => number,
    };
    written(placeholder, number & i128::from(u32::MAX), 8, notation)
}

fn number_in(
    placeholder: Placeholder<'_>,
    number: i128,
    notation: Notation,
) -> Result<String, Box<Problem>> {
    match operand(placeholder)? {
        Some((operand, operator, digits)) => {
            let number = operator.apply(number, operand);
            written(placeholder, number, digits, notation)
        }
        None => written(placeholder, number, 2, notation),
    }
}

/// The operand, what is done with it, and how many digits it has.
fn operand(placeholder: Placeholder<'_>) -> Result<Option<(u32, Operator, usize)>, Box<Problem>> {
    let Some((digits, operator)) = placeholder.operand else {
        return Ok(None);
    };
    let number = u32::from_str_radix(digits, 16).map_err(|_| {
        let message = format!("`{digits}` has more than 32 bits");
        Problem::new(code::UNKNOWN_PLACEHOLDER, message, "too high")
    })?;
    Ok(Some((number, operator, digits.len())))
}

fn written(
    placeholder: Placeholder<'_>,
    number: i128,
    digits: usize,
    notation: Notation,
) -> Result<String, Box<Problem>> {
    match placeholder.format {
        Some(format) => bytes_of(number, format),
        None if notation == Notation::Hex => Ok(format!("{number:0digits$X}")),
        None if placeholder.operand.is_some() => Ok(format!("0x{number:X}")),
        None => Ok(number.to_string()),
    }
}

/// `u16be`, `i32le`, `u8`: the number as bytes, in hexadecimal.
fn bytes_of(number: i128, format: &str) -> Result<String, Box<Problem>> {
    let unknown = || {
        Problem::new(
            code::UNKNOWN_PLACEHOLDER,
            format!("unknown format `{format}`"),
            "expected u8, u16le, u16be, u32le, u32be, i16le ...",
        )
    };
    let signed = format.starts_with('i');
    let rest = format.strip_prefix(['u', 'i']).ok_or_else(unknown)?;
    let (bits, big_endian) = match (rest.strip_suffix("le"), rest.strip_suffix("be")) {
        (Some(bits), _) => (bits, false),
        (_, Some(bits)) => (bits, true),
        _ if rest == "8" => (rest, false),
        _ => return Err(unknown()),
    };
    let bits: u32 = match bits {
        "8" => 8,
        "16" => 16,
        "24" => 24,
        "32" => 32,
        "64" => 64,
        _ => return Err(unknown()),
    };
    let (low, high) = match signed {
        true => (-(1i128 << (bits - 1)), (1i128 << (bits - 1)) - 1),
        false => (0, (1i128 << bits) - 1),
    };
    if !(low..=high).contains(&number) {
        return Err(Problem::new(
            code::DOES_NOT_FIT,
            format!("{number} does not fit {format}"),
            format!("expected {low} to {high}"),
        ));
    }
    let mut bytes: Vec<u8> = number.to_le_bytes()[..bits as usize / 8].to_vec();
    if big_endian {
        bytes.reverse();
    }
    Ok(bytes.iter().map(|byte| format!("{byte:02X}")).collect())
}

/// Where a problem in the text at `template`, whose placeholder stands for `cell`, is best shown.
pub(crate) fn show_at_cell(problem: &mut Problem, cell: Position, template: Position) {
    problem.at = Some(cell);
    problem.template = Some(template);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::yaml;

    fn replace(text: &str, notation: Notation) -> Result<String, String> {
        let row = yaml::read(
            "t",
            "{data: '00 {node}', speed: -2, high: 70000, list: [1]}",
        )
        .unwrap();
        let scope = Scope {
            row: Some(&row),
            environment: Environment {
                node: Some(10),
                address: None,
                identity: [Some(0xFFFF_FFFF), Some(0x1234_5678), None, Some(8)],
            },
            saved: BTreeSet::from(["kept".to_owned()]),
            saved_later: BTreeSet::from(["later".to_owned()]),
            reads: None,
        };
        let replaced = scope.replace(text, notation, false);
        replaced
            .map(Cow::into_owned)
            .map_err(|problem| format!("{} {}", problem.code, problem.message))
    }

    #[test]
    fn placeholders_are_replaced() {
        use Notation::{Hex, Text};
        for (text, notation, expected) in [
            (
                "no placeholder {in here} {}",
                Text,
                "no placeholder {in here} {}",
            ),
            ("{speed} and {speed}", Text, "-2 and -2"),
            ("{node}", Text, "10"),
            ("{580+node}", Text, "0x58A"),
            ("{580+node}#{data}.{node}", Hex, "58A#00 0A.0A"),
            ("{00000580+node}#", Hex, "0000058A#"),
            (
                "{speed:i16le} {speed:i16be} {speed:i8}",
                Hex,
                "FEFF FFFE FE",
            ),
            ("{high:u24be}", Hex, "011170"),
            ("{serial-number}", Text, "8"),
            ("{product-code:u32le}", Hex, "78563412"),
            (
                "{1+vendor-id:u32le} {1+serial-number}",
                Hex,
                "00000000 00000009",
            ),
            ("{FF00&product-code:u32be} {F&node}", Hex, "00005600 A"),
            ("{revision-number:u32le}", Hex, "00000000"),
        ] {
            assert_eq!(replace(text, notation), Ok(expected.to_owned()), "{text}");
        }
        for (text, expected) in [
            ("{sped}", "S034 `{sped}` stands for nothing"),
            ("{address}", "S034 `{address}` stands for nothing here"),
            ("{speed:u16le}", "S026 -2 does not fit u16le"),
            ("{high:u16}", "S034 unknown format `u16`"),
            (
                "{data:u8}",
                "S034 `00 0A` stands for `{data}` and is not a number",
            ),
            ("{list}.", "S034 `{list}` is a list here"),
            (
                "{later}",
                "S039 `{later}` is used before a step has saved it",
            ),
            ("{FFFFFFFFF+node}", "S034 `FFFFFFFFF` has more than 32 bits"),
        ] {
            assert_eq!(
                replace(text, Notation::Hex),
                Err(expected.to_owned()),
                "{text}"
            );
        }
    }
}
