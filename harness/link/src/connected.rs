//! A participant of which only some ports are connected.

use crate::{
    Instant, Line, NotOffered, Outbox, Participant, Reception, State, Stimulus, StimulusKind,
    Transmission,
};

/// A participant of which only some ports are connected. What it sends on the others is heard by nobody.
pub struct Connected {
    participant: Box<dyn Participant>,
    ports: Vec<usize>,
    outbox: Outbox,
}

impl Connected {
    /// `participant` with its own ports `ports`, which are numbered from 0 from here on.
    pub fn new(participant: Box<dyn Participant>, ports: Vec<usize>) -> Connected {
        Connected {
            participant,
            ports,
            outbox: Outbox::default(),
        }
    }

    fn pass_on(&mut self, out: &mut Outbox) {
        let pending: Vec<(usize, Transmission)> = self.outbox.drain().collect();
        for (own, what) in pending {
            if let Some(port) = self.ports.iter().position(|port| *port == own) {
                out.send(port, what);
            }
        }
    }
}

impl Participant for Connected {
    fn line(&self, port: usize) -> Line {
        let own = self.ports.get(port);
        own.map_or(Line::Off, |own| self.participant.line(*own))
    }

    fn receive(&mut self, now: Instant, port: usize, reception: Reception, out: &mut Outbox) {
        if let Some(own) = self.ports.get(port) {
            let inner = &mut self.outbox;
            self.participant.receive(now, *own, reception, inner);
            self.pass_on(out);
        }
    }

    fn wake_at(&self) -> Option<Instant> {
        self.participant.wake_at()
    }

    fn wake(&mut self, now: Instant, out: &mut Outbox) {
        self.participant.wake(now, &mut self.outbox);
        self.pass_on(out);
    }

    fn stimulate(
        &mut self,
        now: Instant,
        stimulus: &Stimulus,
        out: &mut Outbox,
    ) -> Result<(), NotOffered> {
        let done = self.participant.stimulate(now, stimulus, &mut self.outbox);
        self.pass_on(out);
        done
    }

    fn offers(&self) -> Vec<StimulusKind> {
        self.participant.offers()
    }

    fn state(&self) -> State {
        self.participant.state()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Character, Framing};

    /// Answers on the port after the one that it heard something on.
    struct Next;

    impl Participant for Next {
        fn line(&self, port: usize) -> Line {
            match port {
                2 => Line::Stream(Framing::Rtu),
                _ => Line::Off,
            }
        }

        fn receive(&mut self, _: Instant, port: usize, reception: Reception, out: &mut Outbox) {
            if let Reception::Character(character) = reception {
                out.send(port + 1, Transmission::Characters(vec![character]));
            }
        }

        fn wake_at(&self) -> Option<Instant> {
            None
        }

        fn wake(&mut self, _: Instant, out: &mut Outbox) {
            for port in 0..4 {
                out.send(port, Transmission::bytes(&[1]));
            }
        }
    }

    #[test]
    fn ports_are_renumbered_and_the_others_silent() {
        let mut connected = Connected::new(Box::new(Next), vec![2, 1]);
        assert_eq!(connected.line(0), Line::Stream(Framing::Rtu));
        assert_eq!(connected.line(1), Line::Off);
        assert_eq!(connected.line(2), Line::Off);
        let mut out = Outbox::default();
        let character = Reception::Character(Character::new(7));
        connected.receive(Instant::START, 1, character, &mut out);
        connected.receive(Instant::START, 0, character, &mut out);
        connected.receive(Instant::START, 5, character, &mut out);
        let sent: Vec<_> = out.drain().collect();
        assert_eq!(sent, [(0, Transmission::bytes(&[7]))]);
        connected.wake(Instant::START, &mut out);
        let ports: Vec<usize> = out.drain().map(|(port, _)| port).collect();
        assert_eq!(ports, [1, 0]);
    }
}
