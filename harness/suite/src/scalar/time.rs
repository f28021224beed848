//! Durations, their tolerances, bit rates.

use std::time::Duration;

use schemars::{Schema, json_schema};

use super::number::decimal;
use super::text::read_as_text;
use super::{Text, Tolerance};
use crate::code;
use crate::model::PauseLength;
use crate::problem::{Wrong, nearest};

/// Nanoseconds in each unit.
const UNITS: [(&str, u64); 5] = [
    ("us", 1_000),
    ("µs", 1_000),
    ("ms", 1_000_000),
    ("s", 1_000_000_000),
    ("min", 60_000_000_000),
];

/// `50 ms`
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Time(pub(crate) Duration);

/// What one count of an object is: `100 us`, or `ms` for one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct TimeUnit(pub(crate) Duration);

/// `250 kbit/s`, `9600`: bits a second.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct BitRate(pub(crate) u32);

/// The number in front of a unit, and the unit.
fn number_and_unit(text: &str) -> (&str, &str) {
    let end = text
        .find(|c: char| !c.is_ascii_digit() && c != '.')
        .unwrap_or(text.len());
    (&text[..end], text[end..].trim_start())
}

fn duration(text: &str) -> Result<Duration, Wrong> {
    let wrong = |message: String| {
        Wrong::new(
            code::DURATION,
            message,
            "expected a duration such as 100 us, 50 ms, 2 s or 1 min",
        )
    };
    if let Some(digits) = text.strip_prefix("0x") {
        let what = match digits.chars().all(|digit| digit.is_ascii_hexdigit()) {
            true => "is too large a number",
            false => "is not a number",
        };
        let label = "expected hexadecimal digits, 64 bits at most";
        return Err(Wrong::new(code::NUMBER, format!("`{text}` {what}"), label));
    }
    let (number, unit) = number_and_unit(text);
    let Some((digits, decimals)) = decimal(number) else {
        return Err(wrong(format!("`{text}` is not a duration")));
    };
    if unit.is_empty() {
        let help = format!("did you mean `{text} ms`?");
        return Err(wrong(format!("`{text}` has no unit")).help(help));
    }
    let Some((_, nanoseconds)) = UNITS.iter().find(|(name, _)| *name == unit) else {
        let wrong = wrong(format!("`{unit}` is not a unit of time"));
        return Err(match nearest_unit(unit) {
            Some(unit) => wrong.help(format!("did you mean `{number} {unit}`?")),
            None => wrong,
        });
    };
    let product = i128::from(digits) * i128::from(*nanoseconds);
    let divisor = 10i128.pow(decimals);
    if product % divisor != 0 {
        return Err(wrong(format!("`{text}` is finer than a nanosecond")));
    }
    let total =
        u64::try_from(product / divisor).map_err(|_| wrong(format!("`{text}` is too long")))?;
    Ok(Duration::from_nanos(total))
}

fn nearest_unit(unit: &str) -> Option<&'static str> {
    match unit.to_lowercase().as_str() {
        "sec" | "secs" | "second" | "seconds" => Some("s"),
        "msec" | "millisecond" | "milliseconds" => Some("ms"),
        "usec" | "μs" | "microsecond" | "microseconds" => Some("us"),
        "m" | "minute" | "minutes" => Some("min"),
        lower => nearest(lower, &["us", "ms", "min"])
            .and_then(|near| ["us", "ms", "min"].into_iter().find(|known| *known == near)),
    }
}

impl Text for Time {
    const EXPECTED: &'static str = "a duration such as 50 ms";

    fn parse(text: &str) -> Result<Time, Wrong> {
        duration(text).map(Time)
    }

    fn schema() -> Schema {
        json_schema!({"type": "string", "pattern": "^[0-9.]+ ?(us|µs|ms|s|min)$"})
    }
}

impl Text for PauseLength {
    const EXPECTED: &'static str = "a duration such as 20 ms, or 2.5 characters";

