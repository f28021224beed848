//! Whether a case can be played here at all, and why not.

mod line;

use std::collections::BTreeSet;

use fieldproof_dictionary::Dictionary;
use fieldproof_link::StimulusKind;
use fieldproof_suite::device::{DeviceDescription, Feature, FunctionCode, PortDescription};
use fieldproof_suite::identity::Claim;
use fieldproof_suite::model::{
    Case, Depth, Effect, Located, Need, Protocol, ReadExpectation, SdoRead, Step, Stimulate,
    StimulusName,
};
use fieldproof_suite::scalar::ObjectAddress;

use crate::selected::missing_object;
use crate::tester::{TCP, multiplexer};

/// What the bench has and permits.
#[derive(Debug, Clone)]
pub struct Bench {
    /// The roles of the ports it has connected.
    pub ports: BTreeSet<String>,
    /// The roles of those whose bit rate cannot be changed from here.
    pub fixed_rates: BTreeSet<String>,
    /// Those of them whose link is Modbus TCP, where a header stands around a PDU instead of address and CRC.
    pub modbus_tcp: BTreeSet<String>,
    /// Those of them on which a frame ends by its length, not by silence.
    pub streams: BTreeSet<String>,
    /// The stimuli it offers.
    pub stimuli: BTreeSet<StimulusKind>,
    /// The effects it permits.
    pub permits: BTreeSet<Effect>,
    /// How thorough the run is.
    pub depth: Depth,
    /// The device's node-ID on this bench.
    pub node: Option<u8>,
    /// The device's Modbus address on this bench.
    pub address: Option<u8>,
}

/// Why `case` of a suite in `protocol` is skipped here; `None` if it is played.
pub fn skip_reason(
    case: &Case,
    protocol: Protocol,
    device: &DeviceDescription,
    dictionary: Option<&Dictionary>,
    bench: &Bench,
) -> Option<String> {
    missing_port(protocol, bench)
        .or_else(|| too_deep(case, bench))
        .or_else(|| missing_need(case, device, dictionary, bench))
        .or_else(|| line::cannot_carry(case, device, bench))
        .or_else(|| missing_claim(case, device))
        .or_else(|| missing_objects(case, dictionary))
        .or_else(|| missing_permission(case, device, bench))
        .or_else(|| wrong_address(case, bench))
        .or_else(|| fixed_rate(case, bench))
        .or_else(|| missing_companion(case, device))
}

fn missing_port(protocol: Protocol, bench: &Bench) -> Option<String> {
    let roles: &[&str] = match protocol {
        Protocol::Canopen => &["can"],
        Protocol::Modbus if bench.ports.contains(TCP) => &[],
        Protocol::Modbus => &["serial"],
        Protocol::Gateway => &["can", "inverter"],
    };
    roles
        .iter()
        .find(|role| !bench.ports.contains(**role))
        .map(|role| format!("no port {role:?}"))
}

fn too_deep(case: &Case, bench: &Bench) -> Option<String> {
    (case.depth > bench.depth).then(|| "takes long: played with --depth full".to_owned())
}

fn missing_need(
    case: &Case,
    device: &DeviceDescription,
    dictionary: Option<&Dictionary>,
    bench: &Bench,
) -> Option<String> {
    let is_there = |object: &ObjectAddress| {
        dictionary.is_some_and(|it| it.entry(object.index, object.sub).is_some())
    };
    case.needs.iter().find_map(|need| match need {
        Need::Objects(objects) => {
            let missing = objects.iter().find(|object| !is_there(object))?;
            Some(format!(
                "the device has no object {}",
                multiplexer(*missing)
            ))
        }
        Need::Functions(functions) => {
            missing_function(functions, device).or_else(|| line::serial_line_only(functions, bench))
        }
        Need::Feature(feature) if !is_claimed(*feature, device, bench) => Some(format!(
            "the device does not claim {}",
            feature_name(*feature)
        )),
        Need::Stimulus(name) if !bench.stimuli.contains(&kind(*name)) => Some(format!(
            "the bench does not offer the stimulus {}",
            stimulus_name(*name)
        )),
        Need::AnotherNode(node) if bench.node == Some(*node) => Some(format!(
            "node-ID {node}, which another node is to have, is that of the device"
        )),
        Need::AnotherAddress(address) if bench.address == Some(*address) => Some(format!(
            "address {address}, which another slave is to have, is that of the device"
        )),
        _ => None,
    })
}

