//! Faults of framing, of refusals and of single functions, each one departure from one clause.

use std::time::Duration;

use super::{Departure, Remains};
use crate::Fault;

/// A fault of a Modbus side that one setting switches.
macro_rules! faults {
    ($(#[doc = $list_words:literal] $list:ident: $($name:literal, $breaks:literal, $words:literal, $field:ident = $value:expr;)+)+) => {
        $(#[doc = $list_words]
        pub(crate) const $list: &[Fault] = &[$(Fault {
            name: $name,
            breaks: $breaks,
            words: $words,
            caught_by: "modbus",
            apply: |behaviour| behaviour.modbus.$field = $value,
        }),+];)+
    };
}

faults! {
    #[doc = "What any slave on a serial line can have."] LINE:
    "crc-half-checked", "MODBUS over serial line V1.02, 2.5.1.2: a frame with a wrong CRC is discarded",
        "answers a request if the first byte of its CRC is right", crc_half_checked = true;
    "runts-kept", "MODBUS over serial line V1.02, 2.5.1.1: a frame begins after a silence",
        "keeps bytes that were too few for a frame, and puts them before the next one", frame_remains = Some(Remains::OfRunts);
    "long-frames-cut", "MODBUS over serial line V1.02, 2.5.1: a frame has at most 256 bytes",
        "takes the first 256 bytes of a longer frame for a frame", frame_remains = Some(Remains::OfLongFrames);
    "deaf-after-long-frame", "MODBUS over serial line V1.02, 2.5.1: a frame that is none is discarded, and nothing more",
        "does not hear the request after a frame that was too long", departure = Some(Departure::DeafAfterLongFrame);
    "deaf-after-bad-frame", "MODBUS over serial line V1.02, 2.5.1: a frame that is none is discarded, and nothing more",
        "does not hear the request after a frame that was none", departure = Some(Departure::DeafAfterBadFrame);
    "rests-after-answer", "MODBUS over serial line V1.02, 2.5.1.1: frames are separated by 3.5 characters of silence, and no more is asked for",
        "does not hear requests that come within 10 ms of its answer", departure = Some(Departure::RestsAfterAnswer);
    "idle-line-ends-frame", "MODBUS over serial line V1.02, 2.5.1.1: up to 1.5 characters of silence may be inside a frame",
        "takes a silence of one character for the end of a frame", departure = Some(Departure::IdleLineEndsFrame);
    "patient-line", "MODBUS over serial line V1.02, 2.5.1.1: 3.5 characters of silence end a frame",
        "goes on with a frame for 20 ms after it has stopped", departure = Some(Departure::PatientLine);
    "high-bit-ignored", "MODBUS application protocol V1.1b3, 4.1: function codes are 1 to 127",
        "does what the function without its highest bit asks", departure = Some(Departure::HighBitIgnored);
    "request-echoed", "MODBUS over serial line V1.02, 2.1: a slave sends nothing but its answer",
        "sends the request back before its answer", departure = Some(Departure::EchoesRequest);
    "answers-late", "the answer comes in the time that the device promises, or in a second",
        "answers after 1.2 s", processing_delay = Duration::from_millis(1_200);
    "single-not-written", "MODBUS application protocol V1.1b3, 6.6: 06h writes a register",
        "confirms 06h and does not do it", departure = Some(Departure::SingleNotWritten);

    #[doc = "What a slave on a serial line can have of which registers can be written without more ado."] WRITES:
    "short-pdu-filled", "MODBUS application protocol V1.1b3, 7: a request that is not built as its function has it is answered with exception 03",
        "takes bytes that a request lacks for 0", departure = Some(Departure::ShortPduFilled);
    "broadcast-ignored", "MODBUS over serial line V1.02, 2.1: all slaves must accept the broadcast for writing functions",
        "does nothing for a request to address 0", broadcast_ignored = true;

    #[doc = "What a slave on a line with parity can have."] PARITY:
    "parity-ignored", "MODBUS over serial line V1.02, 2.5.1: a character with a wrong parity bit spoils the frame",
        "answers a request with a character whose parity bit is wrong", parity_ignored = true;

    #[doc = "What any slave can have that refuses things."] REFUSALS:
    "unknown-function-silent", "MODBUS application protocol V1.1b3, 7: a function that is not supported is answered with exception 01",
        "does not answer functions that it does not have", unknown_function_silent = true;
    "exception-too-long", "MODBUS application protocol V1.1b3, 7: an exception answer is a function code and an exception code",
        "sends a byte more after an exception code", exception_with_function_data = true;
    "zero-quantity-answered", "MODBUS application protocol V1.1b3, 6: a quantity of 0 is answered with exception 03",
        "answers a request for nothing with nothing", zero_quantity_allowed = true;
    "excess-quantity-answered", "MODBUS application protocol V1.1b3, 6: a quantity above the limit is answered with exception 03",
        "answers requests for more than fits", excess_quantity_allowed = true;
    "address-before-quantity", "MODBUS application protocol V1.1b3, 6: the quantity is checked before the address",
        "answers exception 02 where the quantity is wrong, too", address_before_quantity = true;
    "addresses-wrap", "MODBUS application protocol V1.1b3, 6: address and quantity must not reach beyond 65536",
        "goes on at address 0 after address 65535", addresses_wrap = true;
    "holes-answered", "MODBUS application protocol V1.1b3, 7: an address that does not exist is answered with exception 02",
        "answers 0 for what it does not have", holes_answered = true;
    "byte-count-unchecked", "MODBUS application protocol V1.1b3, 6: a byte count that does not fit the quantity is answered with exception 03",
        "takes a byte count that does not fit the quantity", byte_count_unchecked = true;
    "limits-ignored", "MODBUS application protocol V1.1b3, 7: a value that is not allowed is answered with exception 03",
        "takes values outside their limits", limits_ignored = true;
    "read-only-confirmed", "MODBUS application protocol V1.1b3, 7: what cannot be written is answered with an exception",
        "confirms writing a read-only register and does not do it", read_only_confirmed = true;
    "writes-until-refused", "MODBUS application protocol V1.1b3, 6.12: a request that is refused changes nothing",
        "has written the registers before the one that it refuses", writes_until_refused = true;

    #[doc = "What a slave can have that has every function."] FUNCTIONS:
    "counter-0B-stays", "MODBUS application protocol V1.1b3, 6.8.1: sub-function 0Bh counts the messages on the line",
        "says 0 messages on the line whatever was there", departure = Some(Departure::CounterStays(0x0B));
    "counter-0D-stays", "MODBUS application protocol V1.1b3, 6.8.1: sub-function 0Dh counts exceptions",
        "does not count exceptions", departure = Some(Departure::CounterStays(0x0D));
    "counter-0E-stays", "MODBUS application protocol V1.1b3, 6.8.1: sub-function 0Eh counts the messages for the device",
        "does not count what was for it", departure = Some(Departure::CounterStays(0x0E));
    "counter-0F-stays", "MODBUS application protocol V1.1b3, 6.8.1: sub-function 0Fh counts messages without an answer",
        "does not count what it did not answer", departure = Some(Departure::CounterStays(0x0F));
    "counter-11-stays", "MODBUS application protocol V1.1b3, 6.8.1: sub-function 11h counts exceptions 06",
        "does not count the times it was busy", departure = Some(Departure::CounterStays(0x11));
    "refusals-count-as-events", "MODBUS application protocol V1.1b3, 6.9: an exception is no event",
        "counts what it refused as an event", departure = Some(Departure::RefusalsCountAsEvents);
    "log-empty", "MODBUS application protocol V1.1b3, 6.10: the log has the last events",
        "answers 0Ch without events", departure = Some(Departure::LogEmpty);
    "exception-status-long", "MODBUS application protocol V1.1b3, 6.7: the exception status is one byte",
        "answers 07h with two bytes", departure = Some(Departure::ExceptionStatusLong);
    "addresses-from-1", "MODBUS application protocol V1.1b3, 4.4: the first address in a PDU is 0",
        "reads and writes rows one address too far", departure = Some(Departure::AddressesFromOne);
    "coil-not-written", "MODBUS application protocol V1.1b3, 6.5: 05h switches a coil",
        "confirms 05h and does not do it", departure = Some(Departure::CoilNotWritten);
    "multiple-echoes-bytes", "MODBUS application protocol V1.1b3, 6.12: the answer to 10h has the number of registers",
        "names the number of bytes in the answers to 0Fh and 10h", departure = Some(Departure::MultipleEchoesBytes);
    "large-requests-refused", "MODBUS application protocol V1.1b3, 6.3: up to 125 registers are read at once",
        "refuses more than 64 registers, and more than 512 bits", departure = Some(Departure::LargeRequestsRefused);
    "last-address-refused", "MODBUS application protocol V1.1b3, 4.4: addresses are 0 to 65535",
        "refuses what reaches to address 65535", departure = Some(Departure::LastAddressRefused);
    "records-not-written", "MODBUS application protocol V1.1b3, 6.15: 15h writes records",
        "confirms 15h and does not do it", departure = Some(Departure::RecordsNotWritten);
    "first-row-only", "MODBUS application protocol V1.1b3, 6.14: 14h reads several rows of records",
        "answers only the first of several rows of records", departure = Some(Departure::FirstRowOnly);
    "conditions-ignored", "MODBUS application protocol V1.1b3, 7: exceptions 04 to 08 say what keeps a device from doing what is asked",
        "answers as if nothing were wrong with it", departure = Some(Departure::ConditionsIgnored);
    "conditions-for-all", "MODBUS application protocol V1.1b3, 7: an exception says why this request cannot be done",
        "refuses everything while only some of it cannot be done", departure = Some(Departure::ConditionsForAll);
    "memory-lost", "the register map: what survives power-off",
        "loses at power-off the registers that should survive it", departure = Some(Departure::MemoryLost);
    "nothing-lost", "the register map: what does not survive power-off",
        "has after power-off what it had before", departure = Some(Departure::NothingLost);
    "reads-though-refused", "MODBUS application protocol V1.1b3, 6.17: 17h is refused if its write is",
        "answers 17h with what it reads though it could not write", departure = Some(Departure::ReadsThoughRefused);
    "mask-lost", "MODBUS application protocol V1.1b3, 6.16: 16h changes the bits that the AND mask clears",
        "confirms 16h and does it only if the AND mask is 0", departure = Some(Departure::MaskLost);
    "next-object-wrong", "MODBUS application protocol V1.1b3, 6.21: the next object is the first of what is left",
        "names the object after the next one", departure = Some(Departure::NextObjectWrong);
    "more-follows-missing", "MODBUS application protocol V1.1b3, 6.21: more follows if not all objects fit one answer",
        "does not say that more objects follow", more_follows_missing = true;
    "long-loopback-refused", "MODBUS application protocol V1.1b3, 6.8.1: sub-function 00h takes data of any length",
        "refuses a loopback of more than two bytes", departure = Some(Departure::LongLoopbackRefused);
    "unknown-sub-function-echoed", "MODBUS application protocol V1.1b3, 7: a sub-function that is not supported is answered with exception 01",
        "sends back requests for sub-functions of 08h that it does not have", departure = Some(Departure::UnknownSubFunctionEchoed);
    "tables-mixed", "MODBUS application protocol V1.1b3, 4.3: inputs are read by functions of their own",
        "answers 02h and 04h from the coils and the holding registers", tables_mixed = true;
    "bit-order-reversed", "MODBUS application protocol V1.1b3, 6.1: the first bit is the lowest of its byte",
        "puts the first of eight bits into the highest of their byte", bit_order_reversed = true;
    "padding-bits-set", "MODBUS application protocol V1.1b3, 6.1: the bits after the last are 0",
        "fills the last byte of bits up with ones", padding_bits_set = true;
    "coil-value-unchecked", "MODBUS application protocol V1.1b3, 6.5: a coil is written with FF00h or 0000h",
        "switches a coil on with any value but 0", coil_value_unchecked = true;
    "masks-simply-joined", "MODBUS application protocol V1.1b3, 6.16: the OR mask only sets bits that the AND mask clears",
        "sets every bit of the OR mask", masks_simply_joined = true;
    "reads-before-writes", "MODBUS application protocol V1.1b3, 6.17: 17h writes before it reads",
        "answers 17h with what was there before it wrote", reads_before_writes = true;
    "loopback-cut", "MODBUS application protocol V1.1b3, 6.8.1: sub-function 00h is answered with all data of the request",
        "answers the loopback with the first two bytes of its data", loopback_cut = true;
    "communication-errors-uncounted", "MODBUS application protocol V1.1b3, 6.8.1: sub-function 0Ch counts frames with a wrong CRC",
        "does not count spoilt frames", communication_errors_uncounted = true;
    "counters-not-cleared", "MODBUS application protocol V1.1b3, 6.8.1: sub-function 0Ah clears all counters",
        "confirms clearing the counters and does not do it", counters_not_cleared = true;
    "fetches-count-as-events", "MODBUS application protocol V1.1b3, 6.9: fetching the event counter is no event",
        "counts 0Bh and 0Ch as events", fetches_count_as_events = true;
    "listen-only-answered", "MODBUS application protocol V1.1b3, 6.8.1: in listen only mode nothing is answered",
        "does and answers requests in listen only mode", listen_only_answered = true;
    "restart-keeps-listening", "MODBUS application protocol V1.1b3, 6.8.1: sub-function 01h ends listen only mode",
        "stays in listen only mode after a restart", restart_keeps_listening = true;
    "run-indicator-off", "MODBUS application protocol V1.1b3, 6.13: the run indicator is FFh while the device runs",
        "says in 11h that it does not run", run_indicator_off = true;
    "fifo-count-left-out", "MODBUS application protocol V1.1b3, 6.18: the byte count of 18h has the count in it",
        "leaves the count out of the byte count of 18h", fifo_count_missing_in_bytes = true;
    "categories-ignored", "MODBUS application protocol V1.1b3, 6.21: a category has its own objects and those before",
        "answers every category of the identification with all objects", categories_ignored = true;
    "unknown-object-answered", "MODBUS application protocol V1.1b3, 6.21: a single object that does not exist is answered with exception 02",
        "answers the vendor's name for an object that does not exist", unknown_object_answered = true;
}
