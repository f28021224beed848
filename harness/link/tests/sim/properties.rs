//! What holds for any traffic.

use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
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
/// Long enough for everything to get through.
const END: Instant = ms(1_000);
const PORT: PortIndex = PortIndex(0);

/// Sends random frames at random instants until 40 ms. The last two data bytes of each are its own number and a count.
struct Chatter {
    number: u8,
    count: Arc<AtomicU8>,
    random: Rng,
    next: Instant,
}

impl Chatter {
    fn new(number: u8, seed: u64) -> Chatter {
        let mut random = Rng::with_seed(seed + u64::from(number));
        let next = Instant::from_nanos(random.u64(0..2_000_000));
        Chatter {
            number,
            count: Arc::default(),
            random,
            next,
        }
    }

    fn say(&mut self, port: usize, out: &mut Outbox) {
        let count = self.count.fetch_add(1, Ordering::Relaxed) + 1;
        let frame = any_frame(&mut self.random, [self.number, count]);
        out.send(port, Transmission::Frame(frame));
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
            self.say(port, out);
        }
    }

    fn wake_at(&self) -> Option<Instant> {
        (self.next < ms(40)).then_some(self.next)
    }

    fn wake(&mut self, _now: Instant, out: &mut Outbox) {
        for _ in 0..self.random.usize(1..=3) {
            self.say(0, out);
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

/// What `devices` and one companion say while the tester sends, too: all that was on the bus, by its end, and how much
/// each wanted to say.
fn play(devices: u8, seed: u64) -> (Vec<OnBus>, Vec<u8>) {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", BIT_RATE);
    let mut counts = Vec::new();
    let mut chatter = |number| {
        let chatter = Chatter::new(number, seed);
        counts.push(Arc::clone(&chatter.count));
        Box::new(chatter)
    };
    for number in 1..=devices {
        builder.participant(chatter(number), &[can]);
    }
    let mut lane = builder.build();
    let companion = devices + 1;
    let index = lane.attach(can, chatter(companion));
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
    let counts = counts.iter().map(|count| count.load(Ordering::Relaxed));
    (all, counts.collect())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn frames_never_overlap_and_keep_the_intermission(devices in 1u8..5, seed in 0u64..1 << 32) {
        let (all, _) = play(devices, seed);
        prop_assert!(all.len() > 8);
        for pair in all.windows(2) {
            prop_assert!(pair[1].start >= pair[0].end + BIT * 3, "{pair:?}");
        }
    }

    #[test]
    fn every_frame_of_a_node_arrives_once_and_in_its_order(devices in 1u8..5, seed in 0u64..1 << 32) {
        let (all, wanted) = play(devices, seed);
        for (sender, wanted) in (1..).zip(wanted) {
            let counts: Vec<u8> = all.iter().filter(|f| f.sender == sender).map(|f| f.count).collect();
            let expected: Vec<u8> = (1..=wanted).collect();
            prop_assert_eq!(counts, expected);
        }
    }

    #[test]
    fn the_same_seed_gives_the_same_instants(devices in 1u8..5, seed in 0u64..1 << 32) {
        prop_assert_eq!(play(devices, seed), play(devices, seed));
        prop_assert_ne!(play(devices, seed).0, play(devices, seed + 1).0);
    }
}
