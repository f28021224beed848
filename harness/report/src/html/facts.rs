//! Who the device is, who tested it, and with what.

use std::fmt::Write;

use fieldproof_record::{IdentityPart, RunStarted, UsedFile};

use super::lane::Lane;
use super::markup::{escape, time};

/// What the device says of itself against its description.
pub(super) fn identity(parts: &[IdentityPart]) -> String {
    if parts.is_empty() {
        return "<p class=\"none\">The device was not asked who it is: its description claims nothing that could be read.</p>".to_owned();
    }
    let mut text = "<div class=\"scroll\" role=\"region\" aria-label=\"identity\" tabindex=\"0\"><table class=\"facts\"><thead><tr><th scope=\"col\">identity</th>\
         <th scope=\"col\">object</th><th scope=\"col\">read from the device</th><th scope=\"col\">described</th></tr></thead><tbody>"
        .to_owned();
    for part in parts {
        let (class, sign) = match part.agrees() {
            Some(true) => (
                "agrees",
                " <span class=\"agree\" title=\"agrees\">✓</span><span class=\"hidden\">agrees</span>",
            ),
            Some(false) => (
                "differs",
                " <span class=\"differ\" title=\"differs\">≠</span><span class=\"hidden\">differs</span>",
            ),
            None => ("open", ""),
        };
        let read = match (&part.read, &part.unread) {
            (Some(read), _) => format!("<code>{}</code>", escape(read)),
            (None, Some(why)) => format!("<span class=\"none\">{}</span>", escape(why)),
            (None, None) => "<span class=\"none\">not there</span>".to_owned(),
        };
        let described = part
            .described
            .as_ref()
            .map(|it| format!("<code>{}</code>", escape(it)));
        let _ = write!(
            text,
            "<tr class=\"{class}\"><th scope=\"row\">{}</th><td class=\"object\">{}</td><td>{read}</td><td>{}{sign}</td></tr>",
            escape(&part.name.replace('-', " ")),
            escape(&part.object),
            described.unwrap_or_else(
                || "<span class=\"none\" title=\"nothing claimed\">–</span>".to_owned()
            ),
        );
    }
    text.push_str("</tbody></table></div>");
    text
}

/// The names of what people say about a run, where they are known.
fn name_of(key: &str) -> &str {
    match key {
        "order" => "order number",
        "serial" => "serial number",
        other => other,
    }
}

/// The facts of a run, and of one lane of it.
pub(super) fn facts(run: &RunStarted, lane: &Lane) -> String {
    let mut rows: Vec<(String, String)> = Vec::new();
    let mut row = |name: &str, value: String| rows.push((name.to_owned(), value));
    for (name, part) in [
        ("serial number", "serial-number"),
        ("firmware", "software-version"),
    ] {
        let said = run.settings.iter().any(|it| name_of(&it.key) == name);
        let read = lane.identity.iter().find(|it| it.name == part);
        if let Some(read) = read.and_then(|it| it.read.as_ref())
            && !said
        {
            row(
                name,
                format!(
                    "<code>{}</code> <span class=\"none\">as read</span>",
                    escape(read)
                ),
            );
        }
    }
    for setting in &run.settings {
        row(name_of(&setting.key), escape(&setting.value).into_owned());
    }
    if let Some(started) = &lane.started {
        if let Some(fault) = &started.fault {
            row(
                "fault switched on",
                format!("<code>{}</code>", escape(fault)),
            );
        }
        if let Some(variant) = &started.variant {
            row("variant", format!("<code>{}</code>", escape(variant)));
        }
        for port in &started.ports {
            let name = format!("port {}", port.name);
            row(
                &name,
                format!(
                    "<code>{}</code> {}<br><span class=\"none\">instants: {} ± {}</span>",
                    escape(&port.link),
                    escape(&port.line),
                    escape(&port.timestamps),
                    time(port.uncertainty_ns)
                ),
            );
        }
    }
    let bench = run
        .bench
        .as_deref()
        .unwrap_or("reference device, simulated");
    row("bench", escape(bench).into_owned());
    if lane.summary.complete {
        row("lane time", time(lane.summary.lane_time_ns));
    }
    let mut text = "<table class=\"facts\"><tbody>".to_owned();
    for (name, value) in rows {
        let _ = write!(
            text,
            "<tr><th scope=\"row\">{}</th><td>{value}</td></tr>",
            escape(&name)
        );
    }
    text.push_str("</tbody></table>");
    text
}

/// What holds for the run as a whole.
pub(super) fn run(run: &RunStarted) -> String {
    let rows = [
        ("started", escape(&run.started).into_owned()),
        ("tool", escape(&run.tool).into_owned()),
        (
            "arguments",
            format!("<code>{}</code>", escape(&run.arguments.join(" "))),
        ),
        ("depth", escape(&run.depth).into_owned()),
        (
            "documented deviations",
            if run.strict {
                "fail (strict)"
            } else {
                "accepted and listed"
            }
            .to_owned(),
        ),
        ("seed", run.seed.to_string()),
    ];
    let mut text = "<table class=\"facts\"><tbody>".to_owned();
    for (name, value) in rows {
        let _ = write!(
            text,
            "<tr><th scope=\"row\">{name}</th><td>{value}</td></tr>"
        );
    }
    text.push_str("</tbody></table>");
    text
}

/// Every file with its hash.
pub(super) fn files(files: &[UsedFile]) -> String {
    let mut text = "<div class=\"scroll\" role=\"region\" aria-label=\"files and hashes\" tabindex=\"0\"><table class=\"files\"><thead><tr><th scope=\"col\">kind</th>\
         <th scope=\"col\">file</th><th scope=\"col\">SHA-256</th></tr></thead><tbody>".to_owned();
    for file in files {
        let _ = write!(
            text,
            "<tr><td>{}</td><td><code>{}</code></td><td><code class=\"hash\">{}</code></td></tr>",
            escape(&file.kind),
            escape(&file.path),
            escape(&file.sha256)
        );
    }
    text.push_str("</tbody></table></div>");
    text
}
