//! `send-bytes`, `expect-bytes`: serial frames as they stand.

use std::time::Duration;

use fieldproof_can::BytePattern;
use fieldproof_link::{Character, Farewell, Parity, PortIndex, SerialSettings};
use fieldproof_suite::model::{
    Crc, Disconnect, ExpectBytes, OtherBytes, Pause, PauseLength, SendBytes,
};
use fieldproof_wire::modbus::crc16_bytes;

use crate::limits::show;
use crate::modbus::show_bytes;
use crate::modbus_words::expected_words;
use crate::session::Message;
use crate::stop::{Came, Stop};
use crate::tester::{LATE_ANSWER, SERIAL, Tester};
use crate::value::check_decode;

impl Tester<'_> {
    pub(super) fn send_raw_bytes(&mut self, step: &SendBytes) -> Result<(), Stop> {
        let port = self.port(step.port.as_deref().unwrap_or(SERIAL))?;
        let mut bytes = with_crc(&step.bytes.0, step.crc)?;
        for piece in &step.then {
            bytes.extend(with_crc(&piece.bytes.0, piece.crc)?);
        }
        let mut words = self.request_words(port, &bytes);
        if step.spoil.is_some() {
            words.push_str(", with a wrong parity bit");
        }
        if step.pause.is_some() {
            words.push_str(", with a silence inside");
        }
        self.history.add(words);
        let mut characters: Vec<Character> = bytes.into_iter().map(Character::new).collect();
        if let Some(place) = step.spoil {
            self.spoil(port, &mut characters, usize::from(place))?;
        }
        let Some(pause) = step.pause else {
            self.session.send_characters(port, characters, None)?;
            return Ok(());
        };
        self.send_with_pauses(port, characters, pause)
    }

    fn send_with_pauses(
        &mut self,
        port: PortIndex,
        characters: Vec<Character>,
        pause: Pause,
    ) -> Result<(), Stop> {
        let lasting = self.pause_length(port, pause.lasting)?;
        let mut rest = characters;
        let mut after = None;
        while !rest.is_empty() {
            let is_last = after.is_some() && !pause.again;
            let length = match is_last {
                true => rest.len(),
                false => usize::from(pause.after.get()).min(rest.len()),
            };
            let next = rest.split_off(length);
            let before = self.session.last_sent();
            let sent = self.session.send_characters(port, rest, after)?;
            if after.is_some() {
                self.judge_pause(port, sent.start.since(before.end), lasting)?;
            }
            after = Some(lasting);
            rest = next;
        }
        Ok(())
    }

    /// Turns the parity bit of a character over, where there is one.
    fn spoil(
        &self,
        port: PortIndex,
        characters: &mut [Character],
        place: usize,
    ) -> Result<(), Stop> {
        let settings = self.session.serial_settings(port);
        let has_parity = settings.is_some_and(|it| it.parity != Parity::None);
        if !has_parity || self.session.least_silence(port).is_none() {
            return Err(Stop::undecided(
                "no parity bit can be sent wrong on this link",
                "a serial line with parity",
                "a link without",
            ));
        }
        let character = characters
            .get_mut(place)
            .ok_or_else(|| Stop::Bench(format!("the frame has no character {place}")))?;
        character.spoilt = true;
        Ok(())
    }

    fn pause_length(&self, port: PortIndex, length: PauseLength) -> Result<Duration, Stop> {
        let settings = self.session.serial_settings(port);
        match (length, settings) {
            (PauseLength::Time(time), _) => Ok(time),
            (PauseLength::Characters(thousandths), Some(settings)) => {
                // Above 19200 bit/s the silences of 1.5 and 3.5 characters are fixed, as of characters of 500 us.
                Ok(settings.silence_1_5() * thousandths / 1_500)
            }
            (PauseLength::Characters(_), None) => Err(Stop::Bench(
                "a connection has no characters to count a silence in".into(),
            )),
        }
    }

    /// Between characters of a serial line a silence must have come out on the side of 1.5 and 3.5 characters that it was
    /// meant to be on: else nobody knows what the device was sent.
    fn judge_pause(
        &self,
        port: PortIndex,
        measured: Duration,
        meant: Duration,
    ) -> Result<(), Stop> {
        let Some(settings) = self.session.serial_settings(port) else {
            return Ok(());
        };
        let uncertainty = self.session.uncertainty(port);
        match blurred_limit(settings, measured, uncertainty, meant) {
            None => Ok(()),
            Some((limit, name)) => Err(Stop::undecided(
                format!("the silence among the bytes cannot be told from {name} on this link"),
                format!("{}, and {name} are {}", show(meant), show(limit)),
                format!("{} ± {}", show(measured), show(uncertainty)),
            )),
        }
    }

    pub(super) fn connect(&mut self, name: &str) -> Result<(), Stop> {
        let port = self
            .session
            .tcp_port()
            .ok_or_else(|| Stop::Bench("this bench has no port of Modbus TCP".into()))?;
        if self.session.port(name).is_some() {
            return Err(Stop::Bench(format!("there is a port {name:?} already")));
        }
        self.history.add(format!("opening connection {name}"));
        match self.session.connect(port, name) {
            Err(Stop::Link(error)) => Err(Stop::mismatch(
                "the device takes no further connection",
                "a connection",
                error.to_string(),
                Came::Other,
            )),
            connected => connected,
        }
    }

    pub(super) fn disconnect(&mut self, step: &Disconnect) -> Result<(), Stop> {
        let port = self.port(&step.name)?;
        let how = match step.reset {
            true => Farewell::Reset,
            false => Farewell::Close,
        };
        let how_words = if step.reset { "resetting" } else { "closing" };
        self.history
            .add(format!("{how_words} connection {}", step.name));
        self.session.disconnect(port, how)
    }

    pub(super) fn expect_bytes(&mut self, step: &ExpectBytes) -> Result<(), Stop> {
        let role = step.port.as_deref().unwrap_or(SERIAL);
        let port = self.port(role)?;
        let within = step.within.unwrap_or(self.device.timing.modbus_response);
        let expected = &step.bytes.0;
        let may_be_silent = step.or.contains(&OtherBytes::Silence);
        let Some((bytes, received)) = self.first_serial(port, within)? else {
            if may_be_silent {
                return Ok(());
            }
            let deadline = self.session.last_sent().end + within + LATE_ANSWER;
            let late = self
                .session
                .first(deadline, |received| received.port == port)?;
            let expected = format!("{expected} within {}", show(within));
            let Some(late) = late else {
                return Err(self.no_answer(port, expected));
            };
            let after = show(late.start.since(self.session.last_sent().end));
            return Err(Stop::mismatch(
                format!("the answer came too late, after {after}"),
                expected,
                format!("it came after {after}"),
                Came::Silence,
            ));
        };
        let spoilt = matches!(received.message, Message::Serial { spoilt: true, .. });
        let patterns = step.or.iter().filter_map(|other| match other {
            OtherBytes::Bytes(pattern) => Some(&pattern.0),
            OtherBytes::Silence => None,
        });
        let mut patterns = std::iter::once(expected).chain(patterns);
        let Some(expected) = patterns.find(|it| !spoilt && it.matches(&bytes)) else {
            return Err(wrong_bytes(step, &bytes, spoilt, self.is_modbus_tcp(port)));
        };
        if self.session.serial_settings(port).is_some() {
            check_open_crc(expected, &bytes)?;
        }
        if role == SERIAL || self.session.serial_settings(port).is_none() {
            self.judge_reply_time(port, &received, within)?;
        }
        step.decode
            .iter()
            .try_for_each(|rule| check_decode(rule, &bytes))
    }
}

