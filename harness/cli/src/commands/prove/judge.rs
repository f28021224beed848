//! What the rounds show.

use std::collections::{BTreeMap, BTreeSet};

use fieldproof_record::Verdict;
use serde::Serialize;

use super::rounds::{Claim, Expects, Guise, Round};
use super::tally::Tally;
use crate::line_trouble::Must;

/// So many of a hundred faults must be named in the first line of a failure.
const NAMED_PERCENT: usize = 90;

/// What the rounds show.
#[derive(Debug, Serialize)]
pub(super) struct Proof {
    /// Whether every fault is caught where it belongs, every case catches one, and everything else is as it must be.
    pub(super) holds: bool,
    pub(super) figures: Figures,
    pub(super) rounds: Vec<Finding>,
    /// Every case as written that was played, with the faults that it catches: device and name.
    pub(super) cases: BTreeMap<String, Vec<(String, String)>>,
    /// Cases that were played and caught nothing on any device. They count only where everything was played.
    pub(super) idle_cases: Vec<String>,
    pub(super) whole: bool,
}

/// How many of how many.
#[derive(Debug, Serialize)]
pub(super) struct Figures {
    pub(super) faults: usize,
    pub(super) caught: usize,
    /// Caught by cases of the service that they break.
    pub(super) caught_where_they_belong: usize,
    /// Named by the first line of a failure there.
    pub(super) named: usize,
    pub(super) cases: usize,
    pub(super) cases_that_catch: usize,
}

/// What one round shows.
#[derive(Debug, Serialize)]
pub(super) struct Finding {
    pub(super) device: String,
    pub(super) guise: Guise,
    /// The clause that a fault breaks.
    #[serde(skip_serializing_if = "str::is_empty")]
    pub(super) breaks: &'static str,
    /// What is not as it must be; none if all is.
    pub(super) wrong: Option<Wrong>,
    /// Whether the first line of a failure names what is wrong with the device.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) named: Option<bool>,
    /// Cases that failed, with what was wrong in the first row that did. For a fault: only those that do not fail
    /// without it.
    pub(super) failed: BTreeMap<String, String>,
    pub(super) inconclusive: Vec<String>,
    pub(super) error: Vec<String>,
    /// Cases of which some row passed on a line that lets nothing through.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) passed_in_vain: Vec<String>,
    /// Why the device could not be used any more; the cases after that were played on a fresh one.
    pub(super) stops: Vec<String>,
    /// Cases as written that were played or skipped.
    pub(super) cases: usize,
}

/// Why a round is not as it must be.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Wrong {
    /// No case caught the fault.
    CaughtByNothing,
    /// Only cases caught it that have nothing to do with it.
    CaughtElsewhere(&'static str),
    /// A right device did not pass.
    NotPassed,
    /// Cases passed though nothing came through the line.
    PassedInVain,
    /// Trouble on the line was not seen.
    NotSeen,
    /// It did not end.
    Hung,
}

pub(super) fn judge(rounds: &[Round], tallies: &[Tally], whole: bool) -> Proof {
    let mut findings: Vec<Finding> = Vec::new();
    let mut cases: BTreeMap<String, Vec<(String, String)>> = BTreeMap::new();
    // Of the device as it is.
    let mut fails_anyway: BTreeSet<String> = BTreeSet::new();
    for (round, tally) in rounds.iter().zip(tallies) {
        let mut finding = finding(round, tally);
        match &round.guise {
            Guise::AsItIs => {
                fails_anyway = finding.failed.keys().cloned().collect();
                for played in tally.those(|it| it.counts.total() > it.counts.skipped) {
                    cases.entry(played).or_default();
                }
            }
            Guise::Fault(name) => {
                finding.failed.retain(|id, _| !fails_anyway.contains(id));
                for case in finding.failed.keys() {
                    let fault = (finding.device.clone(), name.clone());
                    cases.entry(case.clone()).or_default().push(fault);
                }
            }
            Guise::Variant(_) | Guise::Line(_) | Guise::Numbers { .. } => {}
        }
        finding.judge(&round.expects);
        if tally.hung {
            finding.wrong = Some(Wrong::Hung);
        }
        findings.push(finding);
    }
    let figures = figures(&findings, &cases);
    let idle_cases: Vec<String> = cases
        .iter()
        .filter(|(_, faults)| faults.is_empty())
        .map(|(case, _)| case.clone())
        .collect();
    let right = findings.iter().all(|finding| finding.wrong.is_none());
    let are_named = figures.named * 100 >= figures.faults * NAMED_PERCENT;
    Proof {
        holds: right && (!whole || idle_cases.is_empty() && are_named),
        figures,
        idle_cases,
        cases,
        rounds: findings,
        whole,
    }
}

