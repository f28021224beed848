//! What every page has: its style, and what is printed in its margins.

use super::markup::escape;

const STYLE: &str = include_str!("report.css");

/// The beginning of a page, up to its body.
pub(super) fn begin(kind: &str, title: &str, date: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{} – {kind}</title>\n<style>\n{STYLE}\n{}</style>\n</head>\n<body>\n",
        escape(title),
        print_margins(kind, title, date),
    )
}

/// A whole page that needs no script.
pub(crate) fn shell(kind: &str, title: &str, date: &str, body: &str) -> String {
    format!("{}{body}</body>\n</html>\n", begin(kind, title, date))
}

/// What stands in the margins of each printed page. These cannot be taken from the page itself.
fn print_margins(kind: &str, title: &str, date: &str) -> String {
    let quoted = |text: &str| {
        let plain = text.replace(['\\', '"', '<', '\n'], " ");
        format!("\"{plain}\"")
    };
    format!(
        "@page {{ @top-left {{ content: {} }} @top-right {{ content: {} }} }}\n",
        quoted(&format!("{title} – {kind}")),
        quoted(date)
    )
}
