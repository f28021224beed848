//! The faults that a Modbus side can be given, each one departure from one clause.

use super::function_faults::{FUNCTIONS, PARITY, REFUSALS};
pub(crate) use super::function_faults::{LINE, WRITES};
use super::tcp_faults::TCP;
use super::{AddressChangeReply, ByteCount, CrcOrder, Departure, EchoedValue, SpeedSign};
use crate::Fault;

/// The CRC of an answer, its bytes in the wrong order.
pub const CRC_BYTES_SWAPPED: Fault = Fault {
    name: "crc-bytes-swapped",
    breaks: "MODBUS over serial line V1.02, 2.5.1.2: the CRC is sent low byte first",
    words: "sends the CRC of its answers high byte first",
    caught_by: "modbus",
    apply: |behaviour| behaviour.modbus.crc_order = CrcOrder::HighByteFirst,
};

/// A request with a wrong CRC does not get silence.
pub const STALE_CRC_ACCEPTED: Fault = Fault {
    name: "stale-crc-accepted",
    breaks: "MODBUS over serial line V1.02, 2.5.1.2: a frame with a wrong CRC is discarded",
    words: "does what a request asks, and answers it, though its CRC is wrong",
    caught_by: "modbus",
    apply: |behaviour| behaviour.modbus.stale_crc_accepted = true,
};

/// An exception that looks like a success.
pub const EXCEPTION_WITHOUT_80H: Fault = Fault {
    name: "exception-without-80h",
    breaks: "MODBUS application protocol V1.1b3, 7: an exception answer sets bit 7 of the function code",
    words: "answers an exception with the plain function code",
    caught_by: "modbus",
    apply: |behaviour| behaviour.modbus.exception_bit_set = false,
};

/// One exception code for another.
pub const EXCEPTION_03_FOR_02: Fault = Fault {
    name: "exception-03-for-02",
    breaks: "MODBUS application protocol V1.1b3, 7: the exception code says why",
    words: "answers exception 03 where 02 is due",
    caught_by: "modbus",
    apply: |behaviour| {
        let codes = &mut behaviour.modbus.exception_codes;
        for code in [
            &mut codes.illegal_function,
            &mut codes.illegal_data_address,
            &mut codes.illegal_data_value,
            &mut codes.device_busy,
        ] {
            if *code == 0x02 {
                *code = 0x03;
            }
        }
    },
};

/// An answer into the silence that ends the request.
pub const REPLY_TOO_EARLY: Fault = Fault {
    name: "reply-too-early",
    breaks: "MODBUS over serial line V1.02, 2.5.1.1: frames are separated by at least 3.5 characters of silence",
    words: "begins its answer about 2.5 characters after the request",
    caught_by: "modbus",
    apply: |behaviour| behaviour.modbus.replies_before_silence = true,
};

/// An answer to everybody's request.
pub const BROADCAST_ANSWERED: Fault = Fault {
    name: "broadcast-answered",
    breaks: "MODBUS over serial line V1.02, 2.1: a broadcast is not answered",
    words: "answers a request to address 0",
    caught_by: "modbus",
    apply: |behaviour| behaviour.modbus.broadcast_answered = true,
};

/// An answer to a request that is meant for another.
pub const OTHER_ADDRESS_ANSWERED: Fault = Fault {
    name: "other-address-answered",
    breaks: "MODBUS over serial line V1.02, 2.2: only the slave that is addressed answers",
    words: "does and answers, from its own address, what another slave is asked",
    caught_by: "modbus",
    apply: |behaviour| behaviour.modbus.other_addresses_answered = true,
};

/// An answer to something that is no request.
pub const BARE_ADDRESS_ANSWERED: Fault = Fault {
    name: "bare-address-answered",
    breaks: "MODBUS over serial line V1.02, 2.5.1: a frame has an address, a function code, data and a CRC",
    words: "answers a frame that has an address and a CRC, but no function code",
    caught_by: "modbus",
    apply: |behaviour| behaviour.modbus.bare_address_answered = true,
};

/// A length that is not one.
pub const WRONG_BYTE_COUNT: Fault = Fault {
    name: "wrong-byte-count",
    breaks: "MODBUS application protocol V1.1b3, 6.3: the byte count is twice the number of registers",
    words: "counts registers, not bytes, in the answer to 03h",
    caught_by: "modbus",
    apply: |behaviour| behaviour.modbus.byte_count = ByteCount::Registers,
};

