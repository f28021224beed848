//! Several open ports, and the wait for whatever comes next on any of them.

use std::collections::VecDeque;
use std::time::Duration;

use nix::errno::Errno;
use nix::poll::{PollFd, PollFlags, ppoll};
use nix::sys::time::TimeSpec;

use super::Clock;
use super::port::{Departure, News, Port, SHORT_WAIT, SendError, down};
use crate::lane::not_a_connection;
use crate::{
    Farewell, Instant, Line, LinkError, PortIndex, PortProperties, Reception, Sent, Transmission,
};

/// How long to wait at most before the ports are looked at again: they have things to do beside.
const LOOK: Duration = Duration::from_millis(100);

/// How long to wait before a busy port is tried again.
const BUSY_RETRY: Duration = Duration::from_micros(200);

/// What happens to a frame that nobody acknowledges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum GivesUp {
    /// It is an error: nobody else is on the bus.
    WithAnError,
    /// The controller goes on trying, and more than it can hold is lost.
    Silently,
}

/// Something that came from a port, or went out of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Heard<Sender> {
    pub(super) port: usize,
    pub(super) at: Instant,
    pub(super) what: Reception,
    /// Who of this process sent it; `None` for whatever came from outside.
    pub(super) from: Option<Sender>,
}

/// A transmission that has not left yet.
struct Leaving<Sender> {
    from: Sender,
    what: Transmission,
    /// When it was given to the port.
    since: Instant,
}

/// The open ports of a process. `Sender` says who of the process sent something.
pub(super) struct Ports<Sender> {
    pub(super) clock: Clock,
    /// `None` where a further connection was closed.
    ports: Vec<Option<Box<dyn Port>>>,
    /// So many of them were there from the beginning; a connection among those behind them may end without harm.
    lasting: usize,
    properties: Vec<PortProperties>,
    leaving: Vec<VecDeque<Leaving<Sender>>>,
    gives_up: GivesUp,
    heard: VecDeque<Heard<Sender>>,
    /// Why a port is of no use any more; told once everything that was heard before is taken.
    failed: Option<LinkError>,
    news: Vec<News>,
}

impl<Sender: Copy + PartialEq> Ports<Sender> {
    pub(super) fn new(ports: Vec<Box<dyn Port>>, gives_up: GivesUp) -> Ports<Sender> {
        Ports {
            clock: Clock::start(),
            properties: ports.iter().map(|it| it.properties().clone()).collect(),
            leaving: ports.iter().map(|_| VecDeque::new()).collect(),
            lasting: ports.len(),
            ports: ports.into_iter().map(Some).collect(),
            gives_up,
            heard: VecDeque::new(),
            failed: None,
            news: Vec::new(),
        }
    }

    pub(super) fn properties(&self) -> &[PortProperties] {
        &self.properties
    }

    /// Opens a further connection to where `port` leads.
    pub(super) fn connect(&mut self, port: usize, name: &str) -> Result<usize, LinkError> {
        let again = self.ports.get(port).and_then(Option::as_ref);
        let Some(opened) = again.and_then(|port| port.again(name)) else {
            return Err(not_a_connection(&self.properties, PortIndex(port)));
        };
        let opened = opened.map_err(|error| down(&self.properties[port], error))?;
        let closed = (self.lasting..self.ports.len()).find(|place| self.ports[*place].is_none());
        let place = closed.unwrap_or(self.ports.len());
        if place == self.ports.len() {
            self.properties.push(opened.properties().clone());
            self.leaving.push(VecDeque::new());
            self.ports.push(None);
        }
        self.properties[place] = opened.properties().clone();
        self.ports[place] = Some(opened);
        Ok(place)
    }

    /// Ends a further connection.
    pub(super) fn disconnect(&mut self, port: usize, how: Farewell) -> Result<(), LinkError> {
        if port < self.lasting || port >= self.ports.len() {
            return Err(not_a_connection(&self.properties, PortIndex(port)));
        }
        if let Some(mut open) = self.ports[port].take() {
            open.farewell(how);
        }
        self.heard.retain(|heard| heard.port != port);
        Ok(())
    }

    pub(super) fn tells_departure(&self, port: usize) -> bool {
        let properties = self.properties.get(port);
        properties.is_some_and(|properties| properties.tells_departure)
    }

    pub(super) fn set_line(&mut self, port: usize, line: Line) -> Result<(), LinkError> {
        let Some(Some(open)) = self.ports.get_mut(port) else {
            return Err(no_such_port(port));
        };
        open.set_line(line)?;
        self.properties[port] = open.properties().clone();
        Ok(())
    }

    /// Gives `what` to a port. The instant at which it leaves, if that is known already; else it will be heard.
    pub(super) fn send(
        &mut self,
        port: usize,
        from: Sender,
        what: Transmission,
    ) -> Result<Option<Sent>, LinkError> {
        let started = self.clock.now();
        loop {
            let Some(Some(open)) = self.ports.get_mut(port) else {
                return Err(self.closed(port));
            };
            let give_up = started + open.patience();
            match open.send(&mut self.clock, &what) {
                Ok(Departure::At(sent)) => {
                    self.hear_own(port, from, &what, sent);
                    return Ok(Some(sent));
                }
                Ok(Departure::Told) => {
                    let since = self.clock.now();
                    self.leaving[port].push_back(Leaving { from, what, since });
                    return Ok(None);
                }
                Err(SendError::Link(error)) => return Err(error),
                Err(SendError::Busy) if self.clock.now() >= give_up => {
                    return match self.gives_up {
                        GivesUp::WithAnError => Err(self.not_acknowledged(port)),
                        GivesUp::Silently => Ok(None),
                    };
                }
                Err(SendError::Busy) => self.wait(self.clock.now() + BUSY_RETRY)?,
            }
        }
    }

