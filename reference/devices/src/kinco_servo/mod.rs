//! A Kinco servo drive on CAN: 500 kbit/s, node 1.

use std::sync::LazyLock;
use std::time::Duration;

use fieldproof_dictionary::{Dictionary, eds};
use fieldproof_link::{
    Instant, Line, NotOffered, Outbox, Participant, Reception, State, Stimulus, StimulusKind,
};

use crate::canopen::{
    self, Address, Factory, Profile, TransmitEvent, error_control_faults, faults, nmt_faults,
    service_faults,
};
use crate::catalogue::{
    Behaviour, DeviceKind, Fault, Medium, PortKind, Settings, UnknownFault, Variant,
};
use crate::drive::{self, DriveNode, Model};

const NODE: u8 = 1;
const BIT_RATE: u32 = 500_000;
const BIT_RATES: &[u32] = &[
    1_000_000, 800_000, 500_000, 250_000, 125_000, 50_000, 20_000,
];
const PORT: usize = 0;

/// The faults of this device alone.
const OWN_FAULTS: &[Fault] = &[
    nmt_faults::EMERGENCY_SENT_IN_STOPPED,
    nmt_faults::APPLICATION_KEPT_BY_RESET_NODE,
    error_control_faults::LIFE_TIME_WITHOUT_FACTOR,
    error_control_faults::CONSUMER_TIME_HALVED,
    service_faults::LOST_HEARTBEAT_UNNOTICED,
    faults::TOGGLE_NOT_ALTERNATED,
    faults::SDO_ANSWERED_IN_STOPPED,
    faults::GUARDING_TOGGLE_STUCK,
    faults::MAPPING_ENTRY_BYTE_ORDER,
];
const FAULTS: &[&[Fault]] = &[
    faults::COMMON,
    nmt_faults::COMMON,
    error_control_faults::COMMON,
    OWN_FAULTS,
    drive::faults::COMMON,
    drive::faults::OPTIONS,
];

/// The slides have what profile position (607Ah, 6081h) and profile velocity (60FFh) need, and no other mode.
const MODEL: Model = Model {
    modes: &[1, 3],
    position: Address::new(0x6063, 0),
    counts_a_second: (1, 1),
    alarm: None,
};

/// What can be built.
pub(crate) const KIND: DeviceKind = DeviceKind {
    name: "kinco-servo",
    title: "Kinco servo drive",
    ports: &[PortKind {
        role: "can",
        medium: Medium::Can { bit_rate: BIT_RATE },
    }],
    faults: FAULTS,
    variants: &[
        Variant {
            name: "download-data-not-echoed",
            words: "leaves bytes 4 to 7 of a download response 0, as CiA 301 has it",
            apply: |behaviour| behaviour.canopen.echo_download_data = false,
        },
        canopen::variants::NO_TPDO_ON_START,
        canopen::variants::REMOTE_FRAMES_IGNORED,
        canopen::variants::HEARTBEAT_AT_ONCE,
        canopen::variants::SLOW,
        drive::variants::BRAKE,
        drive::variants::ENABLED_STEP_BY_STEP,
        drive::variants::QUICK_STOP_NOT_RESUMED,
        drive::variants::QUICK_STOP_BIT_AT_REST,
        drive::variants::MODE_SWITCHED_LATER,
        drive::variants::UNSUPPORTED_MODE_PASSED_OVER,
    ],
    build,
};

/// What the manual documents.
fn documented() -> Behaviour {
    Behaviour {
        canopen: canopen::Behaviour {
            echo_download_data: true,
            ..canopen::Behaviour::default()
        },
        ..Behaviour::default()
    }
}

static DICTIONARY: LazyLock<Dictionary> = LazyLock::new(|| {
    eds::read(include_str!(
        "../../../../fixtures/devices/kinco-servo/kinco-servo.eds"
    ))
    .dictionary
});

fn profile() -> Profile {
    Profile {
        dictionary: &DICTIONARY,
        boot_time: Duration::from_millis(8),
        produces_sync: false,
        guarding: true,
        consumes_heartbeats: true,
        transmit_event: TransmitEvent::Change,
        lowest_transmit_type: 0,
        lss: None,
        saved_on_write: &[],
        node_object: None,
        bit_rate_object: None,
        complete: false,
        clock_object: None,
        twins: &[],
    }
}

fn build(settings: &Settings) -> Result<Box<dyn Participant>, UnknownFault> {
    let behaviour = KIND.behaviour(documented(), settings)?;
    let factory = Factory {
        node: settings.node.unwrap_or(NODE),
        bit_rate: BIT_RATE,
        seed: settings.seed,
    };
    let node = DriveNode::new(&MODEL, profile(), behaviour, factory);
    Ok(Box::new(KincoServo { node }))
}

/// The drive on its bus.
#[derive(Debug)]
struct KincoServo {
    node: DriveNode,
}

impl Participant for KincoServo {
    fn line(&self, _: usize) -> Line {
        self.node.slave.line()
    }

    fn receive(&mut self, now: Instant, _: usize, reception: Reception, _: &mut Outbox) {
        if let Reception::Frame(frame) = reception {
            self.node.receive(now, &frame);
        }
    }

    fn wake_at(&self) -> Option<Instant> {
        self.node.wake_at()
    }

    fn wake(&mut self, now: Instant, out: &mut Outbox) {
        self.node.wake(now, PORT, out);
    }

    fn stimulate(
        &mut self,
        now: Instant,
        stimulus: &Stimulus,
        _: &mut Outbox,
    ) -> Result<(), NotOffered> {
        match stimulus {
            Stimulus::Power { on } => self.node.power(now, *on),
            Stimulus::ProcessValue { name, value } => {
                self.node.slave.set_process_value(name, *value)?;
            }
            Stimulus::Condition { name, active } => {
                self.node.set_condition(now, name, *active)?;
            }
            Stimulus::Setting { name, value } => match name.as_str() {
                "node" => self.node.slave.set_node(now, *value)?,
                "bit-rate" => self.node.slave.set_bit_rate(*value, BIT_RATES)?,
                _ => return Err(NotOffered),
            },
        }
        Ok(())
    }

    fn offers(&self) -> Vec<StimulusKind> {
        vec![
            StimulusKind::Power,
            StimulusKind::ProcessValue,
            StimulusKind::Condition,
            StimulusKind::Setting,
        ]
    }

    fn state(&self) -> State {
        self.node.state()
    }
}

#[cfg(test)]
mod tests;
