//! `send`, `expect`, `expect-silence`: CAN frames as they stand.

use std::time::Duration;

use fieldproof_can::{Frame, Id, MaskedByte, Pattern};
use fieldproof_link::{Instant, Origin, PortIndex};
use fieldproof_suite::model::{Alternative, Expect, ExpectSilence, Send};
use fieldproof_suite::scalar::Tolerance;
use fieldproof_wire::canopen::emergency::ErrorCode;
use fieldproof_wire::canopen::nmt::NmtMessage;
use fieldproof_wire::canopen::{Service, identify};
use fieldproof_wire::describe::describe_frame;

use crate::limits::show;
use crate::session::{Message, Received};
use crate::stop::{Came, Stop};
use crate::tester::{CAN, LATE_ANSWER, SERIAL, Tester};
use crate::value::check_decode;

impl Tester<'_> {
    pub(super) fn send(&mut self, step: &Send) -> Result<(), Stop> {
        self.send_frame(step.frame.0)?;
        self.history.add(self.sent_words(&step.frame.0));
        Ok(())
    }

    /// What the tester sends, in words; of an NMT command for another node they say that it is for another.
    pub(super) fn sent_words(&self, frame: &Frame) -> String {
        let words = describe_frame(frame);
        match NmtMessage::parse(frame) {
            Ok(message) if message.node.is_some_and(|node| self.node != Some(node)) => {
                format!("{words}, which is another node")
            }
            _ => words,
        }
    }

    pub(super) fn expect(&mut self, step: &Expect) -> Result<(), Stop> {
        let pattern = &step.frame.0;
        let (name, promised) = self.promised(pattern.id());
        let within = step.within.unwrap_or(promised);
        let Some((frame, received)) = self.first_frame(pattern.id(), within)? else {
            return match step.or.contains(&Alternative::Silence) {
                true => Ok(()),
                false => Err(with_alternatives(
                    self.nothing_came(pattern, within),
                    &step.or,
                )),
            };
        };
        if !pattern.matches(&frame) {
            if !is_alternative(&step.or, &frame) {
                return Err(with_alternatives(wrong_frame(pattern, &frame), &step.or));
            }
            self.measure_response(name, &received, within)?;
            self.follow_received(&frame, received.at);
            return Ok(());
        }
        self.measure_response(name, &received, within)?;
        check_meaning(step, &frame)?;
        self.follow_received(&frame, received.at);
        match step.period {
            Some(limit) => self.expect_period(step, limit, received.at),
            None => Ok(()),
        }
    }

    /// Measures `count` periods from the frame that came at `last` on.
    fn expect_period(
        &mut self,
        step: &Expect,
        limit: Tolerance,
        mut last: Instant,
    ) -> Result<(), Stop> {
        let pattern = &step.frame.0;
        let patience = limit.nominal * 2 + limit.tolerance;
        let mut periods = Vec::new();
        while periods.len() < step.count as usize {
            let within = (last + patience).since(self.session.last_sent().end);
            let Some((frame, received)) = self.first_frame(pattern.id(), within)? else {
                return Err(Stop::mismatch(
                    format!("{} stops", show_id(pattern.id())),
                    format!("the next within {}", show(patience)),
                    "nothing",
                    Came::Silence,
                ));
            };
            if !pattern.matches(&frame) {
                return Err(wrong_frame(pattern, &frame));
            }
            check_meaning(step, &frame)?;
            periods.push(received.at.since(last));
            last = received.at;
        }
        let port = self.can_port()?;
        let uncertainty = self.session.uncertainty(port) * 2;
        self.judge_periods("period", &periods, limit, step.judge, uncertainty)
    }

    /// What an expected frame tells of the node: a boot-up means that it is pre-operational.
    fn follow_received(&mut self, frame: &Frame, at: Instant) {
        match frame.standard_id().and_then(identify) {
            Some((Service::ErrorControl, Some(node))) if frame.bytes() == [0] => {
                self.node = Some(node);
                self.watch.booted(at);
            }
            Some((Service::SdoResponse, _)) => self.watch.confirmed(at),
            _ => {}
        }
    }

    /// What the description promises for an answer with this identifier, and what the measurement is called.
    fn promised(&self, id: Id) -> (&'static str, Duration) {
        let timing = &self.device.timing;
        let service = match id {
            Id::Standard(id) => identify(id).map(|(service, _)| service),
            Id::Extended(_) => None,
        };
        match service {
            Some(Service::SdoResponse) => ("SDO response time", timing.sdo_response),
            Some(Service::LssResponse) => ("LSS response time", timing.lss_response),
            Some(Service::ErrorControl) => ("error control response time", timing.boot_up),
            _ => ("response time", Duration::from_secs(1)),
        }
    }

    fn nothing_came(&mut self, pattern: &Pattern, within: Duration) -> Stop {
        let deadline = self.session.last_sent().end + within + LATE_ANSWER.min(within);
        let late = self.session.first(deadline, |received| {
            matches!(received.message, Message::Can(frame) if frame.id() == pattern.id())
        });
        let actual = match late {
            Ok(Some(received)) => {
                format!(
                    "it came after {}",
                    show(received.at.since(self.session.last_sent().end))
                )
            }
            Ok(None) => "nothing".to_owned(),
            Err(stop) => return stop,
        };
        let another = match pattern.exact() {
            Some(frame) if is_boot_up(&frame) => self.but_another_booted(),
            _ => String::new(),
        };
        Stop::mismatch(
            format!("no {} came in time{another}", name_of(pattern)),
            format!("{pattern} within {}", show(within)),
            actual,
            Came::Silence,
        )
    }

    pub(super) fn expect_silence(&mut self, step: &ExpectSilence) -> Result<(), Stop> {
        let port = match &step.port {
            Some(role) => self.port(role)?,
            None => self.main_port()?,
        };
        let deadline = self.session.now() + step.lasting;
        let watch = self.watch.clone();
        let (node, transition) = (self.node, self.device.timing.nmt_transition);
        let breaks_silence = |received: &Received| {
            received.port == port
                && received.origin == Origin::Bus
                && match &received.message {
                    Message::Serial { .. } => true,
                    Message::Can(frame) if step.of.is_empty() => {
                        !crate::unexpected::is_proper_heartbeat(
                            frame,
                            received.at,
                            &watch,
                            node,
                            transition,
                        )
                    }
                    Message::Can(frame) => frame
                        .standard_id()
                        .is_some_and(|id| step.of.contains(&id.raw())),
                }
        };
        let Some(received) = self.session.first(deadline, breaks_silence)? else {
            return Ok(());
        };
        let expected = format!("silence for {}", show(step.lasting));
        match received.message {
            Message::Can(frame) => Err(Stop::mismatch(
                format!("{} came where silence was expected", describe_frame(&frame)),
                expected,
                format!("{frame}  {}", describe_frame(&frame)),
                Came::Frame(frame),
            )),
            Message::Serial { bytes, .. } => Err(Stop::mismatch(
                "something came where silence was expected",
                expected,
                crate::modbus::show_bytes(&bytes),
                Came::Answer,
            )),
        }
    }

    /// The port that a suite means when it names none: CAN, or else serial.
    pub(crate) fn main_port(&self) -> Result<PortIndex, Stop> {
        match self.main_role {
            SERIAL => self.modbus_port(),
            role => self.port(role),
        }
    }
}

