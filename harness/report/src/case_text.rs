//! A case that did not simply pass, in full: what it follows, what kept it from passing, the frames around it.

use std::fmt::Write;

use fieldproof_record::{CaseFinished, CaseStarted, Cite, Direction, ExcerptLine, Failure};

use crate::difference::compare;
use crate::ink::Ink;
use crate::problem::Problem;
use crate::render::render;

/// The case in full, ending with a line feed. It starts with the title; the id is left to the caller.
pub fn case_text(started: &CaseStarted, finished: &CaseFinished, ink: Ink) -> String {
    let mut text = String::new();
    line(&mut text, "  ", &started.title);
    citations(&mut text, started);
    if let Some(reason) = &finished.reason {
        line(&mut text, "  ", reason);
    }
    for failure in &finished.failures {
        text.push('\n');
        text.push_str(&failure_text(failure, ink));
    }
    if !finished.excerpt.is_empty() {
        text.push_str("\n  the frames around it (seconds since the lane was opened):\n");
        frames(&mut text, &finished.excerpt, ink);
    }
    text
}

/// A citation for people: the document, then the section.
pub(crate) fn cite(cite: &Cite) -> String {
    match &cite.section {
        Some(section) => format!("{}, {section}", cite.document),
        None => cite.document.clone(),
    }
}

/// Nanoseconds as seconds with nine decimals.
pub(crate) fn seconds(nanoseconds: u64) -> String {
    format!(
        "{}.{:09}",
        nanoseconds / 1_000_000_000,
        nanoseconds % 1_000_000_000
    )
}

fn citations(text: &mut String, started: &CaseStarted) {
    for source in &started.cites {
        line(text, "  follows ", &cite(source));
    }
    for source in &started.against {
        line(text, "  against ", &cite(source));
    }
    if let Some(because) = &started.because {
        line(text, "  because ", because);
    }
    if !started.examples.is_empty() {
        line(text, "  plays ", &started.examples.join(", "));
    }
}

fn failure_text(failure: &Failure, ink: Ink) -> String {
    let mut text = render(&Problem::from(failure), ink);
    let comparison = compare(&failure.expected, &failure.actual);
    if !comparison.expected.is_empty() {
        line(&mut text, "  expected  ", &comparison.expected);
    }
    if !comparison.came.is_empty() {
        line(&mut text, "      came  ", &comparison.came);
    }
    if let Some(marks) = &comparison.marks {
        line(
            &mut text,
            "            ",
            &ink.verdict(failure.verdict, marks),
        );
    }
    text
}

fn frames(text: &mut String, excerpt: &[ExcerptLine], ink: Ink) {
    let widest = |of: fn(&ExcerptLine) -> &str| {
        excerpt
            .iter()
            .map(|line| of(line).chars().count())
            .max()
            .unwrap_or(0)
    };
    let at_width = excerpt
        .iter()
        .map(|line| seconds(line.at_ns).len())
        .max()
        .unwrap_or(0);
    let port_width = widest(|line| &line.port);
    let raw_width = widest(|line| &line.raw);
    for frame in excerpt {
        let mark = if frame.marked { '>' } else { ' ' };
        let direction = match frame.direction {
            Direction::Sent => "sent",
            Direction::Received => "received",
            Direction::Companion => "companion",
        };
        let shown = format!(
            "{mark} {:>at_width$}  {:<port_width$}  {direction:<9}  {:<raw_width$}  {}",
            seconds(frame.at_ns),
            frame.port,
            frame.raw,
            frame.decoded,
        );
        match frame.marked {
            true => line(text, "  ", &ink.bold(shown.trim_end())),
            false => line(text, "  ", shown.trim_end()),
        }
    }
}

/// `words` after `lead`; further lines of `words` are set under the first.
fn line(text: &mut String, lead: &str, words: &str) {
    for (index, words) in words.lines().enumerate() {
        let lead = if index == 0 {
            lead
        } else {
            &" ".repeat(lead.len())
        };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{lead}{words}");
    }
}
