//! JUnit XML: one `testsuite` a suite and device, one `testcase` a case, that is, one row of a table.
//!
//! A `testsuite` gives its numbers before its cases, and a run may have a hundred thousand of these. So each lane
//! writes its cases at once to a place of its own ([`JunitLane`]) and remembers the numbers; at the end [`assemble`]
//! puts both together. No more than one case is held in memory, where quick-junit's model would hold all of them.

use std::borrow::Cow;
use std::io::{self, Read, Write};

use fieldproof_record::{
    CaseFinished, CaseStarted, Event, IdentityPart, LaneStarted, Limits, Measurement, Place,
    Verdict,
};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event as Xml};

use crate::case_text::{case_text, cite, seconds};
use crate::ink::Ink;

/// The numbers of one `testsuite`, and how long its cases are as text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SuiteHead {
    name: String,
    tests: u64,
    failures: u64,
    errors: u64,
    skipped: u64,
    time_ns: u64,
    bytes: u64,
}

/// Writes the cases of one lane.
pub struct JunitLane<W: Write> {
    out: Writer<Counted<W>>,
    strict: bool,
    lane: Option<Box<LaneStarted>>,
    identity: Vec<IdentityPart>,
    heads: Vec<SuiteHead>,
    /// The name of the suite that is being played.
    suite: String,
    case: Option<Case>,
    failed: Option<io::Error>,
}

#[derive(Debug)]
struct Case {
    started: Box<CaseStarted>,
    properties: Vec<(String, String)>,
}

impl<W: Write> JunitLane<W> {
    /// Writes to `out`, which is best buffered. With `strict`, a documented deviation is a failure.
    pub fn new(out: W, strict: bool) -> JunitLane<W> {
        JunitLane {
            out: Writer::new(Counted { out, bytes: 0 }),
            strict,
            lane: None,
            identity: Vec::new(),
            heads: Vec::new(),
            suite: String::new(),
            case: None,
            failed: None,
        }
    }

    /// One more event of the lane. What goes wrong is kept until [`JunitLane::finish`].
    pub fn event(&mut self, event: &Event) {
        if self.failed.is_none() {
            self.failed = self.write(event).err();
        }
    }

    /// What was written, and the numbers for [`assemble`]. A case that was begun and never finished is an error.
    ///
    /// # Errors
    /// The first thing that went wrong.
    pub fn finish(mut self) -> io::Result<(W, Vec<SuiteHead>)> {
        if let Some(error) = self.failed.take() {
            return Err(error);
        }
        self.abandoned_case()?;
        let mut out = self.out.into_inner().out;
        out.flush()?;
        Ok((out, self.heads))
    }

    fn write(&mut self, event: &Event) -> io::Result<()> {
        match event {
            Event::LaneStarted(lane) => self.lane = Some(lane.clone()),
            Event::SuiteStarted(suite) => {
                self.abandoned_case()?;
                self.begin_suite(&suite.suite, &suite.title)?;
            }
            Event::CaseStarted(case) => {
                self.abandoned_case()?;
                let properties = described(case);
                self.case = Some(Case {
                    started: case.clone(),
                    properties,
                });
            }
            Event::Measurement(measurement) => self.property(
                format!("measurement.{}", measurement.name),
                measured(measurement),
            ),
            Event::Observation(observation) => self.property(
                format!("observation.{}", observation.name),
                observation.value.clone(),
            ),
            Event::BusError(error) => {
                self.property("bus error".to_owned(), error.what.clone());
            }
            Event::Note(note) => self.property("note".to_owned(), note.text.clone()),
            Event::CaseFinished(finished) => {
                let case = self
                    .case
                    .take()
                    .unwrap_or_else(|| unannounced(&finished.id));
                self.case(case, finished)?;
            }
            Event::Identity(identity) => self.identity = identity.parts.clone(),
            Event::StepStarted(_)
            | Event::PuttingBack(_)
            | Event::Frame(_)
            | Event::Serial(_)
            | Event::Stimulus(_)
            | Event::SuiteFinished(_)
            | Event::LaneFinished(_) => {}
        }
        Ok(())
    }

    fn property(&mut self, name: String, value: String) {
        if let Some(case) = &mut self.case {
            case.properties.push((name, value));
        }
    }

