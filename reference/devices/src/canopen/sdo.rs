//! The SDO server: expedited and segmented transfers.

use fieldproof_can::Frame;
use fieldproof_link::Instant;

use super::pdo_rules::Parameter;
use super::queue::{Service, identifier};
use super::{Abort, AbortMultiplexer, Address, Answer, Application, Slave};

/// The longest value of an object without a fixed size.
const LONGEST_VALUE: usize = 1024;
/// Data bytes of a segment.
const SEGMENT: usize = 7;

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
}

impl Server {
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

    fn initiate_upload(
        &mut self,
        now: Instant,
        address: Address,
        application: &mut dyn Application,
    ) -> Result<(), (Address, Abort)> {
        let refused = |abort| (address, abort);
        self.sdo.transfer = Transfer::None;
        let slot = self.objects.find(address).map_err(refused)?;
        if self.objects.at(slot).is_none_or(|object| !object.readable) {
            return Err(refused(Abort::WRITE_ONLY));
        }
        match application.reading(address) {
            Answer::Now => self.answer_upload(now, address, slot),
            Answer::Refused(abort) => return Err(refused(abort)),
            Answer::Later => self.sdo.transfer = Transfer::Reading(address),
        }
        Ok(())
    }

    fn answer_upload(&mut self, now: Instant, address: Address, slot: usize) {
        let before = self.sdo.before.as_ref();
        let before = before.filter(|(written, _)| *written == address);
        let value = match (before, self.objects.at(slot)) {
            (Some((_, value)), _) => value.as_slice(),
            (None, Some(object)) => object.value(),
            (None, None) => return,
        };
        let mut response = [0; 8];
        let [command, m0, m1, m2, data @ ..] = &mut response;
        [*m0, *m1, *m2] = address.multiplexer();
        if (1..=4).contains(&value.len()) {
            data.iter_mut()
                .zip(value)
                .for_each(|(to, from)| *to = *from);
            let reversed = self.behaviour.upload_big_endian
                || (self.behaviour.mapping_entry_big_endian && is_mapping_entry(address));
            if let Some(number) = data.get_mut(..value.len()).filter(|_| reversed) {
                number.reverse();
            }
            let size = match value.len() {
                size if !self.behaviour.expedited_size_off_by_one => size,
                4 => 3,
                size => size + 1,
            };
            *command = 0x43 | ((4 - size) << 2).to_le_bytes()[0];
        } else {
            *command = 0x41;
            let [s0, s1, ..] = value.len().to_le_bytes();
            *data = [s0, s1, 0, 0];
            self.sdo.buffer.clear();
            self.sdo.buffer.extend_from_slice(value);
            self.sdo.transfer = Transfer::Upload {
                address,
                offset: 0,
                toggle: false,
            };
        }
        self.respond(now, response);
    }

    /// | bits of byte 0 | hold |
    /// | --- | --- |
    /// | 4 | toggle |
    /// | 1 to 3 | in the answer: data bytes without data |
    /// | 0 | in the answer: this was the last segment |
    fn upload_segment(
        &mut self,
        now: Instant,
        command: u8,
        named: Address,
    ) -> Result<(), (Address, Abort)> {
        let Transfer::Upload {
            address,
            offset,
            toggle,
        } = self.sdo.transfer
        else {
            return Err((named, Abort::UNKNOWN_COMMAND));
        };
        if (command & 0x10 != 0) != toggle {
            return Err((address, Abort::TOGGLE));
        }
        let rest = self.sdo.buffer.get(offset..).unwrap_or_default();
        let size = rest.len().min(SEGMENT);
        let last = rest.len() <= SEGMENT;
        let mut response = [0; 8];
        let [first, data @ ..] = &mut response;
        data.iter_mut().zip(rest).for_each(|(to, from)| *to = *from);
        let shown = toggle && self.behaviour.toggle_alternates;
        let unused = (SEGMENT - size).to_le_bytes()[0];
        *first = u8::from(shown) << 4 | unused << 1 | u8::from(last);
        self.sdo.transfer = if last {
            Transfer::None
        } else {
            Transfer::Upload {
                address,
                offset: offset + size,
                toggle: !toggle,
            }
        };
        self.respond(now, response);
        Ok(())
    }

