//! How many request and response pairs a second go over a simulated lane.

#![allow(clippy::unwrap_used)] // A bench that cannot go on has nothing to report.

use divan::black_box;
use divan::counter::ItemsCount;
use fieldproof_can::{Frame, StandardId};
use fieldproof_link::{
    Instant, Lane, Line, Outbox, Parity, Participant, PortIndex, Reception, SerialSettings,
    StopBits, Transmission, sim,
};

/// Pairs in one measured iteration.
const PAIRS: u32 = 1_000;

/// Answers everything at once: an SDO request on 601h with 581h, characters with the same.
struct Echo {
    line: Line,
    answer: StandardId,
}

impl Participant for Echo {
    fn line(&self, _port: usize) -> Line {
        self.line
    }

    fn receive(&mut self, _now: Instant, port: usize, reception: Reception, out: &mut Outbox) {
        out.send(
            port,
            match reception {
                Reception::Frame(frame) => Transmission::Frame(frame.with_id(self.answer)),
                Reception::Character(character) => Transmission::Characters(vec![character]),
                Reception::BusError(_) | Reception::Connected | Reception::Closed => return,
            },
        );
    }

    fn wake_at(&self) -> Option<Instant> {
        None
    }

    fn wake(&mut self, _now: Instant, _out: &mut Outbox) {}
}

fn standard(raw: u16) -> StandardId {
    StandardId::new(raw).unwrap()
}

fn echo(line: Line) -> Box<Echo> {
    let answer = standard(0x581);
    Box::new(Echo { line, answer })
}

/// One request sent and its response received; the first byte of the response.
fn pair(lane: &mut dyn Lane, port: PortIndex, what: Transmission) -> Reception {
    let sent = lane.send(port, lane.now(), what).unwrap();
    let until = Instant::from_nanos(sent.end.as_nanos() + 10_000_000);
    lane.receive(until).unwrap().unwrap().what
}

#[divan::bench]
fn can_frames(bencher: divan::Bencher) {
    let bit_rate = 1_000_000;
    let mut builder = sim::Builder::new();
    let can = builder.can_bus("can", bit_rate);
    builder.device(echo(Line::Can { bit_rate }), &[can]);
    let mut lane = builder.build();
    let mut counter = 0u32;
    bencher.counter(ItemsCount::new(PAIRS)).bench_local(|| {
        for _ in 0..PAIRS {
            counter += 1;
            let [a, b, c, d] = counter.to_le_bytes();
            let request = Frame::of_eight(standard(0x601), [0x40, 0, 0x10, 0, a, b, c, d]);
            black_box(pair(&mut lane, can, Transmission::Frame(request)));
        }
    });
}

#[divan::bench]
fn characters(bencher: divan::Bencher) {
    let settings = SerialSettings {
        baud: 115_200,
        parity: Parity::Even,
        stop_bits: StopBits::One,
    };
    let mut builder = sim::Builder::new();
    let serial = builder.serial_line("serial", settings);
    builder.device(echo(Line::Serial(settings)), &[serial]);
    let mut lane = builder.build();
    bencher.counter(ItemsCount::new(PAIRS)).bench_local(|| {
        for _ in 0..PAIRS {
            black_box(pair(&mut lane, serial, Transmission::bytes(&[0x55])));
        }
    });
}

fn main() {
    divan::main();
}
