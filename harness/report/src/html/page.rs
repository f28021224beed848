//! The page: what a reader sees before any script has run.

use std::fmt::Write as _;
use std::io::{self, Write};

use fieldproof_record::{RunStarted, Verdict, VerdictCounts};

use super::coverage::Tally;
use super::lane::Lane;
use super::markup::{cases, count, escape, sign};
use super::measured::measured;
use super::{facts, shell, verdict_of};

const SCRIPT: &str = include_str!("report.js");

/// Verdicts in the order a reader looks for them.
const ORDER: [Verdict; 6] = [
    Verdict::Pass,
    Verdict::Deviation,
    Verdict::Fail,
    Verdict::Inconclusive,
    Verdict::Error,
    Verdict::Skipped,
];

pub(super) fn write(
    out: &mut impl Write,
    run: &RunStarted,
    lanes: &[Lane],
    incomplete: Option<&str>,
) -> io::Result<()> {
    let title = title(run, lanes);
    let date = run.started.get(..10).unwrap_or(&run.started);
    out.write_all(shell::begin("conformance report", &title, date).as_bytes())?;
    out.write_all(head(run, lanes, &title, incomplete).as_bytes())?;
    for lane in lanes {
        out.write_all(section(run, lane, lanes.len() > 1).as_bytes())?;
    }
    out.write_all(case_list(lanes).as_bytes())?;
    out.write_all(of_the_run(run).as_bytes())?;
    out.write_all(b"</main>\n")
}

pub(super) fn write_end(out: &mut impl Write) -> io::Result<()> {
    write!(out, "<script>\n{SCRIPT}</script>\n</body>\n</html>\n")
}

fn title(run: &RunStarted, lanes: &[Lane]) -> String {
    match lanes {
        [lane] => match &lane.started {
            Some(started) => started.title.clone(),
            None => lane.summary.device.clone(),
        },
        _ => format!("{} devices", run.lanes.len()),
    }
}

fn head(run: &RunStarted, lanes: &[Lane], title: &str, incomplete: Option<&str>) -> String {
    let mut text = format!(
        "<a class=\"skip\" href=\"#cases\">To the cases</a>\n<header class=\"masthead\"><p class=\"kind\">Conformance report</p>\
         <p class=\"made\">{}<span class=\"date\">{}</span></p><button type=\"button\" id=\"theme\" hidden>Dark</button></header>\n\
         <main>\n<h1>{}</h1>\n",
        escape(&run.tool),
        escape(&run.started.replace('T', " ").replace('Z', " UTC")),
        escape(title)
    );
    if let Some(why) = incomplete {
        let _ = writeln!(
            text,
            "<p class=\"incomplete\" role=\"alert\"><strong>This run is incomplete.</strong> {}.</p>",
            escape(why)
        );
    }
    if lanes.len() > 1 {
        text.push_str(&overview(run, lanes));
    }
    text
}

fn overview(run: &RunStarted, lanes: &[Lane]) -> String {
    let mut text = "<div class=\"scroll\" role=\"region\" aria-label=\"devices\" tabindex=\"0\"><table class=\"overview\"><thead><tr><th scope=\"col\">device</th><th scope=\"col\">verdict</th>".to_owned();
    for verdict in ORDER {
        let _ = write!(text, "<th scope=\"col\" class=\"n\">{verdict}</th>");
    }
    text.push_str("</tr></thead><tbody>");
    for lane in lanes {
        let (class, words) = verdict_of(&lane.summary, run.strict);
        let _ = write!(
            text,
            "<tr><th scope=\"row\"><a href=\"#lane-{}\">{}</a></th><td class=\"v {class}\">{words}</td>",
            lane.number,
            escape(&lane.summary.device)
        );
        numbers(&mut text, lane.summary.counts, &ORDER);
        text.push_str("</tr>");
    }
    text.push_str("</tbody></table></div>\n");
    text
}

fn numbers(text: &mut String, counts: VerdictCounts, columns: &[Verdict]) {
    for verdict in columns {
        let number = counts.of(*verdict);
        let class = if number == 0 { "zero" } else { verdict.name() };
        let _ = write!(
            text,
            "<td class=\"n {class}\">{}</td>",
            count(number.into())
        );
    }
}

fn section(run: &RunStarted, lane: &Lane, several: bool) -> String {
    let number = lane.number;
    let mut text = format!("<section class=\"lane\" id=\"lane-{number}\">\n");
    if several {
        let title = lane.started.as_ref().map_or("", |it| it.title.as_str());
        let _ = writeln!(
            text,
            "<h2 class=\"device\">{} <small>{}</small></h2>",
            escape(&lane.summary.device),
            escape(title)
        );
    }
    text.push_str(&verdict(run, lane, several));
    let _ = writeln!(
        text,
        "<div class=\"columns\"><div>{}</div><div>{}</div></div>",
        facts::identity(&lane.identity),
        facts::facts(run, lane)
    );
    text.push_str(&findings(lane));
    text.push_str(&coverage(lane));
    text.push_str(&measured(lane));
    text.push_str("</section>\n");
    text
}

