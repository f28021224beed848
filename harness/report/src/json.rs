//! The report for programs: one JSON text, written as the cases come.

use std::io::{self, Write};

use fieldproof_record::{
    CaseStarted, Cite, Event, Failure, IdentityPart, Measurement, Observation, Place, PortInfo,
    RunFinished, RunStarted, Verdict, VerdictCounts, WrittenStep,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The version of this format.
pub const JSON_FORMAT: u32 = 1;

/// The whole report. [`Json`] writes it piece by piece; this is what it comes to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(title = "Report of a fieldproof run")]
pub struct RunReport {
    /// The version of this format: 1.
    pub format: u32,
    /// What was played, with what, and by whom.
    pub run: RunStarted,
    /// The devices, in the order of the run's lanes.
    pub lanes: Vec<LaneReport>,
    /// When the run came to its end; without it, it did not.
    pub finished: Option<RunFinished>,
    /// All cases of all lanes.
    pub counts: VerdictCounts,
    /// Why this is not all that was to be played.
    pub incomplete: Option<String>,
}

/// One device.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LaneReport {
    /// Its name on the bench.
    pub device: String,
    /// Its cases, in the order they were played.
    pub cases: Vec<CaseReport>,
    /// What it came to.
    #[serde(flatten)]
    pub end: LaneEnd,
}

/// What is known of a lane at its end.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
pub struct LaneEnd {
    /// The device's title.
    pub title: String,
    /// The fault switched on in a reference device.
    pub fault: Option<String>,
    /// The legal variant that a reference device is.
    pub variant: Option<String>,
    /// The ports.
    pub ports: Vec<PortInfo>,
    /// What the device says of itself, and what its description claims.
    pub identity: Vec<IdentityPart>,
    /// All its cases.
    pub counts: VerdictCounts,
    /// How long it took on the lane's own clock.
    pub lane_time_ns: u64,
    /// Why it ended before its last case.
    pub stopped: Option<String>,
    /// Whether the lane came to its end.
    pub complete: bool,
}

/// One case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CaseReport {
    /// `suite/case[key=value]`.
    pub id: String,
    /// The suite.
    pub suite: String,
    /// One line.
    pub title: String,
    /// The verdict.
    pub verdict: Verdict,
    /// Why it was skipped.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// When it began, in nanoseconds since the lane was opened.
    pub at_ns: u64,
    /// How long it took on the lane's clock.
    pub duration_ns: u64,
    /// Sources it follows.
    pub cites: Vec<Cite>,
    /// Sources it decides against.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub against: Vec<Cite>,
    /// Why it does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub because: Option<String>,
    /// Worked examples it plays.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub examples: Vec<String>,
    /// What it does to the device.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub effects: Vec<String>,
    /// Its control and its steps.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub steps: Vec<WrittenStep>,
    /// Where it stands.
    pub place: Place,
    /// What was measured.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub measurements: Vec<Measurement>,
    /// What was recorded without judging.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub observations: Vec<Observation>,
    /// Lines that decide nothing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// What kept it from passing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub failures: Vec<Failure>,
}

/// The JSON Schema of the report.
pub fn report_schema() -> serde_json::Value {
    schemars::schema_for!(RunReport).to_value()
}

/// Writes a report as the events of one lane after the other come.
#[derive(Debug)]
pub struct Json<W: Write> {
    out: W,
    end: LaneEnd,
    suite: String,
    case: Option<CaseReport>,
    counts: VerdictCounts,
    lanes: usize,
    cases: usize,
}

impl<W: Write> Json<W> {
    /// Begins with what is known of the run.
    ///
    /// # Errors
    /// What the output says.
    pub fn new(mut out: W, run: &RunStarted) -> io::Result<Json<W>> {
        write!(out, "{{\"format\":{JSON_FORMAT},\"run\":")?;
        serde_json::to_writer(&mut out, run)?;
        out.write_all(b",\"lanes\":[")?;
        Ok(Json {
            out,
            end: LaneEnd::default(),
            suite: String::new(),
            case: None,
            counts: VerdictCounts::default(),
            lanes: 0,
            cases: 0,
        })
    }

