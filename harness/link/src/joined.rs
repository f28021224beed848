//! Two participants that have a serial line between them, and are one to everybody else.

use std::collections::VecDeque;

use crate::{
    Character, Instant, Line, NotOffered, Outbox, Participant, Reception, Stimulus, StimulusKind,
    Transmission,
};

/// A device with another behind one of its serial ports: a gateway with its inverter. The line between them takes the
/// time that its characters take; all other ports are those of the device.
pub struct Joined {
    device: Box<dyn Participant>,
    /// The device's port to the other.
    port: usize,
    other: Box<dyn Participant>,
    /// What is on the line between them, by when it arrives; to the other or to the device.
    between: VecDeque<(Instant, To, Character)>,
    outbox: Outbox,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum To {
    Device,
    Other,
}

impl Joined {
    /// `device` with `other`, by its port 0, behind `port`.
    pub fn new(device: Box<dyn Participant>, port: usize, other: Box<dyn Participant>) -> Joined {
        Joined {
            device,
            port,
            other,
            between: VecDeque::new(),
            outbox: Outbox::default(),
        }
    }

    /// Takes what the device has to send: out, or to the other.
    fn sort_out(&mut self, now: Instant, out: &mut Outbox) {
        let pending: Vec<_> = self.outbox.drain().collect();
        for (port, what) in pending {
            match what {
                Transmission::Characters(characters) if port == self.port => {
                    self.put_between(now, To::Other, &characters);
                }
                what => out.send(port, what),
            }
        }
    }

    /// Takes what the other has to send.
    fn sort_back(&mut self, now: Instant) {
        let pending: Vec<_> = self.outbox.drain().collect();
        for (_, what) in pending {
            if let Transmission::Characters(characters) = what {
                self.put_between(now, To::Device, &characters);
            }
        }
    }

    /// Characters follow those that are already on the way.
    fn put_between(&mut self, now: Instant, to: To, characters: &[Character]) {
        let from = match to {
            To::Other => self.device.line(self.port),
            To::Device => self.other.line(0),
        };
        let Line::Serial(settings) = from else {
            return;
        };
        let last = self.between.back().map_or(now, |(at, ..)| now.max(*at));
        let mut at = last;
        for character in characters {
            at = at + settings.character_time();
            self.between.push_back((at, to, *character));
        }
    }

    /// Lets everything happen that is due by `now`, each at its own instant: between the two no driver is ever late.
    fn run_to(&mut self, now: Instant, out: &mut Outbox) {
        while let Some(at) = self.wake_at()
            && at <= now
        {
            match self.between.front().copied() {
                Some((arrival, to, character)) if arrival == at => {
                    self.between.pop_front();
                    self.deliver(at, to, character, out);
                }
                _ if self.device.wake_at() == Some(at) => {
                    self.device.wake(at, &mut self.outbox);
                    self.sort_out(at, out);
                }
                _ => {
                    self.other.wake(at, &mut self.outbox);
                    self.sort_back(at);
                }
            }
        }
    }

    fn deliver(&mut self, at: Instant, to: To, character: Character, out: &mut Outbox) {
        // Set differently, the two do not understand each other.
        if self.device.line(self.port) != self.other.line(0) {
            return;
        }
        let what = Reception::Character(character);
        match to {
            To::Other => {
                self.other.receive(at, 0, what, &mut self.outbox);
                self.sort_back(at);
            }
            To::Device => {
                self.device.receive(at, self.port, what, &mut self.outbox);
                self.sort_out(at, out);
            }
        }
    }
}

impl Participant for Joined {
    fn line(&self, port: usize) -> Line {
        self.device.line(port)
    }

    fn receive(&mut self, now: Instant, port: usize, reception: Reception, out: &mut Outbox) {
        self.run_to(now, out);
        self.device.receive(now, port, reception, &mut self.outbox);
        self.sort_out(now, out);
    }

    fn wake_at(&self) -> Option<Instant> {
        let arrival = self.between.front().map(|(at, ..)| *at);
        let wakes = [self.device.wake_at(), self.other.wake_at(), arrival];
        wakes.into_iter().flatten().min()
    }

    fn wake(&mut self, now: Instant, out: &mut Outbox) {
        self.run_to(now, out);
    }

    fn stimulate(
        &mut self,
        now: Instant,
        stimulus: &Stimulus,
        out: &mut Outbox,
    ) -> Result<(), NotOffered> {
        self.run_to(now, out);
        let given = self.device.stimulate(now, stimulus, &mut self.outbox);
        self.sort_out(now, out);
        given
    }

    fn offers(&self) -> Vec<StimulusKind> {
        self.device.offers()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Parity, SerialSettings, StopBits};

    // 10 bits at 10 kBd: 1 ms a character.
    const LINE: SerialSettings = SerialSettings {
        baud: 10_000,
        parity: Parity::None,
        stop_bits: StopBits::One,
    };

    /// Sends a question when woken at 5 ms, and passes on what comes back as a frame on port 0.
    struct Asks {
        asked: bool,
    }

    impl Participant for Asks {
        fn line(&self, port: usize) -> Line {
            match port {
                1 => Line::Serial(LINE),
                _ => Line::Can { bit_rate: 125_000 },
            }
        }

        fn receive(&mut self, _: Instant, port: usize, what: Reception, out: &mut Outbox) {
            if let (1, Reception::Character(character)) = (port, what) {
                out.send(0, Transmission::bytes(&[character.byte]));
            }
        }

        fn wake_at(&self) -> Option<Instant> {
            (!self.asked).then(|| Instant::from_nanos(5_000_000))
        }

        fn wake(&mut self, _: Instant, out: &mut Outbox) {
            self.asked = true;
            out.send(1, Transmission::bytes(&[0x11, 0x22]));
        }
    }

    /// Answers every character with the next number.
    struct Answers;

    impl Participant for Answers {
        fn line(&self, _: usize) -> Line {
            Line::Serial(LINE)
        }

        fn receive(&mut self, _: Instant, port: usize, what: Reception, out: &mut Outbox) {
            if let Reception::Character(character) = what {
                out.send(port, Transmission::bytes(&[character.byte + 1]));
            }
        }

        fn wake_at(&self) -> Option<Instant> {
            None
        }

        fn wake(&mut self, _: Instant, _: &mut Outbox) {}
    }

    #[test]
    fn characters_between_the_two_take_their_time_and_only_the_device_is_heard() {
        let mut joined = Joined::new(Box::new(Asks { asked: false }), 1, Box::new(Answers));
        let mut out = Outbox::default();
        let mut heard = Vec::new();
        while let Some(at) = joined.wake_at() {
            joined.wake(at, &mut out);
            heard.extend(out.drain().map(|(port, what)| (at.as_nanos(), port, what)));
        }
        assert_eq!(joined.offers(), []);
        // Asked at 5 ms; the question arrives at 6 and 7 ms, each answer a millisecond after what is on the line.
        let answer = |at_ms: u64, byte| (at_ms * 1_000_000, 0, Transmission::bytes(&[byte]));
        assert_eq!(heard, [answer(8, 0x12), answer(9, 0x23)]);
    }
}