/// The silence of 1.5 or 3.5 characters of which nobody can say that what was measured is on the side of it that was meant.
fn blurred_limit(
    settings: SerialSettings,
    measured: Duration,
    uncertainty: Duration,
    meant: Duration,
) -> Option<(Duration, &'static str)> {
    let (least, most) = (measured.saturating_sub(uncertainty), measured + uncertainty);
    let limits = [
        (settings.silence_1_5(), "1.5 characters"),
        (settings.silence_3_5(), "3.5 characters"),
    ];
    limits.into_iter().find(|(limit, _)| match meant <= *limit {
        true => most > *limit,
        false => least <= *limit,
    })
}

fn wrong_bytes(step: &ExpectBytes, bytes: &[u8], spoilt: bool, is_tcp: bool) -> Stop {
    let expected = &step.bytes.0;
    let came = match bytes {
        [_, function, code, _, _] if function & 0x80 != 0 => Came::Exception(*code),
        _ => Came::Answer,
    };
    let stop = Stop::mismatch(
        format!(
            "another answer came than expected ({})",
            expected_words(expected, is_tcp)
        ),
        expected.to_string(),
        show_bytes(bytes),
        came,
    );
    if spoilt {
        return stop.with_note("a character has a wrong parity or stop bit");
    }
    if expected.len() != bytes.len() {
        return stop.with_note(format!(
            "{} bytes were expected, {} came",
            expected.len(),
            bytes.len()
        ));
    }
    let differing: Vec<String> = expected
        .mismatches(bytes)
        .iter()
        .map(usize::to_string)
        .collect();
    stop.with_note(format!("bytes that differ: {}", differing.join(", ")))
}

