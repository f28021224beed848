//! Bad lines before a simulated lane.

use std::num::NonZeroU32;
use std::time::Duration;

use fieldproof_link::sim::{Builder, SimLane};
use fieldproof_link::{
    BusError, Character, FaultyLine, Instant, Lane, Line, LineFault, Origin, Parity, PortIndex,
    Reception, SerialSettings, Transmission,
};

use crate::actor::{Actor, CAN_500K, Do, MODBUS_9600, ms, received, seen, transmission, us};

const PORT: PortIndex = PortIndex(0);

fn every(number: u32) -> NonZeroU32 {
    NonZeroU32::new(number).unwrap()
}

/// The device sends three frames: at 1.1, 2.096 and 3.096 ms.
fn can_lane() -> SimLane {
    let device = Actor::new(CAN_500K)
        .send(ms(1), "000#")
        .send(ms(2), "100#")
        .send(ms(3), "200#");
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    builder.device(device.boxed(), &[can]);
    builder.build()
}

fn serial_lane(parity: Parity) -> SimLane {
    let settings = SerialSettings {
        parity,
        ..MODBUS_9600
    };
    let bytes = Do::Send(0, Transmission::bytes(&[1, 2, 3, 4]));
    let mut builder = Builder::new();
    let serial = builder.serial_line("serial", settings);
    let device = Actor::new(Line::Serial(settings)).then(ms(1), bytes);
    builder.device(device.boxed(), &[serial]);
    builder.build()
}

fn arrivals(lane: &mut impl Lane, until: Instant) -> Vec<(Instant, Reception)> {
    std::iter::from_fn(|| seen(lane.receive(until).unwrap())).collect()
}

fn characters(lane: &mut impl Lane) -> Vec<(u8, bool)> {
    let byte = |(_, what)| match what {
        Reception::Character(Character { byte, spoilt }) => (byte, spoilt),
        other => panic!("{other:?} on a serial line"),
    };
    arrivals(lane, ms(10)).into_iter().map(byte).collect()
}

#[test]
fn every_second_frame_is_lost() {
    let drop = LineFault::Drop { every: every(2) };
    let mut lane = FaultyLine::new(Box::new(can_lane()), PORT, drop);
    let expected = [(us(1_100), received("000#")), (us(3_096), received("200#"))];
    assert_eq!(arrivals(&mut lane, ms(10)), expected);
}

#[test]
fn another_port_is_whole() {
    let drop = LineFault::Drop { every: every(1) };
    let mut lane = FaultyLine::new(Box::new(can_lane()), PortIndex(1), drop);
    assert_eq!(arrivals(&mut lane, ms(10)).len(), 3);
}

#[test]
fn a_late_frame_is_late_and_keeps_its_place() {
    let delay = LineFault::Delay {
        every: every(1),
        by: Duration::from_millis(1),
    };
    let mut lane = FaultyLine::new(Box::new(can_lane()), PORT, delay);
    assert_eq!(lane.receive(ms(2)), Ok(None));
    assert_eq!(lane.now(), ms(2));
    let sync = Actor::new(CAN_500K).send(us(2_500), "080#");
    let index = lane.attach(PORT, sync.boxed());
    // The tester's own SYNC, 96 us, comes between them at its own time.
    let first = lane.receive(ms(10)).unwrap().unwrap();
    assert_eq!((first.at, first.what), (us(2_100), received("000#")));
    assert_eq!(lane.now(), us(2_100));
    let second = lane.receive(ms(10)).unwrap().unwrap();
    assert_eq!((second.at, second.what), (us(2_596), received("080#")));
    assert_eq!(second.origin, Origin::Companion(index));
    let rest = [(us(3_096), received("100#")), (us(4_096), received("200#"))];
    assert_eq!(arrivals(&mut lane, ms(10)), rest);
    assert_eq!(lane.now(), ms(10));
}

