//! The SLCAN link, on the hub and against adapters that are scripts.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpListener};
use std::thread::JoinHandle;
use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::real::{NoStimuli, Port, RealLane, Slcan};
use fieldproof_link::{
    Instant, Lane, Line, LinkError, Origin, PortIndex, Reception, Sent, Transmission,
};

use crate::slcan_hub::RunningHub;

pub(crate) const CAN: PortIndex = PortIndex(0);

pub(crate) fn frame(text: &str) -> Frame {
    text.parse().unwrap()
}

pub(crate) fn lane_on(target: &str, bit_rate: u32) -> RealLane {
    let port = Slcan::open("can", target, bit_rate, None).unwrap();
    RealLane::new(vec![Box::new(port)], Box::new(NoStimuli))
}

pub(crate) fn send(lane: &mut RealLane, frame: Frame) -> Sent {
    let now = lane.now();
    lane.send(CAN, now, Transmission::Frame(frame)).unwrap()
}

/// The next thing that arrives.
pub(crate) fn receive(lane: &mut RealLane) -> (Frame, Origin, Instant) {
    let until = lane.now() + Duration::from_secs(10);
    let arrival = lane.receive(until).unwrap().unwrap();
    match arrival.what {
        Reception::Frame(frame) => (frame, arrival.origin, arrival.at),
        other => panic!("{other:?}"),
    }
}

#[test]
fn two_lanes_hear_each_other() {
    let hub = RunningHub::start(2, false);
    for (first, second) in [
        (hub.tcp(), hub.tcp()),
        (hub.tcp(), hub.terminal(0)),
        (hub.terminal(0), hub.terminal(1)),
    ] {
        let (mut first, mut second) = (lane_on(first, 500_000), lane_on(second, 500_000));
        for (request, response) in [("60A#40001000", "58A#43"), ("1FFFFFFF#R8", "000#")] {
            let (request, response) = (frame(request), frame(response));
            let handed_over = send(&mut first, request);
            let (came, origin, _) = receive(&mut second);
            assert_eq!((came, origin), (request, Origin::Bus));
            send(&mut second, response);
            let (own, origin, left) = receive(&mut first);
            assert_eq!((own, origin), (request, Origin::Tester));
            assert!(left >= handed_over.start);
            let (came, origin, at) = receive(&mut first);
            assert_eq!((came, origin), (response, Origin::Bus));
            assert!(at >= left);
            assert_eq!(receive(&mut second).1, Origin::Tester);
        }
    }
}

#[test]
fn the_properties_say_what_the_hub_does() {
    let hub = RunningHub::start(0, false);
    let port = Slcan::open("can", hub.tcp(), 125_000, None).unwrap();
    let properties = port.properties();
    assert_eq!(properties.link, format!("slcan:{}", hub.tcp()));
    assert_eq!(properties.line, Line::Can { bit_rate: 125_000 });
    assert_eq!(properties.timestamps, "adapter");
    assert!(properties.tells_departure && properties.sets_bit_rate);
    let told = Some(Duration::from_micros(7));
    let port = Slcan::open("can", hub.tcp(), 125_000, told).unwrap();
    assert_eq!(port.properties().uncertainty, Duration::from_micros(7));
}

#[test]
fn other_bit_rates_are_not_heard_until_they_are_set() {
    let hub = RunningHub::start(0, false);
    let mut first = lane_on(hub.tcp(), 500_000);
    let mut second = lane_on(hub.tcp(), 125_000);
    send(&mut first, frame("111#"));
    assert_eq!(receive(&mut first).1, Origin::Tester);
    second
        .set_line(CAN, Line::Can { bit_rate: 500_000 })
        .unwrap();
    assert_eq!(second.ports()[0].line, Line::Can { bit_rate: 500_000 });
    send(&mut first, frame("222#"));
    assert_eq!(receive(&mut second).0, frame("222#"));
    let wrong = second.set_line(CAN, Line::Can { bit_rate: 33_333 });
    assert!(matches!(wrong, Err(LinkError::Down { .. })), "{wrong:?}");
}

