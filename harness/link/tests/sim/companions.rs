//! The tester's own participants.

use std::time::Duration;

use fieldproof_link::sim::Builder;
use fieldproof_link::{
    Arrival, Character, CompanionIndex, Instant, Lane, Line, NotOffered, Origin, PortIndex,
    Reception, Stimulus, Transmission,
};

use crate::actor::{Actor, CAN_500K, Do, MODBUS_9600, ms, received, transmission, us};

const PERIOD: Duration = Duration::from_millis(10);

fn arrival(at: Instant, origin: Origin, what: &str) -> Arrival {
    Arrival {
        port: PortIndex(0),
        at,
        origin,
        what: received(what),
    }
}

/// A SYNC every 10 ms from 10 ms on.
fn sync_producer() -> Actor {
    Actor::new(CAN_500K).every(ms(10), PERIOD, transmission("080#"))
}

#[test]
fn a_sync_producer_sends_through_the_tester_and_is_seen_to() {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    let device = Actor::new(CAN_500K).answer("080#", "181#0102");
    let heard = device.heard();
    builder.device(device.boxed(), &[can]);
    let mut lane = builder.build();
    let sync = sync_producer();
    let companion_heard = sync.heard();
    let index = lane.attach(can, sync.boxed());
    let companion = Origin::Companion(index);
    // SYNC 44 + 4 bits, 96 us; intermission 6 us; TPDO 60 + 4 bits, 128 us.
    let expected = [
        arrival(us(10_096), companion, "080#"),
        arrival(us(10_230), Origin::Bus, "181#0102"),
        arrival(us(20_096), companion, "080#"),
        arrival(us(20_230), Origin::Bus, "181#0102"),
    ];
    for expected in expected {
        assert_eq!(lane.receive(ms(25)), Ok(Some(expected)));
    }
    assert_eq!(lane.receive(ms(25)), Ok(None));
    lane.send(can, ms(25), transmission("000#")).unwrap();

    lane.detach(index);
    assert_eq!(lane.receive(ms(100)), Ok(None));
    assert_eq!(heard.lock().unwrap().len(), 3);
    // Neither its own nor the tester's.
    let tpdos = [
        (us(10_230), 0, received("181#0102")),
        (us(20_230), 0, received("181#0102")),
    ];
    assert_eq!(*companion_heard.lock().unwrap(), tpdos);
}

#[test]
fn indices_are_not_used_again_and_detaching_takes_back_what_waits() {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    builder.device(Actor::new(CAN_500K).off().boxed(), &[can]);
    let mut lane = builder.build();
    let first = lane.attach(can, sync_producer().boxed());
    assert_eq!(first, CompanionIndex(0));
    // Nobody is there to acknowledge the SYNC.
    assert_eq!(lane.receive(ms(15)), Ok(None));
    lane.detach(first);
    lane.detach(first);
    let power = fieldproof_link::Stimulus::Power { on: true };
    lane.stimulate(&power).unwrap();
    let boot_up = arrival(us(15_112), Origin::Bus, "701#00");
    assert_eq!(lane.receive(ms(20)), Ok(Some(boot_up)));
    assert_eq!(lane.receive(ms(20)), Ok(None));
    assert_eq!(lane.attach(can, sync_producer().boxed()), CompanionIndex(1));
}

#[test]
fn detaching_leaves_the_frame_on_the_bus_and_those_behind_it() {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    builder.device(Actor::new(CAN_500K).boxed(), &[can]);
    let mut lane = builder.build();
    let script = Actor::new(CAN_500K).send(ms(1), "000#").send(ms(1), "100#");
    let first = lane.attach(can, script.boxed());
    let second = lane.attach(can, Actor::new(CAN_500K).send(ms(1), "200#").boxed());
    assert_eq!(lane.receive(us(1_050)), Ok(None));
    lane.detach(first);
    // 000# to its end; not 100#; 200# 96 us from 1106 us on.
    let on_the_bus = arrival(us(1_100), Origin::Companion(first), "000#");
    let behind = arrival(us(1_202), Origin::Companion(second), "200#");
    assert_eq!(lane.receive(ms(10)), Ok(Some(on_the_bus)));
    assert_eq!(lane.receive(ms(10)), Ok(Some(behind)));
    assert_eq!(lane.receive(ms(10)), Ok(None));
}

