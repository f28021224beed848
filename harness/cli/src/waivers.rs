//! Accepted failures, and what has become of them.

use std::path::Path;
use std::sync::Arc;

use fieldproof_report::compare::Accepts;
use fieldproof_report::{Problem, Severity};
use fieldproof_suite::load_waivers;
use fieldproof_suite::waivers::Waiver;

use crate::complaint::Complaint;
use crate::{glob, input, problems};

/// The waivers of a file, or none.
#[derive(Default)]
pub(crate) struct Waived {
    waivers: Vec<Used>,
}

struct Used {
    waiver: Waiver,
    expired: bool,
    /// The cases that fail and are meant, and the number of those that do not fail.
    failing: Vec<String>,
    passing: usize,
}

impl Used {
    fn is_for(&self, device: &str, firmware: Option<&str>, case: &str) -> bool {
        let waiver = &self.waiver;
        glob::matches(&waiver.case.value, case)
            && waiver.device.as_ref().is_none_or(|it| it == device)
            && waiver.firmware.as_ref().is_none_or(|pattern| {
                firmware.is_some_and(|firmware| glob::matches(pattern, firmware))
            })
    }
}

impl Waived {
    /// Reads the file at `path`, on the day that is called `today` (`2026-11-22`).
    pub(crate) fn read(path: &Path, today: &str) -> Result<Waived, Complaint> {
        let file = input::read(path).map_err(|problem| Complaint::input(*problem))?;
        let text: Arc<str> = Arc::from(file.text.as_str());
        let waivers = load_waivers(&file).map_err(|diagnostics| {
            let problems = diagnostics.iter();
            let problems = problems.map(|it| problems::of_diagnostic(it, &text));
            Complaint::inputs(problems.collect())
        })?;
        let mut wrong = Vec::new();
        let mut used = Vec::new();
        for waiver in waivers.waivers {
            if !is_date(&waiver.expires.value) {
                let message = format!("`{}` is no day", waiver.expires.value);
                let problem = Problem::new(Severity::Error, message)
                    .in_file(&file.path)
                    .help("a day is written 2027-03-31");
                let at = waiver.expires.at;
                wrong.push(problems::placed(problem, at, "expected a day", &text));
            }
            used.push(Used {
                // Days written like this stand in the order of time.
                expired: waiver.expires.value.as_str() < today,
                waiver,
                failing: Vec::new(),
                passing: 0,
            });
        }
        match wrong.is_empty() {
            true => Ok(Waived { waivers: used }),
            false => Err(Complaint::inputs(wrong)),
        }
    }

    /// What there is to say of the waivers, and whether one that is needed has expired.
    pub(crate) fn outcome(&self) -> (Vec<String>, bool) {
        let mut lines = Vec::new();
        let mut expired = false;
        for used in &self.waivers {
            let waiver = &used.waiver;
            let (case, until) = (&waiver.case.value, &waiver.expires.value);
            let failing = used.failing.len();
            match (failing, used.expired, used.passing) {
                (0, _, 0) => lines.push(format!("{case}: there is no such case in the new run")),
                (0, _, _) => lines.push(format!(
                    "{case}: passes now; the waiver is not needed any more"
                )),
                (_, true, _) => {
                    expired = true;
                    lines.push(format!("{case}: expired on {until}; {failing} still fail"));
                }
                (_, false, _) => lines.push(format!(
                    "{case}: {failing} accepted until {until}: {}",
                    waiver.reason
                )),
            }
        }
        (lines, expired)
    }
}

impl Accepts for Waived {
    fn reason(&mut self, device: &str, firmware: Option<&str>, case: &str) -> Option<String> {
        let mut reason = None;
        for used in &mut self.waivers {
            if used.is_for(device, firmware, case) {
                used.failing.push(case.to_owned());
                if !used.expired {
                    reason = reason.or_else(|| Some(used.waiver.reason.clone()));
                }
            }
        }
        reason
    }

    fn passes(&mut self, device: &str, firmware: Option<&str>, case: &str) {
        for used in &mut self.waivers {
            used.passing += usize::from(used.is_for(device, firmware, case));
        }
    }
}

/// Whether `text` is a day of the calendar, written `2027-03-31`.
fn is_date(text: &str) -> bool {
    text.len() == 10 && humantime::parse_rfc3339(&format!("{text}T00:00:00Z")).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_days() {
        assert!(is_date("2027-03-31") && is_date("2028-02-29"));
        for text in ["2027-3-31", "2027-02-30", "31.03.2027", "", "2027-03-31T00"] {
            assert!(!is_date(text), "{text}");
        }
    }
}
