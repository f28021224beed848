//! CRC-16 as Modbus RTU uses it: polynomial 8005h reflected, from FFFFh, low byte first on the wire.

const TABLE: [u16; 256] = table();

const fn table() -> [u16; 256] {
    let mut table = [0; 256];
    let mut index = 0;
    while index < 256 {
        let mut crc = index as u16;
        let mut bit = 0;
        while bit < 8 {
            crc = if crc & 1 == 1 {
                crc >> 1 ^ 0xA001
            } else {
                crc >> 1
            };
            bit += 1;
        }
        table[index] = crc;
        index += 1;
    }
    table
}

/// The CRC of `bytes`.
pub fn crc16(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0xFFFF, |crc, byte| {
        let [low, _] = crc.to_le_bytes();
        crc >> 8 ^ TABLE[usize::from(low ^ byte)]
    })
}

/// The CRC of `bytes` in the order of the wire: low byte first.
pub fn crc16_bytes(bytes: &[u8]) -> [u8; 2] {
    crc16(bytes).to_le_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn crc16_has_its_published_check_value() {
        // CRC-16/MODBUS in the catalogue of parametrised CRC algorithms: check 4B37, residue 0000.
        assert_eq!(crc16(b"123456789"), 0x4B37);
        assert_eq!(crc16(b""), 0xFFFF);
    }

    #[test]
    fn the_low_byte_goes_first() {
        // Read of one holding register of station 1, as every primer prints it.
        let request = [0x01, 0x03, 0x00, 0x00, 0x00, 0x01];
        assert_eq!(crc16_bytes(&request), [0x84, 0x0A]);
    }

    proptest! {
        #[test]
        fn the_crc_of_bytes_with_their_crc_is_zero(mut bytes: Vec<u8>) {
            bytes.extend(crc16_bytes(&bytes));
            prop_assert_eq!(crc16(&bytes), 0);
        }
    }
}