    fn device(&self) -> &str {
        self.lane.as_ref().map_or("", |lane| &lane.device)
    }

    fn begin_suite(&mut self, suite: &str, title: &str) -> io::Result<()> {
        suite.clone_into(&mut self.suite);
        self.heads.push(SuiteHead {
            name: format!("{suite} on {}", self.device()),
            tests: 0,
            failures: 0,
            errors: 0,
            skipped: 0,
            time_ns: 0,
            bytes: 0,
        });
        let mut properties = vec![("suite.title".to_owned(), title.to_owned())];
        if let Some(lane) = &self.lane {
            properties.push(("device.title".to_owned(), lane.title.clone()));
            properties.push(("tool".to_owned(), lane.tool.clone()));
            properties.push(("seed".to_owned(), lane.seed.to_string()));
            properties.extend(lane.fault.clone().map(|fault| ("fault".to_owned(), fault)));
            properties.extend(lane.ports.iter().map(|port| {
                let uncertainty = seconds(port.uncertainty_ns);
                let timestamps = format!("{} timestamps ± {uncertainty} s", port.timestamps);
                let value = format!("{} {}, {timestamps}", port.link, port.line);
                (format!("port.{}", port.name), value)
            }));
        }
        let read = self.identity.iter().filter_map(|part| {
            let value = part.read.clone()?;
            Some((format!("identity.{}", part.name), value))
        });
        properties.extend(read);
        let before = self.out.get_ref().bytes;
        write_properties(&mut self.out, 2, &properties)?;
        self.count_bytes(before);
        Ok(())
    }

    fn count_bytes(&mut self, before: u64) {
        let written = self.out.get_ref().bytes - before;
        if let Some(head) = self.heads.last_mut() {
            head.bytes += written;
        }
    }

    /// The lane ended before its last case: that is an error, whatever the cases before came to.
    ///
    /// # Errors
    /// What the output says.
    pub fn ended_early(&mut self, why: &str) -> io::Result<()> {
        if let Some(error) = self.failed.take() {
            return Err(error);
        }
        self.abandoned_case()?;
        self.begin_suite("the run", "Whether everything was played")?;
        let finished = CaseFinished {
            id: "the run/came to its end".to_owned(),
            at_ns: 0,
            duration_ns: 0,
            verdict: Verdict::Error,
            reason: Some(why.to_owned()),
            failures: Vec::new(),
            excerpt: Vec::new(),
        };
        self.case(unannounced(&finished.id), &finished)
    }

    fn abandoned_case(&mut self) -> io::Result<()> {
        let Some(case) = self.case.take() else {
            return Ok(());
        };
        let finished = CaseFinished {
            id: case.started.id.clone(),
            at_ns: case.started.at_ns,
            duration_ns: 0,
            verdict: Verdict::Error,
            reason: Some("the record ends within this case".to_owned()),
            failures: Vec::new(),
            excerpt: Vec::new(),
        };
        self.case(case, &finished)
    }

    fn case(&mut self, mut case: Case, finished: &CaseFinished) -> io::Result<()> {
        if self.heads.is_empty() {
            self.begin_suite("", "")?;
        }
        let outcome = Outcome::of(finished.verdict, self.strict);
        if let Some(head) = self.heads.last_mut() {
            head.tests += 1;
            head.time_ns = head.time_ns.saturating_add(finished.duration_ns);
            match outcome {
                Outcome::Passed => {}
                Outcome::Skipped => head.skipped += 1,
                Outcome::Failure => head.failures += 1,
                Outcome::Error => head.errors += 1,
            }
        }
        if finished.verdict == Verdict::Deviation {
            let what = finished
                .failures
                .first()
                .map_or("", |failure| &failure.what);
            case.properties
                .push(("deviation".to_owned(), what.to_owned()));
        }
        let before = self.out.get_ref().bytes;
        let class = format!("{}.{}", self.device(), self.suite);
        write_case(&mut self.out, &class, &case, finished, outcome)?;
        self.count_bytes(before);
        Ok(())
    }
}

