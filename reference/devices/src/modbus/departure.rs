//! What a slave may be made to do wrong in one place, where nothing but a fault asks for it.

/// One departure of a slave.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Departure {
    /// After a frame that is too long it does not hear the next one.
    DeafAfterLongFrame,
    /// After a frame that is none it does not hear the next one.
    DeafAfterBadFrame,
    /// It does not hear what begins within 10 ms of the end of its answer.
    RestsAfterAnswer,
    /// A frame ends after 0.9 characters of silence.
    IdleLineEndsFrame,
    /// A frame ends after 20 ms of silence, and what is quiet inside it does not matter.
    PatientLine,
    /// It sends the request back before its answer.
    EchoesRequest,
    /// Encoder only: the text before the new address is not looked at.
    AddressTextIgnored,
    /// Bytes that a request lacks count as 0.
    ShortPduFilled,
    /// Bit 7 of the function is not looked at.
    HighBitIgnored,
    /// A counter of 08h, by its sub-function, stays 0.
    CounterStays(u8),
    /// What was refused counts as an event.
    RefusalsCountAsEvents,
    /// The log of 0Ch has no events.
    LogEmpty,
    /// 07h is answered with two bytes.
    ExceptionStatusLong,
    /// Addresses count from 1.
    AddressesFromOne,
    /// 06h is confirmed and not done.
    SingleNotWritten,
    /// 05h is confirmed and not done.
    CoilNotWritten,
    /// The answer to 10h and 0Fh has the number of bytes.
    MultipleEchoesBytes,
    /// More than 64 registers or 512 bits do not fit, and are refused.
    LargeRequestsRefused,
    /// The last address of a table is not reached.
    LastAddressRefused,
    /// 15h is confirmed and not done.
    RecordsNotWritten,
    /// 14h answers only the first of several rows.
    FirstRowOnly,
    /// Nothing keeps it from doing what is asked: no condition is minded.
    ConditionsIgnored,
    /// What keeps it from doing some things keeps it from doing all.
    ConditionsForAll,
    /// What is to survive power-off is lost.
    MemoryLost,
    /// What is not to survive power-off does.
    NothingLost,
    /// A value that 17h may not write is not written, and what is asked for is read.
    ReadsThoughRefused,
    /// 16h writes the OR mask where the AND mask is 0, and else nothing.
    MaskLost,
    /// The answer to 2Bh says another next object.
    NextObjectWrong,
    /// A loopback with more than two bytes is refused.
    LongLoopbackRefused,
    /// Sub-functions of 08h that it does not have are answered like the loopback.
    UnknownSubFunctionEchoed,
}
