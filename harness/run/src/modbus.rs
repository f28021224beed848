//! The Modbus client: one request, and what must hold of every answer.

use std::time::Duration;

use fieldproof_link::{Framing, Line, PortIndex};
use fieldproof_record::Limits;
use fieldproof_wire::modbus::{crc16, crc16_bytes};

use crate::limits::nanoseconds;
use crate::modbus_tcp;
use crate::session::{Message, Received};
use crate::stop::{Came, Stop};
use crate::tester::Tester;

/// An answer by the rules of the line: right CRC or header, no spoilt character, not before its time.
#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) address: u8,
    pub(crate) pdu: Vec<u8>,
}

/// Address and PDU with their CRC.
pub(crate) fn adu(address: u8, pdu: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(pdu.len() + 3);
    bytes.push(address);
    bytes.extend_from_slice(pdu);
    let crc = crc16_bytes(&bytes);
    bytes.extend_from_slice(&crc);
    bytes
}

/// `20 03 02 0F B4 01 C4`
pub(crate) fn show_bytes(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len() * 3);
    for byte in bytes {
        if !text.is_empty() {
            text.push(' ');
        }
        text.push_str(&format!("{byte:02X}"));
    }
    text
}

impl Tester<'_> {
    /// The next frame on a serial port since the last send; the silence before it is judged.
    pub(crate) fn first_serial(
        &mut self,
        port: PortIndex,
        within: Duration,
    ) -> Result<Option<(Vec<u8>, Received)>, Stop> {
        let deadline = self.session.last_sent().end + within + self.session.uncertainty(port);
        let Some(received) = self
            .session
            .first(deadline, |received| received.port == port)?
        else {
            return Ok(None);
        };
        match &received.message {
            Message::Serial { bytes, .. } => Ok(Some((bytes.clone(), received.clone()))),
            Message::Can(_) => Ok(None),
        }
    }

    /// Sends a request and waits for the answer; `None` if none comes.
    pub(crate) fn modbus_exchange(
        &mut self,
        to: u8,
        pdu: &[u8],
        within: Duration,
    ) -> Result<Option<Answer>, Stop> {
        let port = self.modbus_port()?;
        self.modbus_exchange_on(port, to, pdu, within)
    }

    /// The same on any port.
    pub(crate) fn modbus_exchange_on(
        &mut self,
        port: PortIndex,
        to: u8,
        pdu: &[u8],
        within: Duration,
    ) -> Result<Option<Answer>, Stop> {
        let transaction = match self.session.line(port) {
            Line::Stream(Framing::ModbusTcp) => Some(self.session.next_transaction()),
            _ => None,
        };
        let request = match transaction {
            Some(transaction) => modbus_tcp::adu(transaction, to, pdu),
            None => adu(to, pdu),
        };
        self.session.send_bytes(port, &request)?;
        let Some((bytes, received)) = self.first_serial(port, within)? else {
            return Ok(None);
        };
        self.judge_reply_time(port, &received, within)?;
        let Message::Serial { spoilt, .. } = received.message else {
            return Ok(None);
        };
        if spoilt {
            return Err(Stop::mismatch(
                "a character of the answer has a wrong parity or stop bit",
                "whole characters",
                show_bytes(&bytes),
                Came::Other,
            ));
        }
        match transaction {
            Some(transaction) => modbus_tcp::read_answer(&bytes, transaction, to).map(Some),
            None => read_answer(&bytes).map(Some),
        }
    }

    /// What came instead of an answer.
    pub(crate) fn no_answer(&self, port: PortIndex, expected: String) -> Stop {
        let what = match self.session.is_closed(port) {
            true => "the Modbus server has closed the connection",
            false => "the Modbus slave does not answer",
        };
        Stop::mismatch(what, expected, "nothing", Came::Silence)
    }

    /// A reply begins no earlier than 3.5 characters after the request, where such silences mean something, and no later
    /// than promised.
    pub(crate) fn judge_reply_time(
        &mut self,
        port: PortIndex,
        received: &Received,
        within: Duration,
    ) -> Result<(), Stop> {
        let silence = self.session.least_silence(port);
        let measured = received.start.since(self.session.last_sent().end);
        let limits = Limits {
            min_ns: silence.map(nanoseconds),
            max_ns: Some(nanoseconds(within.max(silence.unwrap_or_default()))),
        };
        let uncertainty = self.session.uncertainty(port);
        self.measure("Modbus response time", measured, uncertainty, limits)
    }
}

fn read_answer(bytes: &[u8]) -> Result<Answer, Stop> {
    let (body, crc) = match bytes.split_last_chunk::<2>() {
        Some((body, crc)) if body.len() >= 2 => (body, crc),
        _ => {
            return Err(Stop::mismatch(
                "the answer is too short for a Modbus frame",
                "at least 4 bytes",
                show_bytes(bytes),
                Came::Other,
            ));
        }
    };
    let right = crc16_bytes(body);
    if *crc != right {
        return Err(Stop::mismatch(
            "the CRC of the answer is wrong",
            format!("{} {}", show_bytes(body), show_bytes(&right)),
            show_bytes(bytes),
            Came::Other,
        )
        .with_note(crc_hint(body, *crc)));
    }
    let (address, pdu) = body
        .split_first()
        .map_or((0, Vec::new()), |(a, pdu)| (*a, pdu.to_vec()));
    Ok(Answer { address, pdu })
}

fn crc_hint(body: &[u8], crc: [u8; 2]) -> String {
    if u16::from_be_bytes(crc) == crc16(body) {
        "the two bytes of the CRC are swapped: the low byte goes first".into()
    } else {
        format!("a CRC-16 over {} bytes was expected", body.len())
    }
}
