//! YAML text into a tree in which every node and every key knows its place.
//!
//! What a suite does not need is refused: anchors, aliases, tags, keys that are not words, tabs in front of a line. So
//! the tree is never larger than its text.

use std::collections::HashSet;
use std::sync::Arc;

use saphyr_parser::{Event, Parser, ScalarStyle, ScanError, Span};

use crate::diagnostic::shorten;
use crate::lines::Lines;
use crate::node::{Entry, Key, Kind, Node};
use crate::{Diagnostic, Position, Severity, code};

/// How many anchors, aliases and tags are complained about; a file made to explode has millions.
const MOST_REFERENCES: usize = 20;

/// The longest text, in bytes.
const LONGEST_TEXT: usize = 16 << 20;
/// The most nodes in a file.
const MOST_NODES: usize = 2_000_000;
/// The deepest nesting.
const DEEPEST: usize = 32;

/// The one document in `text`.
pub(crate) fn read(path: &str, text: &str) -> Result<Node, Vec<Diagnostic>> {
    if text.len() > LONGEST_TEXT {
        let message = format!(
            "this file has {} bytes, and at most {LONGEST_TEXT} are read",
            text.len()
        );
        return Err(vec![error(
            path,
            code::TOO_LARGE,
            Position::default(),
            message,
            "",
        )]);
    }
    let mut builder = Builder::new(path, text);
    builder.tabs();
    builder.line_ends();
    if !builder.problems.is_empty() {
        return Err(builder.problems);
    }
    for event in Parser::new_from_str(text) {
        let taken = match event {
            Ok((event, span)) => builder.take(event, span),
            Err(error) => Err(builder.scan_error(&error)),
        };
        if let Err(problem) = taken {
            builder.problems.push(*problem);
            return Err(builder.problems);
        }
    }
    builder.finish()
}

fn too_deep() -> String {
    format!("lists and maps are nested more than {DEEPEST} deep")
}

fn error(
    path: &str,
    code: &'static str,
    at: Position,
    message: impl Into<String>,
    label: impl Into<String>,
) -> Diagnostic {
    Diagnostic {
        code,
        severity: Severity::Error,
        path: path.to_owned(),
        at,
        message: shorten(message.into()),
        label: label.into(),
        also: Vec::new(),
        help: None,
    }
}

/// A list or a map that is not finished.
enum Open {
    List(Vec<Node>, Span),
    Map(Vec<Entry>, Option<Key>, Span),
}

struct Builder<'a> {
    path: &'a str,
    text: &'a str,
    lines: Lines,
    open: Vec<Open>,
    root: Option<Node>,
    nodes: usize,
    documents: usize,
    words: HashSet<Arc<str>>,
    problems: Vec<Diagnostic>,
}

type Taken = Result<(), Box<Diagnostic>>;

