//! What survives power-off.

use std::collections::BTreeMap;

use super::Address;

/// Non-volatile memory.
#[derive(Debug, Clone, Default)]
pub(crate) struct Memory {
    pub(crate) values: BTreeMap<Address, Vec<u8>>,
    /// The node-ID, `1..=127`, or 255 for none.
    pub(crate) node: u8,
    /// Bits a second.
    pub(crate) bit_rate: u32,
}

/// The part of the dictionary that a sub-index of 1010h and 1011h stands for.
pub(crate) fn group(sub: u8) -> std::ops::RangeInclusive<u16> {
    match sub {
        2 => 0x1000..=0x1FFF,
        3 => 0x6000..=0x9FFF,
        4.. => 0x2000..=0x5FFF,
        _ => 0x1000..=0x9FFF,
    }
}
