//! A Liaomiao multi-turn encoder: port 0 on CAN (250 kbit/s, node 32), port 1 on a serial line (9600 8N1, address 32).
//! Both show the same shaft.

mod behaviour;
mod model;
mod registers;
mod shaft;

use std::sync::LazyLock;
use std::time::Duration;

use fieldproof_dictionary::{Dictionary, eds};
use fieldproof_link::{
    Instant, Line, NotOffered, Outbox, Participant, Reception, State, Stimulus, StimulusKind,
    Transmission,
};

use crate::canopen::{
    self, Address, Factory, LssAbilities, Profile, Slave, TransmitEvent, error_control_faults,
    faults, lss_faults, nmt_faults,
};
use crate::catalogue::{DeviceKind, Fault, Medium, PortKind, Settings, UnknownFault, Variant};
use crate::modbus::{self, ModbusSlave};
pub use behaviour::{Behaviour, PresetEffect};
use model::EncoderModel;
use registers::EncoderRegisters;
use shaft::Shaft;

const NODE: u8 = 32;
const BIT_RATE: u32 = 250_000;
/// By their code in 3001h and their index in LSS table 0.
const BIT_RATES: &[u32] = &[
    1_000_000, 800_000, 500_000, 250_000, 125_000, 100_000, 50_000, 20_000, 10_000,
];
/// The event timer of TPDO1 is the cyclic timer.
const TWINS: &[(Address, Address)] = &[(Address::new(0x6200, 0), Address::new(0x1800, 5))];
/// Beside 2003h and 6000h, which the model holds.
const SAVED_ON_WRITE: &[u16] = &[0x2002, 0x2004, 0x2005, 0x6003, 0x6200];
const CAN: usize = 0;
const SERIAL: usize = 1;

/// The faults of this device alone.
const OWN_FAULTS: &[Fault] = &[
    faults::TOGGLE_NOT_ALTERNATED,
    faults::SDO_ANSWERED_IN_STOPPED,
    faults::GUARDING_TOGGLE_STUCK,
    faults::EVENT_TIMER_UNIT,
    faults::TPDO_NOT_REFRESHED,
    faults::LSS_STORE_FORGETS,
    faults::LSS_SERIAL_IGNORED,
    faults::LSS_SELECTION_NOT_CONFIRMED,
    faults::LSS_CONFIGURATION_UNCHECKED,
    faults::LSS_BIT_TIMING_MISSING,
    faults::LSS_IDENTITY_BYTE_ORDER,
    faults::LSS_REVISION_ANSWERS_5B,
    faults::NODE_ID_ACTIVE_BEFORE_RESET,
    IDENTITY_OF_THE_TEMPLATE,
    modbus::faults::SPEED_SIGN_LOST,
    modbus::faults::ADDRESS_CHANGE_NOT_ANSWERED,
    modbus::faults::ADDRESS_CHANGE_ANSWERED_FROM_OLD,
    modbus::faults::ADDRESS_TEXT_IGNORED,
];
const ENCODER_FAULTS: &[Fault] = behaviour::FAULTS;
const FAULTS: &[&[Fault]] = &[
    faults::COMMON,
    nmt_faults::COMMON,
    error_control_faults::COMMON,
    modbus::faults::COMMON,
    modbus::faults::LINE,
    modbus::faults::WRITES,
    OWN_FAULTS,
    lss_faults::EVERY,
    ENCODER_FAULTS,
];

/// What can be built.
pub(crate) const KIND: DeviceKind = DeviceKind {
    name: "liaomiao-encoder",
    title: "Liaomiao multi-turn absolute encoder",
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
            name: "tpdo-on-start",
            words: "sends TPDO1 on entering Operational, as newer editions of CiA 406 have it, then every period",
            apply: |behaviour| behaviour.canopen.tpdo_on_start = true,
        },
        behaviour::POSITION_JUMPS_WITH_DIRECTION,
        canopen::variants::REMOTE_FRAMES_IGNORED,
        canopen::variants::HEARTBEAT_AT_ONCE,
        canopen::variants::SLOW,
    ],
    build,
};

const IDENTITY_OF_THE_TEMPLATE: Fault = Fault {
    name: "identity-of-the-template",
    breaks: "CiA 301: object 1018h, the vendor-ID is the one CiA gave; Liaomiao encoder manual, section 6",
    words: "has left in 1018h what a template had: vendor 0, product 0, revision 1, serial number 1",
    caught_by: "lss",
    apply: |behaviour| behaviour.canopen.identity = Some([0, 0, 1, 1]),
};

/// What the manual documents.
fn documented() -> crate::Behaviour {
    crate::Behaviour {
        canopen: canopen::Behaviour {
            tpdo_on_start: false,
            ..canopen::Behaviour::default()
        },
        ..crate::Behaviour::default()
    }
}

static DICTIONARY: LazyLock<Dictionary> = LazyLock::new(|| {
    eds::read(include_str!(
        "../../../../fixtures/devices/liaomiao-encoder/liaomiao-encoder.eds"
    ))
    .dictionary
});

fn profile(behaviour: &Behaviour) -> Profile {
    Profile {
        dictionary: &DICTIONARY,
        boot_time: Duration::from_millis(12),
        produces_sync: false,
        guarding: true,
        consumes_heartbeats: false,
        transmit_event: TransmitEvent::TimerOnly,
        lowest_transmit_type: 0,
        lss: Some(LssAbilities {
            bit_rates: BIT_RATES,
        }),
        saved_on_write: if behaviour.settings_saved {
            SAVED_ON_WRITE
        } else {
            &[]
        },
        node_object: Some(Address::new(0x3000, 0)),
        bit_rate_object: Some(Address::new(0x3001, 0)),
        complete: false,
        clock_object: None,
        twins: if behaviour.cyclic_timer_is_event_timer {
            TWINS
        } else {
            &[]
        },
    }
}