#[test]
fn a_hub_that_ends_is_a_broken_bench() {
    let hub = RunningHub::start(1, false);
    let mut lanes = [
        lane_on(hub.tcp(), 500_000),
        lane_on(hub.terminal(0), 500_000),
    ];
    drop(hub);
    for lane in &mut lanes {
        let until = lane.now() + Duration::from_secs(10);
        let received = lane.receive(until);
        assert!(
            matches!(received, Err(LinkError::Down { .. })),
            "{received:?}"
        );
    }
}

#[test]
fn a_terminal_may_be_left_with_its_channel_open() {
    let hub = RunningHub::start(5, false);
    let mut other = lane_on(hub.tcp(), 125_000);
    for round in 0..5u8 {
        let terminal = hub.terminal(round.into());
        let left = std::fs::OpenOptions::new()
            .read(true)
            .write(true)
            .open(terminal);
        let mut left = left.unwrap();
        left.write_all(b"O\r").unwrap();
        let mut answer = [0];
        left.read_exact(&mut answer).unwrap();
        assert_eq!(answer, *b"\r");
        drop(left);
        for number in 0..100 {
            send(
                &mut other,
                Frame::of(fieldproof_can::StandardId::MAX, [round, number]),
            );
            receive(&mut other);
        }
        let mut next = lane_on(terminal, 125_000);
        send(&mut other, frame("123#"));
        assert_eq!(receive(&mut next).0, frame("123#"));
        receive(&mut other);
    }
}

#[test]
fn what_cannot_be_opened_says_why() {
    let reason = |target: &str, bit_rate| match Slcan::open("can", target, bit_rate, None) {
        Ok(_) => panic!("{target} was opened"),
        Err(error) => error.reason,
    };
    assert!(reason("/dev/ttyNone", 125_000).contains("is the adapter plugged in?"));
    assert!(reason("/dev/null", 125_000).contains("is no serial port"));
    assert!(reason("tcp://nonsense", 125_000).contains("nonsense"));
    let hub = RunningHub::start(0, false);
    assert!(reason(hub.tcp(), 33_333).contains("know no bit rate of 33333 bit/s"));
    let (silent, adapter) = scripted(Vec::new());
    assert!(reason(&format!("tcp://{silent}"), 125_000).contains("is it the right port"));
    adapter.join().unwrap();
}

/// An adapter that answers to each command what the script says, and to what is not in it nothing.
fn scripted(script: Vec<(&'static str, &'static str)>) -> (SocketAddr, JoinHandle<Vec<String>>) {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let adapter = std::thread::spawn(move || {
        let (mut host, _) = listener.accept().unwrap();
        let (mut heard, mut line) = (Vec::new(), String::new());
        let mut byte = [0];
        while let Ok(1) = host.read(&mut byte) {
            if byte[0] != b'\r' {
                line.push(char::from(byte[0]));
                continue;
            }
            let answer = script.iter().find(|(command, _)| *command == line);
            if let Some((_, answer)) = answer {
                // A host that is gone does not need it.
                let _ = host.write_all(answer.as_bytes());
            }
            heard.push(std::mem::take(&mut line));
        }
        heard
    });
    (address, adapter)
}

/// The answers of an adapter as Lawicel made them.
const LAWICEL: [(&str, &str); 10] = [
    ("", "\r"),
    ("C", "\r"),
    ("V", "V1013\r"),
    ("N", "NA123\r"),
    ("Z2", "\x07"),
    ("Z1", "\r"),
    ("S4", "\r"),
    ("O", "\r"),
    ("F", "F00\r"),
    ("t1230", "z\r"),
];

fn with(changes: &[(&'static str, &'static str)]) -> Vec<(&'static str, &'static str)> {
    let mut script = changes.to_vec();
    script.extend(LAWICEL);
    script
}

