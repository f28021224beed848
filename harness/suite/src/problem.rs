//! A mistake on its way from where it is noticed to where its place is known.

use std::fmt;

use crate::diagnostic::shorten;
use crate::{Diagnostic, Position, Severity, code};

/// A mistake. Boxed where it travels, for it is large and rare.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Problem {
    pub(crate) code: &'static str,
    /// `None` until a reader that knows its place passes it on.
    pub(crate) at: Option<Position>,
    /// The placeholder in the case, when `at` is in a row of its table.
    pub(crate) template: Option<Position>,
    pub(crate) message: String,
    pub(crate) label: String,
    pub(crate) also: Vec<(Position, String)>,
    pub(crate) help: Option<String>,
}

impl Problem {
    pub(crate) fn new(
        code: &'static str,
        message: impl Into<String>,
        label: impl Into<String>,
    ) -> Box<Problem> {
        Box::new(Problem {
            code,
            at: None,
            template: None,
            message: message.into(),
            label: label.into(),
            also: Vec::new(),
            help: None,
        })
    }

    pub(crate) fn at(mut self: Box<Self>, at: Position) -> Box<Problem> {
        self.at = Some(at);
        self
    }

    pub(crate) fn help(mut self: Box<Self>, help: impl Into<String>) -> Box<Problem> {
        self.help = Some(help.into());
        self
    }

    pub(crate) fn also(
        mut self: Box<Self>,
        at: Position,
        words: impl Into<String>,
    ) -> Box<Problem> {
        self.also.push((at, words.into()));
        self
    }

    pub(crate) fn into_diagnostic(self, path: &str) -> Diagnostic {
        let mut also = self.also;
        if let Some(template) = self.template {
            also.push((template, "used here".to_owned()));
        }
        Diagnostic {
            code: self.code,
            severity: if [code::UNUSED_COLUMN, code::UNKNOWN_CHECK].contains(&self.code) {
                Severity::Warning
            } else {
                Severity::Error
            },
            path: path.to_owned(),
            at: self.at.unwrap_or_default(),
            message: shorten(self.message),
            label: self.label,
            also,
            help: self.help,
        }
    }
}

/// A problem that a type notices while serde reads it. serde carries nothing but text from there to the reader, so the
/// parts travel in one text, and [`from_text`](Wrong::from_text) takes it apart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Wrong {
    pub(crate) code: &'static str,
    pub(crate) message: String,
    pub(crate) label: String,
    pub(crate) help: Option<String>,
    /// If it is not the place of what is being read.
    pub(crate) at: Option<Position>,
}

const BETWEEN_PARTS: char = '\u{1F}';

impl Wrong {
    pub(crate) fn new(
        code: &'static str,
        message: impl Into<String>,
        label: impl Into<String>,
    ) -> Wrong {
        Wrong {
            code,
            message: message.into(),
            label: label.into(),
            help: None,
            at: None,
        }
    }

    pub(crate) fn help(mut self, help: impl Into<String>) -> Wrong {
        self.help = Some(help.into());
        self
    }

    pub(crate) fn at(mut self, at: Position) -> Wrong {
        self.at = Some(at);
        self
    }

    /// Here, unless it has a place.
    pub(crate) fn or_at(mut self, at: Position) -> Wrong {
        self.at.get_or_insert(at);
        self
    }

    pub(crate) fn into_problem(self) -> Box<Problem> {
        let mut problem = Problem::new(self.code, self.message, self.label);
        problem.help = self.help;
        problem.at = self.at;
        problem
    }

    fn from_text(text: &str) -> Option<Wrong> {
        let parts: Vec<&str> = text.split(BETWEEN_PARTS).collect();
        let [code, message, label, help, at] = parts.as_slice() else {
            return None;
        };
        let numbers: Vec<u32> = at
            .split(':')
            .filter_map(|number| number.parse().ok())
            .collect();
        let at = match numbers.as_slice() {
            [line, column, end_column] => Some(Position {
                line: *line,
                column: *column,
                end_column: *end_column,
            }),
            _ => None,
        };
        Some(Wrong {
            code: code::ALL.iter().find(|known| *known == code)?,
            message: (*message).to_owned(),
            label: (*label).to_owned(),
            help: (!help.is_empty()).then(|| (*help).to_owned()),
            at,
        })
    }
}

impl fmt::Display for Wrong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // A text of the file may hold the separator too.
        let clean = |text: &str| text.replace(BETWEEN_PARTS, "\u{FFFD}");
        let help = clean(self.help.as_deref().unwrap_or_default());
        write!(f, "{}{BETWEEN_PARTS}{}", self.code, clean(&self.message))?;
        write!(
            f,
            "{BETWEEN_PARTS}{}{BETWEEN_PARTS}{help}",
            clean(&self.label)
        )?;
        match self.at {
            Some(at) => write!(
                f,
                "{BETWEEN_PARTS}{}:{}:{}",
                at.line, at.column, at.end_column
            ),
            None => write!(f, "{BETWEEN_PARTS}"),
        }
    }
}

/// What serde reports.
#[derive(Debug)]
pub(crate) struct ReadError(pub(crate) Box<Problem>);

impl From<Box<Problem>> for ReadError {
    fn from(problem: Box<Problem>) -> ReadError {
        ReadError(problem)
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.message)
    }
}

