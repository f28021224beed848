//! Plots, where looking beats reading: inline SVG in the colours of the page.

use std::fmt::Write;

use fieldproof_record::Verdict;

use super::bus_load::BusLoad;
use super::markup::{count, escape, time};
use super::series::{Period, Series};

const WIDTH: f64 = 640.0;
const LEFT: f64 = 54.0;
const RIGHT: f64 = 14.0;

/// A drawing with its words for those who cannot see it.
struct Svg {
    text: String,
    height: f64,
}

impl Svg {
    fn new(height: f64, label: &str) -> Svg {
        let label = escape(label);
        let text =
            format!("<svg viewBox=\"0 0 {WIDTH} {height}\" role=\"img\" aria-label=\"{label}\">");
        Svg { text, height }
    }

    fn add(&mut self, shape: std::fmt::Arguments<'_>) {
        // Writing to a string cannot fail.
        let _ = self.text.write_fmt(shape);
    }

    fn line(&mut self, class: &str, from: (f64, f64), to: (f64, f64)) {
        let ((x1, y1), (x2, y2)) = (from, to);
        self.add(format_args!(
            "<line class=\"{class}\" x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\"/>"
        ));
    }

    fn label(&mut self, anchor: &str, at: (f64, f64), class: &str, words: &str) {
        let (x, y) = at;
        let words = escape(words);
        self.add(format_args!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" class=\"{class}\">{words}</text>"
        ));
    }

    fn finish(mut self) -> String {
        self.text.push_str("</svg>");
        self.text
    }
}

/// A figure with its caption.
pub(super) fn figure(svg: &str, caption: &str) -> String {
    format!("<figure>{svg}<figcaption>{caption}</figcaption></figure>")
}

/// How response times are distributed, and where their limit is.
pub(super) fn distribution(name: &str, series: &Series) -> String {
    const HEIGHT: f64 = 150.0;
    const BINS: usize = 64;
    let bottom = HEIGHT - 26.0;
    let lowest = series.quantile(0.0).max(1) as f64;
    let highest = series.quantile(1.0).max(2) as f64;
    // A limit far away would press all values together; it is named at the edge instead.
    let near = series
        .max_ns
        .filter(|limit| (*limit as f64) < 4.0 * highest);
    let from = (lowest / 1.25).log10();
    let to = (near.map_or(highest, |limit| highest.max(limit as f64)) * 1.25).log10();
    let x =
        |value: f64| LEFT + (value.max(1.0).log10() - from) / (to - from) * (WIDTH - LEFT - RIGHT);
    let mut bins = [0_u64; BINS];
    for value in &series.values_ns {
        let share = ((*value).max(1) as f64).log10() - from;
        let bin = (share / (to - from) * BINS as f64) as usize;
        bins[bin.min(BINS - 1)] += 1;
    }
    let most = bins.iter().copied().max().unwrap_or(1).max(1);
    let mut svg = Svg::new(HEIGHT, &distribution_in_words(name, series));
    let ticks: Vec<f64> = ticks(10_f64.powf(from), 10_f64.powf(to));
    for tick in ticks {
        let at = x(tick);
        svg.line("grid", (at, 16.0), (at, bottom));
        svg.label(
            "middle",
            (at, bottom + 16.0),
            "tick",
            &time(tick.round() as u64),
        );
    }
    let width = (WIDTH - LEFT - RIGHT) / BINS as f64;
    for (index, bin) in bins.iter().enumerate().filter(|(_, bin)| **bin > 0) {
        // A single value is to be seen beside ten thousand.
        let tall = (*bin as f64 / most as f64 * (bottom - 24.0)).max(1.5);
        svg.add(format_args!(
            "<rect class=\"column\" x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{tall:.1}\"><title>{}</title></rect>",
            LEFT + index as f64 * width + 0.5,
            bottom - tall,
            width - 1.0,
            count(*bin),
        ));
    }
    svg.line("axis", (LEFT, bottom), (WIDTH - RIGHT, bottom));
    for (share, words) in [(0.5, "median"), (0.99, "99 %")] {
        let at = x(series.quantile(share) as f64);
        svg.line("quantile", (at, 16.0), (at, bottom));
        let (anchor, shift) = if share < 0.9 {
            ("end", -3.0)
        } else {
            ("start", 3.0)
        };
        svg.label(anchor, (at + shift, 13.0), "quantile-label", words);
    }
    match (near, series.max_ns) {
        (Some(limit), _) => {
            let at = x(limit as f64);
            svg.line("limit", (at, 4.0), (at, bottom));
            svg.label(
                "end",
                (at - 3.0, bottom - 4.0),
                "limit-label",
                &format!("limit {}", time(limit)),
            );
        }
        (None, Some(limit)) => {
            let words = format!("limit {} →", time(limit));
            svg.label("end", (WIDTH - RIGHT, 13.0), "limit-label", &words);
        }
        (None, None) => {}
    }
    svg.label("end", (LEFT - 6.0, 27.0), "tick", &count(most));
    svg.finish()
}

fn distribution_in_words(name: &str, series: &Series) -> String {
    format!(
        "{name}: {} values from {} to {}, median {}, 99 of 100 at most {}",
        count(series.values_ns.len() as u64),
        time(series.quantile(0.0)),
        time(series.quantile(1.0)),
        time(series.quantile(0.5)),
        time(series.quantile(0.99)),
    )
}

