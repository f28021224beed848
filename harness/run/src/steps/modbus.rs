//! `modbus`: one request and what must come back.

use fieldproof_suite::model::{Modbus, ModbusExpectation, ModbusRequest};
use fieldproof_suite::scalar::Number;
use fieldproof_wire::modbus::ExceptionCode;

use crate::limits::show;
use crate::modbus::{Answer, show_bytes};
use crate::modbus_words::expected_pdu_words;
use crate::stop::{Came, Stop};
use crate::tester::Tester;
use crate::value::{Actual, Saved, register};

const READ_HOLDING: u8 = 0x03;
const READ_INPUT: u8 = 0x04;
const WRITE_SINGLE: u8 = 0x06;
const WRITE_MULTIPLE: u8 = 0x10;
const EXCEPTION: u8 = 0x80;

impl Tester<'_> {
    pub(super) fn modbus(&mut self, step: &Modbus) -> Result<(), Stop> {
        let own = self
            .address
            .ok_or_else(|| Stop::Bench("the device has no Modbus address here".into()))?;
        let to = step.to.unwrap_or(own);
        let within = step.within.unwrap_or(self.device.timing.modbus_response);
        let request = pdu_of(&step.request, &self.saved)?;
        let written = written_registers(&step.request);
        let before = match written {
            Some((first, count)) => self.registers_before(first, count)?,
            None => None,
        };
        let is_remembered =
            written.is_some_and(|(first, _)| self.remember_registers(first, &before));
        let port = match &step.port {
            Some(name) => self.port(name)?,
            None => self.modbus_port()?,
        };
        let words = self.pdu_request_words(to, &request);
        self.history.add(words);
        let answer = self.modbus_exchange_on(port, to, &request, within)?;
        if let Some((first, _)) = written {
            match &answer {
                Some(answer) if is_exception(answer) && is_remembered => self.undo.forget_last(),
                Some(answer) if is_exception(answer) => {}
                _ => self.check_registers_remembered(first, &before)?,
            }
        }
        let Some(answer) = answer else {
            return match step.expect {
                ModbusExpectation::Silence => Ok(()),
                _ => Err(self.no_answer(port, format!("an answer within {}", show(within)))),
            };
        };
        if matches!(step.expect, ModbusExpectation::Silence) {
            return Err(Stop::mismatch(
                "an answer came where silence was expected",
                format!("silence for {}", show(within)),
                show_bytes(&answer.pdu),
                if is_exception(&answer) {
                    exception_came(&answer)
                } else {
                    Came::Answer
                },
            ));
        }
        if answer.address != to {
            return Err(Stop::differs(
                "another slave answers",
                format!("address {to:02X}h"),
                format!("address {:02X}h", answer.address),
                Came::Other,
            ));
        }
        self.judge_answer(step, &request, &answer)
    }

    fn judge_answer(&mut self, step: &Modbus, request: &[u8], answer: &Answer) -> Result<(), Stop> {
        match &step.expect {
            ModbusExpectation::Exception(codes) => return check_exception(codes, request, answer),
            ModbusExpectation::Pdu(pattern) => {
                if pattern.0.matches(&answer.pdu) {
                    return Ok(());
                }
                return Err(Stop::mismatch(
                    format!(
                        "another answer came than expected ({})",
                        expected_pdu_words(&pattern.0)
                    ),
                    pattern.0.to_string(),
                    show_bytes(&answer.pdu),
                    if is_exception(answer) {
                        exception_came(answer)
                    } else {
                        Came::Answer
                    },
                ));
            }
            ModbusExpectation::Normal
            | ModbusExpectation::Registers(_)
            | ModbusExpectation::Silence => {}
        }
        if is_exception(answer) {
            return Err(Stop::mismatch(
                "the request is refused",
                "a normal answer",
                show_exception(answer),
                exception_came(answer),
            ));
        }
        let registers = check_shape(&step.request, request, answer)?;
        if let ModbusExpectation::Registers(expected) = &step.expect {
            check_registers(expected, &registers, &self.saved)?;
        }
        if let Some(words) = &step.observe {
            let values: Vec<String> = registers
                .iter()
                .map(|value| format!("{value:04X}h"))
                .collect();
            self.observe(words, values.join(" "));
        }
        if let (Some(name), Some(first)) = (&step.save, registers.first()) {
            self.saved
                .insert(name.clone(), Actual::Number(i128::from(*first)));
        }
        Ok(())
    }
}

fn pdu_of(request: &ModbusRequest, saved: &Saved) -> Result<Vec<u8>, Stop> {
    let mut pdu = Vec::new();
    match request {
        ModbusRequest::ReadHolding { address, count } => {
            pdu.push(READ_HOLDING);
            pdu.extend(address.to_be_bytes());
            pdu.extend(count.to_be_bytes());
        }
        ModbusRequest::ReadInput { address, count } => {
            pdu.push(READ_INPUT);
            pdu.extend(address.to_be_bytes());
            pdu.extend(count.to_be_bytes());
        }
        ModbusRequest::WriteSingle { address, value } => {
            pdu.push(WRITE_SINGLE);
            pdu.extend(address.to_be_bytes());
            pdu.extend(register(value, saved)?.to_be_bytes());
        }
        ModbusRequest::WriteMultiple { address, values } => {
            pdu.push(WRITE_MULTIPLE);
            pdu.extend(address.to_be_bytes());
            pdu.extend((values.len() as u16).to_be_bytes());
            pdu.push((values.len() * 2) as u8);
            for value in values {
                pdu.extend(register(value, saved)?.to_be_bytes());
            }
        }
        ModbusRequest::Pdu(bytes) => pdu.extend_from_slice(&bytes.0),
    }
    Ok(pdu)
}

