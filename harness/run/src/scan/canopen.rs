//! Which nodes are on a CANopen network.

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::{Instant, Lane, LinkError, PortIndex};
use fieldproof_wire::canopen::sdo::Request;
use fieldproof_wire::canopen::{NodeId, Service, cob_id, identify, lss};

use super::bus::{Bus, News};
use super::lss::{LssFound, inquire};
use super::questions::{Answers, Questions};
use super::traffic::{HeardFrom, HeardIdentifier};

/// How a CANopen network is scanned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CanopenScan {
    /// How long it listens before it asks.
    pub listen: Duration,
    /// How long a node may take to answer. All are waited for at once.
    pub timeout: Duration,
    /// Whether slaves are asked for their identity over LSS, too, for which they are switched to configuration and back.
    pub lss: bool,
}

/// What was found on a CANopen network.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CanopenFound {
    /// By node-ID.
    pub nodes: Vec<FoundNode>,
    /// What else was heard.
    pub identifiers: Vec<HeardIdentifier>,
    /// How often the tester's own controller told of trouble on the bus.
    pub bus_errors: u32,
    /// Whether a slave without a node-ID answered.
    pub unconfigured: bool,
    /// What LSS gave, if it was asked for.
    pub lss: Option<LssFound>,
}

/// A node that was heard or that answered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FoundNode {
    /// Its node-ID.
    pub node: NodeId,
    /// What it says of itself; `None` if its SDO server did not answer.
    pub answers: Option<Answers>,
    /// What it sends by itself.
    pub heard: HeardFrom,
}

/// Listens on `port`, then asks all 127 nodes at once who they are. Only objects are read.
///
/// # Errors
/// [`LinkError`]: the link failed, or nobody acknowledges anything.
pub fn scan_canopen(
    lane: &mut dyn Lane,
    port: PortIndex,
    how: &CanopenScan,
) -> Result<CanopenFound, LinkError> {
    let mut bus = Bus::new(lane, port);
    bus.listen(how.listen)?;
    let mut asking = Asking::new(how.timeout);
    asking.run(&mut bus)?;
    let Asking {
        mut answers,
        unconfigured,
        ..
    } = asking;
    let mut found = BTreeMap::new();
    for node in (1..=NodeId::MAX.raw()).filter_map(NodeId::new) {
        let answers = answers.remove(&node);
        let heard = bus.traffic.nodes.get(&node);
        if answers.is_some() || heard.is_some() {
            found.insert(node, answers);
        }
    }
    let lss = match how.lss {
        true => Some(inquire(&mut bus, found.len(), unconfigured, how.timeout)?),
        false => None,
    };
    let mut traffic = std::mem::take(&mut bus.traffic);
    let nodes = found.into_iter().map(|(node, answers)| FoundNode {
        node,
        answers,
        heard: traffic.nodes.remove(&node).unwrap_or_default(),
    });
    Ok(CanopenFound {
        nodes: nodes.collect(),
        identifiers: traffic.identifiers,
        bus_errors: traffic.bus_errors,
        unconfigured,
        lss,
    })
}

/// Conversations with all nodes at the same time.
struct Asking {
    timeout: Duration,
    open: BTreeMap<NodeId, Conversation>,
    to_send: VecDeque<Frame>,
    answers: BTreeMap<NodeId, Answers>,
    unconfigured: bool,
}

struct Conversation {
    questions: Questions,
    /// When its answer is too late; never as long as the request waits to be sent.
    deadline: Instant,
}

impl Asking {
    fn new(timeout: Duration) -> Asking {
        let nodes = (1..=NodeId::MAX.raw()).filter_map(NodeId::new);
        let mut asking = Asking {
            timeout,
            open: BTreeMap::new(),
            to_send: VecDeque::new(),
            answers: BTreeMap::new(),
            unconfigured: false,
        };
        // The answers come while the nodes are asked.
        let question = lss::Request::IdentifyNonConfigured;
        asking.to_send.push_back(question.encode());
        for node in nodes {
            let conversation = Conversation {
                questions: Questions::default(),
                deadline: Instant::NEVER,
            };
            asking.open.insert(node, conversation);
            asking.to_send.push_back(request(node, Questions::first()));
        }
        asking
    }

    fn run(&mut self, bus: &mut Bus<'_>) -> Result<(), LinkError> {
        let mut last = bus.now();
        while !(self.open.is_empty() && self.to_send.is_empty()) {
            if bus.has_room()
                && let Some(frame) = self.to_send.pop_front()
            {
                last = bus.send(frame)?;
                self.was_sent(&frame, last);
                continue;
            }
            let deadlines = self.open.values().map(|it| it.deadline);
            let stuck = bus.now() + self.timeout;
            let until = deadlines.min().unwrap_or(stuck).min(stuck);
            match bus.receive(until)? {
                Some(News::Left(at, frame)) => {
                    last = at;
                    self.was_sent(&frame, at);
                }
                Some(News::Came(frame)) => self.came(&frame),
                None => {
                    if until == stuck {
                        bus.make_room();
                    }
                    self.give_up(until);
                }
            }
        }
        // Nobody may be left to be waited for but the slave without a node-ID.
        let until = last + self.timeout;
        while !self.unconfigured
            && let Some(news) = bus.receive(until)?
        {
            if let News::Came(frame) = news {
                self.came(&frame);
            }
        }
        Ok(())
    }

    /// The time in which an answer must come begins when the request has left.
    fn was_sent(&mut self, frame: &Frame, at: Instant) {
        if let Some((Service::SdoRequest, Some(node))) = frame.standard_id().and_then(identify)
            && let Some(conversation) = self.open.get_mut(&node)
        {
            conversation.deadline = at + self.timeout;
        }
    }

    fn came(&mut self, frame: &Frame) {
        match frame.standard_id().and_then(identify) {
            Some((Service::LssResponse, _)) => {
                let response = lss::Response::parse(frame);
                self.unconfigured |= response == Ok(lss::Response::IdentifyNonConfigured);
            }
            Some((Service::SdoResponse, Some(node))) if !frame.is_remote() => {
                self.answered(node, frame.bytes());
            }
            _ => {}
        }
    }

    fn answered(&mut self, node: NodeId, data: &[u8]) {
        let Some(conversation) = self.open.get_mut(&node) else {
            return;
        };
        let requests = conversation.questions.hear(data);
        if !requests.is_empty() {
            conversation.deadline = Instant::NEVER;
        }
        let frames = requests.into_iter().map(|it| request(node, it));
        self.to_send.extend(frames);
        if conversation.questions.is_over() {
            self.close(node);
        }
    }

    fn give_up(&mut self, now: Instant) {
        let open = self.open.iter();
        let late = open.filter(|(_, conversation)| conversation.deadline <= now);
        let late: Vec<NodeId> = late.map(|(node, _)| *node).collect();
        for node in late {
            if let Some(conversation) = self.open.get_mut(&node)
                && let Some(abort) = conversation.questions.give_up()
            {
                self.to_send.push_back(request(node, abort));
            }
            self.close(node);
        }
    }

    fn close(&mut self, node: NodeId) {
        let closed = self.open.remove(&node);
        if let Some(answers) = closed.and_then(|it| it.questions.into_answers()) {
            self.answers.insert(node, answers);
        }
    }
}

fn request(node: NodeId, request: Request) -> Frame {
    let id = cob_id(Service::SdoRequest, Some(node));
    Frame::of_eight(id, request.encode())
}
