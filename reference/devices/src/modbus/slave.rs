//! A Modbus slave around a set of registers: on a serial line, or on a connection.

use std::collections::BTreeMap;
use std::time::Duration;

use fieldproof_link::{Character, Framing, Instant, Line, SerialSettings};

use super::crc;
use super::framing::{Framer, Received};
use super::stream::{Request, StreamFramer};
use super::{Behaviour, ByteCount, EchoedValue};

const READ_HOLDING: u8 = 0x03;
const WRITE_SINGLE: u8 = 0x06;
const WRITE_MULTIPLE: u8 = 0x10;
const BROADCAST: u8 = 0;
/// Most registers of one 03h.
const MOST_READ: u16 = 125;
/// Most registers of one 10h.
const MOST_WRITTEN: u16 = 123;

/// Why a request is refused. The code that says so is a setting: [`super::ExceptionCodes`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exception {
    /// The function is not supported.
    IllegalFunction,
    /// The register does not exist or does not allow the access.
    IllegalDataAddress,
    /// The value is out of range, or the request is not built as its function has it.
    IllegalDataValue,
    /// Busy.
    DeviceBusy,
}

/// What a device makes of a request that is not one of the ordinary functions on its own address.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Command {
    /// It did what was asked, or not, and stays silent.
    Silent,
    /// It answers this: address, function and data, without CRC.
    Answer(Vec<u8>),
}

/// What a slave serves: the registers of one device, by their address on the wire (the first is 0).
pub trait Registers {
    /// The own address, 1 to 247.
    fn address(&self) -> u8;

    /// How the line is to be set.
    fn serial(&self) -> SerialSettings;

    /// The content of a register.
    ///
    /// # Errors
    /// [`Exception::IllegalDataAddress`]: there is none, or it cannot be read.
    fn read(&self, register: u16, behaviour: &Behaviour) -> Result<u16, Exception>;

    /// Whether a register takes a value.
    ///
    /// # Errors
    /// [`Exception::IllegalDataAddress`]: there is none, or it cannot be written.
    /// [`Exception::IllegalDataValue`]: not this value.
    fn check_write(&self, register: u16, value: u16) -> Result<(), Exception>;

    /// Writes a value that [`Registers::check_write`] allowed.
    fn write(&mut self, register: u16, value: u16);

    /// Takes a whole request (address, function, data; its CRC was right) before the address is looked at; `None` if it
    /// is an ordinary one.
    fn command(&mut self, request: &[u8], behaviour: &Behaviour) -> Option<Command> {
        let _ = (request, behaviour);
        None
    }

    /// From the end of the silence after a request to the answer, jitter apart.
    fn processing_delay(&self, behaviour: &Behaviour) -> Duration {
        behaviour.processing_delay
    }

    /// What a case could have left changed: names and values.
    fn state(&self) -> BTreeMap<String, String>;
}

/// A slave on one serial port. The device that owns the port passes on what arrives, wakes it when it asks, and sends
/// what it gives.
#[derive(Debug, Clone)]
pub struct ModbusSlave<R> {
    registers: R,
    behaviour: Behaviour,
    line: SerialSettings,
    framer: Framer,
    /// In place of the line and its framer, if it is at the end of a connection.
    stream: Option<StreamFramer>,
    chance: fastrand::Rng,
    reply: Option<(Instant, Vec<u8>)>,
    sending_until: Option<Instant>,
}

impl<R: Registers> ModbusSlave<R> {
    /// A slave that behaves so; `seed` fixes its jitter.
    pub fn new(registers: R, behaviour: Behaviour, seed: u64) -> ModbusSlave<R> {
        let line = registers.serial();
        ModbusSlave {
            framer: framer(line, &behaviour),
            registers,
            behaviour,
            line,
            stream: None,
            chance: fastrand::Rng::with_seed(seed),
            reply: None,
            sending_until: None,
        }
    }

    /// The same on a connection, if `framing` says how frames are told apart there.
    pub fn over(self, framing: Option<Framing>) -> ModbusSlave<R> {
        ModbusSlave {
            stream: framing.map(StreamFramer::new),
            ..self
        }
    }

    /// Its registers.
    pub fn registers(&self) -> &R {
        &self.registers
    }

    /// Its registers, to be changed from the device's other side.
    pub fn registers_mut(&mut self) -> &mut R {
        &mut self.registers
    }

    /// How its line is set now: a new bit rate is in effect once the answer that acknowledged it has left.
    pub fn line(&self) -> Line {
        match &self.stream {
            Some(stream) => Line::Stream(stream.framing()),
            None => Line::Serial(self.line),
        }
    }

