//! A comparison as a page.

use std::fmt::Write;

use super::text::lists;
use super::{Change, ComparedRun, Comparison, DeviceComparison, MovedSeries};
use crate::html::{badge, breakable, escape, percent, shell, time};

/// The comparison as one HTML file without outside references.
pub fn comparison_html(comparison: &Comparison) -> String {
    let (class, word) = match (comparison.regressed, comparison.waiver_expired) {
        (true, _) => ("fail", "Worse than before"),
        (false, true) => ("fail", "A waiver has expired"),
        (false, false) => ("pass", "No worse than before"),
    };
    let mut body = format!(
        "<header class=\"masthead\"><p class=\"kind\">Comparison of two runs</p><p class=\"made\">{}</p></header>\n<main>\n<h1>{}</h1>\n\
         <div class=\"verdict {class}\"><p class=\"word\">{word}</p></div>\n",
        escape(&comparison.new.tool),
        escape(&title(comparison)),
    );
    body.push_str(&runs(comparison));
    for device in &comparison.devices {
        body.push_str(&device_markup(device));
    }
    if !comparison.waivers.is_empty() {
        body.push_str("<h2>Waivers</h2>\n<ul>");
        for line in &comparison.waivers {
            let _ = write!(body, "<li>{}</li>", escape(line));
        }
        body.push_str("</ul>\n");
    }
    body.push_str("</main>\n");
    let date = comparison.new.started.get(..10).unwrap_or_default();
    shell("Comparison of two runs", &title(comparison), date, &body)
}

fn title(comparison: &Comparison) -> String {
    match comparison.devices.as_slice() {
        [device] => device.device.clone(),
        devices => format!("{} devices", devices.len()),
    }
}

fn runs(comparison: &Comparison) -> String {
    let settings = |run: &ComparedRun| {
        let said = run.settings.iter();
        let said: Vec<String> = said.map(|it| format!("{} {}", it.key, it.value)).collect();
        said.join(", ")
    };
    let rows = [
        (
            "journal",
            comparison.old.path.clone(),
            comparison.new.path.clone(),
        ),
        (
            "started",
            comparison.old.started.clone(),
            comparison.new.started.clone(),
        ),
        (
            "tool",
            comparison.old.tool.clone(),
            comparison.new.tool.clone(),
        ),
        ("said", settings(&comparison.old), settings(&comparison.new)),
        (
            "complete",
            yes(comparison.old.complete),
            yes(comparison.new.complete),
        ),
    ];
    let mut text = "<div class=\"scroll\" role=\"region\" aria-label=\"runs\" tabindex=\"0\"><table class=\"facts\"><thead><tr><th scope=\"col\">run</th>\
         <th scope=\"col\">old</th><th scope=\"col\">new</th></tr></thead><tbody>".to_owned();
    for (name, old, new) in rows {
        let (old, new) = (escape(&old), escape(&new));
        let _ = write!(
            text,
            "<tr><th scope=\"row\">{name}</th><td>{old}</td><td>{new}</td></tr>"
        );
    }
    text.push_str("</tbody></table></div>\n");
    text
}

fn yes(is: bool) -> String {
    if is { "yes" } else { "no" }.to_owned()
}

fn device_markup(device: &DeviceComparison) -> String {
    let firmware = |it: &Option<String>| escape(it.as_deref().unwrap_or("unknown")).into_owned();
    let mut text = format!(
        "<h2>{} <small>firmware {} → {}</small></h2>\n<p class=\"lead\">{} cases came to the same.</p>\n",
        escape(&device.device),
        firmware(&device.old_firmware),
        firmware(&device.new_firmware),
        device.same
    );
    for (heading, list, _) in lists(device) {
        if !list.is_empty() {
            let _ = writeln!(
                text,
                "<details class=\"part\" open><summary><h3>{heading} <span class=\"many\">{}</span></h3></summary>{}</details>",
                list.len(),
                changes(heading, list)
            );
        }
    }
    if !device.moved.is_empty() || !device.steady.is_empty() {
        text.push_str("<h3>Measured</h3>\n");
        text.push_str(&series(device));
    }
    text
}

fn changes(heading: &str, list: &[Change]) -> String {
    let mut text = format!(
        "<div class=\"scroll\" role=\"region\" aria-label=\"{heading}\" tabindex=\"0\"><table><thead><tr><th scope=\"col\">case</th>\
         <th scope=\"col\">old</th><th scope=\"col\">new</th><th scope=\"col\">what</th></tr></thead><tbody>"
    );
    for change in list {
        let word = |verdict| Option::map_or(verdict, String::new(), badge);
        let waived = change
            .waived
            .as_ref()
            .map(|why| format!("<br>accepted: {}", escape(why)));
        let _ = write!(
            text,
            "<tr><th scope=\"row\"><code>{}</code><br><span class=\"none\">{}</span></th><td>{}</td><td>{}</td><td>{}{}</td></tr>",
            breakable(&change.id),
            escape(&change.title),
            word(change.old),
            word(change.new),
            escape(&change.what),
            waived.unwrap_or_default()
        );
    }
    text.push_str("</tbody></table></div>");
    text
}

fn series(device: &DeviceComparison) -> String {
    let mut text = "<div class=\"scroll\" role=\"region\" aria-label=\"measured\" tabindex=\"0\"><table><thead><tr><th scope=\"col\">what</th>\
         <th scope=\"col\" class=\"n\">cases</th><th scope=\"col\" class=\"n\">old median</th><th scope=\"col\" class=\"n\">new median</th>\
         <th scope=\"col\" class=\"n\">change</th><th scope=\"col\" class=\"n\">of the limit</th><th scope=\"col\" class=\"n\">p</th><th scope=\"col\">verdict</th></tr></thead><tbody>".to_owned();
    let moved = device.moved.iter().map(|it| (it, "moved"));
    for (it, word) in moved.chain(device.steady.iter().map(|it| (it, "steady"))) {
        text.push_str(&series_row(it, word));
    }
    text.push_str("</tbody></table></div>\n");
    text
}

fn series_row(it: &MovedSeries, word: &str) -> String {
    let sign = if it.change < 0.0 { "−" } else { "+" };
    let share = |it: Option<f64>| it.map_or_else(|| "–".to_owned(), percent);
    let class = match (word, it.change > 0.0) {
        ("moved", true) => "inconclusive",
        ("moved", false) => "pass",
        _ => "skipped",
    };
    format!(
        "<tr><th scope=\"row\">{}</th><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{sign}{}</td>\
         <td class=\"n\">{} → {}</td><td class=\"n\">{:.1e}</td><td class=\"v {class}\">{word}</td></tr>",
        escape(&it.name),
        it.cases,
        time(it.old_median_ns),
        time(it.new_median_ns),
        percent(it.change.abs()),
        share(it.of_limit.0),
        share(it.of_limit.1),
        it.p
    )
}