#[test]
fn one_hears_its_own_port_only() {
    let mut builder = Builder::new();
    let ports = [
        builder.can_bus("can", 500_000),
        builder.can_bus("other", 500_000),
    ];
    let device = Actor::new(CAN_500K)
        .send(ms(1), "000#")
        .then(ms(2), Do::Send(1, transmission("000#")));
    builder.device(device.boxed(), &ports);
    let mut lane = builder.build();
    let listener = Actor::new(CAN_500K);
    let heard = listener.heard();
    lane.attach(ports[1], listener.boxed());
    assert_eq!(lane.receive(ms(10)).unwrap().unwrap().port, ports[0]);
    assert_eq!(lane.receive(ms(10)).unwrap().unwrap().port, ports[1]);
    assert_eq!(*heard.lock().unwrap(), [(us(2_100), 0, received("000#"))]);
}

#[test]
fn one_that_is_off_takes_no_part() {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    let device = Actor::new(CAN_500K).send(ms(12), "000#");
    builder.device(device.boxed(), &[can]);
    let mut lane = builder.build();
    let off = sync_producer().off();
    let heard = off.heard();
    lane.attach(can, off.boxed());
    let only = arrival(us(12_100), Origin::Bus, "000#");
    assert_eq!(lane.receive(ms(25)), Ok(Some(only)));
    assert_eq!(lane.receive(ms(25)), Ok(None));
    assert!(heard.lock().unwrap().is_empty());
}

#[test]
fn one_behind_a_serial_port_answers_the_device() {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    let inverter = builder.serial_line("inverter", MODBUS_9600);
    // A gateway: 0 is its CAN port, 1 its serial one.
    let request = Do::Send(1, Transmission::bytes(&[1]));
    let gateway = Actor::new(Line::Serial(MODBUS_9600)).then(ms(1), request);
    let heard = gateway.heard();
    builder.device(gateway.boxed(), &[can, inverter]);
    let mut lane = builder.build();
    let answers = Actor::new(Line::Serial(MODBUS_9600)).every(
        ms(5),
        Duration::from_secs(1),
        Transmission::bytes(&[2]),
    );
    let companion = lane.attach(inverter, answers.boxed());
    let of = |at, origin, byte| Arrival {
        port: inverter,
        at: Instant::from_nanos(at),
        origin,
        what: Reception::Character(Character::new(byte)),
    };
    let request = of(2_145_833, Origin::Bus, 1);
    let answer = of(6_145_833, Origin::Companion(companion), 2);
    assert_eq!(lane.receive(ms(100)), Ok(Some(request)));
    assert_eq!(lane.receive(ms(100)), Ok(Some(answer)));
    assert_eq!(lane.receive(ms(100)), Ok(None));
    assert_eq!(*heard.lock().unwrap(), [(answer.at, 1, answer.what)]);
}

#[test]
fn a_companion_is_stimulated_by_the_port_that_it_is_on() {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    let other = builder.can_bus("other", 500_000);
    builder.device(Actor::new(CAN_500K).boxed(), &[can]);
    let mut lane = builder.build();
    let off = Stimulus::Power { on: false };
    assert_eq!(lane.stimulate_companion(can, &off), Err(NotOffered));
    lane.attach(can, sync_producer().boxed());
    assert_eq!(lane.stimulate_companion(other, &off), Err(NotOffered));
    assert_eq!(lane.stimulate_companion(can, &off), Ok(()));
    assert_eq!(
        lane.receive(ms(15)),
        Ok(None),
        "it is off, and sends nothing"
    );
    let unknown = Stimulus::Condition {
        name: "hot".to_owned(),
        active: true,
    };
    assert_eq!(lane.stimulate_companion(can, &unknown), Err(NotOffered));
}
