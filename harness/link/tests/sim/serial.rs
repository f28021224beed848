//! Serial lines: character times, settings, collisions.

use fieldproof_link::sim::{Builder, SimLane};
use fieldproof_link::{
    Character, Instant, Lane, Line, Outbox, Participant, PortIndex, Reception, Sent,
    SerialSettings, Stimulus, Transmission,
};

use crate::actor::{Actor, Do, MODBUS_9600, ms, seen};

const SERIAL: PortIndex = PortIndex(0);

fn lane(others: Vec<Box<dyn Participant>>) -> SimLane {
    let mut builder = Builder::new();
    let serial = builder.serial_line("serial", MODBUS_9600);
    for (index, other) in others.into_iter().enumerate() {
        if index == 0 {
            builder.device(other, &[serial]);
        } else {
            builder.participant(other, &[serial]);
        }
    }
    builder.build()
}

fn sends(at: Instant, bytes: &[u8]) -> Actor {
    let what = Do::Send(0, Transmission::bytes(bytes));
    Actor::new(Line::Serial(MODBUS_9600)).then(at, what)
}

const fn ns(nanoseconds: u64) -> Instant {
    Instant::from_nanos(nanoseconds)
}

fn clean(byte: u8) -> Reception {
    Reception::Character(Character::new(byte))
}

fn spoilt(byte: u8) -> Reception {
    let spoilt = true;
    Reception::Character(Character { byte, spoilt })
}

fn arrivals(lane: &mut SimLane, until: Instant) -> Vec<(Instant, Reception)> {
    std::iter::from_fn(|| seen(lane.receive(until).unwrap())).collect()
}

#[test]
fn characters_follow_each_other_without_a_gap_or_a_rounding_error() {
    let device = Actor::new(Line::Serial(MODBUS_9600));
    let heard = device.heard();
    let mut lane = lane(vec![device.boxed()]);
    let request = Transmission::bytes(&[1, 2, 3]);
    let sent = lane.send(SERIAL, ms(1), request).unwrap();
    // n * 11 / 9600 s: 1.1458333.., 2.2916666.., 3.4375 ms.
    let expected = [
        (ns(2_145_833), 0, clean(1)),
        (ns(3_291_667), 0, clean(2)),
        (ns(4_437_500), 0, clean(3)),
    ];
    assert_eq!(*heard.lock().unwrap(), expected);
    let expected = Sent {
        start: ms(1),
        end: ns(4_437_500),
    };
    assert_eq!(sent, expected);
}

#[test]
fn nothing_to_send_takes_no_time() {
    let mut lane = lane(Vec::new());
    let sent = lane.send(SERIAL, ms(1), Transmission::bytes(&[])).unwrap();
    assert_eq!((sent.start, sent.end), (ms(1), ms(1)));
}

#[test]
fn a_line_needs_nobody_who_listens() {
    let mut lane = lane(Vec::new());
    let sent = lane.send(SERIAL, ms(1), Transmission::bytes(&[1])).unwrap();
    assert_eq!(sent.end, ns(2_145_833));
}

#[test]
fn what_follows_while_sending_joins_without_a_gap() {
    let device = sends(ms(1), &[1]).then(ms(2), Do::Send(0, Transmission::bytes(&[2])));
    let mut lane = lane(vec![device.boxed()]);
    let expected = [(ns(2_145_833), clean(1)), (ns(3_291_667), clean(2))];
    assert_eq!(arrivals(&mut lane, ms(10)), expected);
}

#[test]
fn what_comes_after_a_pause_counts_from_its_own_start() {
    let device = sends(ms(1), &[1]).then(ms(5), Do::Send(0, Transmission::bytes(&[2])));
    let mut lane = lane(vec![device.boxed()]);
    let expected = [(ns(2_145_833), clean(1)), (ns(6_145_833), clean(2))];
    assert_eq!(arrivals(&mut lane, ms(10)), expected);
}

#[test]
fn other_settings_spoil_what_is_heard() {
    let other = SerialSettings {
        baud: 19_200,
        ..MODBUS_9600
    };
    let mut lane = lane(vec![sends(ms(1), &[1]).boxed()]);
    lane.set_line(SERIAL, Line::Serial(other)).unwrap();
    // As long as its sender takes for it.
    assert_eq!(arrivals(&mut lane, ms(10)), [(ns(2_145_833), spoilt(1))]);
    lane.set_line(SERIAL, Line::Off).unwrap();
    assert!(
        lane.send(SERIAL, ms(10), Transmission::bytes(&[1]))
            .is_err()
    );
}

