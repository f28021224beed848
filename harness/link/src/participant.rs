//! What takes part in a bus beside the tester: reference devices and the tester's own helpers.

use crate::{Instant, Line, Reception, State, Transmission};

/// Something on one or more buses, driven from outside (sans-IO): it is told what arrives and what time it is, puts
/// what it sends into the [`Outbox`], and says when it next wants to be woken.
///
/// The contract of every driver, simulated or real: `now` never goes back; [`Participant::wake`] is called at the
/// instant that [`Participant::wake_at`] last gave, or as soon after it as the driver can; `wake_at` is asked again
/// after every call.
pub trait Participant: Send {
    /// How it is set on its port `port` now. Asked before anything is given to it or taken from it.
    fn line(&self, port: usize) -> Line;

    /// `reception` arrived at its port `port`; `now` is the end of its last bit.
    fn receive(&mut self, now: Instant, port: usize, reception: Reception, out: &mut Outbox);

    /// When it wants to be woken, if at all.
    fn wake_at(&self) -> Option<Instant>;

    /// The instant it asked for has come.
    fn wake(&mut self, now: Instant, out: &mut Outbox);

    /// Something beside the bus is done to it.
    ///
    /// # Errors
    /// [`NotOffered`] if it has no such thing: another kind of stimulus, or an unknown name.
    fn stimulate(
        &mut self,
        now: Instant,
        stimulus: &Stimulus,
        out: &mut Outbox,
    ) -> Result<(), NotOffered> {
        let _ = (now, stimulus, out);
        Err(NotOffered)
    }

    /// The kinds of stimulus it offers.
    fn offers(&self) -> Vec<StimulusKind> {
        Vec::new()
    }

    /// Everything about it that a case could have left changed, as names and values: dictionary, registers, address,
    /// NMT and LSS state, non-volatile memory. Not: measured values, counters that only ever grow.
    fn state(&self) -> State {
        State::default()
    }
}

/// What a participant wants sent, in order, from now on.
#[derive(Debug, Default)]
pub struct Outbox {
    pending: Vec<(usize, Transmission)>,
}

impl Outbox {
    /// Sends `what` on the participant's port `port`. On CAN it then waits for the bus like any controller's frame;
    /// characters follow what the participant is already sending.
    pub fn send(&mut self, port: usize, what: Transmission) {
        self.pending.push((port, what));
    }

    /// Takes what is to be sent, in order.
    pub fn drain(&mut self) -> impl Iterator<Item = (usize, Transmission)> + '_ {
        self.pending.drain(..)
    }

    /// Whether nothing is to be sent.
    pub fn is_empty(&self) -> bool {
        self.pending.is_empty()
    }
}

/// It has no such thing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("not offered")]
pub struct NotOffered;

/// Something a bench does to a device beside the bus.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Stimulus {
    /// Power on or off.
    Power {
        /// On.
        on: bool,
    },
    /// Sets what the device measures or holds as a process value, in the raw unit of the object or register named.
    ProcessValue {
        /// `6063:00`, `register 0004`, or a name of the device's own such as `position`.
        name: String,
        /// The raw value.
        value: i64,
    },
    /// Brings a condition about or ends it: `hardware-fault`, `local-control`.
    Condition {
        /// The condition.
        name: String,
        /// Whether it holds from now on.
        active: bool,
    },
    /// Sets what switches or a front panel would set: `node`, `address`, `bit-rate`, `baud`. In effect at once.
    Setting {
        /// The setting.
        name: String,
        /// The value, in the unit of the setting (bit/s for rates).
        value: i64,
    },
}

/// The kind of a [`Stimulus`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum StimulusKind {
    /// [`Stimulus::Power`]
    Power,
    /// [`Stimulus::ProcessValue`]
    ProcessValue,
    /// [`Stimulus::Condition`]
    Condition,
    /// [`Stimulus::Setting`]
    Setting,
}

impl Stimulus {
    /// Its kind.
    pub fn kind(&self) -> StimulusKind {
        match self {
            Stimulus::Power { .. } => StimulusKind::Power,
            Stimulus::ProcessValue { .. } => StimulusKind::ProcessValue,
            Stimulus::Condition { .. } => StimulusKind::Condition,
            Stimulus::Setting { .. } => StimulusKind::Setting,
        }
    }
}
