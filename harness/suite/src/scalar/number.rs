//! Numbers: whole, decimal, a scale.

use schemars::{Schema, json_schema};

use super::text::read_as_text;
use super::{Decimal, Number, Text};
use crate::code;
use crate::expand::whole;
use crate::problem::Wrong;
use crate::read::ask;

/// `100`, `-100`, `0x64`, `64h`; `None` for anything else and beyond 64 bits.
pub(crate) fn whole_number(text: &str) -> Option<i128> {
    let (negative, digits) = match text.strip_prefix('-') {
        Some(digits) => (true, digits),
        None => (false, text),
    };
    let hexadecimal = digits
        .strip_prefix("0x")
        .or_else(|| digits.strip_suffix('h'));
    let (digits, radix) = match hexadecimal {
        Some(digits) => (digits, 16),
        None => (digits, 10),
    };
    if !digits.starts_with(|first: char| first.is_ascii_hexdigit()) {
        return None;
    }
    let magnitude = i128::from(u64::from_str_radix(digits, radix).ok()?);
    Some(if negative { -magnitude } else { magnitude })
}

impl Text for Number {
    const ASK: &'static str = ask::SAVEABLE;
    const EXPECTED: &'static str = "a whole number";

    fn parse(text: &str) -> Result<Number, Wrong> {
        if let Some(name) = whole(text) {
            return Ok(Number::Saved(name.to_owned()));
        }
        whole_number(text).map(Number::Literal).ok_or_else(|| {
            Wrong::new(
                code::NUMBER,
                format!("`{text}` is not a whole number"),
                "expected a number such as 100, 0x64 or 64h",
            )
        })
    }

    fn schema() -> Schema {
        json_schema!({"type": ["integer", "string"]})
    }
}

impl Text for Decimal {
    const EXPECTED: &'static str = "a decimal number";

    fn parse(text: &str) -> Result<Decimal, Wrong> {
        let wrong = || {
            Wrong::new(
                code::DECIMAL,
                format!("`{text}` is not a decimal number"),
                "expected a number such as 281.0248",
            )
        };
        if let Some(number) = whole_number(text) {
            let digits = i64::try_from(number).map_err(|_| wrong())?;
            return Ok(Decimal {
                digits,
                decimals: 0,
            });
        }
        let (digits, decimals) = decimal(text).ok_or_else(wrong)?;
        Ok(Decimal { digits, decimals })
    }

    fn schema() -> Schema {
        json_schema!({"type": ["number", "string"]})
    }
}

/// The digits of `-281.0248` as a number, and how many stand after the point; at most 18 digits.
pub(crate) fn decimal(text: &str) -> Option<(i64, u32)> {
    let (before, after) = text.split_once('.').unwrap_or((text, ""));
    let unsigned = before.strip_prefix('-').unwrap_or(before);
    let is_digits = |part: &str| part.chars().all(|c| c.is_ascii_digit());
    let point_without_digits = text.contains('.') && after.is_empty();
    if unsigned.is_empty() || point_without_digits || !is_digits(unsigned) || !is_digits(after) {
        return None;
    }
    if unsigned.len() + after.len() > 18 {
        return None;
    }
    let digits = format!("{before}{after}").parse().ok()?;
    Some((digits, after.len() as u32))
}

/// What raw counts are multiplied with: `1/50`, `0.02`, `10`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Scale {
    pub(crate) multiply: i64,
    pub(crate) divide: i64,
}

impl Text for Scale {
    const EXPECTED: &'static str = "a scale such as 1/50 or 0.02";

    fn parse(text: &str) -> Result<Scale, Wrong> {
        let fraction = |text: &str| {
            let (above, below) = text.split_once('/').unwrap_or((text, "1"));
            let (multiply, decimals) = decimal(above.trim())?;
            let divide: i64 = below.trim().parse().ok().filter(|divide| *divide > 0)?;
            let divide = divide.checked_mul(10i64.checked_pow(decimals)?)?;
            (multiply != 0).then_some(Scale { multiply, divide })
        };
        fraction(text).ok_or_else(|| {
            Wrong::new(
                code::DECIMAL,
                format!("`{text}` is not a scale"),
                "expected a scale such as 1/50, 0.02 or 10",
            )
        })
    }

    fn schema() -> Schema {
        json_schema!({"type": ["number", "string"]})
    }
}

read_as_text!(Number, Decimal, Scale);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_are_read() {
        for (text, expected) in [
            ("100", Some(100)),
            ("-100", Some(-100)),
            ("0x64", Some(100)),
            ("64h", Some(100)),
            ("-0x1", Some(-1)),
            ("FFFFFFFFFFFFFFFFh", Some(i128::from(u64::MAX))),
            ("1FFFFFFFFFFFFFFFFh", None),
            ("", None),
            ("h", None),
            ("0x", None),
            ("64", Some(64)),
            ("6 4", None),
            ("+5", None),
            ("1.5", None),
            ("FF", None),
        ] {
            assert_eq!(whole_number(text), expected, "{text}");
        }
    }

    #[test]
    fn decimals_and_scales_are_exact() {
        let decimal = |text| Decimal::parse(text).map(|read| (read.digits, read.decimals));
        assert_eq!(decimal("281.0248"), Ok((2_810_248, 4)));
        assert_eq!(decimal("-0.5"), Ok((-5, 1)));
        assert_eq!(decimal("0x10"), Ok((16, 0)));
        for text in ["1.", ".5", "1e3", "1.2.3", "", "12345678901234567890"] {
            assert_eq!(decimal(text).unwrap_err().code, code::DECIMAL, "{text}");
        }
        let scale = |text| Scale::parse(text).map(|read| (read.multiply, read.divide));
        assert_eq!(scale("1/50"), Ok((1, 50)));
        assert_eq!(scale("0.02"), Ok((2, 100)));
        assert_eq!(scale("10"), Ok((10, 1)));
        for text in ["1/0", "1/-2", "0", "x"] {
            assert_eq!(scale(text).unwrap_err().code, code::DECIMAL, "{text}");
        }
    }
}
