//! The Modbus TCP side of a slave: connections, and requests that wait for their turn whichever they came over.

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use fieldproof_link::{Instant, Reception};

use super::Behaviour;

/// Transaction, protocol, length.
const BEFORE_LENGTH_COUNTS: usize = 6;
/// What the length may be: a unit and 1 to 253 bytes of PDU.
const LENGTHS: std::ops::RangeInclusive<u16> = 2..=254;
/// After a header that is none: nothing more for so long, and the next may begin.
const QUIET: Duration = Duration::from_millis(20);
/// [`TcpFault::NeverFreed`]: so many connections, and no more.
const MOST_EVER: usize = 8;
/// [`TcpFault::FloodStops`]: so many bytes that are no frame are borne.
const FLOOD: usize = 512;
/// [`TcpFault::EndsAfterMany`]: so many requests on one connection.
const MANY: usize = 32;
/// [`TcpFault::ShortBuffer`]: so many bytes of a frame fit.
const SHORT_BUFFER: usize = 256;

/// How the TCP side departs from its specification.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TcpFault {
    /// Its answers carry transaction 0.
    TransactionZero,
    /// Its answers carry numbers that it counts itself.
    TransactionCounted,
    /// The length of its answers leaves the unit out.
    LengthWithoutUnit,
    /// Its answers carry unit FFh.
    UnitReplaced,
    /// Unit 0 is a broadcast.
    UnitZeroUnanswered,
    /// Requests of other protocols are taken for Modbus.
    OtherProtocols,
    /// A request ends where its function says, not its header.
    LengthIgnored,
    /// What comes in one piece is a request, or nothing.
    PieceIsRequest,
    /// Of several requests in one piece only the first is done.
    FirstOfPiece,
    /// While half a request lies on one connection, the others wait.
    HalfBlocks,
    /// A new connection silences those before it.
    NewestOnly,
    /// A connection that was closed still counts.
    NeverFreed,
    /// What a closed connection had begun stands before what comes over the next.
    RemainsKept,
    /// After a header that is none it answers nobody.
    StuckAfterGarbage,
    /// More than 512 bytes that are no frame stop it.
    FloodStops,
    /// A connection that is gone before its answer stops it.
    GoneStops,
    /// It ends a connection after 32 requests.
    EndsAfterMany,
    /// The longest frames do not fit.
    ShortBuffer,
}

/// The connections of a slave.
#[derive(Debug, Clone, Default)]
pub(super) struct TcpSide {
    connections: BTreeMap<usize, Connection>,
    /// Whole frames with the connection they came over, in the order in which they became whole.
    waiting: VecDeque<(usize, Vec<u8>)>,
    /// Connections that it is about to end.
    to_close: Vec<usize>,
    reply: Option<(Instant, usize, Vec<u8>)>,
    /// When the last frame became whole.
    last_whole: Option<Instant>,
    ever: usize,
    answered: u16,
    is_stuck: bool,
    remains: Vec<u8>,
}

#[derive(Debug, Clone, Default)]
struct Connection {
    collected: Vec<u8>,
    last: Option<Instant>,
    /// What comes is thrown away until there is silence.
    is_lost: bool,
    /// [`TcpFault::NewestOnly`], [`TcpFault::NeverFreed`]: nothing is served here.
    is_deaf: bool,
    /// How many bytes were thrown away.
    thrown_away: usize,
    /// How many requests came.
    requests: usize,
}

impl TcpSide {
    /// Forgets everything: after power-on.
    pub(super) fn restart(&mut self) {
        *self = TcpSide::default();
    }

    /// Something came over the connection at `port`.
    pub(super) fn receive(
        &mut self,
        now: Instant,
        port: usize,
        what: Reception,
        behaviour: &Behaviour,
    ) {
        match what {
            Reception::Connected => self.opened(port, behaviour),
            Reception::Closed => self.closed(port, behaviour),
            Reception::Character(character) => self.take(now, port, character.byte, behaviour),
            Reception::Frame(_) | Reception::BusError(_) => {}
        }
    }

