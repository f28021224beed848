//! SDO abort codes.

/// An SDO abort code (CiA 301).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Abort(pub(crate) u32);

impl Abort {
    /// Toggle bit not alternated.
    pub(crate) const TOGGLE: Abort = Abort(0x0503_0000);
    /// SDO protocol timed out.
    pub(crate) const TIMED_OUT: Abort = Abort(0x0504_0000);
    /// Command specifier not valid or unknown.
    pub(crate) const UNKNOWN_COMMAND: Abort = Abort(0x0504_0001);
    /// Invalid block size.
    pub(crate) const BLOCK_SIZE: Abort = Abort(0x0504_0002);
    /// Invalid sequence number.
    pub(crate) const SEQUENCE_NUMBER: Abort = Abort(0x0504_0003);
    /// CRC error.
    pub(crate) const CRC: Abort = Abort(0x0504_0004);
    /// Out of memory.
    pub(crate) const OUT_OF_MEMORY: Abort = Abort(0x0504_0005);
    /// Attempt to read a write-only object.
    pub(crate) const WRITE_ONLY: Abort = Abort(0x0601_0001);
    /// Attempt to write a read-only object.
    pub(crate) const READ_ONLY: Abort = Abort(0x0601_0002);
    /// The object does not exist.
    pub(crate) const NO_OBJECT: Abort = Abort(0x0602_0000);
    /// The object cannot be mapped to the PDO.
    pub(crate) const NOT_MAPPABLE: Abort = Abort(0x0604_0041);
    /// The objects to be mapped would exceed the length of a PDO.
    pub(crate) const MAPPING_TOO_LONG: Abort = Abort(0x0604_0042);
    /// Parameters that do not go together.
    pub(crate) const INCOMPATIBLE: Abort = Abort(0x0604_0043);
    /// General internal incompatibility in the device.
    pub(crate) const INTERNAL: Abort = Abort(0x0604_0047);
    /// Access failed due to a hardware error.
    pub(crate) const HARDWARE: Abort = Abort(0x0606_0000);
    /// The length of the service parameter does not match.
    pub(crate) const LENGTH: Abort = Abort(0x0607_0010);
    /// The length of the service parameter is too high.
    pub(crate) const TOO_LONG: Abort = Abort(0x0607_0012);
    /// The length of the service parameter is too low.
    pub(crate) const TOO_SHORT: Abort = Abort(0x0607_0013);
    /// The sub-index does not exist.
    pub(crate) const NO_SUB_INDEX: Abort = Abort(0x0609_0011);
    /// Invalid value for the parameter.
    pub(crate) const INVALID_VALUE: Abort = Abort(0x0609_0030);
    /// The value of the parameter is too high.
    pub(crate) const TOO_HIGH: Abort = Abort(0x0609_0031);
    /// The value of the parameter is too low.
    pub(crate) const TOO_LOW: Abort = Abort(0x0609_0032);
    /// The maximum is less than the minimum.
    pub(crate) const MAXIMUM_BELOW_MINIMUM: Abort = Abort(0x0609_0036);
    /// No resource: SDO connection.
    pub(crate) const NO_CONNECTION: Abort = Abort(0x060A_0023);
    /// General error.
    pub(crate) const GENERAL: Abort = Abort(0x0800_0000);
    /// Data cannot be transferred or stored.
    pub(crate) const CANNOT_STORE: Abort = Abort(0x0800_0020);
    /// Data cannot be transferred or stored because of local control.
    pub(crate) const LOCAL_CONTROL: Abort = Abort(0x0800_0021);
    /// Data cannot be transferred or stored in the present device state.
    pub(crate) const DEVICE_STATE: Abort = Abort(0x0800_0022);
    /// There is no object dictionary, or it cannot be generated.
    pub(crate) const NO_DICTIONARY: Abort = Abort(0x0800_0023);
    /// No data available.
    pub(crate) const NO_DATA: Abort = Abort(0x0800_0024);
}