    /// | bits of byte 0 | hold |
    /// | --- | --- |
    /// | 2, 3 | data bytes without data, if expedited and sized |
    /// | 1 | expedited |
    /// | 0 | the size is given |
    fn initiate_download(
        &mut self,
        now: Instant,
        command: u8,
        address: Address,
        data: [u8; 4],
        application: &mut dyn Application,
    ) -> Result<(), (Address, Abort)> {
        let refused = |abort| (address, abort);
        self.sdo.transfer = Transfer::None;
        let slot = self.objects.find(address).map_err(refused)?;
        let Some(object) = self.objects.at(slot).filter(|object| object.writable) else {
            return Err(refused(Abort::READ_ONLY));
        };
        let fixed = object.size();
        let sized = command & 0x01 != 0;
        if command & 0x02 == 0 {
            let size = sized.then(|| u32::from_le_bytes(data) as usize);
            let longest = fixed.unwrap_or(LONGEST_VALUE);
            match size {
                Some(size) if size > longest => return Err(refused(Abort::TOO_LONG)),
                Some(size) if fixed.is_some_and(|fixed| size < fixed) => {
                    return Err(refused(Abort::TOO_SHORT));
                }
                _ => {}
            }
            self.sdo.buffer.clear();
            self.sdo.transfer = Transfer::Download {
                address,
                size,
                toggle: false,
            };
            self.confirm(now, 0x60, address, [0; 4]);
            return Ok(());
        }
        let size = if sized {
            4 - usize::from(command >> 2 & 0x03)
        } else {
            fixed.unwrap_or(4).min(4)
        };
        let mut data = data;
        if self.behaviour.mapping_entry_big_endian && is_mapping_entry(address) {
            data.reverse();
        }
        let value = data.get(..size).unwrap_or(&data);
        self.commit(now, 0x60, address, slot, value, application)
    }

    fn download_segment(
        &mut self,
        now: Instant,
        request: &[u8; 8],
        application: &mut dyn Application,
    ) -> Result<(), (Address, Abort)> {
        let [command, m0, m1, m2, ..] = *request;
        let Transfer::Download {
            address,
            size,
            toggle,
        } = self.sdo.transfer
        else {
            let named = Address::from_multiplexer([m0, m1, m2]);
            return Err((named, Abort::UNKNOWN_COMMAND));
        };
        let refused = |abort| (address, abort);
        if (command & 0x10 != 0) != toggle {
            return Err(refused(Abort::TOGGLE));
        }
        let slot = self.objects.find(address).map_err(refused)?;
        let fixed = self.objects.at(slot).and_then(|object| object.size());
        let [_, data @ ..] = request;
        let used = SEGMENT - usize::from(command >> 1 & 0x07);
        self.sdo.buffer.extend(data.iter().take(used));
        if self.sdo.buffer.len() > size.or(fixed).unwrap_or(LONGEST_VALUE) {
            return Err(refused(Abort::TOO_LONG));
        }
        let answer = 0x20 | u8::from(toggle) << 4;
        if command & 0x01 == 0 {
            self.sdo.transfer = Transfer::Download {
                address,
                size,
                toggle: !toggle,
            };
            self.confirm_segment(now, answer);
            return Ok(());
        }
        self.sdo.transfer = Transfer::None;
        if size.is_some_and(|size| size != self.sdo.buffer.len()) {
            return Err(refused(Abort::LENGTH));
        }
        let value = std::mem::take(&mut self.sdo.buffer);
        let outcome = self.commit(now, answer, address, slot, &value, application);
        self.sdo.buffer = value;
        outcome
    }

