//! A device on real links, in the thread of its caller.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use super::port::Port;
use super::ports::{GivesUp, Ports};
use crate::{Instant, Line, LinkError, NotOffered, Outbox, Participant, Stimulus, Transmission};

/// How often the driver looks whether it is to stop, and whether there is a stimulus for the device.
const LOOK: Duration = Duration::from_millis(50);

/// Who sends through the ports: there is only the device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct TheDevice;

/// What is done to a served device beside the bus.
pub trait Control {
    /// The next stimulus, if there is one by now.
    fn next(&mut self) -> Option<Stimulus>;

    /// What became of it.
    fn done(&mut self, outcome: Result<(), NotOffered>);
}

/// Nothing is done to it.
impl Control for () {
    fn next(&mut self) -> Option<Stimulus> {
        None
    }

    fn done(&mut self, _: Result<(), NotOffered>) {}
}

/// Lets `device` take part in `ports`, its port numbers in their order, until `stop` is set.
///
/// # Errors
/// [`LinkError`]: a link failed.
pub fn serve(
    device: Box<dyn Participant>,
    ports: Vec<Box<dyn Port>>,
    control: &mut dyn Control,
    stop: &AtomicBool,
) -> Result<(), LinkError> {
    let mut server = Server {
        device,
        ports: Ports::new(ports, GivesUp::Silently),
        outbox: Outbox::default(),
        held: VecDeque::new(),
        now: Instant::START,
    };
    while !stop.load(Ordering::Relaxed) {
        server.wake();
        server.listen();
        if let Some(stimulus) = control.next() {
            let now = server.now();
            let outbox = &mut server.outbox;
            control.done(server.device.stimulate(now, &stimulus, outbox));
        }
        server.send()?;
        server.release()?;
        server.follow_lines();
        let until = server.ports.clock.now() + LOOK;
        let held_until = server.held.front().map(|held| held.0);
        let wakes = [server.device.wake_at(), held_until, Some(until)];
        let next = wakes.into_iter().flatten().min().unwrap_or(until);
        server.ports.wait(next)?;
    }
    Ok(())
}

struct Server {
    device: Box<dyn Participant>,
    ports: Ports<TheDevice>,
    outbox: Outbox,
    /// Characters on a line that takes no time for them, until the device has sent them by its own clock: before that,
    /// it does not listen.
    held: VecDeque<(Instant, usize, Transmission)>,
    /// The last instant the device was told: for it, time never goes back.
    now: Instant,
}

impl Server {
    fn now(&mut self) -> Instant {
        self.now = self.now.max(self.ports.clock.now());
        self.now
    }

    fn wake(&mut self) {
        let now = self.now();
        if self.device.wake_at().is_some_and(|at| at <= now) {
            self.device.wake(now, &mut self.outbox);
        }
    }

    fn listen(&mut self) {
        while let Some(heard) = self.ports.next_heard(Instant::NEVER) {
            if heard.from.is_none() && self.device.line(heard.port) != Line::Off {
                self.now = self.now.max(heard.at);
                self.device
                    .receive(self.now, heard.port, heard.what, &mut self.outbox);
            }
        }
    }

    fn send(&mut self) -> Result<(), LinkError> {
        let pending: Vec<_> = self.outbox.drain().collect();
        for (port, what) in pending {
            match (self.device.line(port), &what) {
                (Line::Off, _) => {}
                (Line::Serial(settings), Transmission::Characters(characters))
                    if !self.ports.properties()[port].has_bit_times() =>
                {
                    let length = settings.character_time() * characters.len() as u32;
                    let begin = self
                        .held
                        .back()
                        .map_or(self.now, |held| held.0.max(self.now));
                    self.held.push_back((begin + length, port, what));
                }
                _ => {
                    self.ports.send(port, TheDevice, what)?;
                }
            }
        }
        Ok(())
    }

    /// Sends what was held back, once its time has come.
    fn release(&mut self) -> Result<(), LinkError> {
        let now = self.now();
        while self.held.front().is_some_and(|held| held.0 <= now) {
            if let Some((_, port, what)) = self.held.pop_front() {
                self.ports.send(port, TheDevice, what)?;
            }
        }
        Ok(())
    }

    /// Sets the ports as the device sets itself, where a port can be set: its baud rate may be a register.
    fn follow_lines(&mut self) {
        for port in 0..self.ports.properties().len() {
            let line = self.device.line(port);
            let properties = &self.ports.properties()[port];
            if line != Line::Off && line != properties.line && properties.sets_bit_rate {
                // What cannot be set stays; then the device is not understood, as on a real line.
                let _ = self.ports.set_line(port, line);
            }
        }
    }
}
