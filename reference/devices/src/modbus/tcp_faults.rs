//! Faults of the TCP side, each one departure from one clause.

use super::TcpFault;
use crate::Fault;

/// A fault of the TCP side.
macro_rules! tcp_faults {
    ($($name:literal, $breaks:literal, $words:literal, $fault:ident;)+) => {
        /// What a slave on Modbus TCP can have.
        pub(crate) const TCP: &[Fault] = &[$(Fault {
            name: $name,
            breaks: $breaks,
            words: $words,
            caught_by: "modbus",
            apply: |behaviour| behaviour.modbus.tcp_fault = Some(TcpFault::$fault),
        }),+];
    };
}

tcp_faults! {
    "tcp-transaction-zero", "MODBUS messaging on TCP/IP V1.0b, 3.1.3: the answer repeats the transaction identifier",
        "answers every request over TCP with transaction 0", TransactionZero;
    "tcp-transaction-counted", "MODBUS messaging on TCP/IP V1.0b, 3.1.3: the answer repeats the transaction identifier",
        "numbers its answers over TCP itself", TransactionCounted;
    "tcp-length-without-unit", "MODBUS messaging on TCP/IP V1.0b, 3.1.3: the length counts the unit identifier and the data",
        "leaves the unit out of the length of its answers", LengthWithoutUnit;
    "tcp-unit-replaced", "MODBUS messaging on TCP/IP V1.0b, 3.1.3: the answer repeats the unit identifier",
        "answers every unit as unit FFh", UnitReplaced;
    "tcp-unit-0-unanswered", "MODBUS messaging on TCP/IP V1.0b, 4.4: unit 0 addresses a device at the end of a connection",
        "takes unit 0 for a broadcast", UnitZeroUnanswered;
    "tcp-other-protocols", "MODBUS messaging on TCP/IP V1.0b, 3.1.3: the protocol identifier of Modbus is 0",
        "answers requests with another protocol identifier", OtherProtocols;
    "tcp-length-ignored", "MODBUS messaging on TCP/IP V1.0b, 3.1.3: the length says where a frame ends",
        "takes a request to end where its function says, whatever the length is", LengthIgnored;
    "tcp-piece-is-request", "MODBUS messaging on TCP/IP V1.0b, 3.1.3: a frame may come in several packets",
        "forgets the beginning of a request whose rest comes in another packet", PieceIsRequest;
    "tcp-first-of-piece", "MODBUS messaging on TCP/IP V1.0b, 4.4: several requests may be on the way at once",
        "answers the first of several requests in one packet, and forgets the others", FirstOfPiece;
    "tcp-half-blocks", "MODBUS messaging on TCP/IP V1.0b, 4.2: connections are served independently of each other",
        "answers nobody while half a request lies on one connection", HalfBlocks;
    "tcp-newest-only", "MODBUS messaging on TCP/IP V1.0b, 4.2: connections are served independently of each other",
        "goes silent on a connection once there is a newer one", NewestOnly;
    "tcp-never-freed", "MODBUS messaging on TCP/IP V1.0b, 4.2: a connection that is closed is free for another",
        "serves eight connections, and after that none, though all were closed", NeverFreed;
    "tcp-remains-kept", "MODBUS messaging on TCP/IP V1.0b, 3.1.3: a frame begins with its header",
        "puts half a request of a closed connection before what comes over the next", RemainsKept;
    "tcp-stuck-after-garbage", "MODBUS messaging on TCP/IP V1.0b, 4.4: a frame that is not of Modbus is discarded",
        "answers nobody any more after a header that is none", StuckAfterGarbage;
    "tcp-flood-stops", "MODBUS messaging on TCP/IP V1.0b, 4.4: a frame that is not of Modbus is discarded",
        "answers nobody any more after 512 bytes that are no frame", FloodStops;
    "tcp-gone-stops", "MODBUS messaging on TCP/IP V1.0b, 4.2: connections are served independently of each other",
        "answers nobody any more once a client has gone before its answer", GoneStops;
    "tcp-ends-after-many", "MODBUS messaging on TCP/IP V1.0b, 4.2: a connection is kept open, and not opened for each request",
        "ends a connection after 32 requests", EndsAfterMany;
    "tcp-short-buffer", "MODBUS application protocol V1.1b3, 4.1: a frame on TCP has up to 260 bytes",
        "does not answer requests of more than 256 bytes", ShortBuffer;
}