#[test]
fn an_adapter_is_set_and_left_in_this_order() {
    let (address, adapter) = scripted(with(&[]));
    let port = Slcan::open("can", &format!("{address}"), 125_000, None).unwrap();
    assert_eq!(port.properties().timestamps, "adapter");
    // USB hands over once a millisecond, and a frame of 160 bits takes 1.28 ms.
    assert_eq!(port.properties().uncertainty, Duration::from_micros(2_280));
    drop(port);
    let heard = adapter.join().unwrap().join(" ");
    assert_eq!(heard, "  C V C Z2 Z1 N C S4 O F C");
}

#[test]
fn an_adapter_that_acknowledges_nothing_is_used_all_the_same() {
    let (address, adapter) = scripted(vec![("V", "V0101\r")]);
    let target = format!("tcp://{address}");
    let mut lane = lane_on(&target, 125_000);
    let properties = &lane.ports()[0];
    assert_eq!(properties.timestamps, "user space");
    assert!(!properties.tells_departure);
    let sent = send(&mut lane, frame("123#"));
    // 44 bits and some stuff bits of 8 us.
    assert!(sent.end.since(sent.start) >= Duration::from_micros(44 * 8));
    drop(lane);
    let heard = adapter.join().unwrap();
    assert_eq!(heard[heard.len() - 5..].join(" "), "C S4 O t1230 C");
}

#[test]
fn a_frame_that_is_refused_breaks_the_bench() {
    let (address, adapter) = scripted(with(&[("t1230", "\x07")]));
    let mut lane = lane_on(&format!("tcp://{address}"), 125_000);
    send(&mut lane, frame("123#"));
    let until = lane.now() + Duration::from_secs(10);
    let error = lane.receive(until).unwrap_err();
    assert!(
        error.to_string().contains("did not take the frame 123#"),
        "{error}"
    );
    drop(lane);
    adapter.join().unwrap();
}

#[test]
fn a_frame_that_nobody_acknowledges_breaks_the_bench() {
    let (address, adapter) = scripted(with(&[("t1230", "")]));
    let mut lane = lane_on(&format!("tcp://{address}"), 125_000);
    send(&mut lane, frame("123#"));
    let until = lane.now() + Duration::from_secs(10);
    let error = lane.receive(until).unwrap_err();
    assert!(
        matches!(error, LinkError::NotAcknowledged { .. }),
        "{error}"
    );
    drop(lane);
    adapter.join().unwrap();
}

#[test]
fn a_full_receive_queue_breaks_the_bench_and_trouble_on_the_bus_is_told() {
    // The first answer is that of the opening; then it is asked once a second.
    let (address, adapter) = scripted(with(&[("F", "F24\r"), ("t1230", "z\rF09\r")]));
    let mut lane = lane_on(&format!("tcp://{address}"), 125_000);
    let until = lane.now() + Duration::from_secs(10);
    let arrival = lane.receive(until).unwrap().unwrap();
    match arrival.what {
        Reception::BusError(error) => assert_eq!(
            error.to_string(),
            "controller: receive error warning, transmit error warning, receive error passive, \
             transmit error passive"
        ),
        other => panic!("{other:?}"),
    }
    send(&mut lane, frame("123#"));
    assert_eq!(receive(&mut lane).1, Origin::Tester);
    let error = lane.receive(until).unwrap_err();
    assert!(matches!(error, LinkError::Overflow { .. }), "{error}");
    drop(lane);
    adapter.join().unwrap();
}

#[test]
fn spoilt_frames_break_the_bench_and_other_garbage_does_not() {
    let answer = "z\r\n\x00unheard of\rt12\x07t1232AABB0001\rt1232AA\r";
    let (address, adapter) = scripted(with(&[("t1230", answer)]));
    let mut lane = lane_on(&format!("tcp://{address}"), 125_000);
    send(&mut lane, frame("123#"));
    assert_eq!(receive(&mut lane).1, Origin::Tester);
    assert_eq!(receive(&mut lane).0, frame("123#AABB"));
    let until = lane.now() + Duration::from_secs(10);
    let error = lane.receive(until).unwrap_err();
    assert!(
        error.to_string().contains("spoilt frame, \"t1232AA\""),
        "{error}"
    );
    drop(lane);
    adapter.join().unwrap();
}