    fn opened(&mut self, port: usize, behaviour: &Behaviour) {
        self.closed(port, behaviour);
        if behaviour.tcp_fault == Some(TcpFault::NewestOnly) {
            for older in self.connections.values_mut() {
                older.is_deaf = true;
            }
        }
        self.ever += 1;
        let full = behaviour.tcp_fault == Some(TcpFault::NeverFreed) && self.ever > MOST_EVER;
        let connection = Connection {
            collected: std::mem::take(&mut self.remains),
            is_deaf: full,
            ..Connection::default()
        };
        self.connections.insert(port, connection);
    }

    fn closed(&mut self, port: usize, behaviour: &Behaviour) {
        let gone = self.connections.remove(&port);
        if behaviour.tcp_fault == Some(TcpFault::RemainsKept) {
            self.remains = gone.map(|it| it.collected).unwrap_or_default();
        }
        let had_begun = self.reply.as_ref().is_some_and(|(_, to, _)| *to == port)
            || self.waiting.iter().any(|(from, _)| *from == port);
        self.is_stuck |= had_begun && behaviour.tcp_fault == Some(TcpFault::GoneStops);
        self.waiting.retain(|(from, _)| *from != port);
        self.to_close.retain(|it| *it != port);
        self.reply.take_if(|(_, to, _)| *to == port);
    }

    fn take(&mut self, now: Instant, port: usize, byte: u8, behaviour: &Behaviour) {
        let fault = behaviour.tcp_fault;
        let connection = self.connections.entry(port).or_default();
        let pause = connection.last.map(|last| now.since(last));
        connection.last = Some(now);
        if pause.is_some_and(|pause| pause >= QUIET) {
            connection.is_lost = false;
        }
        if pause.is_some_and(|pause| !pause.is_zero()) && fault == Some(TcpFault::PieceIsRequest) {
            connection.collected.clear();
        }
        if connection.is_lost || connection.is_deaf {
            connection.thrown_away += 1;
            let flooded = connection.thrown_away > FLOOD && fault == Some(TcpFault::FloodStops);
            self.is_stuck |= flooded;
            return;
        }
        connection.collected.push(byte);
        match end_of(&connection.collected, fault) {
            End::Unknown => {}
            End::Nowhere => {
                connection.collected.clear();
                connection.is_lost = true;
                self.is_stuck |= fault == Some(TcpFault::StuckAfterGarbage);
                if behaviour.bad_header_closes {
                    self.to_close.push(port);
                }
            }
            End::After(length) if connection.collected.len() < length => {}
            End::After(_) => {
                let frame = std::mem::take(&mut connection.collected);
                connection.requests += 1;
                let ends = connection.requests > MANY && fault == Some(TcpFault::EndsAfterMany);
                if ends {
                    self.to_close.push(port);
                    return;
                }
                self.whole(now, port, frame, behaviour);
            }
        }
    }

    fn whole(&mut self, now: Instant, port: usize, frame: Vec<u8>, behaviour: &Behaviour) {
        let (fault, last_first) = (behaviour.tcp_fault, behaviour.last_request_first);
        let of_one_piece = self.last_whole.replace(now) == Some(now);
        match fault {
            Some(TcpFault::FirstOfPiece) if of_one_piece => {}
            Some(TcpFault::ShortBuffer) if frame.len() > SHORT_BUFFER => {}
            _ if of_one_piece && last_first => self.waiting.push_front((port, frame)),
            _ => self.waiting.push_back((port, frame)),
        }
    }

    /// When it wants to be woken.
    pub(super) fn wake_at(&self, behaviour: &Behaviour) -> Option<Instant> {
        if !self.to_close.is_empty() {
            return Some(Instant::START);
        }
        let reply = self.reply.as_ref().map(|(at, ..)| *at);
        let waits = !self.waiting.is_empty() && !self.is_blocked(behaviour);
        reply.or(waits.then_some(Instant::START))
    }

