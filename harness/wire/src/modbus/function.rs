//! Function codes.

use std::fmt;

/// A function code. Any number can be one; those of the application protocol that are used here have a name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FunctionCode(
    /// The code.
    pub u8,
);

macro_rules! function_codes {
    ($($name:ident = $code:literal, $meaning:literal;)*) => {
        impl FunctionCode {
            $(
                #[doc = concat!($meaning, ".")]
                pub const $name: FunctionCode = FunctionCode($code);
            )*

            /// The name in words; `None` for a code without one.
            pub const fn name(self) -> Option<&'static str> {
                match self {
                    $(FunctionCode::$name => Some($meaning),)*
                    _ => None,
                }
            }
        }
    };
}

function_codes! {
    READ_COILS = 0x01, "read coils";
    READ_DISCRETE_INPUTS = 0x02, "read discrete inputs";
    READ_HOLDING_REGISTERS = 0x03, "read holding registers";
    READ_INPUT_REGISTERS = 0x04, "read input registers";
    WRITE_SINGLE_COIL = 0x05, "write single coil";
    WRITE_SINGLE_REGISTER = 0x06, "write single register";
    READ_EXCEPTION_STATUS = 0x07, "read exception status";
    DIAGNOSTICS = 0x08, "diagnostics";
    GET_COMM_EVENT_COUNTER = 0x0B, "get communication event counter";
    GET_COMM_EVENT_LOG = 0x0C, "get communication event log";
    WRITE_MULTIPLE_COILS = 0x0F, "write multiple coils";
    WRITE_MULTIPLE_REGISTERS = 0x10, "write multiple registers";
    REPORT_SERVER_ID = 0x11, "report server ID";
    READ_FILE_RECORD = 0x14, "read file record";
    WRITE_FILE_RECORD = 0x15, "write file record";
    MASK_WRITE_REGISTER = 0x16, "mask write register";
    READ_WRITE_MULTIPLE_REGISTERS = 0x17, "read/write multiple registers";
    READ_FIFO_QUEUE = 0x18, "read FIFO queue";
    ENCAPSULATED_INTERFACE = 0x2B, "encapsulated interface transport";
}

impl FunctionCode {
    /// The bit that makes a function code that of an exception.
    pub const EXCEPTION_BIT: u8 = 0x80;

    /// Whether a request may carry it: `1..=127`.
    pub const fn is_requestable(self) -> bool {
        matches!(self.0, 1..=127)
    }
}

impl fmt::Display for FunctionCode {
    /// `03h`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:02X}h", self.0)
    }
}
