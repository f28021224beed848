//! A Modbus slave around a set of registers: on a serial line, or on a connection.

use std::time::Duration;

use fieldproof_link::{
    Character, Framing, Instant, Line, Reception, SerialSettings, State, Transmission,
};

use super::counters::Counters;
use super::crc;
use super::framing::{Framer, LONGEST_FRAME, Received};
use super::functions::{Outcome, Service};
use super::stream::{Request, StreamFramer};
use super::tcp_side::{self, TcpSide};
use super::{Behaviour, Command, Departure, Exception, RegisterFault, Registers};

const BROADCAST: u8 = 0;
/// [`Departure::RestsAfterAnswer`]
const REST: Duration = Duration::from_millis(10);

/// A slave on one serial port. The device that owns the port passes on what arrives, wakes it when it asks, and sends
/// what it gives.
#[derive(Debug, Clone)]
pub struct ModbusSlave<R> {
    registers: R,
    behaviour: Behaviour,
    counters: Counters,
    line: SerialSettings,
    framer: Framer,
    /// In place of the line and its framer, if it is at the end of a connection.
    stream: Option<StreamFramer>,
    /// Beside the line.
    tcp: TcpSide,
    chance: fastrand::Rng,
    reply: Option<(Instant, Vec<u8>)>,
    sending_until: Option<Instant>,
    /// What the register of a [`super::RegisterFault`] held before anybody wrote it.
    first_value: Option<u16>,
    /// It does not hear the next frame.
    is_deaf: bool,
    /// It hears nothing whole until then.
    rests_until: Option<Instant>,
}

