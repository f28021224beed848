//! Where a request ends on a connection, which has no silences: by the length that it says it has.

use std::collections::VecDeque;
use std::time::Duration;

use fieldproof_link::{Character, Framing, Instant};

use super::crc;
use super::framing::LONGEST_FRAME;

/// Nothing more for so long, and what does not say how long it is has ended.
const NOTHING_MORE: Duration = Duration::from_millis(20);

/// Bytes of a Modbus TCP header before those that its length counts.
const BEFORE_LENGTH: usize = 6;

/// A request, and what its answer must carry beside its own content.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Request {
    /// Address or unit, function and data.
    pub body: Vec<u8>,
    /// Whether its CRC is right; Modbus TCP has none.
    pub intact: bool,
    /// The transaction of a Modbus TCP header.
    transaction: Option<[u8; 2]>,
}

impl Request {
    /// The frame that carries `body` as the answer to this; an RTU frame has its CRC in `order`.
    pub fn answered(&self, body: Vec<u8>, order: super::CrcOrder) -> Vec<u8> {
        let Some([high, low]) = self.transaction else {
            return crc::with_crc(body, order);
        };
        let [length_high, length_low] = u16::try_from(body.len()).unwrap_or(u16::MAX).to_be_bytes();
        let mut frame = vec![high, low, 0, 0, length_high, length_low];
        frame.extend(body);
        frame
    }
}

/// Collects bytes until they are a request.
#[derive(Debug, Clone)]
pub struct StreamFramer {
    framing: Framing,
    collected: Vec<u8>,
    last: Instant,
    finished: VecDeque<Request>,
}

impl StreamFramer {
    /// For a connection that carries frames so.
    pub fn new(framing: Framing) -> StreamFramer {
        StreamFramer {
            framing,
            collected: Vec::new(),
            last: Instant::START,
            finished: VecDeque::new(),
        }
    }

    /// How frames are told apart.
    pub fn framing(&self) -> Framing {
        self.framing
    }

    /// `character` came at `now`.
    pub fn receive(&mut self, now: Instant, character: Character) {
        self.end_by_nothing_more(now);
        self.last = now;
        self.collected.push(character.byte);
        match length(self.framing, &self.collected) {
            Some(length) if self.collected.len() >= length => self.finish(),
            // What has no end and is too long for a frame is none; the rest of it goes with it.
            _ => self.collected.truncate(LONGEST_FRAME + BEFORE_LENGTH),
        }
    }

    /// When it wants to be woken: at once if there is a request.
    pub fn wake_at(&self) -> Option<Instant> {
        if !self.finished.is_empty() {
            return Some(self.last);
        }
        (!self.collected.is_empty()).then(|| self.last + NOTHING_MORE)
    }

    /// The oldest request that was not taken yet.
    pub fn wake(&mut self, now: Instant) -> Option<Request> {
        self.end_by_nothing_more(now);
        self.finished.pop_front()
    }

    fn end_by_nothing_more(&mut self, now: Instant) {
        if !self.collected.is_empty() && now.since(self.last) >= NOTHING_MORE {
            self.finish();
        }
    }

    /// What was collected is a request, or nothing.
    fn finish(&mut self) {
        let frame = std::mem::take(&mut self.collected);
        self.finished.extend(match self.framing {
            Framing::Rtu => crc::split(&frame).map(|(body, intact)| Request {
                body: body.to_vec(),
                intact,
                transaction: None,
            }),
            Framing::ModbusTcp => from_header(&frame),
        });
    }
}

/// A header of protocol 0 and as many bytes as it says.
fn from_header(frame: &[u8]) -> Option<Request> {
    let (&[high, low, 0, 0, _, _], body) = frame.split_first_chunk()? else {
        return None;
    };
    let is_whole = length(Framing::ModbusTcp, frame) == Some(frame.len());
    is_whole.then(|| Request {
        body: body.to_vec(),
        intact: true,
        transaction: Some([high, low]),
    })
}

