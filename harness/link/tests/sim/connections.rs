//! Connections: several to one device, in order and without bits of their own.

use std::sync::{Arc, Mutex};

use fieldproof_link::sim::{Builder, SimLane};
use fieldproof_link::{
    Character, Farewell, Framing, Instant, Lane, Line, LinkError, Outbox, Participant, PortIndex,
    Reception, Transmission,
};

use crate::actor::{ms, us};

type Heard = Arc<Mutex<Vec<(usize, Reception)>>>;

/// Sends each character back with a bit turned over, and ends the connection for a zero.
struct Server {
    heard: Heard,
}

impl Participant for Server {
    fn line(&self, _: usize) -> Line {
        Line::Stream(Framing::ModbusTcp)
    }

    fn receive(&mut self, _: Instant, port: usize, what: Reception, out: &mut Outbox) {
        self.heard.lock().unwrap().push((port, what));
        match what {
            Reception::Character(Character { byte: 0, .. }) => out.send(port, Transmission::Close),
            Reception::Character(it) => out.send(port, Transmission::bytes(&[it.byte ^ 1])),
            _ => {}
        }
    }

    fn wake_at(&self) -> Option<Instant> {
        None
    }

    fn wake(&mut self, _: Instant, _: &mut Outbox) {}
}

fn lane() -> (SimLane, PortIndex, Heard) {
    let heard = Heard::default();
    let mut builder = Builder::new();
    let port = builder.connection("tcp", Framing::ModbusTcp);
    let server = Server {
        heard: Arc::clone(&heard),
    };
    builder.device(Box::new(server), &[port]);
    (builder.build(), port, heard)
}

fn byte(byte: u8) -> Reception {
    Reception::Character(Character::new(byte))
}

/// All that comes until an instant: port, microseconds, what.
fn arrivals(lane: &mut SimLane, until: Instant) -> Vec<(usize, u64, Reception)> {
    let mut all = Vec::new();
    while let Some(arrival) = lane.receive(until).unwrap() {
        all.push((arrival.port.0, arrival.at.as_nanos() / 1_000, arrival.what));
    }
    all
}

#[test]
fn what_is_sent_arrives_a_little_later_at_the_other_end_alone() {
    let (mut lane, first, heard) = lane();
    let second = lane.connect(first, "second").unwrap();
    assert_eq!(lane.ports()[second.0].name, "second");
    let sent = lane.send(first, us(1_000), Transmission::bytes(&[0x10, 0x20]));
    assert_eq!(sent.unwrap().end, us(1_100));
    lane.send(second, us(2_000), Transmission::bytes(&[0x30]))
        .unwrap();
    assert_eq!(
        arrivals(&mut lane, ms(10)),
        [
            (0, 1_200, byte(0x11)),
            (0, 1_200, byte(0x21)),
            (1, 2_200, byte(0x31)),
        ]
    );
    let heard = heard.lock().unwrap();
    let expected = [
        (1, Reception::Connected),
        (0, byte(0x10)),
        (0, byte(0x20)),
        (1, byte(0x30)),
    ];
    assert_eq!(heard.as_slice(), expected);
}

#[test]
fn a_connection_that_is_closed_is_free_for_another() {
    let (mut lane, first, heard) = lane();
    let second = lane.connect(first, "second").unwrap();
    lane.disconnect(second, Farewell::Close).unwrap();
    assert_eq!(arrivals(&mut lane, ms(1)), []);
    let closed = lane.send(second, ms(2), Transmission::bytes(&[1]));
    assert!(matches!(closed, Err(LinkError::Down { .. })), "{closed:?}");
    let third = lane.connect(first, "third").unwrap();
    assert_eq!(third, second);
    lane.send(third, ms(3), Transmission::bytes(&[2])).unwrap();
    assert_eq!(arrivals(&mut lane, ms(10)), [(1, 3_200, byte(3))]);
    let heard = heard.lock().unwrap();
    let expected = [
        (1, Reception::Connected),
        (1, Reception::Closed),
        (1, Reception::Connected),
        (1, byte(2)),
    ];
    assert_eq!(heard.as_slice(), expected);
}

#[test]
fn the_device_may_end_it() {
    let (mut lane, first, _) = lane();
    let second = lane.connect(first, "second").unwrap();
    lane.send(second, ms(1), Transmission::bytes(&[7, 0, 9]))
        .unwrap();
    let came = arrivals(&mut lane, ms(10));
    assert_eq!(came, [(1, 1_200, byte(6)), (1, 1_200, Reception::Closed)]);
    lane.disconnect(second, Farewell::Reset).unwrap();
}

#[test]
fn only_connections_are_opened_again() {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 125_000);
    let mut lane = builder.build();
    assert!(lane.connect(can, "second").is_err());
    assert!(lane.connect(PortIndex(7), "second").is_err());
    assert!(lane.disconnect(can, Farewell::Close).is_err());
    let (mut lane, first, _) = self::lane();
    assert!(lane.disconnect(first, Farewell::Close).is_err(), "it stays");
}
