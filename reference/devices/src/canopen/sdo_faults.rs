//! The faults that expedited and segmented SDO transfers can be given, each one departure from one clause.

use std::time::Duration;

use super::{AbortMultiplexer, ClientAbort, ReadOnly, SecondInitiate, ShortRequest, StraySegment};
use crate::Fault;
use crate::catalogue::Behaviour;

const fn fault(
    name: &'static str,
    breaks: &'static str,
    words: &'static str,
    apply: fn(&mut Behaviour),
) -> Fault {
    Fault {
        name,
        breaks,
        words,
        caught_by: "sdo",
        apply,
    }
}

/// What every SDO server here can have.
pub(crate) const ACCESS: &[Fault] = &[
    fault(
        "sdo-answer-short",
        "CiA 301: SDO protocols, a message has 8 bytes",
        "ends its SDO answers with the last byte that is not 0",
        |behaviour| behaviour.canopen.sdo.padded = false,
    ),
    fault(
        "short-request-executed",
        "CiA 301: SDO protocols, a message has 8 bytes",
        "takes the bytes that a short SDO request lacks for 0, and does what it says",
        |behaviour| behaviour.canopen.sdo.short_request = ShortRequest::Executed,
    ),
    fault(
        "length-unchecked",
        "CiA 301: SDO abort codes 06070010h, 06070012h and 06070013h",
        "cuts a value that is too long, and fills up one that is too short",
        |behaviour| behaviour.canopen.sdo.length_checked = false,
    ),
    fault(
        "high-limit-unchecked",
        "CiA 301: SDO abort code 06090031h",
        "takes a value above the high limit",
        |behaviour| behaviour.canopen.sdo.high_limit_checked = false,
    ),
    fault(
        "low-limit-unchecked",
        "CiA 301: SDO abort code 06090032h",
        "takes a value below the low limit",
        |behaviour| behaviour.canopen.sdo.low_limit_checked = false,
    ),
    fault(
        "refused-value-kept",
        "CiA 301: SDO abort transfer, the download has failed",
        "refuses a value beyond its limits, and has it all the same",
        |behaviour| behaviour.canopen.sdo.refused_not_written = false,
    ),
    fault(
        "read-only-confirmed",
        "CiA 301: SDO abort code 06010002h",
        "confirms that it has written an object that cannot be, and has not",
        |behaviour| behaviour.canopen.sdo.read_only = ReadOnly::Confirmed,
    ),
    fault(
        "read-only-written",
        "CiA 301: access attributes ro and const",
        "writes objects that cannot be written",
        |behaviour| behaviour.canopen.sdo.read_only = ReadOnly::Written,
    ),
    fault(
        "write-only-read",
        "CiA 301: SDO abort code 06010001h",
        "lets an object be read that cannot be",
        |behaviour| behaviour.canopen.sdo.write_only_checked = false,
    ),
    fault(
        "gap-read",
        "CiA 301: SDO abort code 06090011h",
        "reads 0 at a sub-index that is missing between others",
        |behaviour| behaviour.canopen.sdo.gaps_refused = false,
    ),
    fault(
        "unknown-object-read",
        "CiA 301: SDO abort code 06020000h",
        "reads 0 at an index that does not exist",
        |behaviour| behaviour.canopen.sdo.unknown_object_refused = false,
    ),
    fault(
        "same-value-refused",
        "CiA 301: SDO download",
        "refuses the value that an object already has",
        |behaviour| behaviour.canopen.sdo.same_value_taken = false,
    ),
    fault(
        "sdo-refused-now-and-then",
        "CiA 301: SDO upload and download",
        "refuses every 256th transfer for lack of memory",
        |behaviour| behaviour.canopen.sdo.refused_each = Some(256),
    ),
    fault(
        "sdo-late-now-and-then",
        "the response time that is promised",
        "takes 700 ms for every 150th SDO answer",
        |behaviour| behaviour.canopen.sdo.late_each = Some(150),
    ),
    fault(
        "client-abort-refused",
        "CiA 301: SDO abort transfer is not confirmed",
        "answers an abort with an abort",
        |behaviour| behaviour.canopen.sdo.client_abort = ClientAbort::Refused,
    ),
    fault(
        "sdo-of-the-next-node-answered",
        "CiA 301: COB-IDs of the default SDO",
        "answers requests to the next node-ID as well",
        |behaviour| behaviour.canopen.sdo.own_node_only = false,
    ),
    fault(
        "stray-segment-answered",
        "CiA 301: SDO abort code 05040001h",
        "answers a segment request with no transfer open",
        |behaviour| behaviour.canopen.sdo.stray_segment = StraySegment::Answered,
    ),
];

