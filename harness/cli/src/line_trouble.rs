//! What can be wrong with the line between the tester and a simulated device, and what the verdicts must come to then.

use std::num::NonZeroU32;
use std::time::Duration;

use fieldproof_devices::DeviceKind;
use fieldproof_devices::Medium;
use fieldproof_link::{
    BusError, FaultyLine, Lane, Line, LineFault, LinkError, PortIndex, PortProperties, Transmission,
};
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
        ..master_before("found-enabled", ENABLED)
    },
    NamedTrouble {
        must: Must::FailNothing,
        ..master_before("found-configured", CONFIGURATION)
    },
];

/// A drive that another master has enabled, in velocity mode.
const ENABLED: &[&str] = &[
    "000#0100",
    "SDO#2F60600003000000",
    "SDO#2B40600006000000",
    "SDO#2B40600007000000",
    "SDO#2B4060000F000000",
];

/// Much that another master may have stored: heartbeat, guarding, heartbeats that are watched, inhibit time of EMCY,
/// and EMCY, SYNC, TIME, RPDO1 and TPDO1 under other identifiers. A device refuses what it does not have.
const CONFIGURATION: &[&str] = &[
    "SDO#2B171000C8000000",
    "SDO#2B0C100064000000",
    "SDO#2F0D100003000000",
    "SDO#23161001E8037000",
    "SDO#2B151000F4010000",
    "SDO#2305100092060000",
    "SDO#2312100093060000",
    "SDO#2314100091060080",
    "SDO#2314100091060000",
    "SDO#2300140180060080",
    "SDO#2300140180060000",
    "SDO#2300180190060080",
    "SDO#2F00180201000000",
    "SDO#2300180190060040",
    "SDO#2310100173617665",
    "000#8100",
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

/// How long another master lets a device go on between two frames.
const MASTER_PAUSE: Duration = Duration::from_millis(50);

impl NamedTrouble {
    /// Whether the device is one that was configured.
    pub(crate) fn configures(&self) -> bool {
        self.trouble == LineTrouble::MasterBefore(CONFIGURATION)
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
            LineTrouble::MasterBefore(frames) => {
                let is_can = |port: &PortProperties| matches!(port.line, Line::Can { .. });
                let can = lane.ports().iter().position(is_can);
                let node = device.canopen.as_ref().map(|canopen| canopen.node);
                if let (Some(can), Some(node)) = (can, node) {
                    let request = format!("{:03X}", 0x600 + u16::from(node));
                    let frames = frames.iter().map(|frame| frame.replace("SDO", &request));
                    // A link that fails will fail again for the tester, who says so.
                    let _ = play(lane.as_mut(), PortIndex(can), frames, device.timing.boot_up);
                }
            }
        }
        lane
    }
}

/// Sends frames to a device that has booted; nobody hears what it says.
fn play(
    lane: &mut dyn Lane,
    port: PortIndex,
    frames: impl Iterator<Item = String>,
    boot_up: Duration,
) -> Result<(), LinkError> {
    let mut until = lane.now() + boot_up;
    while lane.receive(until)?.is_some() {}
    for frame in frames.filter_map(|frame| frame.parse().ok()) {
        lane.send(port, until, Transmission::Frame(frame))?;
        until = lane.now() + MASTER_PAUSE;
        while lane.receive(until)?.is_some() {}
    }
    Ok(())
}
