//! How a Modbus side behaves, as settings: documented deviations, legal variants and faults. The code of the slave reads
//! them and holds no fault of its own.

use std::time::Duration;

use super::{Departure, RegisterFault, RegisterFaultKind, TcpFault};

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

/// What a slave keeps of a frame that was none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Remains {
    /// The bytes of one that was too short: they stand before the next.
    OfRunts,
    /// What came before a long silence: the rest is put to it.
    OfTornFrames,
    /// The first bytes of one that was too long, as if it had ended there.
    OfLongFrames,
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
    /// Whether only the first byte of a CRC is looked at.
    pub crc_half_checked: bool,
    /// Whether characters with a wrong parity bit are taken.
    pub parity_ignored: bool,
    /// What is kept of a frame that was none.
    pub frame_remains: Option<Remains>,
    /// Whether nothing is done for a broadcast.
    pub broadcast_ignored: bool,
    /// Whether a function that there is not is met with silence.
    pub unknown_function_silent: bool,
    /// Whether an exception is one byte longer than it is.
    pub exception_with_function_data: bool,
    /// Whether none of something may be asked for.
    pub zero_quantity_allowed: bool,
    /// Whether more than the limit of the function may be asked for.
    pub excess_quantity_allowed: bool,
    /// Whether the addresses are looked at before their number.
    pub address_before_quantity: bool,
    /// Whether address 65535 is followed by address 0.
    pub addresses_wrap: bool,
    /// Whether what there is not reads as 0.
    pub holes_answered: bool,
    /// Whether the byte count of a request may be anything.
    pub byte_count_unchecked: bool,
    /// Whether values outside their limits are taken.
    pub limits_ignored: bool,
    /// Whether a write of a read-only register is confirmed, and not done.
    pub read_only_confirmed: bool,
    /// Whether a write of several stops where it is refused, and has done what was before.
    pub writes_until_refused: bool,
    /// Whether inputs are read from the tables that can be written.
    pub tables_mixed: bool,
    /// Whether the first of eight bits is the highest of its byte.
    pub bit_order_reversed: bool,
    /// Whether the bits after the last are ones.
    pub padding_bits_set: bool,
    /// Whether a coil takes other values than FF00h and 0000h.
    pub coil_value_unchecked: bool,
    /// Whether the OR mask of 16h sets bits that the AND mask keeps.
    pub masks_simply_joined: bool,
    /// Whether 17h reads before it writes.
    pub reads_before_writes: bool,
    /// Whether the loopback of 08h is answered with its first two bytes.
    pub loopback_cut: bool,
    /// Whether spoilt messages are not counted.
    pub communication_errors_uncounted: bool,
    /// Whether counters stay when they are cleared.
    pub counters_not_cleared: bool,
    /// Whether fetching the event counter counts.
    pub fetches_count_as_events: bool,
    /// Whether a slave that only listens does and answers.
    pub listen_only_answered: bool,
    /// Whether a restart does not end listening.
    pub restart_keeps_listening: bool,
    /// Whether it says of itself that it does not run.
    pub run_indicator_off: bool,
    /// Whether the byte count of 18h leaves its own count out.
    pub fifo_count_missing_in_bytes: bool,
    /// Whether every category of the identification has all objects.
    pub categories_ignored: bool,
    /// Whether an object of the identification that there is not is answered.
    pub unknown_object_answered: bool,
    /// Whether it is not said that more objects follow.
    pub more_follows_missing: bool,
    /// Legal variant: whether a header of Modbus TCP that is none ends the connection.
    pub bad_header_closes: bool,
    /// Legal variant: whether several requests of one packet are done from the last to the first.
    pub last_request_first: bool,
    /// The register that is not as its map says.
    pub register_fault: Option<RegisterFault>,
    /// What else it does wrong.
    pub departure: Option<Departure>,
    /// How the TCP side departs from its specification.
    pub tcp_fault: Option<TcpFault>,
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
        crc_half_checked: false,
        parity_ignored: false,
        frame_remains: None,
        broadcast_ignored: false,
        unknown_function_silent: false,
        exception_with_function_data: false,
        zero_quantity_allowed: false,
        excess_quantity_allowed: false,
        address_before_quantity: false,
        addresses_wrap: false,
        holes_answered: false,
        byte_count_unchecked: false,
        limits_ignored: false,
        read_only_confirmed: false,
        writes_until_refused: false,
        tables_mixed: false,
        bit_order_reversed: false,
        padding_bits_set: false,
        coil_value_unchecked: false,
        masks_simply_joined: false,
        reads_before_writes: false,
        loopback_cut: false,
        communication_errors_uncounted: false,
        counters_not_cleared: false,
        fetches_count_as_events: false,
        listen_only_answered: false,
        restart_keeps_listening: false,
        run_indicator_off: false,
        fifo_count_missing_in_bytes: false,
        categories_ignored: false,
        unknown_object_answered: false,
        more_follows_missing: false,
        bad_header_closes: false,
        last_request_first: false,
        register_fault: None,
        departure: None,
        tcp_fault: None,
    };

    /// Whether a register is not as its map says, in this way.
    pub(super) fn spoils(&self, kind: RegisterFaultKind, address: u16) -> bool {
        self.register_fault
            .is_some_and(|fault| fault.is(kind, address))
    }

    /// Whether it departs so.
    pub(crate) fn departs(&self, departure: Departure) -> bool {
        self.departure == Some(departure)
    }
}

impl Default for Behaviour {
    fn default() -> Behaviour {
        Behaviour::CONFORMING
    }
}
