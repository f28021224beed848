//! How a slave does expedited and segmented transfers.

use std::time::Duration;

/// How an SDO server does expedited and segmented transfers, and what it checks. The default conforms to CiA 301.
#[derive(Debug, Clone)]
pub struct OrdinaryTransfer {
    /// How long it waits for the next segment before it gives a transfer up; it need not.
    pub timeout: Option<Duration>,
    /// It says before a segmented upload how many bytes will come.
    pub size_given: bool,
    /// What it does about a request of fewer than 8 bytes.
    pub short_request: ShortRequest,
    /// What it does about a new request while a segmented transfer is open.
    pub second_initiate: SecondInitiate,
    /// A segment request with no transfer open.
    pub stray_segment: StraySegment,

    /// Its answers have 8 bytes; else they end with their last byte that is not 0.
    pub padded: bool,
    /// The reserved bytes of the answer to a segment are 0, and not what the request had there.
    pub reserved_bytes_zero: bool,
    /// A segment request with the wrong toggle bit is refused.
    pub upload_toggle_checked: bool,
    /// A segment with the wrong toggle bit is refused.
    pub download_toggle_checked: bool,
    /// A transfer that the server has aborted is over.
    pub own_abort_final: bool,
    /// What the client does with an abort.
    pub client_abort: ClientAbort,
    /// The last segment of an upload says that it is the last.
    pub last_marked: bool,
    /// The last segment of an upload says how many of its bytes are not data.
    pub unused_given: bool,
    /// How many bytes of the last segment of a download are not data is looked at.
    pub unused_obeyed: bool,
    /// Bytes that it says will come in segments beyond those that do.
    pub surplus_size: usize,
    /// The size that a download was to have is compared with what came.
    pub size_checked: bool,
    /// A download without its size is taken.
    pub unsized_taken: bool,
    /// A download in segments is taken where the value would fit one frame.
    pub small_segmented_taken: bool,
    /// The place in the value that is uploaded has 16 bits, and not 8.
    pub long_offset: bool,
    /// An empty value comes as no bytes, and not as four.
    pub empty_sent: bool,
    /// A value of another length than the object's is refused, and not cut or filled up.
    pub length_checked: bool,
    /// A value above the high limit is refused.
    pub high_limit_checked: bool,
    /// A value below the low limit is refused.
    pub low_limit_checked: bool,
    /// A value that is refused for its limits is not written.
    pub refused_not_written: bool,
    /// Writing an object that cannot be written is refused.
    pub read_only: ReadOnly,
    /// Reading an object that cannot be read is refused.
    pub write_only_checked: bool,
    /// A sub-index that is missing between others is refused.
    pub gaps_refused: bool,
    /// An index that does not exist is refused.
    pub unknown_object_refused: bool,
    /// An object takes the value that it already has.
    pub same_value_taken: bool,
    /// Only requests to the own node-ID are answered, and not those to the next as well.
    pub own_node_only: bool,
    /// A server that has given a transfer up serves the next request.
    pub serves_after_time_out: bool,
    /// A reset ends a transfer.
    pub reset_ends: bool,
    /// Each server has a transfer of its own.
    pub servers_apart: bool,
    /// A server whose COB-IDs are not valid is silent.
    pub servers_off: bool,
    /// The COB-IDs that are written to an additional server are the ones it works with.
    pub servers_follow: bool,
    /// Every so many requests one is refused for lack of memory.
    pub refused_each: Option<u32>,
    /// Every so many answers one takes 700 ms.
    pub late_each: Option<u32>,
}

/// What an SDO server does about a request of fewer than 8 bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ShortRequest {
    /// Nothing.
    Ignored,
    /// It refuses it.
    Refused,
    /// It takes what is missing for 0.
    Executed,
}

/// What an SDO server does about a new request while a segmented transfer is open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SecondInitiate {
    /// The transfer is dropped, the request is served.
    Served,
    /// The transfer is aborted, the request is lost.
    Aborted,
    /// The transfer stays open, the request is not answered.
    Ignored,
}

/// What an SDO server does about a segment request with no transfer open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StraySegment {
    /// It refuses it.
    Refused,
    /// Nothing.
    Ignored,
    /// It answers as if a transfer were open.
    Answered,
}

/// What an SDO server does about the client's abort.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClientAbort {
    /// The transfer is over.
    Obeyed,
    /// Nothing.
    Ignored,
    /// It is refused as an unknown command.
    Refused,
}

/// What an SDO server does when an object is written that cannot be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ReadOnly {
    /// It refuses.
    Refused,
    /// It confirms, and keeps the value.
    Confirmed,
    /// It writes.
    Written,
}

impl Default for OrdinaryTransfer {
    fn default() -> OrdinaryTransfer {
        OrdinaryTransfer {
            timeout: None,
            size_given: true,
            short_request: ShortRequest::Ignored,
            second_initiate: SecondInitiate::Served,
            stray_segment: StraySegment::Refused,
            padded: true,
            reserved_bytes_zero: true,
            upload_toggle_checked: true,
            download_toggle_checked: true,
            own_abort_final: true,
            client_abort: ClientAbort::Obeyed,
            last_marked: true,
            unused_given: true,
            unused_obeyed: true,
            surplus_size: 0,
            size_checked: true,
            unsized_taken: true,
            small_segmented_taken: true,
            long_offset: true,
            empty_sent: true,
            length_checked: true,
            high_limit_checked: true,
            low_limit_checked: true,
            refused_not_written: true,
            read_only: ReadOnly::Refused,
            write_only_checked: true,
            gaps_refused: true,
            unknown_object_refused: true,
            same_value_taken: true,
            own_node_only: true,
            serves_after_time_out: true,
            reset_ends: true,
            servers_apart: true,
            servers_off: true,
            servers_follow: true,
            refused_each: None,
            late_each: None,
        }
    }
}
