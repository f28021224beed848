//! What is known of the node's NMT state: what it was told, and what it says itself.

use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::Instant;
use fieldproof_suite::model::NmtState;
use fieldproof_wire::canopen::nmt::{Command, NmtMessage};
use fieldproof_wire::canopen::sdo::{Request, Transfer};
use fieldproof_wire::canopen::{NodeId, Service, cob_id};

/// What is known of the node.
#[derive(Debug, Clone)]
pub(crate) struct NodeWatch {
    /// The state it must be in by what it was told; unknown until it was found.
    pub(crate) state: Option<NmtState>,
    /// The state before the last command: right until the transition time is over.
    before: Option<NmtState>,
    /// When the last command was sent.
    commanded_at: Instant,
    /// Whether it was reset and its boot-up has not been seen yet.
    pub(crate) boot_up_due: bool,
    /// Whether it produces heartbeats, by its default and by what was written to 1017h since.
    pub(crate) heartbeat: bool,
    /// The period that was written to 1017h, if one was.
    pub(crate) heartbeat_period: Option<Duration>,
    /// What 1017h holds after a reset.
    heartbeat_by_default: bool,
}

impl NodeWatch {
    pub(crate) fn new(heartbeat_by_default: bool) -> NodeWatch {
        NodeWatch {
            state: None,
            before: None,
            commanded_at: Instant::START,
            boot_up_due: false,
            heartbeat: heartbeat_by_default,
            heartbeat_period: None,
            heartbeat_by_default,
        }
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
        }
    }

    /// It has booted: it is pre-operational, and forgets what was only in its memory.
    pub(crate) fn booted(&mut self) {
        self.state = Some(NmtState::PreOperational);
        self.before = None;
        self.boot_up_due = false;
        self.heartbeat = self.heartbeat_by_default;
        self.heartbeat_period = None;
    }

    /// Whether `state`, seen at `at`, is right by what the node was told.
    pub(crate) fn agrees(&self, state: NmtState, at: Instant, transition: Duration) -> bool {
        self.state.is_none_or(|expected| expected == state)
            || (self.before == Some(state) && at <= self.commanded_at + transition)
    }

    fn commanded(&mut self, command: Command, at: Instant) {
        let next = match command {
            Command::Start => NmtState::Operational,
            Command::Stop => NmtState::Stopped,
            Command::EnterPreOperational => NmtState::PreOperational,
            Command::ResetNode | Command::ResetCommunication => {
                self.boot_up_due = true;
                NmtState::PreOperational
            }
            Command::Unknown(_) => return,
        };
        self.before = self.state;
        self.state = Some(next);
        self.commanded_at = at;
    }

    fn written(&mut self, frame: &Frame) {
        if let Ok(Request::InitiateDownload {
            object,
            transfer: Transfer::Expedited(data),
        }) = Request::parse(frame.bytes())
            && object.index == 0x1017
        {
            let milliseconds = data
                .bytes()
                .iter()
                .rev()
                .fold(0, |value, byte| value << 8 | u64::from(*byte));
            self.heartbeat = milliseconds != 0;
            self.heartbeat_period = self.heartbeat.then(|| Duration::from_millis(milliseconds));
        }
    }
}
