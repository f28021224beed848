//! The PDUs: a function code and its data, at most 253 bytes.

mod device_identification;
mod request;
mod response;
mod values;

pub use device_identification::{DeviceIdentification, DeviceObject, DeviceObjects, ReadDeviceId};
pub use request::Request;
pub use response::Response;
pub use values::{
    BitQuantity, CoilWriteQuantity, ReadQuantity, RegisterWriteQuantity, Values, bits_to_bytes,
};

/// The longest PDU, in bytes.
pub const MAX_PDU_LEN: usize = 253;

/// The MEI type of [`Request::ReadDeviceIdentification`], the byte after 2Bh.
const READ_DEVICE_IDENTIFICATION: u8 = 0x0E;

/// On and off as [`Request::WriteSingleCoil`] writes them.
const COIL_ON: u16 = 0xFF00;
const COIL_OFF: u16 = 0x0000;

fn coil_value(on: bool) -> u16 {
    if on { COIL_ON } else { COIL_OFF }
}

fn parse_coil_value(value: u16, offset: usize) -> Result<bool, crate::Violation> {
    match value {
        COIL_ON => Ok(true),
        COIL_OFF => Ok(false),
        _ => Err(crate::Violation::new(
            crate::Rule::Range,
            offset,
            format!("{value:04X}h"),
            "0000h or FF00h",
        )),
    }
}
