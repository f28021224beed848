//! How an adapter is found, reset and set.

use std::collections::VecDeque;
use std::path::Path;
use std::time::{Duration, Instant as SystemInstant};

use super::adapter_clock::AdapterClock;
use super::connection::Connection;
use super::{
    Answer, BitRateCode, Command, Kind, PACED_BUS, STATUS_PERIOD, Slcan, Stamps, UNPACED_BUS,
};
use crate::real::OpenError;
use crate::signal::bits_in_nanos;
use crate::{Instant, Line, PortProperties};

/// How long an adapter may take to answer. USB to serial converters collect bytes for 16 ms.
const ANSWER: Duration = Duration::from_millis(400);

/// How often an adapter that does not answer is tried: some start anew when their port is opened.
const ATTEMPTS: usize = 3;

/// The bits of the longest frame, with as many stuff bits as there can be.
const LONGEST_FRAME_BITS: u64 = 160;

pub(super) fn open(
    role: &str,
    target: &str,
    bit_rate: u32,
    uncertainty: Option<Duration>,
) -> Result<Slcan, OpenError> {
    let link = format!("slcan:{target}");
    let wrong = |reason: String| OpenError::new(&link, reason);
    let connection = Connection::open(target).map_err(wrong)?;
    let mut slcan = Slcan {
        connection,
        properties: PortProperties {
            name: role.to_owned(),
            link: link.clone(),
            line: Line::Can { bit_rate },
            timestamps: "user space",
            uncertainty: Duration::ZERO,
            sets_bit_rate: true,
            tells_departure: true,
        },
        clock: AdapterClock::default(),
        asked: VecDeque::new(),
        held: VecDeque::new(),
        last: Instant::START,
        kind: Kind {
            acknowledges: true,
            has_bit_times: true,
        },
        status: None,
    };
    slcan.find_adapter().map_err(wrong)?;
    let stamps = slcan.switch_stamps_on().map_err(wrong)?;
    let is_own_bus = slcan.is_own_bus().map_err(wrong)?;
    slcan.set_bit_rate(bit_rate).map_err(wrong)?;
    if slcan.kind.acknowledges
        && let Some(Answer::Status(_)) = slcan.ask(&Command::Status).map_err(wrong)?
    {
        slcan.status = Some((0, Instant::START + STATUS_PERIOD));
    }
    slcan.properties.tells_departure = slcan.kind.acknowledges;
    if stamps != Stamps::None {
        slcan.properties.timestamps = "adapter";
    }
    slcan.properties.uncertainty = uncertainty.unwrap_or(match is_own_bus {
        true => Duration::from_micros(200),
        false => usual_uncertainty(target, bit_rate),
    });
    Ok(slcan)
}

/// USB hands over once a millisecond; and most acknowledge a frame when it has yet to leave.
fn usual_uncertainty(target: &str, bit_rate: u32) -> Duration {
    let frame = Duration::from_nanos(bits_in_nanos(LONGEST_FRAME_BITS, bit_rate));
    Duration::from_millis(1).max(latency_timer(target)) + frame
}

/// How long a converter from USB to serial collects bytes, where the system knows that.
fn latency_timer(target: &str) -> Duration {
    let path = std::fs::canonicalize(target).unwrap_or_default();
    let name = path.file_name().unwrap_or_default();
    let file = Path::new("/sys/class/tty")
        .join(name)
        .join("device/latency_timer");
    let text = std::fs::read_to_string(file).unwrap_or_default();
    Duration::from_millis(text.trim().parse().unwrap_or(0))
}

impl Slcan {
    /// Closes the channel, which may still be open, and sees whether somebody answers.
    fn find_adapter(&mut self) -> Result<(), String> {
        for _ in 0..ATTEMPTS {
            let tells_version = self.synchronize()?;
            self.kind.acknowledges = matches!(
                self.ask(&Command::Close)?,
                Some(Answer::Done | Answer::Refused(_))
            );
            if self.kind.acknowledges || tells_version {
                return Ok(());
            }
        }
        Err(
            "nothing there answers as an SLCAN adapter does; is it the right port, does the adapter \
             have SLCAN firmware, and does no other program use it?"
                .to_owned(),
        )
    }

