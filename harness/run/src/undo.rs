//! What a case has changed, last first.

use fieldproof_link::{Line, PortIndex};
use fieldproof_suite::model::Span;
use fieldproof_wire::canopen::Multiplexer;

/// Something to put back.
#[derive(Debug, Clone)]
pub(crate) enum Undo {
    /// An object held these bytes.
    Object(Multiplexer, Vec<u8>),
    /// Registers from this one on held these values.
    Registers(u16, Vec<u16>),
    /// Coils in a row stood so, the first in the lowest bit of the first byte.
    Coils(Span, Vec<u8>),
    /// The power was on.
    PowerOn,
    /// A condition did not hold.
    Condition(String),
    /// A switch stood here.
    Setting(String, i64),
    /// The tester's side of a port was set so.
    Line(PortIndex, Line),
    /// What the tester plays on a port was as new.
    Companion(PortIndex),
}

impl Undo {
    /// Whether putting this back makes the other superfluous.
    fn covers(&self, other: &Undo) -> bool {
        match (self, other) {
            (Undo::Object(object, _), Undo::Object(other, _)) => object == other,
            (Undo::Registers(first, values), Undo::Registers(other, others)) => {
                first <= other
                    && usize::from(*other) + others.len() <= usize::from(*first) + values.len()
            }
            (Undo::PowerOn, Undo::PowerOn) => true,
            (Undo::Condition(name), Undo::Condition(other)) => name == other,
            (Undo::Setting(name, _), Undo::Setting(other, _)) => name == other,
            (Undo::Line(port, _), Undo::Line(other, _)) => port == other,
            (Undo::Companion(port), Undo::Companion(other)) => port == other,
            _ => false,
        }
    }
}

/// What is to be put back, last first.
#[derive(Debug, Default)]
pub(crate) struct UndoStack {
    entries: Vec<Undo>,
    closed: bool,
}

impl UndoStack {
    /// Remembers something, unless what it was before is remembered already: a value that only lay between would
    /// else be played back, and move a drive. Whether it was added.
    pub(crate) fn push(&mut self, undo: Undo) -> bool {
        let adds = !self.closed && !self.entries.iter().any(|known| known.covers(&undo));
        if adds {
            self.entries.push(undo);
        }
        adds
    }

    /// Whether the value of `object` before the case is known.
    pub(crate) fn remembers(&self, object: Multiplexer) -> bool {
        let known = |undo: &Undo| matches!(undo, Undo::Object(other, _) if *other == object);
        self.entries.iter().any(known)
    }

    /// Whether what is changed now is not put back in turn.
    pub(crate) fn is_closed(&self) -> bool {
        self.closed
    }

    /// While the case's own restore steps are played, what they change is not put back in turn.
    pub(crate) fn close(&mut self, closed: bool) {
        self.closed = closed;
    }

    pub(crate) fn pop(&mut self) -> Option<Undo> {
        self.entries.pop()
    }

    /// The last thing was not changed after all.
    pub(crate) fn forget_last(&mut self) {
        self.entries.pop();
    }

    /// Takes out the ports whose companions are to be put back: before everything else, which may need them.
    pub(crate) fn take_companions(&mut self) -> Vec<PortIndex> {
        let mut ports = Vec::new();
        self.entries.retain(|undo| match undo {
            Undo::Companion(port) => {
                ports.push(*port);
                false
            }
            _ => true,
        });
        ports
    }

    pub(crate) fn clear(&mut self) {
        self.entries.clear();
    }

    /// Puts `undo` back after everything else, unless its object is to be put back anyway.
    pub(crate) fn push_last(&mut self, object: Multiplexer, bytes: Vec<u8>) {
        if !self.remembers(object) {
            self.entries.insert(0, Undo::Object(object, bytes));
        }
    }
}
