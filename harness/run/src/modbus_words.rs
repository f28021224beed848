//! Modbus frames in the words of a failure's first line.

use fieldproof_can::BytePattern;
use fieldproof_link::{Framing, Line, PortIndex};
use fieldproof_record::Direction;
use fieldproof_wire::describe::{
    Direction as ModbusDirection, describe_modbus, describe_modbus_tcp,
};
use fieldproof_wire::modbus::tcp::HEADER_LEN;
use fieldproof_wire::modbus::{ExceptionCode, FunctionCode};

use crate::modbus::adu;
use crate::session::Traffic;
use crate::stop::Stop;
use crate::tester::{SERIAL, Tester};

/// What stands around a PDU on a serial line: the address before it, the CRC behind it.
const RTU_HEADER_LEN: usize = 1;
const CRC_LEN: usize = 2;

impl Tester<'_> {
    /// Says what came after the last request, if something did.
    pub(crate) fn with_answer(&self, mut stop: Stop) -> Stop {
        let (Stop::Mismatch(mismatch) | Stop::Undecided(mismatch)) = &mut stop else {
            return stop;
        };
        if self.main_role != SERIAL {
            return stop;
        }
        let serial = self.session.trace().filter_map(|traffic| match traffic {
            Traffic::Serial(event) => Some(event),
            Traffic::Can(_) => None,
        });
        let mut answer = None;
        for event in serial {
            match event.direction {
                Direction::Sent => answer = None,
                Direction::Received | Direction::Companion => answer = answer.or(Some(event)),
            }
        }
        if let Some(event) = answer {
            let words = match self.is_modbus_tcp(PortIndex(event.port.into())) {
                true => describe_modbus_tcp(&event.bytes, ModbusDirection::Response),
                false => describe_modbus(&event.bytes, ModbusDirection::Response),
            };
            mismatch.what = format!("{}: {words}", mismatch.what);
        }
        stop
    }

    /// A request as it stands, in words. On a line that slaves share they say whom it is for, where that is not the device.
    pub(crate) fn request_words(&self, port: PortIndex, request: &[u8]) -> String {
        if self.is_modbus_tcp(port) {
            return describe_modbus_tcp(request, ModbusDirection::Request);
        }
        let words = describe_modbus(request, ModbusDirection::Request);
        self.with_receiver(request.first().copied(), words)
    }

    /// A request with the address it goes to, however it is framed.
    pub(crate) fn pdu_request_words(&self, to: u8, pdu: &[u8]) -> String {
        let words = describe_modbus(&adu(to, pdu), ModbusDirection::Request);
        self.with_receiver(Some(to), words)
    }

    fn with_receiver(&self, to: Option<u8>, words: String) -> String {
        match to {
            Some(0) => format!("broadcast: {words}"),
            Some(address) if Some(address) != self.address => {
                format!("to another address, {address:02X}h: {words}")
            }
            _ => words,
        }
    }

    pub(crate) fn is_modbus_tcp(&self, port: PortIndex) -> bool {
        self.session.line(port) == Line::Stream(Framing::ModbusTcp)
    }
}

/// An answer that is expected, as it stands, in words; as a pattern where it leaves too much open for words.
pub(crate) fn expected_words(expected: &BytePattern, is_tcp: bool) -> String {
    let bytes = expected.bytes();
    let pdu = match is_tcp {
        true => bytes.get(HEADER_LEN..),
        false => bytes.get(RTU_HEADER_LEN..bytes.len().saturating_sub(CRC_LEN)),
    };
    let words = pdu.and_then(|pdu| pdu_in_words(&pdu.iter().copied().collect()));
    words.unwrap_or_else(|| expected.to_string())
}

/// The same of a PDU.
pub(crate) fn expected_pdu_words(expected: &BytePattern) -> String {
    pdu_in_words(expected).unwrap_or_else(|| expected.to_string())
}

fn pdu_in_words(pdu: &BytePattern) -> Option<String> {
    let exact: Vec<Option<u8>> = pdu.bytes().iter().map(|byte| byte.exact()).collect();
    match exact.as_slice() {
        [Some(function), code] if function & FunctionCode::EXCEPTION_BIT != 0 => {
            let function = FunctionCode(function & !FunctionCode::EXCEPTION_BIT);
            Some(match code {
                Some(code) => format!(
                    "exception {} to function {function}",
                    ExceptionCode::from_code(*code)
                ),
                None => format!("an exception to function {function}"),
            })
        }
        _ => pdu
            .exact()
            .map(|pdu| describe_modbus(&adu(1, &pdu), ModbusDirection::Response)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(pattern: &str, is_tcp: bool) -> String {
        expected_words(&pattern.parse().expect("a pattern"), is_tcp)
    }

    #[test]
    fn expected_answers_in_words() {
        for (pattern, is_tcp, said) in [
            ("01 03 02 0F B4 ?? ??", false, "1 register: 0FB4h"),
            (
                "01 83 02 ?? ??",
                false,
                "exception 02 illegal data address to function 03h",
            ),
            ("01 83 ?? ?? ??", false, "an exception to function 03h"),
            ("01 03 02 0F ?? ?? ??", false, "01 03 02 0F ?? ?? ??"),
            (
                "00 07 00 00 00 03 01 83 02",
                true,
                "exception 02 illegal data address to function 03h",
            ),
            ("00", false, "00"),
            ("00", true, "00"),
        ] {
            assert_eq!(words(pattern, is_tcp), said);
        }
    }
}
