//! A register map.

use fieldproof_dictionary::Access;
use fieldproof_dictionary::registers::{
    Kind, Register, RegisterMap, RegisterTable, Scale, Table, WordOrder,
};
use serde::Deserialize;

use super::SourceFile;
use super::suite::{check_language, check_name};
use crate::expand::Scope;
use crate::file::{AccessFile, RegisterFile, RegistersFile, TableFile, WholeNumber};
use crate::model::Located;
use crate::node::Node;
use crate::problem::Problem;
use crate::read::Reader;
use crate::yaml;
use crate::{Diagnostic, Position, code};

/// Reads a register map.
///
/// # Errors
/// Everything that is wrong with it.
pub fn load_registers(file: &SourceFile) -> Result<RegisterMap, Vec<Diagnostic>> {
    let root = yaml::read(&file.path, &file.text)?;
    let mut problems = Vec::new();
    match read(&root, &mut problems) {
        Some(map) if problems.is_empty() => Ok(map),
        _ => {
            problems.sort_by_key(|problem| problem.at);
            let problems = problems.into_iter();
            Err(problems
                .map(|problem| problem.into_diagnostic(&file.path))
                .collect())
        }
    }
}

fn read(root: &Node, problems: &mut Vec<Problem>) -> Option<RegisterMap> {
    if let Err(problem) = check_language(root) {
        problems.push(*problem);
        return None;
    }
    let scope = Scope::default();
    let file = match RegistersFile::deserialize(Reader::new(root, &scope, root.at)) {
        Ok(file) => file,
        Err(error) => {
            problems.push(*error.0);
            return None;
        }
    };
    if let Err(problem) = check_name(&file.registers.value, file.registers.at) {
        problems.push(*problem);
    }
    let mut map = RegisterMap::default();
    let word_order = file.word_order.map(|order| order.lower());
    let tables = [
        (Table::Holding, file.holding),
        (Table::Input, file.input),
        (Table::Coils, file.coils.map(registers_of)),
        (
            Table::DiscreteInputs,
            file.discrete_inputs.map(registers_of),
        ),
    ];
    for (table, values) in tables {
        if let Some(values) = values {
            map.set_table(table, read_table(table, values, word_order, problems));
        }
    }
    if map.tables().all(|(_, table)| table.is_empty()) && problems.is_empty() {
        let problem = Problem::new(
            code::EMPTY,
            "the map has no registers",
            "needs `holding`, `input`, `coils` or `discrete-inputs` with at least one range",
        );
        problems.push(*problem.at(file.registers.at));
    }
    Some(map)
}

fn registers_of<T: Into<RegisterFile>>(table: TableFile<T>) -> TableFile<RegisterFile> {
    let ranges = table.ranges.into_iter();
    TableFile {
        holes: table.holes,
        ranges: ranges
            .map(|range| Located {
                value: range.value.into(),
                at: range.at,
            })
            .collect(),
    }
}

fn read_table(
    table: Table,
    file: TableFile<RegisterFile>,
    word_order: Option<WordOrder>,
    problems: &mut Vec<Problem>,
) -> RegisterTable {
    let mut registers = RegisterTable::new(file.holes.lower());
    let mut places: Vec<Position> = Vec::new();
    for range in file.ranges {
        let at = range.at;
        let is_right = check(table, &range.value, at, problems);
        if !is_right {
            continue;
        }
        places.push(at);
        for register in expand(&range.value, at, word_order) {
            let address = register.address;
            let Err(other) = registers.insert(register) else {
                continue;
            };
            let message = format!("register {address} belongs to `{}` already", other.name);
            let mut problem =
                Problem::new(code::REGISTER_TWICE, message, "a second time here").at(at);
            if let Some(first) = places.iter().find(|place| place.line == other.line) {
                problem = problem.also(*first, "first here");
            }
            problems.push(*problem);
            break;
        }
    }
    registers
}

/// What is wrong with a range by itself.
fn check(table: Table, range: &RegisterFile, at: Position, problems: &mut Vec<Problem>) -> bool {
    let before = problems.len();
    let kind = range.kind.lower();
    check_extent(range, kind, at, problems);
    check_access(table, range, at, problems);
    check_values(range, kind, problems);
    for bit in range.bits.keys() {
        if !(0..i128::from(kind.bits())).contains(&bit.0) {
            let message = format!("bit {} of a value of {} bits", bit.0, kind.bits());
            let label = format!("expected bits 0 to {}", kind.bits() - 1);
            problems.push(*Problem::new(code::DOES_NOT_FIT, message, label).at(at));
        }
    }
    for value in range.codes.keys() {
        check_fits(Located { value: *value, at }, kind, problems);
    }
    problems.len() == before
}