    /// Forgets what it was receiving or about to send, and sets its line as the registers say: after power-on, or when a
    /// switch was set.
    pub fn restart(&mut self) {
        self.reply = None;
        self.sending_until = None;
        self.line = self.registers.serial();
        self.framer = framer(self.line, &self.behaviour);
        self.stream = self.stream.take().map(|it| StreamFramer::new(it.framing()));
    }

    /// `character` ended at `now`. While it has an answer to send it does not listen, and what it heard only the end of
    /// is no frame. On a connection requests wait for their turn.
    pub fn receive(&mut self, now: Instant, character: Character) {
        if let Some(stream) = &mut self.stream {
            stream.receive(now, character);
            return;
        }
        let heard = Character {
            spoilt: character.spoilt || self.is_busy(now),
            ..character
        };
        self.framer.receive(now, heard);
    }

    /// When it wants to be woken.
    pub fn wake_at(&self) -> Option<Instant> {
        let reply = self.reply.as_ref().map(|(at, _)| *at);
        if let Some(stream) = &self.stream {
            return reply.or_else(|| stream.wake_at());
        }
        [self.framer.wake_at(), reply, self.sending_until]
            .into_iter()
            .flatten()
            .min()
    }

    /// The instant it asked for has come; what it sends, if anything.
    pub fn wake(&mut self, now: Instant) -> Option<Vec<Character>> {
        if self.stream.is_some() {
            return self.wake_on_connection(now);
        }
        self.sending_until.take_if(|until| *until <= now);
        let answer = self
            .framer
            .wake(now)
            .and_then(|received| self.answer(&received));
        if let Some(frame) = answer {
            self.reply = Some((now + self.delay(), frame));
        }
        if !self.is_busy(now) {
            self.set_line();
        }
        let (_, frame) = self.reply.take_if(|(at, _)| *at <= now)?;
        let length = u32::try_from(frame.len()).unwrap_or(u32::MAX);
        self.sending_until = Some(now + self.line.character_time() * length);
        Some(frame.into_iter().map(Character::new).collect())
    }

    /// One request after the other.
    fn wake_on_connection(&mut self, now: Instant) -> Option<Vec<Character>> {
        if self.reply.is_none() {
            let request = self.stream.as_mut()?.wake(now)?;
            let answer = self.answer_request(&request)?;
            self.reply = Some((now + self.delay(), answer));
        }
        let (_, frame) = self.reply.take_if(|(at, _)| *at <= now)?;
        Some(frame.into_iter().map(Character::new).collect())
    }

    /// Whether an answer is to come or on its way.
    fn is_busy(&self, now: Instant) -> bool {
        self.reply.is_some() || self.sending_until.is_some_and(|until| now < until)
    }

    /// Sets the line as the registers have it.
    fn set_line(&mut self) {
        if self.line != self.registers.serial() {
            self.line = self.registers.serial();
            self.framer = framer(self.line, &self.behaviour);
        }
    }

    fn delay(&mut self) -> Duration {
        if self.behaviour.replies_before_silence {
            return Duration::ZERO;
        }
        let jitter = u64::try_from(self.behaviour.processing_jitter.as_nanos()).unwrap_or(0);
        let delay = self.registers.processing_delay(&self.behaviour);
        delay + Duration::from_nanos(self.chance.u64(0..=jitter))
    }

    /// Does what a frame asks; the whole answer, if there is one.
    fn answer(&mut self, received: &Received) -> Option<Vec<u8>> {
        let (request, intact) = crc::split(&received.bytes)?;
        if received.flawed || !(intact || self.behaviour.stale_crc_accepted) {
            return None;
        }
        let body = self.answer_body(request)?;
        Some(crc::with_crc(body, self.behaviour.crc_order))
    }

    /// The same on a connection.
    fn answer_request(&mut self, request: &Request) -> Option<Vec<u8>> {
        if !(request.intact || self.behaviour.stale_crc_accepted) {
            return None;
        }
        let body = self.answer_body(&request.body)?;
        Some(request.answered(body, self.behaviour.crc_order))
    }

    /// Address, function and data of the answer.
    fn answer_body(&mut self, request: &[u8]) -> Option<Vec<u8>> {
        match self.registers.command(request, &self.behaviour) {
            Some(Command::Silent) => None,
            Some(Command::Answer(body)) => Some(body),
            None => self.ordinary_answer(request),
        }
    }

