//! A port that waits for a Modbus client: where a reference device is served over TCP.

use std::net::{SocketAddr, TcpListener};
use std::os::fd::{AsFd, BorrowedFd};
use std::time::Duration;

use nix::errno::Errno;
use nix::sys::epoll::{Epoll, EpollCreateFlags, EpollEvent, EpollFlags};

use super::connection::{Connection, Given};
use super::port::{Departure, News, Port, SendError, down};
use super::tcp::{link_text, properties};
use super::{Clock, OpenError};
use crate::{Framing, Line, LinkError, PortProperties, Reception, Sent, Transmission};

/// A port that listens, and carries one connection at a time. Who comes while there is one waits until that is closed;
/// who closes it ends nothing but the connection.
pub struct TcpServer {
    listener: TcpListener,
    address: SocketAddr,
    connection: Option<Connection>,
    /// Readable when the connection is, or without one when somebody waits to be connected.
    readable: Epoll,
    properties: PortProperties,
}

impl TcpServer {
    /// Listens on `host_port` (`127.0.0.1:1502`; port 0 takes a free one).
    ///
    /// # Errors
    /// [`OpenError`]: no such address is here, or it is taken, or reserved.
    pub fn listen(role: &str, host_port: &str, framing: Framing) -> Result<TcpServer, OpenError> {
        let link = link_text(host_port, framing);
        let wrong = |error: std::io::Error| OpenError::new(&link, not_listening(&error));
        let listener = TcpListener::bind(host_port).map_err(wrong)?;
        listener.set_nonblocking(true).map_err(wrong)?;
        let address = listener.local_addr().map_err(wrong)?;
        let readable =
            Epoll::new(EpollCreateFlags::EPOLL_CLOEXEC).map_err(|error| wrong(error.into()))?;
        let link = link_text(&address.to_string(), framing);
        let server = TcpServer {
            listener,
            address,
            connection: None,
            readable,
            properties: properties(role, link.clone(), framing, Some(Duration::from_millis(1))),
        };
        server
            .watch_listener()
            .map_err(|error| OpenError::new(&link, error))?;
        Ok(server)
    }

    /// Another port that listens at the same place: it takes the next client while this one has one.
    ///
    /// # Errors
    /// [`OpenError`]: the system has no room for it.
    pub fn beside(&self) -> Result<TcpServer, OpenError> {
        let link = &self.properties.link;
        let wrong = |error: std::io::Error| OpenError::new(link, error);
        let readable =
            Epoll::new(EpollCreateFlags::EPOLL_CLOEXEC).map_err(|error| wrong(error.into()))?;
        let server = TcpServer {
            listener: self.listener.try_clone().map_err(wrong)?,
            address: self.address,
            connection: None,
            readable,
            properties: self.properties.clone(),
        };
        server
            .watch_listener()
            .map_err(|error| OpenError::new(link, error))?;
        Ok(server)
    }

    /// Where it listens.
    pub fn address(&self) -> SocketAddr {
        self.address
    }

    fn watch_listener(&self) -> Result<(), Errno> {
        let event = EpollEvent::new(EpollFlags::EPOLLIN, 0);
        self.readable.add(&self.listener, event)
    }

    /// Takes the next client, if one waits.
    fn accept(&mut self) -> Result<(), LinkError> {
        let accepted = match self.listener.accept() {
            Ok((stream, _)) => Connection::new(stream),
            // Nobody, or somebody who has gone again.
            Err(_) => return Ok(()),
        };
        let Ok(connection) = accepted else {
            return Ok(());
        };
        let event = EpollEvent::new(EpollFlags::EPOLLIN, 1);
        self.readable
            .add(connection.readable(), event)
            .and_then(|()| self.readable.delete(&self.listener))
            .map_err(|error| down(&self.properties, error))?;
        self.connection = Some(connection);
        Ok(())
    }

    /// The client has gone; the next one may come.
    fn hang_up(&mut self) -> Result<(), LinkError> {
        // Closing it takes it out of what is watched.
        self.connection = None;
        self.watch_listener()
            .map_err(|error| down(&self.properties, error))
    }
}

fn told(clock: &Clock, what: Reception) -> News {
    News::Arrived {
        at: clock.now(),
        what,
    }
}

fn not_listening(error: &std::io::Error) -> String {
    match error.kind() {
        std::io::ErrorKind::AddrInUse => "something else listens there already".into(),
        std::io::ErrorKind::PermissionDenied => {
            "ports below 1024 are reserved; `tcp:HOST:1502` is free to all".into()
        }
        _ => error.to_string(),
    }
}

impl Port for TcpServer {
    fn properties(&self) -> &PortProperties {
        &self.properties
    }

    fn readable(&self) -> BorrowedFd<'_> {
        self.readable.0.as_fd()
    }

    fn send(&mut self, clock: &mut Clock, what: &Transmission) -> Result<Departure, SendError> {
        let at = clock.now();
        let sent = Departure::At(Sent { start: at, end: at });
        // What nobody is there to hear is lost, as on a line.
        let Some(connection) = &mut self.connection else {
            return Ok(sent);
        };
        if *what == Transmission::Close {
            self.hang_up()?;
            return Ok(sent);
        }
        match connection.send(what) {
            Ok(Given::Sent) => Ok(sent),
            Ok(Given::Busy) => Err(SendError::Busy),
            Ok(Given::WrongKind) => {
                let port = self.properties.name.clone();
                Err(LinkError::WrongKind { port }.into())
            }
            Err(_) => {
                self.hang_up()?;
                Ok(sent)
            }
        }
    }

    fn take(&mut self, clock: &mut Clock, news: &mut Vec<News>) -> Result<(), LinkError> {
        if self.connection.is_none() {
            self.accept()?;
            if self.connection.is_some() {
                news.push(told(clock, Reception::Connected));
            }
        }
        let connection = self.connection.as_mut();
        match connection.map(|connection| connection.take(clock, news)) {
            Some(Err(_)) => {
                news.push(told(clock, Reception::Closed));
                self.hang_up()
            }
            Some(Ok(())) | None => Ok(()),
        }
    }

    fn set_line(&mut self, line: Line) -> Result<(), LinkError> {
        if line == self.properties.line {
            return Ok(());
        }
        Err(down(
            &self.properties,
            "a TCP connection has no line settings",
        ))
    }
}