/// Writes the whole file: the numbers of each suite of each lane, and its cases out of what the lane has written.
///
/// # Errors
/// What `out` or a lane's reader says.
pub fn assemble<R: Read>(
    out: impl Write,
    lanes: impl IntoIterator<Item = (Vec<SuiteHead>, R)>,
) -> io::Result<()> {
    let lanes: Vec<_> = lanes.into_iter().collect();
    let mut writer = Writer::new(out);
    writer.write_event(Xml::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    new_line(&mut writer, 0)?;
    let all: Vec<&SuiteHead> = lanes.iter().flat_map(|(heads, _)| heads).collect();
    let mut root = BytesStart::new("testsuites");
    root.push_attribute(("name", "fieldproof"));
    push_numbers(&mut root, &all);
    writer.write_event(Xml::Start(root))?;
    for (heads, mut body) in lanes {
        for head in heads {
            let mut suite = BytesStart::new("testsuite");
            suite.push_attribute(("name", &*xml_text(&head.name)));
            push_numbers(&mut suite, &[&head]);
            new_line(&mut writer, 1)?;
            writer.write_event(Xml::Start(suite))?;
            io::copy(&mut (&mut body).take(head.bytes), writer.get_mut())?;
            new_line(&mut writer, 1)?;
            writer.write_event(Xml::End(BytesEnd::new("testsuite")))?;
        }
    }
    new_line(&mut writer, 0)?;
    writer.write_event(Xml::End(BytesEnd::new("testsuites")))?;
    new_line(&mut writer, 0)?;
    writer.get_mut().flush()
}

fn push_numbers(tag: &mut BytesStart<'_>, heads: &[&SuiteHead]) {
    let sum = |of: fn(&SuiteHead) -> u64| heads.iter().map(|head| of(head)).sum::<u64>();
    for (name, number) in [
        ("tests", sum(|head| head.tests)),
        ("failures", sum(|head| head.failures)),
        ("errors", sum(|head| head.errors)),
        ("skipped", sum(|head| head.skipped)),
    ] {
        tag.push_attribute((name, number.to_string().as_str()));
    }
    let time = heads
        .iter()
        .fold(0, |time: u64, head| time.saturating_add(head.time_ns));
    tag.push_attribute(("time", seconds(time).as_str()));
}

/// What JUnit makes of a verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    Passed,
    Skipped,
    Failure,
    Error,
}

impl Outcome {
    fn of(verdict: Verdict, strict: bool) -> Outcome {
        match verdict {
            Verdict::Pass => Outcome::Passed,
            Verdict::Skipped => Outcome::Skipped,
            Verdict::Deviation if !strict => Outcome::Passed,
            Verdict::Deviation | Verdict::Fail => Outcome::Failure,
            Verdict::Inconclusive | Verdict::Error => Outcome::Error,
        }
    }
}

/// A case that finished and was never begun: it must not be lost.
fn unannounced(id: &str) -> Case {
    let started = CaseStarted {
        id: id.to_owned(),
        written_id: id.to_owned(),
        title: id.to_owned(),
        at_ns: 0,
        cites: Vec::new(),
        against: Vec::new(),
        because: None,
        examples: Vec::new(),
        effects: Vec::new(),
        steps: Vec::new(),
        place: Place::default(),
    };
    Case {
        started: Box::new(started),
        properties: Vec::new(),
    }
}

fn described(case: &CaseStarted) -> Vec<(String, String)> {
    let mut properties = vec![("title".to_owned(), case.title.clone())];
    properties.extend(
        case.cites
            .iter()
            .map(|source| ("source".to_owned(), cite(source))),
    );
    properties.extend(
        case.against
            .iter()
            .map(|source| ("against".to_owned(), cite(source))),
    );
    properties.extend(
        case.because
            .iter()
            .map(|why| ("because".to_owned(), why.clone())),
    );
    properties.extend(
        case.examples
            .iter()
            .map(|id| ("example".to_owned(), id.clone())),
    );
    properties.extend(
        case.effects
            .iter()
            .map(|effect| ("effect".to_owned(), effect.clone())),
    );
    properties
}

