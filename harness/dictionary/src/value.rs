//! Limits and defaults: numbers, some of them relative to the node-ID, and text.

use crate::DataType;

/// An integer, or an integer to be added to the node-ID (`$NODEID+0x180`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Number {
    /// The integer; what is added where the number is relative.
    pub offset: i128,
    /// Whether the node-ID is added.
    pub relative_to_node: bool,
}

impl Number {
    /// A number that is the same for every node.
    pub const fn absolute(value: i128) -> Number {
        Number {
            offset: value,
            relative_to_node: false,
        }
    }

    /// A number to which the node-ID is added.
    pub const fn relative(offset: i128) -> Number {
        Number {
            offset,
            relative_to_node: true,
        }
    }

    /// Its value for node `node`.
    pub const fn value(self, node: u8) -> i128 {
        if self.relative_to_node {
            self.offset.saturating_add(node as i128)
        } else {
            self.offset
        }
    }
}

/// The value of an entry after a reset to defaults.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Default {
    /// A number; for a REALn, its bit pattern.
    Number(Number),
    /// Text as the file has it: a string, bytes in hexadecimal, or a decimal fraction, by the data type.
    Text(String),
}

impl Default {
    /// The number for node `node`, if it is one.
    pub fn value(&self, node: u8) -> Option<i128> {
        match self {
            Default::Number(number) => Some(number.value(node)),
            Default::Text(_) => None,
        }
    }

    /// The bytes of this default in the type `data_type` for node `node`; `None` if it does not fit the type.
    ///
    /// | type | bytes |
    /// | --- | --- |
    /// | fixed size | little-endian, in the size of the type |
    /// | VISIBLE_STRING | the text |
    /// | UNICODE_STRING | the text in UTF-16, little-endian |
    /// | OCTET_STRING, DOMAIN | the bytes that pairs of hexadecimal digits give, else the text |
    pub fn bytes(&self, data_type: DataType, node: u8) -> Option<Vec<u8>> {
        match (self, data_type) {
            (Default::Number(number), _) => integer_bytes(number.value(node), data_type.bytes()?),
            (Default::Text(text), DataType::VisibleString) => Some(text.as_bytes().to_vec()),
            (Default::Text(text), DataType::UnicodeString) => Some(
                text.encode_utf16()
                    .flat_map(|unit| unit.to_le_bytes())
                    .collect(),
            ),
            (Default::Text(text), DataType::OctetString | DataType::Domain) => {
                Some(octets(text).unwrap_or_else(|| text.as_bytes().to_vec()))
            }
            (Default::Text(text), DataType::Real32) => {
                Some(text.trim().parse::<f32>().ok()?.to_le_bytes().to_vec())
            }
            (Default::Text(text), DataType::Real64) => {
                Some(text.trim().parse::<f64>().ok()?.to_le_bytes().to_vec())
            }
            (Default::Text(_), _) => None,
        }
    }
}

/// The low `size` bytes of `value` if it fits them, as a signed or as an unsigned number.
fn integer_bytes(value: i128, size: usize) -> Option<Vec<u8>> {
    integer_fits(value, size).then(|| value.to_le_bytes().into_iter().take(size).collect())
}

/// Whether `size` bytes, 1 to 8 of them, can hold `value`, as a signed or as an unsigned number.
pub(crate) fn integer_fits(value: i128, size: usize) -> bool {
    let bits = 8 * size.clamp(1, 8);
    value >= -(1_i128 << (bits - 1)) && value < 1_i128 << bits
}

/// Pairs of hexadecimal digits, with or without blanks between the pairs.
pub(crate) fn octets(text: &str) -> Option<Vec<u8>> {
    text.split_ascii_whitespace()
        .flat_map(|word| word.as_bytes().chunks(2))
        .map(|pair| match pair {
            [high, low] => Some(digit(*high)? << 4 | digit(*low)?),
            _ => None,
        })
        .collect()
}

fn digit(character: u8) -> Option<u8> {
    char::from(character)
        .to_digit(16)
        .and_then(|digit| u8::try_from(digit).ok())
}

#[cfg(test)]
mod tests {
    use super::{Default, Number};
    use crate::DataType;

    fn number(value: i128) -> Default {
        Default::Number(Number::absolute(value))
    }

    #[test]
    fn integers_are_little_endian_in_the_size_of_the_type() {
        assert_eq!(
            number(0x0002_0192).bytes(DataType::Unsigned32, 1),
            Some(vec![0x92, 0x01, 0x02, 0x00])
        );
        assert_eq!(
            number(-1).bytes(DataType::Integer16, 1),
            Some(vec![0xFF, 0xFF])
        );
        assert_eq!(
            number(1).bytes(DataType::Unsigned40, 1),
            Some(vec![1, 0, 0, 0, 0])
        );
        assert_eq!(number(1).bytes(DataType::Boolean, 1), Some(vec![1]));
        assert_eq!(
            number(i128::from(u64::MAX)).bytes(DataType::Unsigned64, 1),
            Some(vec![0xFF; 8])
        );
    }

    #[test]
    fn what_does_not_fit_gives_no_bytes() {
        assert_eq!(number(256).bytes(DataType::Unsigned8, 1), None);
        assert_eq!(number(-129).bytes(DataType::Integer8, 1), None);
        assert_eq!(number(0).bytes(DataType::Unknown(0x21), 1), None);
    }

    #[test]
    fn the_node_is_added_where_the_number_says_so() {
        let emergency = Default::Number(Number::relative(0x80));
        assert_eq!(emergency.value(0x20), Some(0xA0));
        assert_eq!(
            emergency.bytes(DataType::Unsigned32, 1),
            Some(vec![0x81, 0, 0, 0])
        );
    }

    #[test]
    fn text_by_the_type() {
        let text = |text: &str| Default::Text(text.to_owned());
        assert_eq!(
            text("V10").bytes(DataType::VisibleString, 1),
            Some(b"V10".to_vec())
        );
        assert_eq!(
            text("V").bytes(DataType::UnicodeString, 1),
            Some(vec![b'V', 0])
        );
        assert_eq!(
            text("0A ff").bytes(DataType::OctetString, 1),
            Some(vec![0x0A, 0xFF])
        );
        assert_eq!(
            text("0A f").bytes(DataType::OctetString, 1),
            Some(b"0A f".to_vec())
        );
        assert_eq!(
            text("1.5").bytes(DataType::Real32, 1),
            Some(1.5_f32.to_le_bytes().to_vec())
        );
        assert_eq!(text("1.5").bytes(DataType::Unsigned8, 1), None);
    }
}
