//! Stimuli on real links: by an operator's hand, or by a command of the bench's.

use std::io::{self, BufRead, Write};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use fieldproof_link::real::Stimuli;
use fieldproof_link::{Stimulus, StimulusError, StimulusKind};

use crate::stimulus_words::{request, words};

/// The one that all lanes ask, in turn.
#[derive(Clone)]
pub struct Operator(Option<Arc<Terminal>>);

/// A person at the terminal.
struct Terminal {
    timeout: Duration,
    attention: Mutex<Attention>,
}

/// Whom the operator is listening to.
#[derive(Default)]
struct Attention {
    /// The lane that is being served.
    busy_with: Option<String>,
    /// Lines from the terminal, once somebody has asked.
    lines: Option<Receiver<()>>,
}

impl Operator {
    /// There is nobody.
    pub fn none() -> Operator {
        Operator(None)
    }

    /// Somebody at the terminal, who may take `timeout` over each stimulus.
    pub fn at_the_terminal(timeout: Duration) -> Operator {
        Operator(Some(Arc::new(Terminal {
            timeout,
            attention: Mutex::default(),
        })))
    }

    /// Whether there is nobody.
    pub(crate) fn is_none(&self) -> bool {
        self.0.is_none()
    }
}

impl std::fmt::Debug for Operator {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(if self.is_none() {
            "none"
        } else {
            "at the terminal"
        })
    }
}

/// The stimuli of a lane that an operator gives.
pub(crate) struct ByHand {
    device: String,
    offers: Vec<StimulusKind>,
    terminal: Arc<Terminal>,
    wanted: Option<(String, Instant)>,
}

impl ByHand {
    /// `None` if there is no operator.
    pub(crate) fn new(
        operator: &Operator,
        device: &str,
        offers: Vec<StimulusKind>,
    ) -> Option<ByHand> {
        Some(ByHand {
            device: device.to_owned(),
            offers,
            terminal: Arc::clone(operator.0.as_ref()?),
            wanted: None,
        })
    }

    fn failed(&mut self, reason: String) -> Result<bool, StimulusError> {
        self.finish();
        Err(StimulusError::Failed(reason))
    }

    fn finish(&mut self) {
        self.wanted = None;
        self.terminal.attention().busy_with = None;
    }
}

impl Terminal {
    fn attention(&self) -> MutexGuard<'_, Attention> {
        self.attention
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes the operator's attention, if nobody has it, and says what is wanted.
    fn turn_to(&self, device: &str, wanted: &str) -> bool {
        let mut attention = self.attention();
        match &attention.busy_with {
            Some(busy_with) => busy_with == device,
            None => {
                let lines = attention.lines.get_or_insert_with(terminal_lines);
                // What was typed before the question is no answer to it.
                while lines.try_recv().is_ok() {}
                attention.busy_with = Some(device.to_owned());
                let seconds = self.timeout.as_secs();
                let _ = writeln!(
                    io::stderr(),
                    "{device}: please {wanted}, then press Enter (within {seconds} s)"
                );
                true
            }
        }
    }
}

impl Stimuli for ByHand {
    fn offers(&self) -> Vec<StimulusKind> {
        self.offers.clone()
    }

    fn begin(&mut self, stimulus: &Stimulus) -> Result<(), StimulusError> {
        if !self.offers.contains(&stimulus.kind()) {
            return Err(StimulusError::NotOffered);
        }
        self.wanted = Some((request(stimulus), Instant::now()));
        Ok(())
    }

    fn is_done(&mut self) -> Result<bool, StimulusError> {
        let Some((wanted, since)) = self.wanted.clone() else {
            return Ok(true);
        };
        if !self.terminal.turn_to(&self.device, &wanted) {
            // The time of one who waits for the operator does not run.
            self.wanted = Some((wanted, Instant::now()));
            return Ok(false);
        }
        let answer = match &self.terminal.attention().lines {
            Some(lines) => lines.try_recv(),
            None => Err(TryRecvError::Disconnected),
        };
        match answer {
            Ok(()) => {
                self.finish();
                Ok(true)
            }
            Err(TryRecvError::Disconnected) => {
                self.failed("there is no operator: standard input is closed".to_owned())
            }
            Err(TryRecvError::Empty) if since.elapsed() > self.terminal.timeout => {
                let seconds = self.terminal.timeout.as_secs();
                self.failed(format!("nobody did it within {seconds} s"))
            }
            Err(TryRecvError::Empty) => Ok(false),
        }
    }
}

/// One message for each line on standard input.
fn terminal_lines() -> Receiver<()> {
    let (sender, lines) = mpsc::channel();
    std::thread::spawn(move || {
        for line in io::stdin().lock().lines() {
            if line.is_err() || sender.send(()).is_err() {
                return;
            }
        }
    });
    lines
}

/// The stimuli of a lane that a command of the bench's gives.
pub(crate) struct ByCommand {
    command: Vec<String>,
    offers: Vec<StimulusKind>,
    timeout: Duration,
    running: Option<(Child, Instant)>,
}

/// How long a command may take over a stimulus.
const COMMAND_TIMEOUT: Duration = Duration::from_secs(60);

impl ByCommand {
    pub(crate) fn new(command: Vec<String>, offers: Vec<StimulusKind>) -> ByCommand {
        ByCommand {
            command,
            offers,
            timeout: COMMAND_TIMEOUT,
            running: None,
        }
    }
}

impl Stimuli for ByCommand {
    fn offers(&self) -> Vec<StimulusKind> {
        self.offers.clone()
    }

    fn begin(&mut self, stimulus: &Stimulus) -> Result<(), StimulusError> {
        if !self.offers.contains(&stimulus.kind()) {
            return Err(StimulusError::NotOffered);
        }
        let [program, arguments @ ..] = self.command.as_slice() else {
            return Err(StimulusError::NotOffered);
        };
        let child = Command::new(program)
            .args(arguments)
            .args(words(stimulus))
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .spawn()
            .map_err(|error| StimulusError::Failed(format!("{program}: {error}")))?;
        self.running = Some((child, Instant::now()));
        Ok(())
    }

    fn is_done(&mut self) -> Result<bool, StimulusError> {
        let Some((child, since)) = &mut self.running else {
            return Ok(true);
        };
        let failed = |reason: String| Err(StimulusError::Failed(reason));
        match child.try_wait() {
            Ok(None) if since.elapsed() > self.timeout => {
                let _ = child.kill();
                let _ = child.wait();
                self.running = None;
                let seconds = self.timeout.as_secs();
                failed(format!("the command did not end within {seconds} s"))
            }
            Ok(None) => Ok(false),
            Ok(Some(status)) => {
                self.running = None;
                match status.success() {
                    true => Ok(true),
                    false => failed(format!("the command ended with {status}")),
                }
            }
            Err(error) => failed(error.to_string()),
        }
    }
}
