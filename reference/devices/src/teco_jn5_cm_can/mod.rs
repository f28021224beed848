//! A TECO JN5-CM-CAN module: port 0 on CAN (500 kbit/s, node 1), port 1 the Modbus master's line to an inverter (19200
//! 8N1, station 1). Behind port 1 stands an [`crate::inverter::Inverter`].

mod behaviour;
mod gateway;

use std::sync::LazyLock;
use std::time::Duration;

use fieldproof_dictionary::{Dictionary, eds};
use fieldproof_link::{
    Instant, Line, NotOffered, Outbox, Participant, Reception, State, StateName, Stimulus,
    StimulusKind, Transmission,
};

use crate::canopen::{
    self, Address, Factory, Profile, Slave, TransmitEvent, error_control_faults, faults, nmt_faults,
};
use crate::catalogue::{DeviceKind, Fault, Medium, PortKind, Settings, UnknownFault};
use crate::inverter;
pub use behaviour::{Behaviour, Lost, RunState, TargetSign};
use gateway::Gateway;

const NODE: u8 = 1;
/// The node-ID has six switches.
const HIGHEST_NODE: i64 = 63;
const BIT_RATE: u32 = 500_000;
const BIT_RATES: &[u32] = &[500_000, 250_000, 125_000, 50_000];
const SDO_REQUESTS: std::ops::RangeInclusive<u32> = 0x601..=0x67F;
const CAN: usize = 0;
const INVERTER: usize = 1;

/// The faults of this device alone.
const OWN_FAULTS: &[Fault] = &[
    faults::TOGGLE_NOT_ALTERNATED,
    faults::SDO_ANSWERED_IN_STOPPED,
    faults::MAPPING_ENTRY_BYTE_ORDER,
    behaviour::SWAPS_TWO_REGISTERS,
    behaviour::DIRECTION_LOST,
    behaviour::FAULT_RESET_LOST,
    behaviour::FREQUENCY_HALVED,
    behaviour::FREQUENCY_IN_15_BITS,
    behaviour::CONFIRMS_EARLY,
    behaviour::REFUSAL_HIDDEN,
    behaviour::TARGET_AS_INTEGER16,
    behaviour::DIRECTION_STOPS,
    behaviour::FAULT_RESET_BY_ANY_WRITE,
    behaviour::PDO_NOT_PASSED_ON,
    behaviour::NOT_POLLED,
    behaviour::RUN_STATE_OF_COMMAND,
    behaviour::RUN_STATE_FROZEN,
    behaviour::DEMAND_NOT_HALVED,
    behaviour::WRITES_ONE_FURTHER,
    behaviour::BYTE_ORDER,
    behaviour::LOST_INVERTER_READS_ZERO,
    behaviour::LOST_INVERTER_HANGS,
    behaviour::LOST_FOR_GOOD,
    behaviour::CRC_UNCHECKED,
    behaviour::STATION_UNCHECKED,
    behaviour::EXCEPTION_AS_VALUE,
];
const FAULTS: &[&[Fault]] = &[
    faults::COMMON,
    nmt_faults::COMMON,
    error_control_faults::COMMON,
    OWN_FAULTS,
];

/// What can be built.
pub(crate) const KIND: DeviceKind = DeviceKind {
    name: "teco-jn5-cm-can",
    title: "TECO JN5-CM-CAN module in front of a 510-series inverter",
    ports: &[
        PortKind {
            role: "can",
            medium: Medium::Can { bit_rate: BIT_RATE },
        },
        PortKind {
            role: "inverter",
            medium: Medium::Serial(inverter::LINE),
        },
    ],
    faults: FAULTS,
    variants: &[
        behaviour::STATUSWORD_OF_CIA402,
        behaviour::DEMAND_BEHIND_RAMP,
        behaviour::DEMAND_ROUNDED_UP,
        canopen::variants::REMOTE_FRAMES_IGNORED,
        canopen::variants::HEARTBEAT_AT_ONCE,
        canopen::variants::SLOW,
    ],
    build,
};

/// What the manual documents.
fn documented() -> crate::Behaviour {
    crate::Behaviour {
        canopen: canopen::Behaviour {
            // An asynchronous TPDO is sent by its event timer and by nothing else.
            tpdo_on_start: false,
            ..canopen::Behaviour::default()
        },
        ..crate::Behaviour::default()
    }
}