impl<R: Registers> ModbusSlave<R> {
    /// A slave that behaves so; `seed` fixes its jitter.
    pub fn new(registers: R, behaviour: Behaviour, seed: u64) -> ModbusSlave<R> {
        let line = registers.serial();
        let spoilt = behaviour.register_fault.map(RegisterFault::address);
        let first_value = spoilt.and_then(|it| registers.read(it, &behaviour).ok());
        ModbusSlave {
            first_value,
            framer: framer(line, &behaviour),
            registers,
            behaviour,
            counters: Counters::default(),
            line,
            stream: None,
            tcp: TcpSide::default(),
            chance: fastrand::Rng::with_seed(seed),
            reply: None,
            sending_until: None,
            is_deaf: false,
            rests_until: None,
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

    /// Whether it departs so.
    pub(crate) fn departs(&self, departure: Departure) -> bool {
        self.behaviour.departs(departure)
    }

    /// How its line is set now: a new bit rate is in effect once the answer that acknowledged it has left.
    pub fn line(&self) -> Line {
        match &self.stream {
            Some(stream) => Line::Stream(stream.framing()),
            None => Line::Serial(self.line),
        }
    }

    /// What a case could have left changed, the line apart.
    pub fn state(&self) -> State {
        let mut state = self.registers.state();
        let listens = self.counters.listens_only;
        state.insert("modbus listens only", listens);
        state
    }

    /// Forgets what it was receiving or about to send, and sets its line as the registers say: after power-on, or when a
    /// switch was set.
    pub fn restart(&mut self) {
        self.reply = None;
        self.sending_until = None;
        self.tcp.restart();
        self.counters = Counters::default();
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
        let rests = self.rests_until.is_some_and(|until| now < until);
        let heard = Character {
            spoilt: character.spoilt && !self.behaviour.parity_ignored
                || self.is_busy(now)
                || rests,
            ..character
        };
        self.framer.receive(now, heard);
    }

    /// Something came over the connection of Modbus TCP at `port`.
    pub fn receive_over_tcp(&mut self, now: Instant, port: usize, what: Reception) {
        self.tcp.receive(now, port, what, &self.behaviour);
    }

    /// When it wants to be woken by [`ModbusSlave::wake_tcp`].
    pub fn wake_tcp_at(&self) -> Option<Instant> {
        self.tcp.wake_at(&self.behaviour)
    }

    /// What it sends over a connection of Modbus TCP, if anything.
    pub fn wake_tcp(&mut self, now: Instant) -> Option<(usize, Transmission)> {
        if let Some(port) = self.tcp.take_ended() {
            return Some((port, Transmission::Close));
        }
        if let Some(request) = self.tcp.next_request(&self.behaviour)
            && let Some(body) = self.answer_body(tcp_side::body(&request.1), true)
        {
            let at = now + self.delay();
            self.tcp.answer(at, request, body, &self.behaviour);
        }
        let (port, frame) = self.tcp.due(now)?;
        Some((port, Transmission::bytes(&frame)))
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
        let until = now + self.line.character_time() * length;
        self.sending_until = Some(until);
        if self.behaviour.departs(Departure::RestsAfterAnswer) {
            self.rests_until = Some(until + REST);
        }
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
        let was_deaf = self.is_deaf;
        self.is_deaf = !was_deaf && self.deafens(received);
        if was_deaf {
            return None;
        }
        let whole = crc::split(&received.bytes).filter(|(request, _)| !request.is_empty());
        let intact = whole.is_some_and(|(request, intact)| {
            intact || self.behaviour.crc_half_checked && crc::half_right(request, &received.bytes)
        });
        if received.flawed || !intact {
            if !self.behaviour.communication_errors_uncounted {
                self.counters.spoilt();
            }
            if received.flawed || !self.behaviour.stale_crc_accepted {
                return None;
            }
        } else {
            self.counters.heard();
        }
        let (request, _) = whole?;
        let body = self.answer_body(request, self.is_over_tcp())?;
        let answer = crc::with_crc(body, self.behaviour.crc_order);
        match self.behaviour.departs(Departure::EchoesRequest) {
            true => Some([received.bytes.as_slice(), &answer].concat()),
            false => Some(answer),
        }
    }

    /// Whether it does not hear the frame after this one.
    fn deafens(&self, received: &Received) -> bool {
        match self.behaviour.departure {
            Some(Departure::DeafAfterLongFrame) => {
                received.flawed && received.bytes.len() == LONGEST_FRAME
            }
            Some(Departure::DeafAfterBadFrame) => {
                received.flawed || !crc::split(&received.bytes).is_some_and(|(_, intact)| intact)
            }
            _ => false,
        }
    }

    /// The same on a connection.
    fn answer_request(&mut self, request: &Request) -> Option<Vec<u8>> {
        if !(request.intact || self.behaviour.stale_crc_accepted) {
            return None;
        }
        let body = self.answer_body(&request.body, self.is_over_tcp())?;
        Some(request.answered(body, self.behaviour.crc_order))
    }

    /// Address, function and data of the answer.
    fn answer_body(&mut self, request: &[u8], over_tcp: bool) -> Option<Vec<u8>> {
        match self.registers.command(request, &self.behaviour) {
            Some(Command::Silent) => None,
            Some(Command::Answer(body)) => Some(body),
            None => self.ordinary_answer(request, over_tcp),
        }
    }

    /// The answer to a request on the own address or to all, without its CRC.
    fn ordinary_answer(&mut self, request: &[u8], over_tcp: bool) -> Option<Vec<u8>> {
        let (&address, pdu) = request.split_first()?;
        let own_address = self.registers.address();
        // There is no broadcast on a connection of its own, and no other slave behind it.
        let broadcast = address == BROADCAST && !over_tcp;
        let others = self.behaviour.other_addresses_answered || over_tcp;
        if !broadcast && address != own_address && !others {
            return None;
        }
        let (function, data) = match pdu.split_first() {
            Some((&function, data)) if self.behaviour.departs(Departure::HighBitIgnored) => {
                (function & 0x7F, data)
            }
            Some((&function, data)) => (function, data),
            None if self.behaviour.bare_address_answered => (0, pdu),
            None => return None,
        };
        self.counters.received(broadcast);
        if broadcast && self.behaviour.broadcast_ignored {
            return None;
        }
        let unit = if over_tcp { address } else { own_address };
        let outcome = match self.service(over_tcp).serve(function, data) {
            Outcome::Answer(outcome) => outcome,
            Outcome::Silence => return None,
        };
        if broadcast && !self.behaviour.broadcast_answered {
            return None;
        }
        let is_unknown = outcome == Err(Exception::IllegalFunction);
        if is_unknown && self.behaviour.unknown_function_silent {
            return None;
        }
        Some(self.frame(unit, function, outcome))
    }

    fn frame(&self, unit: u8, function: u8, outcome: Result<Vec<u8>, Exception>) -> Vec<u8> {
        let mut answer = vec![unit];
        match outcome {
            Ok(data) => {
                answer.push(function);
                answer.extend(data);
            }
            Err(exception) => {
                let bit = u8::from(self.behaviour.exception_bit_set) << 7;
                answer.extend([
                    function | bit,
                    exception.code(&self.behaviour.exception_codes),
                ]);
                if self.behaviour.exception_with_function_data {
                    answer.push(0);
                }
            }
        }
        answer
    }

    fn service(&mut self, over_tcp: bool) -> Service<'_, R> {
        Service {
            over_tcp,
            first_value: self.first_value,
            registers: &mut self.registers,
            behaviour: &self.behaviour,
            counters: &mut self.counters,
        }
    }

    fn is_over_tcp(&self) -> bool {
        let framing = self.stream.as_ref().map(StreamFramer::framing);
        framing == Some(Framing::ModbusTcp)
    }
}

fn framer(line: SerialSettings, behaviour: &Behaviour) -> Framer {
    let framer = match behaviour.departure {
        _ if behaviour.replies_before_silence => Framer::hasty(line),
        Some(Departure::IdleLineEndsFrame) => Framer::impatient(line),
        Some(Departure::PatientLine) => Framer::patient(line),
        _ => Framer::new(line),
    };
    match behaviour.frame_remains {
        Some(remains) => framer.keeping(remains),
        None => framer,
    }
}
