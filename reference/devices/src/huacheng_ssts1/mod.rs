//! A Huacheng SSTS1 servo drive: port 0 on CAN (1 Mbit/s, node 1), port 1 on a serial line (19200 8E1, address 1).

pub(crate) mod registers;

use std::sync::LazyLock;
use std::time::Duration;

use fieldproof_dictionary::{Dictionary, eds};
use fieldproof_link::{
    Instant, Line, NotOffered, Outbox, Participant, Reception, State, Stimulus, StimulusKind,
    Transmission,
};

use crate::canopen::{
    self, Address, Factory, Profile, TransmitEvent, error_control_faults, faults, nmt_faults,
    service_faults,
};
use crate::catalogue::{
    Behaviour, DeviceKind, Fault, Medium, PortKind, Settings, UnknownFault, Variant,
};
use crate::drive::{self, DriveNode, Model};
use crate::modbus::{self, ModbusSlave};
use registers::DriveRegisters;

const NODE: u8 = 1;
const BIT_RATE: u32 = 1_000_000;
const BIT_RATES: &[u32] = &[
    1_000_000, 800_000, 500_000, 250_000, 125_000, 50_000, 20_000,
];
const CAN: usize = 0;
const SERIAL: usize = 1;

/// The faults of this device alone.
const OWN_FAULTS: &[Fault] = &[
    nmt_faults::APPLICATION_KEPT_BY_RESET_NODE,
    nmt_faults::COMMUNICATION_KEPT_BY_RESET_COMMUNICATION,
    error_control_faults::LIFE_TIME_WITHOUT_FACTOR,
    service_faults::LOST_MASTER_UNNOTICED,
    faults::MAPPING_ENTRY_BYTE_ORDER,
    faults::GUARDING_TOGGLE_STUCK,
    faults::SYNC_NOT_STOPPED,
    faults::EMERGENCY_WITHOUT_REGISTER,
    modbus::faults::WRITE_MULTIPLE_FORGETS,
];
const FAULTS: &[&[Fault]] = &[
    faults::COMMON,
    nmt_faults::COMMON,
    error_control_faults::COMMON,
    modbus::faults::COMMON,
    modbus::faults::LINE,
    modbus::faults::WRITES,
    OWN_FAULTS,
    drive::faults::COMMON,
    drive::faults::VALUES,
];

/// Section 4.3 names the modes: profile position, velocity and torque, homing, and the cyclic synchronous ones. The
/// unit of velocity is rpm; ten thousand pulses are a revolution of the motor that section 1 has its defaults for.
const MODEL: Model = Model {
    modes: &[1, 3, 4, 6, 8, 9, 10],
    position: Address::new(0x6064, 0),
    counts_a_second: (10_000, 60),
    alarm: Some(Address::new(0x2100, 0)),
};

/// What can be built.
pub(crate) const KIND: DeviceKind = DeviceKind {
    name: "huacheng-ssts1",
    title: "Huacheng SSTS1 low-voltage servo drive",
    ports: &[
        PortKind {
            role: "can",
            medium: Medium::Can { bit_rate: BIT_RATE },
        },
        PortKind {
            role: "serial",
            medium: Medium::Serial(registers::LINE),
        },
    ],
    faults: FAULTS,
    variants: &[
        Variant {
            name: "sdo-in-stopped",
            words: "answers SDO requests in Stopped, as the prose of its manual has it and the table does not",
            apply: |behaviour| behaviour.canopen.sdo_in_stopped = true,
        },
        canopen::variants::NO_TPDO_ON_START,
        canopen::variants::REMOTE_FRAMES_IGNORED,
        canopen::variants::HEARTBEAT_AT_ONCE,
        canopen::variants::SLOW,
        drive::variants::BRAKE,
        drive::variants::ENABLED_STEP_BY_STEP,
        drive::variants::QUICK_STOP_BIT_AT_REST,
        drive::variants::MODE_SWITCHED_LATER,
        drive::variants::UNSUPPORTED_MODE_PASSED_OVER,
    ],
    build,
};