fn measured(measurement: &Measurement) -> String {
    let limits = match measurement.limits {
        Limits {
            min_ns: None,
            max_ns: None,
        } => "no limit".to_owned(),
        Limits {
            min_ns: None,
            max_ns: Some(max),
        } => format!("limit {} s", seconds(max)),
        Limits {
            min_ns: Some(min),
            max_ns: None,
        } => format!("at least {} s", seconds(min)),
        Limits {
            min_ns: Some(min),
            max_ns: Some(max),
        } => {
            format!("limits {} s to {} s", seconds(min), seconds(max))
        }
    };
    format!(
        "{} s ({limits}, uncertainty {} s, {})",
        seconds(measurement.value_ns),
        seconds(measurement.uncertainty_ns),
        measurement.verdict
    )
}

fn write_case<W: Write>(
    out: &mut Writer<W>,
    class: &str,
    case: &Case,
    finished: &CaseFinished,
    outcome: Outcome,
) -> io::Result<()> {
    let started = &case.started;
    let mut tag = BytesStart::new("testcase");
    tag.push_attribute(("name", &*xml_text(&started.id)));
    tag.push_attribute(("classname", &*xml_text(class)));
    tag.push_attribute(("time", seconds(finished.duration_ns).as_str()));
    tag.push_attribute(("file", &*xml_text(&started.place.path)));
    tag.push_attribute(("line", started.place.line.to_string().as_str()));
    new_line(out, 2)?;
    out.write_event(Xml::Start(tag))?;
    write_properties(out, 3, &case.properties)?;
    let first = finished
        .failures
        .first()
        .map(|failure| failure.what.as_str());
    let message = first.or(finished.reason.as_deref()).unwrap_or_default();
    let element = match outcome {
        Outcome::Passed => None,
        Outcome::Skipped => Some("skipped"),
        Outcome::Failure => Some("failure"),
        Outcome::Error => Some("error"),
    };
    if let Some(element) = element {
        let mut tag = BytesStart::new(element);
        tag.push_attribute(("message", &*xml_text(message)));
        new_line(out, 3)?;
        if outcome == Outcome::Skipped {
            out.write_event(Xml::Empty(tag))?;
        } else {
            tag.push_attribute(("type", finished.verdict.name()));
            out.write_event(Xml::Start(tag))?;
            let body = case_text(started, finished, Ink::Plain);
            out.write_event(Xml::Text(BytesText::new(&xml_text(&body))))?;
            out.write_event(Xml::End(BytesEnd::new(element)))?;
        }
    }
    new_line(out, 2)?;
    out.write_event(Xml::End(BytesEnd::new("testcase")))
}

fn write_properties<W: Write>(
    out: &mut Writer<W>,
    depth: usize,
    properties: &[(String, String)],
) -> io::Result<()> {
    if properties.is_empty() {
        return Ok(());
    }
    new_line(out, depth)?;
    out.write_event(Xml::Start(BytesStart::new("properties")))?;
    for (name, value) in properties {
        let mut tag = BytesStart::new("property");
        tag.push_attribute(("name", &*xml_text(name)));
        tag.push_attribute(("value", &*xml_text(value)));
        new_line(out, depth + 1)?;
        out.write_event(Xml::Empty(tag))?;
    }
    new_line(out, depth)?;
    out.write_event(Xml::End(BytesEnd::new("properties")))
}

/// The writer's own indentation would start at the margin in every lane.
fn new_line<W: Write>(out: &mut Writer<W>, depth: usize) -> io::Result<()> {
    const SPACES: &[u8] = b"\n            ";
    out.get_mut()
        .write_all(&SPACES[..=(2 * depth).min(SPACES.len() - 1)])
}

/// What XML cannot hold in any notation is shown as a replacement character.
fn xml_text(text: &str) -> Cow<'_, str> {
    let illegal = |character: char| matches!(character, '\0'..='\u{8}' | '\u{B}' | '\u{C}' | '\u{E}'..='\u{1F}' | '\u{FFFE}' | '\u{FFFF}');
    match text.contains(illegal) {
        true => Cow::Owned(text.replace(illegal, "\u{FFFD}")),
        false => Cow::Borrowed(text),
    }
}

/// Counts what is written.
#[derive(Debug)]
struct Counted<W> {
    out: W,
    bytes: u64,
}

impl<W: Write> Write for Counted<W> {
    fn write(&mut self, buffer: &[u8]) -> io::Result<usize> {
        let written = self.out.write(buffer)?;
        self.bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
