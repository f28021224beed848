//! By which protocol a value travels, and which object it belongs to.

use schemars::{JsonSchema, Schema, json_schema};
use serde::Deserialize;

use crate::code;
use crate::forms::TwoForms;
use crate::model::{BlockMistake, BlockTransfer, SdoObject, Transfer};
use crate::problem::Wrong;
use crate::scalar::{ObjectAddress, Text, read_as_text};

const WRITABLE_DOMAIN: &str = "writable-domain";

impl Text for SdoObject {
    const EXPECTED: &'static str = "an object such as \"6041:00\"";

    fn parse(text: &str) -> Result<SdoObject, Wrong> {
        match text {
            WRITABLE_DOMAIN => Ok(SdoObject::WritableDomain),
            _ => ObjectAddress::parse(text).map(SdoObject::Address),
        }
    }

    fn schema() -> Schema {
        json_schema!({"anyOf": [ObjectAddress::schema(), {"const": WRITABLE_DOMAIN}]})
    }
}

read_as_text!(SdoObject);

/// A protocol by its name, or the block protocol with its settings.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum TransferFile {
    Named(TransferName),
    Block(BlockFile),
}

/// A protocol of SDO.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum TransferName {
    /// In the initiate frames: 4 bytes at the most.
    Expedited,
    /// In segments, each of which is answered.
    Segmented,
    /// In blocks of segments.
    Block,
}

/// A block transfer; what is left out is as with `transfer: block`.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(rename = "BlockTransfer")]
pub(crate) struct BlockFile {
    /// Whether the tester makes or checks a CRC; true where nothing is said.
    #[serde(default)]
    crc: Option<bool>,
    /// Of a read: segments of a block, 1 to 127, or another number to see it refused; 127 where nothing is said.
    #[serde(default)]
    block_size: Option<u8>,
    /// Of a read: segments of every block but the first.
    #[serde(default)]
    next_block_size: Option<u8>,
    /// Of a read: a value of up to this many bytes may come by the ordinary upload; 0 where nothing is said.
    #[serde(default)]
    switch_threshold: Option<u8>,
    /// Of a write: whether the size is given before; true where nothing is said.
    #[serde(default)]
    size_given: Option<bool>,
    /// What the tester does wrong.
    #[serde(default)]
    mistake: Option<BlockMistake>,
}

impl TwoForms for TransferFile {
    type Short = TransferName;
    type Full = BlockFile;

    fn from_short(name: TransferName) -> TransferFile {
        TransferFile::Named(name)
    }

    fn from_full(block: BlockFile) -> TransferFile {
        TransferFile::Block(block)
    }
}

/// In which direction a value travels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Direction {
    Read,
    Write,
}

impl TransferFile {
    pub(crate) fn lower(self, direction: Direction) -> Result<Transfer, Wrong> {
        let block = match self {
            TransferFile::Named(TransferName::Expedited) => return Ok(Transfer::Expedited),
            TransferFile::Named(TransferName::Segmented) => return Ok(Transfer::Segmented),
            TransferFile::Named(TransferName::Block) => {
                return Ok(Transfer::Block(BlockTransfer::default()));
            }
            TransferFile::Block(block) => block,
        };
        block.check(direction)?;
        let usual = BlockTransfer::default();
        Ok(Transfer::Block(BlockTransfer {
            crc: block.crc.unwrap_or(usual.crc),
            block_size: block.block_size.unwrap_or(usual.block_size),
            next_block_size: block.next_block_size,
            switch_threshold: block.switch_threshold.unwrap_or(usual.switch_threshold),
            size_given: block.size_given.unwrap_or(usual.size_given),
            mistake: block.mistake,
        }))
    }
}

impl BlockFile {
    fn check(&self, direction: Direction) -> Result<(), Wrong> {
        let of_reads = self.block_size.is_some()
            || self.next_block_size.is_some()
            || self.switch_threshold.is_some();
        let downloads_only = matches!(
            self.mistake,
            Some(BlockMistake::WrongCrc | BlockMistake::WrongSize)
        );
        let uploads_only = self.mistake == Some(BlockMistake::WrongNumber);
        let message = match direction {
            Direction::Write if of_reads => {
                "`block-size`, `next-block-size` and `switch-threshold` belong to a read"
            }
            Direction::Write if uploads_only => "`wrong-number` is a mistake of a read",
            Direction::Read if self.size_given.is_some() => "`size-given` belongs to a write",
            Direction::Read if downloads_only => {
                "`wrong-crc` and `wrong-size` are mistakes of a write"
            }
            _ => return Ok(()),
        };
        let label = "in a block transfer the other way";
        Err(Wrong::new(code::KEYS_TOGETHER, message, label))
    }
}
