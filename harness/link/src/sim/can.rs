//! A CAN bus: one frame at a time, by arbitration, taken only if somebody acknowledges it.

use std::collections::VecDeque;

use fieldproof_can::{Frame, INTERMISSION_BITS, Id};

use super::medium::{Delivery, Source};
use crate::signal::bits_in_nanos;
use crate::{Instant, Line, Reception};

/// The bus and its nodes. Node 0 is the tester's port.
///
/// What is not modelled: error frames. A frame that nobody acknowledges would disturb the bus until its sender is
/// passive; here it waits without taking the bus until a node of the same bit rate is there.
#[derive(Default)]
pub(super) struct CanBus {
    nodes: Vec<Node>,
    flight: Option<Flight>,
    /// The end of the last intermission.
    idle_at: Instant,
    /// No node that has something to send has anybody to acknowledge it, until something changes.
    stuck: bool,
}

#[derive(Default)]
struct Node {
    /// Bits a second; 0 is not there.
    bit_rate: u32,
    /// Since when it is set so.
    since: Instant,
    queue: VecDeque<Queued>,
}

#[derive(Clone, Copy)]
struct Queued {
    frame: Frame,
    from: Source,
}

/// The frame on the bus; it stays at the head of its node's queue until it is acknowledged.
#[derive(Clone, Copy)]
struct Flight {
    node: usize,
    queued: Queued,
    bit_rate: u32,
    start: Instant,
    end: Instant,
}

impl CanBus {
    /// A further node, switched off.
    pub(super) fn join(&mut self) -> usize {
        self.nodes.push(Node::default());
        self.nodes.len() - 1
    }

    /// A node that is switched off loses what it had to send; one that changes its bit rate keeps it.
    pub(super) fn set_line(&mut self, node: usize, line: Line, now: Instant) {
        let bit_rate = match line {
            Line::Can { bit_rate } => bit_rate,
            Line::Off | Line::Serial(_) | Line::Stream(_) => 0,
        };
        let node = &mut self.nodes[node];
        if node.bit_rate == bit_rate {
            return;
        }
        node.bit_rate = bit_rate;
        node.since = now;
        if bit_rate == 0 {
            node.queue.clear();
        }
        self.stuck = false;
    }

    /// Queues `frame`. While nobody is there to acknowledge anything, it takes the place of one with its identifier.
    pub(super) fn push(&mut self, node: usize, from: Source, frame: Frame) {
        if self.nodes[node].bit_rate == 0 {
            return;
        }
        let alone = !self.has_peer(node);
        let queue = &mut self.nodes[node].queue;
        let same = |queued: &&mut Queued| queued.from == from && queued.frame.id() == frame.id();
        match queue.iter_mut().find(|queued| alone && same(queued)) {
            Some(queued) => queued.frame = frame,
            None => queue.push_back(Queued { frame, from }),
        }
        self.stuck = false;
    }

    /// Takes back what `from` has queued at `node`; a frame that is on the bus already stays.
    pub(super) fn withdraw(&mut self, node: usize, from: Source) {
        let mut on_the_bus = self.is_sending(node);
        self.nodes[node].queue.retain(|queued| {
            let keep = on_the_bus || queued.from != from;
            on_the_bus = false;
            keep
        });
    }

    pub(super) fn is_sending(&self, node: usize) -> bool {
        self.flight.is_some_and(|flight| flight.node == node)
    }

    /// When the bus is next idle with something to send; `NEVER` if a frame is on it, or nothing can be sent.
    pub(super) fn starts_at(&self, now: Instant) -> Instant {
        let nothing = || self.nodes.iter().all(|node| node.queue.is_empty());
        if self.flight.is_some() || self.stuck || nothing() {
            Instant::NEVER
        } else {
            self.idle_at.max(now)
        }
    }

