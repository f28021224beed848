//! Why a request is refused.

use super::ExceptionCodes;

/// Why a request is refused. The code that says so is, for the commonest, a setting: [`ExceptionCodes`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exception {
    /// The function is not supported.
    IllegalFunction,
    /// The register does not exist or does not allow the access.
    IllegalDataAddress,
    /// The value is out of range, or the request is not built as its function has it.
    IllegalDataValue,
    /// Something broke while it was done.
    ServerDeviceFailure,
    /// It takes long; the answer is to be asked for later.
    Acknowledge,
    /// Busy.
    DeviceBusy,
    /// The memory of files is not consistent.
    MemoryParity,
    /// A gateway that has no way to the device.
    GatewayPathUnavailable,
    /// A gateway whose device is silent.
    GatewayTargetSilent,
}

impl Exception {
    /// The code that is sent.
    pub(crate) const fn code(self, codes: &ExceptionCodes) -> u8 {
        match self {
            Exception::IllegalFunction => codes.illegal_function,
            Exception::IllegalDataAddress => codes.illegal_data_address,
            Exception::IllegalDataValue => codes.illegal_data_value,
            Exception::ServerDeviceFailure => 0x04,
            Exception::Acknowledge => 0x05,
            Exception::DeviceBusy => codes.device_busy,
            Exception::MemoryParity => 0x08,
            Exception::GatewayPathUnavailable => 0x0A,
            Exception::GatewayTargetSilent => 0x0B,
        }
    }
}