/// The role of the main port of a suite.
pub(crate) const fn main_role(protocol: fieldproof_suite::model::Protocol) -> &'static str {
    match protocol {
        fieldproof_suite::model::Protocol::Canopen | fieldproof_suite::model::Protocol::Gateway => {
            CAN
        }
        fieldproof_suite::model::Protocol::Modbus => SERIAL,
    }
}

fn check_meaning(step: &Expect, frame: &Frame) -> Result<(), Stop> {
    step.decode.iter().try_for_each(|rule| {
        if let Some(object) = rule.object {
            check_named_object(frame, object.index, object.sub)?;
        }
        check_decode(rule, frame.bytes())
    })
}

/// A frame came under the right identifier that is not the one expected.
pub(super) fn wrong_frame(pattern: &Pattern, frame: &Frame) -> Stop {
    let expected = match pattern.exact() {
        Some(frame) => format!("; expected: {}", describe_frame(&frame)),
        None => String::new(),
    };
    let stop = Stop::mismatch(
        format!(
            "another frame came than expected: {}{expected}",
            describe_frame(frame)
        ),
        format!("{pattern}{}", describe_pattern(pattern)),
        format!("{frame}  {}", describe_frame(frame)),
        Came::Frame(*frame),
    );
    if pattern.len() != frame.len() {
        return stop.with_note(format!(
            "{} data bytes were expected, {} came",
            pattern.len(),
            frame.len()
        ));
    }
    let differing: Vec<String> = pattern
        .mismatches(frame)
        .iter()
        .map(usize::to_string)
        .collect();
    match differing.len() {
        0 => stop,
        1 => stop.with_note(format!("byte {} differs", differing[0])),
        _ => stop.with_note(format!("bytes {} differ", differing.join(", "))),
    }
}

