//! How things are written in a file where that is not how the model has them.

mod bench;
mod can;
mod case;
mod device;
mod flood;
mod modbus;
mod pdo;
mod registers;
mod sdo;
mod short;
mod stimulate;
mod transfer;
mod value;

pub(crate) use bench::*;
pub(crate) use can::*;
pub(crate) use case::*;
pub(crate) use device::*;
pub(crate) use flood::*;
pub(crate) use modbus::*;
pub(crate) use pdo::*;
pub(crate) use registers::*;
pub(crate) use sdo::*;
pub(crate) use stimulate::*;

crate::forms::schema_of!(
    crate::model::Flood: FloodFile,
    crate::model::Sync: SyncFile,
    crate::model::Expect: ExpectFile,
    crate::model::ExpectTpdo: ExpectTpdoFile,
    crate::model::SendRpdo: SendRpdoFile,
    crate::model::SdoRead: SdoReadFile,
    crate::model::SdoWrite: SdoWriteFile,
    crate::model::Modbus: ModbusFile,
    crate::model::Stimulate: StimulateFile,
);
