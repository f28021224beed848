//! Conditions under which a device refuses to have its values written or read.

use std::collections::BTreeSet;

use fieldproof_link::{Instant, NotOffered, StateName, StateValue};

use crate::canopen::{Abort, Answer, HARDWARE, Slave};

/// With an EMCY; the others come without one.
const HARDWARE_FAULT: &str = "hardware-fault";
/// The panel has control.
const LOCAL_CONTROL: &str = "local-control";

/// What a condition makes impossible.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Refuses {
    Writing,
    Reading,
    Both,
}

/// What there is, and how an access is refused under it.
const CONDITIONS: &[(&str, Refuses, Abort)] = &[
    (HARDWARE_FAULT, Refuses::Writing, Abort::HARDWARE),
    (LOCAL_CONTROL, Refuses::Writing, Abort::LOCAL_CONTROL),
    ("wrong-device-state", Refuses::Writing, Abort::DEVICE_STATE),
    ("storage-refused", Refuses::Writing, Abort::CANNOT_STORE),
    ("out-of-memory", Refuses::Writing, Abort::OUT_OF_MEMORY),
    (
        "internal-incompatibility",
        Refuses::Writing,
        Abort::INTERNAL,
    ),
    ("general-error", Refuses::Writing, Abort::GENERAL),
    ("no-connection-left", Refuses::Both, Abort::NO_CONNECTION),
    ("no-dictionary", Refuses::Both, Abort::NO_DICTIONARY),
    ("no-data", Refuses::Reading, Abort::NO_DATA),
];

/// Those that hold.
#[derive(Debug, Default)]
pub(crate) struct Conditions {
    active: BTreeSet<&'static str>,
}

impl Conditions {
    /// Brings the condition called `name` about, or ends it.
    ///
    /// # Errors
    /// [`NotOffered`]: there is none of this name.
    pub(crate) fn set(
        &mut self,
        now: Instant,
        name: &str,
        active: bool,
        slave: &mut Slave,
    ) -> Result<(), NotOffered> {
        let found = CONDITIONS.iter().find(|(known, ..)| *known == name);
        let (name, ..) = found.ok_or(NotOffered)?;
        let changed = if active {
            self.active.insert(name)
        } else {
            self.active.remove(name)
        };
        if changed && *name == HARDWARE_FAULT {
            slave.set_error(now, HARDWARE, active);
        }
        Ok(())
    }

    /// What a write is answered under them.
    pub(crate) fn answer(&self) -> Answer {
        self.answer_to(Refuses::Writing)
    }

    /// Whether the panel has control.
    pub(crate) fn is_local(&self) -> bool {
        self.active.contains(LOCAL_CONTROL)
    }

    /// What a read is answered under them.
    pub(crate) fn answer_to_reading(&self) -> Answer {
        self.answer_to(Refuses::Reading)
    }

    fn answer_to(&self, access: Refuses) -> Answer {
        let mut holding = CONDITIONS.iter().filter(|(name, refuses, _)| {
            self.active.contains(name) && (*refuses == access || *refuses == Refuses::Both)
        });
        holding
            .next()
            .map_or(Answer::Now, |(_, _, abort)| Answer::Refused(*abort))
    }

    pub(crate) fn state(&self) -> impl Iterator<Item = (StateName, StateValue)> {
        CONDITIONS
            .iter()
            .map(|(name, ..)| ((*name).into(), self.active.contains(name).into()))
    }
}
