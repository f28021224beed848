//! The SDO server: expedited, segmented and block transfers.

mod block;
mod download;
mod settings;
#[cfg(test)]
mod tests;
mod upload;

use std::time::Duration;

use fieldproof_can::{Frame, StandardId};
use fieldproof_link::Instant;

use super::pdo_rules::Parameter;
use super::queue::{Service, identifier};
use super::{Abort, AbortMultiplexer, Address, Application, Slave};
use block::{AskedBlocks, BlockDownload, BlockUpload};
pub use block::{BlockTransfer, Recovery};
pub use settings::{
    ClientAbort, OrdinaryTransfer, ReadOnly, SecondInitiate, ShortRequest, StraySegment,
};

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
    /// It has given a transfer up, and serves no more.
    stuck: bool,
    /// The last request.
    request: [u8; 8],
    /// How many transfers were asked for, and how many answers were given.
    asked: u32,
    answered: u32,
}

/// What a late answer takes more than others.
const LATE: Duration = Duration::from_millis(700);

impl Server {
    /// A server beside the default one.
    pub(super) fn answering_on(identifier: Option<u16>) -> Server {
        Server {
            answers_on: identifier,
            ..Server::default()
        }
    }

    /// A reset.
    pub(super) fn reset(&mut self, settings: &OrdinaryTransfer) {
        if settings.reset_ends {
            *self = Server::default();
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

    /// Answers as `other` does, which answers as this one did.
    pub(super) const fn exchange_identifier(&mut self, other: &mut Server) {
        std::mem::swap(&mut self.answers_on, &mut other.answers_on);
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
        if self.sdo.stuck {
            return;
        }
        let Some(request) = self.whole_request(now, frame) else {
            return;
        };
        self.sdo.request = request;
        let outcome = match self.serve_blocks(now, &request, application) {
            Some(outcome) => outcome,
            None => self.serve_ordinary(now, &request, application),
        };
        if let Err((address, abort)) = outcome {
            self.abort(now, address, abort);
        }
        self.await_request(now);
        if silent {
            self.queue.retain(|service| service != Service::Sdo);
        }
    }

    /// A request has 8 bytes.
    fn whole_request(&mut self, now: Instant, frame: &Frame) -> Option<[u8; 8]> {
        let bytes = frame.bytes();
        if let Ok(request) = <[u8; 8]>::try_from(bytes) {
            return Some(request);
        }
        let mut request = [0; 8];
        request
            .iter_mut()
            .zip(bytes)
            .for_each(|(to, from)| *to = *from);
        match self.behaviour.sdo.short_request {
            ShortRequest::Executed if !frame.is_remote() => Some(request),
            ShortRequest::Refused if !frame.is_remote() => {
                let [_, m0, m1, m2, ..] = request;
                let named = Address::from_multiplexer([m0, m1, m2]);
                self.abort(now, named, Abort::UNKNOWN_COMMAND);
                None
            }
            _ => None,
        }
    }

    /// A new transfer is asked for, of `address`; what comes of it, if it is not to be served.
    fn begins(&mut self, address: Address) -> Option<Result<(), Refusal>> {
        let settings = &self.behaviour.sdo;
        if let Transfer::Upload { .. } | Transfer::Download { .. } = self.sdo.transfer {
            match settings.second_initiate {
                SecondInitiate::Served => {}
                SecondInitiate::Aborted => return Some(Err((address, Abort::UNKNOWN_COMMAND))),
                SecondInitiate::Ignored => return Some(Ok(())),
            }
        }
        self.sdo.asked = self.sdo.asked.wrapping_add(1);
        let refused = settings
            .refused_each
            .is_some_and(|each| self.sdo.asked.is_multiple_of(each));
        refused.then_some(Err((address, Abort::OUT_OF_MEMORY)))
    }

    fn serve_ordinary(
        &mut self,
        now: Instant,
        request: &[u8; 8],
        application: &mut dyn Application,
    ) -> Result<(), Refusal> {
        let [command, m0, m1, m2, data @ ..] = *request;
        let address = Address::from_multiplexer([m0, m1, m2]);
        if matches!(command >> 5, 1 | 2)
            && let Some(outcome) = self.begins(address)
        {
            return outcome;
        }
        match command >> 5 {
            0 => self.download_segment(now, request, application),
            1 => self.initiate_download(now, command, address, data, application),
            2 => self.begin_upload(now, address, Asked::Ordinary, application),
            3 => self.upload_segment(now, command, address),
            4 => self.client_aborts(address),
            _ if self.behaviour.unknown_command_refused => Err((address, Abort::UNKNOWN_COMMAND)),
            _ => Ok(()),
        }
    }

    fn client_aborts(&mut self, address: Address) -> Result<(), Refusal> {
        match self.behaviour.sdo.client_abort {
            ClientAbort::Obeyed => {
                self.forget_segments();
                self.sdo.transfer = Transfer::None;
                Ok(())
            }
            ClientAbort::Ignored => Ok(()),
            ClientAbort::Refused => Err((address, Abort::UNKNOWN_COMMAND)),
        }
    }

    pub(super) fn abort(&mut self, now: Instant, address: Address, abort: Abort) {
        if self.behaviour.sdo.own_abort_final {
            self.forget_segments();
            self.sdo.transfer = Transfer::None;
        }
        let [_, r0, r1, r2, ..] = self.sdo.request;
        let named = match self.behaviour.abort_multiplexer {
            AbortMultiplexer::OfRequest => address,
            AbortMultiplexer::OfFrame => Address::from_multiplexer([r0, r1, r2]),
            AbortMultiplexer::NextIndex => {
                Address::new(address.index().wrapping_add(1), address.sub())
            }
        };
        let codes = self.behaviour.abort_codes.iter();
        let code = codes.fold(
            abort.0,
            |code, (meant, said)| {
                if abort.0 == *meant { *said } else { code }
            },
        );
        let [m0, m1, m2] = named.multiplexer();
        let [c0, c1, c2, c3] = code.to_le_bytes();
        self.respond(now, [0x80, m0, m1, m2, c0, c1, c2, c3]);
    }

    pub(super) fn respond(&mut self, now: Instant, response: [u8; 8]) {
        self.respond_from(now, self.node, response);
    }

    pub(super) fn respond_from(&mut self, now: Instant, node: u8, response: [u8; 8]) {
        self.sdo.answered = self.sdo.answered.wrapping_add(1);
        let each = self.behaviour.sdo.late_each;
        let late = each.is_some_and(|each| self.sdo.answered.is_multiple_of(each));
        let extra = if late { LATE } else { Duration::ZERO };
        let at = now + self.turnaround() + extra;
        self.respond_at(at, node, response);
    }

    /// The identifier of this server's answers.
    fn answers_from(&self, node: u8) -> StandardId {
        identifier(self.sdo.answers_on.unwrap_or(0x580 + u16::from(node)))
    }

    fn respond_at(&mut self, at: Instant, node: u8, response: [u8; 8]) {
        let identifier = self.answers_from(node);
        let mut frame = Frame::of_eight(identifier, response);
        if !self.behaviour.sdo.padded {
            let used = response.iter().rposition(|byte| *byte != 0);
            let bytes = response.get(..=used.unwrap_or(0)).unwrap_or(&response);
            frame = Frame::data(identifier, bytes).unwrap_or(frame);
        }
        self.queue.push(at, Service::Sdo, frame);
    }
}

fn is_mapping_entry(address: Address) -> bool {
    address.sub() != 0 && Parameter::of(address.index()) == Some(Parameter::Mapping)
}