#[test]
fn flipped_bits_are_noticed_by_parity_if_their_number_is_odd() {
    let flip = |mask| LineFault::Flip {
        every: every(3),
        mask,
    };
    let cases = [
        (Parity::Even, 0b001, (2, true)),
        (Parity::Odd, 0b011, (0, false)),
        (Parity::None, 0b001, (2, false)),
    ];
    for (parity, mask, third) in cases {
        let mut lane = FaultyLine::new(Box::new(serial_lane(parity)), PORT, flip(mask));
        let expected = [(1, false), (2, false), third, (4, false)];
        assert_eq!(characters(&mut lane), expected);
    }
}

#[test]
fn what_the_tester_sends_goes_through() {
    let drop = LineFault::Drop { every: every(1) };
    let mut lane = FaultyLine::new(Box::new(can_lane()), PORT, drop);
    let sent = lane.send(PORT, ms(5), transmission("000#")).unwrap();
    assert_eq!(sent.end, us(5_100));
    assert_eq!(lane.receive(ms(10)), Ok(None));
}

/// The device sends 16 bytes in two frames.
fn full_frames() -> SimLane {
    let device = Actor::new(CAN_500K)
        .send(ms(1), "100#0000000000000000")
        .send(ms(2), "100#0000000000000000");
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    builder.device(device.boxed(), &[can]);
    builder.build()
}

fn heard(lane: SimLane, fault: LineFault) -> Vec<Reception> {
    let mut lane = FaultyLine::new(Box::new(lane), PORT, fault);
    let all = arrivals(&mut lane, ms(10)).into_iter();
    all.map(|(_, what)| what).collect()
}

#[test]
fn an_adapter_can_damage_a_frame() {
    let flip = LineFault::Flip {
        every: every(1),
        mask: 0x81,
    };
    assert_eq!(
        heard(full_frames(), flip),
        [
            received("100#0081000000000000"),
            received("100#0000810000000000")
        ]
    );
    // Without data there is nothing to be damaged.
    assert_eq!(heard(can_lane(), flip).len(), 3);
}

#[test]
fn frames_arrive_twice() {
    let double = LineFault::Double { every: every(2) };
    let expected = ["000#", "100#", "100#", "200#"].map(received);
    assert_eq!(heard(can_lane(), double), expected);
}

#[test]
fn a_late_frame_is_passed_by_others() {
    let delay = LineFault::Delay {
        every: every(2),
        by: Duration::from_millis(5),
    };
    let expected = ["000#", "200#", "100#"].map(received);
    assert_eq!(heard(can_lane(), delay), expected);
}

#[test]
fn the_controller_tells_of_errors() {
    let error = BusError::new(1 << 7, [0; 8]);
    let disturb = LineFault::Disturb {
        every: every(3),
        error,
    };
    let came = heard(can_lane(), disturb);
    assert_eq!(came.len(), 4);
    assert_eq!(came[2], Reception::BusError(error));
    assert_eq!(came[3], received("200#"));
}

#[test]
fn what_the_tester_sends_is_not_understood() {
    let deafen = LineFault::Deafen { every: every(2) };
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    let device = Actor::new(CAN_500K);
    let heard = device.heard();
    builder.device(device.boxed(), &[can]);
    let mut lane = FaultyLine::new(Box::new(builder.build()), PORT, deafen);
    for at in [1, 2, 3] {
        lane.send(PORT, ms(at), transmission("080#")).unwrap();
    }
    lane.receive(ms(10)).unwrap();
    let heard = heard.lock().unwrap();
    let came: Vec<Reception> = heard.iter().map(|(_, _, what)| *what).collect();
    assert_eq!(came, ["080#", "1FFFFFFF#", "080#"].map(received));
}

#[test]
fn a_higher_priority_passes_what_waits() {
    let device = Actor::new(CAN_500K)
        .send(ms(1), "201#")
        .send(ms(2), "301#")
        .send(ms(3), "200#")
        .send(ms(8), "100#");
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    builder.device(device.boxed(), &[can]);
    let by_priority = LineFault::ByPriority {
        within: Duration::from_millis(3),
    };
    let mut lane = FaultyLine::new(Box::new(builder.build()), PORT, by_priority);
    let order: Vec<Reception> = arrivals(&mut lane, ms(20))
        .into_iter()
        .map(|(_, what)| what)
        .collect();
    let expected = ["200#", "201#", "301#", "100#"].map(received);
    assert_eq!(order, expected);
}