static DICTIONARY: LazyLock<Dictionary> = LazyLock::new(|| {
    eds::read(include_str!(
        "../../../../fixtures/devices/teco-jn5-cm-can/TECO_510_CAN.eds"
    ))
    .dictionary
});

fn profile() -> Profile {
    Profile {
        dictionary: &DICTIONARY,
        boot_time: Duration::from_millis(15),
        produces_sync: false,
        guarding: false,
        consumes_heartbeats: false,
        transmit_event: TransmitEvent::TimerOnly,
        lowest_transmit_type: 1,
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
    let mut gateway = Gateway::new(behaviour.gateway);
    let slave = Slave::new(profile(), behaviour.canopen, factory, &mut gateway);
    Ok(Box::new(TecoJn5CmCan {
        slave,
        gateway,
        powered: true,
    }))
}

/// The module on its two ports.
#[derive(Debug)]
struct TecoJn5CmCan {
    slave: Slave,
    gateway: Gateway,
    powered: bool,
}

impl TecoJn5CmCan {
    /// After everything that may have given the gateway something to do.
    fn go_on(&mut self, now: Instant) {
        self.gateway.keep_polling(now, self.slave.is_operational());
        self.gateway.go_on(now);
    }

    fn switch(&mut self, now: Instant, name: &str, value: i64) -> Result<(), NotOffered> {
        match name {
            "node" if value <= HIGHEST_NODE => self.slave.set_node(now, value),
            "bit-rate" => self.slave.set_bit_rate(value, BIT_RATES),
            _ => Err(NotOffered),
        }
    }
}

impl Participant for TecoJn5CmCan {
    fn line(&self, port: usize) -> Line {
        match port {
            INVERTER if self.powered => self.gateway.master.line(),
            CAN => self.slave.line(),
            _ => Line::Off,
        }
    }

    fn receive(&mut self, now: Instant, port: usize, reception: Reception, _: &mut Outbox) {
        match (port, reception) {
            (CAN, Reception::Frame(frame)) => {
                let from_client = SDO_REQUESTS.contains(&frame.id().raw());
                self.gateway.hears(from_client);
                self.slave.receive(now, &frame, &mut self.gateway);
                self.go_on(now);
            }
            (INVERTER, Reception::Character(character)) if self.powered => {
                self.gateway.master.receive(now, character);
            }
            _ => {}
        }
    }

    fn wake_at(&self) -> Option<Instant> {
        if !self.powered {
            return None;
        }
        let timers = [
            self.slave.wake_at(),
            self.gateway.master.wake_at(),
            self.gateway.poll_at,
        ];
        timers.into_iter().flatten().min()
    }

    fn wake(&mut self, now: Instant, out: &mut Outbox) {
        if !self.powered {
            return;
        }
        self.slave.wake(now, CAN, &mut self.gateway, out);
        self.go_on(now);
        if self.gateway.master.wake_at().is_some_and(|at| at <= now) {
            if let Some(characters) = self.gateway.master.wake(now) {
                out.send(INVERTER, Transmission::Characters(characters));
            }
            self.gateway.deliver(now, &mut self.slave);
        }
    }

    /// Process values are objects; one that the inverter would give (603Fh, 6041h, 6043h) is held until the inverter is
    /// commanded.
    fn stimulate(
        &mut self,
        now: Instant,
        stimulus: &Stimulus,
        _: &mut Outbox,
    ) -> Result<(), NotOffered> {
        match stimulus {
            Stimulus::Power { on } => {
                self.powered = *on;
                self.slave.power(now, *on, &mut self.gateway);
            }
            Stimulus::ProcessValue { name, value } => {
                self.slave.set_process_value(name, *value)?;
                self.gateway.held.extend(Address::parse(name));
            }
            Stimulus::Setting { name, value } => self.switch(now, name, *value)?,
            Stimulus::Condition { .. } => return Err(NotOffered),
        }
        Ok(())
    }

    fn offers(&self) -> Vec<StimulusKind> {
        vec![
            StimulusKind::Power,
            StimulusKind::ProcessValue,
            StimulusKind::Setting,
        ]
    }

    /// Without 2025h: its values are the inverter's.
    fn state(&self) -> State {
        let mut state = self.slave.state();
        state.retain(|name| !matches!(name, StateName::Object("", 0x2025, _)));
        state.insert("operation signal", self.gateway.operation());
        state
    }
}

#[cfg(test)]
mod tests;
