//! Downloads, expedited and segmented.

use fieldproof_link::Instant;

use super::block::END;
use super::{LONGEST_VALUE, ReadOnly, Refusal, SEGMENT, StraySegment, Transfer, is_mapping_entry};
use crate::canopen::{Abort, Address, Application, Slave};

impl Slave {
    /// | bits of byte 0 | hold |
    /// | --- | --- |
    /// | 2, 3 | data bytes without data, if expedited and sized |
    /// | 1 | expedited |
    /// | 0 | the size is given |
    pub(super) fn initiate_download(
        &mut self,
        now: Instant,
        command: u8,
        address: Address,
        data: [u8; 4],
        application: &mut dyn Application,
    ) -> Result<(), Refusal> {
        let refused = |abort| (address, abort);
        self.forget_segments();
        self.sdo.transfer = Transfer::None;
        let sized = command & 0x01 != 0;
        if !sized && !self.behaviour.sdo.unsized_taken {
            return Err(refused(Abort::UNKNOWN_COMMAND));
        }
        if command & 0x02 == 0 {
            let size = sized.then(|| u32::from_le_bytes(data) as usize);
            let (_, fixed) = self.check_download(address, size).map_err(refused)?;
            let small = fixed.is_some_and(|fixed| fixed <= 4);
            if small && !self.behaviour.sdo.small_segmented_taken {
                return Err(refused(Abort::UNKNOWN_COMMAND));
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
        let (slot, fixed) = self.check_download(address, None).map_err(refused)?;
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

    /// The slot and the size of an object that may be written, and with that many bytes, as far as can be said before
    /// they come.
    pub(super) fn check_download(
        &self,
        address: Address,
        size: Option<usize>,
    ) -> Result<(usize, Option<usize>), Abort> {
        let slot = self.objects.find(address)?;
        let settings = &self.behaviour.sdo;
        let refuses = settings.read_only == ReadOnly::Refused;
        let object = self.objects.at(slot);
        let object = object.filter(|object| object.writable || !refuses);
        let fixed = object.ok_or(Abort::READ_ONLY)?.size();
        match size.filter(|_| settings.length_checked) {
            Some(size) if size > fixed.unwrap_or(LONGEST_VALUE) => Err(Abort::TOO_LONG),
            Some(size) if fixed.is_some_and(|fixed| size < fixed) => Err(Abort::TOO_SHORT),
            _ => Ok((slot, fixed)),
        }
    }

    pub(super) fn download_segment(
        &mut self,
        now: Instant,
        request: &[u8; 8],
        application: &mut dyn Application,
    ) -> Result<(), Refusal> {
        let [command, m0, m1, m2, ..] = *request;
        let Transfer::Download {
            address,
            size,
            toggle,
        } = self.sdo.transfer
        else {
            return self.stray_download_segment(now, command, [m0, m1, m2]);
        };
        let refused = |abort| (address, abort);
        let settings = &self.behaviour.sdo;
        let (obeys_unused, checks_size) = (settings.unused_obeyed, settings.size_checked);
        let toggle = if settings.download_toggle_checked {
            toggle
        } else {
            command & 0x10 != 0
        };
        if (command & 0x10 != 0) != toggle {
            return Err(refused(Abort::TOGGLE));
        }
        let slot = self.objects.find(address).map_err(refused)?;
        let fixed = self.objects.at(slot).and_then(|object| object.size());
        let [_, data @ ..] = request;
        let unused = usize::from(command >> 1 & 0x07);
        let used = if obeys_unused {
            SEGMENT - unused
        } else {
            SEGMENT
        };
        self.sdo.buffer.extend(data.iter().take(used));
        let longest = size.filter(|_| checks_size).or(fixed);
        let longest = longest.filter(|_| obeys_unused).unwrap_or(LONGEST_VALUE);
        if self.sdo.buffer.len() > longest {
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
        if checks_size && obeys_unused && size.is_some_and(|size| size != self.sdo.buffer.len()) {
            return Err(refused(Abort::LENGTH));
        }
        let value = std::mem::take(&mut self.sdo.buffer);
        let outcome = self.commit(now, answer, address, slot, &value, application);
        self.sdo.buffer = value;
        outcome
    }

    fn stray_download_segment(
        &mut self,
        now: Instant,
        command: u8,
        named: [u8; 3],
    ) -> Result<(), Refusal> {
        match self.behaviour.sdo.stray_segment {
            StraySegment::Refused => {
                Err((Address::from_multiplexer(named), Abort::UNKNOWN_COMMAND))
            }
            StraySegment::Ignored => Ok(()),
            StraySegment::Answered => {
                self.confirm_segment(now, 0x20 | command & 0x10);
                Ok(())
            }
        }
    }

    /// Writes, and answers with `command` unless the application takes its time.
    pub(super) fn commit(
        &mut self,
        now: Instant,
        command: u8,
        address: Address,
        slot: usize,
        value: &[u8],
        application: &mut dyn Application,
    ) -> Result<(), Refusal> {
        let fitted = self.fit(slot, value);
        let value = fitted.as_deref().unwrap_or(value);
        let object = self.objects.at(slot);
        if !self.behaviour.sdo.same_value_taken
            && object.is_some_and(|object| object.value() == value)
        {
            return Err((address, Abort::DEVICE_STATE));
        }
        if object.is_some_and(|object| !object.writable) {
            if self.behaviour.sdo.read_only == ReadOnly::Written {
                self.objects.set(address, value);
            }
            self.confirm(now, command, address, [0; 4]);
            return Ok(());
        }
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

    /// `value` cut or filled up to the size of the object, if its length is not checked.
    fn fit(&self, slot: usize, value: &[u8]) -> Option<Vec<u8>> {
        let size = self.objects.at(slot)?.size()?;
        if self.behaviour.sdo.length_checked || value.len() == size {
            return None;
        }
        let mut value = value.to_vec();
        value.resize(size, 0);
        Some(value)
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
        if command == END && !self.behaviour.block.end_confirmed {
            return;
        }
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
        let mut answer = if self.behaviour.sdo.reserved_bytes_zero {
            [0; 8]
        } else {
            self.sdo.request
        };
        let [first, ..] = &mut answer;
        *first = command;
        self.respond(now, answer);
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
}
