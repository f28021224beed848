//! The CRC of block transfers.

/// CRC-16 of CiA 301: polynomial x^16 + x^12 + x^5 + 1, most significant bit first. It begins with `initial`, which is 0.
pub(super) fn crc(initial: u16, data: &[u8]) -> u16 {
    data.iter().fold(initial, |crc, byte| {
        (0..8).fold(crc ^ u16::from(*byte) << 8, |crc, _| {
            let carry = crc & 0x8000 != 0;
            crc << 1 ^ if carry { 0x1021 } else { 0 }
        })
    })
}

#[test]
fn the_check_value_comes_out() {
    assert_eq!(crc(0, b"123456789"), 0x31C3);
    assert_eq!(crc(0, &[]), 0);
    assert_eq!(crc(0xFFFF, b"123456789"), 0x29B1);
}