/// What the manual documents.
fn documented() -> Behaviour {
    Behaviour {
        modbus: registers::DOCUMENTED,
        ..Behaviour::default()
    }
}

static DICTIONARY: LazyLock<Dictionary> = LazyLock::new(|| {
    eds::read(include_str!(
        "../../../../fixtures/devices/huacheng-ssts1/huacheng-ssts1.eds"
    ))
    .dictionary
});

fn profile() -> Profile {
    Profile {
        dictionary: &DICTIONARY,
        boot_time: Duration::from_millis(20),
        produces_sync: true,
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
    let address = settings.address.unwrap_or(registers::ADDRESS);
    let registers = DriveRegisters::new(address, registers::LINE);
    let modbus = ModbusSlave::new(registers, behaviour.modbus.clone(), settings.seed);
    Ok(Box::new(HuachengSsts1 {
        node: DriveNode::new(&MODEL, profile(), behaviour, factory),
        modbus: modbus.over(settings.framing),
        powered: true,
    }))
}

/// The drive on its two ports.
#[derive(Debug)]
struct HuachengSsts1 {
    node: DriveNode,
    modbus: ModbusSlave<DriveRegisters>,
    powered: bool,
}

impl HuachengSsts1 {
    fn power(&mut self, now: Instant, on: bool) {
        self.powered = on;
        if on {
            self.modbus.registers_mut().power_on();
        }
        self.modbus.restart();
        self.node.power(now, on);
    }

    fn switch(&mut self, now: Instant, name: &str, value: i64) -> Result<(), NotOffered> {
        match name {
            "node" => self.node.slave.set_node(now, value),
            "bit-rate" => self.node.slave.set_bit_rate(value, BIT_RATES),
            "address" => self.modbus.registers_mut().set_address(value),
            "baud" => {
                self.modbus.registers_mut().set_baud(value)?;
                self.modbus.restart();
                Ok(())
            }
            _ => Err(NotOffered),
        }
    }
}

impl Participant for HuachengSsts1 {
    fn line(&self, port: usize) -> Line {
        match port {
            SERIAL if self.powered => self.modbus.line(),
            CAN => self.node.slave.line(),
            _ => Line::Off,
        }
    }

    fn receive(&mut self, now: Instant, port: usize, reception: Reception, _: &mut Outbox) {
        match (port, reception) {
            (CAN, Reception::Frame(frame)) => {
                self.node.receive(now, &frame);
            }
            (SERIAL, Reception::Character(character)) if self.powered => {
                self.modbus.receive(now, character);
            }
            _ => {}
        }
    }

    fn wake_at(&self) -> Option<Instant> {
        let serial = self.modbus.wake_at().filter(|_| self.powered);
        [self.node.wake_at(), serial].into_iter().flatten().min()
    }

    fn wake(&mut self, now: Instant, out: &mut Outbox) {
        self.node.wake(now, CAN, out);
        if self.powered
            && self.modbus.wake_at().is_some_and(|at| at <= now)
            && let Some(characters) = self.modbus.wake(now)
        {
            out.send(SERIAL, Transmission::Characters(characters));
        }
    }

    /// Process values: objects (`6064:00`) and parameters (`P212`, `register 00D4`).
    fn stimulate(
        &mut self,
        now: Instant,
        stimulus: &Stimulus,
        _: &mut Outbox,
    ) -> Result<(), NotOffered> {
        match stimulus {
            Stimulus::Power { on } => self.power(now, *on),
            Stimulus::ProcessValue { name, value } if name.contains(':') => {
                self.node.slave.set_process_value(name, *value)?;
            }
            Stimulus::ProcessValue { name, value } => {
                let registers = self.modbus.registers_mut();
                registers.set_process_value(name, *value)?;
            }
            Stimulus::Condition { name, active } => {
                self.node.set_condition(now, name, *active)?;
            }
            Stimulus::Setting { name, value } => self.switch(now, name, *value)?,
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
        use modbus::Registers as _;
        let mut state = self.node.state();
        state.extend(self.modbus.registers().state());
        state
    }
}

#[cfg(test)]
mod tests;