fn figures(findings: &[Finding], cases: &BTreeMap<String, Vec<(String, String)>>) -> Figures {
    let faults = || {
        let is_fault = |it: &&Finding| matches!(it.guise, Guise::Fault(_));
        findings.iter().filter(is_fault)
    };
    Figures {
        faults: faults().count(),
        caught: faults().filter(|it| !it.failed.is_empty()).count(),
        caught_where_they_belong: faults().filter(|it| it.wrong.is_none()).count(),
        named: faults().filter(|it| it.named == Some(true)).count(),
        cases: cases.len(),
        cases_that_catch: cases.values().filter(|faults| !faults.is_empty()).count(),
    }
}

fn finding(round: &Round, tally: &Tally) -> Finding {
    let failed = tally.cases.iter();
    let failed = failed.filter_map(|(id, it)| Some((id.clone(), it.wrong.clone()?)));
    Finding {
        device: round.device.name().to_owned(),
        guise: round.guise.clone(),
        breaks: match &round.expects {
            Expects::Caught(claim) => claim.breaks,
            Expects::Passes | Expects::Line(_) => "",
        },
        wrong: None,
        named: None,
        failed: failed.collect(),
        inconclusive: tally.with(Verdict::Inconclusive),
        error: tally.with(Verdict::Error),
        passed_in_vain: match round.expects {
            Expects::Line(Must::PassNothing) => tally.with(Verdict::Pass),
            Expects::Line(Must::PassWhatIsOnlyHeard) => tally.those(|it| it.sent_and_passed),
            _ => Vec::new(),
        },
        stops: tally.stops.clone(),
        cases: tally.cases.len(),
    }
}

impl Finding {
    pub(super) fn passes(&self) -> bool {
        self.failed.is_empty()
            && self.inconclusive.is_empty()
            && self.error.is_empty()
            && self.stops.is_empty()
    }

    fn judge(&mut self, expects: &Expects) {
        let wrong = |is: bool, what: Wrong| is.then_some(what);
        self.wrong = match expects {
            Expects::Passes | Expects::Line(Must::PassAll) => {
                wrong(!self.passes(), Wrong::NotPassed)
            }
            Expects::Line(Must::FailNothing) => wrong(!self.failed.is_empty(), Wrong::NotPassed),
            Expects::Line(Must::Show) => wrong(self.passes(), Wrong::NotSeen),
            Expects::Line(Must::PassNothing | Must::PassWhatIsOnlyHeard) => {
                wrong(!self.passed_in_vain.is_empty(), Wrong::PassedInVain)
            }
            Expects::Caught(claim) => {
                self.named = Some(self.is_named(claim));
                self.where_caught(claim)
            }
        };
    }

    fn where_caught(&self, claim: &Claim) -> Option<Wrong> {
        if self.failed.is_empty() {
            return Some(Wrong::CaughtByNothing);
        }
        let mut cases = self.failed.keys();
        let belongs = cases.any(|case| is_about(case, claim.caught_by));
        (!belongs).then_some(Wrong::CaughtElsewhere(claim.caught_by))
    }

    fn is_named(&self, claim: &Claim) -> bool {
        self.failed
            .iter()
            .filter(|(case, _)| is_about(case, claim.caught_by))
            .any(|(_, line)| {
                let line = line.to_lowercase();
                let mut words = claim.named.iter();
                words.any(|word| line.contains(&word.to_lowercase()))
            })
    }
}

/// Whether a case is in a suite about `service`: `canopen.sdo-block` is about `sdo`, and so are the suites about what an
/// SDO server answers. The suite `canopen` of a device goes through the services as its manual does.
fn is_about(case: &str, service: &str) -> bool {
    let suite = case.split('/').next().unwrap_or_default();
    let is_of = |part: &str| {
        part.strip_prefix(service)
            .is_some_and(|rest| rest.is_empty() || rest.starts_with('-'))
    };
    let related = match service {
        "sdo" => &["abort-codes", "dictionary"][..],
        "nmt" => &["boot-up"],
        "error-control" => &["guarding", "heartbeat-consumer", "error-behaviour"],
        "cob-id" => &["cob-ids"],
        "gateway" => &["inverter"],
        // The encoder's own suite about what it measures.
        "cia406" => &["position"],
        _ => &[],
    };
    let of_its_manual = suite.ends_with(".canopen") && service != "modbus";
    let mut parts = suite.split('.');
    of_its_manual || parts.any(|part| is_of(part) || related.contains(&part))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suites_are_about_services() {
        for (case, service, is) in [
            ("canopen.sdo/reads", "sdo", true),
            ("canopen.sdo-block/reads", "sdo", true),
            ("canopen.dictionary/read", "sdo", true),
            ("kinco-servo.sdo/reads", "sdo", true),
            ("modbus.crc/worked", "modbus", true),
            ("canopen.sdo/reads", "pdo", false),
            ("canopen.sync/reads", "sy", false),
            ("canopen.nmt/sdo", "sdo", false),
        ] {
            assert_eq!(is_about(case, service), is, "{case} {service}");
        }
    }
}