/// An echo that is not one.
pub const WRITE_ECHO_WRONG_VALUE: Fault = Fault {
    name: "write-echo-wrong-value",
    breaks: "MODBUS application protocol V1.1b3, 6.6: the answer to 06h is the request",
    words: "writes the value, but names the next higher one in its answer",
    caught_by: "modbus",
    apply: |behaviour| behaviour.modbus.echoed_value = EchoedValue::OneMore,
};

/// Huacheng drive only, for the encoder has no two registers side by side that are read as they were written: a write
/// of several registers that is one of the first.
pub const WRITE_MULTIPLE_FORGETS: Fault = Fault {
    name: "write-multiple-forgets",
    breaks: "MODBUS application protocol V1.1b3, 6.12: 10h writes a block of contiguous registers",
    words: "writes the first of several registers and confirms them all",
    caught_by: "modbus",
    apply: |behaviour| behaviour.modbus.most_written = 1,
};

/// Encoder only: silence after a change of address.
pub const ADDRESS_CHANGE_NOT_ANSWERED: Fault = Fault {
    name: "address-change-not-answered",
    breaks: "Liaomiao encoder manual, Modbus-RTU operation 3: the change is answered",
    words: "takes the new address and stays silent",
    caught_by: "modbus",
    apply: |behaviour| behaviour.modbus.address_change_reply = AddressChangeReply::None,
};

/// Encoder only: the answer to a change of address comes from the wrong one.
pub const ADDRESS_CHANGE_ANSWERED_FROM_OLD: Fault = Fault {
    name: "address-change-answered-from-old",
    breaks: "Liaomiao encoder manual, Modbus-RTU operation 3: the answer comes from the new address",
    words: "takes the new address, but answers from the one it had",
    caught_by: "modbus",
    apply: |behaviour| behaviour.modbus.address_change_reply = AddressChangeReply::FromOld,
};

/// Encoder only: any five bytes will do.
pub const ADDRESS_TEXT_IGNORED: Fault = Fault {
    name: "address-text-ignored",
    breaks: "Liaomiao encoder manual, Modbus-RTU operation 3: the text `addr:` stands before the new address",
    words: "takes a new address whatever text stands before it",
    caught_by: "modbus",
    apply: |behaviour| behaviour.modbus.departure = Some(Departure::AddressTextIgnored),
};

/// Encoder only: a turn one way looks like a turn the other way.
pub const SPEED_SIGN_LOST: Fault = Fault {
    name: "speed-sign-lost",
    breaks: "Liaomiao encoder manual, Modbus-RTU operations 6, 15 and 16: the speed is signed",
    words: "shows the magnitude of the speed in registers 0004h, 000Ch and 000Dh",
    caught_by: "modbus",
    apply: |behaviour| behaviour.modbus.speed_sign = SpeedSign::Lost,
};

/// Every fault of every Modbus side. A device lists those that show on it.
pub const FAULTS: &[Fault] = &[
    CRC_BYTES_SWAPPED,
    STALE_CRC_ACCEPTED,
    EXCEPTION_WITHOUT_80H,
    EXCEPTION_03_FOR_02,
    REPLY_TOO_EARLY,
    BROADCAST_ANSWERED,
    OTHER_ADDRESS_ANSWERED,
    BARE_ADDRESS_ANSWERED,
    WRONG_BYTE_COUNT,
    WRITE_ECHO_WRONG_VALUE,
    WRITE_MULTIPLE_FORGETS,
    ADDRESS_CHANGE_NOT_ANSWERED,
    ADDRESS_CHANGE_ANSWERED_FROM_OLD,
    ADDRESS_TEXT_IGNORED,
    SPEED_SIGN_LOST,
];

/// What a slave can have that has every function.
pub(crate) const COMPLETE: &[&[Fault]] = &[
    COMMON,
    &[WRITE_MULTIPLE_FORGETS],
    LINE,
    WRITES,
    PARITY,
    REFUSALS,
    FUNCTIONS,
    TCP,
];

/// What every Modbus slave here can have.
pub(crate) const COMMON: &[Fault] = &[
    CRC_BYTES_SWAPPED,
    STALE_CRC_ACCEPTED,
    EXCEPTION_WITHOUT_80H,
    EXCEPTION_03_FOR_02,
    REPLY_TOO_EARLY,
    BROADCAST_ANSWERED,
    OTHER_ADDRESS_ANSWERED,
    BARE_ADDRESS_ANSWERED,
    WRONG_BYTE_COUNT,
    WRITE_ECHO_WRONG_VALUE,
];
