//! The line to an adapter, or to a host: bytes there and back without ever waiting, cut into lines.

use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Read, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::os::unix::fs::OpenOptionsExt;
use std::time::Duration;

use nix::errno::Errno;
use nix::fcntl::OFlag;
use nix::poll::{PollFd, PollFlags, ppoll};
use nix::sys::termios::{
    BaudRate, ControlFlags, FlushArg, SetArg, SpecialCharacterIndices, cfmakeraw, cfsetspeed,
    tcflush, tcgetattr, tcsetattr,
};
use nix::sys::time::TimeSpec;

use super::codec::{BELL, END};

/// More than any line has; the rest of a longer one is dropped.
const LONGEST_LINE: usize = 160;

/// How long to wait for a connection over TCP.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(2);

/// Bytes there and back, without waiting.
pub(crate) struct Connection {
    file: File,
    received: Vec<u8>,
    /// How many of these have been given out as lines.
    taken: usize,
    unsent: Vec<u8>,
    /// How many of these have been sent.
    sent: usize,
}

impl Connection {
    /// To `target`: `tcp://host:port`, `host:port`, or the path of a terminal.
    pub(super) fn open(target: &str) -> Result<Connection, String> {
        let address = target
            .strip_prefix("tcp://")
            .or_else(|| target.strip_prefix("socket://"));
        match address {
            Some(address) => connect(address),
            None if target.contains('/') || !target.contains(':') => open_terminal(target),
            None => connect(target),
        }
    }

    /// On what does not wait already.
    pub(crate) fn on(file: impl Into<OwnedFd>) -> Connection {
        Connection {
            file: File::from(file.into()),
            received: Vec::new(),
            taken: 0,
            unsent: Vec::new(),
            sent: 0,
        }
    }

    pub(crate) fn descriptor(&self) -> BorrowedFd<'_> {
        self.file.as_fd()
    }

    /// Where what is to be sent is appended; [`Connection::flush`] sends it.
    pub(crate) fn outbox(&mut self) -> &mut Vec<u8> {
        &mut self.unsent
    }

    /// How many bytes the other side has not taken yet.
    pub(crate) fn unsent(&self) -> usize {
        self.unsent.len() - self.sent
    }

    /// Sends as much as goes without waiting.
    pub(crate) fn flush(&mut self) -> io::Result<()> {
        while self.unsent() > 0 {
            match self.file.write(&self.unsent[self.sent..]) {
                Ok(count) => self.sent += count,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => {
                    self.unsent.drain(..self.sent);
                    self.sent = 0;
                    return Ok(());
                }
                Err(error) => return Err(error),
            }
        }
        self.unsent.clear();
        self.sent = 0;
        Ok(())
    }

    /// Forgets what was received and what was to be sent.
    pub(crate) fn forget(&mut self) {
        self.received.clear();
        self.taken = 0;
        self.forget_unsent();
    }

    /// Forgets what was to be sent.
    pub(crate) fn forget_unsent(&mut self) {
        self.unsent.clear();
        self.sent = 0;
    }

    /// Takes what has arrived, up to some thousand bytes; whether there may be more. The end of the connection is an
    /// error.
    pub(crate) fn fill(&mut self) -> io::Result<bool> {
        let mut chunk = [0; 4096];
        let count = match self.file.read(&mut chunk) {
            Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
            Ok(count) => count,
            Err(error) if error.kind() == ErrorKind::Interrupted => return Ok(true),
            Err(error) if error.kind() == ErrorKind::WouldBlock => return Ok(false),
            Err(error) => return Err(error),
        };
        self.received.drain(..self.taken);
        self.taken = 0;
        self.received.extend(&chunk[..count]);
        Ok(count == chunk.len())
    }

    /// Waits until something has arrived, but not longer than `timeout`.
    pub(super) fn wait(&self, timeout: Duration) -> io::Result<()> {
        let mut descriptors = [PollFd::new(self.file.as_fd(), PollFlags::POLLIN)];
        match ppoll(&mut descriptors, Some(TimeSpec::from(timeout)), None) {
            Ok(_) | Err(Errno::EINTR) => Ok(()),
            Err(error) => Err(error.into()),
        }
    }

    /// The next line that has arrived, and its end. Line feeds and zeros between lines belong to none.
    pub(crate) fn next_line(&mut self) -> Option<(&[u8], u8)> {
        let between = |byte: &u8| matches!(byte, b'\n' | 0);
        let waiting = &self.received[self.taken..];
        self.taken += waiting.iter().take_while(|it| between(it)).count();
        let waiting = &self.received[self.taken..];
        let Some(length) = waiting.iter().position(|it| matches!(*it, END | BELL)) else {
            let longest = self.taken + LONGEST_LINE;
            self.received.truncate(longest);
            return None;
        };
        let start = self.taken;
        self.taken += length + 1;
        let line = &self.received[start..start + length];
        Some((
            &line[..length.min(LONGEST_LINE)],
            self.received[start + length],
        ))
    }
}

