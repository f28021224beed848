//! Every case of every suite on every reference device, each a test of its own: `kinco-servo::canopen.nmt/transition`.
//!
//! All in one process: a lane is played once, whole, and then each of its cases is reported.

#![allow(clippy::print_stderr)]

use std::process::ExitCode;
use std::sync::atomic::AtomicBool;

use fieldproof::{Exit, Library, Plan, Selection, play};
use fieldproof_record::{CaseStarted, Event, Sink, Verdict};
use fieldproof_report::{Ink, case_text, render};
use libtest_mimic::{Arguments, Failed, Trial};

fn main() -> ExitCode {
    let arguments = Arguments::from_args();
    match trials() {
        Ok(trials) => libtest_mimic::run(&arguments, trials).exit_code(),
        Err(text) => {
            eprintln!("{text}");
            Exit::WrongInput.into()
        }
    }
}

fn trials() -> Result<Vec<Trial>, String> {
    let library = Library::load(&Selection::default()).map_err(|complaint| {
        complaint
            .problems
            .iter()
            .map(|problem| render(problem, Ink::Plain))
            .collect::<String>()
    })?;
    let mut trials = Vec::new();
    for device in &library.devices {
        let mut sink = Outcomes::default();
        play(device, &Plan::default(), &mut sink, &AtomicBool::new(false))
            .map_err(|error| error.to_string())?;
        trials.extend(
            sink.outcomes
                .into_iter()
                .map(|outcome| outcome.trial(device.name())),
        );
    }
    Ok(trials)
}

/// What one case came to.
struct Outcome {
    id: String,
    skipped: bool,
    /// The case in full, if it did not pass.
    failed: Option<String>,
}

impl Outcome {
    fn trial(self, device: &str) -> Trial {
        let Outcome {
            id,
            skipped,
            failed,
        } = self;
        Trial::test(format!("{device}::{id}"), move || match failed {
            Some(text) => Err(Failed::from(text)),
            None => Ok(()),
        })
        .with_ignored_flag(skipped)
    }
}

#[derive(Default)]
struct Outcomes {
    outcomes: Vec<Outcome>,
    case: Option<Box<CaseStarted>>,
}

impl Sink for Outcomes {
    fn emit(&mut self, event: Event) {
        match event {
            Event::CaseStarted(case) => self.case = Some(case),
            Event::CaseFinished(finished) => {
                let text = self
                    .case
                    .take()
                    .map(|started| case_text(&started, &finished, Ink::Plain));
                let passed = match finished.verdict {
                    Verdict::Pass | Verdict::Skipped | Verdict::Deviation => true,
                    Verdict::Inconclusive | Verdict::Fail | Verdict::Error => false,
                };
                self.outcomes.push(Outcome {
                    skipped: finished.verdict == Verdict::Skipped,
                    failed: (!passed).then(|| text.unwrap_or_default()),
                    id: finished.id,
                });
            }
            Event::LaneFinished(lane) => {
                if let Some(why) = lane.stopped {
                    self.outcomes.push(Outcome {
                        id: "the lane comes to its end".to_owned(),
                        skipped: false,
                        failed: Some(why),
                    });
                }
            }
            _ => {}
        }
    }
}