/// Four to nine round numbers from `low` to `high`.
fn ticks(low: f64, high: f64) -> Vec<f64> {
    const SERIES: [&[f64]; 4] = [
        &[1.0],
        &[1.0, 3.0],
        &[1.0, 2.0, 5.0],
        &[1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0],
    ];
    let mut ticks = Vec::new();
    for series in SERIES {
        ticks.clear();
        let mut decade = 10_f64.powf(low.log10().floor());
        while decade <= high {
            let of_decade = series.iter().map(|digit| digit * decade);
            ticks.extend(of_decade.filter(|tick| (low..=high).contains(tick)));
            decade *= 10.0;
        }
        if ticks.len() >= 4 {
            break;
        }
    }
    ticks
}

/// Where periods lie between their limits, in the order they were measured.
pub(super) fn periods(periods: &[&Period]) -> String {
    const HEIGHT: f64 = 170.0;
    const TOP: f64 = 14.0;
    let bottom = HEIGHT - 22.0;
    let middle = (TOP + bottom) / 2.0;
    // The limits stand at two thirds of the way up and down.
    let reach = (bottom - TOP) / 3.0;
    let place = |value: f64, period: &Period| {
        let centre = (period.min_ns as f64 + period.max_ns as f64) / 2.0;
        let half = ((period.max_ns as f64 - period.min_ns as f64) / 2.0).max(1.0);
        let y = middle - (value - centre) / half * reach;
        y.clamp(TOP - 6.0, bottom + 6.0)
    };
    let outside = periods
        .iter()
        .filter(|it| it.verdict != Verdict::Pass)
        .count();
    let label = format!(
        "{} periods between their limits, {outside} not inside",
        periods.len()
    );
    let mut svg = Svg::new(HEIGHT, &label);
    svg.add(format_args!(
        "<rect class=\"inside\" x=\"{LEFT}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\"/>",
        middle - reach,
        WIDTH - LEFT - RIGHT,
        2.0 * reach
    ));
    for (y, words) in [
        (middle - reach, "max"),
        (middle, "nominal"),
        (middle + reach, "min"),
    ] {
        let class = if words == "nominal" { "grid" } else { "limit" };
        svg.line(class, (LEFT, y), (WIDTH - RIGHT, y));
        svg.label("end", (LEFT - 6.0, y + 3.5), "tick", words);
    }
    let step = (WIDTH - LEFT - RIGHT) / periods.len().max(1) as f64;
    let radius = (step / 2.2).clamp(1.2, 3.2);
    for (index, period) in periods.iter().enumerate() {
        let x = LEFT + (index as f64 + 0.5) * step;
        let value = period.value_ns as f64;
        let uncertainty = period.uncertainty_ns as f64;
        if period.uncertainty_ns > 0 {
            let (high, low) = (
                place(value + uncertainty, period),
                place(value - uncertainty, period),
            );
            svg.line("whisker", (x, high), (x, low));
        }
        let y = place(value, period);
        svg.add(format_args!(
            "<circle class=\"dot {}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\"><title>{}: {}, {} to {}</title></circle>",
            period.verdict.name(),
            escape(&period.case),
            time(period.value_ns),
            time(period.min_ns),
            time(period.max_ns),
        ));
    }
    svg.label("start", (LEFT, svg.height - 6.0), "tick", "first measured");
    svg.label(
        "end",
        (WIDTH - RIGHT, svg.height - 6.0),
        "tick",
        "last measured",
    );
    svg.finish()
}

/// How busy a bus was over the run.
pub(super) fn bus_load(port: &str, load: &BusLoad) -> String {
    const HEIGHT: f64 = 130.0;
    const TOP: f64 = 12.0;
    let bottom = HEIGHT - 24.0;
    let loads: Vec<f64> = load.loads().collect();
    let highest = loads.iter().copied().fold(0.0, f64::max);
    let full = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0]
        .into_iter()
        .find(|full| *full >= highest)
        .unwrap_or(1.0);
    let mean = loads.iter().sum::<f64>() / loads.len().max(1) as f64;
    let label = format!(
        "load of {port}: at most {} a slice of {}, {} on average",
        percent(highest),
        time(load.width_ns),
        percent(mean)
    );
    let mut svg = Svg::new(HEIGHT, &label);
    for share in [0.0, 0.5, 1.0] {
        let y = bottom - share * (bottom - TOP);
        let class = if share == 0.0 { "axis" } else { "grid" };
        svg.line(class, (LEFT, y), (WIDTH - RIGHT, y));
        svg.label("end", (LEFT - 6.0, y + 3.5), "tick", &percent(share * full));
    }
    let width = (WIDTH - LEFT - RIGHT) / loads.len().max(1) as f64;
    let mut path = format!("M{LEFT:.1} {bottom:.1}");
    for (index, load) in loads.iter().enumerate() {
        let (x, y) = (
            LEFT + index as f64 * width,
            bottom - load / full * (bottom - TOP),
        );
        let _ = write!(path, "L{x:.1} {y:.1}H{:.1}", x + width);
    }
    let _ = write!(path, "L{:.1} {bottom:.1}Z", WIDTH - RIGHT);
    svg.add(format_args!("<path class=\"area\" d=\"{path}\"/>"));
    let end = load.width_ns.saturating_mul(loads.len() as u64);
    svg.label("start", (LEFT, HEIGHT - 6.0), "tick", "0 s");
    svg.label("end", (WIDTH - RIGHT, HEIGHT - 6.0), "tick", &time(end));
    svg.finish()
}

/// `12 %`, `0.4 %`
pub(crate) fn percent(share: f64) -> String {
    let percent = share * 100.0;
    match percent {
        0.0 => "0 %".to_owned(),
        10.0.. => format!("{percent:.0} %"),
        1.0.. => format!("{percent:.1} %").replace(".0 %", " %"),
        _ => format!("{percent:.2} %").replace(".00 %", " %"),
    }
}