fn is_alternative(alternatives: &[Alternative], frame: &Frame) -> bool {
    alternatives.iter().any(
        |alternative| matches!(alternative, Alternative::Frame(other) if other.0.matches(frame)),
    )
}

/// Says what else would have been accepted.
fn with_alternatives(stop: Stop, alternatives: &[Alternative]) -> Stop {
    alternatives
        .iter()
        .fold(stop, |stop, alternative| match alternative {
            Alternative::Silence => stop.with_note("or silence"),
            Alternative::Frame(frame) => stop.with_note(format!("or {}", frame.0)),
        })
}

fn describe_pattern(pattern: &Pattern) -> String {
    pattern
        .exact()
        .map(|frame| format!("  {}", describe_frame(&frame)))
        .unwrap_or_default()
}

fn check_named_object(frame: &Frame, index: u16, sub: u8) -> Result<(), Stop> {
    let named = match frame.bytes() {
        [_, low, high, named_sub, ..] => (u16::from_le_bytes([*low, *high]), *named_sub),
        _ => (0, 0),
    };
    if named == (index, sub) {
        return Ok(());
    }
    Err(Stop::mismatch(
        format!("the answer names another object than {index:04X}h:{sub:02X}"),
        format!("{index:04X}h:{sub:02X}"),
        format!("{:04X}h:{:02X}", named.0, named.1),
        Came::Frame(*frame),
    ))
}

fn is_boot_up(frame: &Frame) -> bool {
    let service = frame.standard_id().and_then(identify);
    matches!(service, Some((Service::ErrorControl, _))) && frame.bytes() == [0]
}

/// `SDO response for 1017h:00 (58Ah)`, as far as the pattern says it.
fn name_of(pattern: &Pattern) -> String {
    let id = show_id(pattern.id());
    let service = match pattern.id() {
        Id::Standard(standard) => identify(standard).map(|(service, _)| service),
        Id::Extended(_) => None,
    };
    let Some(service) = service else {
        return format!("frame {id}");
    };
    let exact = |byte: &MaskedByte| (byte.mask() == 0xFF).then_some(byte.value());
    let bytes: Vec<Option<u8>> = pattern.bytes().iter().map(exact).collect();
    match (service, bytes.as_slice()) {
        (Service::SdoResponse, [_, Some(low), Some(high), Some(sub), ..]) => {
            let index = u16::from_le_bytes([*low, *high]);
            format!("{service} for {index:04X}h:{sub:02X} ({id})")
        }
        (Service::Emergency, [Some(low), Some(high), ..]) => {
            let code = ErrorCode(u16::from_le_bytes([*low, *high]));
            format!("{service} {code} ({id})")
        }
        (Service::ErrorControl, [Some(0)]) => format!("boot-up message ({id})"),
        _ => format!("{service} ({id})"),
    }
}

fn show_id(id: Id) -> String {
    match id {
        Id::Standard(id) => format!("{:03X}h", id.raw()),
        Id::Extended(id) => format!("{:08X}h", id.raw()),
    }
}
