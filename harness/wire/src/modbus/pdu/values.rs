//! Lists and quantities inside the limits that the length of a PDU gives them.

use std::ops::Deref;

use crate::modbus::reader::Reader;
use crate::{Rule, Violation};

bounded! {
    /// How many coils or discrete inputs are read, `1..=2000`.
    pub struct BitQuantity(u16) in 1..=2000
}

bounded! {
    /// How many registers are read, `1..=125`.
    pub struct ReadQuantity(u16) in 1..=125
}

bounded! {
    /// How many coils are written, `1..=1968`.
    pub struct CoilWriteQuantity(u16) in 1..=1968
}

bounded! {
    /// How many registers are written, `1..=123`.
    pub struct RegisterWriteQuantity(u16) in 1..=123
}

/// A list of `LEAST` to `MOST` values.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Values<T, const LEAST: usize, const MOST: usize>(Vec<T>);

impl<T, const LEAST: usize, const MOST: usize> Values<T, LEAST, MOST> {
    /// These values; `None` if there are too few or too many.
    pub fn new(values: Vec<T>) -> Option<Self> {
        (LEAST..=MOST)
            .contains(&values.len())
            .then_some(Values(values))
    }

    /// The same, for values that were counted at byte `offset`.
    pub(super) fn parse(values: Vec<T>, offset: usize) -> Result<Self, Violation> {
        let found = values.len() as u64;
        Values::new(values)
            .ok_or_else(|| Violation::range(offset, found, LEAST as u64, MOST as u64))
    }
}

impl<T, const LEAST: usize, const MOST: usize> Deref for Values<T, LEAST, MOST> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<const LEAST: usize, const MOST: usize> Values<u16, LEAST, MOST> {
    /// The values, each high byte first.
    pub(super) fn to_be_bytes(&self) -> impl Iterator<Item = u8> + '_ {
        self.iter().flat_map(|value| value.to_be_bytes())
    }
}

/// Coils as Modbus packs them: eight a byte, the first in bit 0, the last byte filled up with zeros.
pub fn bits_to_bytes(bits: &[bool]) -> Vec<u8> {
    bits.chunks(8)
        .map(|chunk| {
            chunk
                .iter()
                .rev()
                .fold(0, |byte, bit| byte << 1 | u8::from(*bit))
        })
        .collect()
}

/// The first `count` bits of `bytes`.
pub(super) fn bytes_to_bits(bytes: &[u8], count: usize) -> Vec<bool> {
    bytes
        .iter()
        .flat_map(|byte| (0..8).map(move |bit| byte >> bit & 1 == 1))
        .take(count)
        .collect()
}

/// The registers in `bytes`; an odd byte at the end is left out.
pub(super) fn registers(bytes: &[u8]) -> Vec<u16> {
    bytes
        .chunks_exact(2)
        .map(|pair| u16::from_be_bytes([pair[0], pair[1]]))
        .collect()
}

/// A byte count, which must be `expected`, and the bytes it counts, which must be the last.
pub(super) fn counted<'a>(reader: &mut Reader<'a>, expected: usize) -> Result<&'a [u8], Violation> {
    let offset = reader.offset();
    let count = usize::from(reader.u8()?);
    if count != expected {
        return Err(Violation::new(
            Rule::Count,
            offset,
            count.to_string(),
            expected.to_string(),
        ));
    }
    let bytes = reader.take(count)?;
    reader.end()?;
    Ok(bytes)
}

/// A byte count and the bytes it counts, which must be the last.
pub(super) fn counted_rest<'a>(reader: &mut Reader<'a>) -> Result<&'a [u8], Violation> {
    let expected = reader.left().saturating_sub(1);
    counted(reader, expected)
}

/// A byte count, which must be even, and the registers it counts, which must be the last.
pub(super) fn counted_registers<const MOST: usize>(
    reader: &mut Reader<'_>,
) -> Result<Values<u16, 1, MOST>, Violation> {
    let offset = reader.offset();
    let bytes = counted_rest(reader)?;
    if bytes.len() % 2 == 1 {
        let expected = "an even number";
        let found = bytes.len().to_string();
        return Err(Violation::new(Rule::Count, offset, found, expected));
    }
    Values::parse(registers(bytes), offset)
}