impl<'a> Builder<'a> {
    fn new(path: &'a str, text: &'a str) -> Builder<'a> {
        Builder {
            path,
            text,
            lines: Lines::of(text),
            open: Vec::new(),
            root: None,
            nodes: 0,
            documents: 0,
            words: HashSet::new(),
            problems: Vec::new(),
        }
    }

    fn stop(
        &self,
        code: &'static str,
        at: Position,
        message: impl Into<String>,
        label: impl Into<String>,
    ) -> Taken {
        Err(Box::new(error(self.path, code, at, message, label)))
    }

    /// YAML forbids tabs for indentation; what a parser says of them helps nobody.
    fn tabs(&mut self) {
        for (number, line) in self.text.lines().enumerate() {
            let indentation = line.len() - line.trim_start_matches([' ', '\t']).len();
            if let Some(tab) = line[..indentation].find('\t') {
                let at = Position {
                    line: number as u32 + 1,
                    column: tab as u32 + 1,
                    end_column: tab as u32 + 2,
                };
                let mut problem = error(
                    self.path,
                    code::TAB,
                    at,
                    "a tab indents this line",
                    "expected spaces",
                );
                problem.help = Some("set the editor to put spaces for tabs in YAML".to_owned());
                self.problems.push(problem);
                return;
            }
        }
    }

    /// YAML ends a line at a carriage return alone, nobody else does; lines would not be where people see them.
    fn line_ends(&mut self) {
        for (number, line) in self.text.lines().enumerate() {
            if let Some(before) = line.split_once('\r').map(|(before, _)| before) {
                let column = before.chars().count() as u32 + 1;
                let at = Position {
                    line: number as u32 + 1,
                    column,
                    end_column: column + 1,
                };
                let message = "this is not YAML: a carriage return without a line feed";
                let label = "expected a line feed after it";
                self.problems
                    .push(error(self.path, code::NOT_YAML, at, message, label));
                return;
            }
        }
    }

    fn take(&mut self, event: Event<'_>, span: Span) -> Taken {
        match event {
            Event::DocumentStart(_) => {
                self.documents += 1;
                if self.documents > 1 {
                    let message = "a second document starts here";
                    return self.stop(
                        code::ONE_DOCUMENT,
                        self.place(span),
                        message,
                        "expected one document",
                    );
                }
                Ok(())
            }
            Event::Alias(_) => {
                self.refuse_reference(span, "an alias");
                self.add(Kind::Empty, span)
            }
            Event::Scalar(text, style, anchor, tag) => {
                self.refuse_anchor_and_tag(anchor, tag.is_some(), span);
                let empty =
                    style == ScalarStyle::Plain && matches!(text.as_ref(), "" | "~" | "null");
                if empty && !self.awaits_key() {
                    self.add(Kind::Empty, span)
                } else {
                    self.add(Kind::Text(text.into()), span)
                }
            }
            Event::SequenceStart(anchor, tag) => {
                self.refuse_anchor_and_tag(anchor, tag.is_some(), span);
                self.open(Open::List(Vec::new(), span), span)
            }
            Event::MappingStart(anchor, tag) => {
                self.refuse_anchor_and_tag(anchor, tag.is_some(), span);
                self.open(Open::Map(Vec::new(), None, span), span)
            }
            Event::SequenceEnd | Event::MappingEnd => self.close(span),
            Event::Nothing | Event::StreamStart | Event::StreamEnd | Event::DocumentEnd => Ok(()),
        }
    }

    fn awaits_key(&self) -> bool {
        matches!(self.open.last(), Some(Open::Map(_, None, _)))
    }

    fn open(&mut self, open: Open, span: Span) -> Taken {
        let at = self.place(span);
        if self.awaits_key() {
            return self.stop(
                code::KEY_NOT_A_WORD,
                at,
                "a list or a map stands for a key",
                "expected a word",
            );
        }
        if self.open.len() == DEEPEST {
            return self.stop(code::TOO_DEEP, at, too_deep(), "");
        }
        self.open.push(open);
        Ok(())
    }

    fn close(&mut self, end: Span) -> Taken {
        match self.open.pop() {
            Some(Open::List(elements, start)) => {
                let first = elements.first().map(|element| element.at);
                let at = self.place_between(start, end, first);
                self.put(Node {
                    at,
                    kind: Kind::List(elements),
                })
            }
            Some(Open::Map(mut entries, _, start)) => {
                entries.shrink_to_fit();
                self.find_duplicates(&entries);
                let first = entries.first().map(|entry| entry.key.at);
                let at = self.place_between(start, end, first);
                self.put(Node {
                    at,
                    kind: Kind::Map(entries),
                })
            }
            None => Ok(()),
        }
    }

    fn add(&mut self, kind: Kind, span: Span) -> Taken {
        let at = self.place(span);
        self.put(Node { at, kind })
    }

    fn put(&mut self, node: Node) -> Taken {
        self.nodes += 1;
        if self.nodes > MOST_NODES {
            let message = format!("this file has more than {MOST_NODES} values");
            return self.stop(code::TOO_LARGE, node.at, message, "");
        }
        match self.open.last_mut() {
            None => self.root = Some(node),
            Some(Open::List(elements, _)) => elements.push(node),
            Some(Open::Map(entries, pending, _)) => match pending.take() {
                Some(key) => entries.push(Entry { key, value: node }),
                None => {
                    let text = match node.kind {
                        Kind::Text(text) => text,
                        _ => Box::default(),
                    };
                    if text.as_ref() == "<<" {
                        let message = "a merge key: what a case says must stand in it";
                        return self.stop(
                            code::REFERENCE,
                            node.at,
                            message,
                            "expected it written out",
                        );
                    }
                    let text = match self.words.get(text.as_ref()) {
                        Some(word) => Arc::clone(word),
                        None => {
                            let word: Arc<str> = text.into();
                            self.words.insert(Arc::clone(&word));
                            word
                        }
                    };
                    *pending = Some(Key { text, at: node.at });
                }
            },
        }
        Ok(())
    }

    fn find_duplicates(&mut self, entries: &[Entry]) {
        let mut keys: Vec<&Key> = entries.iter().map(|entry| &entry.key).collect();
        keys.sort_by(|one, other| one.text.cmp(&other.text).then(one.at.cmp(&other.at)));
        for pair in keys.windows(2) {
            if let [first, second] = pair
                && first.text == second.text
            {
                let message = format!("the key `{}` is already in this map", second.text);
                let mut problem = error(
                    self.path,
                    code::DUPLICATE_KEY,
                    second.at,
                    message,
                    "a second time",
                );
                problem.also.push((first.at, "first here".to_owned()));
                self.problems.push(problem);
            }
        }
    }

    fn refuse_anchor_and_tag(&mut self, anchor: usize, tag: bool, span: Span) {
        if anchor > 0 {
            self.refuse_reference(span, "an anchor");
        }
        if tag {
            self.refuse_reference(span, "a tag");
        }
    }

    fn refuse_reference(&mut self, span: Span, what: &str) {
        if self.problems.len() >= MOST_REFERENCES {
            return;
        }
        let at = self.place(span);
        let message = format!("{what}: what a case says must stand in it");
        self.problems.push(error(
            self.path,
            code::REFERENCE,
            at,
            message,
            "expected it written out",
        ));
    }

    fn scan_error(&self, scan: &ScanError) -> Box<Diagnostic> {
        let column = scan.marker().col() as u32 + 1;
        let at = Position {
            line: scan.marker().line() as u32,
            column,
            end_column: column + 1,
        };
        let mut problem = error(
            self.path,
            code::NOT_YAML,
            at,
            format!("this is not YAML: {}", scan.info()),
            "",
        );
        if scan.info().contains("recursion limit") {
            return Box::new(error(self.path, code::TOO_DEEP, at, too_deep(), ""));
        }
        let line = self.lines.line(self.text, scan.marker().line());
        if line.contains('{') {
            problem.help = Some("a text that starts with `{` must stand in quotes".to_owned());
        } else if line.matches(": ").count() > 1 {
            problem.help = Some("a text with `: ` in it must stand in quotes".to_owned());
        }
        Box::new(problem)
    }

    fn finish(mut self) -> Result<Node, Vec<Diagnostic>> {
        match self.root {
            _ if !self.problems.is_empty() => Err(self.problems),
            Some(node) => Ok(node),
            None => {
                self.problems.push(error(
                    self.path,
                    code::ONE_DOCUMENT,
                    Position::default(),
                    "this file is empty",
                    "",
                ));
                Err(self.problems)
            }
        }
    }

    fn place(&self, span: Span) -> Position {
        let line = span.start.line();
        let column = span.start.col() as u32 + 1;
        let end_column = if span.end.line() == line {
            span.end.col() as u32 + 1
        } else {
            self.end_of(line)
        };
        Position {
            line: line as u32,
            column,
            end_column: end_column.max(column),
        }
    }

    /// The place of a list or map: a flow one from bracket to bracket, a block one where its first entry is.
    fn place_between(&self, start: Span, end: Span, first: Option<Position>) -> Position {
        match first {
            Some(first) if start.is_empty() => first,
            _ => self.place(Span::new(start.start, end.end)),
        }
    }

    fn end_of(&self, line: usize) -> u32 {
        let line = self.lines.line(self.text, line);
        line.trim_end().chars().count() as u32 + 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(node: &Node) -> (u32, u32, u32) {
        (node.at.line, node.at.column, node.at.end_column)
    }

    #[test]
    fn every_node_knows_its_place() {
        let text = "a: 581#43??  # frame\nmap: {x: 1, y: 'q'}\nlist:\n  - é: two words\n  - [\n   1]\nnone:\n";
        let root = read("t", text).unwrap();
        assert_eq!(root.get("a").unwrap().text(), Some("581#43??"));
        assert_eq!(place(root.get("a").unwrap()), (1, 4, 12));
        let map = root.get("map").unwrap();
        assert_eq!(place(map), (2, 6, 20));
        assert_eq!(place(map.get("y").unwrap()), (2, 16, 19));
        let list = root.get("list").unwrap();
        assert_eq!(place(list), (4, 5, 6));
        assert_eq!(place(list.elements()[0].get("é").unwrap()), (4, 8, 17));
        assert_eq!(place(&list.elements()[1]), (5, 5, 6));
        assert_eq!(root.get("none").unwrap().kind, Kind::Empty);
        assert_eq!(root.entry("none").unwrap().key.at.line, 7);
    }
}
