//! The text of an EDS file as sections, keys and values, each with its line.

/// A `[section]` with its keys in the order of the file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Section {
    /// Its name as the file has it, without the blanks around it.
    pub name: String,
    /// Its line, from 1.
    pub line: usize,
    /// Its keys in the order of the file, repeated ones included.
    pub keys: Vec<Key>,
}

/// A `key=value`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Key {
    /// Its name as the file has it, without the blanks around it.
    pub name: String,
    /// Everything after the `=`, a `;` included, without the blanks around it.
    pub value: String,
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

impl Section {
    /// The first key of that name, in any case and with any blanks in it.
    pub fn key(&self, name: &str) -> Option<&Key> {
        self.keys.iter().find(|key| key.is(name))
    }

    /// Whether it is called `name`, in any case.
    pub fn is(&self, name: &str) -> bool {
        self.name.eq_ignore_ascii_case(name)
    }
}

impl Key {
    /// Whether it is called `name`, in any case and with any blanks in it.
    pub fn is(&self, name: &str) -> bool {
        let blanks = || self.name.bytes().any(|byte| byte.is_ascii_whitespace());
        self.name.eq_ignore_ascii_case(name)
            || (self.name.len() > name.len()
                && blanks()
                && squeezed(&self.name).eq_ignore_ascii_case(name))
    }
}

fn squeezed(name: &str) -> String {
    name.chars().filter(|c| !c.is_whitespace()).collect()
}

/// Splits `text` into sections. Values keep every character after the `=`, a `;` included, but the blanks around them.
pub(crate) fn parse(text: &str) -> (Vec<Section>, Vec<Stray>) {
    let mut sections: Vec<Section> = Vec::new();
    let mut strays = Vec::new();
    let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
    for (number, text) in text.lines().enumerate() {
        let line = number + 1;
        let text = text.trim();
        if text.is_empty() || text.starts_with(';') {
            continue;
        }
        if let Some(name) = section_name(text) {
            sections.push(Section {
                name: name.to_owned(),
                line,
                keys: Vec::with_capacity(8),
            });
            continue;
        }
        match (text.split_once('='), sections.last_mut()) {
            (Some((name, value)), Some(section)) => section.keys.push(Key {
                name: name.trim().to_owned(),
                value: value.trim().to_owned(),
                line,
            }),
            _ => strays.push(Stray {
                text: text.to_owned(),
                line,
            }),
        }
    }
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
        assert_eq!(sections.len(), 2);
        assert_eq!((sections[0].name.as_str(), sections[0].line), ("1000", 2));
        let name = sections[0].key("PARAMETERNAME").unwrap();
        assert_eq!((name.value.as_str(), name.line), ("Device Type;", 3));
        assert_eq!((sections[1].name.as_str(), sections[1].line), ("1001", 5));
        assert_eq!(sections[1].key("a").unwrap().value, "b=c");
    }

    #[test]
    fn strays_are_kept() {
        let (sections, strays) = parse("\u{FEFF}lost=1\n[a]\nno key here\n[b");
        assert_eq!(sections.len(), 1);
        let lines: Vec<_> = strays
            .iter()
            .map(|stray| (stray.line, stray.text.as_str()))
            .collect();
        assert_eq!(lines, [(1, "lost=1"), (3, "no key here"), (4, "[b")]);
    }
}
