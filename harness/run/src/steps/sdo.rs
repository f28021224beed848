//! `sdo-read`, `sdo-write`.

use std::time::Duration;

use fieldproof_suite::model::{
    AbortExpectation, ReadExpectation, SdoRead, SdoWrite, Transfer, WriteExpectation,
};
use fieldproof_wire::canopen::{AbortCode, Multiplexer};

use crate::modbus::show_bytes;
use crate::sdo::{Only, Outcome, Protocol, Uploaded, show_abort};
use crate::sdo_block::Ended;
use crate::stop::{Came, Stop};
use crate::tester::Tester;
use crate::value::{Actual, decode, encode, resolve, size};

/// Between two reads of an object that takes its time.
pub(super) const LOOK: Duration = Duration::from_millis(10);

impl Tester<'_> {
    pub(super) fn sdo_read(&mut self, step: &SdoRead) -> Result<(), Stop> {
        let until = self.session.now() + step.settles.unwrap_or_default();
        loop {
            match self.sdo_read_once(step) {
                Err(Stop::Mismatch(mismatch))
                    if matches!(mismatch.came, Came::Value(_) | Came::Answer)
                        && self.session.now() < until =>
                {
                    let next = self.session.now() + LOOK;
                    self.session.collect_until(next)?;
                }
                done => return done,
            }
        }
    }

    fn sdo_read_once(&mut self, step: &SdoRead) -> Result<(), Stop> {
        let object = self.resolve(step.object)?;
        let within = step.within.unwrap_or(self.device.timing.sdo_response);
        let value = match self.upload_by(object, step.transfer, within)? {
            Ended::With(Outcome::Done(value)) => value,
            Ended::With(Outcome::Refused(code)) => {
                return self.judge_refused_read(object, step, code);
            }
            Ended::GivenUp => return Ok(()),
        };
        let bytes = value.of_size(size(step.value_type));
        if let ReadExpectation::Abort(abort) = &step.expect {
            let actual = decode(step.value_type, bytes).unwrap_or(Actual::Bytes(bytes.to_vec()));
            return Err(Stop::mismatch(
                format!(
                    "reading {object} is not refused: {} expected",
                    self.show_accepted(abort)
                ),
                self.show_accepted(abort),
                actual.to_string(),
                came(&actual),
            ));
        }
        let Some(actual) = decode(step.value_type, bytes) else {
            return Err(Stop::differs(
                format!("{object} has another size"),
                show_size(size(step.value_type).unwrap_or_default()),
                format!("{}: {}", show_size(bytes.len()), show_bytes(bytes)),
                Came::Other,
            ));
        };
        let by = value.protocol.words();
        self.check_read(object, by, &step.expect, &actual)?;
        if let Some(words) = &step.observe {
            self.observe(words, actual.to_string());
        }
        if let Some(name) = &step.save {
            self.saved.insert(name.clone(), actual);
        }
        Ok(())
    }

    fn upload_by(
        &mut self,
        object: Multiplexer,
        transfer: Option<Transfer>,
        within: Duration,
    ) -> Result<Ended<Uploaded>, Stop> {
        let only = match transfer {
            Some(Transfer::Block(block)) => return self.sdo_block_upload(object, &block, within),
            Some(Transfer::Expedited) => Some(Only::Expedited),
            Some(Transfer::Segmented) => Some(Only::Segmented),
            None => None,
        };
        self.sdo_upload_by(object, only, within).map(Ended::With)
    }

    fn download_by(
        &mut self,
        object: Multiplexer,
        value: &[u8],
        transfer: Option<Transfer>,
        within: Duration,
    ) -> Result<Ended<()>, Stop> {
        let only = match transfer {
            Some(Transfer::Block(block)) => {
                return self.sdo_block_download(object, value, &block, within);
            }
            Some(Transfer::Expedited) => Some(Only::Expedited),
            Some(Transfer::Segmented) => Some(Only::Segmented),
            None => None,
        };
        let outcome = self.sdo_download_by(object, value, only, within)?;
        Ok(Ended::With(outcome))
    }

    fn judge_refused_read(
        &mut self,
        object: Multiplexer,
        step: &SdoRead,
        code: AbortCode,
    ) -> Result<(), Stop> {
        match &step.expect {
            ReadExpectation::Abort(abort) | ReadExpectation::OneOfOrAbort(_, abort) => {
                self.check_abort(object, abort, code)
            }
            // A value is recorded whatever it is, so its absence is recorded as well.
            ReadExpectation::Any if step.observe.is_some() => {
                let words = step.observe.as_deref().unwrap_or_default();
                self.observe(words, format!("refused: {}", show_abort(code)));
                Ok(())
            }
            _ => Err(Stop::mismatch(
                format!("reading {object} is refused: {}", show_abort(code)),
                "a value",
                show_abort(code),
                Came::Abort(code.0),
            )),
        }
    }

    pub(super) fn sdo_write(&mut self, step: &SdoWrite) -> Result<(), Stop> {
        let object = self.resolve(step.object)?;
        let within = step.within.unwrap_or(self.device.timing.sdo_response);
        let bytes = encode(step.value_type, &step.value, step.unit, &self.saved)?;
        let by = protocol_words(step.transfer);
        let before = self.value_before(object, bytes.len())?;
        let is_remembered = self.remember_object(object, &before);
        let outcome = match self.download_by(object, &bytes, step.transfer, within)? {
            Ended::With(outcome) => outcome,
            Ended::GivenUp => {
                self.history
                    .add(format!("SDO write {object}{by}, given up by the tester"));
                return self.check_remembered(object, &before);
            }
        };
        if let Outcome::Refused(_) = outcome
            && is_remembered
        {
            self.undo.forget_last();
        }
        let end = match outcome {
            Outcome::Done(()) => "",
            Outcome::Refused(_) => ", which was refused",
        };
        self.judge_write(step, object, &bytes, before, outcome)?;
        let value = match decode(step.value_type, &bytes) {
            Some(value @ (Actual::Number(_) | Actual::Text(_))) => value.to_string(),
            _ => show_size(bytes.len()),
        };
        self.history
            .add(format!("SDO write {object} = {value}{by}{end}"));
        Ok(())
    }

    fn judge_write(
        &mut self,
        step: &SdoWrite,
        object: Multiplexer,
        bytes: &[u8],
        before: Option<Vec<u8>>,
        outcome: Outcome<()>,
    ) -> Result<(), Stop> {
        let within = step.within.unwrap_or(self.device.timing.sdo_response);
        match (&step.expect, outcome) {
            (WriteExpectation::Ok, Outcome::Done(())) => self.check_remembered(object, &before),
            (WriteExpectation::Ok, Outcome::Refused(code)) => Err(Stop::mismatch(
                format!("writing {object} is refused: {}", show_abort(code)),
                "it is accepted",
                show_abort(code),
                Came::Abort(code.0),
            )),
            (WriteExpectation::Abort(abort), Outcome::Refused(code)) => {
                self.check_abort(object, abort, code)
            }
            (WriteExpectation::Either(_), Outcome::Done(())) => {
                self.check_remembered(object, &before)?;
                self.check_holds(object, bytes, "it was accepted", within)
            }
            (WriteExpectation::Either(abort), Outcome::Refused(code)) => {
                self.check_abort(object, abort, code)?;
                match before {
                    Some(before) => self.check_holds(object, &before, "it was refused", within),
                    None => Ok(()),
                }
            }
            (WriteExpectation::Abort(abort), Outcome::Done(())) => Err(Stop::mismatch(
                format!(
                    "writing {object}{} is not refused: {} expected",
                    protocol_words(step.transfer),
                    self.show_accepted(abort)
                ),
                self.show_accepted(abort),
                "it is accepted",
                Came::Answer,
            )),
        }
    }

    /// Whether an object holds what the answer to the write said.
    fn check_holds(
        &mut self,
        object: Multiplexer,
        expected: &[u8],
        because: &str,
        within: Duration,
    ) -> Result<(), Stop> {
        let held = match self.sdo_upload(object, within)? {
            Outcome::Done(value) => value.of_size(Some(expected.len())).to_vec(),
            Outcome::Refused(code) => {
                return Err(Stop::mismatch(
                    format!("reading {object} back is refused"),
                    show_bytes(expected),
                    show_abort(code),
                    Came::Abort(code.0),
                ));
            }
        };
        if held == expected {
            return Ok(());
        }
        Err(Stop::differs(
            format!("{object} does not hold what the answer to the write said"),
            format!("{}, for {because}", show_bytes(expected)),
            show_bytes(&held),
            Came::Other,
        ))
    }

    fn check_abort(
        &mut self,
        object: Multiplexer,
        expected: &AbortExpectation,
        code: AbortCode,
    ) -> Result<(), Stop> {
        let passes = match expected.strict {
            Some(strict) if self.strict => code.0 == strict,
            _ => expected.abort.contains(&code.0) || expected.strict == Some(code.0),
        };
        if passes {
            return Ok(());
        }
        Err(Stop::differs(
            format!("{object} is refused with another abort code"),
            self.show_accepted(expected),
            show_abort(code),
            Came::Abort(code.0),
        ))
    }

    fn show_accepted(&self, expected: &AbortExpectation) -> String {
        let codes = match expected.strict {
            Some(strict) if self.strict => vec![strict],
            _ => expected.abort.clone(),
        };
        let codes: Vec<String> = codes
            .into_iter()
            .map(|code| show_abort(AbortCode(code)))
            .collect();
        format!("abort {}", codes.join(" or "))
    }

    fn check_read(
        &self,
        object: Multiplexer,
        by: &str,
        expect: &ReadExpectation,
        actual: &Actual,
    ) -> Result<(), Stop> {
        let saved = &self.saved;
        let wrong = |expected: String| {
            Err(Stop::differs(
                format!("{object}{by} holds another value"),
                expected,
                actual,
                came(actual),
            ))
        };
        match expect {
            ReadExpectation::Any | ReadExpectation::Abort(_) => Ok(()),
            ReadExpectation::Value(value) => {
                let expected = resolve(value, None, saved)?;
                if expected == *actual {
                    return Ok(());
                }
                match first_difference(&expected, actual) {
                    None => wrong(expected.to_string()),
                    Some(place) => Err(Stop::mismatch(
                        format!("{object}{by} holds another value from byte {place} on"),
                        expected.to_string(),
                        actual.to_string(),
                        came(actual),
                    )),
                }
            }
            ReadExpectation::OneOf(values) | ReadExpectation::OneOfOrAbort(values, _) => {
                let expected: Vec<Actual> = values
                    .iter()
                    .map(|value| resolve(value, None, saved))
                    .collect::<Result<_, _>>()?;
                if expected.contains(actual) {
                    return Ok(());
                }
                let names: Vec<String> = expected.iter().map(Actual::to_string).collect();
                wrong(format!("one of {}", names.join(", ")))
            }
            ReadExpectation::OtherThan(value) => {
                let unwanted = resolve(value, None, saved)?;
                if unwanted != *actual {
                    return Ok(());
                }
                Err(Stop::mismatch(
                    format!("{object} holds {actual}, which it must not"),
                    format!("any but {unwanted}"),
                    actual.to_string(),
                    came(actual),
                ))
            }
            ReadExpectation::Claimed(claim) => match self.device.identity.claimed(*claim) {
                None => Err(Stop::Bench(format!(
                    "the device claims no {}",
                    claim.name()
                ))),
                Some(claimed) => {
                    let expected = resolve(&claimed.value, None, saved)?;
                    match expected == *actual {
                        true => Ok(()),
                        false => wrong(format!(
                            "{expected}, the {} that the device claims",
                            claim.name()
                        )),
                    }
                }
            },
            ReadExpectation::Range { from, to } => match actual {
                Actual::Number(number) if number >= from && number <= to => Ok(()),
                _ => wrong(format!("{from} to {to}")),
            },
        }
    }
}

fn show_size(bytes: usize) -> String {
    match bytes {
        1 => "1 byte".to_owned(),
        _ => format!("{bytes} bytes"),
    }
}

/// By which protocol a value is to be written, where the step says it.
const fn protocol_words(transfer: Option<Transfer>) -> &'static str {
    match transfer {
        None | Some(Transfer::Expedited) => "",
        Some(Transfer::Segmented) => Protocol::Segmented.words(),
        Some(Transfer::Block(_)) => Protocol::Block.words(),
    }
}

/// The first byte in which two values of bytes differ, counted from 0.
fn first_difference(expected: &Actual, actual: &Actual) -> Option<usize> {
    let (Actual::Bytes(expected), Actual::Bytes(actual)) = (expected, actual) else {
        return None;
    };
    let pairs = expected.iter().zip(actual);
    Some(
        pairs
            .take_while(|(expected, actual)| expected == actual)
            .count(),
    )
}

fn came(actual: &Actual) -> Came {
    match actual {
        Actual::Number(number) => Came::Value(*number),
        Actual::Text(_) | Actual::Bytes(_) => Came::Answer,
    }
}
