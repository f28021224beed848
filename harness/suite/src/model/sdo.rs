//! Reading and writing objects.

use std::time::Duration;

use schemars::JsonSchema;
use serde::Deserialize;

use super::ValueType;
use crate::file::{SdoReadFile, SdoWriteFile};
use crate::identity::Claim;
use crate::scalar::{ObjectAddress, Value};

/// Reads an object.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(try_from = "SdoReadFile")]
pub struct SdoRead {
    /// The object.
    pub object: SdoObject,
    /// By which protocol; without it, as the server chooses.
    pub transfer: Option<Transfer>,
    /// Its type; the answer must have its size.
    pub value_type: ValueType,
    /// What must come; without it, any value.
    pub expect: ReadExpectation,
    /// How long after the request; else what the description promises.
    pub within: Option<Duration>,
    /// It is read again and again until it is what is expected, for so long at the most.
    pub settles: Option<Duration>,
    /// Keeps the value under this name for later steps.
    pub save: Option<String>,
    /// Records the value as an observation with these words.
    pub observe: Option<String>,
    /// The name of this check, for documented deviations.
    pub check: Option<String>,
}

/// An object to read or write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SdoObject {
    /// This one: `"6041:00"`.
    Address(ObjectAddress),
    /// `writable-domain`: the first DOMAIN of the device's dictionary that can be read and written. A case is skipped
    /// where there is none.
    WritableDomain,
}

/// By which protocol a value travels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Transfer {
    /// In the initiate frames: 4 bytes at the most.
    Expedited,
    /// In segments, each of which is answered.
    Segmented,
    /// In blocks of segments.
    Block(BlockTransfer),
}

/// How a block transfer is carried out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BlockTransfer {
    /// Whether the tester makes or checks a CRC.
    pub crc: bool,
    /// Of an upload: segments of a block, `1..=127`; others to see them refused.
    pub block_size: u8,
    /// Of an upload: segments of every block but the first.
    pub next_block_size: Option<u8>,
    /// Of an upload: a value of up to this many bytes may come by the ordinary upload; 0: none may.
    pub switch_threshold: u8,
    /// Of a download: whether the size is given before.
    pub size_given: bool,
    /// What the tester does wrong.
    pub mistake: Option<BlockMistake>,
}

impl Default for BlockTransfer {
    fn default() -> BlockTransfer {
        BlockTransfer {
            crc: true,
            block_size: 127,
            next_block_size: None,
            switch_threshold: 0,
            size_given: true,
            mistake: None,
        }
    }
}

/// What the tester does wrong in a block transfer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BlockMistake {
    /// A segment in the middle of the first block is lost; the server must notice, or send it again.
    LostSegment,
    /// An upload is acknowledged up to segment 128.
    WrongNumber,
    /// The CRC of a download is wrong.
    WrongCrc,
    /// A download is said to have one byte more than it has.
    WrongSize,
    /// The tester aborts within the first block, and the step is over.
    Abort,
    /// The tester sends nothing any more: after the first block of an upload, before the end of a download.
    Abandon,
}

impl BlockMistake {
    /// Whether the tester does not carry the transfer through.
    pub const fn gives_up(self) -> bool {
        matches!(self, BlockMistake::Abort | BlockMistake::Abandon)
    }
}

/// What a read must give.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum ReadExpectation {
    /// Any value of the right size.
    #[default]
    Any,
    /// This value: `expect: 5`, `expect: "JN5-CM-CAN"`, `expect: "{device_type}"`.
    Value(Value),
    /// One of these: `expect: {one-of: [1, 2]}`.
    OneOf(Vec<Value>),
    /// Between, limits included: `expect: {from: 5, to: 10}`.
    Range {
        /// Lower limit.
        from: i128,
        /// Upper limit.
        to: i128,
    },
    /// What the description claims: `expect: {claimed: vendor-id}`. A case is skipped where nothing is claimed.
    Claimed(Claim),
    /// `expect: {abort: [0x06010002, 0x06010000], strict: 0x06010002}`
    Abort(AbortExpectation),
}

/// A refusal that is expected.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AbortExpectation {
    /// The abort codes that pass. The abort must name the object that was asked for.
    pub abort: Vec<u32>,
    /// The one code that passes under `--strict`.
    pub strict: Option<u32>,
}

/// Writes an object.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(try_from = "SdoWriteFile")]
pub struct SdoWrite {
    /// The object.
    pub object: SdoObject,
    /// By which protocol; without it, expedited up to 4 bytes and else segmented.
    pub transfer: Option<Transfer>,
    /// The type it is sent as.
    pub value_type: ValueType,
    /// The value.
    pub value: Value,
    /// For a duration: what one count of the object is.
    pub unit: Option<Duration>,
    /// `ok` (the default) or `{abort: [...]}`.
    pub expect: WriteExpectation,
    /// How long after the request; else what the description promises.
    pub within: Option<Duration>,
    /// The name of this check, for documented deviations.
    pub check: Option<String>,
}

/// What a write must give.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum WriteExpectation {
    /// It is accepted.
    #[default]
    Ok,
    /// It is refused.
    Abort(AbortExpectation),
}
