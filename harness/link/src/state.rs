//! What a participant would show if it could be opened.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

/// Names and values, cheap to take and to compare: it is done around every case. Text is made of them only when two differ.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct State(Vec<(StateName, StateValue)>);

/// What has a value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum StateName {
    /// A value of an object dictionary, behind a word or nothing: `saved 1017:00`.
    Object(&'static str, u16, u8),
    /// A number in hexadecimal, behind a word: `register 00D4`.
    Hexadecimal(&'static str, u16),
    /// A number in decimal, of at least three digits, behind a word: `P212`.
    Decimal(&'static str, u16),
    /// Anything else.
    Text(Cow<'static, str>),
}

/// A value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum StateValue {
    /// Up to 8 bytes, the least significant first, and how many they are.
    Bytes([u8; 8], u8),
    /// More bytes, the least significant first.
    Long(Box<[u8]>),
    /// A number.
    Number(i64),
    /// Anything else.
    Text(Cow<'static, str>),
}

/// What is not the same in two states.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StateDifference {
    /// What has a value.
    pub name: String,
    /// Its value in the one; none if it is not there.
    pub before: Option<String>,
    /// Its value in the other.
    pub after: Option<String>,
}

impl State {
    /// Adds a value.
    pub fn insert(&mut self, name: impl Into<StateName>, value: impl Into<StateValue>) {
        self.0.push((name.into(), value.into()));
    }

    /// Leaves out what `stays` does not want.
    pub fn retain(&mut self, stays: impl Fn(&StateName) -> bool) {
        self.0.retain(|(name, _)| stays(name));
    }

    /// A value as text.
    pub fn get(&self, name: &str) -> Option<String> {
        let found = self.0.iter().find(|(known, _)| known.to_string() == name);
        found.map(|(_, value)| value.to_string())
    }

    /// What is not the same in `after`, by name.
    pub fn differences(&self, after: &State) -> Vec<StateDifference> {
        if self == after {
            return Vec::new();
        }
        let (before, after) = (self.text(), after.text());
        let names: BTreeSet<&String> = before.keys().chain(after.keys()).collect();
        let changed = names
            .into_iter()
            .filter(|name| before.get(*name) != after.get(*name));
        changed
            .map(|name| StateDifference {
                name: name.clone(),
                before: before.get(name).cloned(),
                after: after.get(name).cloned(),
            })
            .collect()
    }

    fn text(&self) -> BTreeMap<String, String> {
        let text = |(name, value): &(StateName, StateValue)| (name.to_string(), value.to_string());
        self.0.iter().map(text).collect()
    }
}

impl Extend<(StateName, StateValue)> for State {
    fn extend<I: IntoIterator<Item = (StateName, StateValue)>>(&mut self, values: I) {
        self.0.extend(values);
    }
}

impl FromIterator<(StateName, StateValue)> for State {
    fn from_iter<I: IntoIterator<Item = (StateName, StateValue)>>(values: I) -> State {
        State(values.into_iter().collect())
    }
}

impl IntoIterator for State {
    type Item = (StateName, StateValue);
    type IntoIter = std::vec::IntoIter<Self::Item>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl From<&'static str> for StateName {
    fn from(text: &'static str) -> StateName {
        StateName::Text(Cow::Borrowed(text))
    }
}

impl From<String> for StateName {
    fn from(text: String) -> StateName {
        StateName::Text(Cow::Owned(text))
    }
}

impl fmt::Display for StateName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StateName::Object(word, index, sub) => write!(f, "{word}{index:04X}:{sub:02X}"),
            StateName::Hexadecimal(word, number) => write!(f, "{word}{number:04X}"),
            StateName::Decimal(word, number) => write!(f, "{word}{number:03}"),
            StateName::Text(text) => f.write_str(text),
        }
    }
}

impl From<&[u8]> for StateValue {
    fn from(bytes: &[u8]) -> StateValue {
        let mut short = [0; 8];
        match (short.get_mut(..bytes.len()), u8::try_from(bytes.len())) {
            (Some(place), Ok(len)) => {
                place.copy_from_slice(bytes);
                StateValue::Bytes(short, len)
            }
            _ => StateValue::Long(bytes.into()),
        }
    }
}

impl From<&'static str> for StateValue {
    fn from(text: &'static str) -> StateValue {
        StateValue::Text(Cow::Borrowed(text))
    }
}

impl From<String> for StateValue {
    fn from(text: String) -> StateValue {
        StateValue::Text(Cow::Owned(text))
    }
}

impl From<bool> for StateValue {
    fn from(is: bool) -> StateValue {
        StateValue::from(if is { "true" } else { "false" })
    }
}

macro_rules! numbers {
    ($($number:ty),*) => {
        $(impl From<$number> for StateValue {
            fn from(number: $number) -> StateValue {
                StateValue::Number(number.into())
            }
        })*
    };
}

numbers!(u8, u16, u32, i16, i32, i64);

/// Bytes as a number is written: the most significant first.
impl fmt::Display for StateValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let bytes = match self {
            StateValue::Bytes(bytes, len) => bytes.get(..usize::from(*len)).unwrap_or(bytes),
            StateValue::Long(bytes) => bytes,
            StateValue::Number(number) => return number.fmt(f),
            StateValue::Text(text) => return f.write_str(text),
        };
        let mut digits = bytes.iter().rev();
        digits.try_for_each(|byte| write!(f, "{byte:02X}"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(heartbeat: u16) -> State {
        let mut state = State::default();
        state.insert(
            StateName::Object("", 0x1017, 0),
            &heartbeat.to_le_bytes()[..],
        );
        state.insert(StateName::Object("saved ", 0x1008, 0), &b"ten bytes."[..]);
        state.insert(StateName::Hexadecimal("register ", 0xD4), 500_u16);
        state.insert(StateName::Decimal("P", 12), -3_i16);
        state.insert("nmt", "stopped");
        state.insert("listens only", true);
        state
    }

    #[test]
    fn names_and_values_are_shown_as_people_write_them() {
        let state = state(0x0102);
        for (name, value) in [
            ("1017:00", "0102"),
            ("saved 1008:00", "2E736574796220 6E6574"),
            ("register 00D4", "500"),
            ("P012", "-3"),
            ("nmt", "stopped"),
            ("listens only", "true"),
        ] {
            assert_eq!(state.get(name), Some(value.replace(' ', "")), "{name}");
        }
        assert_eq!(state.get("1018:00"), None);
    }

    #[test]
    fn what_differs_is_named_with_both_values() {
        let (before, mut after) = (state(0), state(100));
        after.retain(|name| *name != StateName::from("nmt"));
        after.insert("lss", "waiting");
        let difference = |name: &str, before: Option<&str>, after: Option<&str>| StateDifference {
            name: name.to_owned(),
            before: before.map(str::to_owned),
            after: after.map(str::to_owned),
        };
        assert_eq!(
            before.differences(&after),
            [
                difference("1017:00", Some("0000"), Some("0064")),
                difference("lss", None, Some("waiting")),
                difference("nmt", Some("stopped"), None),
            ]
        );
        assert_eq!(before.differences(&state(0)), []);
        // An order has no meaning.
        let turned: State = state(0)
            .into_iter()
            .collect::<Vec<_>>()
            .into_iter()
            .rev()
            .collect();
        assert_eq!(before.differences(&turned), []);
    }
}
