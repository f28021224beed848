//! A connection to a Modbus server: Modbus TCP, or RTU frames over TCP.

use std::net::{SocketAddr, TcpStream, ToSocketAddrs};
use std::os::fd::BorrowedFd;
use std::time::Duration;

use super::connection::{Broken, Connection, Given};
use super::port::{Departure, News, Port, SendError, down};
use super::{Clock, OpenError};
use crate::{Farewell, Framing, Line, LinkError, PortProperties, Sent, Transmission};

/// How late bytes may be read after they arrived, and how long they may lie before they are sent, if nobody knows
/// better: a wake-up of a busy machine.
const UNCERTAINTY: Duration = Duration::from_millis(1);

/// A TCP connection to a device. Bytes carry the instant at which they were read.
pub struct Tcp {
    connection: Connection,
    properties: PortProperties,
    host_port: String,
    framing: Framing,
    connect_timeout: Duration,
}

impl Tcp {
    /// Connects `role` to `host_port` (`192.168.1.10:502`), waiting up to `connect_timeout` for each of its addresses.
    /// Without an `uncertainty`, instants are taken to be within 1 ms.
    ///
    /// # Errors
    /// [`OpenError`]: the host is not known, or nobody there takes the connection.
    pub fn open(
        role: &str,
        host_port: &str,
        framing: Framing,
        connect_timeout: Duration,
        uncertainty: Option<Duration>,
    ) -> Result<Tcp, OpenError> {
        let link = link_text(host_port, framing);
        let wrong = |reason: String| OpenError::new(&link, reason);
        let stream = connect(host_port, connect_timeout).map_err(wrong)?;
        let connection = Connection::new(stream).map_err(|error| wrong(error.to_string()))?;
        Ok(Tcp {
            connection,
            properties: properties(role, link.clone(), framing, uncertainty),
            host_port: host_port.to_owned(),
            framing,
            connect_timeout,
        })
    }

    fn down(&self, why: &Broken) -> LinkError {
        down(&self.properties, why)
    }
}

/// The link as a bench file writes it.
pub(super) fn link_text(host_port: &str, framing: Framing) -> String {
    match framing {
        Framing::ModbusTcp => format!("tcp:{host_port}"),
        Framing::Rtu => format!("tcp:{host_port}?framing=rtu"),
    }
}

pub(super) fn properties(
    role: &str,
    link: String,
    framing: Framing,
    uncertainty: Option<Duration>,
) -> PortProperties {
    PortProperties {
        name: role.to_owned(),
        link,
        line: Line::Stream(framing),
        timestamps: "user space",
        uncertainty: uncertainty.unwrap_or(UNCERTAINTY),
        sets_bit_rate: false,
        tells_departure: false,
    }
}

fn connect(host_port: &str, timeout: Duration) -> Result<TcpStream, String> {
    let addresses = host_port
        .to_socket_addrs()
        .map_err(|error| format!("the host is not known: {error}"))?;
    let mut reason = "the host has no address".to_owned();
    for address in addresses {
        match TcpStream::connect_timeout(&address, timeout.max(Duration::from_millis(1))) {
            Ok(stream) => return Ok(stream),
            Err(error) => reason = not_connected(address, timeout, &error),
        }
    }
    Err(reason)
}

fn not_connected(address: SocketAddr, timeout: Duration, error: &std::io::Error) -> String {
    match error.kind() {
        std::io::ErrorKind::ConnectionRefused => {
            format!("{address} refuses the connection: nothing listens there")
        }
        std::io::ErrorKind::TimedOut => {
            let milliseconds = timeout.as_millis();
            format!("{address} did not take the connection within {milliseconds} ms")
        }
        _ => format!("{address}: {error}"),
    }
}

impl Port for Tcp {
    fn properties(&self) -> &PortProperties {
        &self.properties
    }

    fn readable(&self) -> BorrowedFd<'_> {
        self.connection.readable()
    }

    fn send(&mut self, clock: &mut Clock, what: &Transmission) -> Result<Departure, SendError> {
        // Before it is given to the system: the answer may be there before that returns.
        let at = clock.now();
        match self.connection.send(what) {
            Ok(Given::Sent) => Ok(Departure::At(Sent { start: at, end: at })),
            Ok(Given::Busy) => Err(SendError::Busy),
            Ok(Given::WrongKind) => {
                let port = self.properties.name.clone();
                Err(LinkError::WrongKind { port }.into())
            }
            Err(why) => Err(self.down(&why).into()),
        }
    }

    fn take(&mut self, clock: &mut Clock, news: &mut Vec<News>) -> Result<(), LinkError> {
        let taken = self.connection.take(clock, news);
        taken.map_err(|why| self.down(&why))
    }

    fn take_waiting(
        &mut self,
        clock: &mut Clock,
        news: &mut Vec<News>,
    ) -> Option<Result<(), LinkError>> {
        let taken = self.connection.take_waiting(clock, news);
        Some(taken.map_err(|why| self.down(&why)))
    }

    fn again(&self, name: &str) -> Option<Result<Box<dyn Port>, OpenError>> {
        let uncertainty = Some(self.properties.uncertainty);
        let opened = Tcp::open(
            name,
            &self.host_port,
            self.framing,
            self.connect_timeout,
            uncertainty,
        );
        Some(opened.map(|port| Box::new(port) as Box<dyn Port>))
    }

    fn farewell(&mut self, how: Farewell) {
        if how == Farewell::Reset {
            self.connection.reset_at_the_end();
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
