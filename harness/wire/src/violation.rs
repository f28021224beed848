//! Which rule bytes break.

use std::fmt;

/// The kind of a broken rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum Rule {
    /// A message has a fixed or a limited length.
    Length,
    /// A service has its identifier.
    Identifier,
    /// A service is a data frame or a remote frame.
    FrameKind,
    /// The command specifier, command or function code is one of those defined.
    Command,
    /// A number lies inside its limits.
    Range,
    /// A count says how many bytes follow.
    Count,
    /// What is reserved is zero.
    Reserved,
    /// The CRC is that of the bytes before it.
    Checksum,
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Rule::Length => "length",
            Rule::Identifier => "identifier",
            Rule::FrameKind => "kind of frame",
            Rule::Command => "command",
            Rule::Range => "range",
            Rule::Count => "byte count",
            Rule::Reserved => "reserved",
            Rule::Checksum => "checksum",
        })
    }
}

/// Bytes that break a rule of their protocol.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub struct Violation {
    /// Which rule.
    pub rule: Rule,
    /// The first byte concerned, from 0; for [`Rule::Length`] where the bytes end or should have ended, for
    /// [`Rule::Identifier`] and [`Rule::FrameKind`] 0.
    pub offset: usize,
    /// What is there.
    pub found: String,
    /// What should be.
    pub expected: String,
}

impl Violation {
    /// A violation in words.
    pub fn new(
        rule: Rule,
        offset: usize,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Violation {
        Violation {
            rule,
            offset,
            found: found.into(),
            expected: expected.into(),
        }
    }

    pub(crate) fn length(found: usize, expected: usize) -> Violation {
        Violation::new(
            Rule::Length,
            found.min(expected),
            plural(found, "byte"),
            plural(expected, "byte"),
        )
    }

    pub(crate) fn range(offset: usize, found: u64, lowest: u64, highest: u64) -> Violation {
        Violation::new(
            Rule::Range,
            offset,
            found.to_string(),
            format!("{lowest} to {highest}"),
        )
    }

    /// One byte is not what it must be.
    pub(crate) fn byte(
        rule: Rule,
        offset: usize,
        found: u8,
        expected: impl Into<String>,
    ) -> Violation {
        Violation::new(rule, offset, format!("{found:02X}h"), expected)
    }
}

impl fmt::Display for Violation {
    /// `range: found 126 at byte 3, expected 1 to 125`; without the place where it says nothing new.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Violation {
            rule,
            offset,
            found,
            expected,
        } = self;
        match rule {
            Rule::Length | Rule::Identifier | Rule::FrameKind => {
                write!(f, "{rule}: found {found}, expected {expected}")
            }
            _ => write!(
                f,
                "{rule}: found {found} at byte {offset}, expected {expected}"
            ),
        }
    }
}

/// `1 byte`, `2 bytes`
pub(crate) fn plural(count: usize, noun: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{ending}")
}

/// `bytes` as an array, if it is as long.
pub(crate) fn exactly<const LEN: usize>(bytes: &[u8]) -> Result<[u8; LEN], Violation> {
    bytes
        .try_into()
        .map_err(|_| Violation::length(bytes.len(), LEN))
}

/// What a receiver ignores is nonetheless as the sender must put it: `found` is what `legal` encodes to.
pub(crate) fn reserved_is_zero(found: &[u8], legal: &[u8]) -> Result<(), Violation> {
    let differs = found
        .iter()
        .zip(legal)
        .enumerate()
        .find(|(_, (found, legal))| found != legal);
    match differs {
        Some((offset, (found, legal))) => Err(Violation::byte(
            Rule::Reserved,
            offset,
            *found,
            format!("{legal:02X}h"),
        )),
        None => Ok(()),
    }
}
