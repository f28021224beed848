//! What the functions do: the data of a request in, the data of its answer out.

mod bits;
mod diagnostics;
mod files;
mod identification;
mod registers;

use super::counters::Counters;
use super::{Behaviour, Departure, Exception, Registers};

/// Functions that exist on serial lines only.
const SERIAL_LINE_ONLY: [u8; 5] = [0x07, 0x08, 0x0B, 0x0C, 0x11];
/// What only fetches the event counter is not counted as an event.
const FETCHES: [u8; 2] = [0x0B, 0x0C];

/// Whatever keeps a device from doing anything keeps it from one of these.
const ANY_CONDITION: [u8; 2] = [0x06, 0x14];

/// What came of a request.
pub(super) enum Outcome {
    /// The data of the answer, or why there is none but an exception.
    Answer(Result<Vec<u8>, Exception>),
    /// Nothing is answered.
    Silence,
}

/// A slave while it does what a request asks.
pub(super) struct Service<'a, R> {
    pub(super) registers: &'a mut R,
    pub(super) behaviour: &'a Behaviour,
    pub(super) counters: &'a mut Counters,
    /// Whether it is at the end of a Modbus TCP connection.
    pub(super) over_tcp: bool,
    /// What the register of a [`super::RegisterFault`] held before anybody wrote it.
    pub(super) first_value: Option<u16>,
}

impl<R: Registers> Service<'_, R> {
    /// Does what a function asks.
    pub(super) fn serve(&mut self, function: u8, data: &[u8]) -> Outcome {
        if self.counters.listens_only {
            return self.listen(function, data);
        }
        let filled = [data, &[0; 4]].concat();
        let is_short = data.len() < 4 && (0x01..=0x06).contains(&function);
        let data = match is_short && self.behaviour.departs(Departure::ShortPduFilled) {
            true => &filled[..4],
            false => data,
        };
        let outcome = self.execute(function, data);
        if !self.counters.listens_only {
            let counts = !FETCHES.contains(&function) || self.behaviour.fetches_count_as_events;
            self.counters.done(outcome.as_ref().err().copied(), counts);
            if outcome.is_err() && self.behaviour.departs(Departure::RefusalsCountAsEvents) {
                self.counters.events = self.counters.events.wrapping_add(1);
            }
        }
        let is_listening = self.counters.listens_only && outcome.is_ok();
        match is_listening && !self.behaviour.listen_only_answered {
            true => Outcome::Silence,
            false => Outcome::Answer(outcome),
        }
    }

    /// Only the restart is done, and it is not answered.
    fn listen(&mut self, function: u8, data: &[u8]) -> Outcome {
        const RESTART: [u8; 3] = [0x08, 0x00, 0x01];
        let restart = [&[function], data].concat().starts_with(&RESTART);
        if self.behaviour.listen_only_answered {
            return Outcome::Answer(self.execute(function, data));
        }
        if restart && !self.behaviour.restart_keeps_listening {
            // A restart with a wrong value is none.
            let _ = self.execute(function, data);
        }
        Outcome::Silence
    }

    fn execute(&mut self, function: u8, data: &[u8]) -> Result<Vec<u8>, Exception> {
        let serial_only = self.over_tcp && SERIAL_LINE_ONLY.contains(&function);
        if serial_only || !self.registers.functions().contains(&function) {
            return Err(Exception::IllegalFunction);
        }
        let for_all = self.behaviour.departs(Departure::ConditionsForAll);
        let unable = self.registers.unable(function);
        let unable = unable.or_else(|| {
            let others = ANY_CONDITION.iter().filter(|_| for_all);
            others.filter_map(|it| self.registers.unable(*it)).next()
        });
        if let Some(exception) = unable
            && !self.behaviour.departs(Departure::ConditionsIgnored)
        {
            return Err(exception);
        }
        match function {
            0x01 => self.read_coils(data),
            0x02 => self.read_discrete_inputs(data),
            0x03 => self.read_holding(data),
            0x04 => self.read_input(data),
            0x05 => self.write_coil(data),
            0x06 => self.write_single(data),
            0x07 => self.exception_status(data),
            0x08 => self.diagnostics(data),
            0x0B => self.event_counter(data),
            0x0C => self.event_log(data),
            0x0F => self.write_coils(data),
            0x10 => self.write_multiple(data),
            0x11 => self.server_id(data),
            0x14 => self.read_files(data),
            0x15 => self.write_files(data),
            0x16 => self.mask_write(data),
            0x17 => self.read_write(data),
            0x18 => self.read_fifo(data),
            0x2B => self.encapsulated(data),
            _ => Err(Exception::IllegalFunction),
        }
    }

    /// The addresses that a request names, once their number is known to be allowed.
    fn extent(&self, start: u16, quantity: u16, most: u16) -> Result<Extent, Exception> {
        let allowed = (1..=most).contains(&quantity)
            || (quantity == 0 && self.behaviour.zero_quantity_allowed)
            || (quantity > most && self.behaviour.excess_quantity_allowed);
        let reaches = u32::from(start) + u32::from(quantity) <= 0x1_0000;
        let too_far = !reaches && !self.behaviour.addresses_wrap;
        if self.behaviour.address_before_quantity && too_far {
            return Err(Exception::IllegalDataAddress);
        }
        if !allowed {
            return Err(Exception::IllegalDataValue);
        }
        if too_far {
            return Err(Exception::IllegalDataAddress);
        }
        self.departing_extent(start, quantity, most)?;
        let start = match self.behaviour.departs(Departure::AddressesFromOne) {
            true => start.saturating_add(1),
            false => start,
        };
        Ok(Extent { start, quantity })
    }
}

/// A small buffer has room for so many registers, or for eight times as many bits.
const SMALL_BUFFER: u16 = 64;
/// More than the most registers of any request.
const MOST_REGISTERS: u16 = 125;

impl<R: Registers> Service<'_, R> {
    /// What a departing slave refuses beside.
    fn departing_extent(&self, start: u16, quantity: u16, most: u16) -> Result<(), Exception> {
        let room = match most > MOST_REGISTERS {
            true => 8 * SMALL_BUFFER,
            false => SMALL_BUFFER,
        };
        let is_large = quantity > room;
        if is_large && self.behaviour.departs(Departure::LargeRequestsRefused) {
            return Err(Exception::IllegalDataValue);
        }
        let reaches_last = u32::from(start) + u32::from(quantity) == 0x1_0000;
        if reaches_last && self.behaviour.departs(Departure::LastAddressRefused) {
            return Err(Exception::IllegalDataAddress);
        }
        Ok(())
    }
}

/// Addresses one after the other.
#[derive(Clone, Copy)]
struct Extent {
    start: u16,
    quantity: u16,
}

impl Extent {
    fn addresses(self) -> impl Iterator<Item = u16> {
        (0..self.quantity).map(move |offset| self.start.wrapping_add(offset))
    }
}

/// Two numbers and nothing more.
fn two_words(data: &[u8]) -> Result<[u16; 2], Exception> {
    match data {
        &[a, b, c, d] => Ok([u16::from_be_bytes([a, b]), u16::from_be_bytes([c, d])]),
        _ => Err(Exception::IllegalDataValue),
    }
}

/// A byte count before the bytes it counts; what does not fit one byte is cut as a device's arithmetic would cut it.
fn counted(bytes: Vec<u8>) -> Vec<u8> {
    let [_, count] = u16::try_from(bytes.len()).unwrap_or(u16::MAX).to_be_bytes();
    let mut answer = vec![count];
    answer.extend(bytes);
    answer
}
