//! The SDO server: expedited, segmented and block transfers.

mod block;
mod download;
mod upload;

use fieldproof_can::{Frame, StandardId};
use fieldproof_link::Instant;

use super::pdo_rules::Parameter;
use super::queue::{Service, identifier};
use super::{Abort, AbortMultiplexer, Address, Application, Slave};
use block::{AskedBlocks, BlockDownload, BlockUpload};
pub use block::{BlockTransfer, Recovery};

/// The longest value of an object without a fixed size, in bytes.
const LONGEST_VALUE: usize = 1 << 15;
/// Data bytes of a segment.
const SEGMENT: usize = 7;

/// A request that is refused: the object it names, and why.
type Refusal = (Address, Abort);

/// A transfer that takes more than one request, or longer than one answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Transfer {
    #[default]
    None,
    Upload {
        address: Address,
        offset: usize,
        toggle: bool,
    },
    Download {
        address: Address,
        size: Option<usize>,
        toggle: bool,
    },
    BlockUpload(BlockUpload),
    BlockDownload(BlockDownload),
    /// The application is reading.
    Reading {
        address: Address,
        asked: Asked,
    },
    /// The application is writing; the last answer's command byte is kept.
    Writing {
        address: Address,
        command: u8,
    },
}

/// How a client wants a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Asked {
    /// Expedited or in segments.
    Ordinary,
    /// In blocks.
    Blocks(AskedBlocks),
}

/// The server's own memory.
#[derive(Debug, Default)]
pub(super) struct Server {
    transfer: Transfer,
    /// The data of the transfer.
    buffer: Vec<u8>,
    /// What the object last written held before.
    before: Option<(Address, Vec<u8>)>,
    /// When a block transfer has waited long enough for the client.
    deadline: Option<Instant>,
    /// The identifier of its answers, if it is not the default server's.
    answers_on: Option<u16>,
}

impl Server {
    /// A server beside the default one.
    pub(super) fn answering_on(identifier: Option<u16>) -> Server {
        Server {
            answers_on: identifier,
            ..Server::default()
        }
    }

    pub(super) const fn name(&self) -> &'static str {
        match self.transfer {
            Transfer::None => "idle",
            Transfer::Upload { .. } | Transfer::Reading { .. } => "upload",
            Transfer::Download { .. } | Transfer::Writing { .. } => "download",
            Transfer::BlockUpload(_) => "block upload",
            Transfer::BlockDownload(_) => "block download",
        }
    }

    pub(super) const fn deadline(&self) -> Option<Instant> {
        self.deadline
    }
}

impl Slave {
    /// | byte | holds |
    /// | --- | --- |
    /// | 0 | command specifier in bits 5 to 7 |
    /// | 1 to 3 | index (low byte first) and sub-index where a transfer begins or is aborted |
    /// | 4 to 7 | data of an expedited transfer, or the size of a segmented one |
    pub(super) fn serve(&mut self, now: Instant, frame: &Frame, application: &mut dyn Application) {
        let silent = !self.state.permits(Service::Sdo, &self.behaviour);
        if silent && !self.behaviour.nmt.requests_done_in_stopped {
            return;
        }
        let Ok(request) = <[u8; 8]>::try_from(frame.bytes()) else {
            return;
        };
        let outcome = match self.serve_blocks(now, &request, application) {
            Some(outcome) => outcome,
            None => self.serve_ordinary(now, &request, application),
        };
        if let Err((address, abort)) = outcome {
            self.abort(now, address, abort);
        }
        self.await_block_request(now);
        if silent {
            self.queue.retain(|service| service != Service::Sdo);
        }
    }

    fn serve_ordinary(
        &mut self,
        now: Instant,
        request: &[u8; 8],
        application: &mut dyn Application,
    ) -> Result<(), Refusal> {
        let [command, m0, m1, m2, data @ ..] = *request;
        let address = Address::from_multiplexer([m0, m1, m2]);
        match command >> 5 {
            0 => self.download_segment(now, request, application),
            1 => self.initiate_download(now, command, address, data, application),
            2 => self.begin_upload(now, address, Asked::Ordinary, application),
            3 => self.upload_segment(now, command, address),
            4 => {
                self.forget_segments();
                self.sdo.transfer = Transfer::None;
                Ok(())
            }
            _ if self.behaviour.unknown_command_refused => Err((address, Abort::UNKNOWN_COMMAND)),
            _ => Ok(()),
        }
    }

    pub(super) fn abort(&mut self, now: Instant, address: Address, abort: Abort) {
        self.forget_segments();
        self.sdo.transfer = Transfer::None;
        let named = match self.behaviour.abort_multiplexer {
            AbortMultiplexer::OfRequest => address,
            AbortMultiplexer::NextIndex => {
                Address::new(address.index().wrapping_add(1), address.sub())
            }
        };
        let code = if abort == Abort::NO_SUB_INDEX {
            self.behaviour.abort_no_sub_index
        } else {
            abort.0
        };
        let [m0, m1, m2] = named.multiplexer();
        let [c0, c1, c2, c3] = code.to_le_bytes();
        self.respond(now, [0x80, m0, m1, m2, c0, c1, c2, c3]);
    }

    pub(super) fn respond(&mut self, now: Instant, response: [u8; 8]) {
        self.respond_from(now, self.node, response);
    }

    pub(super) fn respond_from(&mut self, now: Instant, node: u8, response: [u8; 8]) {
        let at = now + self.turnaround();
        self.respond_at(at, node, response);
    }

    /// The identifier of this server's answers.
    fn answers_from(&self, node: u8) -> StandardId {
        identifier(self.sdo.answers_on.unwrap_or(0x580 + u16::from(node)))
    }

    fn respond_at(&mut self, at: Instant, node: u8, response: [u8; 8]) {
        let identifier = self.answers_from(node);
        self.queue
            .push(at, Service::Sdo, Frame::of_eight(identifier, response));
    }
}

fn is_mapping_entry(address: Address) -> bool {
    address.sub() != 0 && Parameter::of(address.index()) == Some(Parameter::Mapping)
}