fn missing_function(functions: &[FunctionCode], device: &DeviceDescription) -> Option<String> {
    let modbus = device.modbus.as_ref();
    match modbus.filter(|modbus| !modbus.functions.is_empty()) {
        None => Some("the description does not say which functions the device has".to_owned()),
        Some(modbus) => {
            let missing = functions
                .iter()
                .find(|function| !modbus.claims(**function))?;
            Some(format!("the device does not claim function {missing}"))
        }
    }
}

fn missing_objects(case: &Case, dictionary: Option<&Dictionary>) -> Option<String> {
    let steps = case.control.iter().chain(&case.steps);
    lacks_object(steps, dictionary).map(str::to_owned)
}

fn lacks_object<'s>(
    steps: impl IntoIterator<Item = &'s Located<Step>>,
    dictionary: Option<&Dictionary>,
) -> Option<&'static str> {
    steps.into_iter().find_map(|step| match &step.value {
        Step::Repeat(repeat) => lacks_object(&repeat.steps, dictionary),
        step => missing_object(step, dictionary),
    })
}

/// Something is done to what the tester plays on a port, and there it plays nothing.
fn missing_companion(case: &Case, device: &DeviceDescription) -> Option<String> {
    let plays = |role: &str| {
        matches!(
            device.ports.get(role),
            Some(PortDescription::Serial {
                companion: Some(_),
                ..
            })
        )
    };
    let mut steps = case.control.iter().chain(&case.steps);
    steps.find_map(|step| match &step.value {
        Step::Stimulate(Stimulate::Companion { port, .. }) if !plays(port) => {
            Some(format!("the tester plays nothing on port {port:?}"))
        }
        _ => None,
    })
}

/// A device that has Modbus TCP and no serial line answers there what it would answer on one.
fn is_claimed(feature: Feature, device: &DeviceDescription, bench: &Bench) -> bool {
    let over_tcp = feature == Feature::ModbusRtu && line::is_over_tcp(bench);
    device.features.contains(&feature)
        || (over_tcp && device.features.contains(&Feature::ModbusTcp))
}

fn missing_claim(case: &Case, device: &DeviceDescription) -> Option<String> {
    let steps = case.control.iter().chain(&case.steps);
    let unclaimed = |claim: &&Claim| device.identity.claimed(**claim).is_none();
    if let Some(claim) = case.claims.iter().find(unclaimed) {
        return Some(format!("the device does not claim its {}", claim.name()));
    }
    expects_unclaimed(steps, device)
        .then(|| "the device does not claim this part of its identity".to_owned())
}

fn expects_unclaimed<'s>(
    steps: impl IntoIterator<Item = &'s Located<Step>>,
    device: &DeviceDescription,
) -> bool {
    steps.into_iter().any(|step| match &step.value {
        Step::SdoRead(SdoRead {
            expect: ReadExpectation::Claimed(claim),
            ..
        }) => device.identity.claimed(*claim).is_none(),
        Step::Repeat(repeat) => expects_unclaimed(&repeat.steps, device),
        _ => false,
    })
}

fn missing_permission(case: &Case, device: &DeviceDescription, bench: &Bench) -> Option<String> {
    case.effects
        .iter()
        .find(|effect| !bench.permits.contains(effect))
        .map(|effect| {
            let danger = device
                .dangers
                .get(effect)
                .map(|words| format!(" ({words})"))
                .unwrap_or_default();
            format!("the bench does not permit {}{danger}", effect_name(*effect))
        })
}

fn wrong_address(case: &Case, bench: &Bench) -> Option<String> {
    if bench.stimuli.contains(&StimulusKind::Setting) {
        return None;
    }
    let written_for = case.written_for;
    if let Some(address) = written_for.address
        && bench.address != Some(address)
    {
        return Some(format!(
            "written for address {address}, which the device does not have here"
        ));
    }
    match written_for.node {
        Some(node) if written_for.fixed && bench.node != Some(node) => Some(format!(
            "written for node {node}, which the device does not have here"
        )),
        _ => None,
    }
}

