//! A serial port of the system.

mod dating;
mod echo;
mod marks;
mod terminal;

use std::io::{ErrorKind, Read, Write};
use std::os::fd::{AsFd, BorrowedFd};
use std::time::Duration;

use nix::poll::{PollFd, PollFlags, ppoll};
use nix::sys::termios::{tcdrain, tcgetattr};
use nix::sys::time::TimeSpec;

use self::dating::Dating;
use self::echo::Echo;
pub use self::echo::LocalEcho;
use self::marks::Marks;
use self::terminal::{Kind, Terminal};
use super::port::{Departure, News, Port, SendError, down};
use super::{Clock, OpenError};
use crate::{
    Character, Instant, Line, LinkError, Parity, PortProperties, Reception, Sent, SerialSettings,
    Transmission,
};

/// As much as the system keeps of what has come.
const READ_SIZE: usize = 4096;

/// How long the system may take no more of a transmission that has begun.
const GIVE_UP: Duration = Duration::from_millis(100);

/// How a serial port is used.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct SerialOptions {
    /// Whether what is sent comes back.
    pub echo: LocalEcho,
    /// How far instants may be off, if that is known better than the port can tell.
    pub uncertainty: Option<Duration>,
}

/// A serial port of the system: a UART, a USB adapter, or a pseudo-terminal with another process behind it.
///
/// The system does not stamp characters, so those that are read together are dated back by the time they took. On a
/// pseudo-terminal they take none, and whatever parity is asked for, there is none.
pub struct Serial {
    terminal: Terminal,
    properties: PortProperties,
    settings: SerialSettings,
    options: SerialOptions,
    marks: Marks,
    dating: Dating,
    echo: Echo,
    /// When all that was given to the system will have left.
    sent: Instant,
}

impl Serial {
    /// Opens the port at `path` for `role`, for this process alone.
    ///
    /// # Errors
    /// [`OpenError`]: it is not there, not a serial port, in use, or cannot be set so.
    pub fn open(
        role: &str,
        path: &str,
        settings: SerialSettings,
        options: SerialOptions,
    ) -> Result<Serial, OpenError> {
        let link = format!("serial:{path}");
        let terminal =
            Terminal::open(path, settings).map_err(|reason| OpenError::new(&link, reason))?;
        let kind = terminal.kind;
        let echo = match (options.echo, kind) {
            // Nothing there echoes by itself, and an answer may come as soon as an echo would.
            (LocalEcho::Auto, Kind::PseudoTerminal) => LocalEcho::No,
            (echo, _) => echo,
        };
        Ok(Serial {
            properties: PortProperties {
                name: role.to_owned(),
                link,
                line: Line::Serial(settings),
                timestamps: kind.timestamps(),
                uncertainty: options.uncertainty.unwrap_or(kind.uncertainty(settings)),
                sets_bit_rate: kind != Kind::PseudoTerminal,
                tells_departure: false,
            },
            marks: Marks::default(),
            dating: Dating::new(kind.character_time(settings)),
            echo: Echo::new(echo),
            sent: Instant::START,
            terminal,
            settings,
            options,
        })
    }

    fn character_time(&self) -> Duration {
        self.terminal.kind.character_time(self.settings)
    }

    /// Sends well-formed characters.
    fn send_bytes(&mut self, clock: &Clock, bytes: &[u8]) -> Result<Sent, SendError> {
        let start = clock.now().max(self.sent);
        self.write(bytes)?;
        let count = u32::try_from(bytes.len()).unwrap_or(u32::MAX);
        let end = match self.terminal.kind {
            Kind::PseudoTerminal => clock.now(),
            Kind::Uart { .. } | Kind::Usb { .. } => {
                start + self.character_time().saturating_mul(count)
            }
        };
        Ok(Sent { start, end })
    }

    /// Sends characters of which some are spoilt: with the other parity. There is a gap wherever that changes.
    fn send_spoilt(&mut self, clock: &Clock, characters: &[Character]) -> Result<Sent, SendError> {
        let right = self.settings.parity;
        let wrong = match right {
            Parity::Even => Parity::Odd,
            Parity::Odd => Parity::Even,
            Parity::None => return Err(self.wrong_kind().into()),
        };
        if self.terminal.kind == Kind::PseudoTerminal {
            return Err(self.wrong_kind().into());
        }
        self.drain()?;
        let start = clock.now();
        for run in characters.chunk_by(|one, next| one.spoilt == next.spoilt) {
            let is_spoilt = run.iter().any(|character| character.spoilt);
            self.set_parity(if is_spoilt { wrong } else { right })?;
            let bytes: Vec<u8> = run.iter().map(|character| character.byte).collect();
            let sent = self.write(&bytes).and_then(|()| Ok(self.drain()?));
            if sent.is_err() {
                // Whatever went wrong with the transmission is what matters.
                let _ = self.set_parity(right);
            }
            sent?;
        }
        self.set_parity(right)?;
        let end = clock.now();
        Ok(Sent { start, end })
    }

    fn set_parity(&mut self, parity: Parity) -> Result<(), LinkError> {
        let set = self.terminal.set_parity(parity);
        set.map_err(|reason| down(&self.properties, reason))
    }

    /// Waits until all has left.
    fn drain(&self) -> Result<(), LinkError> {
        tcdrain(&self.terminal.file).map_err(|error| down(&self.properties, error))
    }