fn verdict(run: &RunStarted, lane: &Lane, several: bool) -> String {
    let (class, words) = verdict_of(&lane.summary, run.strict);
    let counts = lane.summary.counts;
    let applies = counts.total() - counts.skipped;
    let mut parts = Vec::new();
    let mut part = |number: u32, words: &str| {
        if number > 0 {
            parts.push(format!("{} {words}", count(number.into())));
        }
    };
    part(counts.fail, "failed");
    part(counts.error, "could not be carried out");
    part(counts.inconclusive, "could not be decided");
    part(counts.deviation, "deviate as the manual documents");
    part(counts.skipped, "do not apply or were not permitted");
    let rest = match parts.is_empty() {
        true => String::new(),
        false => format!("; {}", parts.join(", ")),
    };
    let mut text = format!(
        "<div class=\"verdict {class}\"><p class=\"word\">{words}</p><p class=\"sentence\">{} of {} passed{rest}.</p>",
        count(counts.pass.into()),
        match applies {
            1 => "1 case that applies".to_owned(),
            _ => format!("{} cases that apply", count(applies.into())),
        },
    );
    // Where there is one lane, the head of the page says it.
    if let Some(reason) = lane.summary.stopped.as_ref().filter(|_| several) {
        let _ = write!(
            text,
            "<p class=\"stopped\">Stopped: {}.</p>",
            escape(reason)
        );
    }
    text.push_str(&bar(counts));
    text.push_str("</div>\n");
    text
}

/// The verdicts as one bar.
fn bar(counts: VerdictCounts) -> String {
    let total = counts.total().max(1);
    let mut text = "<div class=\"bar\" aria-hidden=\"true\">".to_owned();
    for verdict in ORDER {
        let number = counts.of(verdict);
        if number > 0 {
            let share = f64::from(number) / f64::from(total) * 100.0;
            let _ = write!(
                text,
                "<span class=\"{}\" style=\"width:{share:.3}%\" title=\"{number} {verdict}\"></span>",
                verdict.name()
            );
        }
    }
    text.push_str("</div>");
    text
}

fn findings(lane: &Lane) -> String {
    let mut text = String::new();
    let groups: [(&str, &[Verdict]); 2] = [
        (
            "What did not pass",
            &[Verdict::Fail, Verdict::Error, Verdict::Inconclusive],
        ),
        (
            "Deviations that the manual documents",
            &[Verdict::Deviation],
        ),
    ];
    for (heading, verdicts) in groups {
        let of_group = lane.findings.iter().filter(|(it, _)| verdicts.contains(it));
        let blocks: Vec<&str> = of_group.map(|(_, block)| block.as_str()).collect();
        if blocks.is_empty() {
            continue;
        }
        let open = if verdicts.contains(&Verdict::Fail) {
            " open"
        } else {
            ""
        };
        let _ = writeln!(
            text,
            "<details class=\"part\"{open}><summary><h3>{heading} <span class=\"many\">{}</span></h3></summary>{}</details>",
            blocks.len(),
            blocks.concat()
        );
    }
    if lane.findings_left_out > 0 {
        let _ = writeln!(
            text,
            "<p class=\"none\">{} more did not simply pass; they are in the list of cases.</p>",
            count(lane.findings_left_out)
        );
    }
    text
}

/// The verdicts that a table of coverage has columns for: those that there are, and those that everybody looks for.
fn columns(lane: &Lane) -> Vec<Verdict> {
    let always = [Verdict::Pass, Verdict::Fail, Verdict::Skipped];
    let counts = lane.coverage.all.counts;
    let mut columns = ORDER.to_vec();
    columns.retain(|verdict| always.contains(verdict) || counts.of(*verdict) > 0);
    columns
}