    fn parse(text: &str) -> Result<PauseLength, Wrong> {
        let Some(number) = text.strip_suffix("characters").map(str::trim_end) else {
            return duration(text).map(PauseLength::Time);
        };
        let thousandths = decimal(number).and_then(|(digits, decimals)| {
            let scale = 10i64.checked_pow(3u32.checked_sub(decimals)?)?;
            u32::try_from(digits.checked_mul(scale)?).ok()
        });
        thousandths.map(PauseLength::Characters).ok_or_else(|| {
            Wrong::new(
                code::DURATION,
                format!("`{text}` is no number of characters"),
                "expected characters such as 2.5 characters",
            )
        })
    }

    fn schema() -> Schema {
        json_schema!({"type": "string", "pattern": "^[0-9.]+ ?(us|µs|ms|s|min|characters)$"})
    }
}

impl Text for TimeUnit {
    const EXPECTED: &'static str = "what one count is, such as ms or 100 us";

    fn parse(text: &str) -> Result<TimeUnit, Wrong> {
        let one = UNITS.iter().find(|(name, _)| *name == text);
        let unit = match one {
            Some((_, nanoseconds)) => Duration::from_nanos(*nanoseconds),
            None => duration(text)?,
        };
        if unit.is_zero() {
            return Err(Wrong::new(
                code::DURATION,
                "a count of no time",
                "expected a unit such as ms or 100 us",
            ));
        }
        Ok(TimeUnit(unit))
    }

    fn schema() -> Schema {
        json_schema!({"type": "string", "pattern": "^([0-9.]+ ?)?(us|µs|ms|s|min)$"})
    }
}

impl Text for Tolerance {
    const EXPECTED: &'static str = "a limit such as 100 ms ± 5 %";

    fn parse(text: &str) -> Result<Tolerance, Wrong> {
        let label = "expected a limit such as 100 ms ± 5 % or 100 ms ± 2 ms";
        let Some((nominal, tolerance)) = text.split_once('±').or_else(|| text.split_once("+-"))
        else {
            let message = format!("`{text}` has no tolerance");
            return Err(Wrong::new(code::TOLERANCE, message, label));
        };
        let nominal = duration(nominal.trim())?;
        let tolerance = tolerance.trim();
        let tolerance = match tolerance.strip_suffix('%') {
            Some(percent) => percent_of(nominal, percent.trim()),
            None => Some(duration(tolerance)?),
        };
        match tolerance {
            Some(tolerance) => Ok(Tolerance { nominal, tolerance }),
            None => {
                let message = format!("`{text}` is not a limit");
                Err(Wrong::new(code::TOLERANCE, message, label))
            }
        }
    }

    fn schema() -> Schema {
        json_schema!({"type": "string", "pattern": "(±|\\+-)"})
    }
}

fn percent_of(nominal: Duration, percent: &str) -> Option<Duration> {
    let (digits, decimals) = decimal(percent)?;
    let nominal = i128::try_from(nominal.as_nanos()).ok()?;
    let product = nominal.checked_mul(i128::from(digits))?;
    let nanoseconds = product / 10i128.pow(decimals + 2);
    u64::try_from(nanoseconds).ok().map(Duration::from_nanos)
}

impl Text for BitRate {
    const EXPECTED: &'static str = "a bit rate such as 250 kbit/s";

    fn parse(text: &str) -> Result<BitRate, Wrong> {
        let label = "expected a bit rate such as 250 kbit/s, 1 Mbit/s or 9600";
        let wrong = |message: String| Wrong::new(code::RATE, message, label);
        let (number, unit) = number_and_unit(text);
        let Some((digits, decimals)) = decimal(number) else {
            return Err(wrong(format!("`{text}` is not a bit rate")));
        };
        let factor = match unit {
            "" | "bit/s" | "baud" => 1,
            "kbit/s" => 1_000,
            "Mbit/s" => 1_000_000,
            _ => {
                let wrong = wrong(format!("`{unit}` is not a unit of bit rates"));
                return Err(match unit.to_lowercase().as_str() {
                    "k" | "kb" | "kbit" | "kbps" | "kb/s" | "kbaud" | "kbit/s" => {
                        wrong.help(format!("did you mean `{number} kbit/s`?"))
                    }
                    "m" | "mb" | "mbit" | "mbps" | "mb/s" | "mbaud" | "mbit/s" => {
                        wrong.help(format!("did you mean `{number} Mbit/s`?"))
                    }
                    _ => wrong,
                });
            }
        };
        let product = i128::from(digits) * factor;
        let divisor = 10i128.pow(decimals);
        match u32::try_from(product / divisor) {
            Ok(rate) if rate > 0 && product % divisor == 0 => Ok(BitRate(rate)),
            _ => Err(wrong(format!("`{text}` is not a bit rate"))),
        }
    }