    /// Arbitration among the heads of the queues that somebody would acknowledge.
    pub(super) fn start(&mut self, now: Instant) {
        let mut winner: Option<(u32, usize, Queued)> = None;
        for (index, node) in self.nodes.iter().enumerate() {
            let Some(head) = node.queue.front() else {
                continue;
            };
            let key = arbitration_field(&head.frame);
            let loses = winner.is_some_and(|(best, ..)| best <= key);
            if !loses && self.has_peer(index) {
                winner = Some((key, index, *head));
            }
        }
        let Some((_, node, queued)) = winner else {
            self.stuck = true;
            return;
        };
        let bit_rate = self.nodes[node].bit_rate;
        let nanos = bits_in_nanos(queued.frame.bits().into(), bit_rate);
        self.flight = Some(Flight {
            node,
            queued,
            bit_rate,
            start: now,
            end: now.after_nanos(nanos),
        });
    }

    fn has_peer(&self, node: usize) -> bool {
        let bit_rate = self.nodes[node].bit_rate;
        let mut others = self.nodes.iter().enumerate();
        others.any(|(index, other)| index != node && other.bit_rate == bit_rate)
    }

    /// The end of the frame on the bus; `NEVER` if there is none.
    pub(super) fn ends_at(&self) -> Instant {
        self.flight.map_or(Instant::NEVER, |flight| flight.end)
    }

    /// Ends the frame on the bus: it leaves its queue if its sender was there to the end and somebody acknowledged it,
    /// and is tried again otherwise.
    pub(super) fn end(&mut self) -> Option<Delivery> {
        let flight = self.flight.take()?;
        let intermission = bits_in_nanos(INTERMISSION_BITS.into(), flight.bit_rate);
        self.idle_at = flight.end.after_nanos(intermission);
        let delivery = Delivery {
            node: flight.node,
            from: flight.queued.from,
            start: flight.start,
            end: flight.end,
            what: Reception::Frame(flight.queued.frame),
            line: Line::Can {
                bit_rate: flight.bit_rate,
            },
        };
        let heard = |node| self.hears(node, flight.bit_rate, flight.start);
        let mut others = (0..self.nodes.len()).filter(|&node| node != flight.node);
        if !heard(flight.node) || !others.any(heard) {
            return None;
        }
        self.nodes[flight.node].queue.pop_front();
        Some(delivery)
    }

    /// Whether `node` has been set to `bit_rate` since `start`.
    pub(super) fn hears(&self, node: usize, bit_rate: u32, start: Instant) -> bool {
        let node = &self.nodes[node];
        node.bit_rate == bit_rate && node.since <= start
    }
}

/// The arbitration field as a number, first bit highest: the lower one wins. In the order of the bus: eleven bits of
/// identifier, RTR (base) or SRR (extended, recessive), IDE, eighteen bits of identifier and RTR of the extended format.
fn arbitration_field(frame: &Frame) -> u32 {
    let remote = u32::from(frame.is_remote());
    match frame.id() {
        Id::Standard(id) => u32::from(id.raw()) << 21 | remote << 20,
        Id::Extended(id) => {
            let (high, low) = (id.raw() >> 18, id.raw() & 0x3_FFFF);
            high << 21 | 0b11 << 19 | low << 1 | remote
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fieldproof_can::StandardId;

    #[test]
    fn the_arbitration_field_orders_formats_and_kinds() {
        let base = Id::standard(0x123).unwrap();
        // The same first eleven bits.
        let extended = Id::extended(0x123 << 18).unwrap();
        let key = |frame: Option<Frame>| arbitration_field(&frame.unwrap());
        let lower = Id::from(StandardId::new(0x122).unwrap());
        let order = [
            key(Frame::remote(lower, 0)),
            key(Frame::data(base, &[])),
            key(Frame::remote(base, 0)),
            key(Frame::data(extended, &[])),
            key(Frame::remote(extended, 0)),
            key(Frame::data(Id::extended((0x123 << 18) + 1).unwrap(), &[])),
            key(Frame::data(Id::standard(0x124).unwrap(), &[])),
        ];
        assert!(order.is_sorted_by(|a, b| a < b), "{order:X?}");
    }
}
