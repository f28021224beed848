//! What is known of the node's NMT state: what it was told, and what it says itself.

use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::Instant;
use fieldproof_suite::model::NmtState;
use fieldproof_wire::canopen::nmt::{Command, NmtMessage};
use fieldproof_wire::canopen::sdo::{Request, Transfer};
use fieldproof_wire::canopen::{Multiplexer, NodeId, Service, cob_id};

/// What is known of the node.
#[derive(Debug, Clone)]
pub(crate) struct NodeWatch {
    /// The states it was told to be in, each with the instant from which it should; the last one is the present one.
    /// Empty until it was found.
    states: Vec<(Instant, NmtState)>,
    /// Whether it was reset and its boot-up has not been seen yet.
    pub(crate) boot_up_due: bool,
    /// Whether it produces heartbeats, by its default and by what was written to 1017h since.
    pub(crate) heartbeat: bool,
    /// When it was last told not to, if it was; `None` within while that is not confirmed.
    heartbeat_ended_at: Option<Option<Instant>>,
    /// The period that was written to 1017h, if one was.
    pub(crate) heartbeat_period: Option<Duration>,
    /// What 1017h holds after a reset by the dictionary.
    heartbeat_by_default: bool,
    /// Whether 1017h may hold something else after a reset, for it was found or saved so.
    may_outlive_reset: bool,
    /// What 1017h was found to hold, in milliseconds, if that was a heartbeat.
    found_heartbeat: Option<u16>,
    /// Whether it was reset since 1017h was seen to hold that.
    may_have_forgotten: bool,
    /// Nobody knows whether it produces heartbeats.
    unsure: bool,
    /// When it was asked for its state by guarding requests whose answers have not been expected yet.
    guarding_requests: Vec<Instant>,
}

impl NodeWatch {
    pub(crate) fn new(heartbeat_by_default: bool) -> NodeWatch {
        NodeWatch {
            states: Vec::new(),
            boot_up_due: false,
            heartbeat: heartbeat_by_default,
            heartbeat_ended_at: None,
            heartbeat_period: None,
            heartbeat_by_default,
            may_outlive_reset: false,
            found_heartbeat: None,
            may_have_forgotten: false,
            unsure: false,
            guarding_requests: Vec::new(),
        }
    }

    /// The state it must be in by what it was told.
    pub(crate) fn state(&self) -> Option<NmtState> {
        self.states.last().map(|(_, state)| *state)
    }

    /// It was found in a state.
    pub(crate) fn found(&mut self, state: NmtState, at: Instant) {
        self.states = vec![(at, state)];
    }

    /// 1017h holds so many milliseconds: what it holds after a reset may be the same, if it was stored.
    pub(crate) fn found_heartbeat(&mut self, milliseconds: u16) {
        self.wrote(HEARTBEAT, &milliseconds.to_le_bytes());
        self.may_outlive_reset |= self.heartbeat != self.heartbeat_by_default;
        self.found_heartbeat = (milliseconds != 0).then_some(milliseconds);
    }

    /// What 1017h was found to hold, in milliseconds, if a reset may have made the node forget it.
    pub(crate) fn forgotten_heartbeat(&self) -> Option<u16> {
        self.found_heartbeat.filter(|_| self.may_have_forgotten)
    }

    /// A case begins: what was before the present state matters no more.
    pub(crate) fn begin_case(&mut self) {
        self.states.drain(..self.states.len().saturating_sub(1));
        self.heartbeat_ended_at = None;
        self.guarding_requests.clear();
    }

    /// Follows a frame of the tester.
    pub(crate) fn sent(&mut self, frame: &Frame, at: Instant, node: Option<NodeId>) {
        let (Some(id), Some(node)) = (frame.standard_id(), node) else {
            return;
        };
        if id == cob_id(Service::Nmt, None) {
            if let Ok(message) = NmtMessage::parse(frame)
                && message.node.is_none_or(|addressed| addressed == node)
            {
                self.commanded(message.command, at);
            }
        } else if id == cob_id(Service::SdoRequest, Some(node)) {
            self.written(frame);
        } else if id == cob_id(Service::ErrorControl, Some(node)) && frame.is_remote() {
            self.guarding_requests.push(at);
        }
    }

    /// A frame of error control was expected. Beside a heartbeat nobody can tell whether it was a guarding answer.
    pub(crate) fn expected_error_control(&mut self, at: Instant, within: Duration) {
        if !self.heartbeat {
            self.takes_guarding_answer(at, within);
        }
    }

    /// Whether a frame at `at` may be a guarding answer: there is one for each request, within some time.
    pub(crate) fn takes_guarding_answer(&mut self, at: Instant, within: Duration) -> bool {
        let asked = self
            .guarding_requests
            .iter()
            .rposition(|asked| *asked <= at && at <= *asked + within);
        asked
            .map(|place| self.guarding_requests.remove(place))
            .is_some()
    }