fn check_extent(range: &RegisterFile, kind: Kind, at: Position, problems: &mut Vec<Problem>) {
    let count = u32::from(range.count.unwrap_or(1));
    let end = u32::from(range.address) + count * u32::from(kind.words());
    if end > 0x1_0000 {
        let problem = Problem::new(
            code::NUMBER,
            format!("the last of its registers would be {}", end - 1),
            "expected addresses up to 65535",
        );
        problems.push(*problem.at(at));
    }
    if range.word_order.is_some() && kind.words() == 1 {
        let problem = Problem::new(
            code::KEYS_TOGETHER,
            "one register has no order of words",
            "expected a `type` of 32 bits beside `word-order`",
        );
        problems.push(*problem.at(at));
    }
}

fn check_access(table: Table, range: &RegisterFile, at: Position, problems: &mut Vec<Problem>) {
    let writes = !matches!(range.access, AccessFile::R);
    if writes && !table.can_be_written() {
        let problem = Problem::new(
            code::KEYS_TOGETHER,
            format!("nothing in the table `{}` can be written", table.name()),
            "expected `access: r`",
        );
        problems.push(*problem.at(at));
    } else if !writes && (!range.effect.0.is_empty() || range.persists.is_some()) {
        let problem = Problem::new(
            code::KEYS_TOGETHER,
            "what cannot be written has no `effect` and no `persists`",
            "expected `access: w` or `access: rw` beside them",
        );
        problems.push(*problem.at(at));
    }
}

/// Limits and default against the type and each other.
fn check_values(range: &RegisterFile, kind: Kind, problems: &mut Vec<Problem>) {
    let mut fit = true;
    for value in [range.low, range.high, range.default].into_iter().flatten() {
        fit &= check_fits(value, kind, problems);
    }
    if !fit {
        return;
    }
    let value_of = |limit: Option<Located<WholeNumber>>, or: i64| {
        limit.map_or(i128::from(or), |limit| limit.value.0)
    };
    let low = value_of(range.low, kind.lowest());
    let high = value_of(range.high, kind.highest());
    let last = range.high.or(range.low);
    if let Some(at) = last.map(|limit| limit.at).filter(|_| low > high) {
        let message = format!("nothing lies between {low} and {high}");
        let label = "expected `low` to be below `high`";
        problems.push(*Problem::new(code::OUTSIDE_LIMITS, message, label).at(at));
    } else if let Some(default) = range.default
        && !(low..=high).contains(&default.value.0)
    {
        let message = format!("the default {} is outside its limits", default.value.0);
        let label = format!("expected {low} to {high}");
        problems.push(*Problem::new(code::OUTSIDE_LIMITS, message, label).at(default.at));
    }
}

fn check_fits(value: Located<WholeNumber>, kind: Kind, problems: &mut Vec<Problem>) -> bool {
    let range = i128::from(kind.lowest())..=i128::from(kind.highest());
    if range.contains(&value.value.0) {
        return true;
    }
    let message = format!("{} does not fit {}", value.value.0, kind.name());
    let label = format!("expected {} to {}", range.start(), range.end());
    problems.push(*Problem::new(code::DOES_NOT_FIT, message, label).at(value.at));
    false
}

/// The registers of a range that has been checked.
fn expand(
    range: &RegisterFile,
    at: Position,
    word_order: Option<WordOrder>,
) -> impl Iterator<Item = Register> {
    let kind = range.kind.lower();
    let words = kind.words();
    let own_order = range.word_order.map(|order| order.lower());
    let value_of = |limit: Option<Located<WholeNumber>>| {
        limit.and_then(|limit| i64::try_from(limit.value.0).ok())
    };
    let effects = range.effect.0.iter().map(|effect| effect.lower());
    let first = Register {
        address: range.address,
        name: range.name.clone(),
        kind,
        access: match range.access {
            AccessFile::R => Access::ReadOnly,
            AccessFile::W => Access::WriteOnly,
            AccessFile::Rw => Access::ReadWrite,
        },
        low: value_of(range.low),
        high: value_of(range.high),
        default: value_of(range.default),
        unit: range.unit.clone(),
        scale: range.scale.map(|scale| Scale {
            multiply: scale.multiply,
            divide: scale.divide,
        }),
        word_order: own_order.or(word_order).filter(|_| words == 2),
        persists: range.persists,
        effects: effects
            .collect::<Option<_>>()
            .filter(|_| !range.effect.0.is_empty()),
        codes: range
            .codes
            .iter()
            .filter_map(|(code, name)| Some((i64::try_from(code.0).ok()?, name.clone())))
            .collect(),
        bits: range
            .bits
            .iter()
            .filter_map(|(bit, name)| Some((u8::try_from(bit.0).ok()?, name.clone())))
            .collect(),
        line: at.line,
    };
    let numbered_from = u32::from(range.numbered_from);
    let count = range.count;
    (0..count.unwrap_or(1)).map(move |offset| Register {
        address: first.address.saturating_add(offset * words),
        name: match count {
            Some(_) => format!("{} {}", first.name, numbered_from + u32::from(offset)),
            None => first.name.clone(),
        },
        ..first.clone()
    })
}
