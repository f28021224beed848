//! Which frame goes next, and how long it takes.

use std::collections::BTreeMap;
use std::time::Duration;

use fieldproof_can::{Frame, INTERMISSION_BITS, Id};

use super::client::{Client, Waiting};
use crate::Instant;
use crate::signal::bits_in_nanos;

/// The bus. Clients of different bit rates do not hear each other, and do not disturb each other either: each bit rate is
/// a bus of its own.
pub(super) struct Bus {
    paced: bool,
    segments: BTreeMap<u32, Segment>,
}

/// What goes on at one bit rate.
#[derive(Debug, Clone, Copy, Default)]
struct Segment {
    flight: Option<Flight>,
    idle_at: Instant,
}

/// A frame that is on the bus.
#[derive(Debug, Clone, Copy)]
struct Flight {
    sender: u64,
    frame: Frame,
    end: Instant,
}

impl Bus {
    pub(super) fn new(paced: bool) -> Bus {
        Bus {
            paced,
            segments: BTreeMap::new(),
        }
    }

    pub(super) fn is_paced(&self) -> bool {
        self.paced
    }

    /// Ends and begins frames up to `now`; whether one ended.
    pub(super) fn carry(&mut self, now: Instant, clients: &mut BTreeMap<u64, Client>) -> bool {
        for client in clients.values() {
            if let Some((bit_rate, _)) = client.sends_at() {
                self.segments.entry(bit_rate).or_default();
            }
        }
        let mut ended = false;
        for (bit_rate, segment) in &mut self.segments {
            let bits = |bits: u32| match self.paced {
                true => Duration::from_nanos(bits_in_nanos(bits.into(), *bit_rate)),
                false => Duration::ZERO,
            };
            loop {
                if segment.flight.is_none() {
                    segment.flight = segment.begin(*bit_rate, now, clients, bits);
                }
                match segment.flight {
                    Some(flight) if flight.end <= now => {
                        segment.flight = None;
                        segment.idle_at = flight.end + bits(INTERMISSION_BITS);
                        deliver(flight, *bit_rate, clients);
                        ended = true;
                    }
                    _ => break,
                }
            }
        }
        // A bit rate at which nothing goes on needs no place.
        self.segments
            .retain(|_, segment| segment.flight.is_some() || segment.idle_at > now);
        ended
    }

    /// When something is to be done even if no client says anything.
    pub(super) fn next_change(&self, clients: &BTreeMap<u64, Client>) -> Instant {
        let change = |(bit_rate, segment): (&u32, &Segment)| match segment.flight {
            Some(flight) => flight.end,
            None => match earliest(*bit_rate, clients) {
                Some(since) => since.max(segment.idle_at),
                None => Instant::NEVER,
            },
        };
        let changes = self.segments.iter().map(change);
        changes.min().unwrap_or(Instant::NEVER)
    }
}

impl Segment {
    /// The frame that wins of those that wait when the bus is idle.
    fn begin(
        &self,
        bit_rate: u32,
        now: Instant,
        clients: &BTreeMap<u64, Client>,
        bits: impl Fn(u32) -> Duration,
    ) -> Option<Flight> {
        let start = earliest(bit_rate, clients)?.max(self.idle_at);
        if start > now {
            return None;
        }
        let contenders = waiting(bit_rate, clients).filter(|(_, it)| it.since <= start);
        let (sender, winner) = contenders.min_by_key(|(_, it)| rank(&it.frame))?;
        let frame = winner.frame;
        let end = start + bits(frame.bits());
        Some(Flight { sender, frame, end })
    }
}

fn waiting(
    bit_rate: u32,
    clients: &BTreeMap<u64, Client>,
) -> impl Iterator<Item = (u64, Waiting)> + '_ {
    clients
        .iter()
        .filter_map(move |(id, client)| match client.sends_at() {
            Some((at, first)) if at == bit_rate => Some((*id, first)),
            _ => None,
        })
}

fn earliest(bit_rate: u32, clients: &BTreeMap<u64, Client>) -> Option<Instant> {
    waiting(bit_rate, clients).map(|(_, it)| it.since).min()
}

fn deliver(flight: Flight, bit_rate: u32, clients: &mut BTreeMap<u64, Client>) {
    for (id, client) in clients {
        if *id == flight.sender {
            client.hear_own(flight.frame, flight.end);
        } else {
            client.hear(flight.frame, bit_rate, flight.end);
        }
    }
}

/// The lower wins: the bits of the arbitration field, in the order in which they are on the bus. After the first 11 bits
/// a frame of 11 has RTR and a dominant IDE where one of 29 has two recessive bits.
fn rank(frame: &Frame) -> u32 {
    let remote = u32::from(frame.is_remote());
    match frame.id() {
        Id::Standard(id) => u32::from(id.raw()) << 21 | remote << 20,
        Id::Extended(id) => {
            let (base, extension) = (id.raw() >> 18, id.raw() & 0x3_FFFF);
            base << 21 | 0b11 << 19 | extension << 1 | remote
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dominant_bit_wins() {
        let rank = |text: &str| rank(&text.parse().unwrap());
        assert!(rank("080#00") < rank("081#"));
        assert!(rank("181#00") < rank("181#R1"));
        // An 11-bit remote frame against a 29-bit one of the same first 11 bits: IDE decides.
        assert!(rank("181#R1") < rank("06040000#"));
        assert!(rank("06040000#") < rank("06040000#R"));
        assert!(rank("06040000#R") < rank("06040001#"));
        assert!(rank("0603FFFF#") < rank("181#00"));
    }
}
