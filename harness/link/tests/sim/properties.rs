//! What holds for any traffic.

use std::time::Duration;

use fastrand::Rng;
use fieldproof_can::{Frame, Id};
use fieldproof_link::sim::Builder;
use fieldproof_link::{
    Arrival, Instant, Lane, Line, Origin, Outbox, Participant, PortIndex, Reception, Sent,
    Transmission,
};
use proptest::prelude::*;

use crate::actor::ms;

const BIT_RATE: u32 = 250_000;
const BIT: Duration = Duration::from_nanos(1_000_000_000 / BIT_RATE as u64);
const END: Instant = ms(50);
const PORT: PortIndex = PortIndex(0);

/// Sends random frames at random instants until 40 ms. The last two data bytes of each are its own number and a count.
struct Chatter {
    number: u8,
    count: u8,
    random: Rng,
    next: Instant,
}

impl Chatter {
    fn new(number: u8, seed: u64) -> Chatter {
        let mut random = Rng::with_seed(seed + u64::from(number));
        let next = Instant::from_nanos(random.u64(0..2_000_000));
        Chatter {
            number,
            count: 0,
            random,
            next,
        }
    }
}

fn any_frame(random: &mut Rng, tail: [u8; 2]) -> Frame {
    let id = if random.bool() {
        Id::standard(random.u16(0..=0x7FF))
    } else {
        Id::extended(random.u32(0..=0x1FFF_FFFF))
    };
    let mut data: Vec<u8> = (0..random.usize(0..=6)).map(|_| random.u8(..)).collect();
    data.extend(tail);
    Frame::data(id.unwrap(), &data).unwrap()
}

impl Participant for Chatter {
    fn line(&self, _port: usize) -> Line {
        let bit_rate = BIT_RATE;
        Line::Can { bit_rate }
    }

    fn receive(&mut self, _now: Instant, port: usize, _what: Reception, out: &mut Outbox) {
        // Sometimes an answer, so that traffic depends on traffic.
        if self.random.u8(..) < 16 && self.next < ms(40) {
            self.count += 1;
            let tail = [self.number, self.count];
            out.send(port, Transmission::Frame(any_frame(&mut self.random, tail)));
        }
    }

    fn wake_at(&self) -> Option<Instant> {
        (self.next < ms(40)).then_some(self.next)
    }

    fn wake(&mut self, _now: Instant, out: &mut Outbox) {
        for _ in 0..self.random.usize(1..=3) {
            self.count += 1;
            let tail = [self.number, self.count];
            out.send(0, Transmission::Frame(any_frame(&mut self.random, tail)));
        }
        let pause = Duration::from_nanos(self.random.u64(1_000_000..4_000_000));
        self.next = self.next + pause;
    }
}

/// A frame on the bus, and who sent it; the tester is 0.
#[derive(Debug, Clone, Copy, PartialEq)]
struct OnBus {
    start: Instant,
    end: Instant,
    sender: u8,
    count: u8,
}

impl OnBus {
    fn new(start: Option<Instant>, end: Instant, frame: Frame) -> OnBus {
        let [.., sender, count] = *frame.bytes() else {
            panic!("not ours: {frame}");
        };
        OnBus {
            start: start.unwrap_or(end - BIT * frame.bits()),
            end,
            sender,
            count,
        }
    }
}

/// What `devices` and one companion say while the tester sends, too: all that was on the bus, by its end.
fn play(devices: u8, seed: u64) -> Vec<OnBus> {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", BIT_RATE);
    for number in 1..=devices {
        builder.participant(Box::new(Chatter::new(number, seed)), &[can]);
    }
    let mut lane = builder.build();
    let companion = devices + 1;
    let index = lane.attach(can, Box::new(Chatter::new(companion, seed)));
    let mut random = Rng::with_seed(!seed);
    let mut all = Vec::new();
    for count in 0..8 {
        let frame = any_frame(&mut random, [0, count]);
        let at = Instant::from_nanos(random.u64(0..40_000_000)).max(lane.now());
        let Sent { start, end } = lane.send(PORT, at, Transmission::Frame(frame)).unwrap();
        assert!(start >= at);
        all.push(OnBus::new(Some(start), end, frame));
    }
    let mut last = Instant::START;
    while let Some(arrival) = lane.receive(END).unwrap() {
        let Arrival {
            at, origin, what, ..
        } = arrival;
        let Reception::Frame(frame) = what else {
            panic!("a character on a CAN bus");
        };
        let on_bus = OnBus::new(None, at, frame);
        let from_companion = origin == Origin::Companion(index);
        assert_eq!(on_bus.sender == companion, from_companion);
        assert!(at > last, "arrivals are in the order of time");
        last = at;
        all.push(on_bus);
    }
    all.sort_by_key(|on_bus| on_bus.end);
    all
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn frames_never_overlap_and_keep_the_intermission(devices in 1u8..5, seed in 0u64..1 << 32) {
        let all = play(devices, seed);
        prop_assert!(all.len() > 8);
        for pair in all.windows(2) {
            prop_assert!(pair[1].start >= pair[0].end + BIT * 3, "{pair:?}");
        }
    }

    #[test]
    fn every_frame_of_a_node_arrives_once_and_in_its_order(devices in 1u8..5, seed in 0u64..1 << 32) {
        let all = play(devices, seed);
        for sender in 1..=devices + 1 {
            let counts: Vec<u8> = all.iter().filter(|f| f.sender == sender).map(|f| f.count).collect();
            let expected: Vec<u8> = (1..=counts.len() as u8).collect();
            prop_assert_eq!(counts, expected);
        }
    }

    #[test]
    fn the_same_seed_gives_the_same_instants(devices in 1u8..5, seed in 0u64..1 << 32) {
        prop_assert_eq!(play(devices, seed), play(devices, seed));
        prop_assert_ne!(play(devices, seed), play(devices, seed + 1));
    }
}
