//! What the system knows of a serial port, and how it is set.

use std::fs::{self, File, OpenOptions};
use std::os::fd::AsRawFd;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::Path;
use std::time::Duration;

use nix::fcntl::OFlag;
use nix::sys::stat::major;
use nix::sys::termios::{InputFlags, SetArg, tcgetattr, tcsetattr};
use nix::unistd::isatty;
use serialport::{ClearBuffer, DataBits, FlowControl, SerialPort, TTYPort};

use crate::{Parity, SerialSettings, StopBits};

/// How late a process may be told what has come, on a machine that does other things too.
const SCHEDULING: Duration = Duration::from_millis(1);

/// How long a USB adapter may keep characters that does not say how long.
const USB_ADAPTER: Duration = Duration::from_millis(4);

/// How many characters of silence a port waits for before it hands over fewer than it would like to hand over at once.
const FIFO_TIMEOUT_CHARACTERS: u32 = 4;

/// How far a baud rate may be off, in percent.
const BAUD_TOLERANCE_PERCENT: u64 = 2;

/// What is behind a port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A port of the machine, which may collect characters before it hands them over.
    Uart {
        /// Whether it does.
        has_fifo: bool,
    },
    /// A USB adapter, which keeps characters for so long at most.
    Usb {
        /// How long.
        latency: Duration,
    },
    /// Another process: characters without bits, and without time of their own.
    PseudoTerminal,
}

impl Kind {
    /// Of the open `file`, by the device's number and by `sys`, where the system tells of its devices.
    pub(super) fn of(file: &File, path: &Path, sys: &Path) -> Kind {
        // Numbers that never change: 136 to 143 are the far ends of pseudo-terminals.
        if file
            .metadata()
            .is_ok_and(|it| (136..=143).contains(&major(it.rdev())))
        {
            return Kind::PseudoTerminal;
        }
        // The name may be a link that says which adapter is meant, not which place it got.
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let terminal = sys
            .join("class/tty")
            .join(path.file_name().unwrap_or_default());
        let device = terminal.join("device");
        let is_usb = fs::read_link(device.join("subsystem"))
            .ok()
            .and_then(|bus| Some(bus.file_name()?.to_string_lossy().starts_with("usb")));
        if is_usb == Some(true) {
            let latency_ms = read_number(&device.join("latency_timer"))
                .or_else(|| read_number(&device.join("../latency_timer")));
            let latency = latency_ms.map_or(USB_ADAPTER, Duration::from_millis);
            return Kind::Usb { latency };
        }
        let hands_over_at = read_number(&terminal.join("rx_trig_bytes"));
        Kind::Uart {
            has_fifo: hands_over_at != Some(1),
        }
    }

    /// Where instants come from.
    pub(super) fn timestamps(self) -> &'static str {
        match self {
            Kind::Uart { .. } => "user space",
            Kind::Usb { .. } => "user space (USB adapter)",
            Kind::PseudoTerminal => "user space (pseudo-terminal)",
        }
    }

    /// How long a character is on the line.
    pub(super) fn character_time(self, settings: SerialSettings) -> Duration {
        match self {
            Kind::Uart { .. } | Kind::Usb { .. } => settings.character_time(),
            Kind::PseudoTerminal => Duration::ZERO,
        }
    }

    /// How far the instant of a character may be off.
    pub(super) fn uncertainty(self, settings: SerialSettings) -> Duration {
        let character = self.character_time(settings);
        let kept = match self {
            Kind::Uart { has_fifo: false } | Kind::PseudoTerminal => Duration::ZERO,
            Kind::Uart { has_fifo: true } => character * FIFO_TIMEOUT_CHARACTERS,
            Kind::Usb { latency } => latency,
        };
        character + kept + SCHEDULING
    }
}

fn read_number(path: &Path) -> Option<u64> {
    fs::read_to_string(path).ok()?.trim().parse().ok()
}

/// A port, twice: to read and write without waiting, and to set.
pub(super) struct Terminal {
    pub(super) file: File,
    pub(super) kind: Kind,
    tty: TTYPort,
}

impl Terminal {
    /// Opens the port at `path` for this process alone.
    pub(super) fn open(path: &str, settings: SerialSettings) -> Result<Terminal, String> {
        if settings.baud == 0 {
            return Err("a baud rate of 0 is none".to_owned());
        }
        let flags = OFlag::O_NONBLOCK | OFlag::O_NOCTTY;
        // In this order: opened for us alone, it could not be opened once more.
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .custom_flags(flags.bits())
            .open(path)
            .map_err(|error| error.to_string())?;
        if !isatty(file.as_raw_fd()).unwrap_or(false) {
            return Err("it is not a serial port".to_owned());
        }
        let tty = serialport::new(path, settings.baud)
            .data_bits(DataBits::Eight)
            .parity(parity(settings.parity))
            .stop_bits(stop_bits(settings.stop_bits))
            .flow_control(FlowControl::None)
            .open_native()
            .map_err(|error| error.to_string())?;
        let kind = Kind::of(&file, Path::new(path), Path::new("/sys"));
        let mut terminal = Terminal { file, kind, tty };
        terminal.set(settings)?;
        // What somebody sent before is nothing of ours.
        let cleared = terminal.tty.clear(ClearBuffer::Input);
        cleared.map_err(|error| error.to_string())?;
        Ok(terminal)
    }

