//! The one renderer: a problem as text, in the manner of rustc.

use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet};

use crate::ink::{Ink, verdict_style};
use crate::problem::{Also, Elsewhere, Problem, Severity, SourceText, Span};

/// More text than this is not given to the snippet renderer: places further apart are shown as notes.
const LONGEST_EXCERPT_BYTES: usize = 100_000;
/// Of a longer line only the part around the place is shown.
const LONGEST_LINE_CHARS: usize = 240;
/// How much of a long line is shown before the place.
const LEAD_CHARS: usize = 60;

/// `problem` as text that ends with a line feed.
pub fn render(problem: &Problem, ink: Ink) -> String {
    let level = level(problem.severity);
    let mut title = level.primary_title(problem.message.as_str());
    if let Some(code) = &problem.code {
        title = title.id(code.as_str());
    }
    let mut group = Group::with_title(title);
    let excerpt = excerpt(problem);
    let shortened = excerpt.as_ref().is_some_and(|excerpt| excerpt.shortened);
    if !problem.path.is_empty() && (shortened || excerpt.is_none()) {
        group = group.element(origin(problem));
    }
    let far = match &excerpt {
        Some(excerpt) => {
            group = group.element(excerpt.snippet(problem));
            problem.also.len() > excerpt.also.len()
        }
        None => !problem.also.is_empty(),
    };
    if far {
        for Also { at, words } in &problem.also {
            let place = format!("{}:{}:{}: {words}", problem.path, at.line, at.column);
            group = group.element(Level::NOTE.message(place));
        }
    }
    for place in &problem.elsewhere {
        group = match other_file(place) {
            Some(snippet) => group.element(snippet),
            None => group.element(
                Level::NOTE.message(format!("{}:{}: {}", place.path, place.at.line, place.words)),
            ),
        };
    }
    for note in &problem.notes {
        group = group.element(Level::NOTE.message(note.as_str()));
    }
    if let Some(help) = &problem.help {
        group = group.element(Level::HELP.message(help.as_str()));
    }
    let mut text = renderer(problem.severity, ink).render(&[group]);
    text.push('\n');
    if shortened {
        // The place is in the origin above: in the shortened line it would be another.
        text = text
            .split_inclusive('\n')
            .filter(|line| line.trim() != ":::")
            .collect();
    }
    text
}

fn level(severity: Severity) -> Level<'static> {
    match severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Note => Level::NOTE,
        Severity::Fail => Level::ERROR.with_name("fail"),
        Severity::Inconclusive => Level::WARNING.with_name("inconclusive"),
        Severity::Deviation => Level::INFO.with_name("deviation"),
    }
}

fn renderer(severity: Severity, ink: Ink) -> Renderer {
    use fieldproof_record::Verdict;
    match (ink, severity) {
        (Ink::Plain, _) => Renderer::plain(),
        (Ink::Coloured, Severity::Deviation) => {
            Renderer::styled().info(verdict_style(Verdict::Deviation))
        }
        (Ink::Coloured, _) => Renderer::styled(),
    }
}

fn origin(problem: &Problem) -> Origin<'_> {
    let origin = Origin::path(problem.path.as_str());
    let column = problem.at.column.max(1) as usize;
    match problem.at.line {
        0 => origin,
        line => origin.line(line as usize).char_column(column),
    }
}

/// The line of a place in another file; `None` if the line is not at hand, or very long.
fn other_file(place: &Elsewhere) -> Option<Snippet<'_, annotate_snippets::Annotation<'_>>> {
    let line = match &place.source {
        SourceText::Missing => return None,
        SourceText::Line(line) => line,
        SourceText::Whole(text) => line_of(text, place.at.line)?,
    };
    let excerpt = one_line(line, place.at);
    let mark = AnnotationKind::Context
        .span(excerpt.primary.clone())
        .label(place.words.as_str());
    (!excerpt.shortened).then(|| {
        Snippet::source(excerpt.text)
            .line_start(excerpt.first_line)
            .path(place.path.as_str())
            .annotation(mark)
    })
}

/// The part of a text that is shown.
struct Excerpt<'a> {
    text: &'a str,
    first_line: usize,
    /// Whether the text is not the whole of its line.
    shortened: bool,
    /// In bytes of `text`.
    primary: Range<usize>,
    also: Vec<(Range<usize>, &'a str)>,
}