/// A bus without bits has no bit rate to change, and some interfaces may not be set.
fn fixed_rate(case: &Case, bench: &Bench) -> Option<String> {
    let sets = |steps: &[Located<Step>]| steps.iter().any(|step| sets_bit_rate(&step.value));
    (bench.fixed_rates.contains(crate::tester::CAN) && (sets(&case.control) || sets(&case.steps)))
        .then(|| "the bit rate of this link cannot be changed".to_owned())
}

fn sets_bit_rate(step: &Step) -> bool {
    match step {
        Step::SetBitRate(_) => true,
        Step::Repeat(repeat) => repeat.steps.iter().any(|step| sets_bit_rate(&step.value)),
        _ => false,
    }
}

const fn kind(name: StimulusName) -> StimulusKind {
    match name {
        StimulusName::Power => StimulusKind::Power,
        StimulusName::ProcessValue => StimulusKind::ProcessValue,
        StimulusName::Condition => StimulusKind::Condition,
        StimulusName::Setting => StimulusKind::Setting,
    }
}

const fn stimulus_name(name: StimulusName) -> &'static str {
    match name {
        StimulusName::Power => "power",
        StimulusName::ProcessValue => "process-value",
        StimulusName::Condition => "condition",
        StimulusName::Setting => "setting",
    }
}

/// The word of the suite language for an effect.
pub const fn effect_name(effect: Effect) -> &'static str {
    match effect {
        Effect::Writes => "writes",
        Effect::Persists => "persists",
        Effect::Readdresses => "readdresses",
        Effect::Moves => "moves",
        Effect::Resets => "resets",
        Effect::DisturbsBus => "disturbs-bus",
    }
}

/// The word of the suite language for a feature.
pub const fn feature_name(feature: Feature) -> &'static str {
    match feature {
        Feature::NmtSlave => "nmt-slave",
        Feature::HeartbeatProducer => "heartbeat-producer",
        Feature::NodeGuarding => "node-guarding",
        Feature::SdoServer => "sdo-server",
        Feature::SdoSegmented => "sdo-segmented",
        Feature::SdoBlock => "sdo-block",
        Feature::Tpdo => "tpdo",
        Feature::AcyclicPdo => "acyclic-pdo",
        Feature::EventTpdo => "event-tpdo",
        Feature::Rpdo => "rpdo",
        Feature::DynamicMapping => "dynamic-mapping",
        Feature::DummyMapping => "dummy-mapping",
        Feature::SyncConsumer => "sync-consumer",
        Feature::SyncCounter => "sync-counter",
        Feature::SyncProducer => "sync-producer",
        Feature::Emergency => "emergency",
        Feature::TimeConsumer => "time-consumer",
        Feature::TimeProducer => "time-producer",
        Feature::Lss => "lss",
        Feature::LssIdentify => "lss-identify",
        Feature::LssActivateBitTiming => "lss-activate-bit-timing",
        Feature::LssFastscan => "lss-fastscan",
        Feature::RemoteFrames => "remote-frames",
        Feature::Cia402 => "cia402",
        Feature::ProfilePosition => "profile-position",
        Feature::Velocity => "velocity",
        Feature::ProfileVelocity => "profile-velocity",
        Feature::TorqueProfile => "torque-profile",
        Feature::Homing => "homing",
        Feature::InterpolatedPosition => "interpolated-position",
        Feature::CyclicSynchronousPosition => "cyclic-synchronous-position",
        Feature::CyclicSynchronousVelocity => "cyclic-synchronous-velocity",
        Feature::CyclicSynchronousTorque => "cyclic-synchronous-torque",
        Feature::Cia406 => "cia406",
        Feature::ModbusRtu => "modbus-rtu",
        Feature::ModbusTcp => "modbus-tcp",
        Feature::FactorySettings => "factory-settings",
        Feature::Ssi => "ssi",
        Feature::Gateway => "gateway",
    }
}
