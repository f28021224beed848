//! Values of the dictionary.

use fieldproof_dictionary::{Access, DataType, Default, Dictionary, Entry, Object, ObjectKind};
use fieldproof_suite::Columns;
use fieldproof_suite::model::{AccessWord, Has, MappableInto, Query, TypeWord};

use super::{is_meant, place};

pub(super) fn objects(query: &Query, dictionary: &Dictionary, node: u8) -> Vec<Columns> {
    let entries = dictionary.entries();
    entries
        // Below are the data types and the dummies, which are no values.
        .filter(|(index, sub, _)| *index >= 0x1000 && is_meant(query, *index, *sub))
        .filter_map(|(index, sub, entry)| {
            let word = type_word(entry.data_type)?;
            let structure = dictionary
                .object(index)
                .filter(|_| sub == 0xFF)
                .and_then(structure);
            let value = ValueOf {
                entry,
                word,
                node,
                structure,
            };
            is_so(query, &value).then(|| columns(index, sub, &value))
        })
        .collect()
}

struct ValueOf<'d> {
    entry: &'d Entry,
    word: TypeWord,
    node: u8,
    /// Of sub-index FFh: what it must be.
    structure: Option<u32>,
}

impl ValueOf<'_> {
    fn low(&self) -> Option<i128> {
        self.entry.low_limit.map(|low| low.value(self.node))
    }

    fn high(&self) -> Option<i128> {
        self.entry.high_limit.map(|high| high.value(self.node))
    }

    fn below(&self) -> Option<i128> {
        let (lowest, _) = range(self.entry.data_type)?;
        self.low().filter(|low| *low > lowest).map(|low| low - 1)
    }

    fn above(&self) -> Option<i128> {
        let (_, highest) = range(self.entry.data_type)?;
        self.high()
            .filter(|high| *high < highest)
            .map(|high| high + 1)
    }

    /// A number as a suite writes it for `as`.
    fn written(&self, number: i128) -> String {
        let size = self.entry.data_type.bytes().unwrap_or(0);
        match self.word.as_word() {
            "bytes" => pairs(number.to_le_bytes().get(..size).unwrap_or_default()),
            _ => number.to_string(),
        }
    }

    /// In bytes; of what has no size of its own, that of its default.
    fn size(&self) -> Option<usize> {
        let fixed = self.entry.data_type.bytes();
        fixed.or_else(|| self.entry.default_bytes(self.node).map(|bytes| bytes.len()))
    }

    /// As a suite writes it.
    fn default(&self) -> Option<String> {
        let bytes = self.entry.default_bytes(self.node)?;
        match (self.word.as_word(), self.entry.default.as_ref()?) {
            ("text", Default::Text(text)) => Some(text.clone()),
            ("bytes", _) => Some(pairs(&bytes)),
            (_, Default::Number(number)) => {
                let (lowest, highest) = range(self.entry.data_type).unwrap_or((0, i128::MAX));
                let value = number.value(self.node);
                // A bit pattern of a negative number.
                let wrapped = match lowest < 0 && value > highest {
                    true => value - 2 * (highest + 1),
                    false => value,
                };
                Some(wrapped.to_string())
            }
            _ => {
                let mut little_endian = [0; 16];
                little_endian
                    .get_mut(..bytes.len())?
                    .copy_from_slice(&bytes);
                Some(u128::from_le_bytes(little_endian).to_string())
            }
        }
    }
}

/// What sub-index FFh of an object tells (CiA 301), as far as an EDS says it: it has the data type of an array, and not
/// that of a record.
///
/// | bits | |
/// | --- | --- |
/// | 0 to 7 | object code |
/// | 8 to 15 | data type |
/// | 16 to 31 | 0 |
fn structure(object: &Object) -> Option<u32> {
    let element = match object.kind {
        ObjectKind::Array => object.entries.get(&1)?,
        _ => return None,
    };
    let data_type = u8::try_from(element.data_type.code()).ok()?;
    Some(u32::from(data_type) << 8 | u32::from(object.kind.code()))
}

/// Bytes as a suite writes them.
fn pairs(bytes: &[u8]) -> String {
    let digits: Vec<String> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    digits.join(" ")
}

fn is_so(query: &Query, value: &ValueOf<'_>) -> bool {
    let entry = value.entry;
    let access = query.access.is_empty() || query.access.iter().any(|it| is(*it, entry.access));
    let of_type = query.types.is_empty() || query.types.contains(&value.word);
    let bounded = query.size.from.is_some() || query.size.to.is_some();
    let of_size = !bounded
        || value.size().is_some_and(|size| {
            let from = query.size.from.unwrap_or(0) as usize;
            let to = query.size.to.map_or(usize::MAX, |to| to as usize);
            (from..=to).contains(&size)
        });
    let has = query.has.iter().all(|has| match has {
        Has::Default => value.default().is_some(),
        Has::Low => value.low().is_some(),
        Has::High => value.high().is_some(),
        Has::Below => value.below().is_some(),
        Has::Above => value.above().is_some(),
        Has::Structure => value.structure.is_some(),
        // No EDS says so.
        Has::Codes | Has::Bits => false,
    });
    let mappable = query.pdo.is_none_or(|pdo| is_mappable(pdo, entry));
    access && of_type && of_size && has && mappable
}

