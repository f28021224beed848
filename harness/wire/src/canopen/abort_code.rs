//! The SDO abort codes.

use std::fmt;

/// An SDO abort code. Any number can be one; those of CiA 301 have a name and a meaning.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct AbortCode(
    /// The code.
    pub u32,
);

macro_rules! abort_codes {
    ($($name:ident = $code:literal, $meaning:literal;)*) => {
        impl AbortCode {
            $(
                #[doc = concat!($meaning, ".")]
                pub const $name: AbortCode = AbortCode($code);
            )*

            /// The codes of CiA 301, in ascending order.
            pub const NAMED: &[AbortCode] = &[$(AbortCode::$name),*];

            /// What the code says; `None` if CiA 301 does not have it.
            pub const fn meaning(self) -> Option<&'static str> {
                match self {
                    $(AbortCode::$name => Some($meaning),)*
                    _ => None,
                }
            }
        }
    };
}

abort_codes! {
    TOGGLE_NOT_ALTERNATED = 0x0503_0000, "toggle bit did not change";
    TIMED_OUT = 0x0504_0000, "SDO transfer timed out";
    COMMAND_UNKNOWN = 0x0504_0001, "command specifier unknown or not valid";
    BLOCK_SIZE_INVALID = 0x0504_0002, "block size not valid";
    SEQUENCE_NUMBER_INVALID = 0x0504_0003, "sequence number not valid";
    CRC_ERROR = 0x0504_0004, "CRC of the block transfer wrong";
    OUT_OF_MEMORY = 0x0504_0005, "out of memory";
    ACCESS_UNSUPPORTED = 0x0601_0000, "access to the object not supported";
    READ_OF_WRITE_ONLY = 0x0601_0001, "object is write-only";
    WRITE_OF_READ_ONLY = 0x0601_0002, "object is read-only";
    OBJECT_DOES_NOT_EXIST = 0x0602_0000, "object does not exist";
    NOT_MAPPABLE = 0x0604_0041, "object cannot be mapped to the PDO";
    PDO_LENGTH_EXCEEDED = 0x0604_0042, "mapped objects do not fit into the PDO";
    PARAMETER_INCOMPATIBLE = 0x0604_0043, "parameter incompatible with another";
    INTERNAL_INCOMPATIBILITY = 0x0604_0047, "incompatibility inside the device";
    HARDWARE_ERROR = 0x0606_0000, "access failed on a hardware error";
    LENGTH_MISMATCH = 0x0607_0010, "data type or length does not match";
    LENGTH_TOO_HIGH = 0x0607_0012, "too many data bytes";
    LENGTH_TOO_LOW = 0x0607_0013, "too few data bytes";
    SUB_INDEX_DOES_NOT_EXIST = 0x0609_0011, "sub-index does not exist";
    VALUE_INVALID = 0x0609_0030, "value not valid";
    VALUE_TOO_HIGH = 0x0609_0031, "value too high";
    VALUE_TOO_LOW = 0x0609_0032, "value too low";
    MAXIMUM_BELOW_MINIMUM = 0x0609_0036, "maximum below minimum";
    NO_SDO_CONNECTION = 0x060A_0023, "no SDO connection available";
    GENERAL_ERROR = 0x0800_0000, "general error";
    NOT_TRANSFERABLE = 0x0800_0020, "data cannot be passed to the application or stored";
    LOCAL_CONTROL = 0x0800_0021, "data cannot be passed on because of local control";
    DEVICE_STATE = 0x0800_0022, "data cannot be passed on in the present device state";
    NO_OBJECT_DICTIONARY = 0x0800_0023, "no object dictionary present or its generation failed";
    NO_DATA_AVAILABLE = 0x0800_0024, "no data available";
}

impl fmt::Display for AbortCode {
    /// The code, and the meaning if it has one: `06090011h sub-index does not exist`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:08X}h", self.0)?;
        match self.meaning() {
            Some(meaning) => write!(f, " {meaning}"),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_of_the_standard_is_named_once() {
        assert_eq!(AbortCode::NAMED.len(), 31);
        assert!(AbortCode::NAMED.is_sorted_by(|one, next| one < next));
    }

    #[test]
    fn codes_print_with_their_meaning() {
        assert_eq!(
            AbortCode(0x0609_0011).to_string(),
            "06090011h sub-index does not exist"
        );
        assert_eq!(AbortCode(0x0609_0012).to_string(), "06090012h");
    }
}
