//! What a case that can be read may still get wrong: it can never fail, its expectation can never be met, it does more
//! than it declares.

use super::CaseTemplate;
use crate::code;
use crate::model::{
    Alternative, Case, DriveTarget, Effect, Located, ModbusRequest, Need, NmtAddress, NmtCommand,
    PowerAction, Protocol, Step, Stimulate, StimulusName, SuiteHead,
};
use crate::problem::Problem;

/// Pushes what is wrong with the meaning of a case.
pub(super) fn case(
    head: &SuiteHead,
    case: &Case,
    template: &CaseTemplate,
    problems: &mut Vec<Problem>,
) {
    check_head(case, template, problems);
    let mut something_was_sent = false;
    for step in flat(&case.control).into_iter().chain(flat(&case.steps)) {
        if !something_was_sent && needs_a_cause(head.protocol, &step.value) {
            let problem = Problem::new(
                code::NEVER_MET,
                "nothing was sent yet, so this can never come",
                "an expectation looks back to the last send, never before the case",
            );
            problems.push(*problem.at(step.at));
        }
        something_was_sent |= is_cause(&step.value);
    }
    for step in all_steps(case) {
        check_protocol(head.protocol, step, problems);
        check_effects(case, step, problems);
        check_needs(case, step, problems);
        check_alternatives(step, problems);
    }
}

/// What may come in the place of a frame comes with its identifier, for nothing else is looked at.
fn check_alternatives(step: &Located<Step>, problems: &mut Vec<Problem>) {
    let Step::Expect(expect) = &step.value else {
        return;
    };
    let id = expect.frame.0.id();
    let elsewhere =
        |one: &Alternative| matches!(one, Alternative::Frame(frame) if frame.0.id() != id);
    if expect.or.iter().any(elsewhere) {
        let problem = Problem::new(
            code::NEVER_MET,
            "a frame with another identifier cannot come in the place of this one",
            "expected the identifier of `frame` in `or`",
        );
        problems.push(*problem.at(step.at));
    }
}

/// What the case as a whole lacks.
fn check_head(case: &Case, template: &CaseTemplate, problems: &mut Vec<Problem>) {
    let at_key = |key: &str| {
        let entry = template.body.entry(key);
        entry.map_or(template.at, |entry| entry.key.at)
    };
    if !flat(&case.steps)
        .into_iter()
        .any(|step| can_fail(&step.value))
    {
        let problem = Problem::new(
            code::NEVER_FAILS,
            "no step of this case expects anything, so it can never fail",
            "expected at least one expectation",
        );
        problems.push(*problem.at(at_key("steps")));
    }
    if case.cites.is_empty() {
        let problem = Problem::new(
            code::EMPTY,
            "this case cites nothing",
            "expected at least one source",
        );
        problems.push(*problem.at(at_key("cite")));
    }
    if !case.against.is_empty() && case.because.is_none() {
        let problem = Problem::new(
            code::KEYS_TOGETHER,
            "this case decides against a source and does not say why",
            "needs `because`",
        );
        problems.push(*problem.at(at_key("against")));
    }
}

fn all_steps(case: &Case) -> impl Iterator<Item = &Located<Step>> {
    let parts = [&case.control, &case.steps, &case.restore.steps];
    parts.into_iter().flat_map(|steps| flat(steps))
}

/// The steps as they are played once; in place of a `repeat` what is inside it.
fn flat(steps: &[Located<Step>]) -> Vec<&Located<Step>> {
    let mut all = Vec::with_capacity(steps.len());
    for step in steps {
        match &step.value {
            Step::Repeat(repeat) => all.extend(flat(&repeat.steps)),
            _ => all.push(step),
        }
    }
    all
}

fn can_fail(step: &Step) -> bool {
    match step {
        Step::Expect(_)
        | Step::ExpectSilence(_)
        | Step::ExpectState(_)
        | Step::ExpectBootUp(_)
        | Step::ExpectHeartbeat(_)
        | Step::ExpectTpdo(_)
        | Step::ExpectMapping(_)
        | Step::ExpectBytes(_)
        | Step::SdoRead(_)
        | Step::SdoWrite(_)
        | Step::ExpectDrive(_)
        | Step::Modbus(_) => true,
        Step::Send(_)
        | Step::Flood(_)
        | Step::Nmt(_)
        | Step::NmtEnter(_)
        | Step::DriveEnter(_)
        | Step::Sync(_)
        | Step::StartSync(_)
        | Step::StopSync
        | Step::SendRpdo(_)
        | Step::SendBytes(_)
        | Step::Connect(_)
        | Step::Disconnect(_)
        | Step::Stimulate(_)
        | Step::SetBitRate(_)
        | Step::Repeat(_) => false,
    }
}

