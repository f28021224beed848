//! Faults of framing, of refusals and of single functions, each one departure from one clause.

use super::Remains;
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
            named: &[],
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
    "broadcast-ignored", "MODBUS over serial line V1.02, 2.1: all slaves must accept the broadcast for writing functions",
        "does nothing for a request to address 0", broadcast_ignored = true;

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