#[test]
fn a_character_is_spoilt_if_the_settings_change_under_it() {
    let other = SerialSettings {
        baud: 19_200,
        ..MODBUS_9600
    };
    let device = sends(ms(1), &[1, 2]).then(ms(2), Do::SetLine(Line::Serial(other)));
    let mut lane = lane(vec![device.boxed()]);
    lane.set_line(SERIAL, Line::Serial(other)).unwrap();
    // The second at the new rate: 11 / 19200 s = 572916.67 ns after the first.
    let expected = [(ns(2_145_833), spoilt(1)), (ns(2_718_750), clean(2))];
    assert_eq!(arrivals(&mut lane, ms(10)), expected);
}

#[test]
fn a_character_spoilt_on_purpose_arrives_so() {
    let what = Transmission::Characters(vec![Character {
        byte: 7,
        spoilt: true,
    }]);
    let device = Actor::new(Line::Serial(MODBUS_9600));
    let heard = device.heard();
    let mut lane = lane(vec![device.boxed()]);
    lane.send(SERIAL, ms(1), what).unwrap();
    assert_eq!(*heard.lock().unwrap(), [(ns(2_145_833), 0, spoilt(7))]);
}

#[test]
fn two_senders_at_once_spoil_each_other() {
    // The second character of the one overlaps with both of the other; the third is alone again.
    let first = sends(ms(1), &[1, 2, 3]);
    let second = sends(ns(2_500_000), &[9]);
    let listener = Actor::new(Line::Serial(MODBUS_9600));
    let heard = listener.heard();
    let mut lane = lane(vec![first.boxed(), second.boxed(), listener.boxed()]);
    // 9 from 2.5 ms to 3.645833 ms: during 2 (2.145833 to 3.291667) and 3 (3.291667 to 4.4375).
    let expected = [
        (ns(2_145_833), clean(1)),
        (ns(3_291_667), spoilt(2)),
        (ns(3_645_833), spoilt(9)),
        (ns(4_437_500), spoilt(3)),
    ];
    assert_eq!(arrivals(&mut lane, ms(10)), expected);
    let others: Vec<_> = heard
        .lock()
        .unwrap()
        .iter()
        .map(|(at, _, what)| (*at, *what))
        .collect();
    assert_eq!(others, expected);
}

#[test]
fn a_collision_ends_with_the_characters_in_it() {
    let first = sends(ms(1), &[1, 2]);
    let second = sends(ms(1), &[9]);
    let mut lane = lane(vec![first.boxed(), second.boxed()]);
    let expected = [
        (ns(2_145_833), spoilt(1)),
        (ns(2_145_833), spoilt(9)),
        (ns(3_291_667), clean(2)),
    ];
    assert_eq!(arrivals(&mut lane, ms(10)), expected);
}

#[test]
fn one_that_ends_as_another_begins_is_clean() {
    let first = sends(ms(1), &[1]);
    let second = sends(ns(2_145_833), &[2]);
    let mut lane = lane(vec![second.boxed(), first.boxed()]);
    let expected = [(ns(2_145_833), clean(1)), (ns(3_291_666), clean(2))];
    assert_eq!(arrivals(&mut lane, ms(10)), expected);
}

#[test]
fn a_device_that_loses_power_breaks_off() {
    let device = sends(ms(1), &[1, 2, 3]).then(ms(20), Do::Send(0, Transmission::bytes(&[4])));
    let mut lane = lane(vec![device.boxed()]);
    assert_eq!(lane.receive(ms(2)), Ok(None));
    lane.stimulate(&Stimulus::Power { on: false }).unwrap();
    assert_eq!(arrivals(&mut lane, ms(10)), [(ns(2_145_833), spoilt(1))]);
    // What it had to send is lost.
    lane.stimulate(&Stimulus::Power { on: true }).unwrap();
    assert_eq!(arrivals(&mut lane, ms(30)), [(ns(21_145_833), clean(4))]);
}

/// Answers with one character when the line has been silent for 3.5 of them.
struct Rtu {
    silent_at: Option<Instant>,
}

impl Participant for Rtu {
    fn line(&self, _port: usize) -> Line {
        Line::Serial(MODBUS_9600)
    }

    fn receive(&mut self, now: Instant, _port: usize, _what: Reception, _out: &mut Outbox) {
        self.silent_at = Some(now + MODBUS_9600.silence_3_5());
    }

    fn wake_at(&self) -> Option<Instant> {
        self.silent_at
    }

    fn wake(&mut self, _now: Instant, out: &mut Outbox) {
        self.silent_at = None;
        out.send(0, Transmission::bytes(&[0x55]));
    }
}

#[test]
fn a_slave_answers_after_its_silence() {
    let mut lane = lane(vec![Box::new(Rtu { silent_at: None })]);
    lane.send(SERIAL, ms(0), Transmission::bytes(&[1, 2]))
        .unwrap();
    // Request 22 bits, 2291667 ns; silence 38.5 bits, 4010417 ns; answer 11 bits, 1145833 ns.
    let expected = [(ns(7_447_917), clean(0x55))];
    assert_eq!(arrivals(&mut lane, ms(100)), expected);
}
