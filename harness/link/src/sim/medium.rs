//! What all media have in common, as the world drives them.

use super::can::CanBus;
use super::serial::SerialLine;
use super::stream::Stream;
use crate::{CompanionIndex, Instant, Line, Reception, Transmission};

/// Who gave something to a node to send.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Source {
    /// A participant with a node of its own.
    Bus,
    /// [`crate::Lane::send`].
    Tester,
    /// One of the tester's companions, through the tester's node.
    Companion(CompanionIndex),
}

/// Something that has been sent to its last bit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Delivery {
    /// The node that sent it.
    pub(super) node: usize,
    pub(super) from: Source,
    pub(super) start: Instant,
    pub(super) end: Instant,
    pub(super) what: Reception,
    /// How its sender was set.
    pub(super) line: Line,
}

/// A bus or a line. Its nodes are counted in the order they joined; node 0 is the tester's port.
pub(super) enum Medium {
    Can(CanBus),
    Serial(SerialLine),
    Stream(Stream),
}

impl Medium {
    pub(super) fn join(&mut self) -> usize {
        match self {
            Medium::Can(bus) => bus.join(),
            Medium::Serial(line) => line.join(),
            Medium::Stream(stream) => stream.join(),
        }
    }

    pub(super) fn set_line(&mut self, node: usize, line: Line, now: Instant) {
        match self {
            Medium::Can(bus) => bus.set_line(node, line, now),
            Medium::Serial(serial) => serial.set_line(node, line, now),
            Medium::Stream(stream) => stream.set_line(node, line),
        }
    }

    /// Whether a node can be set so here.
    pub(super) fn takes(&self, line: Line) -> bool {
        match line {
            Line::Off => true,
            Line::Can { .. } => matches!(self, Medium::Can(_)),
            Line::Serial(_) => matches!(self, Medium::Serial(_)),
            Line::Stream(_) => matches!(self, Medium::Stream(_)),
        }
    }

    /// Whether `what` can be sent here.
    pub(super) fn carries(&self, what: &Transmission) -> bool {
        match what {
            Transmission::Frame(_) => matches!(self, Medium::Can(_)),
            Transmission::Characters(_) => !matches!(self, Medium::Can(_)),
            Transmission::Close => false,
        }
    }

    /// Gives `what` to `node` to send. What the medium cannot carry is lost, as is everything while the node is off.
    pub(super) fn push(&mut self, node: usize, from: Source, what: Transmission, now: Instant) {
        match (self, what) {
            (Medium::Can(bus), Transmission::Frame(frame)) => bus.push(node, from, frame),
            (Medium::Serial(line), Transmission::Characters(characters)) => {
                line.push(node, from, &characters, now);
            }
            (Medium::Stream(stream), what) => stream.push(node, from, what, now),
            (Medium::Can(_) | Medium::Serial(_), _) => {}
        }
    }

    pub(super) fn withdraw(&mut self, node: usize, from: Source) {
        match self {
            Medium::Can(bus) => bus.withdraw(node, from),
            Medium::Serial(line) => line.withdraw(node, from),
            // What was given to a connection is on its way.
            Medium::Stream(_) => {}
        }
    }

    pub(super) fn is_sending(&self, node: usize) -> bool {
        match self {
            Medium::Can(bus) => bus.is_sending(node),
            Medium::Serial(line) => line.is_sending(node),
            Medium::Stream(_) => false,
        }
    }

    /// When something is next to be started by [`Medium::start`].
    pub(super) fn starts_at(&self, now: Instant) -> Instant {
        match self {
            Medium::Can(bus) => bus.starts_at(now),
            // Nobody waits for a serial line or a connection to be idle.
            Medium::Serial(_) | Medium::Stream(_) => Instant::NEVER,
        }
    }

    pub(super) fn start(&mut self, now: Instant) {
        match self {
            Medium::Can(bus) => bus.start(now),
            Medium::Serial(_) | Medium::Stream(_) => {}
        }
    }

    pub(super) fn ends_at(&self) -> Instant {
        match self {
            Medium::Can(bus) => bus.ends_at(),
            Medium::Serial(line) => line.ends_at(),
            Medium::Stream(stream) => stream.ends_at(),
        }
    }

    pub(super) fn end(&mut self) -> Option<Delivery> {
        match self {
            Medium::Can(bus) => bus.end(),
            Medium::Serial(line) => line.end(),
            Medium::Stream(stream) => stream.end(),
        }
    }

    /// How `node` hears what was delivered, if it does.
    pub(super) fn hears(&self, node: usize, delivery: &Delivery) -> Option<Reception> {
        match (self, delivery.line, delivery.what) {
            (Medium::Can(bus), Line::Can { bit_rate }, what) => {
                bus.hears(node, bit_rate, delivery.start).then_some(what)
            }
            (Medium::Serial(line), Line::Serial(settings), Reception::Character(character)) => line
                .hears(node, settings, delivery.start, character)
                .map(Reception::Character),
            (Medium::Stream(stream), _, what) => stream.hears(node).then_some(what),
            _ => None,
        }
    }
}