/// Where the pattern leaves the last two bytes open they are still a CRC, and it must be right.
fn check_open_crc(expected: &BytePattern, bytes: &[u8]) -> Result<(), Stop> {
    let is_open =
        matches!(expected.bytes(), [.., low, high] if low.mask() == 0 && high.mask() == 0);
    let Some((body, crc)) = bytes.split_last_chunk::<2>().filter(|_| is_open) else {
        return Ok(());
    };
    let right = crc16_bytes(body);
    if *crc == right {
        return Ok(());
    }
    Err(Stop::mismatch(
        "the CRC of the frame is wrong",
        show_bytes(&right),
        show_bytes(crc),
        Came::Answer,
    ))
}

fn with_crc(bytes: &[u8], crc: Crc) -> Result<Vec<u8>, Stop> {
    let mut whole = bytes.to_vec();
    let [low, high] = crc16_bytes(bytes);
    match crc {
        Crc::Given => {}
        Crc::Append => whole.extend([low, high]),
        Crc::Swapped => whole.extend([high, low]),
        Crc::FlipBit(bit) => {
            whole.extend([low, high]);
            let byte = whole
                .get_mut(bit as usize / 8)
                .ok_or_else(|| Stop::Bench(format!("the frame has no bit {bit}")))?;
            *byte ^= 1 << (bit % 8);
        }
    }
    Ok(whole)
}

#[cfg(test)]
mod tests {
    use fieldproof_link::StopBits;

    use super::*;

    #[test]
    fn a_silence_must_be_on_the_side_that_was_meant() {
        // 10 bits at 10 kBd: 1.5 characters are 1.5 ms, 3.5 are 3.5 ms.
        let settings = SerialSettings {
            baud: 10_000,
            parity: Parity::None,
            stop_bits: StopBits::One,
        };
        let blurred = |measured: u64, uncertainty: u64, meant: u64| {
            let us = Duration::from_micros;
            let limit = blurred_limit(settings, us(measured), us(uncertainty), us(meant));
            limit.map(|(_, name)| name)
        };
        assert_eq!(blurred(1_000, 0, 1_000), None);
        assert_eq!(blurred(1_000, 500, 1_000), None);
        assert_eq!(blurred(1_000, 501, 1_000), Some("1.5 characters"));
        // It came out longer than it was meant.
        assert_eq!(blurred(1_600, 0, 1_000), Some("1.5 characters"));
        assert_eq!(blurred(2_500, 900, 2_500), None);
        assert_eq!(blurred(2_500, 1_000, 2_500), Some("1.5 characters"));
        assert_eq!(blurred(3_400, 200, 2_500), Some("3.5 characters"));
        assert_eq!(blurred(5_000, 1_000, 5_000), None);
        assert_eq!(blurred(5_000, 1_500, 5_000), Some("3.5 characters"));
    }

    #[test]
    fn a_crc_that_the_pattern_leaves_open_must_be_right() {
        let open: BytePattern = "20 03 02 ?? ?? ?? ??".parse().expect("a pattern");
        assert!(check_open_crc(&open, &[0x20, 0x03, 0x02, 0x0F, 0xB4, 0x01, 0xC4]).is_ok());
        assert!(check_open_crc(&open, &[0x20, 0x03, 0x02, 0x0F, 0xB4, 0xC4, 0x01]).is_err());
        let given: BytePattern = "20 03 02 ?? ?? 00 00".parse().expect("a pattern");
        assert!(check_open_crc(&given, &[0x20, 0x03, 0x02, 0x0F, 0xB4, 0x00, 0x00]).is_ok());
    }

    #[test]
    fn the_crc_is_left_appended_swapped_or_spoilt() {
        // Read of register 0000h of slave 20h; its CRC is 82 BB.
        let request = [0x20, 0x03, 0x00, 0x00, 0x00, 0x01];
        assert_eq!(with_crc(&request, Crc::Given).ok(), Some(request.to_vec()));
        let appended = [0x20, 0x03, 0x00, 0x00, 0x00, 0x01, 0x82, 0xBB];
        assert_eq!(
            with_crc(&request, Crc::Append).ok(),
            Some(appended.to_vec())
        );
        let swapped = [0x20, 0x03, 0x00, 0x00, 0x00, 0x01, 0xBB, 0x82];
        assert_eq!(
            with_crc(&request, Crc::Swapped).ok(),
            Some(swapped.to_vec())
        );
        let spoilt = [0x20, 0x0B, 0x00, 0x00, 0x00, 0x01, 0x82, 0xBB];
        assert_eq!(
            with_crc(&request, Crc::FlipBit(11)).ok(),
            Some(spoilt.to_vec())
        );
        assert!(with_crc(&request, Crc::FlipBit(64)).is_err());
    }
}