fn connect(address: &str) -> Result<Connection, String> {
    let addresses = address.to_socket_addrs();
    let addresses = addresses.map_err(|error| format!("{address}: {error}"))?;
    let mut reason = "it has no address".to_owned();
    for address in addresses {
        match TcpStream::connect_timeout(&address, CONNECT_TIMEOUT) {
            Ok(stream) => {
                without_waiting(&stream).map_err(|error| error.to_string())?;
                return Ok(Connection::on(stream));
            }
            Err(error) => reason = error.to_string(),
        }
    }
    Err(format!(
        "nothing can be reached at {address}: {reason}; is it running, and is the port right?"
    ))
}

/// Lines are short and answers are waited for: each is sent at once.
pub(crate) fn without_waiting(stream: &TcpStream) -> io::Result<()> {
    stream.set_nodelay(true)?;
    stream.set_nonblocking(true)
}

fn open_terminal(path: &str) -> Result<Connection, String> {
    let mut options = OpenOptions::new();
    options
        .read(true)
        .write(true)
        .custom_flags((OFlag::O_NOCTTY | OFlag::O_NONBLOCK).bits());
    let file = options.open(path).map_err(|error| match error.kind() {
        ErrorKind::NotFound => format!("there is no {path}; is the adapter plugged in?"),
        ErrorKind::PermissionDenied => format!(
            "{path} may not be opened by this user; the group that may is often called dialout"
        ),
        _ => error.to_string(),
    })?;
    make_raw(file.as_fd()).map_err(|error| format!("{path} is no serial port: {error}"))?;
    // What came for whoever had it open before. Where it cannot be dropped, it is no answer to anything.
    let _ = tcflush(file.as_fd(), FlushArg::TCIFLUSH);
    Ok(Connection::on(file))
}

/// Sets a terminal to 115200 baud, 8 data bits, no parity, one stop bit, and to pass on every byte as it is.
pub(crate) fn make_raw(terminal: BorrowedFd<'_>) -> Result<(), Errno> {
    let mut settings = tcgetattr(terminal)?;
    cfmakeraw(&mut settings);
    settings
        .control_flags
        .insert(ControlFlags::CLOCAL | ControlFlags::CREAD);
    settings
        .control_flags
        .remove(ControlFlags::CSTOPB | ControlFlags::CRTSCTS);
    settings.control_chars[SpecialCharacterIndices::VMIN as usize] = 1;
    settings.control_chars[SpecialCharacterIndices::VTIME as usize] = 0;
    cfsetspeed(&mut settings, BaudRate::B115200)?;
    tcsetattr(terminal, SetArg::TCSANOW, &settings)
}

#[cfg(test)]
mod tests {
    use std::os::unix::net::UnixStream;

    use super::*;

    fn lines(chunks: &[&[u8]]) -> Vec<(Vec<u8>, u8)> {
        let (here, mut there) = UnixStream::pair().unwrap();
        here.set_nonblocking(true).unwrap();
        let mut connection = Connection::on(here);
        let mut lines = Vec::new();
        for chunk in chunks {
            there.write_all(chunk).unwrap();
            while connection.fill().unwrap() {
                while let Some((line, end)) = connection.next_line() {
                    lines.push((line.to_vec(), end));
                }
            }
            while let Some((line, end)) = connection.next_line() {
                lines.push((line.to_vec(), end));
            }
        }
        lines
    }

    #[test]
    fn lines_may_come_in_pieces() {
        let came = lines(&[b"t12", b"30\rz\r\x07", b"\r\n\0V10", b"13\r"]);
        let expected: [(&[u8], u8); 5] = [
            (b"t1230", END),
            (b"z", END),
            (b"", BELL),
            (b"", END),
            (b"V1013", END),
        ];
        assert_eq!(came, expected.map(|(line, end)| (line.to_vec(), end)));
    }

    #[test]
    fn a_line_without_end_takes_no_memory() {
        let (here, mut there) = UnixStream::pair().unwrap();
        here.set_nonblocking(true).unwrap();
        let mut connection = Connection::on(here);
        for _ in 0..100 {
            there.write_all(&[b'x'; 4096]).unwrap();
            connection.fill().unwrap();
            assert_eq!(connection.next_line(), None);
            assert!(connection.received.len() <= LONGEST_LINE);
        }
        there.write_all(b"\rO\r").unwrap();
        connection.fill().unwrap();
        assert_eq!(
            connection.next_line().map(|(line, _)| line.len()),
            Some(LONGEST_LINE)
        );
        assert_eq!(connection.next_line(), Some((&b"O"[..], END)));
    }
}