/// How long the request is that begins with `start`, as far as that says.
fn length(framing: Framing, start: &[u8]) -> Option<usize> {
    match framing {
        Framing::ModbusTcp => {
            let length = u16::from_be_bytes([*start.get(4)?, *start.get(5)?]);
            // A unit and 1 to 253 bytes of PDU.
            (2..=254)
                .contains(&length)
                .then(|| BEFORE_LENGTH + usize::from(length))
        }
        Framing::Rtu => match *start.get(1)? {
            0x01..=0x06 => Some(8),
            0x0F | 0x10 => Some(9 + usize::from(*start.get(6)?)),
            _ => None,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modbus::CrcOrder;

    const READ: [u8; 12] = [0, 9, 0, 0, 0, 6, 0x20, 3, 0, 1, 0, 1];

    fn at(milliseconds: u64) -> Instant {
        Instant::START + Duration::from_millis(milliseconds)
    }

    /// The bodies of the requests in these chunks, each with its instant in milliseconds.
    fn requests(framing: Framing, chunks: &[(u64, &[u8])]) -> Vec<Request> {
        let mut framer = StreamFramer::new(framing);
        for (milliseconds, bytes) in chunks {
            for byte in *bytes {
                framer.receive(at(*milliseconds), Character::new(*byte));
            }
        }
        let mut requests = Vec::new();
        while let Some(wake_at) = framer.wake_at() {
            requests.extend(framer.wake(wake_at));
        }
        requests
    }

    #[test]
    fn a_header_says_where_a_request_ends() {
        let twice = [READ, READ].concat();
        for chunks in [
            vec![(1, twice.as_slice())],
            vec![(1, &twice[..5]), (2, &twice[5..])],
        ] {
            let requests = requests(Framing::ModbusTcp, &chunks);
            assert_eq!(requests.len(), 2);
            assert_eq!(requests[0].body, READ[6..]);
            let answer = requests[0].answered(vec![0x20, 0x83, 2], CrcOrder::LowByteFirst);
            assert_eq!(answer, [0, 9, 0, 0, 0, 3, 0x20, 0x83, 2]);
        }
    }

    #[test]
    fn what_has_another_header_is_no_request_and_does_not_harm_the_next() {
        for (place, byte) in [(3, 1), (4, 1), (5, 0), (5, 1)] {
            let mut wrong = READ;
            wrong[place] = byte;
            let requests = requests(Framing::ModbusTcp, &[(1, &wrong), (30, &READ)]);
            assert_eq!(requests.len(), 1, "{byte} in place {place}");
        }
        let half = requests(Framing::ModbusTcp, &[(1, &READ[..9]), (30, &READ)]);
        assert_eq!(half.len(), 1);
        let endless = [0xFF; 2_000];
        let after = requests(Framing::ModbusTcp, &[(1, &endless), (30, &READ)]);
        assert_eq!(after.len(), 1);
    }

    #[test]
    fn an_rtu_request_ends_by_its_function_or_by_nothing_more() {
        let read = crc::with_crc(vec![0x20, 3, 0, 1, 0, 1], CrcOrder::LowByteFirst);
        let write = crc::with_crc(vec![1, 0x10, 0, 1, 0, 1, 2, 0, 5], CrcOrder::LowByteFirst);
        let unknown = crc::with_crc(vec![1, 0x4E, 0, 0], CrcOrder::LowByteFirst);
        let chunk = [read.as_slice(), &write, &unknown].concat();
        let found = requests(Framing::Rtu, &[(1, &chunk), (30, &read)]);
        let lengths: Vec<usize> = found.iter().map(|request| request.body.len()).collect();
        assert_eq!(lengths, [6, 9, 4, 6]);
        assert!(found.iter().all(|request| request.intact));
        let mut spoilt = read.clone();
        spoilt[3] ^= 1;
        assert!(!requests(Framing::Rtu, &[(1, &spoilt)])[0].intact);
        let answer = found[0].answered(vec![0x20, 0x83, 2], CrcOrder::LowByteFirst);
        assert_eq!(
            crc::split(&answer),
            Some(([0x20, 0x83, 2].as_slice(), true))
        );
    }
}
