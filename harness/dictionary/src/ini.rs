//! The text of an EDS file as sections, keys and values, each with its line.

/// A `[section]` with its keys in the order of the file.
#[derive(Debug)]
pub(crate) struct Section<'a> {
    pub(crate) name: &'a str,
    pub(crate) line: usize,
    pub(crate) keys: Vec<Key<'a>>,
}

/// A `key=value`.
#[derive(Debug)]
pub(crate) struct Key<'a> {
    pub(crate) name: &'a str,
    pub(crate) value: &'a str,
    pub(crate) line: usize,
}

/// A line that is none of: section, key, comment, blank; or a key before the first section.
#[derive(Debug)]
pub(crate) struct Stray<'a> {
    pub(crate) text: &'a str,
    pub(crate) line: usize,
}

impl<'a> Section<'a> {
    /// The first key of that name, in any case.
    pub(crate) fn key(&self, name: &str) -> Option<&Key<'a>> {
        self.keys
            .iter()
            .find(|key| key.name.eq_ignore_ascii_case(name))
    }
}

/// Splits `text` into sections. Values keep every character after the `=`, a `;` included, but the blanks around them.
pub(crate) fn parse(text: &str) -> (Vec<Section<'_>>, Vec<Stray<'_>>) {
    let mut sections: Vec<Section<'_>> = Vec::new();
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
                name,
                line,
                keys: Vec::new(),
            });
            continue;
        }
        match (text.split_once('='), sections.last_mut()) {
            (Some((name, value)), Some(section)) => section.keys.push(Key {
                name: name.trim(),
                value: value.trim(),
                line,
            }),
            _ => strays.push(Stray { text, line }),
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
        assert_eq!((sections[0].name, sections[0].line), ("1000", 2));
        let name = sections[0].key("PARAMETERNAME").unwrap();
        assert_eq!((name.value, name.line), ("Device Type;", 3));
        assert_eq!((sections[1].name, sections[1].line), ("1001", 5));
        assert_eq!(sections[1].key("a").unwrap().value, "b=c");
    }

    #[test]
    fn strays_are_kept() {
        let (sections, strays) = parse("\u{FEFF}lost=1\n[a]\nno key here\n[b");
        assert_eq!(sections.len(), 1);
        let lines: Vec<_> = strays
            .iter()
            .map(|stray| (stray.line, stray.text))
            .collect();
        assert_eq!(lines, [(1, "lost=1"), (3, "no key here"), (4, "[b")]);
    }
}