    /// Gives all of `bytes` to the system, or nothing and [`SendError::Busy`].
    fn write(&mut self, bytes: &[u8]) -> Result<(), SendError> {
        let mut left = bytes;
        while !left.is_empty() {
            match self.terminal.file.write(left) {
                Ok(count) => left = left.get(count..).unwrap_or_default(),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.kind() != ErrorKind::WouldBlock => {
                    return Err(down(&self.properties, error).into());
                }
                Err(_) if left.len() == bytes.len() => return Err(SendError::Busy),
                Err(_) => self.wait_for_room()?,
            }
        }
        Ok(())
    }

    fn wait_for_room(&self) -> Result<(), LinkError> {
        let mut port = [PollFd::new(self.readable(), PollFlags::POLLOUT)];
        match ppoll(&mut port, Some(TimeSpec::from(GIVE_UP)), None) {
            Ok(0) => Err(down(&self.properties, "it takes no more characters")),
            Ok(_) => Ok(()),
            Err(error) => Err(down(&self.properties, error)),
        }
    }

    /// Reads what has come; what is no echo waits in [`Echo::heard`].
    fn read(&mut self, clock: &Clock) -> Result<(), LinkError> {
        let mut bytes = [0; READ_SIZE];
        let count = match self.terminal.file.read(&mut bytes) {
            Ok(0) => return Err(self.hung_up()),
            Ok(count) => count,
            Err(error) => {
                return match error.kind() {
                    ErrorKind::WouldBlock | ErrorKind::Interrupted => Ok(()),
                    _ => Err(down(&self.properties, error)),
                };
            }
        };
        let now = clock.now();
        let characters: Vec<Character> = match self.terminal.kind {
            Kind::PseudoTerminal => bytes[..count].iter().copied().map(Character::new).collect(),
            Kind::Uart { .. } | Kind::Usb { .. } => {
                let marks = &mut self.marks;
                bytes[..count]
                    .iter()
                    .filter_map(|&it| marks.take(it))
                    .collect()
            }
        };
        let ends = self.dating.ends(now, characters.len());
        for dated in ends.zip(characters) {
            let heard = self.echo.came(now, dated);
            heard.map_err(|error| down(&self.properties, error))?;
        }
        Ok(())
    }

    /// Reading says that it ended; why, anything else that is asked of it says.
    fn hung_up(&self) -> LinkError {
        let gone = match self.terminal.kind {
            Kind::Uart { .. } => "the port is gone",
            Kind::Usb { .. } => "the adapter is gone",
            Kind::PseudoTerminal => "the other side of the pseudo-terminal has closed",
        };
        match tcgetattr(&self.terminal.file) {
            Ok(_) => down(&self.properties, gone),
            Err(error) => down(&self.properties, format!("{gone} ({error})")),
        }
    }

    fn wrong_kind(&self) -> LinkError {
        let port = self.properties.name.clone();
        LinkError::WrongKind { port }
    }
}

impl Port for Serial {
    fn properties(&self) -> &PortProperties {
        &self.properties
    }

    fn readable(&self) -> BorrowedFd<'_> {
        self.terminal.file.as_fd()
    }

    fn send(&mut self, clock: &mut Clock, what: &Transmission) -> Result<Departure, SendError> {
        let Transmission::Characters(characters) = what else {
            return Err(self.wrong_kind().into());
        };
        let sent = if characters.iter().any(|character| character.spoilt) {
            self.send_spoilt(clock, characters)?
        } else {
            let bytes: Vec<u8> = characters.iter().map(|it| it.byte).collect();
            self.send_bytes(clock, &bytes)?
        };
        self.sent = sent.end;
        self.dating.sent(sent.end);
        // By then an echo is back; the answer begins 3.5 characters after the request and is not shorter than that.
        let count = u32::try_from(characters.len()).unwrap_or(u32::MAX);
        let answer = self.settings.silence_3_5() + self.character_time().saturating_mul(count);
        let back_by = sent.end + answer.max(self.properties.uncertainty);
        self.echo.sent(characters.iter().map(|it| it.byte), back_by);
        Ok(Departure::At(sent))
    }

    fn take(&mut self, clock: &mut Clock, news: &mut Vec<News>) -> Result<(), LinkError> {
        let taken = self.read(clock).and_then(|()| {
            let passed = self.echo.pass(clock.now());
            passed.map_err(|error| down(&self.properties, error))
        });
        let heard = self.echo.heard.drain(..);
        news.extend(heard.map(|(at, character)| News::Arrived {
            at,
            what: Reception::Character(character),
        }));
        taken
    }

    fn set_line(&mut self, line: Line) -> Result<(), LinkError> {
        let Line::Serial(settings) = line else {
            return Err(self.wrong_kind());
        };
        if self.terminal.kind == Kind::PseudoTerminal {
            return Err(down(&self.properties, "a pseudo-terminal has no bit rate"));
        }
        let set = self.terminal.set(settings);
        set.map_err(|reason| down(&self.properties, reason))?;
        self.settings = settings;
        self.dating.set_character_time(self.character_time());
        let by_itself = self.terminal.kind.uncertainty(settings);
        self.properties.uncertainty = self.options.uncertainty.unwrap_or(by_itself);
        self.properties.line = line;
        Ok(())
    }
}