    /// Begins the lane of `device`.
    ///
    /// # Errors
    /// What the output says.
    pub fn begin_lane(&mut self, device: &str) -> io::Result<()> {
        let comma = if self.lanes == 0 { "\n" } else { ",\n" };
        self.lanes += 1;
        self.cases = 0;
        write!(self.out, "{comma}{{\"device\":")?;
        serde_json::to_writer(&mut self.out, device)?;
        self.out.write_all(b",\"cases\":[")
    }

    /// One more event of the lane.
    ///
    /// # Errors
    /// What the output says.
    pub fn event(&mut self, event: &Event) -> io::Result<()> {
        match event {
            Event::LaneStarted(lane) => {
                self.end.title.clone_from(&lane.title);
                self.end.fault.clone_from(&lane.fault);
                self.end.variant.clone_from(&lane.variant);
                self.end.ports.clone_from(&lane.ports);
            }
            Event::Identity(identity) => self.end.identity.clone_from(&identity.parts),
            Event::SuiteStarted(suite) => self.suite.clone_from(&suite.suite),
            Event::CaseStarted(case) => self.case = Some(begun(&self.suite, case)),
            Event::Measurement(it) => self.with_case(|case| case.measurements.push((**it).clone())),
            Event::Observation(it) => self.with_case(|case| case.observations.push((**it).clone())),
            Event::Note(it) => self.with_case(|case| case.notes.push(it.text.clone())),
            Event::CaseFinished(finished) => {
                self.end.counts.add(finished.verdict);
                if let Some(mut case) = self.case.take() {
                    case.verdict = finished.verdict;
                    case.duration_ns = finished.duration_ns;
                    case.reason.clone_from(&finished.reason);
                    case.failures.clone_from(&finished.failures);
                    return self.write_case(&case);
                }
            }
            Event::LaneFinished(end) => {
                self.end.complete = true;
                self.end.lane_time_ns = end.at_ns;
                self.end.stopped.clone_from(&end.stopped);
            }
            _ => {}
        }
        Ok(())
    }

    fn with_case(&mut self, change: impl FnOnce(&mut CaseReport)) {
        if let Some(case) = &mut self.case {
            change(case);
        }
    }

    fn write_case(&mut self, case: &CaseReport) -> io::Result<()> {
        let comma: &[u8] = if self.cases == 0 { b"\n" } else { b",\n" };
        self.cases += 1;
        self.out.write_all(comma)?;
        serde_json::to_writer(&mut self.out, case)?;
        Ok(())
    }

    /// Ends the lane.
    ///
    /// # Errors
    /// What the output says.
    pub fn end_lane(&mut self) -> io::Result<()> {
        self.case = None;
        let end = std::mem::take(&mut self.end);
        self.counts.merge(end.counts);
        let end = serde_json::to_string(&end)?;
        // The end's members stand in the lane itself.
        write!(self.out, "],{}", end.get(1..).unwrap_or("}"))
    }

    /// Ends the report. The output.
    ///
    /// # Errors
    /// What the output says.
    pub fn finish(
        mut self,
        finished: Option<&RunFinished>,
        incomplete: Option<&str>,
    ) -> io::Result<W> {
        self.out.write_all(b"],\n\"finished\":")?;
        serde_json::to_writer(&mut self.out, &finished)?;
        self.out.write_all(b",\"counts\":")?;
        serde_json::to_writer(&mut self.out, &self.counts)?;
        self.out.write_all(b",\"incomplete\":")?;
        serde_json::to_writer(&mut self.out, &incomplete)?;
        self.out.write_all(b"}\n")?;
        self.out.flush()?;
        Ok(self.out)
    }
}

fn begun(suite: &str, case: &CaseStarted) -> CaseReport {
    CaseReport {
        id: case.id.clone(),
        suite: suite.to_owned(),
        title: case.title.clone(),
        verdict: Verdict::Error,
        reason: None,
        at_ns: case.at_ns,
        duration_ns: 0,
        cites: case.cites.clone(),
        against: case.against.clone(),
        because: case.because.clone(),
        examples: case.examples.clone(),
        effects: case.effects.clone(),
        steps: case.steps.clone(),
        place: case.place.clone(),
        measurements: Vec::new(),
        observations: Vec::new(),
        notes: Vec::new(),
        failures: Vec::new(),
    }
}