    fn is_blocked(&self, behaviour: &Behaviour) -> bool {
        let mut connections = self.connections.values();
        behaviour.tcp_fault == Some(TcpFault::HalfBlocks)
            && connections.any(|it| !it.collected.is_empty())
    }

    /// A connection that it ends now.
    pub(super) fn take_ended(&mut self) -> Option<usize> {
        let port = self.to_close.pop()?;
        self.connections.remove(&port);
        Some(port)
    }

    /// The next request, if none is being done.
    pub(super) fn next_request(&mut self, behaviour: &Behaviour) -> Option<(usize, Vec<u8>)> {
        if self.reply.is_some() || self.is_blocked(behaviour) {
            return None;
        }
        let (port, frame) = self.waiting.pop_front()?;
        let is_silent = self.is_stuck
            || behaviour.tcp_fault == Some(TcpFault::UnitZeroUnanswered)
                && frame.get(BEFORE_LENGTH_COUNTS) == Some(&0);
        (!is_silent).then_some((port, frame))
    }

    /// Answers `request` with `body`, unit and PDU, at `at`.
    pub(super) fn answer(
        &mut self,
        at: Instant,
        (port, request): (usize, Vec<u8>),
        mut body: Vec<u8>,
        behaviour: &Behaviour,
    ) {
        self.answered = self.answered.wrapping_add(1);
        let fault = behaviour.tcp_fault;
        let own = [request[0], request[1]];
        let transaction = match fault {
            Some(TcpFault::TransactionZero) => [0, 0],
            Some(TcpFault::TransactionCounted) => self.answered.to_be_bytes(),
            _ => own,
        };
        let counted = match fault {
            Some(TcpFault::LengthWithoutUnit) => body.len().saturating_sub(1),
            _ => body.len(),
        };
        if let (Some(TcpFault::UnitReplaced), Some(unit)) = (fault, body.first_mut()) {
            *unit = 0xFF;
        }
        let length = u16::try_from(counted).unwrap_or(u16::MAX).to_be_bytes();
        let frame = [&transaction, &[0, 0], &length, body.as_slice()].concat();
        self.reply = Some((at, port, frame));
    }

    /// What is to be sent by `now`.
    pub(super) fn due(&mut self, now: Instant) -> Option<(usize, Vec<u8>)> {
        let (_, port, frame) = self.reply.take_if(|(at, ..)| *at <= now)?;
        Some((port, frame))
    }
}

/// Unit, function and data of a frame.
pub(super) fn body(frame: &[u8]) -> &[u8] {
    frame.get(BEFORE_LENGTH_COUNTS..).unwrap_or_default()
}

/// Where a frame ends.
enum End {
    /// Too little of it is there.
    Unknown,
    /// It is none.
    Nowhere,
    /// With so many bytes.
    After(usize),
}

fn end_of(start: &[u8], fault: Option<TcpFault>) -> End {
    let Some((&[_, _, high, low, length_high, length_low], body)) =
        start.split_first_chunk::<BEFORE_LENGTH_COUNTS>()
    else {
        return End::Unknown;
    };
    let is_modbus = [high, low] == [0, 0] || fault == Some(TcpFault::OtherProtocols);
    let length = u16::from_be_bytes([length_high, length_low]);
    let is_length = LENGTHS.contains(&length) || fault == Some(TcpFault::LengthIgnored);
    if !is_modbus || !is_length {
        return End::Nowhere;
    }
    match (fault, body) {
        // Unit, function, two numbers.
        (Some(TcpFault::LengthIgnored), [_, 0x01..=0x06, ..]) => {
            End::After(BEFORE_LENGTH_COUNTS + 6)
        }
        (Some(TcpFault::LengthIgnored), [] | [_]) => End::Unknown,
        _ => End::After(BEFORE_LENGTH_COUNTS + usize::from(length)),
    }
}