fn is(word: AccessWord, access: Access) -> bool {
    match word {
        AccessWord::Ro => access == Access::ReadOnly,
        AccessWord::Wo => access == Access::WriteOnly,
        AccessWord::Rw => access == Access::ReadWrite,
        AccessWord::Rwr => access == Access::ReadWriteOnRead,
        AccessWord::Rww => access == Access::ReadWriteOnWrite,
        AccessWord::Const => access == Access::Constant,
        AccessWord::Readable => access.readable(),
        AccessWord::Writable => access.writable(),
    }
}

fn is_mappable(into: MappableInto, entry: &Entry) -> bool {
    let access = entry.access;
    match into {
        MappableInto::No => !entry.pdo_mapping,
        MappableInto::Rpdo => {
            entry.pdo_mapping && access.writable() && access != Access::ReadWriteOnRead
        }
        MappableInto::Tpdo => {
            entry.pdo_mapping && access.readable() && access != Access::ReadWriteOnWrite
        }
    }
}

fn columns(index: u16, sub: u8, value: &ValueOf<'_>) -> Columns {
    let mut columns = place(index, sub);
    columns.push(("-name", value.entry.name.clone()));
    columns.push(("-type", value.word.as_word().to_owned()));
    columns.push(("-access", value.entry.access.word().to_owned()));
    if let Some(size) = value.size() {
        let bits = value
            .entry
            .data_type
            .bits()
            .map_or(8 * size, |bits| bits as usize);
        let mapping = u32::from(index) << 16 | u32::from(sub) << 8;
        columns.push(("-size", size.to_string()));
        columns.push(("-bits", bits.to_string()));
        columns.push((
            "-mapping",
            format!("0x{:08X}", mapping as usize | bits & 0xFF),
        ));
    }
    let numbers = [
        ("-low", value.low()),
        ("-high", value.high()),
        ("-below", value.below()),
        ("-above", value.above()),
    ];
    for (suffix, number) in numbers {
        columns.extend(number.map(|number| (suffix, value.written(number))));
    }
    columns.extend(value.default().map(|default| ("-default", default)));
    let structure = value.structure.map(|word| format!("0x{word:08X}"));
    columns.extend(structure.map(|structure| ("-structure", structure)));
    columns
}

/// The lowest and the highest value of an integer type.
fn range(data_type: DataType) -> Option<(i128, i128)> {
    let real = matches!(data_type, DataType::Real32 | DataType::Real64);
    let time = matches!(data_type, DataType::TimeOfDay | DataType::TimeDifference);
    let bits = data_type.bits().filter(|_| !real && !time)?;
    match data_type.is_signed() {
        true => Some((-(1 << (bits - 1)), (1 << (bits - 1)) - 1)),
        false => Some((0, (1 << bits) - 1)),
    }
}

const fn type_word(data_type: DataType) -> Option<TypeWord> {
    Some(match data_type {
        DataType::Boolean => TypeWord::Boolean,
        DataType::Integer8 => TypeWord::I8,
        DataType::Integer16 => TypeWord::I16,
        DataType::Integer24 => TypeWord::I24,
        DataType::Integer32 => TypeWord::I32,
        DataType::Integer40 => TypeWord::I40,
        DataType::Integer48 => TypeWord::I48,
        DataType::Integer56 => TypeWord::I56,
        DataType::Integer64 => TypeWord::I64,
        DataType::Unsigned8 => TypeWord::U8,
        DataType::Unsigned16 => TypeWord::U16,
        DataType::Unsigned24 => TypeWord::U24,
        DataType::Unsigned32 => TypeWord::U32,
        DataType::Unsigned40 => TypeWord::U40,
        DataType::Unsigned48 => TypeWord::U48,
        DataType::Unsigned56 => TypeWord::U56,
        DataType::Unsigned64 => TypeWord::U64,
        DataType::Real32 => TypeWord::Real32,
        DataType::Real64 => TypeWord::Real64,
        DataType::VisibleString => TypeWord::Text,
        DataType::OctetString => TypeWord::Octets,
        DataType::UnicodeString => TypeWord::Unicode,
        DataType::TimeOfDay => TypeWord::TimeOfDay,
        DataType::TimeDifference => TypeWord::TimeDifference,
        DataType::Domain => TypeWord::Domain,
        DataType::Unknown(_) => return None,
    })
}
