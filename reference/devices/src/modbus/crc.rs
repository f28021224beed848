//! The check of a Modbus RTU frame: CRC-16, polynomial A001h reflected, preset FFFFh, sent low byte first.

use super::CrcOrder;

/// The CRC of `bytes`.
pub fn crc16(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0xFFFF, |crc, byte| {
        (0..8).fold(crc ^ u16::from(*byte), |crc, _| {
            if crc & 1 == 0 {
                crc >> 1
            } else {
                (crc >> 1) ^ 0xA001
            }
        })
    })
}

/// `body` with its CRC after it, the two bytes in `order`.
pub fn with_crc(mut body: Vec<u8>, order: CrcOrder) -> Vec<u8> {
    let crc = crc16(&body);
    body.extend(match order {
        CrcOrder::LowByteFirst => crc.to_le_bytes(),
        CrcOrder::HighByteFirst => crc.to_be_bytes(),
    });
    body
}

/// Takes a frame apart into what is checked and whether the check is right; `None` if it is too short for both.
pub fn split(frame: &[u8]) -> Option<(&[u8], bool)> {
    let (body, check) = frame.split_last_chunk::<2>()?;
    Some((body, u16::from_le_bytes(*check) == crc16(body)))
}

/// Whether the first byte of the check is right, `body` being what it is of.
pub(crate) fn half_right(body: &[u8], frame: &[u8]) -> bool {
    frame.get(body.len()) == crc16(body).to_le_bytes().first()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_check_value() {
        assert_eq!(crc16(b"123456789"), 0x4B37);
        assert_eq!(crc16(b""), 0xFFFF);
    }

    #[test]
    fn low_byte_goes_first_unless_told_otherwise() {
        let body = vec![0x01, 0x86, 0x02];
        assert_eq!(
            with_crc(body.clone(), CrcOrder::LowByteFirst),
            [0x01, 0x86, 0x02, 0xC3, 0xA1]
        );
        assert_eq!(
            with_crc(body, CrcOrder::HighByteFirst),
            [0x01, 0x86, 0x02, 0xA1, 0xC3]
        );
    }

    #[test]
    fn split_tells_right_from_wrong() {
        assert_eq!(
            split(&[0x01, 0x86, 0x02, 0xC3, 0xA1]),
            Some(([0x01, 0x86, 0x02].as_slice(), true))
        );
        assert_eq!(
            split(&[0x01, 0x86, 0x02, 0xA1, 0xC3]),
            Some(([0x01, 0x86, 0x02].as_slice(), false))
        );
        assert_eq!(split(&[0x01]), None);
    }
}