impl std::error::Error for ReadError {}

impl serde::de::Error for ReadError {
    fn custom<T: fmt::Display>(wrong: T) -> ReadError {
        let text = wrong.to_string();
        ReadError(match Wrong::from_text(&text) {
            Some(wrong) => wrong.into_problem(),
            None => Problem::new(code::WRONG_SHAPE, text, ""),
        })
    }

    fn invalid_type(found: serde::de::Unexpected<'_>, expected: &dyn serde::de::Expected) -> Self {
        use serde::de::Unexpected;
        let found = match found {
            Unexpected::Str(_) => "a text".to_owned(),
            Unexpected::Seq => "a list".to_owned(),
            Unexpected::Map => "a map".to_owned(),
            Unexpected::Unit | Unexpected::UnitVariant => "nothing".to_owned(),
            Unexpected::NewtypeVariant | Unexpected::StructVariant => "a map".to_owned(),
            other => other.to_string(),
        };
        let message = match found.as_str() {
            "nothing" => "the value is missing".to_owned(),
            found => format!("{found} cannot stand here"),
        };
        ReadError(Problem::new(
            code::WRONG_SHAPE,
            message,
            format!("expected {}", in_our_words(&expected.to_string())),
        ))
    }

    fn unknown_variant(found: &str, expected: &'static [&'static str]) -> ReadError {
        let problem = Problem::new(
            code::UNKNOWN_WORD,
            format!("unknown word `{found}`"),
            expected_one_of(expected),
        );
        ReadError(with_nearest(problem, found, expected))
    }

    fn unknown_field(found: &str, expected: &'static [&'static str]) -> ReadError {
        let problem = Problem::new(
            code::UNKNOWN_KEY,
            format!("unknown key `{found}`"),
            expected_one_of(expected),
        );
        ReadError(with_nearest(problem, found, expected))
    }

    fn missing_field(field: &'static str) -> ReadError {
        ReadError(Problem::new(
            code::MISSING_KEY,
            format!("the key `{field}` is missing"),
            format!("needs `{field}`"),
        ))
    }
}

/// What serde calls the kinds of values.
fn in_our_words(expected: &str) -> &str {
    match expected {
        "a string" => "a text",
        "a sequence" => "a list",
        "a boolean" => "true or false",
        other => other,
    }
}

/// `expected one of ...`
pub(crate) fn expected_one_of<T: AsRef<str>>(words: &[T]) -> String {
    match words {
        [] => "expected nothing here".to_owned(),
        [word] => format!("expected `{}`", word.as_ref()),
        _ => {
            let words: Vec<String> = words
                .iter()
                .map(|word| format!("`{}`", word.as_ref()))
                .collect();
            format!("expected one of {}", words.join(", "))
        }
    }
}

/// Adds the nearest known word as help, if one is near.
pub(crate) fn with_nearest<T: AsRef<str>>(
    problem: Box<Problem>,
    found: &str,
    known: &[T],
) -> Box<Problem> {
    match nearest(found, known) {
        Some(word) => problem.help(format!("did you mean `{word}`?")),
        None => problem,
    }
}

/// The known word nearest to `found`: at most a third of it wrong, or one of the two begins with the other.
pub(crate) fn nearest<'a, T: AsRef<str>>(found: &str, known: &'a [T]) -> Option<&'a str> {
    // Nobody mistypes a text of this length, and the distance of long texts is slow to find.
    if found.is_empty() || found.len() > 64 {
        return None;
    }
    let folded = found.to_lowercase().replace(['_', ' '], "-");
    let allowed = (folded.chars().count() / 3).max(1);
    let words = known.iter().map(AsRef::as_ref);
    let distances = words.map(|word| (strsim::damerau_levenshtein(&folded, word), word));
    let near = distances.min_by_key(|(distance, _)| *distance)?;
    if near.0 <= allowed {
        return Some(near.1);
    }
    let begins =
        |word: &&str| folded.len() > 2 && (word.starts_with(&folded) || folded.starts_with(*word));
    known.iter().map(AsRef::as_ref).find(begins)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::de::Error;

    #[test]
    fn a_wrong_survives_serde() {
        let at = Position {
            line: 1,
            column: 2,
            end_column: 3,
        };
        for wrong in [
            Wrong::new(code::DURATION, "no unit", "expected `ms`"),
            Wrong::new(code::DURATION, "no unit", "expected `ms`")
                .help("write it")
                .at(at),
        ] {
            let problem = ReadError::custom(&wrong).0;
            assert_eq!(problem, wrong.into_problem());
        }
        let strange = Wrong::new(code::BYTES, "a\u{1F}b", "");
        assert_eq!(ReadError::custom(&strange).0.message, "a\u{FFFD}b");
    }

    #[test]
    fn the_nearest_word_is_found() {
        let verbs = ["sdo-read", "sdo-write", "send", "expect"];
        assert_eq!(nearest("sdo-raed", &verbs), Some("sdo-read"));
        assert_eq!(nearest("SDO_READ", &verbs), Some("sdo-read"));
        assert_eq!(nearest("expects", &verbs), Some("expect"));
        assert_eq!(nearest("sleep", &verbs), None);
        assert_eq!(nearest("", &verbs), None);
    }
}