fn coverage(lane: &Lane) -> String {
    let columns = columns(lane);
    let heads: String = columns
        .iter()
        .map(|verdict| format!("<th scope=\"col\" class=\"n\">{verdict}</th>"))
        .collect();
    let mut text = format!(
        "<h3>Coverage</h3>\n<p class=\"lead\">By clause of the standard and by section of the manual. A case that follows several is counted at each.</p>\n\
         <div class=\"scroll\" role=\"region\" aria-label=\"coverage\" tabindex=\"0\"><table class=\"coverage\"><thead><tr><th scope=\"col\">section</th>\
         <th scope=\"col\" class=\"n\">cases</th><th scope=\"col\" class=\"n\">apply</th>{heads}<th scope=\"col\">why skipped</th></tr></thead>\n"
    );
    let span = columns.len() + 4;
    for (document, sections) in &lane.coverage.documents {
        let _ = writeln!(
            text,
            "<tbody><tr class=\"document\"><th scope=\"rowgroup\" colspan=\"{span}\">{}</th></tr>",
            escape(document)
        );
        for (section, tally) in sections {
            let name = match section.0.as_str() {
                "" => "as a whole",
                name => name,
            };
            text.push_str(&coverage_row(name, tally, "", &columns));
        }
        text.push_str("</tbody>\n");
    }
    let all = coverage_row(
        "every case once",
        &lane.coverage.all,
        " class=\"all\"",
        &columns,
    );
    let _ = writeln!(text, "<tbody>{all}</tbody></table></div>");
    text
}

fn coverage_row(name: &str, tally: &Tally, class: &str, columns: &[Verdict]) -> String {
    const SHOWN: usize = 3;
    let counts = tally.counts;
    let mut text = format!(
        "<tr{class}><th scope=\"row\">{}</th><td class=\"n\">{}</td><td class=\"n\">{}</td>",
        escape(name),
        count(counts.total().into()),
        count((counts.total() - counts.skipped).into())
    );
    numbers(&mut text, counts, columns);
    let mut reasons: Vec<(&String, &u32)> = tally.reasons.iter().collect();
    reasons.sort_by_key(|(_, number)| std::cmp::Reverse(**number));
    let mut words: Vec<String> = reasons
        .iter()
        .take(SHOWN)
        .map(|(reason, number)| format!("{number} × {}", escape(reason)))
        .collect();
    if reasons.len() > SHOWN {
        words.push(match reasons.len() - SHOWN {
            1 => "another reason".to_owned(),
            others => format!("{others} other reasons"),
        });
    }
    let _ = writeln!(text, "<td class=\"why\">{}</td></tr>", words.join("<br>"));
    text
}

fn case_list(lanes: &[Lane]) -> String {
    let mut all = VerdictCounts::default();
    lanes.iter().for_each(|lane| all.merge(lane.summary.counts));
    let mut text = format!(
        "<section id=\"cases\"><h2>Cases <span class=\"many\">{}</span></h2>\n\
         <noscript><p class=\"none\">The list of cases needs a script to be unpacked; <code>report.json</code>, <code>junit.xml</code> and \
         <code>report.tap</code> beside this file have them all.</p></noscript>\n<form id=\"filter\" role=\"search\" hidden>\
         <label class=\"find\"><span>Find</span><input type=\"search\" id=\"text\" placeholder=\"id, title or reason\" autocomplete=\"off\" spellcheck=\"false\"></label>",
        cases(all.total().into())
    );
    if lanes.len() > 1 {
        text.push_str("<label class=\"find\"><span>Device</span><select id=\"device\"><option value=\"\">all</option>");
        for lane in lanes {
            let _ = write!(
                text,
                "<option value=\"{}\">{}</option>",
                lane.number,
                escape(&lane.summary.device)
            );
        }
        text.push_str("</select></label>");
    }
    text.push_str("<fieldset><legend class=\"hidden\">Verdicts</legend>");
    for verdict in ORDER {
        let number = all.of(verdict);
        if number > 0 {
            let value = super::exchange::place_of(verdict);
            let _ = write!(
                text,
                "<label class=\"toggle {0}\"><input type=\"checkbox\" name=\"verdict\" value=\"{value}\" checked><span aria-hidden=\"true\">{1}</span> {0} <b>{2}</b></label>",
                verdict.name(),
                sign(verdict),
                count(number.into())
            );
        }
    }
    text.push_str(
        "</fieldset><p id=\"shown\" role=\"status\"></p>\
         <p class=\"keys\"><kbd>/</kbd> find <kbd>n</kbd> next that did not pass <kbd>Esc</kbd> show all</p></form>\n\
         <div id=\"list\" aria-busy=\"true\"></div></section>\n",
    );
    text
}

fn of_the_run(run: &RunStarted) -> String {
    format!(
        "<section id=\"run\"><h2>The run</h2>\n{}\n<h3>Files and their hashes</h3>\n\
         <p class=\"lead\">Everything that was used, as it was read. <code>SHA256SUMS</code> beside this file has the hashes of the reports, this one's too; \
         the whole traffic is in <code>traffic/</code>.</p>\n{}</section>\n",
        facts::run(run),
        facts::files(&run.files)
    )
}
