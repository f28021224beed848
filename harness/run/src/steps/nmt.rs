//! `nmt`, `nmt-enter`, `expect-state`, `expect-boot-up`, `expect-heartbeat`.

use std::time::Duration;

use fieldproof_can::{Frame, Id};
use fieldproof_record::{Limits, Verdict};
use fieldproof_suite::device::Feature;
use fieldproof_suite::model::{
    ExpectBootUp, ExpectHeartbeat, ExpectState, Judge, Nmt, NmtAddress, NmtCommand, NmtState,
};
use fieldproof_suite::scalar::Tolerance;
use fieldproof_wire::canopen::nmt::{Command, NmtMessage, State};
use fieldproof_wire::canopen::{NodeId, Service, cob_id, identify};
use fieldproof_wire::describe::describe_frame;

use crate::limits::{nanoseconds, show};
use crate::session::{Message, Received};
use crate::stop::{Came, Stop};
use crate::tester::{DEVICE_TYPE, Tester};
use crate::unexpected::is_proper_heartbeat;

impl Tester<'_> {
    pub(super) fn nmt(&mut self, step: &Nmt) -> Result<(), Stop> {
        let command = match step.command {
            NmtCommand::Start => Command::Start,
            NmtCommand::Stop => Command::Stop,
            NmtCommand::EnterPreOperational => Command::EnterPreOperational,
            NmtCommand::ResetNode => Command::ResetNode,
            NmtCommand::ResetCommunication => Command::ResetCommunication,
        };
        let node = match step.node {
            NmtAddress::This => Some(self.node_id()?),
            NmtAddress::All => None,
            NmtAddress::Other(node) => Some(
                NodeId::new(node).ok_or_else(|| Stop::Bench(format!("{node} is not a node-ID")))?,
            ),
        };
        let frame = NmtMessage { command, node }.encode();
        self.send_frame(frame)?;
        self.history.add(self.sent_words(&frame));
        Ok(())
    }

    pub(super) fn nmt_enter(&mut self, target: NmtState) -> Result<(), Stop> {
        let command = self.command_into(target)?;
        match self.observe_state(target, self.device.timing.nmt_transition)? {
            Observed::Is | Observed::CannotTell => {
                self.history.add(describe_frame(&command));
                // What was on its way when the command came is no business of what follows. A node that becomes operational
                // sends its PDOs at once: these are.
                if target != NmtState::Operational {
                    self.session.mark_sent();
                }
                Ok(())
            }
            Observed::Not(actual) => Err(Stop::undecided(
                format!("the node could not be brought into {}", name(target)),
                name(target),
                actual,
            )),
        }
    }

    pub(crate) fn command_into(&mut self, target: NmtState) -> Result<Frame, Stop> {
        let command = match target {
            NmtState::PreOperational => Command::EnterPreOperational,
            NmtState::Operational => Command::Start,
            NmtState::Stopped => Command::Stop,
        };
        let node = Some(self.node_id()?);
        let frame = NmtMessage { command, node }.encode();
        self.send_frame(frame)?;
        Ok(frame)
    }

    pub(super) fn expect_state(&mut self, step: &ExpectState) -> Result<(), Stop> {
        let within = step.within.unwrap_or(self.device.timing.nmt_transition);
        match self.observe_state(step.is, within)? {
            Observed::Is => Ok(()),
            Observed::Not(actual) => Err(Stop::mismatch(
                format!("the node is not {}: {actual}", name(step.is)),
                name(step.is),
                actual,
                Came::Other,
            )),
            Observed::CannotTell => Err(Stop::undecided(
                "the state cannot be seen",
                name(step.is),
                "neither heartbeat nor guarding is on, no PDO came, and SDO looks the same in both states",
            )),
        }
    }

    /// Looks at the node's state by what it offers: heartbeats if they are on, guarding if it claims it, else by
    /// which services work.
    fn observe_state(&mut self, expected: NmtState, within: Duration) -> Result<Observed, Stop> {
        if self.watch.heartbeat {
            self.observe_by_heartbeat(expected, within)
        } else if self.claims(Feature::NodeGuarding) {
            self.observe_by_guarding(expected, within)
        } else {
            self.observe_by_services(expected, within)
        }
    }

    /// A node that sends PDOs is operational; one that does not answer SDO is stopped; else both looks are the same.
    fn observe_by_services(
        &mut self,
        expected: NmtState,
        within: Duration,
    ) -> Result<Observed, Stop> {
        let settled = self.session.last_sent().end + within;
        self.session.collect_until(settled)?;
        match expected {
            NmtState::Operational if self.has_sent_pdos() => Ok(Observed::Is),
            _ if self.claims(Feature::SdoServer) => self.observe_by_sdo(expected),
            _ => Ok(Observed::CannotTell),
        }
    }

    fn observe_by_heartbeat(
        &mut self,
        expected: NmtState,
        within: Duration,
    ) -> Result<Observed, Stop> {
        let id = Id::Standard(self.identifier(Service::ErrorControl)?);
        let commanded_at = self.session.last_sent().end;
        let period = self
            .watch
            .heartbeat_period
            .unwrap_or(Duration::from_secs(1));
        let patience = within + period * 2;
        let mut last = None;
        while let Some((frame, received)) = self.first_frame(id, patience)? {
            let state = frame
                .bytes()
                .first()
                .map(|byte| State::from_code(byte & 0x7F));
            if state == Some(wire_state(expected)) {
                let in_time = received.at.since(commanded_at) <= within + period * 2;
                return Ok(if in_time {
                    Observed::Is
                } else {
                    Observed::Not("too late".into())
                });
            }
            if received.at > commanded_at + within {
                return Ok(Observed::Not(format!(
                    "{} (heartbeat {} after the command)",
                    show_state(state),
                    show(received.at.since(commanded_at))
                )));
            }
            last = state;
        }
        Ok(Observed::Not(match last {
            None => "no heartbeat came".into(),
            Some(state) => show_state(Some(state)),
        }))
    }

    fn observe_by_guarding(
        &mut self,
        expected: NmtState,
        within: Duration,
    ) -> Result<Observed, Stop> {
        // The node may take its time to change state, and is asked only once that is over.
        let settled = self.session.last_sent().end + within;
        self.session.collect_until(settled)?;
        let id = self.identifier(Service::ErrorControl)?;
        let Some(request) = Frame::remote(id, 1) else {
            return Ok(Observed::CannotTell);
        };
        self.send_frame(request)?;
        let answer = self.first_frame(Id::Standard(id), self.device.timing.sdo_response)?;
        let state = answer.and_then(|(frame, _)| frame.bytes().first().copied());
        Ok(match state.map(|byte| State::from_code(byte & 0x7F)) {
            Some(state) if state == wire_state(expected) => Observed::Is,
            Some(state) => Observed::Not(format!("{} (guarding)", show_state(Some(state)))),
            None => Observed::Not("no answer to the guarding request".into()),
        })
    }

    fn observe_by_sdo(&mut self, expected: NmtState) -> Result<Observed, Stop> {
        let within = self.device.timing.sdo_response;
        let answers = match self.sdo_upload(DEVICE_TYPE, within) {
            Ok(_) => true,
            Err(Stop::Mismatch(mismatch)) if matches!(mismatch.came, Came::Silence) => false,
            Err(stop) => return Err(stop),
        };
        Ok(match (expected, answers) {
            (NmtState::Stopped, false) => Observed::Is,
            (NmtState::Stopped, true) => Observed::Not("SDO is answered".into()),
            (_, false) => Observed::Not("SDO is not answered".into()),
            (NmtState::PreOperational | NmtState::Operational, true) => Observed::CannotTell,
        })
    }

    /// Whether a PDO of the node has come since the last send.
    pub(crate) fn has_sent_pdos(&self) -> bool {
        let node = self.node;
        self.session.has_come(|received| match received.message {
            Message::Can(frame) => {
                frame
                    .standard_id()
                    .and_then(identify)
                    .is_some_and(|(service, from)| {
                        matches!(service, Service::TransmitPdo(_)) && from == node
                    })
            }
            Message::Serial { .. } => false,
        })
    }

    pub(super) fn expect_boot_up(&mut self, step: &ExpectBootUp) -> Result<(), Stop> {
        let within = step.within.unwrap_or(self.device.timing.boot_up);
        let node = match step.node {
            None => self.node_id()?,
            Some(node) => {
                NodeId::new(node).ok_or_else(|| Stop::Bench(format!("{node} is not a node-ID")))?
            }
        };
        let id = cob_id(Service::ErrorControl, Some(node));
        let expected = format!("{:03X}#00 within {}", id.raw(), show(within));
        let Some((frame, received)) = self.first_but_heartbeats(Id::Standard(id), within)? else {
            return Err(Stop::mismatch(
                format!(
                    "no boot-up message of node {node} ({:03X}h) came{}",
                    id.raw(),
                    self.but_another_booted()
                ),
                expected,
                "nothing",
                Came::Silence,
            ));
        };
        if frame.is_remote() || frame.bytes() != [0] {
            return Err(Stop::mismatch(
                format!(
                    "another message came before the boot-up: {}",
                    describe_frame(&frame)
                ),
                expected,
                frame.to_string(),
                Came::Frame(frame),
            ));
        }
        self.measure_response("boot-up time", &received, within)?;
        self.node = Some(node);
        self.watch.booted(received.at);
        Ok(())
    }

    /// `, but node-ID 85 booted`, if another than the expected one did.
    pub(super) fn but_another_booted(&self) -> String {
        let booted = self.session.look_for(|received| match &received.message {
            Message::Can(frame) if frame.bytes() == [0] => {
                match frame.standard_id().and_then(identify)? {
                    (Service::ErrorControl, node) => node,
                    _ => None,
                }
            }
            _ => None,
        });
        booted.map_or_else(String::new, |node| format!(", but node-ID {node} booted"))
    }

    /// The first frame with this identifier, heartbeats that were waiting for the bus left aside.
    fn first_but_heartbeats(
        &mut self,
        id: Id,
        within: Duration,
    ) -> Result<Option<(Frame, Received)>, Stop> {
        loop {
            let found = self.first_frame(id, within)?;
            let transition = self.device.timing.nmt_transition;
            match found {
                Some((frame, received))
                    if is_proper_heartbeat(
                        &frame,
                        received.at,
                        &self.watch,
                        self.node,
                        transition,
                    ) => {}
                found => return Ok(found),
            }
        }
    }

    pub(super) fn expect_heartbeat(&mut self, step: &ExpectHeartbeat) -> Result<(), Stop> {
        let id = Id::Standard(self.identifier(Service::ErrorControl)?);
        let patience = step.period.nominal + step.period.tolerance * 2;
        let mut periods = Vec::new();
        let mut last = None;
        let mut wait_until = self.session.now() + patience * 2;
        while periods.len() < step.count as usize {
            let within = wait_until.since(self.session.last_sent().end);
            let Some((frame, received)) = self.first_frame(id, within)? else {
                return Err(Stop::mismatch(
                    "the heartbeats stop",
                    format!("{} more", step.count as usize - periods.len()),
                    "nothing",
                    Came::Silence,
                ));
            };
            let expected = wire_state(step.state);
            if frame.bytes() != [expected.code()] {
                return Err(Stop::mismatch(
                    format!(
                        "the heartbeat carries another state than {}: {}",
                        name(step.state),
                        describe_frame(&frame)
                    ),
                    format!("{:02X}h ({})", expected.code(), name(step.state)),
                    frame.to_string(),
                    Came::Frame(frame),
                ));
            }
            if let Some(last) = last {
                periods.push(received.at.since(last));
            }
            last = Some(received.at);
            wait_until = received.at + patience + step.period.nominal;
        }
        let port = self.can_port()?;
        let uncertainty = self.session.uncertainty(port) * 2;
        self.judge_periods(
            "heartbeat period",
            &periods,
            step.period,
            step.judge,
            uncertainty,
        )
    }

    /// Judges each period, their mean or their median.
    pub(super) fn judge_periods(
        &mut self,
        name: &'static str,
        periods: &[Duration],
        limit: Tolerance,
        judge: Judge,
        uncertainty: Duration,
    ) -> Result<(), Stop> {
        let limits = Limits {
            min_ns: Some(nanoseconds(limit.nominal.saturating_sub(limit.tolerance))),
            max_ns: Some(nanoseconds(limit.nominal + limit.tolerance)),
        };
        let mut sorted = periods.to_vec();
        sorted.sort_unstable();
        let count = u32::try_from(periods.len()).unwrap_or(u32::MAX).max(1);
        match judge {
            Judge::Mean => {
                let mean = periods.iter().sum::<Duration>() / count;
                self.measure(name, mean, uncertainty / count, limits)
            }
            Judge::Median => {
                let median = sorted.get(sorted.len() / 2).copied().unwrap_or_default();
                self.measure(name, median, uncertainty, limits)
            }
            Judge::Each => {
                // The two ends are the worst; when both pass, all do.
                let ends = [sorted.first(), sorted.last()];
                let worst = ends.into_iter().flatten().max_by_key(|period| {
                    let verdict = crate::limits::judge(**period, uncertainty, limits);
                    (verdict_rank(verdict), period.abs_diff(limit.nominal))
                });
                self.measure(
                    name,
                    worst.copied().unwrap_or_default(),
                    uncertainty,
                    limits,
                )
            }
        }
    }
}

const fn verdict_rank(verdict: Verdict) -> u8 {
    match verdict {
        Verdict::Pass => 0,
        Verdict::Inconclusive => 1,
        _ => 2,
    }
}

/// What looking at the state gave.
enum Observed {
    Is,
    Not(String),
    CannotTell,
}

const fn wire_state(state: NmtState) -> State {
    match state {
        NmtState::PreOperational => State::PreOperational,
        NmtState::Operational => State::Operational,
        NmtState::Stopped => State::Stopped,
    }
}

const fn name(state: NmtState) -> &'static str {
    match state {
        NmtState::PreOperational => "pre-operational",
        NmtState::Operational => "operational",
        NmtState::Stopped => "stopped",
    }
}

fn show_state(state: Option<State>) -> String {
    state.map_or_else(
        || "a message without a state".into(),
        |state| state.to_string(),
    )
}
