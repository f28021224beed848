//! Frame scripts: what is done to a device and what it sends, as text.
//!
//! | line | means |
//! | --- | --- |
//! | `> 601#4063600000000000` | a frame to port 0; `#R`, `#R1` for a remote frame, eight digits for a 29-bit identifier |
//! | `< 581#4363600013D1FFFF` | a frame from port 0 |
//! | `>> 20 03 00 00 00 01 82 BB` | characters to port 1, without gaps |
//! | `<< 20 03 02 0F B4 01 C4` | characters from port 1; with a companion there, `>>` is what that answers |
//! | `wait 10 ms` | time passes; 1 ms passes after a frame, 100 ms after characters |
//! | `power off`, `power on` | a stimulus |
//! | `set 6063:00 = -12013` | a process value |
//! | `begin hardware-fault`, `end hardware-fault` | a condition |
//! | `switch node = 2` | a setting |

use std::fmt::Write;
use std::time::Duration;

use fieldproof_can::{Frame, Id};
use fieldproof_link::{
    Character, Instant, Line, Outbox, Participant, Reception, Stimulus, Transmission,
};

use crate::{DeviceKind, Settings};

/// A device and the time.
pub(crate) struct Script {
    pub(crate) device: Box<dyn Participant>,
    pub(crate) now: Instant,
    companion: Option<Box<dyn Participant>>,
    told: String,
    /// When each frame of port 0 left, and which.
    pub(crate) sent: Vec<(Instant, Frame)>,
}

impl Script {
    /// A device of `kind` as it is, a millisecond after power-on.
    pub(crate) fn new(kind: &DeviceKind, settings: &Settings) -> Script {
        Script::of((kind.build)(settings).unwrap())
    }

    pub(crate) fn of(device: Box<dyn Participant>) -> Script {
        Script {
            device,
            now: Instant::START,
            companion: None,
            told: String::new(),
            sent: Vec::new(),
        }
    }

    /// Joins port 0 of `companion` to port 1 of the device.
    pub(crate) fn with(mut self, companion: Box<dyn Participant>) -> Script {
        self.companion = Some(companion);
        self
    }

    /// Does what `text` says, and tells what happened in the same form.
    pub(crate) fn play(&mut self, text: &str) -> String {
        for line in lines(text) {
            let told =
                line.starts_with('<') || (self.companion.is_some() && line.starts_with(">>"));
            if !told {
                writeln!(self.told, "{line}").unwrap();
                self.act(line);
            }
        }
        std::mem::take(&mut self.told)
    }

    fn act(&mut self, line: &str) {
        let mut out = Outbox::default();
        let (verb, rest) = line.split_once(' ').unwrap();
        let mut stimulate = |stimulus| {
            self.device
                .stimulate(self.now, &stimulus, &mut out)
                .unwrap();
        };
        let named = || rest.split_once(" = ").unwrap();
        match verb {
            ">" => self
                .device
                .receive(self.now, 0, Reception::Frame(frame(rest)), &mut out),
            ">>" => return self.characters(rest),
            "wait" => {
                let milliseconds = rest.strip_suffix(" ms").unwrap().parse().unwrap();
                return self.pass(Duration::from_millis(milliseconds));
            }
            "power" => stimulate(Stimulus::Power { on: rest == "on" }),
            "set" => stimulate(Stimulus::ProcessValue {
                name: named().0.to_owned(),
                value: named().1.parse().unwrap(),
            }),
            "switch" => stimulate(Stimulus::Setting {
                name: named().0.to_owned(),
                value: named().1.parse().unwrap(),
            }),
            "begin" | "end" => stimulate(Stimulus::Condition {
                name: rest.to_owned(),
                active: verb == "begin",
            }),
            _ => panic!("no verb: {line}"),
        }
        self.tell(&mut out);
        if verb == ">" {
            self.pass(Duration::from_millis(1));
        }
    }

    fn characters(&mut self, text: &str) {
        let byte = |digits| u8::from_str_radix(digits, 16).unwrap();
        let bytes: Vec<u8> = text.split(' ').map(byte).collect();
        let Line::Serial(line) = self.device.line(1) else {
            return;
        };
        let time = Duration::from_secs(1) * line.bits_per_character() / line.baud;
        for byte in bytes {
            self.pass(time);
            let mut out = Outbox::default();
            let character = Reception::Character(Character::new(byte));
            self.device.receive(self.now, 1, character, &mut out);
            self.tell(&mut out);
        }
        self.pass(Duration::from_millis(100));
    }

    /// Lets `time` pass.
    pub(crate) fn pass(&mut self, time: Duration) {
        let until = self.now + time;
        loop {
            let device = self.device.wake_at().map(|at| (at, false));
            let companion = self
                .companion
                .as_ref()
                .and_then(|companion| companion.wake_at());
            let next = device
                .into_iter()
                .chain(companion.map(|at| (at, true)))
                .min();
            let Some((at, companion)) = next.filter(|(at, _)| *at <= until) else {
                break;
            };
            self.now = self.now.max(at);
            let mut out = Outbox::default();
            if companion {
                self.companion.as_mut().unwrap().wake(self.now, &mut out);
                self.relay(&mut out);
            } else {
                self.device.wake(self.now, &mut out);
                self.tell(&mut out);
            }
        }
        self.now = until;
    }

