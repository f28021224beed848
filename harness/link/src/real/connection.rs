//! An open TCP connection as a port sees it: bytes without time of their own.

use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::os::fd::{AsFd, AsRawFd, BorrowedFd};
use std::time::Duration;

use nix::errno::Errno;
use nix::sys::socket::{MsgFlags, recv, setsockopt, sockopt};

use super::Clock;
use super::port::News;
#[cfg(doc)]
use super::port::SHORT_WAIT;
use crate::{Character, Reception, Transmission};

/// How long the kernel is asked to wait for bytes, and for room to send; see [`SHORT_WAIT`].
const WAIT_AS_ASKED: Duration = Duration::from_millis(10);

/// How many bytes are taken at once; a whole Modbus frame has at most 260.
const CHUNK: usize = 1024;

/// Why nothing goes on a connection any more.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Broken {
    /// The other side has closed it.
    Closed,
    /// In the words of the system.
    Failed(String),
}

impl std::fmt::Display for Broken {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Broken::Closed => f.write_str("the peer closed the connection"),
            Broken::Failed(why) => f.write_str(why),
        }
    }
}

impl From<std::io::Error> for Broken {
    fn from(error: std::io::Error) -> Broken {
        match error.kind() {
            ErrorKind::ConnectionReset => Broken::Failed("the peer reset the connection".into()),
            ErrorKind::BrokenPipe => Broken::Closed,
            _ => Broken::Failed(error.to_string()),
        }
    }
}

/// What became of bytes that were given to a connection.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Given {
    /// They are on their way.
    Sent,
    /// The system takes nothing for the moment.
    Busy,
    /// A connection does not carry this.
    WrongKind,
}

/// A connection, with small frames sent at once.
#[derive(Debug)]
pub(super) struct Connection {
    stream: TcpStream,
}

impl Connection {
    pub(super) fn new(stream: TcpStream) -> std::io::Result<Connection> {
        stream.set_nodelay(true)?;
        stream.set_nonblocking(false)?;
        stream.set_read_timeout(Some(WAIT_AS_ASKED))?;
        stream.set_write_timeout(Some(WAIT_AS_ASKED))?;
        Ok(Connection { stream })
    }

    /// When it is dropped, the other side is told by a reset.
    pub(super) fn reset_at_the_end(&self) {
        let at_once = nix::libc::linger {
            l_onoff: 1,
            l_linger: 0,
        };
        // Where that cannot be set it is closed in order.
        let _ = setsockopt(&self.stream, sockopt::Linger, &at_once);
    }

    pub(super) fn readable(&self) -> BorrowedFd<'_> {
        self.stream.as_fd()
    }

    /// Sends characters as bytes. Frames and spoilt characters it cannot carry.
    pub(super) fn send(&mut self, what: &Transmission) -> Result<Given, Broken> {
        let Transmission::Characters(characters) = what else {
            return Ok(Given::WrongKind);
        };
        if characters.iter().any(|character| character.spoilt) {
            return Ok(Given::WrongKind);
        }
        let bytes: Vec<u8> = characters.iter().map(|character| character.byte).collect();
        let mut rest = bytes.as_slice();
        while !rest.is_empty() {
            match self.stream.write(rest) {
                Ok(count) => rest = rest.get(count..).unwrap_or_default(),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => {
                    return match rest.len() == bytes.len() {
                        true => Ok(Given::Busy),
                        false => Err(Broken::Failed(
                            "the peer took only a part of what was sent".into(),
                        )),
                    };
                }
                Err(error) => return Err(error.into()),
            }
        }
        Ok(Given::Sent)
    }

    /// Takes all bytes that have come.
    pub(super) fn take(&mut self, clock: &Clock, news: &mut Vec<News>) -> Result<(), Broken> {
        let mut bytes = [0; CHUNK];
        loop {
            match recv(self.stream.as_raw_fd(), &mut bytes, MsgFlags::MSG_DONTWAIT) {
                Ok(0) => return Err(Broken::Closed),
                Ok(count) => {
                    tell(clock, bytes.get(..count).unwrap_or_default(), news);
                    if count < CHUNK {
                        return Ok(());
                    }
                }
                Err(Errno::EAGAIN) => return Ok(()),
                Err(Errno::EINTR) => {}
                Err(error) => return Err(std::io::Error::from(error).into()),
            }
        }
    }

    /// Takes what has come; if that is nothing, waits for something as long as a port may.
    pub(super) fn take_waiting(
        &mut self,
        clock: &Clock,
        news: &mut Vec<News>,
    ) -> Result<(), Broken> {
        let mut bytes = [0; CHUNK];
        match self.stream.read(&mut bytes) {
            Ok(0) => Err(Broken::Closed),
            Ok(count) => {
                tell(clock, bytes.get(..count).unwrap_or_default(), news);
                Ok(())
            }
            Err(error)
                if matches!(
                    error.kind(),
                    ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
                ) =>
            {
                Ok(())
            }
            Err(error) => Err(error.into()),
        }
    }
}

/// All of them arrived now, as far as anybody can know.
fn tell(clock: &Clock, bytes: &[u8], news: &mut Vec<News>) {
    let at = clock.now();
    news.extend(bytes.iter().map(|byte| News::Arrived {
        at,
        what: Reception::Character(Character::new(*byte)),
    }));
}