    /// The oldest thing heard and not taken yet that is not later than `until`.
    pub(super) fn next_heard(&mut self, until: Instant) -> Option<Heard<Sender>> {
        let is_due = self.heard.front().is_some_and(|heard| heard.at <= until);
        is_due.then(|| self.heard.pop_front()).flatten()
    }

    /// Waits until something comes on any port, but not later than `until` and not for long; then takes all that has
    /// come.
    pub(super) fn wait(&mut self, until: Instant) -> Result<(), LinkError> {
        if let Some(error) = &self.failed {
            return Err(error.clone());
        }
        let timeout = until.since(self.clock.now()).min(LOOK);
        if timeout > SHORT_WAIT && self.take_waiting() {
            return Ok(());
        }
        let open = self.ports.iter().flatten();
        let readable = open.map(|port| port.readable());
        let mut descriptors: Vec<PollFd<'_>> = readable
            .map(|descriptor| PollFd::new(descriptor, PollFlags::POLLIN))
            .collect();
        match ppoll(&mut descriptors, Some(TimeSpec::from(timeout)), None) {
            // After a signal, the caller looks whether it still wants to wait.
            Ok(_) | Err(Errno::EINTR) => self.take(),
            Err(error) => {
                self.failed = self.properties.first().map(|port| down(port, error));
            }
        }
        Ok(())
    }

    /// Takes all that has come, without waiting.
    pub(super) fn take(&mut self) {
        for port in 0..self.ports.len() {
            let Some(open) = &mut self.ports[port] else {
                continue;
            };
            let mut news = std::mem::take(&mut self.news);
            let taken = open.take(&mut self.clock, &mut news);
            self.tell(port, news, taken);
        }
    }

    /// Waits for a single port in one system call, if it can do that.
    fn take_waiting(&mut self) -> bool {
        let [Some(port)] = self.ports.as_mut_slice() else {
            return false;
        };
        let mut news = std::mem::take(&mut self.news);
        match port.take_waiting(&mut self.clock, &mut news) {
            Some(taken) => {
                self.tell(0, news, taken);
                true
            }
            None => {
                self.news = news;
                false
            }
        }
    }

    fn tell(&mut self, port: usize, mut news: Vec<News>, taken: Result<(), LinkError>) {
        let ended = taken.is_err() && port >= self.lasting;
        if let Err(error) = taken
            && !ended
        {
            self.failed.get_or_insert(error);
        }
        for news in news.drain(..) {
            match news {
                News::Arrived { at, what } => self.hear(port, at, what, None),
                News::Left(sent) => {
                    if let Some(leaving) = self.leaving[port].pop_front() {
                        self.hear_own(port, leaving.from, &leaving.what, sent);
                    }
                }
            }
        }
        self.news = news;
        if ended {
            let now = self.clock.now();
            self.hear(port, now, Reception::Closed, None);
            self.ports[port] = None;
        }
        self.give_up_leaving(port);
    }

    /// A frame that nobody acknowledges stays in the controller, which goes on trying.
    fn give_up_leaving(&mut self, port: usize) {
        let Some(oldest) = self.leaving[port].front() else {
            return;
        };
        let Some(open) = &self.ports[port] else {
            return;
        };
        let patience = open.patience();
        if self.gives_up == GivesUp::WithAnError && self.clock.now().since(oldest.since) > patience
        {
            self.leaving[port].clear();
            let error = self.not_acknowledged(port);
            self.failed.get_or_insert(error);
        }
    }

    fn hear_own(&mut self, port: usize, from: Sender, what: &Transmission, sent: Sent) {
        match what {
            Transmission::Frame(frame) => {
                self.hear(port, sent.end, Reception::Frame(*frame), Some(from));
            }
            Transmission::Characters(characters) => {
                for character in characters {
                    let what = Reception::Character(*character);
                    self.hear(port, sent.end, what, Some(from));
                }
            }
            Transmission::Close => {}
        }
    }

    /// Keeps what was heard in the order of time over all ports.
    fn hear(&mut self, port: usize, at: Instant, what: Reception, from: Option<Sender>) {
        let later = self.heard.iter().rev().take_while(|it| it.at > at).count();
        let place = self.heard.len() - later;
        let heard = Heard {
            port,
            at,
            what,
            from,
        };
        self.heard.insert(place, heard);
    }

    fn closed(&self, port: usize) -> LinkError {
        match self.properties.get(port) {
            Some(properties) => down(properties, "the connection is closed"),
            None => no_such_port(port),
        }
    }

    fn not_acknowledged(&self, port: usize) -> LinkError {
        LinkError::NotAcknowledged {
            port: self.properties[port].name.clone(),
        }
    }
}

fn no_such_port(port: usize) -> LinkError {
    LinkError::Down {
        port: format!("number {port}"),
        reason: "the lane has no such port".to_owned(),
    }
}
