//! Whatever arrives, no device panics, and none wants to be woken at an instant at which it just was.

#![allow(clippy::unwrap_used)]

use std::time::Duration;

use fieldproof_can::{Frame, Id};
use fieldproof_devices::{Settings, kinds};
use fieldproof_link::{Character, Instant, Outbox, Participant, Reception, Stimulus, Transmission};
use proptest::prelude::*;

/// Something that happens to a device.
#[derive(Debug, Clone)]
enum Event {
    Frame(u16, Vec<u8>, bool),
    Characters(Vec<u8>),
    Pass(u64),
    Power(bool),
    Setting(&'static str, i64),
}

/// Requests that get somewhere, more often than chance would have them.
fn data() -> impl Strategy<Value = Vec<u8>> {
    let index = prop_oneof![
        Just(0x1003_u16),
        Just(0x1005),
        Just(0x1006),
        0x1008_u16..0x101A,
        Just(0x1029),
        Just(0x1201),
        0x1400_u16..0x1404,
        0x1600_u16..0x1604,
        0x1800_u16..0x1804,
        0x1A00_u16..0x1A04,
        Just(0x2025),
        Just(0x3000),
        0x6000_u16..0x6100,
        any::<u16>(),
    ];
    let request = (any::<u8>(), index, 0_u8..10, any::<[u8; 4]>()).prop_map(
        |(command, index, sub, value)| {
            let [low, high] = index.to_le_bytes();
            [&[command, low, high, sub][..], &value].concat()
        },
    );
    prop_oneof![3 => request, 1 => prop::collection::vec(any::<u8>(), 0..=8)]
}

fn event() -> impl Strategy<Value = Event> {
    let identifier = prop_oneof![
        1 => prop::sample::select(vec![
            0x000_u16, 0x080, 0x100, 0x7E5, 0x701, 0x705, 0x181, 0x201,
        ]),
        1 => Just(0x601),
        1 => 0_u16..0x800,
    ];
    let command = (
        prop::sample::select(vec![1_u8, 2, 0x80, 0x81, 0x82]),
        0_u8..2,
    );
    prop_oneof![
        6 => (identifier, data(), prop::bool::weighted(0.1))
            .prop_map(|(identifier, data, remote)| Event::Frame(identifier, data, remote)),
        1 => command.prop_map(|(command, node)| Event::Frame(0, vec![command, node], false)),
        1 => prop::collection::vec(any::<u8>(), 1..20).prop_map(Event::Characters),
        3 => (0_u64..300).prop_map(Event::Pass),
        1 => any::<bool>().prop_map(Event::Power),
        1 => (prop::sample::select(vec!["node", "bit-rate", "address", "baud"]), -1_i64..300)
            .prop_map(|(name, value)| Event::Setting(name, value)),
    ]
}

struct Played {
    device: Box<dyn Participant>,
    now: Instant,
}

impl Played {
    fn play(&mut self, event: &Event) {
        let mut out = Outbox::default();
        match event {
            Event::Frame(identifier, data, remote) => {
                let id = Id::standard(*identifier).unwrap();
                let frame = if *remote {
                    Frame::remote(id, u8::try_from(data.len()).unwrap())
                } else {
                    Frame::data(id, data)
                };
                let reception = Reception::Frame(frame.unwrap());
                self.device.receive(self.now, 0, reception, &mut out);
            }
            Event::Characters(bytes) => {
                for byte in bytes {
                    self.pass(1);
                    let reception = Reception::Character(Character::new(*byte));
                    self.device.receive(self.now, 1, reception, &mut out);
                }
            }
            Event::Pass(milliseconds) => self.pass(*milliseconds),
            Event::Power(on) => {
                let stimulus = Stimulus::Power { on: *on };
                self.device
                    .stimulate(self.now, &stimulus, &mut out)
                    .unwrap();
            }
            Event::Setting(name, value) => {
                let stimulus = Stimulus::Setting {
                    name: (*name).to_owned(),
                    value: *value,
                };
                // Refused where it is none of the device's.
                let _ = self.device.stimulate(self.now, &stimulus, &mut out);
            }
        }
        check(&mut out);
        self.pass(1);
        let _ = self.device.state();
        let _ = [0, 1, 2].map(|port| self.device.line(port));
    }

    fn pass(&mut self, milliseconds: u64) {
        let until = self.now + Duration::from_millis(milliseconds);
        while let Some(at) = self.device.wake_at().filter(|at| *at <= until) {
            self.now = self.now.max(at);
            let mut out = Outbox::default();
            // Several things may be due at one instant, one after the other, but not without end.
            for _ in 0..10 {
                self.device.wake(self.now, &mut out);
            }
            check(&mut out);
            assert!(self.device.wake_at().is_none_or(|at| at > self.now));
        }
        self.now = until;
    }
}

/// Frames go to port 0, characters to port 1.
fn check(out: &mut Outbox) {
    for (port, what) in out.drain() {
        match what {
            Transmission::Frame(_) => assert_eq!(port, 0),
            Transmission::Characters(_) | Transmission::Close => assert_eq!(port, 1),
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn no_input_breaks_a_device(events in prop::collection::vec(event(), 1..60), choice in any::<prop::sample::Index>()) {
        for kind in kinds() {
            let faults: Vec<_> = kind.faults().collect();
            let fault = (choice.index(faults.len() + 1)).checked_sub(1);
            let settings = Settings {
                node: Some(1),
                fault: fault.map(|fault| faults[fault].name.to_owned()),
                ..Settings::default()
            };
            let device = (kind.build)(&settings).unwrap();
            let mut played = Played { device, now: Instant::START };
            played.pass(100);
            for event in &events {
                played.play(event);
            }
        }
    }
}
