//! Measured times, as a table and as plots.

use std::fmt::Write;

use fieldproof_record::Verdict;

use super::lane::Lane;
use super::markup::{count, escape, time};
use super::plots;
use super::series::{Period, Series};

/// Everything that was measured on a lane.
pub(super) fn measured(lane: &Lane) -> String {
    let mut text = String::new();
    let mut table = String::new();
    for (name, series) in &lane.measured.series {
        let mut series_sorted = Series {
            values_ns: series.values_ns.clone(),
            max_ns: series.max_ns,
            nearest: series.nearest,
        };
        series_sorted.values_ns.sort_unstable();
        let series = &series_sorted;
        let number = series.values_ns.len() as u64;
        let value = |share: f64| time(series.quantile(share));
        let _ = write!(
            table,
            "<tr><th scope=\"row\">{}</th><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td>\
             <td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>",
            escape(name),
            count(number),
            value(0.0),
            value(0.5),
            value(0.95),
            value(0.99),
            value(1.0),
            series.nearest.map_or_else(String::new, plots::percent)
        );
        if number >= 10 && (name.contains("SDO") || name.contains("Modbus")) {
            let caption = format!(
                "<strong>{}</strong> {} values; {}.",
                escape(name),
                count(number),
                match series.max_ns {
                    None => "no limit was asked for".to_owned(),
                    Some(limit) => format!("the tightest limit is {}", time(limit)),
                }
            );
            text.push_str(&plots::figure(&plots::distribution(name, series), &caption));
        }
    }
    text.push_str(&periods(lane));
    for (port, load) in lane.bus_load.iter().filter(|(_, load)| load.frames > 0) {
        let caption = format!(
            "<strong>Load of the bus</strong> on port {}: {} frames at {} kbit/s in slices of {}; stuff bits are not counted.",
            escape(port),
            count(load.frames),
            load.bits_per_second / 1_000,
            time(load.width_ns)
        );
        text.push_str(&plots::figure(&plots::bus_load(port, load), &caption));
    }
    if table.is_empty() && text.is_empty() {
        return text;
    }
    format!(
        "<h3>Measured</h3>\n<div class=\"scroll\" role=\"region\" aria-label=\"measured times\" tabindex=\"0\"><table class=\"measured\"><thead><tr><th scope=\"col\">what</th>\
         <th scope=\"col\" class=\"n\">values</th><th scope=\"col\" class=\"n\">least</th><th scope=\"col\" class=\"n\">median</th>\
         <th scope=\"col\" class=\"n\">95 %</th><th scope=\"col\" class=\"n\">99 %</th><th scope=\"col\" class=\"n\">most</th>\
         <th scope=\"col\" class=\"n\">of its limit</th></tr></thead><tbody>{table}</tbody></table></div>\n<div class=\"figures\">{text}</div>\n"
    )
}

fn periods(lane: &Lane) -> String {
    let mut names: Vec<&str> = Vec::new();
    for period in &lane.measured.periods {
        if !names.contains(&period.name.as_str()) {
            names.push(&period.name);
        }
    }
    let mut text = String::new();
    for name in names {
        let of_name = lane.measured.periods.iter().filter(|it| it.name == name);
        let of_name: Vec<&Period> = of_name.collect();
        let outside = of_name.iter().filter(|it| it.verdict != Verdict::Pass);
        let caption = format!(
            "<strong>{}</strong> {} between the limits of their cases; {}.",
            escape(name),
            match of_name.len() {
                1 => "one value".to_owned(),
                number => format!("{} values", count(number as u64)),
            },
            match outside.count() {
                0 => "all inside".to_owned(),
                number => format!("{number} not inside"),
            }
        );
        text.push_str(&plots::figure(&plots::periods(&of_name), &caption));
    }
    if lane.measured.periods_left_out > 0 {
        let _ = write!(
            text,
            "<p class=\"none\">{} more periods are not drawn.</p>",
            count(lane.measured.periods_left_out)
        );
    }
    text
}
