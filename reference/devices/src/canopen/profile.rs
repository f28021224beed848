//! What a device can do, and what its objects mean to it.

use std::time::Duration;

use fieldproof_dictionary::Dictionary;

use super::{Abort, Address, Objects};

/// What a device can do.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Profile {
    pub(crate) dictionary: &'static Dictionary,
    /// From power-on or a reset to the boot-up message.
    pub(crate) boot_time: Duration,
    /// It can produce SYNC.
    pub(crate) produces_sync: bool,
    /// It answers node guarding.
    pub(crate) guarding: bool,
    /// It listens to the heartbeats of the nodes in 1016h.
    pub(crate) consumes_heartbeats: bool,
    /// What makes an event-driven TPDO leave.
    pub(crate) transmit_event: TransmitEvent,
    /// The lowest transmission type that a TPDO takes: 0, or 1 without acyclic ones.
    pub(crate) lowest_transmit_type: u8,
    pub(crate) lss: Option<LssAbilities>,
    /// The indexes whose values are saved when they are written.
    pub(crate) saved_on_write: &'static [u16],
    /// The objects of 8 bits that hold the node-ID and the bit-rate code and change them from the next reset on.
    pub(crate) node_object: Option<Address>,
    pub(crate) bit_rate_object: Option<Address>,
    /// It has what CiA 301 and CiA 305 leave to a device: transmission types 252 and 253, dummies in a mapping, late
    /// RPDOs, a counter in SYNC, TIME, a second SDO server, rules for every COB-ID; and LSS that activates a bit timing and finds slaves.
    pub(crate) complete: bool,
    /// The TIME_OF_DAY that a TIME sets.
    pub(crate) clock_object: Option<Address>,
    /// Objects that are one value; after a reset the second has what the first has.
    pub(crate) twins: &'static [(Address, Address)],
}

/// What makes an event-driven TPDO leave, beside its event timer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum TransmitEvent {
    /// A change of what it carries.
    Change,
    /// Nothing.
    TimerOnly,
}

/// What an LSS slave can do.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LssAbilities {
    /// Bit rates in bits a second by their index in table 0; 0 at an index that is reserved.
    pub(crate) bit_rates: &'static [u32],
}

/// How an application answers an access that comes from an SDO client or an RPDO.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Answer {
    /// The object dictionary does it.
    Now,
    /// It fails.
    Refused(Abort),
    /// The application does it and says so through [`super::Slave::finish`].
    Later,
}

/// What the objects of a device mean to it.
pub(crate) trait Application {
    /// `address` is to be read.
    fn reading(&mut self, address: Address) -> Answer {
        let _ = address;
        Answer::Now
    }

    /// `value` has the right length and is within the limits; it is to be written to `address`.
    fn writing(&mut self, address: Address, value: &[u8]) -> Answer {
        let _ = (address, value);
        Answer::Now
    }

    /// A value was written to `address`.
    fn written(&mut self, address: Address, objects: &mut Objects) {
        let _ = (address, objects);
    }

    /// The values of a reset are in `objects`; the application puts its process values there.
    fn reset(&mut self, objects: &mut Objects) {
        let _ = objects;
    }
}