    /// Drops everything that comes until the version does, which is asked for last; whether it came.
    fn synchronize(&mut self) -> Result<bool, String> {
        // Whatever was begun before is ended, and refused.
        for command in [
            Command::Nothing,
            Command::Nothing,
            Command::Close,
            Command::Version,
        ] {
            command.write(self.connection.outbox());
        }
        self.connection.flush().map_err(|error| error.to_string())?;
        let give_up = SystemInstant::now() + ANSWER;
        loop {
            while let Some((line, end)) = self.connection.next_line() {
                if matches!(Answer::read(line, end), Answer::Text(_)) {
                    return Ok(true);
                }
            }
            if !self.wait(give_up)? {
                return Ok(false);
            }
        }
    }

    /// Waits for more to read; whether there is still time.
    fn wait(&mut self, give_up: SystemInstant) -> Result<bool, String> {
        let left = give_up.saturating_duration_since(SystemInstant::now());
        let waited = self.connection.wait(left);
        waited.map_err(|error| error.to_string())?;
        let filled = self.connection.fill();
        filled.map_err(|error| self.down(&error).to_string())?;
        Ok(!left.is_zero())
    }

    /// Sends `command` and waits for the answer to it; `None` if none comes. What comes before it is kept.
    pub(super) fn ask(&mut self, command: &Command) -> Result<Option<Answer>, String> {
        let mut due_before = self.asked.len();
        command.write(self.connection.outbox());
        self.connection.flush().map_err(|error| error.to_string())?;
        let give_up = SystemInstant::now() + ANSWER;
        loop {
            while let Some((line, end)) = self.connection.next_line() {
                let answer = Answer::read(line, end);
                match answer {
                    Answer::Other(_) => {}
                    Answer::Received { .. } => self.held.push_back(answer),
                    _ if due_before > 0 => {
                        due_before -= 1;
                        self.held.push_back(answer);
                    }
                    _ => return Ok(Some(answer)),
                }
            }
            if !self.wait(give_up)? {
                return Ok(None);
            }
        }
    }

    /// The finest that the adapter has.
    fn switch_stamps_on(&mut self) -> Result<Stamps, String> {
        if !self.kind.acknowledges {
            return Ok(Stamps::None);
        }
        for stamps in [Stamps::Microseconds, Stamps::Milliseconds] {
            if self.ask(&Command::Stamps(stamps))? == Some(Answer::Done) {
                return Ok(stamps);
            }
        }
        Ok(Stamps::None)
    }

    /// Whether this is our own bus without adapters.
    fn is_own_bus(&mut self) -> Result<bool, String> {
        if !self.kind.acknowledges {
            return Ok(false);
        }
        Ok(match self.ask(&Command::SerialNumber)? {
            Some(Answer::Text(text)) if text == UNPACED_BUS => {
                self.kind.has_bit_times = false;
                true
            }
            Some(Answer::Text(text)) => text == PACED_BUS,
            _ => false,
        })
    }

    /// Takes the adapter off the bus, and onto it again with another bit rate.
    pub(super) fn set_bit_rate(&mut self, bit_rate: u32) -> Result<(), String> {
        let code = BitRateCode::of(bit_rate).ok_or_else(|| {
            format!(
                "SLCAN adapters know no bit rate of {bit_rate} bit/s, but \
                 10, 20, 50, 100, 125, 250, 500, 800 and 1000 kbit/s"
            )
        })?;
        // It is refused where the channel was not open.
        self.ask_if_acknowledged(&Command::Close)?;
        let set = self.ask_if_acknowledged(&Command::BitRate(code))?;
        if set != Answer::Done {
            return Err(format!(
                "the adapter refused the bit rate of {bit_rate} bit/s"
            ));
        }
        match self.ask_if_acknowledged(&Command::Open)? {
            Answer::Done => Ok(()),
            _ => Err("the adapter refused to open its channel".to_owned()),
        }
    }

    /// An adapter that acknowledges nothing does as it is told.
    fn ask_if_acknowledged(&mut self, command: &Command) -> Result<Answer, String> {
        if self.kind.acknowledges {
            let answer = self.ask(command)?;
            return answer.ok_or_else(|| "the adapter does not answer any more".to_owned());
        }
        command.write(self.connection.outbox());
        let flushed = self.connection.flush();
        flushed.map_err(|error| error.to_string())?;
        Ok(Answer::Done)
    }
}
