//! A slave that has all that CiA 301 and CiA 305 give one: 500 kbit/s, node 10. It is no vendor's.

use std::sync::LazyLock;
use std::time::Duration;

use fieldproof_dictionary::{Dictionary, eds};
use fieldproof_link::{
    Instant, Line, NotOffered, Outbox, Participant, Reception, State, Stimulus, StimulusKind,
};

use crate::canopen::{
    self, Address, BlockTransfer, Factory, LssAbilities, ObjectFault, ObjectFaultKind, Profile,
    Slave, TransmitEvent, block_faults, communication_faults, error_control_faults, faults,
    lss_faults, nmt_faults, pdo_faults, robustness_faults, sdo_faults, service_faults,
};
use crate::catalogue::{Behaviour, DeviceKind, Fault, Medium, PortKind, Settings, UnknownFault};

mod values;

use values::Values;

const NODE: u8 = 10;
const BIT_RATE: u32 = 500_000;
/// Table 0 of CiA 305; index 5 is reserved.
const BIT_RATES: &[u32] = &[
    1_000_000, 800_000, 500_000, 250_000, 125_000, 0, 50_000, 20_000, 10_000,
];
const PORT: usize = 0;

/// The faults of this device alone.
const OWN_FAULTS: &[Fault] = &[
    faults::TOGGLE_NOT_ALTERNATED,
    faults::SDO_ANSWERED_IN_STOPPED,
    faults::GUARDING_TOGGLE_STUCK,
    faults::SYNC_NOT_STOPPED,
    faults::EMERGENCY_WITHOUT_REGISTER,
    faults::EVENT_TIMER_UNIT,
    faults::MAPPING_ENTRY_BYTE_ORDER,
    faults::LSS_REVISION_ANSWERS_5B,
    faults::LSS_STORE_FORGETS,
    faults::LSS_SELECTION_NOT_CONFIRMED,
    faults::LSS_CONFIGURATION_UNCHECKED,
    faults::LSS_IDENTITY_BYTE_ORDER,
    faults::LSS_SERIAL_IGNORED,
    faults::LSS_BIT_TIMING_MISSING,
    faults::NODE_ID_ACTIVE_BEFORE_RESET,
    Fault {
        name: "structure-wrong",
        breaks: "CiA 301: sub-index FFh, object code and data type",
        words: "sub-index FFh of the array 2203h names another type than its elements have",
        caught_by: "sdo",
        apply: |behaviour| {
            let fault = ObjectFault::new(ObjectFaultKind::WrongDefault, 0x2203, 0xFF);
            behaviour.canopen.object_fault = Some(fault);
        },
    },
];
const FAULTS: &[&[Fault]] = &[
    faults::COMMON,
    nmt_faults::COMMON,
    nmt_faults::REST,
    error_control_faults::COMMON,
    error_control_faults::REST,
    service_faults::ALL,
    communication_faults::ALL,
    OWN_FAULTS,
    sdo_faults::ACCESS,
    sdo_faults::SEGMENTED,
    sdo_faults::ANY_LENGTH,
    sdo_faults::SERVERS,
    sdo_faults::REASONS,
    block_faults::BLOCK,
    pdo_faults::ALL,
    lss_faults::EVERY,
    lss_faults::COMPLETE,
    robustness_faults::ALL,
];

