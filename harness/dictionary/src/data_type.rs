//! The CANopen data types.

/// A data type of an object, by its index in the object dictionary (CiA 301).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum DataType {
    /// 0001h, one bit; one byte in an SDO.
    Boolean,
    /// 0002h
    Integer8,
    /// 0003h
    Integer16,
    /// 0010h
    Integer24,
    /// 0004h
    Integer32,
    /// 0012h
    Integer40,
    /// 0013h
    Integer48,
    /// 0014h
    Integer56,
    /// 0015h
    Integer64,
    /// 0005h
    Unsigned8,
    /// 0006h
    Unsigned16,
    /// 0016h
    Unsigned24,
    /// 0007h
    Unsigned32,
    /// 0018h
    Unsigned40,
    /// 0019h
    Unsigned48,
    /// 001Ah
    Unsigned56,
    /// 001Bh
    Unsigned64,
    /// 0008h, IEEE 754 single precision.
    Real32,
    /// 0011h, IEEE 754 double precision.
    Real64,
    /// 0009h
    VisibleString,
    /// 000Ah
    OctetString,
    /// 000Bh
    UnicodeString,
    /// 000Ch, 48 bits.
    TimeOfDay,
    /// 000Dh, 48 bits.
    TimeDifference,
    /// 000Fh, bytes without a length of their own.
    Domain,
    /// Any other code: complex types, types of a manufacturer or a profile.
    Unknown(u16),
}

impl DataType {
    /// The type whose code is `code`; a code that is none of the basic types is kept.
    pub const fn from_code(code: u16) -> DataType {
        match code {
            0x01 => DataType::Boolean,
            0x02 => DataType::Integer8,
            0x03 => DataType::Integer16,
            0x04 => DataType::Integer32,
            0x05 => DataType::Unsigned8,
            0x06 => DataType::Unsigned16,
            0x07 => DataType::Unsigned32,
            0x08 => DataType::Real32,
            0x09 => DataType::VisibleString,
            0x0A => DataType::OctetString,
            0x0B => DataType::UnicodeString,
            0x0C => DataType::TimeOfDay,
            0x0D => DataType::TimeDifference,
            0x0F => DataType::Domain,
            0x10 => DataType::Integer24,
            0x11 => DataType::Real64,
            0x12 => DataType::Integer40,
            0x13 => DataType::Integer48,
            0x14 => DataType::Integer56,
            0x15 => DataType::Integer64,
            0x16 => DataType::Unsigned24,
            0x18 => DataType::Unsigned40,
            0x19 => DataType::Unsigned48,
            0x1A => DataType::Unsigned56,
            0x1B => DataType::Unsigned64,
            other => DataType::Unknown(other),
        }
    }

    /// Its code in CiA 301, as an EDS writes it.
    pub const fn code(self) -> u16 {
        match self {
            DataType::Boolean => 0x01,
            DataType::Integer8 => 0x02,
            DataType::Integer16 => 0x03,
            DataType::Integer32 => 0x04,
            DataType::Unsigned8 => 0x05,
            DataType::Unsigned16 => 0x06,
            DataType::Unsigned32 => 0x07,
            DataType::Real32 => 0x08,
            DataType::VisibleString => 0x09,
            DataType::OctetString => 0x0A,
            DataType::UnicodeString => 0x0B,
            DataType::TimeOfDay => 0x0C,
            DataType::TimeDifference => 0x0D,
            DataType::Domain => 0x0F,
            DataType::Integer24 => 0x10,
            DataType::Real64 => 0x11,
            DataType::Integer40 => 0x12,
            DataType::Integer48 => 0x13,
            DataType::Integer56 => 0x14,
            DataType::Integer64 => 0x15,
            DataType::Unsigned24 => 0x16,
            DataType::Unsigned40 => 0x18,
            DataType::Unsigned48 => 0x19,
            DataType::Unsigned56 => 0x1A,
            DataType::Unsigned64 => 0x1B,
            DataType::Unknown(code) => code,
        }
    }

    /// The size in bits as a PDO mapping counts it; `None` where the type has no fixed size.
    pub const fn bits(self) -> Option<u32> {
        Some(match self {
            DataType::Boolean => 1,
            DataType::Integer8 | DataType::Unsigned8 => 8,
            DataType::Integer16 | DataType::Unsigned16 => 16,
            DataType::Integer24 | DataType::Unsigned24 => 24,
            DataType::Integer32 | DataType::Unsigned32 | DataType::Real32 => 32,
            DataType::Integer40 | DataType::Unsigned40 => 40,
            DataType::Integer48
            | DataType::Unsigned48
            | DataType::TimeOfDay
            | DataType::TimeDifference => 48,
            DataType::Integer56 | DataType::Unsigned56 => 56,
            DataType::Integer64 | DataType::Unsigned64 | DataType::Real64 => 64,
            DataType::VisibleString
            | DataType::OctetString
            | DataType::UnicodeString
            | DataType::Domain
            | DataType::Unknown(_) => return None,
        })
    }

    /// The size in bytes as an SDO carries it; `None` where the type has no fixed size.
    pub const fn bytes(self) -> Option<usize> {
        match self.bits() {
            Some(bits) => Some(bits.div_ceil(8) as usize),
            None => None,
        }
    }

    /// Whether it is an INTEGERn, in two's complement.
    pub const fn is_signed(self) -> bool {
        matches!(
            self,
            DataType::Integer8
                | DataType::Integer16
                | DataType::Integer24
                | DataType::Integer32
                | DataType::Integer40
                | DataType::Integer48
                | DataType::Integer56
                | DataType::Integer64
        )
    }

    /// Whether it is a REALn.
    pub const fn is_real(self) -> bool {
        matches!(self, DataType::Real32 | DataType::Real64)
    }

    /// Whether its values are text or bytes without a fixed length.
    pub const fn is_text(self) -> bool {
        matches!(
            self,
            DataType::VisibleString
                | DataType::OctetString
                | DataType::UnicodeString
                | DataType::Domain
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_go_both_ways() {
        for code in 0..=0x40 {
            assert_eq!(DataType::from_code(code).code(), code);
        }
    }
}
