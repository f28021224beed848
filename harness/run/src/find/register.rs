//! Values of the register map, and the addresses beside them.

use fieldproof_dictionary::Access;
use fieldproof_dictionary::registers::{Holes, Kind, Register, RegisterMap, RegisterTable, Table};
use fieldproof_suite::Columns;
use fieldproof_suite::model::{AccessWord, Has, Query, TypeWord};

/// The tables that are meant.
fn tables<'a>(
    query: &Query,
    map: &'a RegisterMap,
) -> impl Iterator<Item = (Table, &'a RegisterTable)> {
    let meant: Vec<Table> = query.table.iter().map(|word| word.table()).collect();
    map.tables()
        .filter(move |(table, _)| meant.is_empty() || meant.contains(table))
}

pub(super) fn registers(query: &Query, map: &RegisterMap) -> Vec<Columns> {
    let length = usize::from(query.row.unwrap_or(1));
    let mut found = Vec::new();
    for (table, values) in tables(query, map) {
        let matching: Vec<&Register> = values.registers().filter(|it| is_so(query, it)).collect();
        let rows = rows(&matching, length);
        found.extend(rows.map(|(first, last)| columns(table, first, last)));
    }
    found
}

/// The first and the last of every `length` registers of `matching` that follow each other without a gap.
fn rows<'r>(
    matching: &[&'r Register],
    length: usize,
) -> impl Iterator<Item = (&'r Register, &'r Register)> {
    // How many follow each other up to each of them, itself counted.
    let mut run = 0;
    let mut before: Option<&Register> = None;
    let runs = matching.iter().enumerate().map(move |(place, register)| {
        let follows =
            before.is_some_and(|it| it.addresses().end().checked_add(1) == Some(register.address));
        run = if follows { run + 1 } else { 1 };
        before = Some(register);
        (place, run)
    });
    runs.filter(move |(_, run)| *run >= length)
        .filter_map(move |(last, _)| {
            let first = (last + 1).checked_sub(length)?;
            Some((*matching.get(first)?, *matching.get(last)?))
        })
}

/// The addresses that are said to be refused, with their table.
pub(super) fn holes(query: &Query, map: &RegisterMap) -> Vec<Columns> {
    tables(query, map)
        .filter(|(_, values)| values.holes == Holes::Refused)
        .flat_map(|(table, values)| {
            let holes = values.holes_beside().into_iter();
            holes.map(move |address| {
                vec![
                    ("", address.to_string()),
                    ("-table", table.name().to_owned()),
                ]
            })
        })
        .collect()
}

fn is_so(query: &Query, register: &Register) -> bool {
    let access = query.access.is_empty() || query.access.iter().any(|it| is(*it, register.access));
    let of_type = query.types.is_empty() || query.types.contains(&type_word(register.kind));
    let has = query.has.iter().all(|has| match has {
        Has::Default => register.default.is_some(),
        Has::Low => register.low.is_some(),
        Has::High => register.high.is_some(),
        Has::Below => below(register).is_some(),
        Has::Above => above(register).is_some(),
        Has::Codes => !register.codes.is_empty(),
        Has::Bits => !register.bits.is_empty(),
        // Of objects only.
        Has::Structure => false,
    });
    let effects = query.effect.is_empty()
        || register.effects.as_ref().is_some_and(|effects| {
            let allowed = |effect| query.effect.iter().any(|it| it.effect() == effect);
            effects.iter().all(|effect| allowed(*effect))
        });
    let takes = query.takes.is_none_or(|values| {
        register.low.is_some_and(|low| low <= values.from)
            && register.high.is_some_and(|high| high >= values.to)
    });
    let persists = query.persists.is_none() || query.persists == register.persists;
    access && of_type && has && effects && takes && persists
}

fn is(word: AccessWord, access: Access) -> bool {
    match word {
        AccessWord::Ro => access == Access::ReadOnly,
        AccessWord::Wo => access == Access::WriteOnly,
        AccessWord::Rw => access == Access::ReadWrite,
        AccessWord::Readable => access.readable(),
        AccessWord::Writable => access.writable(),
        AccessWord::Rwr | AccessWord::Rww | AccessWord::Const => false,
    }
}

const fn type_word(kind: Kind) -> TypeWord {
    match kind {
        Kind::Bit => TypeWord::Boolean,
        Kind::U16 => TypeWord::U16,
        Kind::I16 => TypeWord::I16,
        Kind::U32 => TypeWord::U32,
        Kind::I32 => TypeWord::I32,
        Kind::F32 => TypeWord::Real32,
    }
}

/// The value below the lowest, if the type can hold it.
fn below(register: &Register) -> Option<i64> {
    let low = register.low?;
    (low > register.kind.lowest()).then(|| low - 1)
}

/// The value above the highest, if the type can hold it.
fn above(register: &Register) -> Option<i64> {
    let high = register.high?;
    (high < register.kind.highest()).then(|| high + 1)
}

fn columns(table: Table, register: &Register, of_row: &Register) -> Columns {
    let last = *of_row.addresses().end();
    let mut columns = vec![
        ("", register.address.to_string()),
        ("-name", register.name.clone()),
        ("-table", table.name().to_owned()),
        ("-type", register.kind.name().to_owned()),
        ("-access", register.access.word().to_owned()),
        (
            "-count",
            (u32::from(last - register.address) + 1).to_string(),
        ),
        ("-last", last.to_string()),
    ];
    // A value of two registers is not written as one number.
    if register.kind.words() == 1 {
        let numbers = [
            ("-default", register.default),
            ("-low", register.low),
            ("-high", register.high),
            ("-below", below(register)),
            ("-above", above(register)),
        ];
        for (suffix, number) in numbers {
            columns.extend(number.map(|it| (suffix, (it & 0xFFFF).to_string())));
        }
        let of_last = [
            ("-last-low", of_row.low),
            ("-last-high", of_row.high),
            ("-last-below", below(of_row)),
            ("-last-above", above(of_row)),
        ];
        for (suffix, number) in of_last {
            columns.extend(number.map(|it| (suffix, (it & 0xFFFF).to_string())));
        }
    }
    columns
}
