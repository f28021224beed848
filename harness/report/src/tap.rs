//! The Test Anything Protocol, version 14: one test point a case.

use std::io::{self, Write};

use fieldproof_record::{CaseFinished, Event, Verdict};

/// Writes test points as cases finish, and the plan at the end.
#[derive(Debug)]
pub struct Tap<W: Write> {
    out: W,
    strict: bool,
    number: u64,
    device: String,
}

impl<W: Write> Tap<W> {
    /// With `strict`, a documented deviation is not ok.
    ///
    /// # Errors
    /// What the output says.
    pub fn new(mut out: W, strict: bool) -> io::Result<Tap<W>> {
        out.write_all(b"TAP version 14\n")?;
        Ok(Tap {
            out,
            strict,
            number: 0,
            device: String::new(),
        })
    }

    /// One more event of any lane.
    ///
    /// # Errors
    /// What the output says.
    pub fn event(&mut self, event: &Event) -> io::Result<()> {
        match event {
            Event::LaneStarted(lane) => self.device.clone_from(&lane.device),
            Event::CaseFinished(case) => self.case(case)?,
            _ => {}
        }
        Ok(())
    }

    fn case(&mut self, case: &CaseFinished) -> io::Result<()> {
        self.number += 1;
        let ok = match case.verdict {
            Verdict::Pass | Verdict::Skipped => "ok",
            Verdict::Deviation if !self.strict => "ok",
            _ => "not ok",
        };
        let name = words(&format!("{}: {}", self.device, case.id));
        write!(self.out, "{ok} {} - {name}", self.number)?;
        if case.verdict == Verdict::Skipped {
            let reason = words(case.reason.as_deref().unwrap_or_default());
            write!(self.out, " # SKIP {reason}")?;
        }
        self.out.write_all(b"\n")?;
        match case.verdict {
            Verdict::Pass | Verdict::Skipped => Ok(()),
            _ => self.diagnostic(case),
        }
    }

    fn diagnostic(&mut self, case: &CaseFinished) -> io::Result<()> {
        writeln!(self.out, "  ---\n  severity: {}", case.verdict)?;
        if let Some(failure) = case.failures.first() {
            let place = &failure.place;
            let fields = [
                ("message", &failure.what),
                ("expected", &failure.expected),
                ("actual", &failure.actual),
            ];
            for (name, text) in fields {
                // What JSON writes as a string, YAML reads as one.
                writeln!(self.out, "  {name}: {}", serde_json::Value::from(&**text))?;
            }
            let at = format!("{}:{}", place.path, place.line);
            writeln!(self.out, "  at: {}", serde_json::Value::from(at))?;
        }
        self.out.write_all(b"  ...\n")
    }

    /// The plan; a run that did not come to its end says so. The output.
    ///
    /// # Errors
    /// What the output says.
    pub fn finish(mut self, incomplete: Option<&str>) -> io::Result<W> {
        match incomplete {
            Some(why) => writeln!(self.out, "Bail out! {}", words(why))?,
            None => writeln!(self.out, "1..{}", self.number)?,
        }
        self.out.flush()?;
        Ok(self.out)
    }
}

/// One line in which nothing is taken for a directive.
fn words(text: &str) -> String {
    let one_line = text.split_whitespace().collect::<Vec<&str>>().join(" ");
    one_line.replace('\\', "\\\\").replace('#', "\\#")
}
