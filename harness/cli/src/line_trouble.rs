//! What can be wrong with the line between the tester and a simulated device, and what the verdicts must come to then.

mod left;

use std::num::NonZeroU32;
use std::time::Duration;

use fieldproof_devices::DeviceKind;
use fieldproof_devices::Medium;
use fieldproof_link::{BusError, FaultyLine, Lane, LineFault, PortIndex};
use fieldproof_suite::device::DeviceDescription;

/// What is wrong.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LineTrouble {
    /// Frames and characters do not come through as they should.
    Fault(LineFault),
    /// Another node is on the bus, and busy.
    Neighbour,
    /// Another master was there before, and sent these frames. `SDO` stands for the identifier of the device's requests.
    MasterBefore(&'static [&'static str]),
    /// A Modbus client was there before, and sent these PDUs.
    ClientBefore(&'static [&'static [u8]]),
}

/// A trouble with its name.
#[derive(Debug, Clone, Copy)]
pub(crate) struct NamedTrouble {
    /// `frames-doubled`
    pub(crate) name: &'static str,
    pub(crate) trouble: LineTrouble,
    pub(crate) on: On,
    pub(crate) must: Must,
}

/// Lines that can have it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum On {
    Can,
    Serial,
    Both,
}

/// What the verdicts must come to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Must {
    /// No case passes: what it rests on is not there.
    PassNothing,
    /// No case passes in which the tester sends something.
    PassWhatIsOnlyHeard,
    /// Some case does not pass.
    Show,
    /// Everything passes: it is not the device's doing.
    PassAll,
    /// No case fails, though some may not be able to judge.
    FailNothing,
}

const fn every(number: u32) -> NonZeroU32 {
    match NonZeroU32::new(number) {
        Some(number) => number,
        None => NonZeroU32::MIN,
    }
}

const fn fault(name: &'static str, on: On, must: Must, fault: LineFault) -> NamedTrouble {
    NamedTrouble {
        name,
        trouble: LineTrouble::Fault(fault),
        on,
        must,
    }
}

/// A bus error: what a controller tells of an error frame.
const BUS_ERROR: BusError = BusError::new(1 << 7, [0; 8]);

pub(crate) const TROUBLES: &[NamedTrouble] = &[
    fault(
        "line-cut",
        On::Both,
        Must::PassNothing,
        LineFault::Drop { every: every(1) },
    ),
    fault(
        "tester-unheard",
        On::Both,
        Must::PassWhatIsOnlyHeard,
        LineFault::Deafen { every: every(1) },
    ),
    fault(
        "every-answer-damaged",
        On::Both,
        Must::Show,
        LineFault::Flip {
            every: every(1),
            mask: 0xFF,
        },
    ),
    fault(
        "frames-lost-now-and-then",
        On::Can,
        Must::Show,
        LineFault::Drop { every: every(40) },
    ),
    fault(
        "requests-lost-now-and-then",
        On::Both,
        Must::Show,
        LineFault::Deafen { every: every(40) },
    ),
    fault(
        "frames-doubled",
        On::Can,
        Must::Show,
        LineFault::Double { every: every(1) },
    ),
    fault(
        "frames-doubled-now-and-then",
        On::Can,
        Must::Show,
        LineFault::Double { every: every(40) },
    ),
    fault(
        "frames-damaged-now-and-then",
        On::Can,
        Must::Show,
        LineFault::Flip {
            every: every(40),
            mask: 0x10,
        },
    ),
    fault(
        "frames-passed-by-others",
        On::Can,
        Must::Show,
        LineFault::Delay {
            every: every(20),
            by: Duration::from_millis(30),
        },
    ),
    fault(
        "frames-by-priority",
        On::Can,
        // The device's own controller may send them in this order as well.
        Must::PassAll,
        LineFault::ByPriority {
            within: Duration::from_millis(2),
        },
    ),
    fault(
        "frames-late",
        On::Both,
        Must::Show,
        LineFault::Delay {
            every: every(1),
            by: Duration::from_secs(2),
        },
    ),
    fault(
        "error-frames",
        On::Can,
        Must::PassAll,
        LineFault::Disturb {
            every: every(10),
            error: BUS_ERROR,
        },
    ),
    fault(
        "bytes-lost-now-and-then",
        On::Serial,
        Must::Show,
        LineFault::Drop { every: every(150) },
    ),
    fault(
        "bytes-doubled-now-and-then",
        On::Serial,
        Must::Show,
        LineFault::Double { every: every(150) },
    ),
    fault(
        "bit-flipped-now-and-then",
        On::Serial,
        Must::Show,
        LineFault::Flip {
            every: every(150),
            mask: 0x04,
        },
    ),
    NamedTrouble {
        name: "busy-neighbour",
        trouble: LineTrouble::Neighbour,
        on: On::Can,
        must: Must::PassAll,
    },
    master_before("found-operational", &["000#0100"]),
    master_before("found-stopped", &["000#0200"]),
    master_before(
        "found-operational-with-heartbeat",
        &["SDO#2B171000C8000000", "000#0100"],
    ),
    master_before(
        "found-stopped-with-heartbeat",
        &["SDO#2B171000C8000000", "000#0200"],
    ),
    NamedTrouble {
        must: Must::FailNothing,
        ..master_before("found-enabled", left::ENABLED)
    },
    NamedTrouble {
        must: Must::FailNothing,
        ..master_before("found-configured", left::CONFIGURATION)
    },
    NamedTrouble {
        name: "found-written",
        trouble: LineTrouble::ClientBefore(left::WRITES),
        on: On::Serial,
        must: Must::FailNothing,
    },
];

/// Whatever another master left, a right device passes.
const fn master_before(name: &'static str, frames: &'static [&'static str]) -> NamedTrouble {
    NamedTrouble {
        name,
        trouble: LineTrouble::MasterBefore(frames),
        on: On::Can,
        must: Must::PassAll,
    }
}

impl NamedTrouble {
    /// Whether the device is one that was configured.
    pub(crate) fn configures(&self) -> bool {
        let configured = LineTrouble::MasterBefore(left::CONFIGURATION);
        self.trouble == configured || self.trouble == LineTrouble::ClientBefore(left::WRITES)
    }

    /// Whether a line of such a device can have it.
    pub(crate) fn fits(&self, kind: &DeviceKind) -> bool {
        kind.ports.iter().any(|port| match port.medium {
            Medium::Can { .. } => self.on != On::Serial,
            Medium::Serial(_) => self.on != On::Can,
            // What arrives on a connection is whole.
            Medium::Tcp => self.on == On::Both,
        })
    }
}

impl LineTrouble {
    /// `lane`, and the trouble on each of its ports that can have it.
    pub(crate) fn between(
        self,
        mut lane: Box<dyn Lane>,
        device: &DeviceDescription,
    ) -> Box<dyn Lane> {
        match self {
            LineTrouble::Neighbour => {}
            LineTrouble::Fault(fault) => {
                for port in 0..lane.ports().len() {
                    lane = Box::new(FaultyLine::new(lane, PortIndex(port), fault));
                }
            }
            // A link that fails will fail again for the tester, who says so.
            LineTrouble::MasterBefore(frames) => {
                let _ = left::by_master(lane.as_mut(), device, frames);
            }
            LineTrouble::ClientBefore(requests) => {
                let _ = left::by_client(lane.as_mut(), device, requests);
            }
        }
        lane
    }
}