    fn tell(&mut self, out: &mut Outbox) {
        for (port, transmission) in out.drain().collect::<Vec<_>>() {
            match transmission {
                Transmission::Frame(frame) => {
                    assert_eq!(port, 0);
                    self.sent.push((self.now, frame));
                    writeln!(self.told, "< {}", text(&frame)).unwrap();
                }
                Transmission::Characters(characters) => {
                    assert_eq!(port, 1);
                    let mut bytes = String::new();
                    for character in &characters {
                        write!(bytes, " {:02X}", character.byte).unwrap();
                    }
                    writeln!(self.told, "<<{bytes}").unwrap();
                    if let Some(companion) = &mut self.companion {
                        let out = &mut Outbox::default();
                        deliver(companion.as_mut(), 0, self.now, &characters, out);
                    }
                }
                Transmission::Close => writeln!(self.told, "<< end").unwrap(),
            }
        }
    }

    /// What the companion sends goes to port 1.
    fn relay(&mut self, out: &mut Outbox) {
        for (_, transmission) in out.drain().collect::<Vec<_>>() {
            let Transmission::Characters(characters) = transmission else {
                panic!("a frame on a serial line");
            };
            let mut bytes = String::new();
            for character in &characters {
                write!(bytes, " {:02X}", character.byte).unwrap();
            }
            writeln!(self.told, ">>{bytes}").unwrap();
            let mut out = Outbox::default();
            deliver(self.device.as_mut(), 1, self.now, &characters, &mut out);
            self.tell(&mut out);
        }
    }
}

/// Each character ends a character time after the one before.
fn deliver(
    to: &mut dyn Participant,
    port: usize,
    from: Instant,
    characters: &[Character],
    out: &mut Outbox,
) {
    let Line::Serial(line) = to.line(port) else {
        return;
    };
    let time = Duration::from_secs(1) * line.bits_per_character() / line.baud;
    let mut at = from;
    for character in characters {
        at = at + time;
        to.receive(at, port, Reception::Character(*character), out);
    }
}

/// What `script` makes of a device of `kind` that is a legal variant.
pub(crate) fn as_variant(kind: &DeviceKind, variant: &str, script: &str) -> String {
    let settings = Settings {
        variant: Some(variant.to_owned()),
        ..Settings::default()
    };
    Script::new(kind, &settings).play(script)
}

/// What `script` makes of a device of `kind`.
pub(crate) fn without_fault(kind: &DeviceKind, script: &str) -> String {
    Script::new(kind, &Settings::default()).play(script)
}

/// What `script` makes of a device of `kind` with one fault.
pub(crate) fn with_fault(kind: &DeviceKind, fault: &str, script: &str) -> String {
    let settings = Settings {
        fault: Some(fault.to_owned()),
        ..Settings::default()
    };
    Script::new(kind, &settings).play(script)
}

/// Plays `script`, which must come out as it is written.
pub(crate) fn conforms(kind: &DeviceKind, script: &str) {
    assert_same(&without_fault(kind, script), script);
}

/// A fault changes the outcome of `script`, on which a device without it comes out as written, in exactly these lines:
/// the first of a pair becomes the second, which may be no line or several.
pub(crate) fn departs(kind: &DeviceKind, fault: &str, script: &str, changes: &[(&str, &str)]) {
    conforms(kind, script);
    assert_same(
        &with_fault(kind, fault, script),
        &departures(script, changes),
    );
}

/// `script` with these lines changed, in this order.
pub(crate) fn departures(script: &str, changes: &[(&str, &str)]) -> String {
    let mut expected = String::new();
    let mut changes = changes.iter().peekable();
    for line in lines(script) {
        let changed = changes.next_if(|(old, _)| *old == line);
        let line = changed.map_or(line, |(_, new)| new);
        writeln!(expected, "{line}").unwrap();
    }
    assert_eq!(changes.next(), None, "never reached");
    expected
}

/// Both say the same, indentation and empty lines apart.
pub(crate) fn assert_same(told: &str, expected: &str) {
    let plain = |text| lines(text).collect::<Vec<_>>().join("\n");
    assert_eq!(plain(told), plain(expected), "\n--- it was\n{told}");
}

fn lines(text: &str) -> impl Iterator<Item = &str> {
    text.lines().map(str::trim).filter(|line| !line.is_empty())
}

fn frame(text: &str) -> Frame {
    let (id, data) = text.split_once('#').unwrap();
    if id.len() == 8 {
        return text.parse().unwrap();
    }
    let id = Id::standard(u16::from_str_radix(id, 16).unwrap()).unwrap();
    if data == "R" {
        return Frame::remote(id, 0).unwrap();
    }
    if let Some(length) = data.strip_prefix('R') {
        return Frame::remote(id, length.parse().unwrap()).unwrap();
    }
    let byte = |place| u8::from_str_radix(&data[place..place + 2], 16).unwrap();
    let bytes: Vec<u8> = (0..data.len()).step_by(2).map(byte).collect();
    Frame::data(id, &bytes).unwrap()
}

fn text(frame: &Frame) -> String {
    let mut text = format!("{:03X}#", frame.id().raw());
    for byte in frame.bytes() {
        write!(text, "{byte:02X}").unwrap();
    }
    text
}
