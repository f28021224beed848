//! What is found in a file.

use super::Rule;

/// How bad a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// Worth knowing.
    Note,
    /// Other readers may stumble over it.
    Warning,
    /// It contradicts the standard or the rest of the file.
    Error,
}

/// Something in the file that is not as it should be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// The rule that is broken.
    pub rule: &'static Rule,
    /// The line, from 1.
    pub line: usize,
    /// What is wrong, with the text in question.
    pub text: String,
    /// What was done about it, or what to write instead.
    pub help: String,
    /// Whether something that the file says did not get into the result.
    pub lost: bool,
}

impl Finding {
    /// A finding that loses nothing.
    pub(super) fn new(
        rule: &'static Rule,
        line: usize,
        text: impl Into<String>,
        help: impl Into<String>,
    ) -> Finding {
        Finding {
            rule,
            line,
            text: text.into(),
            help: help.into(),
            lost: false,
        }
    }

    /// A finding for which something is left out.
    pub(super) fn losing(
        rule: &'static Rule,
        line: usize,
        text: impl Into<String>,
        help: impl Into<String>,
    ) -> Finding {
        Finding {
            lost: true,
            ..Finding::new(rule, line, text, help)
        }
    }
}
