//! An EDS held against the table of a manual.

use super::{Row, Size, Status, Table};
use crate::eds::{Eds, Finding, Rule, field, rules};
use crate::{DataType, Default, Entry, Object};

/// Where an EDS and a table differ.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    /// What differs, and the line of the EDS. Where the EDS has no such entry this is the line of its object, or of
    /// the list that the object would be in, or 1.
    pub finding: Finding,
    /// The line of the table; `None` where the table has no such entry.
    pub row: Option<usize>,
}

/// Where `eds` and `table` differ, in the order of the lines of the EDS.
///
/// What the table does not print is not compared. `const` is `ro` and `rwr` or `rww` is `rw` here: manuals seldom tell
/// them apart.
pub fn compare(eds: &Eds, table: &Table) -> Vec<Difference> {
    let mut differences = Vec::new();
    for row in table.rows() {
        match eds.dictionary.entry(row.index, row.sub) {
            Some(entry) => of_entry(eds, entry, row, &mut differences),
            None if row.status == Status::Described => differences.push(missing(eds, row)),
            None => {}
        }
    }
    for object in eds.dictionary.objects() {
        differences.extend(unprinted(object, table));
    }
    differences.sort_by_key(|difference| (difference.finding.line, difference.finding.rule.code));
    differences
}

/// An entry that the manual says the device has, and the EDS does not describe.
fn missing(eds: &Eds, row: &Row) -> Difference {
    let list = match row.index {
        0x1000 | 0x1001 | 0x1018 => "MandatoryObjects",
        0x2000..=0x5FFF => "ManufacturerObjects",
        _ => "OptionalObjects",
    };
    let object = eds.dictionary.object(row.index).map(|object| object.line);
    let line = object.or_else(|| eds.section(list).map(|section| section.line));
    Difference {
        finding: Finding::new(
            &rules::NOT_IN_EDS,
            line.unwrap_or(1),
            format!("the manual has {}, the EDS does not", named(row)),
            "describe it if the device has it",
        ),
        row: Some(row.line),
    }
}

/// The entries of `object` that the manual does not print, if there are any.
fn unprinted(object: &Object, table: &Table) -> Option<Difference> {
    let subs: Vec<(&u8, &Entry)> = object
        .entries
        .iter()
        .filter(|(sub, _)| table.row(object.index, **sub).is_none())
        .collect();
    let (first, entry) = subs.first()?;
    let (what, line) = match subs.len() {
        count if count == object.entries.len() => (format!("{:04X}", object.index), object.line),
        1 => (format!("{:04X}:{first:02X}", object.index), entry.line),
        count => (
            format!(
                "{:04X}:{first:02X} and {} more of its entries",
                object.index,
                count - 1
            ),
            entry.line,
        ),
    };
    Some(Difference {
        finding: Finding::new(
            &rules::NOT_IN_MANUAL,
            line,
            format!("the EDS has {what}, the manual does not"),
            "nothing of it can be held against the manual",
        ),
        row: None,
    })
}

fn of_entry(eds: &Eds, entry: &Entry, row: &Row, differences: &mut Vec<Difference>) {
    let mut differ = |rule: &'static Rule, key: &str, text: String, help: &str| {
        differences.push(Difference {
            finding: Finding::new(rule, eds.line_of(entry.line, key), text, help),
            row: Some(row.line),
        });
    };
    let word = match row.status {
        Status::Described => None,
        Status::Unsupported => Some("not supported"),
        Status::Reserved => Some("reserved"),
    };
    if let Some(word) = word {
        differ(
            &rules::NOT_SUPPORTED,
            "ParameterName",
            format!(
                "the EDS describes {}, which is {word} by the manual",
                named(row)
            ),
            "remove it if the device does nothing with it",
        );
    }
    if let Some(size) = row.size.filter(|size| !size.is_of(entry.data_type)) {
        let wanted = match size {
            Size::Type(data_type) => format!("{data_type:?}"),
            Size::Bits(bits) => format!("{bits} bits"),
        };
        differ(
            &rules::MANUAL_TYPE,
            "DataType",
            format!(
                "{} is {:?} in the EDS, {wanted} in the manual",
                named(row),
                entry.data_type
            ),
            "read it: the number of bytes of the answer tells which is right",
        );
    }
    let rights = |access: crate::Access| (access.readable(), access.writable());
    if let Some(access) = row
        .access
        .filter(|access| rights(*access) != rights(entry.access))
    {
        differ(
            &rules::MANUAL_ACCESS,
            "AccessType",
            format!(
                "{} is {} in the EDS, {} in the manual",
                named(row),
                entry.access.word(),
                access.word()
            ),
            "the device answers 06010001h or 06010002h to what it does not allow",
        );
    }
    let Some(printed) = &row.default else {
        return;
    };
    match &entry.default {
        None => differ(
            &rules::DEFAULT_IN_MANUAL_ALONE,
            "DefaultValue",
            format!(
                "{} has no default in the EDS, {printed} in the manual",
                named(row)
            ),
            "write the default if the device has it",
        ),
        Some(default) if !is_written(default, printed, entry.data_type) => differ(
            &rules::MANUAL_DEFAULT,
            "DefaultValue",
            format!(
                "{} is {} by default in the EDS, {printed} in the manual",
                named(row),
                eds.key_at(entry.line, "DefaultValue")
                    .map_or("counted", |key| key.value)
            ),
            "read it after a reset to defaults",
        ),
        Some(_) => {}
    }
}

impl Size {
    /// Whether `data_type` is of this type or size.
    fn is_of(self, data_type: DataType) -> bool {
        match self {
            Size::Type(wanted) => data_type == wanted,
            // A BOOLEAN takes a byte in an SDO.
            Size::Bits(bits) => {
                data_type.bits() == Some(bits) || (bits == 8 && data_type == DataType::Boolean)
            }
        }
    }
}

/// Whether `printed` is `default` in the type of the EDS, for every node.
fn is_written(default: &Default, printed: &str, data_type: DataType) -> bool {
    let Some(printed) = field::value(printed, data_type) else {
        return false;
    };
    [1, 127].into_iter().all(|node| match (default, &printed) {
        (Default::Number(one), Default::Number(other)) => one.value(node) == other.value(node),
        (one, other) => {
            one == other || {
                let bytes = one.bytes(data_type, node);
                bytes.is_some() && bytes == other.bytes(data_type, node)
            }
        }
    })
}

/// `6040:00 control word`
fn named(row: &Row) -> String {
    let text = format!("{:04X}:{:02X} {}", row.index, row.sub, row.name);
    text.trim_end().to_owned()
}
