//! The header that a request and its answer have on Modbus TCP.

use fieldproof_wire::modbus::tcp::{HEADER_LEN, RawTcp};
use fieldproof_wire::modbus::{Extent, response_extent};

use crate::modbus::{Answer, show_bytes};
use crate::stop::{Came, Stop};

/// Header and PDU, whatever the PDU is.
pub(crate) fn adu(transaction: u16, unit: u8, pdu: &[u8]) -> Vec<u8> {
    // A suite may say more than fits a frame, but never more than fits the length.
    let length = u16::try_from(pdu.len() + 1).unwrap_or(u16::MAX);
    let mut bytes = Vec::with_capacity(HEADER_LEN + pdu.len());
    bytes.extend(transaction.to_be_bytes());
    bytes.extend([0, 0]);
    bytes.extend(length.to_be_bytes());
    bytes.push(unit);
    bytes.extend_from_slice(pdu);
    bytes
}

/// The answer to a request with this transaction and unit.
pub(crate) fn read_answer(bytes: &[u8], transaction: u16, unit: u8) -> Result<Answer, Stop> {
    let wrong = |what: &str, expected: String, actual: String| {
        Stop::differs(what, expected, actual, Came::Other)
            .with_note(format!("the answer is {}", show_bytes(bytes)))
    };
    let raw = RawTcp(bytes);
    let (Some(came), Some(protocol), Some(length), Some(from), Some(pdu @ [_, ..])) = (
        raw.transaction(),
        raw.protocol(),
        raw.length(),
        raw.unit(),
        raw.pdu(),
    ) else {
        return Err(Stop::mismatch(
            "the answer is too short for a Modbus TCP frame",
            format!("at least {} bytes", HEADER_LEN + 1),
            show_bytes(bytes),
            Came::Other,
        ));
    };
    if protocol != 0 {
        return Err(wrong(
            "the protocol identifier of the answer is not that of Modbus",
            "0000h".into(),
            format!("{protocol:04X}h"),
        ));
    }
    check_length(length, pdu).map_err(|expected| {
        wrong(
            "the length field of the answer is not that of what it carries",
            expected,
            length.to_string(),
        )
    })?;
    if came != transaction {
        return Err(wrong(
            "the answer carries another transaction identifier than the request",
            format!("{transaction:04X}h"),
            format!("{came:04X}h"),
        ));
    }
    if from != unit {
        return Err(wrong(
            "the answer carries another unit identifier than the request",
            format!("{unit:02X}h"),
            format!("{from:02X}h"),
        ));
    }
    Ok(Answer {
        address: from,
        pdu: pdu.to_vec(),
    })
}

/// The length counts the unit and the PDU: as many bytes as came, and as the function has. Gives what was expected.
fn check_length(length: u16, pdu: &[u8]) -> Result<(), String> {
    let length = usize::from(length);
    if length != pdu.len() + 1 {
        return Err(format!("{}, as many bytes as came", pdu.len() + 1));
    }
    match response_extent(pdu) {
        Extent::Bytes(right) if right != pdu.len() => {
            Err(format!("{}, as the function code has it", right + 1))
        }
        Extent::NotYet => Err("more than a function code".into()),
        Extent::Bytes(_) | Extent::Open => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ANSWER: [u8; 11] = [0, 7, 0, 0, 0, 5, 0x20, 3, 2, 0x0F, 0xB4];

    /// What is wrong with the answer to transaction 7 of unit 20h.
    fn verdict(bytes: &[u8]) -> Result<Vec<u8>, String> {
        match read_answer(bytes, 7, 0x20) {
            Ok(answer) => Ok(answer.pdu),
            Err(Stop::Mismatch(mismatch)) => Err(mismatch.what),
            Err(other) => panic!("{other:?}"),
        }
    }

    fn with(at: usize, byte: u8) -> [u8; 11] {
        let mut bytes = ANSWER;
        bytes[at] = byte;
        bytes
    }

    #[test]
    fn a_request_has_its_header() {
        let request = [0x01, 0x02, 0, 0, 0, 6, 0x20, 3, 0, 0, 0, 1];
        assert_eq!(adu(0x0102, 0x20, &request[7..]), request);
        assert_eq!(adu(1, 2, &[]), [0, 1, 0, 0, 0, 1, 2]);
    }

    #[test]
    fn every_field_of_an_answer_is_judged() {
        assert_eq!(verdict(&ANSWER), Ok(vec![3, 2, 0x0F, 0xB4]));
        let cases: [(&[u8], &str); 8] = [
            (
                &with(1, 8),
                "the answer carries another transaction identifier than the request: 0008h, and not 0007h",
            ),
            (
                &with(3, 1),
                "the protocol identifier of the answer is not that of Modbus: 0001h, and not 0000h",
            ),
            (
                &with(5, 6),
                "the length field of the answer is not that of what it carries: 6, and not 5, as many bytes as came",
            ),
            (
                &with(6, 1),
                "the answer carries another unit identifier than the request: 01h, and not 20h",
            ),
            (
                &with(8, 4),
                "the length field of the answer is not that of what it carries: 5, and not 7, as the function code has it",
            ),
            (
                &ANSWER[..7],
                "the answer is too short for a Modbus TCP frame",
            ),
            (
                &[0, 7, 0, 0, 0, 2, 0x20, 3],
                "the length field of the answer is not that of what it carries: 2, and not more than a function code",
            ),
            (&[], "the answer is too short for a Modbus TCP frame"),
        ];
        for (bytes, words) in cases {
            assert_eq!(verdict(bytes), Err(words.to_owned()));
        }
    }
}
