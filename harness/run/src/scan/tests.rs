//! Scans of the reference devices on simulated buses.

use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_devices::{DeviceKind, Medium, Settings};
use fieldproof_link::sim::{Builder, SimLane};
use fieldproof_link::{
    Instant, Lane, Line, LinkError, Outbox, Participant, PortIndex, Reception, SerialSettings,
    Transmission,
};
use fieldproof_wire::canopen::NodeId;
use fieldproof_wire::canopen::lss::{FastScan, Request, Response};
use fieldproof_wire::modbus::ExceptionCode;

use super::*;

const SECOND: Duration = Duration::from_secs(1);

fn kind(name: &str) -> &'static DeviceKind {
    fieldproof_devices::kind(name).expect("a reference device")
}

fn device(name: &str, number: Option<u8>, fault: Option<&str>) -> Box<dyn Participant> {
    let settings = Settings {
        node: number,
        address: number,
        seed: 1,
        fault: fault.map(str::to_owned),
        variant: None,
        framing: None,
    };
    (kind(name).build)(&settings).expect("it has this fault")
}

fn canopen(lss: bool) -> CanopenScan {
    CanopenScan {
        listen: SECOND,
        timeout: SECOND / 2,
        lss,
    }
}

/// What is found on a bus with these on it, and how long that takes.
fn scan_bus(
    bit_rate: u32,
    lss: bool,
    participants: Vec<Box<dyn Participant>>,
) -> (CanopenFound, Duration) {
    let mut builder = Builder::new();
    let bus = builder.can_bus("can", bit_rate);
    for participant in participants {
        builder.participant(participant, &[bus]);
    }
    let mut lane = builder.build();
    let found = scan_canopen(&mut lane, bus, &canopen(lss)).expect("somebody acknowledges");
    (found, lane.now().since(Instant::START))
}

fn numbers(found: &CanopenFound) -> Vec<u8> {
    found.nodes.iter().map(|it| it.node.raw()).collect()
}

fn answers(found: &CanopenFound, place: usize) -> &Answers {
    let node = &found.nodes[place];
    node.answers.as_ref().expect("its SDO server answers")
}

#[test]
fn every_device_on_a_network_is_found_in_less_than_two_seconds() {
    let devices = [
        ("kinco-servo", 1),
        ("teco-jn5-cm-can", 64),
        ("canopen-complete", 127),
    ];
    let devices = devices.map(|(name, node)| device(name, Some(node), None));
    let (found, took) = scan_bus(500_000, false, devices.into());
    assert_eq!(numbers(&found), [1, 64, 127]);
    assert!(took < 2 * SECOND, "{took:?}");
    let teco = answers(&found, 1);
    let identity = [Some(0x373), Some(0x100), Some(0x10000)];
    assert_eq!(teco.identity[..3], identity);
    assert_eq!(teco.name.as_deref(), Some("JN5-CM-CAN"));
    let complete = answers(&found, 2);
    assert_eq!(complete.name.as_deref(), Some("canopen-complete"));
    assert_eq!(complete.identity[3], Some(1));
    assert!(found.nodes.iter().all(|it| it.heard.boot_up));
    assert!(!found.unconfigured);
    assert_eq!(found.lss, None);
}

#[test]
fn devices_are_found_at_their_own_bit_rate_only() {
    let huacheng = |bit_rate| {
        let devices = ["huacheng-ssts1", "huacheng-ssts1"];
        let numbers = [Some(2), Some(3)].into_iter();
        let devices = devices.into_iter().zip(numbers);
        let devices = devices.map(|(name, node)| device(name, node, None));
        let mut builder = Builder::new();
        let bus = builder.can_bus("can", bit_rate);
        for device in devices {
            builder.participant(device, &[bus]);
        }
        let mut lane = builder.build();
        scan_canopen(&mut lane, bus, &canopen(false))
    };
    let found = huacheng(1_000_000).expect("they acknowledge");
    assert_eq!(numbers(&found), [2, 3]);
    assert_eq!(answers(&found, 0).identity[1], Some(1));
    let nobody = huacheng(125_000);
    assert!(matches!(nobody, Err(LinkError::NotAcknowledged { .. })));
}

#[test]
fn node_that_is_heard_and_does_not_answer_is_found() {
    let heartbeat = Talker("705#04".parse().expect("a frame"), Instant::START);
    let talkers: Vec<Box<dyn Participant>> = vec![Box::new(heartbeat)];
    let (found, _) = scan_bus(125_000, false, talkers);
    assert_eq!(numbers(&found), [5]);
    assert_eq!(found.nodes[0].answers, None);
    let heard = &found.nodes[0].heard;
    let state = fieldproof_wire::canopen::nmt::State::Stopped;
    assert_eq!(heard.state, Some(state));
    assert_eq!(heard.period, Some(SECOND / 4));
}

#[test]
fn identity_is_inquired_over_lss_of_a_slave_that_is_alone() {
    let (found, _) = scan_bus(250_000, true, vec![device("liaomiao-encoder", None, None)]);
    assert_eq!(numbers(&found), [32]);
    let slave = LssSlave {
        identity: [Some(0x63C), Some(1), Some(1), Some(241_000_888)],
        node: NodeId::new(32),
    };
    assert_eq!(found.lss, Some(LssFound::Slaves(vec![slave])));
}

#[test]
fn slaves_wait_again_after_lss() {
    let mut builder = Builder::new();
    let bus = builder.can_bus("can", 250_000);
    builder.device(device("liaomiao-encoder", None, None), &[bus]);
    let mut lane = builder.build();
    lane.receive(lane.now() + SECOND).expect("a simulated bus");
    let before = lane.device_state();
    scan_canopen(&mut lane, bus, &canopen(true)).expect("it acknowledges");
    assert_eq!(lane.device_state(), before);
}