    /// Writes, and answers with `command` unless the application takes its time.
    fn commit(
        &mut self,
        now: Instant,
        command: u8,
        address: Address,
        slot: usize,
        value: &[u8],
        application: &mut dyn Application,
    ) -> Result<(), (Address, Abort)> {
        if self.behaviour.upload_lags_download {
            let before = self.objects.at(slot).map(|object| object.value().to_vec());
            self.sdo.before = before.map(|before| (address, before));
        }
        let node = self.node;
        let done = self
            .write(now, address, slot, value, application)
            .map_err(|abort| (address, abort))?;
        if !done {
            self.sdo.buffer.clear();
            self.sdo.buffer.extend_from_slice(value);
            self.sdo.transfer = Transfer::Writing { address, command };
            return Ok(());
        }
        let mut echo = [0; 4];
        echo.iter_mut()
            .zip(value)
            .for_each(|(to, from)| *to = *from);
        self.confirm_from(now, node, command, address, echo);
        Ok(())
    }

    fn confirm(&mut self, now: Instant, command: u8, address: Address, echo: [u8; 4]) {
        self.confirm_from(now, self.node, command, address, echo);
    }

    /// The answer to a download comes from the node that it was sent to.
    fn confirm_from(
        &mut self,
        now: Instant,
        node: u8,
        command: u8,
        address: Address,
        echo: [u8; 4],
    ) {
        if command != 0x60 {
            return self.confirm_segment(now, command);
        }
        if !self.behaviour.download_confirmed {
            return;
        }
        let [m0, m1, m2] = address.multiplexer();
        let [e0, e1, e2, e3] = if self.behaviour.echo_download_data {
            echo
        } else {
            [0; 4]
        };
        self.respond_from(now, node, [command, m0, m1, m2, e0, e1, e2, e3]);
    }

    fn confirm_segment(&mut self, now: Instant, command: u8) {
        self.respond(now, [command, 0, 0, 0, 0, 0, 0, 0]);
    }

    /// The application has read `address`.
    pub(crate) fn finish_upload(
        &mut self,
        now: Instant,
        address: Address,
        outcome: Result<&[u8], Abort>,
    ) {
        if let Ok(value) = outcome {
            self.objects.set(address, value);
        }
        if self.sdo.transfer != Transfer::Reading(address) {
            return;
        }
        self.sdo.transfer = Transfer::None;
        match (outcome, self.objects.find(address)) {
            (Ok(_), Ok(slot)) => self.answer_upload(now, address, slot),
            (Err(abort), _) | (_, Err(abort)) => self.abort(now, address, abort),
        }
    }

    /// The application has written what was to be written to `address`.
    pub(crate) fn finish_download(
        &mut self,
        now: Instant,
        address: Address,
        outcome: Result<(), Abort>,
    ) {
        let Transfer::Writing {
            address: awaited,
            command,
        } = self.sdo.transfer
        else {
            return;
        };
        if awaited != address {
            return;
        }
        self.sdo.transfer = Transfer::None;
        match outcome {
            Ok(()) => self.confirm(now, command, address, [0; 4]),
            Err(abort) => self.abort(now, address, abort),
        }
    }

    fn abort(&mut self, now: Instant, address: Address, abort: Abort) {
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

    fn respond(&mut self, now: Instant, response: [u8; 8]) {
        self.respond_from(now, self.node, response);
    }

    fn respond_from(&mut self, now: Instant, node: u8, response: [u8; 8]) {
        let at = now + self.turnaround();
        let identifier = identifier(0x580 + u16::from(node));
        self.queue
            .push(at, Service::Sdo, Frame::of_eight(identifier, response));
    }
}

fn is_mapping_entry(address: Address) -> bool {
    address.sub() != 0 && Parameter::of(address.index()) == Some(Parameter::Mapping)
}