    /// It has booted: it is pre-operational, and forgets what was only in its memory.
    pub(crate) fn booted(&mut self, at: Instant) {
        self.states.push((at, NmtState::PreOperational));
        self.boot_up_due = false;
        self.reset_heartbeat(at);
    }

    /// Whether `state`, seen at `at`, is right by what the node had been told by then. Each new state may take
    /// `transition` to come about.
    pub(crate) fn agrees(&self, state: NmtState, at: Instant, transition: Duration) -> bool {
        let told_by_then = self
            .states
            .iter()
            .take_while(|(since, _)| *since <= at)
            .count();
        let in_force = told_by_then.saturating_sub(1);
        let still_right = |index: usize| {
            index == in_force
                || self
                    .states
                    .get(index + 1)
                    .is_some_and(|(ended, _)| at <= *ended + transition)
        };
        self.states.is_empty()
            || (0..=in_force).any(|index| {
                self.states.get(index).is_some_and(|(_, s)| *s == state) && still_right(index)
            })
    }

    /// Whether a heartbeat at `at` is in order: they are on, or were until just before.
    pub(crate) fn had_heartbeat(&self, at: Instant) -> bool {
        self.heartbeat
            || self.unsure
            || self
                .heartbeat_ended_at
                .is_some_and(|ended| ended.is_none_or(|ended| at <= ended + GRACE))
    }

    /// The server has answered: what was written holds from now on.
    pub(crate) fn confirmed(&mut self, at: Instant) {
        if let Some(ended @ None) = &mut self.heartbeat_ended_at {
            *ended = Some(at);
        }
    }

    /// A case ended early: nobody knows what the node made of the last command.
    pub(crate) fn forget_state(&mut self) {
        self.states.clear();
    }

    fn commanded(&mut self, command: Command, at: Instant) {
        let next = match command {
            Command::Start => NmtState::Operational,
            Command::Stop => NmtState::Stopped,
            Command::EnterPreOperational => NmtState::PreOperational,
            Command::ResetNode | Command::ResetCommunication => {
                self.boot_up_due = true;
                self.reset_heartbeat(at);
                NmtState::PreOperational
            }
            Command::Unknown(_) => return,
        };
        self.states.push((at, next));
    }

    fn written(&mut self, frame: &Frame) {
        if let Ok(Request::InitiateDownload {
            object,
            transfer: Transfer::Expedited(data),
        }) = Request::parse(frame.bytes())
        {
            self.wrote(object, data.bytes());
        }
    }

    /// The client is about to end a download of `value`.
    pub(crate) fn wrote(&mut self, object: Multiplexer, value: &[u8]) {
        if object.index == STORE {
            self.may_outlive_reset |= self.heartbeat != self.heartbeat_by_default;
        }
        if object != HEARTBEAT {
            return;
        }
        let bytes = value.iter().take(4).rev();
        let milliseconds = bytes.fold(0, |value, byte| value << 8 | u64::from(*byte));
        let period = (milliseconds != 0).then(|| Duration::from_millis(milliseconds));
        self.unsure = false;
        let is_as_found = self.found_heartbeat.map(u64::from) == Some(milliseconds);
        self.may_have_forgotten &= !is_as_found;
        self.set_heartbeat(period.is_some(), period, None);
    }

    fn reset_heartbeat(&mut self, at: Instant) {
        self.unsure = self.may_outlive_reset;
        self.may_have_forgotten = true;
        self.set_heartbeat(self.heartbeat_by_default, None, Some(at));
    }

    fn set_heartbeat(&mut self, on: bool, period: Option<Duration>, at: Option<Instant>) {
        if self.heartbeat && !on {
            self.heartbeat_ended_at = Some(at);
        }
        self.heartbeat = on;
        self.heartbeat_period = period;
    }
}

/// The period of the heartbeat.
pub(crate) const HEARTBEAT: Multiplexer = Multiplexer::new(0x1017, 0);
/// The object that saves parameters.
const STORE: u16 = 0x1010;

/// How long after it has ended a heartbeat may still come that was already waiting for the bus.
const GRACE: Duration = Duration::from_millis(10);

#[cfg(test)]
mod tests {
    use super::*;

    const TRANSITION: Duration = Duration::from_millis(10);

    fn ms(milliseconds: u64) -> Instant {
        Instant::from_nanos(milliseconds * 1_000_000)
    }

    fn watch() -> NodeWatch {
        let mut watch = NodeWatch::new(true);
        watch.found(NmtState::PreOperational, ms(0));
        watch.commanded(Command::Start, ms(100));
        watch.commanded(Command::Stop, ms(200));
        watch
    }

