//! A participant that plays a script and remembers what it heard.

use std::sync::{Arc, Mutex};
use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::{
    Arrival, Instant, Line, NotOffered, Outbox, Parity, Participant, Reception, SerialSettings,
    Stimulus, StimulusKind, StopBits, Transmission,
};

/// 2 us a bit.
pub(crate) const CAN_500K: Line = Line::Can { bit_rate: 500_000 };

/// 11 bits a character, 1 145 833.33 ns.
pub(crate) const MODBUS_9600: SerialSettings = SerialSettings {
    baud: 9_600,
    parity: Parity::Even,
    stop_bits: StopBits::One,
};

pub(crate) const fn us(microseconds: u64) -> Instant {
    Instant::from_nanos(microseconds * 1_000)
}

pub(crate) const fn ms(milliseconds: u64) -> Instant {
    us(milliseconds * 1_000)
}

/// In can-utils notation.
pub(crate) fn frame(text: &str) -> Frame {
    text.parse().unwrap()
}

pub(crate) fn transmission(text: &str) -> Transmission {
    Transmission::Frame(frame(text))
}

pub(crate) fn received(text: &str) -> Reception {
    Reception::Frame(frame(text))
}

/// When what came.
pub(crate) fn seen(arrival: Option<Arrival>) -> Option<(Instant, Reception)> {
    arrival.map(|arrival| (arrival.at, arrival.what))
}

pub(crate) enum Do {
    Send(usize, Transmission),
    SetLine(Line),
}

/// What it heard: when, on which of its ports, what.
pub(crate) type Heard = Arc<Mutex<Vec<(Instant, usize, Reception)>>>;

/// Plays a script and remembers what it heard. It offers power, and forgets nothing when it is switched off.
pub(crate) struct Actor {
    line: Line,
    powered: bool,
    /// In the order of time.
    script: Vec<(Instant, Do)>,
    done: usize,
    answer: Option<(Reception, Transmission)>,
    period: Option<(Instant, Duration, Transmission)>,
    heard: Heard,
}

impl Actor {
    pub(crate) fn new(line: Line) -> Actor {
        Actor {
            line,
            powered: true,
            script: Vec::new(),
            done: 0,
            answer: None,
            period: None,
            heard: Heard::default(),
        }
    }

    pub(crate) fn send(self, at: Instant, frame: &str) -> Actor {
        self.then(at, Do::Send(0, transmission(frame)))
    }

    pub(crate) fn then(mut self, at: Instant, action: Do) -> Actor {
        self.script.push((at, action));
        self
    }

    /// Sends `answer` at once whenever it hears `question`.
    pub(crate) fn answer(mut self, question: &str, answer: &str) -> Actor {
        self.answer = Some((received(question), transmission(answer)));
        self
    }

    /// Sends `what` at `first` and then every `period`.
    pub(crate) fn every(mut self, first: Instant, period: Duration, what: Transmission) -> Actor {
        self.period = Some((first, period, what));
        self
    }

    pub(crate) fn off(mut self) -> Actor {
        self.powered = false;
        self
    }

    pub(crate) fn heard(&self) -> Heard {
        Arc::clone(&self.heard)
    }

    pub(crate) fn boxed(self) -> Box<dyn Participant> {
        Box::new(self)
    }
}

impl Participant for Actor {
    fn line(&self, _port: usize) -> Line {
        if self.powered { self.line } else { Line::Off }
    }

    fn receive(&mut self, now: Instant, port: usize, reception: Reception, out: &mut Outbox) {
        self.heard.lock().unwrap().push((now, port, reception));
        if let Some((question, answer)) = &self.answer
            && *question == reception
        {
            out.send(port, answer.clone());
        }
    }

    fn wake_at(&self) -> Option<Instant> {
        let scripted = self.script.get(self.done).map(|(at, _)| *at);
        let periodic = self.period.as_ref().map(|(next, ..)| *next);
        scripted.into_iter().chain(periodic).min()
    }

    fn wake(&mut self, now: Instant, out: &mut Outbox) {
        while let Some((at, action)) = self.script.get(self.done)
            && *at <= now
        {
            self.done += 1;
            match action {
                Do::Send(port, what) => out.send(*port, what.clone()),
                Do::SetLine(line) => self.line = *line,
            }
        }
        if let Some((next, period, what)) = &mut self.period
            && *next <= now
        {
            *next = *next + *period;
            out.send(0, what.clone());
        }
    }

    fn stimulate(
        &mut self,
        _now: Instant,
        stimulus: &Stimulus,
        out: &mut Outbox,
    ) -> Result<(), NotOffered> {
        let Stimulus::Power { on } = stimulus else {
            return Err(NotOffered);
        };
        self.powered = *on;
        // Its boot-up, or in vain.
        out.send(0, transmission("701#00"));
        Ok(())
    }

    fn offers(&self) -> Vec<StimulusKind> {
        vec![StimulusKind::Power]
    }
}