fn build(settings: &Settings) -> Result<Box<dyn Participant>, UnknownFault> {
    let behaviour = KIND.behaviour(documented(), settings)?;
    let factory = Factory {
        node: settings.node.unwrap_or(NODE),
        bit_rate: BIT_RATE,
        seed: settings.seed,
    };
    let mut registers = EncoderRegisters::new(settings.address.unwrap_or(registers::ADDRESS));
    let mut shaft = Shaft {
        model: &mut registers.model,
        behaviour: &behaviour.encoder,
    };
    let profile = profile(&behaviour.encoder);
    let slave = Slave::new(profile, behaviour.canopen, factory, &mut shaft);
    Ok(Box::new(LiaomiaoEncoder {
        slave,
        modbus: ModbusSlave::new(registers, behaviour.modbus, settings.seed).over(settings.framing),
        powered: true,
        behaviour: behaviour.encoder,
    }))
}

/// The encoder on its two ports.
#[derive(Debug)]
struct LiaomiaoEncoder {
    slave: Slave,
    modbus: ModbusSlave<EncoderRegisters>,
    powered: bool,
    behaviour: Behaviour,
}

impl LiaomiaoEncoder {
    /// The CAN side, and the shaft that it shows.
    fn can(&mut self) -> (&mut Slave, Shaft<'_>) {
        let shaft = Shaft {
            model: &mut self.modbus.registers_mut().model,
            behaviour: &self.behaviour,
        };
        (&mut self.slave, shaft)
    }

    /// The shaft has turned, or the serial side has set how it is shown.
    fn show(&mut self) {
        let (slave, shaft) = self.can();
        shaft.show(&mut slave.objects);
        slave.values_changed();
    }

    fn power(&mut self, now: Instant, on: bool) {
        self.powered = on;
        self.modbus.restart();
        let (slave, mut shaft) = self.can();
        slave.power(now, on, &mut shaft);
    }

    /// The shaft turns by `counts` of 1/65536 turn, clockwise where they are positive.
    fn turn(&mut self, counts: i64) -> Result<(), NotOffered> {
        let counts = i32::try_from(counts).map_err(|_| NotOffered)?;
        if self.powered || self.behaviour.turns_unpowered_counted {
            let model = &mut self.modbus.registers_mut().model;
            model.turn(counts, &self.behaviour);
        }
        Ok(())
    }

    fn switch(&mut self, now: Instant, name: &str, value: i64) -> Result<(), NotOffered> {
        match name {
            "node" => self.slave.set_node(now, value),
            "bit-rate" => self.slave.set_bit_rate(value, BIT_RATES),
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

impl Participant for LiaomiaoEncoder {
    fn line(&self, port: usize) -> Line {
        match port {
            SERIAL if self.powered => self.modbus.line(),
            CAN => self.slave.line(),
            _ => Line::Off,
        }
    }

    fn receive(&mut self, now: Instant, port: usize, reception: Reception, _: &mut Outbox) {
        match (port, reception) {
            (CAN, Reception::Frame(frame)) => {
                let (slave, mut shaft) = self.can();
                slave.receive(now, &frame, &mut shaft);
            }
            (SERIAL, Reception::Character(character)) if self.powered => {
                self.modbus.receive(now, character);
            }
            _ => {}
        }
    }

    fn wake_at(&self) -> Option<Instant> {
        let serial = self.modbus.wake_at().filter(|_| self.powered);
        [self.slave.wake_at(), serial].into_iter().flatten().min()
    }

    fn wake(&mut self, now: Instant, out: &mut Outbox) {
        let (slave, mut shaft) = self.can();
        slave.wake(now, CAN, &mut shaft, out);
        if !self.powered || self.modbus.wake_at().is_none_or(|at| at > now) {
            return;
        }
        let before = self.modbus.registers().model;
        if let Some(characters) = self.modbus.wake(now) {
            out.send(SERIAL, Transmission::Characters(characters));
        }
        if self.modbus.registers().model != before {
            self.show();
        }
    }

    /// Process values: `turn`, by which the shaft turns on, in 1/65536 turn, clockwise where positive; `position` in counts, `speed` in 1/10000 rpm, `temperature` in 1/100 °C, a measured register
    /// (`register 0004`), `6004:00` and `2000:00`.
    fn stimulate(
        &mut self,
        now: Instant,
        stimulus: &Stimulus,
        _: &mut Outbox,
    ) -> Result<(), NotOffered> {
        match stimulus {
            Stimulus::Power { on } => self.power(now, *on),
            Stimulus::ProcessValue { name, value } => {
                let name = match name.as_str() {
                    "6004:00" => "position",
                    "2000:00" => "speed",
                    other => other,
                };
                if name == "turn" {
                    self.turn(*value)?;
                } else {
                    let registers = self.modbus.registers_mut();
                    registers.set_process_value(name, *value)?;
                }
                self.show();
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

    fn state(&self) -> State {
        use modbus::Registers as _;
        let mut state = self.slave.state();
        state.extend(self.modbus.registers().state());
        state
    }
}

#[cfg(test)]
mod tests;
