//! What the standards say of single objects.

use crate::{DataType, Dictionary};

/// The profile number in the default of 1000h.
pub(super) fn profile(dictionary: &Dictionary) -> Option<u16> {
    u16::try_from(super::number(dictionary, 0x1000, 0)? & 0xFFFF).ok()
}

/// Whether it is the mapping of a PDO.
pub(super) fn is_mapping(index: u16) -> bool {
    matches!(index, 0x1600..=0x17FF | 0x1A00..=0x1BFF)
}

/// The data type of an entry in CiA 301, or in the profile if this is CiA 402.
pub(super) fn data_type(index: u16, sub: u8, profile: Option<u16>) -> Option<DataType> {
    if index < 0x2000 {
        return communication(index, sub);
    }
    (profile == Some(402)).then(|| drives(index, sub))?
}

fn communication(index: u16, sub: u8) -> Option<DataType> {
    use DataType::{Unsigned8, Unsigned16, Unsigned32, VisibleString};
    Some(match (index, sub) {
        (0x1001 | 0x100D | 0x1019, 0) => Unsigned8,
        (0x1000 | 0x1002 | 0x1005..=0x1007 | 0x1012..=0x1014, 0) => Unsigned32,
        (0x1008..=0x100A, 0) => VisibleString,
        (0x100C | 0x1015 | 0x1017, 0) => Unsigned16,
        (0x1003 | 0x1010 | 0x1011 | 0x1016 | 0x1018, 1..=0xFE) => Unsigned32,
        (0x1029, 1..=0xFE) => Unsigned8,
        (0x1200..=0x12FF, 1 | 2) => Unsigned32,
        (0x1280..=0x12FF, 3) => Unsigned8,
        (0x1400..=0x15FF | 0x1800..=0x19FF, 1) => Unsigned32,
        (0x1400..=0x15FF | 0x1800..=0x19FF, 2) => Unsigned8,
        (0x1400..=0x15FF | 0x1800..=0x19FF, 3 | 5) => Unsigned16,
        (0x1600..=0x17FF | 0x1A00..=0x1BFF, 1..=0x40) => Unsigned32,
        _ => return None,
    })
}

fn drives(index: u16, sub: u8) -> Option<DataType> {
    use DataType::{Integer8, Integer16, Integer32, Unsigned16, Unsigned32};
    if sub != 0 {
        return None;
    }
    Some(match index {
        0x603F..=0x6041 => Unsigned16,
        0x6042..=0x6044 | 0x605A..=0x605E => Integer16,
        0x604F | 0x6050 => Unsigned32,
        0x6060 | 0x6061 | 0x6098 => Integer8,
        0x6062..=0x6064 | 0x606B | 0x606C | 0x607A | 0x607C | 0x60FF => Integer32,
        0x6071 | 0x6074 | 0x6077 => Integer16,
        0x6065 | 0x6067 | 0x607F | 0x6081 | 0x6083..=0x6085 | 0x6502 => Unsigned32,
        _ => return None,
    })
}
