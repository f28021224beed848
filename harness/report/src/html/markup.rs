//! Text into HTML, and numbers as people read them.

use std::borrow::Cow;

use fieldproof_record::Verdict;

/// `text` with nothing in it that HTML would take for its own.
pub(crate) fn escape(text: &str) -> Cow<'_, str> {
    if !text.contains(['&', '<', '>', '"', '\'']) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            other => escaped.push(other),
        }
    }
    Cow::Owned(escaped)
}

/// `13,643`
pub(super) fn count(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// `1 case`, `13,643 cases`
pub(super) fn cases(number: u64) -> String {
    match number {
        1 => "1 case".to_owned(),
        _ => format!("{} cases", count(number)),
    }
}

/// `213 µs`, `1.5 ms`, `2 s`: four digits that count.
pub(crate) fn time(nanoseconds: u64) -> String {
    let (unit, name) = match nanoseconds {
        0 => return "0 ms".to_owned(),
        1..1_000 => (1.0, "ns"),
        1_000..1_000_000 => (1e3, "µs"),
        1_000_000..1_000_000_000 => (1e6, "ms"),
        _ => (1e9, "s"),
    };
    let value = nanoseconds as f64 / unit;
    let decimals = match value {
        100.0.. => 1,
        10.0.. => 2,
        _ => 3,
    };
    let text = format!("{value:.decimals$}");
    let text = match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.'),
        false => &text,
    };
    format!("{text} {name}")
}

/// A sign for those who cannot tell the colours.
pub(super) const fn sign(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Pass => "✓",
        Verdict::Skipped => "–",
        Verdict::Deviation => "≈",
        Verdict::Inconclusive => "?",
        Verdict::Fail => "✗",
        Verdict::Error => "!",
    }
}

/// A verdict as it stands before a case.
pub(crate) fn badge(verdict: Verdict) -> String {
    let (name, sign) = (verdict.name(), sign(verdict));
    format!("<span class=\"badge {name}\"><span aria-hidden=\"true\">{sign}</span> {name}</span>")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_cannot_become_markup() {
        assert_eq!(
            escape("<script>alert('x') & \"y\"</script>"),
            "&lt;script&gt;alert(&#39;x&#39;) &amp; &quot;y&quot;&lt;/script&gt;"
        );
        assert!(matches!(escape("581#43"), Cow::Borrowed(_)));
    }

    #[test]
    fn numbers_read_well() {
        assert_eq!(count(0), "0");
        assert_eq!(count(999), "999");
        assert_eq!(count(13_643), "13,643");
        assert_eq!(count(1_000_000), "1,000,000");
        assert_eq!(cases(1), "1 case");
        assert_eq!(time(0), "0 ms");
        assert_eq!(time(213_400), "213.4 µs");
        assert_eq!(time(1_500_000_000), "1.5 s");
        assert_eq!(time(100_000_000), "100 ms");
        assert_eq!(time(999), "999 ns");
    }
}
