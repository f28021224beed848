//! Plays byte scripts against a slave: characters in at their instants, the answer out.

use std::time::Duration;

use fieldproof_dictionary::registers::RegisterMap;
use fieldproof_link::{Character, Instant, Line, SerialSettings};
use fieldproof_suite::SourceFile;

use super::{Behaviour, ModbusSlave, Registers, crc};

/// An answer and when it began.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Answer {
    /// The whole frame.
    pub(crate) bytes: Vec<u8>,
    /// From the end of the last character of the request to the start of the answer.
    pub(crate) after: Duration,
}

/// A slave and the clock of its tester.
#[derive(Debug)]
pub(crate) struct Script<R> {
    /// The slave.
    pub(crate) slave: ModbusSlave<R>,
    now: Instant,
}

impl<R: Registers> Script<R> {
    /// The slave that these registers and this behaviour make.
    pub(crate) fn new(registers: R, behaviour: Behaviour) -> Script<R> {
        Script {
            slave: ModbusSlave::new(registers, behaviour, 1),
            now: Instant::START,
        }
    }

    /// How the slave's line is set.
    pub(crate) fn line(&self) -> SerialSettings {
        match self.slave.line() {
            Line::Serial(line) => line,
            other => panic!("not a serial line: {other:?}"),
        }
    }

    /// Sends bytes given in hexadecimal, as they are.
    pub(crate) fn send(&mut self, frame: &str) -> Option<Answer> {
        self.send_bytes(&hex(frame))
    }

    /// Sends bytes given in hexadecimal and their CRC.
    pub(crate) fn ask(&mut self, body: &str) -> Option<Answer> {
        self.send_bytes(&crc::with_crc(hex(body), super::CrcOrder::LowByteFirst))
    }

    /// Sends without gaps, long after what was before; waits until the slave wants nothing more.
    pub(crate) fn send_bytes(&mut self, frame: &[u8]) -> Option<Answer> {
        let characters: Vec<(Duration, Character)> = frame
            .iter()
            .map(|byte| (Duration::ZERO, Character::new(*byte)))
            .collect();
        self.now = self.now + Duration::from_secs(1);
        let answers = self.send_characters(&characters);
        assert!(answers.len() < 2, "two answers to one frame: {answers:?}");
        answers.into_iter().next()
    }

    /// Sends characters, each after a gap; the slave is woken whenever it asks.
    pub(crate) fn send_characters(&mut self, characters: &[(Duration, Character)]) -> Vec<Answer> {
        let mut answers = Vec::new();
        let mut last_end = self.now;
        for (gap, character) in characters {
            let end = last_end + *gap + self.line().character_time();
            self.run_until(end, last_end, &mut answers);
            self.slave.receive(end, *character);
            last_end = end;
        }
        self.run_until(Instant::NEVER, last_end, &mut answers);
        self.now = self.now.max(last_end);
        answers
    }

    fn run_until(&mut self, until: Instant, last_end: Instant, answers: &mut Vec<Answer>) {
        while let Some(at) = self.slave.wake_at().filter(|at| *at < until) {
            self.now = self.now.max(at);
            if let Some(characters) = self.slave.wake(self.now) {
                answers.push(Answer {
                    bytes: characters.iter().map(|character| character.byte).collect(),
                    after: self.now.since(last_end),
                });
            }
        }
    }

    /// Sends a whole frame and expects a whole frame, or silence for an empty one. The answer must keep the silence.
    pub(crate) fn play(&mut self, request: &str, expected: &str) {
        let silence = self.line().silence_3_5();
        let answer = self.send(request);
        if let Some(answer) = &answer {
            assert!(
                answer.after >= silence,
                "{request}: answered after {answer:?}"
            );
        }
        let came = answer.map(|answer| text(&answer.bytes)).unwrap_or_default();
        assert_eq!(came, expected, "answer to {request}");
    }

    /// Asks with a right CRC and expects an answer without its CRC, which must be right, or silence for an empty one.
    pub(crate) fn play_body(&mut self, request: &str, expected: &str) {
        let came = self.ask(request).map(|answer| {
            let (body, right) = crc::split(&answer.bytes).unwrap();
            assert!(right, "CRC of the answer to {request}: {answer:?}");
            text(body)
        });
        assert_eq!(came.unwrap_or_default(), expected, "answer to {request}");
    }
}

/// What the description of a device claims to have.
#[allow(
    clippy::disallowed_methods,
    reason = "a test of the files of the project"
)]
pub(crate) fn register_map(device: &str) -> RegisterMap {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/devices");
    let path = format!("{folder}/{device}/registers.yaml");
    let text = std::fs::read_to_string(&path).unwrap();
    fieldproof_suite::load_registers(&SourceFile { path, text }).unwrap()
}

/// The bytes of a text like `01 03`.
pub(crate) fn hex(text: &str) -> Vec<u8> {
    text.split_whitespace()
        .map(|byte| u8::from_str_radix(byte, 16).unwrap())
        .collect()
}

/// A text like `01 03`.
pub(crate) fn text(bytes: &[u8]) -> String {
    let bytes: Vec<String> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    bytes.join(" ")
}
