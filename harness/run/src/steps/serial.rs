//! `send-bytes`, `expect-bytes`: serial frames as they stand.

use fieldproof_can::BytePattern;
use fieldproof_suite::model::{Crc, ExpectBytes, SendBytes};
use fieldproof_wire::modbus::crc16_bytes;

use crate::limits::show;
use crate::modbus::show_bytes;
use crate::session::Message;
use crate::stop::{Came, Stop};
use crate::tester::{LATE_ANSWER, SERIAL, Tester};
use crate::value::check_decode;

impl Tester<'_> {
    pub(super) fn send_raw_bytes(&mut self, step: &SendBytes) -> Result<(), Stop> {
        let port = self.port(step.port.as_deref().unwrap_or(SERIAL))?;
        let bytes = with_crc(&step.bytes.0, step.crc)?;
        self.session.send_bytes(port, &bytes)?;
        Ok(())
    }

    pub(super) fn expect_bytes(&mut self, step: &ExpectBytes) -> Result<(), Stop> {
        let role = step.port.as_deref().unwrap_or(SERIAL);
        let port = self.port(role)?;
        let within = step.within.unwrap_or(self.device.timing.modbus_response);
        let expected = &step.bytes.0;
        let Some((bytes, received)) = self.first_serial(port, within)? else {
            let deadline = self.session.last_sent().end + within + LATE_ANSWER;
            let late = self
                .session
                .first(deadline, |received| received.port == port)?;
            let actual = late.map_or_else(
                || "nothing".to_owned(),
                |late| {
                    format!(
                        "it came after {}",
                        show(late.start.since(self.session.last_sent().end))
                    )
                },
            );
            return Err(Stop::mismatch(
                "no answer came in time",
                format!("{expected} within {}", show(within)),
                actual,
                Came::Silence,
            ));
        };
        let spoilt = matches!(received.message, Message::Serial { spoilt: true, .. });
        if spoilt || !expected.matches(&bytes) {
            return Err(wrong_bytes(step, &bytes, spoilt));
        }
        check_open_crc(expected, &bytes)?;
        if role == SERIAL {
            self.judge_reply_time(port, &received, within)?;
        }
        step.decode
            .iter()
            .try_for_each(|rule| check_decode(rule, &bytes))
    }
}

fn wrong_bytes(step: &ExpectBytes, bytes: &[u8], spoilt: bool) -> Stop {
    let expected = &step.bytes.0;
    let came = match bytes {
        [_, function, code, _, _] if function & 0x80 != 0 => Came::Exception(*code),
        _ => Came::Answer,
    };
    let stop = Stop::mismatch(
        "another answer came than expected",
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
    use super::*;

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