/// Whether the device may answer this step, or do something because of it.
fn is_cause(step: &Step) -> bool {
    !matches!(
        step,
        Step::Expect(_)
            | Step::ExpectSilence(_)
            | Step::ExpectState(_)
            | Step::ExpectBootUp(_)
            | Step::ExpectHeartbeat(_)
            | Step::ExpectTpdo(_)
            | Step::ExpectBytes(_)
            | Step::Connect(_)
            | Step::Disconnect(_)
            | Step::StopSync
    )
}

/// Whether this never comes by itself: an answer of SDO, LSS or Modbus, a boot-up message.
fn needs_a_cause(protocol: Protocol, step: &Step) -> bool {
    match step {
        Step::Expect(expect) => {
            let id = expect.frame.0.id();
            !id.is_extended() && matches!(id.raw(), 0x581..=0x5FF | 0x7E4)
        }
        Step::ExpectBytes(_) => protocol == Protocol::Modbus,
        Step::ExpectBootUp(_) => true,
        _ => false,
    }
}

fn check_protocol(protocol: Protocol, step: &Located<Step>, problems: &mut Vec<Problem>) {
    let serial = matches!(
        step.value,
        Step::Modbus(_)
            | Step::SendBytes(_)
            | Step::ExpectBytes(_)
            | Step::Connect(_)
            | Step::Disconnect(_)
    );
    let either = matches!(step.value, Step::ExpectSilence(_) | Step::Stimulate(_));
    let (wrong, speaks, other) = match protocol {
        Protocol::Canopen => (serial, "canopen", "modbus"),
        Protocol::Modbus => (!serial && !either, "modbus", "canopen"),
        Protocol::Gateway => return,
    };
    if wrong {
        let problem = Problem::new(
            code::WRONG_PROTOCOL,
            format!("this suite speaks {speaks}, and this is a verb of {other}"),
            format!("not in a suite of `protocol: {speaks}`"),
        );
        problems.push(*problem.at(step.at));
    }
}

fn check_effects(case: &Case, step: &Located<Step>, problems: &mut Vec<Problem>) {
    let Some((effect, word, does)) = effect_of(&step.value) else {
        return;
    };
    // What writes non-volatile memory or readdresses the device writes, too.
    let declared = case.effects.contains(&effect)
        || (effect == Effect::Writes
            && case
                .effects
                .iter()
                .any(|declared| matches!(declared, Effect::Persists | Effect::Readdresses)));
    if !declared {
        let problem = Problem::new(
            code::UNDECLARED,
            format!("this {does}, and the case does not declare it"),
            format!("needs `effects: [{word}]`"),
        );
        problems.push(*problem.at(step.at));
    }
}

/// A stimulus that the bench may lack must be declared, or the case would break there instead of being skipped.
fn check_needs(case: &Case, step: &Located<Step>, problems: &mut Vec<Problem>) {
    let Step::Stimulate(stimulate) = &step.value else {
        return;
    };
    let (stimulus, word) = match stimulate {
        Stimulate::Power(_) => (StimulusName::Power, "power"),
        Stimulate::ProcessValue { .. } => (StimulusName::ProcessValue, "process-value"),
        Stimulate::Condition { .. } => (StimulusName::Condition, "condition"),
        Stimulate::Setting { .. } => (StimulusName::Setting, "setting"),
        // The tester's own, which no bench need offer.
        Stimulate::Companion { .. } => return,
    };
    if !case.needs.contains(&Need::Stimulus(stimulus)) {
        let problem = Problem::new(
            code::UNDECLARED,
            "this stimulus is not among what the case needs",
            format!("needs `needs: [stimulus: {word}]`"),
        );
        problems.push(*problem.at(step.at));
    }
}

/// What a step of a service certainly does; of raw frames and bytes only their author knows.
fn effect_of(step: &Step) -> Option<(Effect, &'static str, &'static str)> {
    match step {
        Step::SdoWrite(_) => Some((Effect::Writes, "writes", "writes an object")),
        Step::DriveEnter(DriveTarget::OperationEnabled) => {
            Some((Effect::Moves, "moves", "enables a drive"))
        }
        Step::DriveEnter(_) => Some((Effect::Writes, "writes", "writes a controlword")),
        Step::Modbus(modbus) => match modbus.request {
            ModbusRequest::WriteSingle { .. } | ModbusRequest::WriteMultiple { .. } => {
                Some((Effect::Writes, "writes", "writes a register"))
            }
            _ => None,
        },
        Step::Nmt(nmt) if nmt.node == NmtAddress::All => {
            Some((Effect::DisturbsBus, "disturbs-bus", "speaks to all nodes"))
        }
        Step::Nmt(nmt)
            if matches!(
                nmt.command,
                NmtCommand::ResetNode | NmtCommand::ResetCommunication
            ) =>
        {
            Some((Effect::Resets, "resets", "resets the device"))
        }
        Step::Stimulate(Stimulate::Power(PowerAction::Off | PowerAction::Cycle)) => {
            Some((Effect::Resets, "resets", "takes the device's power"))
        }
        _ => None,
    }
}
