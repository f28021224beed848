//! The exit codes, in one place.

use std::process::ExitCode;

use fieldproof_record::VerdictCounts;
use fieldproof_report::LaneSummary;

/// How the program ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Exit {
    /// 0: everything passed, documented deviations included unless they are counted as failures.
    Passed,
    /// 1: something failed or could not be decided.
    Failed,
    /// 2: the input was wrong, or nothing was selected or played.
    WrongInput,
    /// 3: the bench broke, or the run was interrupted.
    Broken,
}

/// What the second Ctrl-C ends with: 128 and the number of SIGINT.
pub(crate) const INTERRUPTED_TWICE: i32 = 130;

impl Exit {
    /// Its number.
    pub const fn code(self) -> u8 {
        match self {
            Exit::Passed => 0,
            Exit::Failed => 1,
            Exit::WrongInput => 2,
            Exit::Broken => 3,
        }
    }

    /// What a run that came to `lanes` ends with.
    pub fn of_run(lanes: &[LaneSummary], strict: bool) -> Exit {
        let mut all = VerdictCounts::default();
        lanes.iter().for_each(|lane| all.merge(lane.counts));
        let whole = lanes
            .iter()
            .all(|lane| lane.complete && lane.stopped.is_none());
        let deviations = if strict { all.deviation } else { 0 };
        if !whole || all.error > 0 {
            Exit::Broken
        } else if all.fail > 0 || all.inconclusive > 0 || deviations > 0 {
            Exit::Failed
        } else if all.total() == all.skipped {
            Exit::WrongInput
        } else {
            Exit::Passed
        }
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> ExitCode {
        ExitCode::from(exit.code())
    }
}

#[cfg(test)]
mod tests {
    use fieldproof_record::Verdict;

    use super::*;

    fn exit(verdicts: &[Verdict], strict: bool) -> u8 {
        let mut lane = LaneSummary {
            complete: true,
            ..LaneSummary::default()
        };
        verdicts
            .iter()
            .for_each(|verdict| lane.counts.add(*verdict));
        Exit::of_run(&[lane], strict).code()
    }

    #[test]
    fn worst_verdict_decides() {
        use Verdict::{Deviation, Error, Fail, Inconclusive, Pass, Skipped};
        assert_eq!(exit(&[Pass, Skipped, Deviation], false), 0);
        assert_eq!(exit(&[Pass, Deviation], true), 1);
        assert_eq!(exit(&[Pass, Inconclusive], false), 1);
        assert_eq!(exit(&[Pass, Fail], false), 1);
        assert_eq!(exit(&[Fail, Error], false), 3);
        assert_eq!(exit(&[Skipped], false), 2);
        assert_eq!(exit(&[], false), 2);
    }

    #[test]
    fn lane_that_was_stopped_is_not_passed() {
        let mut lane = LaneSummary {
            complete: true,
            stopped: Some("interrupted".to_owned()),
            ..LaneSummary::default()
        };
        lane.counts.add(Verdict::Pass);
        assert_eq!(Exit::of_run(&[lane.clone()], false), Exit::Broken);
        lane.stopped = None;
        lane.complete = false;
        assert_eq!(Exit::of_run(&[lane], false), Exit::Broken);
    }
}
