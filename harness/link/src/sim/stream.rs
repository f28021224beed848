//! A connection: characters in order both ways at once, without bits of their own.

use std::collections::VecDeque;
use std::time::Duration;

use super::medium::{Delivery, Source};
use super::world::TESTER;
use crate::{Farewell, Instant, Line, Reception, Transmission};

/// From one end to the other, whatever is sent.
const LATENCY: Duration = Duration::from_micros(100);

/// A connection between the tester, node 0, and the device.
#[derive(Default)]
pub(super) struct Stream {
    /// How each node is set; `Off` is not there.
    nodes: Vec<Option<Line>>,
    /// In the order of sending, which is that of arriving.
    on_the_way: VecDeque<Delivery>,
    /// The tester has ended it, or has heard that the device has.
    is_closed: bool,
}

impl Stream {
    /// A further node, switched off.
    pub(super) fn join(&mut self) -> usize {
        self.nodes.push(None);
        self.nodes.len() - 1
    }

    pub(super) fn set_line(&mut self, node: usize, line: Line) {
        self.nodes[node] = matches!(line, Line::Stream(_)).then_some(line);
    }

    pub(super) fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// Another connection, in the place of the one that was closed.
    pub(super) fn open(&mut self) {
        self.is_closed = false;
        self.on_the_way.clear();
    }

    /// The tester ends it.
    pub(super) fn close(&mut self, how: Farewell, now: Instant) {
        self.on_the_way
            .retain(|it| it.node == TESTER && how == Farewell::Close);
        if let Some(line) = self.nodes[TESTER] {
            self.put(TESTER, Source::Tester, Reception::Closed, line, now);
        }
        self.is_closed = true;
    }

    /// What comes after the end, or from a node that is not there, is lost.
    pub(super) fn push(&mut self, node: usize, from: Source, what: Transmission, now: Instant) {
        let Some(line) = self.nodes[node].filter(|_| !self.is_closed) else {
            return;
        };
        match what {
            Transmission::Characters(characters) => {
                for character in characters {
                    self.put(node, from, Reception::Character(character), line, now);
                }
            }
            Transmission::Close => self.put(node, from, Reception::Closed, line, now),
            Transmission::Frame(_) => {}
        }
    }

    fn put(&mut self, node: usize, from: Source, what: Reception, line: Line, now: Instant) {
        self.on_the_way.push_back(Delivery {
            node,
            from,
            start: now,
            end: now + LATENCY,
            what,
            line,
        });
    }

    /// When the next thing arrives; `NEVER` if nothing is on the way.
    pub(super) fn ends_at(&self) -> Instant {
        self.on_the_way.front().map_or(Instant::NEVER, |it| it.end)
    }

    pub(super) fn end(&mut self) -> Option<Delivery> {
        let delivery = self.on_the_way.pop_front()?;
        if delivery.node != TESTER && delivery.what == Reception::Closed {
            self.is_closed = true;
            self.on_the_way.clear();
        }
        Some(delivery)
    }

    /// Whether a node is there to hear.
    pub(super) fn hears(&self, node: usize) -> bool {
        self.nodes[node].is_some()
    }
}