    /// The answer to a request on the own address or to all, without its CRC.
    fn ordinary_answer(&mut self, request: &[u8]) -> Option<Vec<u8>> {
        let (&address, pdu) = request.split_first()?;
        let own_address = self.registers.address();
        let others = self.behaviour.other_addresses_answered;
        if address != BROADCAST && address != own_address && !others {
            return None;
        }
        let (function, data) = match pdu.split_first() {
            Some((&function, data)) => (function, data),
            None if self.behaviour.bare_address_answered => (0, pdu),
            None => return None,
        };
        let outcome = self.execute(function, data);
        if address == BROADCAST && !self.behaviour.broadcast_answered {
            return None;
        }
        let mut answer = vec![own_address];
        match outcome {
            Ok(data) => {
                answer.push(function);
                answer.extend(data);
            }
            Err(exception) => {
                let bit = u8::from(self.behaviour.exception_bit_set) << 7;
                answer.extend([function | bit, self.code(exception)]);
            }
        }
        Some(answer)
    }

    fn code(&self, exception: Exception) -> u8 {
        let codes = self.behaviour.exception_codes;
        match exception {
            Exception::IllegalFunction => codes.illegal_function,
            Exception::IllegalDataAddress => codes.illegal_data_address,
            Exception::IllegalDataValue => codes.illegal_data_value,
            Exception::DeviceBusy => codes.device_busy,
        }
    }

    /// The data of the answer, after the function code.
    fn execute(&mut self, function: u8, data: &[u8]) -> Result<Vec<u8>, Exception> {
        match function {
            READ_HOLDING => self.read_holding(data),
            WRITE_SINGLE => self.write_single(data),
            WRITE_MULTIPLE => self.write_multiple(data),
            _ => Err(Exception::IllegalFunction),
        }
    }

    /// Start and quantity; answered by a byte count and the registers.
    fn read_holding(&self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        let &[start_high, start_low, quantity_high, quantity_low] = data else {
            return Err(Exception::IllegalDataValue);
        };
        let quantity = u16::from_be_bytes([quantity_high, quantity_low]);
        if !(1..=MOST_READ).contains(&quantity) {
            return Err(Exception::IllegalDataValue);
        }
        let start = u16::from_be_bytes([start_high, start_low]);
        let last = last_register(start, quantity)?;
        let count = match self.behaviour.byte_count {
            ByteCount::Bytes => 2 * quantity,
            ByteCount::Registers => quantity,
        };
        // At most 250, so the low byte is all of it.
        let mut answer = vec![count.to_be_bytes()[1]];
        for register in start..=last {
            answer.extend(
                self.registers
                    .read(register, &self.behaviour)?
                    .to_be_bytes(),
            );
        }
        Ok(answer)
    }

    /// Register and value; answered by the same.
    fn write_single(&mut self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        let &[register_high, register_low, value_high, value_low] = data else {
            return Err(Exception::IllegalDataValue);
        };
        let register = u16::from_be_bytes([register_high, register_low]);
        let value = u16::from_be_bytes([value_high, value_low]);
        self.registers.check_write(register, value)?;
        self.registers.write(register, value);
        let echoed = match self.behaviour.echoed_value {
            EchoedValue::Written => value,
            EchoedValue::OneMore => value.wrapping_add(1),
        };
        Ok([register.to_be_bytes(), echoed.to_be_bytes()].concat())
    }

    /// Start, quantity, byte count, values; answered by start and quantity. Writes all or none.
    fn write_multiple(&mut self, data: &[u8]) -> Result<Vec<u8>, Exception> {
        let Some((
            &[
                start_high,
                start_low,
                quantity_high,
                quantity_low,
                byte_count,
            ],
            bytes,
        )) = data.split_first_chunk::<5>()
        else {
            return Err(Exception::IllegalDataValue);
        };
        let quantity = u16::from_be_bytes([quantity_high, quantity_low]);
        if !(1..=MOST_WRITTEN).contains(&quantity)
            || u16::from(byte_count) != 2 * quantity
            || bytes.len() != usize::from(byte_count)
        {
            return Err(Exception::IllegalDataValue);
        }
        let start = u16::from_be_bytes([start_high, start_low]);
        let last = last_register(start, quantity)?;
        let (pairs, _) = bytes.as_chunks::<2>();
        let values = pairs.iter().map(|pair| u16::from_be_bytes(*pair));
        for (register, value) in (start..=last).zip(values.clone()) {
            self.registers.check_write(register, value)?;
        }
        let written = (start..=last).zip(values).take(self.behaviour.most_written);
        for (register, value) in written {
            self.registers.write(register, value);
        }
        Ok([start.to_be_bytes(), quantity.to_be_bytes()].concat())
    }
}

fn framer(line: SerialSettings, behaviour: &Behaviour) -> Framer {
    if behaviour.replies_before_silence {
        Framer::hasty(line)
    } else {
        Framer::new(line)
    }
}

fn last_register(start: u16, quantity: u16) -> Result<u16, Exception> {
    start
        .checked_add(quantity.saturating_sub(1))
        .ok_or(Exception::IllegalDataAddress)
}
