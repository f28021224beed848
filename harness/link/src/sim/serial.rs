//! A serial line: half duplex, every character heard by all others.

use std::collections::VecDeque;

use super::medium::{Delivery, Source};
use crate::signal::bits_in_nanos;
use crate::{Character, Instant, Line, Reception, SerialSettings};

/// The line and its nodes. Node 0 is the tester's port.
#[derive(Default)]
pub(super) struct SerialLine {
    nodes: Vec<Node>,
}

#[derive(Default)]
struct Node {
    /// `None` is not there.
    settings: Option<SerialSettings>,
    /// Since when it is set so.
    since: Instant,
    queue: VecDeque<Queued>,
    flight: Option<Flight>,
    burst: Option<Burst>,
}

#[derive(Clone, Copy)]
struct Queued {
    character: Character,
    from: Source,
}

/// The character that a node has on the line.
#[derive(Clone, Copy)]
struct Flight {
    queued: Queued,
    settings: SerialSettings,
    start: Instant,
    end: Instant,
    collided: bool,
}

/// Characters without a gap: instants are counted from the first, so that rounding does not add up.
#[derive(Clone, Copy)]
struct Burst {
    settings: SerialSettings,
    start: Instant,
    bits: u64,
}

impl SerialLine {
    /// A further node, switched off.
    pub(super) fn join(&mut self) -> usize {
        self.nodes.push(Node::default());
        self.nodes.len() - 1
    }

    /// A node that is switched off loses what it had to send; one that is set differently keeps it.
    pub(super) fn set_line(&mut self, node: usize, line: Line, now: Instant) {
        let settings = match line {
            Line::Serial(settings) => Some(settings),
            Line::Off | Line::Can { .. } | Line::Stream(_) => None,
        };
        let node = &mut self.nodes[node];
        if node.settings == settings {
            return;
        }
        node.settings = settings;
        node.since = now;
        if settings.is_none() {
            node.queue.clear();
        }
    }

    pub(super) fn push(
        &mut self,
        node: usize,
        from: Source,
        characters: &[Character],
        now: Instant,
    ) {
        if self.nodes[node].settings.is_none() {
            return;
        }
        let queued = characters
            .iter()
            .map(|&character| Queued { character, from });
        self.nodes[node].queue.extend(queued);
        if self.nodes[node].flight.is_none() {
            self.nodes[node].burst = None;
            self.start(node, now);
        }
    }

    /// Takes back what `from` has queued at `node`; the character on the line stays.
    pub(super) fn withdraw(&mut self, node: usize, from: Source) {
        self.nodes[node].queue.retain(|queued| queued.from != from);
    }

    pub(super) fn is_sending(&self, node: usize) -> bool {
        self.nodes[node].flight.is_some()
    }

    /// Puts the next character of `node` on the line; two on it at once spoil each other.
    fn start(&mut self, node: usize, now: Instant) {
        let sender = &mut self.nodes[node];
        let Some(settings) = sender.settings else {
            return;
        };
        let Some(queued) = sender.queue.pop_front() else {
            return;
        };
        let burst = sender.burst.filter(|burst| burst.settings == settings);
        let mut burst = burst.unwrap_or(Burst {
            settings,
            start: now,
            bits: 0,
        });
        burst.bits += u64::from(settings.bits_per_character());
        sender.burst = Some(burst);
        let end = burst
            .start
            .after_nanos(bits_in_nanos(burst.bits, settings.baud));
        let mut collided = false;
        for (index, other) in self.nodes.iter_mut().enumerate() {
            if index != node
                && let Some(flight) = other.flight.as_mut().filter(|flight| flight.end > now)
            {
                flight.collided = true;
                collided = true;
            }
        }
        self.nodes[node].flight = Some(Flight {
            queued,
            settings,
            start: now,
            end,
            collided,
        });
    }

    /// The end of the character that ends next; `NEVER` if there is none.
    pub(super) fn ends_at(&self) -> Instant {
        let ends = self
            .nodes
            .iter()
            .filter_map(|node| node.flight.map(|flight| flight.end));
        ends.min().unwrap_or(Instant::NEVER)
    }

    /// Ends the character that ends next and lets its sender go on with the one after it.
    pub(super) fn end(&mut self) -> Option<Delivery> {
        let ends = self.ends_at();
        let ended = |node: &Node| node.flight.is_some_and(|flight| flight.end == ends);
        let index = self.nodes.iter().position(ended)?;
        let flight = self.nodes[index].flight.take()?;
        let whole = self.is_set(index, flight.settings, flight.start);
        self.start(index, flight.end);
        Some(Delivery {
            node: index,
            from: flight.queued.from,
            start: flight.start,
            end: flight.end,
            what: Reception::Character(Character {
                byte: flight.queued.character.byte,
                spoilt: flight.queued.character.spoilt || flight.collided || !whole,
            }),
            line: Line::Serial(flight.settings),
        })
    }

    /// How `node` hears a character that was sent with `settings` since `start`: spoilt, unless it has been set the
    /// same all the time; not at all if it is not there.
    pub(super) fn hears(
        &self,
        node: usize,
        settings: SerialSettings,
        start: Instant,
        character: Character,
    ) -> Option<Character> {
        self.nodes[node].settings?;
        Some(Character {
            byte: character.byte,
            spoilt: character.spoilt || !self.is_set(node, settings, start),
        })
    }

    /// Whether `node` has been set to `settings` since `start`.
    fn is_set(&self, node: usize, settings: SerialSettings, start: Instant) -> bool {
        let node = &self.nodes[node];
        node.settings == Some(settings) && node.since <= start
    }
}
