//! The text of an EDS file as sections, keys and values, each with its line.

use std::ops::Range;

/// A text split into sections, which are views of it.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Sections {
    text: String,
    heads: Vec<Head>,
    keys: Vec<KeySpan>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct Head {
    name: Range<usize>,
    line: usize,
    /// Its keys, as a part of all keys.
    keys: Range<usize>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
struct KeySpan {
    name: Range<usize>,
    value: Range<usize>,
    line: usize,
}

/// A `[section]` with its keys in the order of the file.
#[derive(Clone, Copy)]
pub struct Section<'t> {
    /// Its name as the file has it, without the blanks around it.
    pub name: &'t str,
    /// Its line, from 1.
    pub line: usize,
    text: &'t str,
    keys: &'t [KeySpan],
}

/// A `key=value`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Key<'t> {
    /// Its name as the file has it, without the blanks around it.
    pub name: &'t str,
    /// Everything after the `=`, a `;` included, without the blanks around it.
    pub value: &'t str,
    /// Its line, from 1.
    pub line: usize,
}

/// A line that is none of: section, key, comment, blank; or a key before the first section.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stray {
    /// The line without the blanks around it.
    pub text: String,
    /// Its number, from 1.
    pub line: usize,
}

impl Sections {
    /// Every section in the order of the file.
    pub(crate) fn iter(&self) -> impl Iterator<Item = Section<'_>> {
        self.heads.iter().map(|head| self.section(head))
    }

    /// The first section called `name`, in any case.
    pub(crate) fn named(&self, name: &str) -> Option<Section<'_>> {
        let mut heads = self.heads.iter();
        heads
            .find(|head| slice(&self.text, &head.name).eq_ignore_ascii_case(name))
            .map(|head| self.section(head))
    }

    /// The section that starts in `line`.
    pub(crate) fn at(&self, line: usize) -> Option<Section<'_>> {
        let at = self.heads.binary_search_by_key(&line, |head| head.line);
        self.heads.get(at.ok()?).map(|head| self.section(head))
    }

    fn section(&self, head: &Head) -> Section<'_> {
        Section {
            name: slice(&self.text, &head.name),
            line: head.line,
            text: &self.text,
            keys: self.keys.get(head.keys.clone()).unwrap_or_default(),
        }
    }
}

impl<'t> Section<'t> {
    /// Its keys in the order of the file, repeated ones included.
    pub fn keys(&self) -> impl ExactSizeIterator<Item = Key<'t>> + Clone + use<'t> {
        let text = self.text;
        self.keys.iter().map(move |key| Key {
            name: slice(text, &key.name),
            value: slice(text, &key.value),
            line: key.line,
        })
    }

    /// The first key of that name, in any case and with any blanks in it.
    pub fn key(&self, name: &str) -> Option<Key<'t>> {
        self.keys().find(|key| key.is(name))
    }

    /// Like [`Section::key`], but `None` if nothing is behind the `=`.
    pub fn filled(&self, name: &str) -> Option<Key<'t>> {
        self.key(name).filter(|key| !key.value.is_empty())
    }

    /// Whether it is called `name`, in any case.
    pub fn is(&self, name: &str) -> bool {
        self.name.eq_ignore_ascii_case(name)
    }
}

impl Key<'_> {
    /// Whether it is called `name`, in any case and with any blanks in it.
    pub fn is(&self, name: &str) -> bool {
        self.name.eq_ignore_ascii_case(name)
            || (self.name.len() > name.len()
                && self.has_blanks()
                && squeezed(self.name).eq_ignore_ascii_case(name))
    }

    pub(crate) fn has_blanks(&self) -> bool {
        // Most names are plain ASCII, in which a look at the bytes is enough.
        let plain = self.name.bytes().all(|byte| byte.is_ascii_graphic());
        !plain && self.name.contains(char::is_whitespace)
    }
}

fn squeezed(name: &str) -> String {
    name.chars().filter(|c| !c.is_whitespace()).collect()
}

fn slice<'t>(text: &'t str, range: &Range<usize>) -> &'t str {
    text.get(range.clone()).unwrap_or_default()
}

/// Splits `text` into sections. Values keep every character after the `=`, a `;` included, but the blanks around them.
pub(crate) fn parse(text: &str) -> (Sections, Vec<Stray>) {
    // Files have some 15 bytes a line, and most lines are keys.
    let mut keys: Vec<KeySpan> = Vec::with_capacity(text.len() / 15);
    let mut heads: Vec<Head> = Vec::with_capacity(text.len() / 150);
    let mut strays = Vec::new();
    let range = |part: &str| {
        let start = part.as_ptr().addr() - text.as_ptr().addr();
        start..start + part.len()
    };
    let lines = text.strip_prefix('\u{FEFF}').unwrap_or(text).lines();
    for (line, text) in (1..).zip(lines.map(str::trim)) {
        if text.is_empty() || text.starts_with(';') {
            continue;
        }
        if let Some(name) = section_name(text) {
            heads.push(Head {
                name: range(name),
                line,
                keys: keys.len()..keys.len(),
            });
            continue;
        }
        match (text.split_once('='), heads.last_mut()) {
            (Some((name, value)), Some(head)) => {
                keys.push(KeySpan {
                    name: range(name.trim_end()),
                    value: range(value.trim_start()),
                    line,
                });
                head.keys.end = keys.len();
            }
            _ => strays.push(Stray {
                text: text.to_owned(),
                line,
            }),
        }
    }
    let sections = Sections {
        text: text.to_owned(),
        heads,
        keys,
    };
    (sections, strays)
}

fn section_name(text: &str) -> Option<&str> {
    let (name, rest) = text.strip_prefix('[')?.split_once(']')?;
    let rest = rest.trim_start();
    (rest.is_empty() || rest.starts_with(';')).then_some(name.trim())
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn sections_keys_and_lines() {
        let (sections, strays) =
            parse("; top\r\n[1000]\r\nParameterName = Device Type;\r\n\r\n[ 1001 ] ; why\r\nA=b=c");
        assert!(strays.is_empty());
        let heads: Vec<_> = sections
            .iter()
            .map(|section| (section.name, section.line))
            .collect();
        assert_eq!(heads, [("1000", 2), ("1001", 5)]);
        let first = sections.at(2).unwrap();
        let name = first.key("PARAMETERNAME").unwrap();
        assert_eq!((name.value, name.line), ("Device Type;", 3));
        let second = sections.named("1001").unwrap();
        assert_eq!(second.key("a").unwrap().value, "b=c");
        assert!(sections.at(3).is_none() && second.key("b").is_none());
    }

    #[test]
    fn strays_are_kept() {
        let (sections, strays) = parse("\u{FEFF}lost=1\n[a]\nno key here\n[b");
        assert_eq!(sections.iter().count(), 1);
        let lines: Vec<_> = strays
            .iter()
            .map(|stray| (stray.line, stray.text.as_str()))
            .collect();
        assert_eq!(lines, [(1, "lost=1"), (3, "no key here"), (4, "[b")]);
    }
}
