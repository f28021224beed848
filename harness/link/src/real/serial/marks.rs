//! Characters with a wrong parity or stop bit, as a terminal of the system marks them.

use crate::Character;

/// What begins a mark, and a byte FFh of its own when doubled.
const ESCAPE: u8 = 0xFF;

/// Reads what a terminal set to PARMRK gives:
///
/// | bytes | character |
/// | --- | --- |
/// | `FF FF` | FFh |
/// | `FF 00 x` | x, with a wrong parity or stop bit; a break is `FF 00 00` |
/// | `x` | x |
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) enum Marks {
    #[default]
    Plain,
    Escaped,
    Marked,
}

impl Marks {
    /// The character that `byte` completes.
    pub(super) fn take(&mut self, byte: u8) -> Option<Character> {
        let spoilt = *self == Marks::Marked;
        *self = match (*self, byte) {
            (Marks::Plain, ESCAPE) => Marks::Escaped,
            (Marks::Escaped, 0) => Marks::Marked,
            // After an escape nothing else can come but its second half.
            (Marks::Plain | Marks::Escaped | Marks::Marked, _) => Marks::Plain,
        };
        (*self == Marks::Plain).then_some(Character { byte, spoilt })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Vec<(u8, bool)> {
        let mut marks = Marks::default();
        let characters = bytes.iter().filter_map(|&byte| marks.take(byte));
        characters.map(|it| (it.byte, it.spoilt)).collect()
    }

    #[test]
    fn plain_bytes_are_characters() {
        assert_eq!(
            read(&[0x01, 0x00, 0x7F]),
            [(0x01, false), (0, false), (0x7F, false)]
        );
    }

    #[test]
    fn a_doubled_escape_is_one_character() {
        assert_eq!(read(&[0xFF, 0xFF, 0x00]), [(0xFF, false), (0x00, false)]);
    }

    #[test]
    fn a_marked_character_is_spoilt_whatever_it_is() {
        assert_eq!(
            read(&[0xFF, 0x00, 0x41, 0x42]),
            [(0x41, true), (0x42, false)]
        );
        assert_eq!(read(&[0xFF, 0x00, 0x00]), [(0x00, true)]);
        assert_eq!(
            read(&[0xFF, 0x00, 0xFF, 0x01]),
            [(0xFF, true), (0x01, false)]
        );
    }

    #[test]
    fn an_escape_may_be_all_that_has_come_yet() {
        let mut marks = Marks::default();
        assert_eq!(marks.take(0xFF), None);
        assert_eq!(marks.take(0x00), None);
        assert_eq!(marks.take(0x55).map(|it| it.spoilt), Some(true));
    }
}
