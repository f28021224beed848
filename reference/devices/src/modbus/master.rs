//! A small Modbus RTU master: one request at a time, in the order they were asked for.

use std::collections::VecDeque;
use std::time::Duration;

use fieldproof_link::{Character, Instant, Line, SerialSettings};

use super::framing::{Framer, Received};
use super::{CrcOrder, crc};

const READ_HOLDING: u8 = 0x03;
const WRITE_SINGLE: u8 = 0x06;
const EXCEPTION_BIT: u8 = 0x80;

/// Names a request until its result is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct RequestId(u64);

/// What a slave answered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Reply {
    /// It wrote the register.
    Written,
    /// The registers asked for.
    Registers(Vec<u16>),
}

/// Why there is no such answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Failure {
    /// Nothing came in time.
    NoAnswer,
    /// What came is not an answer to the request.
    Malformed,
    /// The slave refused, with this code.
    Exception(u8),
}

/// What a master takes for an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Answers {
    /// What comes from the station that was asked, with the right CRC.
    #[default]
    Right,
    /// What comes from it, whatever the CRC is.
    CrcUnchecked,
    /// What comes, whoever sent it.
    StationUnchecked,
}

#[derive(Debug, Clone, Copy)]
enum Request {
    WriteSingle {
        station: u8,
        register: u16,
        value: u16,
    },
    ReadHolding {
        station: u8,
        register: u16,
        quantity: u16,
    },
}

#[derive(Debug, Clone, Copy)]
struct InFlight {
    id: RequestId,
    request: Request,
    give_up_at: Instant,
}

/// The master's side of one serial port. Its owner passes on what arrives, wakes it when it asks, sends what it gives,
/// and takes the results.
#[derive(Debug, Clone)]
pub struct ModbusMaster {
    line: SerialSettings,
    timeout: Duration,
    answers: Answers,
    framer: Framer,
    queue: VecDeque<(RequestId, Request)>,
    in_flight: Option<InFlight>,
    results: VecDeque<(RequestId, Result<Reply, Failure>)>,
    next_id: u64,
    free_from: Instant,
}

impl ModbusMaster {
    /// A master on a line set so, that waits up to `timeout` from the end of a request to the start of silence after its
    /// answer.
    pub fn new(line: SerialSettings, timeout: Duration) -> ModbusMaster {
        ModbusMaster {
            line,
            timeout,
            answers: Answers::Right,
            framer: Framer::new(line),
            queue: VecDeque::new(),
            in_flight: None,
            results: VecDeque::new(),
            next_id: 0,
            free_from: Instant::START,
        }
    }

    /// The same that takes `answers` for an answer.
    pub fn taking(self, answers: Answers) -> ModbusMaster {
        ModbusMaster { answers, ..self }
    }

    /// How its line is set.
    pub fn line(&self) -> Line {
        Line::Serial(self.line)
    }

    /// Asks for a 06h: `value` into `register` of `station` (1 to 247).
    pub fn write_single(
        &mut self,
        now: Instant,
        station: u8,
        register: u16,
        value: u16,
    ) -> RequestId {
        self.ask(
            now,
            Request::WriteSingle {
                station,
                register,
                value,
            },
        )
    }

    /// Asks for a 03h: `quantity` registers (1 to 125) of `station` (1 to 247) from `register` on.
    pub fn read_holding(
        &mut self,
        now: Instant,
        station: u8,
        register: u16,
        quantity: u16,
    ) -> RequestId {
        self.ask(
            now,
            Request::ReadHolding {
                station,
                register,
                quantity,
            },
        )
    }

    /// The oldest result that was not taken yet.
    pub fn take_result(&mut self) -> Option<(RequestId, Result<Reply, Failure>)> {
        self.results.pop_front()
    }

    /// Forgets every request and result: after power-off.
    pub fn clear(&mut self) {
        self.framer.clear();
        self.queue.clear();
        self.in_flight = None;
        self.results.clear();
    }

    /// `character` ended at `now`.
    pub fn receive(&mut self, now: Instant, character: Character) {
        self.free_from = self.free_from.max(now + self.line.silence_3_5());
        self.framer.receive(now, character);
    }