/// The registers a request writes: the first and how many.
fn written_registers(request: &ModbusRequest) -> Option<(u16, u16)> {
    match request {
        ModbusRequest::WriteSingle { address, .. } => Some((*address, 1)),
        ModbusRequest::WriteMultiple { address, values } => u16::try_from(values.len())
            .ok()
            .filter(|count| *count > 0)
            .map(|count| (*address, count)),
        ModbusRequest::ReadHolding { .. }
        | ModbusRequest::ReadInput { .. }
        | ModbusRequest::Pdu(_) => None,
    }
}

/// A normal answer must have the shape of its function; gives the registers it carries.
fn check_shape(request: &ModbusRequest, sent: &[u8], answer: &Answer) -> Result<Vec<u16>, Stop> {
    let malformed = |expected: String| {
        Stop::mismatch(
            format!("the answer does not have the shape of its function ({expected})"),
            expected,
            show_bytes(&answer.pdu),
            Came::Answer,
        )
    };
    match request {
        ModbusRequest::ReadHolding { count, .. } | ModbusRequest::ReadInput { count, .. } => {
            let function = sent.first().copied().unwrap_or_default();
            let bytes = usize::from(*count) * 2;
            match answer.pdu.split_first_chunk::<2>() {
                Some(([code, length], data))
                    if *code == function
                        && usize::from(*length) == bytes
                        && data.len() == bytes =>
                {
                    Ok(data
                        .as_chunks::<2>()
                        .0
                        .iter()
                        .map(|pair| u16::from_be_bytes(*pair))
                        .collect())
                }
                _ => Err(malformed(format!(
                    "function {function:02X}h, byte count {bytes} and as many bytes"
                ))),
            }
        }
        ModbusRequest::WriteSingle { .. } if answer.pdu != sent => {
            Err(malformed(format!("the echo of {}", show_bytes(sent))))
        }
        ModbusRequest::WriteMultiple { .. } if Some(answer.pdu.as_slice()) != sent.get(..5) => {
            Err(malformed(show_bytes(sent.get(..5).unwrap_or_default())))
        }
        ModbusRequest::WriteSingle { .. } | ModbusRequest::WriteMultiple { .. } => Ok(Vec::new()),
        ModbusRequest::Pdu(_) if answer.pdu.first() != sent.first() => Err(malformed(format!(
            "function {:02X}",
            sent.first().copied().unwrap_or_default()
        ))),
        ModbusRequest::Pdu(_) => Ok(Vec::new()),
    }
}

fn check_registers(expected: &[Number], came: &[u16], saved: &Saved) -> Result<(), Stop> {
    let expected: Vec<u16> = expected
        .iter()
        .map(|number| register(number, saved))
        .collect::<Result<_, _>>()?;
    if expected == came {
        return Ok(());
    }
    let show_all = |values: &[u16]| {
        let words: Vec<String> = values
            .iter()
            .map(|value| format!("{value} ({value:04X}h)"))
            .collect();
        words.join(", ")
    };
    Err(Stop::differs(
        "the registers hold something else",
        show_all(&expected),
        show_all(came),
        came.first()
            .map_or(Came::Other, |first| Came::Value(i128::from(*first))),
    ))
}

fn check_exception(codes: &[u8], request: &[u8], answer: &Answer) -> Result<(), Stop> {
    let expected = {
        let names: Vec<String> = codes
            .iter()
            .map(|code| ExceptionCode::from_code(*code).to_string())
            .collect();
        format!("exception {}", names.join(" or "))
    };
    let function = request.first().copied().unwrap_or_default();
    match answer.pdu.as_slice() {
        [code, exception] if *code == function | EXCEPTION => {
            if codes.contains(exception) {
                Ok(())
            } else {
                Err(Stop::differs(
                    "the request is refused with another exception",
                    expected,
                    show_exception(answer),
                    Came::Exception(*exception),
                ))
            }
        }
        [code, _] if *code == function => Err(Stop::mismatch(
            "the function code of the exception lacks its highest bit",
            format!("{:02X} and one byte", function | EXCEPTION),
            show_bytes(&answer.pdu),
            Came::Answer,
        )),
        _ => Err(Stop::mismatch(
            format!("the request is not refused ({expected} expected)"),
            expected,
            show_bytes(&answer.pdu),
            Came::Answer,
        )),
    }
}

fn is_exception(answer: &Answer) -> bool {
    answer
        .pdu
        .first()
        .is_some_and(|function| function & EXCEPTION != 0)
}

fn exception_came(answer: &Answer) -> Came {
    answer
        .pdu
        .get(1)
        .map_or(Came::Other, |code| Came::Exception(*code))
}

fn show_exception(answer: &Answer) -> String {
    match answer.pdu.get(1) {
        Some(code) => format!("exception {}", ExceptionCode::from_code(*code)),
        None => "an exception without a code".into(),
    }
}