#[test]
fn nobody_is_inquired_over_lss_where_two_would_answer() {
    let devices = [1, 2].map(|node| device("canopen-complete", Some(node), None));
    let (found, _) = scan_bus(500_000, true, devices.into());
    assert_eq!(found.lss, Some(LssFound::TooMany(2)));
}

#[test]
fn slaves_without_a_node_id_are_told_apart_by_fast_scan() {
    let identities = [[0x63C, 1, 1, 241_000_888], [0x63C, 1, 1, 0x8000_0001]];
    let slaves = identities.map(|identity| Box::new(Unconfigured::new(identity)) as _);
    let (found, _) = scan_bus(125_000, true, slaves.into());
    assert!(found.unconfigured);
    assert!(found.nodes.is_empty());
    let slaves = identities.map(|identity| LssSlave {
        identity: identity.map(Some),
        node: None,
    });
    assert_eq!(found.lss, Some(LssFound::Slaves(slaves.into())));
}

/// Sends its frame four times a second.
struct Talker(Frame, Instant);

impl Participant for Talker {
    fn line(&self, _: usize) -> Line {
        Line::Can { bit_rate: 125_000 }
    }

    fn receive(&mut self, _: Instant, _: usize, _: Reception, _: &mut Outbox) {}

    fn wake_at(&self) -> Option<Instant> {
        Some(self.1)
    }

    fn wake(&mut self, _: Instant, out: &mut Outbox) {
        self.1 = self.1 + SECOND / 4;
        out.send(0, Transmission::Frame(self.0));
    }
}

/// A slave without a node-ID that knows fastscan and nothing else.
struct Unconfigured {
    identity: [u32; 4],
    part: u8,
    is_found: bool,
}

impl Unconfigured {
    fn new(identity: [u32; 4]) -> Unconfigured {
        Unconfigured {
            identity,
            part: 0,
            is_found: false,
        }
    }

    fn takes_part(&mut self, step: FastScan) -> bool {
        if self.is_found {
            return false;
        }
        let Some(bit) = step.bit_check else {
            self.part = 0;
            return true;
        };
        let own = self.identity[usize::from(step.part.number())];
        let matches = (own ^ step.number) >> bit.raw() == 0;
        if step.part.number() != self.part || !matches {
            return false;
        }
        if bit.raw() == 0 && step.next != step.part {
            self.part = step.next.number();
            self.is_found = step.next < step.part;
        }
        true
    }
}

impl Participant for Unconfigured {
    fn line(&self, _: usize) -> Line {
        Line::Can { bit_rate: 125_000 }
    }

    fn receive(&mut self, _: Instant, _: usize, what: Reception, out: &mut Outbox) {
        let Reception::Frame(frame) = what else {
            return;
        };
        let response = match Request::parse(&frame) {
            Ok(Request::IdentifyNonConfigured) => Response::IdentifyNonConfigured,
            Ok(Request::FastScan(step)) if self.takes_part(step) => Response::IdentifySlave,
            _ => return,
        };
        out.send(0, Transmission::Frame(response.encode()));
    }

    fn wake_at(&self) -> Option<Instant> {
        None
    }

    fn wake(&mut self, _: Instant, _: &mut Outbox) {}
}

/// A serial line set as the device is, with the device at `address` on it.
fn line(name: &str, address: Option<u8>) -> (SimLane, PortIndex) {
    let mut builder = Builder::new();
    let (number, settings) = serial_port(kind(name));
    let port = builder.serial_line("serial", settings);
    // Its other ports are connected to nothing.
    let mut ports = vec![PortIndex(usize::MAX); number];
    ports.push(port);
    builder.participant(device(name, address, None), &ports);
    (builder.build(), port)
}

fn serial_port(kind: &DeviceKind) -> (usize, SerialSettings) {
    let mut ports = kind.ports.iter().enumerate();
    let serial = ports.find_map(|(number, port)| match port.medium {
        Medium::Serial(settings) => Some((number, settings)),
        Medium::Can { .. } | Medium::Tcp => None,
    });
    serial.expect("it has a serial port")
}

fn scan_line(name: &str, address: Option<u8>, addresses: &[u8]) -> ModbusFound {
    let (mut lane, port) = line(name, address);
    let how = ModbusScan {
        addresses: addresses.to_vec(),
        timeout: Duration::from_millis(200),
    };
    scan_modbus(&mut lane, port, &how, || {}).expect("a simulated line")
}

#[test]
fn server_is_found_among_all_addresses() {
    for (name, address) in [("liaomiao-encoder", 32), ("huacheng-ssts1", 247)] {
        let found = scan_line(name, Some(address), &[]);
        let addresses: Vec<u8> = found.servers.iter().map(|it| it.address).collect();
        assert_eq!(addresses, [address], "{name}");
        assert!(found.noise.is_empty(), "{name}");
        assert_eq!(found.servers[0].identification, []);
    }
}

#[test]
fn exception_is_an_answer_too() {
    let refuses = scan_line("huacheng-ssts1", None, &[1]);
    let code = ExceptionCode::IllegalDataValue;
    assert_eq!(refuses.servers[0].register_0, Err(code));
    let answers = scan_line("liaomiao-encoder", None, &[31, 32, 33]);
    assert!(answers.servers[0].register_0.is_ok());
}

#[test]
fn only_the_addresses_that_are_given_are_asked() {
    assert_eq!(
        scan_line("liaomiao-encoder", None, &[1, 2]),
        ModbusFound::default()
    );
}