    fn schema() -> Schema {
        json_schema!({
            "type": ["integer", "string"],
            "pattern": "^[0-9.]+ ?(bit/s|baud|kbit/s|Mbit/s)?$"
        })
    }
}

read_as_text!(Time, TimeUnit, Tolerance, BitRate, PauseLength);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pause_is_a_time_or_characters() {
        let read = |text| PauseLength::parse(text).ok();
        assert_eq!(
            read("20 ms"),
            Some(PauseLength::Time(Duration::from_millis(20)))
        );
        for (text, thousandths) in [
            ("2.5 characters", 2_500),
            ("1 characters", 1_000),
            ("0.125characters", 125),
        ] {
            assert_eq!(read(text), Some(PauseLength::Characters(thousandths)));
        }
        for text in [
            "2.5",
            "characters",
            "1.2345 characters",
            "-1 characters",
            "x characters",
        ] {
            assert_eq!(read(text), None, "{text}");
        }
    }

    #[test]
    fn durations_have_units() {
        let nanoseconds = |text| Time::parse(text).map(|time| time.0.as_nanos());
        assert_eq!(nanoseconds("50 ms"), Ok(50_000_000));
        assert_eq!(nanoseconds("100us"), Ok(100_000));
        assert_eq!(nanoseconds("1.5 s"), Ok(1_500_000_000));
        assert_eq!(nanoseconds("1 min"), Ok(60_000_000_000));
        for (text, message, help) in [
            ("50", "`50` has no unit", "did you mean `50 ms`?"),
            (
                "50 mS",
                "`mS` is not a unit of time",
                "did you mean `50 ms`?",
            ),
            (
                "2 sec",
                "`sec` is not a unit of time",
                "did you mean `2 s`?",
            ),
            ("2 parsec", "`parsec` is not a unit of time", ""),
            ("soon", "`soon` is not a duration", ""),
            ("-1 ms", "`-1 ms` is not a duration", ""),
            (
                "0.0000001 ms",
                "`0.0000001 ms` is finer than a nanosecond",
                "",
            ),
            (
                "999999999999999 min",
                "`999999999999999 min` is too long",
                "",
            ),
        ] {
            let wrong = Time::parse(text).unwrap_err();
            assert_eq!(wrong.message, message);
            assert_eq!(wrong.help.unwrap_or_default(), help);
        }
    }

    #[test]
    fn tolerances_are_times_or_percent() {
        let read = |text| {
            Tolerance::parse(text)
                .map(|read| (read.nominal.as_micros(), read.tolerance.as_micros()))
        };
        assert_eq!(read("100 ms ± 5 %"), Ok((100_000, 5_000)));
        assert_eq!(read("1 s +- 0.5%"), Ok((1_000_000, 5_000)));
        assert_eq!(read("100 ms ± 2 ms"), Ok((100_000, 2_000)));
        for text in ["100 ms", "100 ms ± x %", "100 ms ± 999999999999999999 %"] {
            assert_eq!(read(text).unwrap_err().code, code::TOLERANCE, "{text}");
        }
        assert_eq!(read("100 ms ± 5").unwrap_err().code, code::DURATION);
    }

    #[test]
    fn bit_rates_are_read() {
        let rate = |text| BitRate::parse(text).map(|rate| rate.0);
        assert_eq!(rate("250 kbit/s"), Ok(250_000));
        assert_eq!(rate("1 Mbit/s"), Ok(1_000_000));
        assert_eq!(rate("83.333 kbit/s"), Ok(83_333));
        assert_eq!(rate("9600"), Ok(9600));
        for text in ["250k", "0", "", "5000 Mbit/s", "0.5", "fast"] {
            assert_eq!(rate(text).unwrap_err().code, code::RATE, "{text}");
        }
    }
}
