//! What goes into the record about lanes and cases.

use fieldproof_link::{Framing, Lane, Line, Parity, StateDifference, StopBits};
use fieldproof_record::{
    CaseFinished, CaseStarted, Cite, Failure, LaneStarted, Place, PortInfo, Verdict, WrittenStep,
};
use fieldproof_suite::model::{Case, Citation, Located, Step};
use fieldproof_suite::{CaseRef, Environment};

use crate::applies::effect_name;
use crate::lane::LaneJob;

/// The first entry of a case that is not read.
fn unread(case: &CaseRef<'_>, title: &str, place: Place, at_ns: u64) -> CaseStarted {
    CaseStarted {
        id: case.id(),
        written_id: case.written_id(),
        title: title.to_owned(),
        at_ns,
        cites: Vec::new(),
        against: Vec::new(),
        because: None,
        examples: Vec::new(),
        effects: Vec::new(),
        steps: Vec::new(),
        place,
    }
}

/// The two entries of a case for which the device has nothing to play it with.
pub(crate) fn passed_over(
    case: &CaseRef<'_>,
    place: Place,
    why: &str,
    at_ns: u64,
) -> (CaseStarted, CaseFinished) {
    let started = unread(case, case.title_as_written(), place, at_ns);
    let finished = CaseFinished {
        id: case.id(),
        at_ns,
        duration_ns: 0,
        verdict: Verdict::Skipped,
        reason: Some(why.to_owned()),
        failures: Vec::new(),
        excerpt: Vec::new(),
    };
    (started, finished)
}

/// The two entries of a case that cannot be played as it stands on this bench.
pub(crate) fn refused(
    case: &CaseRef<'_>,
    place: Place,
    why: &str,
    at_ns: u64,
) -> (CaseStarted, CaseFinished) {
    let started = unread(case, "cannot be read for this bench", place.clone(), at_ns);
    let failure = Failure {
        verdict: Verdict::Error,
        place,
        at_ns,
        what: why.to_owned(),
        expected: String::new(),
        actual: String::new(),
        notes: Vec::new(),
    };
    let finished = CaseFinished {
        id: case.id(),
        at_ns,
        duration_ns: 0,
        verdict: Verdict::Error,
        reason: None,
        failures: vec![failure],
        excerpt: Vec::new(),
    };
    (started, finished)
}

/// What a look into the device showed: something is not as it was found.
pub(crate) fn left_changed(differences: &[StateDifference], at_ns: u64, place: Place) -> Failure {
    let show = |value: fn(&StateDifference) -> &Option<String>| {
        let all = differences.iter().map(|it| {
            let value = value(it).as_deref().unwrap_or("nothing");
            format!("{} = {value}", it.name)
        });
        all.collect::<Vec<_>>().join(", ")
    };
    Failure {
        verdict: Verdict::Error,
        place,
        at_ns,
        what: "the device is not as it was found".into(),
        expected: show(|it| &it.before),
        actual: show(|it| &it.after),
        notes: vec!["the case must put back what it changes, or say how under restore".into()],
    }
}

/// The first entry of a lane.
pub(crate) fn lane_started(job: &LaneJob<'_>, lane: &dyn Lane) -> LaneStarted {
    LaneStarted {
        tool: job.tool.to_owned(),
        device: job.name.to_owned(),
        title: job.device.title.clone(),
        fault: job.fault.map(str::to_owned),
        variant: job.variant.map(str::to_owned),
        seed: job.seed,
        ports: lane
            .ports()
            .iter()
            .map(|port| PortInfo {
                name: port.name.clone(),
                link: port.link.clone(),
                line: show_line(port.line),
                timestamps: port.timestamps.to_owned(),
                uncertainty_ns: crate::limits::nanoseconds(port.uncertainty),
            })
            .collect(),
    }
}

/// `250 kbit/s`, `9600 8N1`
fn show_line(line: Line) -> String {
    match line {
        Line::Off => "off".into(),
        Line::Stream(Framing::ModbusTcp) => "Modbus TCP".into(),
        Line::Stream(Framing::Rtu) => "RTU over TCP".into(),
        Line::Can { bit_rate } if bit_rate % 1_000_000 == 0 => {
            format!("{} Mbit/s", bit_rate / 1_000_000)
        }
        Line::Can { bit_rate } => format!("{} kbit/s", bit_rate / 1_000),
        Line::Serial(settings) => {
            let parity = match settings.parity {
                Parity::None => 'N',
                Parity::Even => 'E',
                Parity::Odd => 'O',
            };
            let stop_bits = match settings.stop_bits {
                StopBits::One => 1,
                StopBits::Two => 2,
            };
            format!("{} 8{parity}{stop_bits}", settings.baud)
        }
    }
}

/// The first entry of a case.
pub(crate) fn case_started(
    case: &Case,
    at_ns: u64,
    place: Place,
    steps: Vec<WrittenStep>,
) -> CaseStarted {
    CaseStarted {
        id: case.id.clone(),
        written_id: case.written_id.clone(),
        title: case.title.clone(),
        at_ns,
        cites: cites(&case.cites),
        against: cites(&case.against),
        because: case.because.clone(),
        examples: case.examples.clone(),
        effects: case
            .effects
            .iter()
            .map(|effect| effect_name(*effect).to_owned())
            .collect(),
        steps,
        place,
    }
}

/// The control and the steps of `case` as its file has them.
pub(crate) fn written_steps(
    of: &CaseRef<'_>,
    environment: &Environment,
    case: &Case,
) -> Vec<WrittenStep> {
    let written = |step: &Located<Step>, control| WrittenStep {
        line: step.at.line,
        control,
        text: text_of_item(of, environment, step.at.line),
    };
    let control = case.control.iter().map(|step| written(step, true));
    let steps = case.steps.iter().map(|step| written(step, false));
    control.chain(steps).collect()
}

/// The longest step that is shown in full, in lines.
const LONGEST_STEP: u32 = 24;

/// The item of a list that begins on `line`, without its dash and indentation.
fn text_of_item(of: &CaseRef<'_>, environment: &Environment, line: u32) -> String {
    let suite = of.suite();
    let first = suite.line_text(line);
    let indent = first.len() - first.trim_start().len();
    let item = first.trim_start();
    let item = item.strip_prefix("- ").unwrap_or(item);
    let mut text = of.written_out(item.trim_end(), environment).into_owned();
    for line in line + 1..line + LONGEST_STEP {
        let more = suite.line_text(line);
        let inside = more.len() - more.trim_start().len() > indent;
        if !inside {
            break;
        }
        text.push('\n');
        let more = more.get(indent + 2..).unwrap_or(more.trim()).trim_end();
        text.push_str(&of.written_out(more, environment));
    }
    text
}

fn cites(citations: &[Citation]) -> Vec<Cite> {
    citations
        .iter()
        .map(|citation| Cite {
            document: citation.document.clone(),
            section: citation.section.clone(),
        })
        .collect()
}
