//! Exception codes.

use std::fmt;

/// Why a server refuses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ExceptionCode {
    /// 01h
    IllegalFunction,
    /// 02h
    IllegalDataAddress,
    /// 03h
    IllegalDataValue,
    /// 04h
    ServerDeviceFailure,
    /// 05h
    Acknowledge,
    /// 06h
    ServerDeviceBusy,
    /// 08h
    MemoryParityError,
    /// 0Ah
    GatewayPathUnavailable,
    /// 0Bh
    GatewayTargetDeviceFailedToRespond,
    /// Any other.
    Unknown(u8),
}

impl ExceptionCode {
    /// The code.
    pub const fn code(self) -> u8 {
        match self {
            ExceptionCode::IllegalFunction => 0x01,
            ExceptionCode::IllegalDataAddress => 0x02,
            ExceptionCode::IllegalDataValue => 0x03,
            ExceptionCode::ServerDeviceFailure => 0x04,
            ExceptionCode::Acknowledge => 0x05,
            ExceptionCode::ServerDeviceBusy => 0x06,
            ExceptionCode::MemoryParityError => 0x08,
            ExceptionCode::GatewayPathUnavailable => 0x0A,
            ExceptionCode::GatewayTargetDeviceFailedToRespond => 0x0B,
            ExceptionCode::Unknown(code) => code,
        }
    }

    /// The exception with this code.
    pub const fn from_code(code: u8) -> ExceptionCode {
        match code {
            0x01 => ExceptionCode::IllegalFunction,
            0x02 => ExceptionCode::IllegalDataAddress,
            0x03 => ExceptionCode::IllegalDataValue,
            0x04 => ExceptionCode::ServerDeviceFailure,
            0x05 => ExceptionCode::Acknowledge,
            0x06 => ExceptionCode::ServerDeviceBusy,
            0x08 => ExceptionCode::MemoryParityError,
            0x0A => ExceptionCode::GatewayPathUnavailable,
            0x0B => ExceptionCode::GatewayTargetDeviceFailedToRespond,
            code => ExceptionCode::Unknown(code),
        }
    }

    /// The name in words; `None` for an unknown code.
    pub const fn name(self) -> Option<&'static str> {
        match self {
            ExceptionCode::IllegalFunction => Some("illegal function"),
            ExceptionCode::IllegalDataAddress => Some("illegal data address"),
            ExceptionCode::IllegalDataValue => Some("illegal data value"),
            ExceptionCode::ServerDeviceFailure => Some("server device failure"),
            ExceptionCode::Acknowledge => Some("acknowledge"),
            ExceptionCode::ServerDeviceBusy => Some("server device busy"),
            ExceptionCode::MemoryParityError => Some("memory parity error"),
            ExceptionCode::GatewayPathUnavailable => Some("gateway path unavailable"),
            ExceptionCode::GatewayTargetDeviceFailedToRespond => {
                Some("gateway target device failed to respond")
            }
            ExceptionCode::Unknown(_) => None,
        }
    }
}

impl fmt::Display for ExceptionCode {
    /// `02 illegal data address`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:02X}", self.code())?;
        match self.name() {
            Some(name) => write!(f, " {name}"),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_is_kept() {
        for code in 0..=255 {
            assert_eq!(ExceptionCode::from_code(code).code(), code);
        }
        assert_eq!(
            ExceptionCode::from_code(2).to_string(),
            "02 illegal data address"
        );
        assert_eq!(ExceptionCode::from_code(0x7C).to_string(), "7C");
    }
}
