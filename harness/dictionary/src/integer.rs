//! Integers as EDS files write them.

/// An integer as it was written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Integer {
    pub(crate) value: i128,
    /// Written in hexadecimal: so it may be the bit pattern of a negative number.
    pub(crate) hexadecimal: bool,
}

impl Integer {
    /// Decimal, `0x` or `0X` hexadecimal, or octal with a leading 0; each with an optional sign.
    pub(crate) fn parse(text: &str) -> Option<Integer> {
        let text = text.trim();
        let (negative, digits) = match text.strip_prefix('-') {
            Some(rest) => (true, rest),
            None => (false, text.strip_prefix('+').unwrap_or(text)),
        };
        let hexadecimal = digits
            .strip_prefix("0x")
            .or_else(|| digits.strip_prefix("0X"));
        let (digits, radix) = match hexadecimal {
            Some(rest) => (rest, 16),
            None if digits.len() > 1 && digits.starts_with('0') => (digits, 8),
            None => (digits, 10),
        };
        if digits.starts_with(['+', '-']) {
            return None;
        }
        // Nothing in either format needs more than 64 bits, and sums of such numbers must not overflow.
        let magnitude = i128::from(u64::from_str_radix(digits, radix).ok()?);
        Some(Integer {
            value: if negative { -magnitude } else { magnitude },
            hexadecimal: radix == 16 && !negative,
        })
    }

    /// The value, where a hexadecimal number with the top bit of `bits` set means the negative number of that pattern.
    pub(crate) fn as_signed(self, bits: u32) -> i128 {
        let sign = 1_i128 << (bits.clamp(1, 64) - 1);
        if self.hexadecimal && self.value >= sign && self.value < sign * 2 {
            self.value - sign * 2
        } else {
            self.value
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Integer;

    fn value(text: &str) -> Option<i128> {
        Integer::parse(text).map(|integer| integer.value)
    }

    #[test]
    fn every_base() {
        assert_eq!(value("48"), Some(48));
        assert_eq!(value("0x1F"), Some(31));
        assert_eq!(value("0XFE"), Some(254));
        assert_eq!(value("017"), Some(15));
        assert_eq!(value("0"), Some(0));
        assert_eq!(value("00"), Some(0));
        assert_eq!(value("-32768"), Some(-32768));
        assert_eq!(value(" 0x0000000A "), Some(10));
        assert_eq!(value("18446744073709551615"), Some(i128::from(u64::MAX)));
    }

    #[test]
    fn what_is_no_integer() {
        for text in [
            "",
            "-",
            "0x",
            "08",
            "1.5",
            "1 2",
            "--1",
            "0x-1",
            "+-1",
            "18446744073709551616",
            "abc",
            "１",
        ] {
            assert_eq!(value(text), None, "{text:?}");
        }
    }

    #[test]
    fn a_hexadecimal_pattern_may_be_negative() {
        let pattern = |text: &str, bits| Integer::parse(text).unwrap().as_signed(bits);
        assert_eq!(pattern("0x8000", 16), -32768);
        assert_eq!(pattern("0xFFFF", 16), -1);
        assert_eq!(pattern("0x7FFF", 16), 32767);
        assert_eq!(pattern("0xFFFF", 32), 65535);
        assert_eq!(pattern("65535", 16), 65535);
        assert_eq!(pattern("0xFFFFFFFFFFFFFFFF", 64), -1);
    }
}
