//! A CAN bus without adapters: programs share it as if each had an SLCAN adapter of its own.

mod bus;
mod client;

use std::collections::BTreeMap;
use std::io;
use std::net::{SocketAddr, TcpListener};
use std::os::fd::{AsFd, AsRawFd};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use nix::errno::Errno;
use nix::fcntl::{FcntlArg, OFlag, fcntl};
use nix::poll::{PollFd, PollFlags, ppoll};
use nix::pty::openpty;
use nix::sys::time::TimeSpec;
use nix::unistd::ttyname;

use self::bus::Bus;
use self::client::{Client, Place};
use super::slcan::connection::{Connection, make_raw, without_waiting};
use super::{Clock, OpenError};
use crate::Instant;

/// How often the hub looks whether it is to stop, and whether somebody has opened a pseudo-terminal.
const LOOK: Duration = Duration::from_millis(20);

/// More connections at once are not taken.
const MOST_CLIENTS: usize = 64;

/// What a [`Hub`] offers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HubOptions {
    /// Where it listens for connections over TCP; port 0 is a free one.
    pub tcp: Option<SocketAddr>,
    /// How many pseudo-terminals it makes.
    pub terminals: usize,
    /// Bits a second for clients that open their channel without setting a bit rate.
    pub bit_rate: u32,
    /// Whether a frame takes its bit times, or none.
    pub paced: bool,
}

/// A CAN bus without adapters. Each client speaks SLCAN, over TCP or a pseudo-terminal; a frame of one goes to all others
/// of the same bit rate, in one order for all, and is acknowledged to its sender once it was on the bus. Of frames that
/// wait at the same time the one with the lowest identifier goes first. As on `vcan`, a frame needs nobody to take it.
pub struct Hub {
    clock: Clock,
    listener: Option<TcpListener>,
    addresses: Vec<String>,
    clients: BTreeMap<u64, Client>,
    next_client: u64,
    bus: Bus,
    bit_rate: u32,
    looked: Instant,
}

/// What the hub is woken by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    Listener,
    Client(u64),
}

impl Hub {
    /// Listens, and makes the pseudo-terminals.
    ///
    /// # Errors
    /// [`OpenError`]: the address is taken, or the system makes no more pseudo-terminals.
    pub fn listen(options: &HubOptions) -> Result<Hub, OpenError> {
        let mut hub = Hub {
            clock: Clock::start(),
            listener: None,
            addresses: Vec::new(),
            clients: BTreeMap::new(),
            next_client: 0,
            bus: Bus::new(options.paced),
            bit_rate: options.bit_rate,
            looked: Instant::START,
        };
        if let Some(address) = options.tcp {
            let name = format!("tcp://{address}");
            let listened = hub.listen_at(address);
            listened.map_err(|error| OpenError::new(&name, error))?;
        }
        for _ in 0..options.terminals {
            let made = hub.make_terminal();
            made.map_err(|error| OpenError::new("pseudo-terminal", error))?;
        }
        Ok(hub)
    }

    /// Where clients find it: `tcp://127.0.0.1:29536`, `/dev/pts/4`.
    pub fn addresses(&self) -> &[String] {
        &self.addresses
    }

    fn listen_at(&mut self, address: SocketAddr) -> io::Result<()> {
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        self.addresses
            .push(format!("tcp://{}", listener.local_addr()?));
        self.listener = Some(listener);
        Ok(())
    }

    fn make_terminal(&mut self) -> io::Result<()> {
        let pair = openpty(None, None)?;
        make_raw(pair.slave.as_fd())?;
        let path = ttyname(&pair.slave)?.display().to_string();
        let flags = fcntl(pair.master.as_raw_fd(), FcntlArg::F_GETFL)?;
        let flags = OFlag::from_bits_retain(flags) | OFlag::O_NONBLOCK;
        fcntl(pair.master.as_raw_fd(), FcntlArg::F_SETFL(flags))?;
        self.addresses.push(path.clone());
        self.join(Connection::on(pair.master), path, Place::Terminal);
        Ok(())
    }

    fn join(&mut self, connection: Connection, name: String, place: Place) {
        let client = Client::new(connection, name, place, self.bit_rate, self.bus.is_paced());
        self.clients.insert(self.next_client, client);
        self.next_client += 1;
    }

    /// Carries frames until `stop` is set. `notice` is told in words which clients were dropped and why.
    ///
    /// # Errors
    /// The system cannot wait for clients.
    pub fn run(&mut self, stop: &AtomicBool, mut notice: impl FnMut(&str)) -> io::Result<()> {
        while !stop.load(Ordering::Relaxed) {
            let ready = self.wait()?;
            let now = self.clock.now();
            for source in ready {
                match source {
                    Source::Listener => self.accept(),
                    Source::Client(id) => {
                        if let Some(client) = self.clients.get_mut(&id) {
                            client.fill();
                        }
                    }
                }
            }
            self.look_at_terminals(now);
            self.carry(now);
            self.clients.retain(|_, client| client.goes_on(&mut notice));
        }
        Ok(())
    }

    /// Does what clients say and what the bus has time for, until nothing is left to do.
    fn carry(&mut self, now: Instant) {
        loop {
            for client in self.clients.values_mut() {
                client.obey(now);
            }
            if !self.bus.carry(now, &mut self.clients) {
                break;
            }
        }
    }

    /// Waits until a client has something to say, or the frame on the bus is over.
    fn wait(&self) -> io::Result<Vec<Source>> {
        let mut sources = Vec::with_capacity(self.clients.len() + 1);
        let mut descriptors = Vec::with_capacity(self.clients.len() + 1);
        if let Some(listener) = &self.listener
            && self.clients.len() < MOST_CLIENTS
        {
            sources.push(Source::Listener);
            descriptors.push(PollFd::new(listener.as_fd(), PollFlags::POLLIN));
        }
        for (id, client) in &self.clients {
            let wants = client.wants();
            if !wants.is_empty() {
                sources.push(Source::Client(*id));
                descriptors.push(PollFd::new(client.descriptor(), wants));
            }
        }
        let next = self.bus.next_change(&self.clients);
        let timeout = next.since(self.clock.now()).min(LOOK);
        match ppoll(&mut descriptors, Some(TimeSpec::from(timeout)), None) {
            Ok(_) => {}
            Err(Errno::EINTR) => return Ok(Vec::new()),
            Err(error) => return Err(error.into()),
        }
        let ready = sources.into_iter().zip(&descriptors);
        let ready = ready.filter(|(_, descriptor)| descriptor.any().unwrap_or(true));
        Ok(ready.map(|(source, _)| source).collect())
    }

    fn accept(&mut self) {
        let Some(listener) = &self.listener else {
            return;
        };
        // A client that is gone already, or that the system has no room for, is none.
        if let Ok((stream, address)) = listener.accept()
            && without_waiting(&stream).is_ok()
        {
            self.join(Connection::on(stream), address.to_string(), Place::Network);
        }
    }

    /// Nothing tells that somebody has opened a pseudo-terminal again.
    fn look_at_terminals(&mut self, now: Instant) {
        if now.since(self.looked) < LOOK {
            return;
        }
        self.looked = now;
        for client in self.clients.values_mut() {
            client.look_whether_opened();
        }
    }
}
