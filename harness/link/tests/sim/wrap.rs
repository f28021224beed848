//! Bad lines before a simulated lane.

use std::num::NonZeroU32;
use std::time::Duration;

use fieldproof_link::sim::{Builder, SimLane};
use fieldproof_link::{
    Character, FaultyLine, Instant, Lane, Line, LineFault, Origin, Parity, PortIndex, Reception,
    SerialSettings, Transmission,
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
    let mut lane = FaultyLine::new(can_lane(), PORT, drop);
    let expected = [(us(1_100), received("000#")), (us(3_096), received("200#"))];
    assert_eq!(arrivals(&mut lane, ms(10)), expected);
}

#[test]
fn another_port_is_whole() {
    let drop = LineFault::Drop { every: every(1) };
    let mut lane = FaultyLine::new(can_lane(), PortIndex(1), drop);
    assert_eq!(arrivals(&mut lane, ms(10)).len(), 3);
}

#[test]
fn a_late_frame_is_late_and_keeps_its_place() {
    let delay = LineFault::Delay(Duration::from_millis(1));
    let mut lane = FaultyLine::new(can_lane(), PORT, delay);
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
        let mut lane = FaultyLine::new(serial_lane(parity), PORT, flip(mask));
        let expected = [(1, false), (2, false), third, (4, false)];
        assert_eq!(characters(&mut lane), expected);
    }
    let mut lane = FaultyLine::new(can_lane(), PORT, flip(0xFF));
    assert_eq!(
        arrivals(&mut lane, ms(10)),
        arrivals(&mut can_lane(), ms(10))
    );
}

#[test]
fn what_the_tester_sends_goes_through() {
    let drop = LineFault::Drop { every: every(1) };
    let mut lane = FaultyLine::new(can_lane(), PORT, drop);
    let sent = lane.send(PORT, ms(5), transmission("000#")).unwrap();
    assert_eq!(sent.end, us(5_100));
    assert_eq!(lane.receive(ms(10)), Ok(None));
}
