//! Whether a case can be played here at all, and why not.

use std::collections::BTreeSet;

use fieldproof_dictionary::Dictionary;
use fieldproof_link::StimulusKind;
use fieldproof_suite::device::{DeviceDescription, Feature, FunctionCode, Parity, PortDescription};
use fieldproof_suite::identity::Claim;
use fieldproof_suite::model::{
    Case, Depth, Effect, ExpectBytes, Located, Modbus, Need, PauseLength, Protocol,
    ReadExpectation, SdoRead, SendBytes, Step, Stimulate, StimulusName,
};
use fieldproof_suite::scalar::ObjectAddress;

use crate::selected::missing_object;
use crate::tester::{SERIAL, TCP, multiplexer};

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
        .or_else(|| rtu_alone(case, bench))
        .or_else(|| missing_connections(case, device))
        .or_else(|| no_parity(case, device, bench))
        .or_else(|| no_characters(case, bench))
        .or_else(|| no_silences(case, bench))
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
            missing_function(functions, device).or_else(|| serial_line_only(functions, bench))
        }
        Need::Feature(feature) if !is_claimed(*feature, device, bench) => Some(format!(
            "the device does not claim {}",
            feature_name(*feature)
        )),
        Need::Stimulus(name) if !bench.stimuli.contains(&kind(*name)) => Some(format!(
            "the bench does not offer the stimulus {}",
            stimulus_name(*name)
        )),
        _ => None,
    })
}

/// Functions that the specification has for serial lines only.
const SERIAL_LINE_ONLY: [u8; 5] = [0x07, 0x08, 0x0B, 0x0C, 0x11];

fn serial_line_only(functions: &[FunctionCode], bench: &Bench) -> Option<String> {
    let mut of_lines = functions
        .iter()
        .filter(|it| SERIAL_LINE_ONLY.contains(&it.function));
    let function = of_lines.next().filter(|_| is_over_tcp(bench))?;
    Some(format!("function {function} is for serial lines"))
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

/// Whether Modbus is spoken over TCP where a step names no port.
fn is_over_tcp(bench: &Bench) -> bool {
    match bench.ports.contains(SERIAL) {
        true => bench.modbus_tcp.contains(SERIAL),
        false => bench.modbus_tcp.contains(TCP),
    }
}

/// A device that has Modbus TCP and no serial line answers there what it would answer on one.
fn is_claimed(feature: Feature, device: &DeviceDescription, bench: &Bench) -> bool {
    let over_tcp = feature == Feature::ModbusRtu && is_over_tcp(bench);
    device.features.contains(&feature)
        || (over_tcp && device.features.contains(&Feature::ModbusTcp))
}

/// What makes sense on a serial line alone is not played on Modbus TCP.
fn rtu_alone(case: &Case, bench: &Bench) -> Option<String> {
    let steps = case.control.iter().chain(&case.steps);
    steps
        .chain(&case.restore.steps)
        .find_map(|step| rtu_step(&step.value, bench))
}

/// More connections are open at once, with that of the bench, than the device serves.
fn missing_connections(case: &Case, device: &DeviceDescription) -> Option<String> {
    let (mut open, mut most) = (0, 0);
    let steps: Vec<&Located<Step>> = case.control.iter().chain(&case.steps).collect();
    count_connections(&steps, &mut open, &mut most);
    let needed = most + 1;
    let served = device.modbus.as_ref().and_then(|it| it.connections);
    match served {
        _ if most == 0 => None,
        None => {
            Some("the description does not say how many connections the device serves".to_owned())
        }
        Some(served) if served < needed => Some(format!(
            "the device serves {served} connections, and {needed} are needed"
        )),
        Some(_) => None,
    }
}

fn count_connections(steps: &[&Located<Step>], open: &mut u16, most: &mut u16) {
    for step in steps {
        match &step.value {
            Step::Connect(_) => *open += 1,
            Step::Disconnect(_) => *open = open.saturating_sub(1),
            Step::Repeat(repeat) => {
                let inside: Vec<&Located<Step>> = repeat.steps.iter().collect();
                count_connections(&inside, open, most);
            }
            _ => {}
        }
        *most = (*most).max(*open);
    }
}

/// A parity bit is sent wrong where there is none.
fn no_parity(case: &Case, device: &DeviceDescription, bench: &Bench) -> Option<String> {
    let spoils = |step: &Located<Step>| {
        matches!(
            &step.value,
            Step::SendBytes(SendBytes { spoil: Some(_), .. })
        )
    };
    let has_parity = matches!(
        device.ports.get(SERIAL),
        Some(PortDescription::Serial { parity, .. }) if *parity != Parity::None
    );
    let carries = has_parity && !bench.fixed_rates.contains(SERIAL);
    let mut steps = case.control.iter().chain(&case.steps);
    (steps.any(spoils) && !carries).then(|| "the line has no parity bit".to_owned())
}

/// What follows a frame without a silence belongs to it only where silence ends a frame.
fn no_silences(case: &Case, bench: &Bench) -> Option<String> {
    let follows = |step: &Located<Step>| matches!(&step.value, Step::SendBytes(SendBytes { then, port: None, .. }) if !then.is_empty());
    let mut steps = case.control.iter().chain(&case.steps);
    (steps.any(follows) && bench.streams.contains(SERIAL))
        .then(|| "no silence ends a frame on this link".to_owned())
}

/// A silence is counted in characters where characters take no time.
fn no_characters(case: &Case, bench: &Bench) -> Option<String> {
    let counts = |step: &Located<Step>| match &step.value {
        Step::SendBytes(SendBytes {
            pause: Some(pause), ..
        }) => matches!(pause.lasting, PauseLength::Characters(_)),
        _ => false,
    };
    let mut steps = case.control.iter().chain(&case.steps);
    (steps.any(counts) && bench.fixed_rates.contains(SERIAL))
        .then(|| "characters take no time on this link".to_owned())
}

fn rtu_step(step: &Step, bench: &Bench) -> Option<String> {
    // A port that the bench does not have is a connection that the case has opened.
    let is_tcp = |port: &Option<String>| match port.as_deref() {
        Some(port) => bench.modbus_tcp.contains(port),
        None => is_over_tcp(bench),
    };
    match step {
        Step::Connect(_) if bench.modbus_tcp.is_empty() => Some("no port of Modbus TCP".to_owned()),
        Step::SendBytes(SendBytes { port, .. }) | Step::ExpectBytes(ExpectBytes { port, .. })
            if is_tcp(port) =>
        {
            Some("written as an RTU frame; this link is Modbus TCP".to_owned())
        }
        Step::Modbus(Modbus {
            to: Some(to), port, ..
        }) if port.is_none() && is_over_tcp(bench) && bench.address != Some(*to) => Some(format!(
            "sent to address {to}; this link is Modbus TCP, with one device at its end"
        )),
        Step::Repeat(repeat) => {
            let mut steps = repeat.steps.iter();
            steps.find_map(|step| rtu_step(&step.value, bench))
        }
        _ => None,
    }
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