    #[test]
    fn a_state_is_judged_by_what_the_node_had_been_told_when_it_was_seen() {
        let watch = watch();
        assert!(watch.agrees(NmtState::PreOperational, ms(50), TRANSITION));
        assert!(watch.agrees(NmtState::Operational, ms(150), TRANSITION));
        assert!(watch.agrees(NmtState::Stopped, ms(250), TRANSITION));
        assert!(!watch.agrees(NmtState::Operational, ms(50), TRANSITION));
        assert!(!watch.agrees(NmtState::PreOperational, ms(150), TRANSITION));
        assert!(!watch.agrees(NmtState::Operational, ms(250), TRANSITION));
    }

    #[test]
    fn the_state_before_is_right_until_the_transition_is_over() {
        let watch = watch();
        assert!(watch.agrees(NmtState::Operational, ms(209), TRANSITION));
        assert!(!watch.agrees(NmtState::Operational, ms(211), TRANSITION));
        assert!(!watch.agrees(NmtState::PreOperational, ms(209), TRANSITION));
    }

    #[test]
    fn a_guarding_request_may_be_answered_once() {
        let mut watch = watch();
        let within = Duration::from_millis(50);
        let request = Frame::remote(cob_id(Service::ErrorControl, NodeId::new(1)), 1);
        watch.sent(&request.expect("a frame"), ms(300), NodeId::new(1));
        assert!(!watch.takes_guarding_answer(ms(299), within));
        assert!(!watch.takes_guarding_answer(ms(351), within));
        assert!(watch.takes_guarding_answer(ms(310), within));
        assert!(!watch.takes_guarding_answer(ms(311), within));
        watch.sent(&request.expect("a frame"), ms(400), NodeId::new(1));
        watch.expected_error_control(ms(401), within);
        assert!(watch.takes_guarding_answer(ms(402), within), "a heartbeat");
        watch.wrote(Multiplexer::new(0x1017, 0), &[0, 0]);
        watch.sent(&request.expect("a frame"), ms(500), NodeId::new(1));
        watch.expected_error_control(ms(501), within);
        assert!(!watch.takes_guarding_answer(ms(502), within));
    }

    #[test]
    fn heartbeats_end_with_a_reset_and_with_a_write_of_zero() {
        let mut watch = NodeWatch::new(false);
        let node = NodeId::new(1);
        let write = |text: &str| text.parse::<Frame>().expect("a frame");
        watch.sent(&write("601#2B1710000A000000"), ms(10), node);
        assert_eq!(watch.heartbeat_period, Some(Duration::from_millis(10)));
        watch.sent(&write("601#2B17100000000000"), ms(100), node);
        assert!(
            watch.had_heartbeat(ms(600)),
            "the write is not confirmed yet"
        );
        watch.confirmed(ms(110));
        assert!(watch.had_heartbeat(ms(115)));
        assert!(!watch.had_heartbeat(ms(130)));
        watch.sent(&write("601#2B1710000A000000"), ms(200), node);
        watch.sent(&write("000#8201"), ms(300), node);
        assert!(watch.boot_up_due);
        assert!(watch.had_heartbeat(ms(299)));
        assert!(!watch.had_heartbeat(ms(320)));
    }

    #[test]
    fn a_saved_heartbeat_may_come_after_a_reset() {
        let mut watch = NodeWatch::new(false);
        let node = NodeId::new(1);
        let mut send = |text: &str, at| watch.sent(&text.parse().expect("a frame"), ms(at), node);
        send("601#2B1710000A000000", 10);
        send("601#2310100173617665", 20);
        send("601#2B17100000000000", 30);
        send("000#8201", 300);
        assert!(watch.had_heartbeat(ms(500)));
        watch.booted(ms(510));
        assert!(watch.had_heartbeat(ms(600)));
        watch.wrote(HEARTBEAT, &[0, 0]);
        watch.confirmed(ms(610));
        assert!(!watch.had_heartbeat(ms(700)));
    }

    #[test]
    fn a_heartbeat_that_was_found_may_come_after_a_reset() {
        let mut watch = NodeWatch::new(false);
        watch.found_heartbeat(1_000);
        assert!(watch.heartbeat && watch.had_heartbeat(ms(10)));
        watch.commanded(Command::ResetNode, ms(20));
        assert!(!watch.heartbeat && watch.had_heartbeat(ms(500)));

        let mut watch = NodeWatch::new(false);
        watch.found_heartbeat(0);
        watch.commanded(Command::ResetNode, ms(20));
        assert!(!watch.had_heartbeat(ms(500)));
    }
}
