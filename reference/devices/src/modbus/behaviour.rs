//! How a Modbus side behaves, as settings: documented deviations, legal variants and faults. The code of the slave reads
//! them and holds no fault of its own.

use std::time::Duration;

/// In which order the two bytes of a CRC are sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CrcOrder {
    /// As Modbus has it.
    LowByteFirst,
    /// The other way round.
    HighByteFirst,
}

/// What the byte count of an answer to 03h counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ByteCount {
    /// The bytes that follow it.
    Bytes,
    /// The registers that follow it.
    Registers,
}

/// Which value the answer to 06h names.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EchoedValue {
    /// The one that was written.
    Written,
    /// The next higher one.
    OneMore,
}

/// From where the answer to a change of the own address comes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AddressChangeReply {
    /// From the new address.
    FromNew,
    /// From the address it had before.
    FromOld,
    /// Not at all; the address changes nevertheless.
    None,
}

/// Whether a register that holds a speed carries its sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SpeedSign {
    /// It does.
    #[default]
    Kept,
    /// It holds the magnitude.
    Lost,
}

/// The code that is sent for each reason to refuse.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ExceptionCodes {
    /// A function that is not supported.
    pub illegal_function: u8,
    /// A register that does not exist or does not allow the access.
    pub illegal_data_address: u8,
    /// A value that is out of range, or a request that is not built as its function has it.
    pub illegal_data_value: u8,
    /// Busy.
    pub device_busy: u8,
}

impl ExceptionCodes {
    /// As the Modbus application protocol numbers them.
    pub const STANDARD: ExceptionCodes = ExceptionCodes {
        illegal_function: 0x01,
        illegal_data_address: 0x02,
        illegal_data_value: 0x03,
        device_busy: 0x06,
    };

    /// With 02h for a value and 03h for an address.
    pub const ADDRESS_AND_VALUE_SWAPPED: ExceptionCodes = ExceptionCodes {
        illegal_data_address: 0x03,
        illegal_data_value: 0x02,
        ..ExceptionCodes::STANDARD
    };
}

/// The settings of a Modbus slave.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Behaviour {
    /// Legal variant: from the end of the silence after a request to the first bit of the answer.
    pub processing_delay: Duration,
    /// Legal variant: the delay is longer by up to this, by chance from the seed.
    pub processing_jitter: Duration,
    /// Documented deviation: which code says what.
    pub exception_codes: ExceptionCodes,
    /// Documented deviation: whether and from where a change of the own address is answered.
    pub address_change_reply: AddressChangeReply,
    /// How the CRC of an answer is sent; a request is always checked low byte first.
    pub crc_order: CrcOrder,
    /// Whether a request is answered although its CRC is wrong.
    pub stale_crc_accepted: bool,
    /// Whether the function code of an exception answer has bit 7 set.
    pub exception_bit_set: bool,
    /// Whether the answer begins before 3.5 characters of silence have passed since the request.
    pub replies_before_silence: bool,
    /// Whether a request to address 0 is answered.
    pub broadcast_answered: bool,
    /// Whether a request to another address is answered.
    pub other_addresses_answered: bool,
    /// Whether an address and a CRC, with no function between them, are answered.
    pub bare_address_answered: bool,
    /// What the byte count of an answer to 03h counts.
    pub byte_count: ByteCount,
    /// Which value the answer to 06h names.
    pub echoed_value: EchoedValue,
    /// How many of the registers of a 10h are written.
    pub most_written: usize,
    /// Whether registers that hold a speed carry its sign.
    pub speed_sign: SpeedSign,
}

impl Behaviour {
    /// Conforms; the delay is that of an unhurried device.
    pub const CONFORMING: Behaviour = Behaviour {
        processing_delay: Duration::from_millis(2),
        processing_jitter: Duration::from_micros(200),
        exception_codes: ExceptionCodes::STANDARD,
        address_change_reply: AddressChangeReply::FromNew,
        crc_order: CrcOrder::LowByteFirst,
        stale_crc_accepted: false,
        exception_bit_set: true,
        replies_before_silence: false,
        broadcast_answered: false,
        other_addresses_answered: false,
        bare_address_answered: false,
        byte_count: ByteCount::Bytes,
        echoed_value: EchoedValue::Written,
        most_written: usize::MAX,
        speed_sign: SpeedSign::Kept,
    };
}

impl Default for Behaviour {
    fn default() -> Behaviour {
        Behaviour::CONFORMING
    }
}
