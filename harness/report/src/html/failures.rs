//! What kept a case from passing: expected against actual, byte by byte, and the frames around it.

use std::fmt::Write;

use fieldproof_record::{CaseFinished, CaseStarted, Direction, ExcerptLine, Failure};

use super::markup::{badge, escape};
use crate::case_text::{cite, seconds};
use crate::difference::compare;

/// The case in full, for the list of what did not pass.
pub(super) fn block(number: u64, started: &CaseStarted, finished: &CaseFinished) -> String {
    let mut text = format!(
        "<article class=\"finding {}\" id=\"finding-{number}\"><h4>{} <a href=\"#case-{number}\"><code>{}</code></a></h4>\
         <p class=\"purpose\">{}</p>",
        finished.verdict.name(),
        badge(finished.verdict),
        breakable(&started.id),
        escape(&started.title),
    );
    let sources: Vec<String> = started.cites.iter().map(cite).collect();
    if !sources.is_empty() {
        say(
            &mut text,
            format_args!("<p class=\"sources\">{}</p>", escape(&sources.join(" · "))),
        );
    }
    text.push_str(&failure_markup(finished));
    text.push_str(&frames(&finished.excerpt));
    text.push_str("</article>\n");
    text
}

/// An id that may be broken where its parts end.
pub(crate) fn breakable(id: &str) -> String {
    escape(id)
        .replace('/', "/<wbr>")
        .replace('.', ".<wbr>")
        .replace(',', ",<wbr>")
        .replace('[', "<wbr>[")
}

/// What was expected and what came, for each failure.
pub(super) fn failure_markup(finished: &CaseFinished) -> String {
    let mut text = String::new();
    for failure in &finished.failures {
        text.push_str(&one(failure));
    }
    text
}

fn one(failure: &Failure) -> String {
    let mut text = format!(
        "<div class=\"what\"><p><strong>{}</strong></p>",
        escape(&failure.what)
    );
    let comparison = compare(&failure.expected, &failure.actual);
    let marks = comparison.marks.as_deref().unwrap_or("");
    let (expected, came) = (&comparison.expected, &comparison.came);
    if !expected.is_empty() || !came.is_empty() {
        say(
            &mut text,
            format_args!(
                "<dl class=\"compare\"><dt>expected</dt><dd><code>{}</code></dd><dt>came</dt><dd><code>{}</code></dd></dl>",
                marked(expected, marks),
                marked(came, marks)
            ),
        );
    }
    for note in &failure.notes {
        say(
            &mut text,
            format_args!("<p class=\"note\">{}</p>", escape(note)),
        );
    }
    let place = &failure.place;
    if place.line > 0 {
        say(
            &mut text,
            format_args!(
                "<p class=\"place\"><code>{}:{}</code> <code>{}</code></p>",
                escape(&place.path),
                place.line,
                escape(place.text.trim())
            ),
        );
    }
    text.push_str("</div>");
    text
}

/// `line` with what stands above a mark marked.
fn marked(line: &str, marks: &str) -> String {
    let mut text = String::new();
    let mut open = false;
    let mut marks = marks.chars();
    let mut piece = String::new();
    let flush = |text: &mut String, piece: &mut String, open: bool| {
        if piece.is_empty() {
            return;
        }
        let words = escape(piece);
        match open {
            true => say(text, format_args!("<mark>{words}</mark>")),
            false => text.push_str(&words),
        }
        piece.clear();
    };
    for character in line.chars() {
        let is_marked = marks.next() == Some('^');
        if is_marked != open {
            flush(&mut text, &mut piece, open);
            open = is_marked;
        }
        piece.push(character);
    }
    flush(&mut text, &mut piece, open);
    text
}

fn frames(excerpt: &[ExcerptLine]) -> String {
    if excerpt.is_empty() {
        return String::new();
    }
    let mut text = "<div class=\"scroll\" role=\"region\" aria-label=\"the frames around it\" tabindex=\"0\"><table class=\"frames\"><thead><tr>\
         <th scope=\"col\">time</th><th scope=\"col\">port</th><th scope=\"col\"><span class=\"hidden\">direction</span></th>\
         <th scope=\"col\">bytes</th><th scope=\"col\">meaning</th></tr></thead><tbody>".to_owned();
    for line in excerpt {
        let class = if line.marked { " class=\"marked\"" } else { "" };
        say(
            &mut text,
            format_args!(
                "<tr{class}><td class=\"n\">{}</td><td>{}</td><td>{}</td><td><code>{}</code></td><td>{}</td></tr>",
                seconds(line.at_ns),
                escape(&line.port),
                arrow(line.direction),
                escape(&line.raw),
                escape(&line.decoded)
            ),
        );
    }
    text.push_str("</tbody></table></div>");
    text
}

const fn arrow(direction: Direction) -> &'static str {
    match direction {
        Direction::Sent => {
            "<span title=\"sent by the tester\">→</span><span class=\"hidden\">sent</span>"
        }
        Direction::Received => {
            "<span title=\"received from the device\">←</span><span class=\"hidden\">received</span>"
        }
        Direction::Companion => {
            "<span title=\"sent by a companion of the tester\">⇢</span><span class=\"hidden\">companion</span>"
        }
    }
}

fn say(text: &mut String, words: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = text.write_fmt(words);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_that_differ_are_marked_and_text_stays_text() {
        assert_eq!(marked("581#80<2", "      ^^"), "581#80<mark>&lt;2</mark>");
        assert_eq!(marked("a&b", ""), "a&amp;b");
        assert_eq!(marked("ab", "^^^^"), "<mark>ab</mark>");
    }
}