/// What an SDO server here can have that does segmented transfers.
pub(crate) const SEGMENTED: &[Fault] = &[
    fault(
        "abort-names-request-bytes",
        "CiA 301: SDO abort transfer, multiplexer",
        "names in an abort what bytes 1 to 3 of the request hold, and be it data of a segment",
        |behaviour| behaviour.canopen.abort_multiplexer = AbortMultiplexer::OfFrame,
    ),
    fault(
        "segment-answer-dirty",
        "CiA 301: SDO download segment, reserved bytes are 0",
        "repeats the data of a segment in its answer",
        |behaviour| behaviour.canopen.sdo.reserved_bytes_zero = false,
    ),
    fault(
        "upload-toggle-unchecked",
        "CiA 301: SDO abort code 05030000h",
        "answers a segment request whatever its toggle bit",
        |behaviour| behaviour.canopen.sdo.upload_toggle_checked = false,
    ),
    fault(
        "download-toggle-unchecked",
        "CiA 301: SDO abort code 05030000h",
        "takes a segment whatever its toggle bit, and so one twice",
        |behaviour| behaviour.canopen.sdo.download_toggle_checked = false,
    ),
    fault(
        "own-abort-not-final",
        "CiA 301: SDO abort transfer ends the transfer",
        "goes on with a transfer that it has aborted",
        |behaviour| behaviour.canopen.sdo.own_abort_final = false,
    ),
    fault(
        "client-abort-ignored",
        "CiA 301: SDO abort transfer",
        "goes on with a transfer that the client has aborted",
        |behaviour| behaviour.canopen.sdo.client_abort = ClientAbort::Ignored,
    ),
    fault(
        "abandoned-transfer-stays",
        "CiA 301: SDO initiate requests",
        "answers no new request until a segmented transfer that the client has dropped is aborted",
        |behaviour| behaviour.canopen.sdo.second_initiate = SecondInitiate::Ignored,
    ),
    fault(
        "stuck-after-time-out",
        "CiA 301: SDO abort transfer, abort code 05040000h",
        "gives up a transfer that is not carried on, and answers no request from then on",
        |behaviour| {
            behaviour.canopen.sdo.timeout = Some(Duration::from_secs(1));
            behaviour.canopen.sdo.serves_after_time_out = false;
        },
    ),
    fault(
        "transfer-survives-reset",
        "CiA 301: NMT service reset communication",
        "goes on with an SDO transfer that was open when it was reset",
        |behaviour| behaviour.canopen.sdo.reset_ends = false,
    ),
    fault(
        "segment-last-not-marked",
        "CiA 301: SDO upload segment, bit 0",
        "does not say that the last segment is the last",
        |behaviour| behaviour.canopen.sdo.last_marked = false,
    ),
    fault(
        "segment-unused-wrong",
        "CiA 301: SDO upload segment, bytes without data",
        "says that every byte of the last segment is data",
        |behaviour| behaviour.canopen.sdo.unused_given = false,
    ),
    fault(
        "segmented-size-wrong",
        "CiA 301: SDO upload initiate, size",
        "says that one byte more will come in segments than does",
        |behaviour| behaviour.canopen.sdo.surplus_size = 1,
    ),
    fault(
        "long-value-wraps",
        "CiA 301: SDO upload segment",
        "counts the bytes of an upload in 8 bits, and begins again after 256",
        |behaviour| behaviour.canopen.sdo.long_offset = false,
    ),
    fault(
        "small-segmented-refused",
        "CiA 301: SDO download initiate, normal transfer",
        "refuses a download in segments where the value would fit one frame",
        |behaviour| behaviour.canopen.sdo.small_segmented_taken = false,
    ),
    fault(
        "unsized-download-refused",
        "CiA 301: SDO download initiate, size indicator",
        "refuses a download whose size is not given",
        |behaviour| behaviour.canopen.sdo.unsized_taken = false,
    ),
];

/// What an SDO server here can have that takes values of any length in segments.
pub(crate) const ANY_LENGTH: &[Fault] = &[
    fault(
        "download-unused-ignored",
        "CiA 301: SDO download segment, bytes without data",
        "takes all seven bytes of the last segment",
        |behaviour| behaviour.canopen.sdo.unused_obeyed = false,
    ),
    fault(
        "download-size-unchecked",
        "CiA 301: SDO download initiate, size; abort code 06070010h",
        "takes a download in segments that is not as long as was said",
        |behaviour| behaviour.canopen.sdo.size_checked = false,
    ),
    fault(
        "empty-value-padded",
        "CiA 301: SDO upload, size",
        "answers with four bytes where a value has none",
        |behaviour| behaviour.canopen.sdo.empty_sent = false,
    ),
];

/// What a device here can have with several SDO servers.
pub(crate) const SERVERS: &[Fault] = &[
    fault(
        "servers-share-a-transfer",
        "CiA 301: SDO server parameter, each is a channel of its own",
        "has one transfer for all its SDO servers",
        |behaviour| behaviour.canopen.sdo.servers_apart = false,
    ),
    fault(
        "invalid-server-answers",
        "CiA 301: SDO server parameter, bit 31 of the COB-ID",
        "has an SDO server answer though its COB-IDs are not valid",
        |behaviour| behaviour.canopen.sdo.servers_off = false,
    ),
    fault(
        "server-cob-id-ignored",
        "CiA 301: SDO server parameter, COB-ID",
        "takes the COB-IDs of an SDO server, and does not use them",
        |behaviour| behaviour.canopen.sdo.servers_follow = false,
    ),
];

/// What a device here can have that refuses accesses for reasons of its own.
pub(crate) const REASONS: &[Fault] = &[fault(
    "refusal-without-reason",
    "CiA 301: SDO abort codes",
    "says that an object does not exist when something else is the matter",
    |behaviour| {
        behaviour.canopen.abort_codes = &[
            (0x0504_0005, 0x0602_0000),
            (0x0604_0047, 0x0602_0000),
            (0x0606_0000, 0x0602_0000),
            (0x060A_0023, 0x0602_0000),
            (0x0800_0000, 0x0602_0000),
            (0x0800_0020, 0x0602_0000),
            (0x0800_0021, 0x0602_0000),
            (0x0800_0022, 0x0602_0000),
            (0x0800_0023, 0x0602_0000),
            (0x0800_0024, 0x0602_0000),
            (0x0609_0036, 0x0602_0000),
        ];
    },
)];