impl<'a> Excerpt<'a> {
    fn snippet(&self, problem: &'a Problem) -> Snippet<'a, annotate_snippets::Annotation<'a>> {
        let mut primary = AnnotationKind::Primary.span(self.primary.clone());
        if !problem.label.is_empty() {
            primary = primary.label(problem.label.as_str());
        }
        let also = self
            .also
            .iter()
            .map(|(range, words)| AnnotationKind::Context.span(range.clone()).label(*words));
        let snippet = Snippet::source(self.text)
            .line_start(self.first_line)
            .annotation(primary)
            .annotations(also);
        match self.shortened || problem.path.is_empty() {
            true => snippet,
            false => snippet.path(problem.path.as_str()),
        }
    }
}

fn excerpt(problem: &Problem) -> Option<Excerpt<'_>> {
    if problem.at.line == 0 {
        return None;
    }
    match &problem.source {
        SourceText::Missing => None,
        SourceText::Line(line) => Some(one_line(line, problem.at)),
        SourceText::Whole(text) => {
            let lines = || {
                problem
                    .also
                    .iter()
                    .map(|also| also.at.line)
                    .filter(|line| *line > 0)
            };
            let first = lines().fold(problem.at.line, u32::min);
            let last = lines().fold(problem.at.line, u32::max);
            match several_lines(text, first, last, problem) {
                Some(excerpt) => Some(excerpt),
                None => line_of(text, problem.at.line).map(|line| one_line(line, problem.at)),
            }
        }
    }
}

/// One line, shortened if it is very long.
fn one_line(line: &str, at: Span) -> Excerpt<'_> {
    let line = line.trim_end_matches(['\r', '\n']);
    let shortened = line.chars().count() > LONGEST_LINE_CHARS;
    let cut = match shortened {
        true => {
            let first = (at.column as usize).saturating_sub(LEAD_CHARS);
            byte_of(line, first)..byte_of(line, first + LONGEST_LINE_CHARS)
        }
        false => 0..line.len(),
    };
    let marked = range_in(line, at);
    let clip = |byte: usize| byte.clamp(cut.start, cut.end) - cut.start;
    Excerpt {
        text: &line[cut.clone()],
        first_line: at.line as usize,
        shortened,
        primary: clip(marked.start)..clip(marked.end),
        also: Vec::new(),
    }
}

/// The lines from `first` to `last`; `None` if there is only one place, or too much text.
fn several_lines<'a>(
    text: &'a str,
    first: u32,
    last: u32,
    problem: &'a Problem,
) -> Option<Excerpt<'a>> {
    if problem.also.is_empty() {
        return None;
    }
    let start = line_of(text, first)?.as_ptr() as usize - text.as_ptr() as usize;
    let last_line = line_of(text, last)?;
    let end = last_line.as_ptr() as usize - text.as_ptr() as usize + last_line.len();
    if end - start > LONGEST_EXCERPT_BYTES {
        return None;
    }
    let range = |span: Span| {
        let line = line_of(text, span.line)?;
        let offset = line.as_ptr() as usize - text.as_ptr() as usize - start;
        let within = range_in(line, span);
        Some(offset + within.start..offset + within.end)
    };
    let also: Option<Vec<_>> = problem
        .also
        .iter()
        .map(|also| Some((range(also.at)?, also.words.as_str())))
        .collect();
    Some(Excerpt {
        text: &text[start..end],
        first_line: first as usize,
        shortened: false,
        primary: range(problem.at)?,
        also: also?,
    })
}

fn line_of(text: &str, line: u32) -> Option<&str> {
    text.lines().nth((line as usize).checked_sub(1)?)
}

/// The bytes of `line` that `span` marks: at least something.
fn range_in(line: &str, span: Span) -> Range<usize> {
    if span.column == 0 {
        let indent = line.len() - line.trim_start().len();
        return indent..line.len();
    }
    let start = byte_of(line, span.column as usize - 1);
    let end = byte_of(line, (span.end_column.max(span.column + 1)) as usize - 1);
    start..end.max(start)
}

/// The byte at which character `index` (from 0) of `line` starts; its end if there are fewer.
fn byte_of(line: &str, index: usize) -> usize {
    line.char_indices()
        .nth(index)
        .map_or(line.len(), |(byte, _)| byte)
}