/// What can be built.
pub(crate) const KIND: DeviceKind = DeviceKind {
    name: "canopen-complete",
    title: "A CANopen slave that has everything",
    ports: &[PortKind {
        role: "can",
        medium: Medium::Can { bit_rate: BIT_RATE },
    }],
    faults: FAULTS,
    variants: &[
        canopen::variants::TPDO_WITH_FIRST_SYNC,
        canopen::variants::NO_TPDO_ON_START,
        canopen::variants::HEARTBEAT_AT_ONCE,
        canopen::variants::LONG_NMT_COMMANDS,
        canopen::variants::GUARDED_BESIDE_HEARTBEAT,
        canopen::variants::GUARDED_BY_ONE_BYTE,
        canopen::variants::SLOW,
        canopen::variants::GENERAL_ABORT_CODES,
        canopen::variants::CAREFUL_SDO,
        canopen::variants::TERSE_SDO,
        canopen::variants::SMALL_BLOCKS,
        canopen::variants::OTHER_PDO_ABORTS,
        canopen::variants::EMPTY_PLACES_READ_0,
        canopen::variants::FIRST_SYNC_AT_ONCE,
        canopen::variants::EMERGENCY_LATE,
        canopen::variants::PASSING_ERRORS_SHOWN,
        canopen::variants::LONG_PDO_UNREPORTED,
        canopen::variants::LSS_ADDRESS_COMPARED_AT_THE_END,
    ],
    build,
};

static DICTIONARY: LazyLock<Dictionary> = LazyLock::new(|| {
    eds::read(include_str!(
        "../../../../fixtures/devices/canopen-complete/canopen-complete.eds"
    ))
    .dictionary
});

fn documented() -> Behaviour {
    let mut behaviour = Behaviour::default();
    behaviour.canopen.block = BlockTransfer {
        offered: true,
        ..BlockTransfer::default()
    };
    behaviour.canopen.manners.empty_places_refused = true;
    behaviour
}

fn profile() -> Profile {
    Profile {
        dictionary: &DICTIONARY,
        boot_time: Duration::from_millis(5),
        produces_sync: true,
        guarding: true,
        consumes_heartbeats: true,
        transmit_event: TransmitEvent::Change,
        lowest_transmit_type: 0,
        lss: Some(LssAbilities {
            bit_rates: BIT_RATES,
        }),
        saved_on_write: &[],
        node_object: None,
        bit_rate_object: None,
        complete: true,
        clock_object: Some(Address::new(0x200C, 0)),
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
    let mut values = Values::default();
    let slave = Slave::new(profile(), behaviour.canopen, factory, &mut values);
    Ok(Box::new(Complete { slave, values }))
}

/// The slave on its bus.
#[derive(Debug)]
struct Complete {
    slave: Slave,
    values: Values,
}

impl Participant for Complete {
    fn line(&self, _: usize) -> Line {
        self.slave.line()
    }

    fn receive(&mut self, now: Instant, _: usize, reception: Reception, _: &mut Outbox) {
        if let Reception::Frame(frame) = reception {
            self.slave.receive(now, &frame, &mut self.values);
        }
    }

    fn wake_at(&self) -> Option<Instant> {
        self.slave.wake_at()
    }

    fn wake(&mut self, now: Instant, out: &mut Outbox) {
        self.slave.wake(now, PORT, &mut self.values, out);
    }

    fn stimulate(
        &mut self,
        now: Instant,
        stimulus: &Stimulus,
        _: &mut Outbox,
    ) -> Result<(), NotOffered> {
        match stimulus {
            Stimulus::Power { on } => self.slave.power(now, *on, &mut self.values),
            Stimulus::ProcessValue { name, value } => {
                self.slave.set_process_value(name, *value)?;
            }
            Stimulus::Condition { name, active } => {
                self.values
                    .conditions
                    .set(now, name, *active, &mut self.slave)?;
            }
            Stimulus::Setting { name, value } => match name.as_str() {
                "node" => self.slave.set_node(now, *value)?,
                "bit-rate" => self.slave.set_bit_rate(*value, BIT_RATES)?,
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
        let mut state = self.slave.state();
        state.extend(self.values.conditions.state());
        state
    }
}

#[cfg(test)]
mod communication_tests;
#[cfg(test)]
mod disturbed_tests;
#[cfg(test)]
mod error_control_tests;
#[cfg(test)]
mod lss_tests;
#[cfg(test)]
mod nmt_tests;
#[cfg(test)]
mod pdo_tests;
#[cfg(test)]
mod tests;
