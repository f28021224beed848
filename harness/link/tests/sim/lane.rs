//! What the lane promises whatever the medium.

use std::time::Duration;

use fieldproof_link::sim::Builder;
use fieldproof_link::{
    Instant, Lane, Line, LinkError, Outbox, Participant, PortIndex, Reception, State, Stimulus,
    StimulusError, StimulusKind, Transmission,
};

use crate::actor::{Actor, CAN_500K, MODBUS_9600, ms, received, seen, transmission, us};

#[test]
fn ports_say_what_they_are() {
    let mut builder = Builder::new();
    builder.can_bus("can", 500_000);
    builder.serial_line("serial", MODBUS_9600);
    let lane = builder.build();
    let names: Vec<_> = lane.ports().iter().map(|port| &*port.name).collect();
    assert_eq!(names, ["can", "serial"]);
    for port in lane.ports() {
        assert_eq!((&*port.link, port.timestamps), ("sim:", "simulated"));
        assert_eq!(port.uncertainty, Duration::ZERO);
    }
    assert_eq!(lane.ports()[1].line, Line::Serial(MODBUS_9600));
}

#[test]
fn wrong_use_is_an_error() {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    let serial = builder.serial_line("serial", MODBUS_9600);
    let mut lane = builder.build();
    let wrong = |port: &str| LinkError::WrongKind { port: port.into() };
    let bytes = || Transmission::bytes(&[1]);
    let frame = || transmission("000#");
    assert_eq!(lane.send(can, ms(1), bytes()), Err(wrong("can")));
    assert_eq!(lane.send(serial, ms(1), frame()), Err(wrong("serial")));
    assert_eq!(lane.set_line(serial, CAN_500K), Err(wrong("serial")));
    assert_eq!(lane.now(), Instant::START);

    let nowhere = PortIndex(2);
    let missing = lane.send(nowhere, ms(1), frame()).unwrap_err();
    let text = "port number 2 is down: the lane has no such port";
    assert_eq!(missing.to_string(), text);
    assert_eq!(lane.set_line(nowhere, Line::Off), Err(missing));

    lane.set_line(can, Line::Off).unwrap();
    let off = lane.send(can, ms(1), frame()).unwrap_err();
    assert!(off.to_string().contains("switched off"), "{off}");
}

#[test]
fn a_participant_on_a_port_that_is_not_there_is_heard_by_nobody() {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    let lost = Actor::new(CAN_500K).send(ms(1), "000#");
    builder.device(lost.boxed(), &[PortIndex(7), can]);
    let mut lane = builder.build();
    lane.attach(
        PortIndex(7),
        Actor::new(CAN_500K).send(ms(1), "000#").boxed(),
    );
    assert_eq!(lane.receive(ms(10)), Ok(None));
}

#[test]
fn stimuli_are_for_the_device_alone() {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    builder.participant(Actor::new(CAN_500K).boxed(), &[can]);
    let mut lane = builder.build();
    let power = Stimulus::Power { on: true };
    assert_eq!(lane.offers(), []);
    assert_eq!(lane.stimulate(&power), Err(StimulusError::NotOffered));
    assert_eq!(lane.device_state(), State::default());

    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    builder.device(Actor::new(CAN_500K).boxed(), &[can]);
    let mut lane = builder.build();
    assert_eq!(lane.offers(), [StimulusKind::Power]);
    assert_eq!(lane.stimulate(&power), Ok(()));
    let other = Stimulus::Setting {
        name: "node".into(),
        value: 1,
    };
    assert_eq!(lane.stimulate(&other), Err(StimulusError::NotOffered));
}

#[test]
fn what_arrives_while_sending_is_kept_with_its_instant() {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    let device = Actor::new(CAN_500K)
        .send(us(500), "000#")
        .send(us(900), "123#");
    builder.device(device.boxed(), &[can]);
    let mut lane = builder.build();
    lane.send(can, ms(2), transmission("000#")).unwrap();
    let first = seen(lane.receive(us(650)).unwrap());
    assert_eq!(first, Some((us(600), received("000#"))));
    // 900 + 90 us is after 650 us: not yet, though it is there.
    assert_eq!(lane.receive(us(650)), Ok(None));
    assert_eq!(lane.now(), us(2_100));
    let second = seen(lane.receive(us(990)).unwrap());
    assert_eq!(second, Some((us(990), received("123#"))));
}

#[test]
fn an_hour_of_heartbeats_takes_no_time_to_speak_of() {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    let heartbeat = transmission("701#05");
    let device = Actor::new(CAN_500K).every(ms(1_000), Duration::from_secs(1), heartbeat);
    builder.device(device.boxed(), &[can]);
    let mut lane = builder.build();
    let end = ms(3_600_500);
    let beats = std::iter::from_fn(|| lane.receive(end).unwrap()).count();
    assert_eq!(beats, 3_600);
}

/// Never goes back to sleep.
struct Restless {
    at: Option<Instant>,
}

impl Participant for Restless {
    fn line(&self, _port: usize) -> Line {
        CAN_500K
    }

    fn receive(&mut self, _now: Instant, _port: usize, _what: Reception, _out: &mut Outbox) {}

    fn wake_at(&self) -> Option<Instant> {
        self.at
    }

    fn wake(&mut self, _now: Instant, _out: &mut Outbox) {}
}

#[test]
fn a_participant_that_never_sleeps_does_not_hang_the_lane() {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    builder.device(Box::new(Restless { at: Some(ms(1)) }), &[can]);
    let mut lane = builder.build();
    let error = lane.receive(ms(10)).unwrap_err();
    let text = "port can is down: a participant asks to be woken again and again at one instant";
    assert_eq!(error.to_string(), text);
    assert_eq!(lane.now(), ms(1));
    assert_eq!(lane.send(can, ms(2), transmission("000#")), Err(error));
}

#[test]
fn waiting_for_ever_where_nothing_happens_ends_at_once() {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    builder.device(Actor::new(CAN_500K).send(ms(1), "000#").boxed(), &[can]);
    let mut lane = builder.build();
    assert!(lane.receive(Instant::NEVER).unwrap().is_some());
    assert_eq!(lane.receive(Instant::NEVER), Ok(None));
    assert_eq!(lane.now(), us(1_100));
}
