//! The SDO server: expedited and segmented transfers.

mod download;
mod upload;

use fieldproof_can::Frame;
use fieldproof_link::Instant;

use super::pdo_rules::Parameter;
use super::queue::{Service, identifier};
use super::{Abort, AbortMultiplexer, Address, Application, Slave};

/// The longest value of an object without a fixed size.
const LONGEST_VALUE: usize = 1024;
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
    /// The application is reading.
    Reading(Address),
    /// The application is writing; the last answer's command byte is kept.
    Writing { address: Address, command: u8 },
}

/// The server's own memory.
#[derive(Debug, Default)]
pub(super) struct Server {
    transfer: Transfer,
    /// The data of the transfer.
    buffer: Vec<u8>,
    /// What the object last written held before.
    before: Option<(Address, Vec<u8>)>,
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
            Transfer::Upload { .. } | Transfer::Reading(_) => "upload",
            Transfer::Download { .. } | Transfer::Writing { .. } => "download",
        }
    }
}

impl Slave {
    /// | byte | holds |
    /// | --- | --- |
    /// | 0 | command specifier in bits 5 to 7 |
    /// | 1 to 3 | index (low byte first) and sub-index where a transfer begins or is aborted |
    /// | 4 to 7 | data of an expedited transfer, or the size of a segmented one |
    pub(super) fn serve(&mut self, now: Instant, frame: &Frame, application: &mut dyn Application) {
        if !self.state.permits(Service::Sdo, &self.behaviour) {
            return;
        }
        let Ok(request) = <[u8; 8]>::try_from(frame.bytes()) else {
            return;
        };
        let [command, m0, m1, m2, data @ ..] = request;
        let address = Address::from_multiplexer([m0, m1, m2]);
        let outcome = match command >> 5 {
            0 => self.download_segment(now, &request, application),
            1 => self.initiate_download(now, command, address, data, application),
            2 => self.initiate_upload(now, address, application),
            3 => self.upload_segment(now, command, address),
            4 => {
                self.sdo.transfer = Transfer::None;
                Ok(())
            }
            _ if self.behaviour.unknown_command_refused => Err((address, Abort::UNKNOWN_COMMAND)),
            _ => Ok(()),
        };
        if let Err((address, abort)) = outcome {
            self.abort(now, address, abort);
        }
    }

    pub(super) fn abort(&mut self, now: Instant, address: Address, abort: Abort) {
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
        let raw = self.sdo.answers_on.unwrap_or(0x580 + u16::from(node));
        let identifier = identifier(raw);
        self.queue
            .push(at, Service::Sdo, Frame::of_eight(identifier, response));
    }
}

fn is_mapping_entry(address: Address) -> bool {
    address.sub() != 0 && Parameter::of(address.index()) == Some(Parameter::Mapping)
}