    /// When it wants to be woken.
    pub fn wake_at(&self) -> Option<Instant> {
        let give_up_at = self.in_flight.map(|in_flight| in_flight.give_up_at);
        let send_at =
            (self.in_flight.is_none() && !self.queue.is_empty()).then_some(self.free_from);
        [self.framer.wake_at(), give_up_at, send_at]
            .into_iter()
            .flatten()
            .min()
    }

    /// The instant it asked for has come; what it sends, if anything. A result may be there to take.
    pub fn wake(&mut self, now: Instant) -> Option<Vec<Character>> {
        if let Some(received) = self.framer.wake(now) {
            self.free_from = self.free_from.max(now);
            self.take_answer(&received);
        }
        if let Some(in_flight) = self
            .in_flight
            .take_if(|in_flight| in_flight.give_up_at <= now)
        {
            self.results
                .push_back((in_flight.id, Err(Failure::NoAnswer)));
        }
        if self.in_flight.is_some() || now < self.free_from {
            return None;
        }
        let (id, request) = self.queue.pop_front()?;
        // What is left of an answer that came too late is not the answer to this.
        self.framer.clear();
        let frame = crc::with_crc(request.body(), CrcOrder::LowByteFirst);
        let length = u32::try_from(frame.len()).unwrap_or(u32::MAX);
        let end = now + self.line.character_time() * length;
        self.free_from = end + self.line.silence_3_5();
        self.in_flight = Some(InFlight {
            id,
            request,
            give_up_at: end + self.timeout,
        });
        Some(frame.into_iter().map(Character::new).collect())
    }

    fn ask(&mut self, now: Instant, request: Request) -> RequestId {
        let id = RequestId(self.next_id);
        self.next_id += 1;
        self.free_from = self.free_from.max(now);
        self.queue.push_back((id, request));
        id
    }

    /// Ends the request in flight by what came, unless it came from another station.
    fn take_answer(&mut self, received: &Received) {
        let Some(InFlight { id, request, .. }) = self.in_flight else {
            return;
        };
        let result = match crc::split(&received.bytes) {
            Some((body, right))
                if !received.flawed && (right || self.answers == Answers::CrcUnchecked) =>
            {
                let other = body.first() != Some(&request.station());
                if other && self.answers != Answers::StationUnchecked {
                    return;
                }
                request.reply(body)
            }
            _ => Err(Failure::Malformed),
        };
        self.in_flight = None;
        self.results.push_back((id, result));
    }
}

impl Request {
    fn station(self) -> u8 {
        match self {
            Request::WriteSingle { station, .. } | Request::ReadHolding { station, .. } => station,
        }
    }

    /// The request without its CRC: address, function, register, value or quantity.
    fn body(self) -> Vec<u8> {
        let (station, function, register, last) = match self {
            Request::WriteSingle {
                station,
                register,
                value,
            } => (station, WRITE_SINGLE, register, value),
            Request::ReadHolding {
                station,
                register,
                quantity,
            } => (station, READ_HOLDING, register, quantity),
        };
        let mut body = vec![station, function];
        body.extend(register.to_be_bytes());
        body.extend(last.to_be_bytes());
        body
    }

    /// What `body`, an answer from the right station, says.
    fn reply(self, body: &[u8]) -> Result<Reply, Failure> {
        let (function, data) = body
            .get(1..)
            .and_then(<[u8]>::split_first)
            .ok_or(Failure::Malformed)?;
        let asked = self.body();
        let asked_function = asked.get(1).copied().unwrap_or_default();
        if *function == asked_function | EXCEPTION_BIT {
            return match data {
                [code] => Err(Failure::Exception(*code)),
                _ => Err(Failure::Malformed),
            };
        }
        match self {
            Request::WriteSingle { .. } if body == asked => Ok(Reply::Written),
            Request::ReadHolding { quantity, .. } if *function == asked_function => {
                let (count, bytes) = data.split_first().ok_or(Failure::Malformed)?;
                if usize::from(*count) != bytes.len() || bytes.len() != 2 * usize::from(quantity) {
                    return Err(Failure::Malformed);
                }
                let (pairs, _) = bytes.as_chunks::<2>();
                Ok(Reply::Registers(
                    pairs.iter().map(|pair| u16::from_be_bytes(*pair)).collect(),
                ))
            }
            _ => Err(Failure::Malformed),
        }
    }
}

#[cfg(test)]
mod tests;