    /// Sets it otherwise. A pseudo-terminal has nothing to set, and on some systems refuses a parity.
    pub(super) fn set(&mut self, settings: SerialSettings) -> Result<(), String> {
        if self.kind == Kind::PseudoTerminal {
            return Ok(());
        }
        self.try_to_set(settings)
            .map_err(|error| error.to_string())?;
        let baud = self.tty.baud_rate().map_err(|error| error.to_string())?;
        let difference = u64::from(baud.abs_diff(settings.baud));
        if difference * 100 > u64::from(settings.baud) * BAUD_TOLERANCE_PERCENT {
            return Err(format!("it cannot do {} baud, but {baud}", settings.baud));
        }
        if self.tty.parity().ok() != Some(parity(settings.parity)) {
            return Err("it cannot do this parity".to_owned());
        }
        self.mark_errors().map_err(|error| error.to_string())
    }

    fn try_to_set(&mut self, settings: SerialSettings) -> serialport::Result<()> {
        self.tty.set_baud_rate(settings.baud)?;
        self.tty.set_parity(parity(settings.parity))?;
        self.tty.set_stop_bits(stop_bits(settings.stop_bits))
    }

    /// Sets the parity alone, while nothing is being sent.
    pub(super) fn set_parity(&mut self, to: Parity) -> Result<(), String> {
        let set = self.tty.set_parity(parity(to));
        set.map_err(|error| error.to_string())?;
        self.mark_errors().map_err(|error| error.to_string())
    }

    /// Has characters with a wrong parity or stop bit marked, which setting the parity undoes.
    fn mark_errors(&self) -> nix::Result<()> {
        let mut attributes = tcgetattr(&self.file)?;
        let flags = &mut attributes.input_flags;
        flags.insert(InputFlags::INPCK | InputFlags::PARMRK);
        flags.remove(InputFlags::IGNPAR | InputFlags::ISTRIP | InputFlags::IGNBRK);
        tcsetattr(&self.file, SetArg::TCSANOW, &attributes)
    }
}

fn parity(parity: Parity) -> serialport::Parity {
    match parity {
        Parity::None => serialport::Parity::None,
        Parity::Even => serialport::Parity::Even,
        Parity::Odd => serialport::Parity::Odd,
    }
}

fn stop_bits(stop_bits: StopBits) -> serialport::StopBits {
    match stop_bits {
        StopBits::One => serialport::StopBits::One,
        StopBits::Two => serialport::StopBits::Two,
    }
}

#[cfg(test)]
mod tests {
    use std::os::unix::fs::symlink;

    use super::*;

    const SETTINGS: SerialSettings = SerialSettings {
        baud: 10_000,
        parity: Parity::None,
        stop_bits: StopBits::One,
    };

    /// What a port called `tty` is, whose device and bus the system tells so.
    fn kind(bus: Option<&str>, facts: &[(&str, &str)]) -> Kind {
        let sys = tempfile::tempdir().unwrap();
        let terminal = sys.path().join("class/tty/tty");
        fs::create_dir_all(terminal.join("device")).unwrap();
        if let Some(bus) = bus {
            symlink(
                format!("../../../../bus/{bus}"),
                terminal.join("device/subsystem"),
            )
            .unwrap();
        }
        for (name, value) in facts {
            fs::write(terminal.join(name), value).unwrap();
        }
        let port = sys.path().join("tty");
        let file = File::create(&port).unwrap();
        Kind::of(&file, &port, sys.path())
    }

    #[test]
    fn an_adapter_with_a_latency_timer_says_how_long_it_keeps_characters() {
        let kind = kind(Some("usb-serial"), &[("device/latency_timer", "16\n")]);
        let latency = Duration::from_millis(16);
        assert_eq!(kind, Kind::Usb { latency });
        assert_eq!(kind.timestamps(), "user space (USB adapter)");
        // 16 ms in the adapter, a character of 1 ms, 1 ms in this machine.
        assert_eq!(kind.uncertainty(SETTINGS), Duration::from_millis(18));
    }

    #[test]
    fn an_adapter_without_one_is_not_trusted_with_less_than_a_few_milliseconds() {
        let kind = kind(Some("usb"), &[]);
        assert_eq!(kind.uncertainty(SETTINGS), Duration::from_millis(4 + 1 + 1));
    }

    #[test]
    fn a_port_of_the_machine_waits_for_silence_before_it_hands_over_a_few_characters() {
        for bus in [Some("serial-base"), None] {
            let kind = kind(bus, &[("rx_trig_bytes", "8")]);
            assert_eq!(kind, Kind::Uart { has_fifo: true });
            assert_eq!(kind.uncertainty(SETTINGS), Duration::from_millis(4 + 1 + 1));
        }
    }

    #[test]
    fn a_port_of_the_machine_that_hands_over_every_character_does_not() {
        let kind = kind(None, &[("rx_trig_bytes", "1")]);
        assert_eq!(kind, Kind::Uart { has_fifo: false });
        assert_eq!(kind.uncertainty(SETTINGS), Duration::from_millis(1 + 1));
    }
}
