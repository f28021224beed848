//! How long a response is, from its first bytes: where nothing else says where one ends.

use super::FunctionCode;

/// How long a response PDU is, as far as its first bytes tell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// That many bytes, the function code among them.
    Bytes(usize),
    /// More bytes will tell.
    NotYet,
    /// The function has no fixed length and no byte count in front.
    Open,
}

/// The extent of the response PDU that begins with `start`.
///
/// | function | bytes |
/// | --- | --- |
/// | 80h and above | 2: function, exception code |
/// | 01h to 04h, 11h, 17h | 2 and as many as byte 1 says |
/// | 05h, 06h, 0Bh, 0Fh, 10h | 5 |
/// | 16h | 7 |
/// | all others | open |
///
/// The answer to 0Bh has two words like that to 06h.
pub fn response_extent(start: &[u8]) -> Extent {
    let Some(function) = start.first() else {
        return Extent::NotYet;
    };
    match FunctionCode(*function) {
        FunctionCode(0x80..) => Extent::Bytes(2),
        FunctionCode::READ_COILS
        | FunctionCode::READ_DISCRETE_INPUTS
        | FunctionCode::READ_HOLDING_REGISTERS
        | FunctionCode::READ_INPUT_REGISTERS
        | FunctionCode::REPORT_SERVER_ID
        | FunctionCode::READ_WRITE_MULTIPLE_REGISTERS => match start.get(1) {
            Some(count) => Extent::Bytes(2 + usize::from(*count)),
            None => Extent::NotYet,
        },
        FunctionCode::WRITE_SINGLE_COIL
        | FunctionCode::WRITE_SINGLE_REGISTER
        | FunctionCode::GET_COMM_EVENT_COUNTER
        | FunctionCode::WRITE_MULTIPLE_COILS
        | FunctionCode::WRITE_MULTIPLE_REGISTERS => Extent::Bytes(5),
        FunctionCode::MASK_WRITE_REGISTER => Extent::Bytes(7),
        _ => Extent::Open,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::modbus::Response;
    use proptest::prelude::*;

    #[test]
    fn the_first_bytes_tell() {
        assert_eq!(response_extent(&[]), Extent::NotYet);
        assert_eq!(response_extent(&[0x03]), Extent::NotYet);
        assert_eq!(response_extent(&[0x03, 250]), Extent::Bytes(252));
        assert_eq!(response_extent(&[0x06]), Extent::Bytes(5));
        assert_eq!(response_extent(&[0x83]), Extent::Bytes(2));
        assert_eq!(response_extent(&[0x2B, 0x0E]), Extent::Open);
        assert_eq!(response_extent(&[0x00]), Extent::Open);
    }

    proptest! {
        #[test]
        fn whatever_is_a_response_has_its_extent(
            function in 1..=0x2Bu8,
            rest in proptest::collection::vec(0u8..8, 0..12),
        ) {
            let bytes = [&[function], rest.as_slice()].concat();
            if Response::parse(&bytes).is_ok() {
                let extent = response_extent(&bytes);
                prop_assert!(matches!(extent, Extent::Open) || extent == Extent::Bytes(bytes.len()), "{extent:?}");
            }
        }
    }
}
