//! A device that is a function: one frame in, frames out after a delay; and a bench around it.

use std::collections::{BTreeMap, VecDeque};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::{
    Arrival, CompanionIndex, Instant, Lane, Line, LinkError, NotOffered, Outbox, Participant,
    PortIndex, PortProperties, Reception, Sent, Stimulus, StimulusError, StimulusKind,
    Transmission, sim,
};
use fieldproof_record::{CaseFinished, Event, Verdict};
use fieldproof_run::{Bench, LaneJob, LaneOutcome, play_lane};
use fieldproof_suite::device::{
    CanopenDescription, Deviation, DeviceDescription, Feature, PortDescription, Timing,
};
use fieldproof_suite::model::{Depth, Effect};
use fieldproof_suite::{SourceFile, load};

const BIT_RATE: u32 = 1_000_000;

/// What a scripted device answers to a frame: each answer with its delay.
pub(crate) type Answers = Vec<(Duration, Frame)>;

/// A device that is a function of the frames it gets. Sees every frame; remembers them for the test.
pub(crate) struct Scripted {
    answer: Box<dyn FnMut(&Frame) -> Answers + Send>,
    pending: VecDeque<(Instant, Frame)>,
    pub(crate) seen: Arc<Mutex<Vec<String>>>,
}

impl Scripted {
    pub(crate) fn new(answer: impl FnMut(&Frame) -> Answers + Send + 'static) -> Scripted {
        Scripted {
            answer: Box::new(answer),
            pending: VecDeque::new(),
            seen: Arc::default(),
        }
    }
}

impl Participant for Scripted {
    fn line(&self, _port: usize) -> Line {
        Line::Can { bit_rate: BIT_RATE }
    }

    fn receive(&mut self, now: Instant, _port: usize, reception: Reception, _out: &mut Outbox) {
        let Reception::Frame(frame) = reception else {
            return;
        };
        self.seen.lock().unwrap().push(frame.to_string());
        for (delay, answer) in (self.answer)(&frame) {
            self.pending.push_back((now + delay, answer));
        }
    }

    fn wake_at(&self) -> Option<Instant> {
        self.pending.front().map(|(at, _)| *at)
    }

    fn wake(&mut self, now: Instant, out: &mut Outbox) {
        while let Some((at, frame)) = self.pending.front().copied() {
            if at > now {
                break;
            }
            self.pending.pop_front();
            out.send(0, Transmission::Frame(frame));
        }
    }

    fn offers(&self) -> Vec<StimulusKind> {
        Vec::new()
    }
}

/// A frame from its notation.
pub(crate) fn frame(text: &str) -> Frame {
    text.parse().unwrap()
}

/// An answer a millisecond later.
pub(crate) fn soon(text: &str) -> (Duration, Frame) {
    (Duration::from_millis(1), frame(text))
}

/// A node with a dictionary in which every object holds 4 bytes: answers every read and write at once.
pub(crate) struct Memory {
    pub(crate) objects: BTreeMap<(u16, u8), [u8; 4]>,
}

impl Memory {
    pub(crate) fn new(objects: &[((u16, u8), [u8; 4])]) -> Memory {
        Memory {
            objects: objects
                .iter()
                .copied()
                .chain([((0x1000, 0), [0; 4])])
                .collect(),
        }
    }

    pub(crate) fn answer(&mut self, request: &Frame) -> Answers {
        let bytes = request.bytes();
        if request.id().raw() != 0x601 || bytes.len() != 8 {
            return Vec::new();
        }
        let key = (u16::from_le_bytes([bytes[1], bytes[2]]), bytes[3]);
        let mut answer = [0, bytes[1], bytes[2], bytes[3], 0, 0, 0, 0];
        match (bytes[0], self.objects.get_mut(&key)) {
            (_, None) => {
                answer[0] = 0x80;
                answer[4..].copy_from_slice(&0x0602_0000_u32.to_le_bytes());
            }
            (0x40, Some(value)) => {
                answer[0] = 0x43;
                answer[4..].copy_from_slice(value);
            }
            (_, Some(value)) => {
                answer[0] = 0x60;
                value.copy_from_slice(&bytes[4..]);
            }
        }
        vec![(
            Duration::from_millis(1),
            Frame::data(frame("581#").id(), &answer).unwrap(),
        )]
    }
}

/// A lane whose instants may be off.
pub(crate) struct Uncertain<L> {
    lane: L,
    ports: Vec<PortProperties>,
}

impl<L: Lane> Uncertain<L> {
    fn new(lane: L, uncertainty: Duration) -> Uncertain<L> {
        let ports = lane
            .ports()
            .iter()
            .map(|p| PortProperties {
                uncertainty,
                ..p.clone()
            })
            .collect();
        Uncertain { lane, ports }
    }
}

impl<L: Lane> Lane for Uncertain<L> {
    fn now(&self) -> Instant {
        self.lane.now()
    }

    fn ports(&self) -> &[PortProperties] {
        &self.ports
    }

    fn send(
        &mut self,
        port: PortIndex,
        at: Instant,
        what: Transmission,
    ) -> Result<Sent, LinkError> {
        self.lane.send(port, at, what)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Arrival>, LinkError> {
        self.lane.receive(until)
    }

    fn set_line(&mut self, port: PortIndex, line: Line) -> Result<(), LinkError> {
        self.lane.set_line(port, line)
    }

    fn offers(&self) -> Vec<StimulusKind> {
        self.lane.offers()
    }

    fn stimulate(&mut self, stimulus: &Stimulus) -> Result<(), StimulusError> {
        self.lane.stimulate(stimulus)
    }

    fn stimulate_companion(
        &mut self,
        port: PortIndex,
        stimulus: &Stimulus,
    ) -> Result<(), NotOffered> {
        self.lane.stimulate_companion(port, stimulus)
    }

    fn attach(&mut self, port: PortIndex, companion: Box<dyn Participant>) -> CompanionIndex {
        self.lane.attach(port, companion)
    }

    fn detach(&mut self, companion: CompanionIndex) {
        self.lane.detach(companion);
    }
}

/// A bench with one device on CAN, node 1, that permits everything.
pub(crate) struct Setup {
    pub(crate) deviates: Vec<Deviation>,
    pub(crate) features: Vec<Feature>,
    pub(crate) permits: Vec<Effect>,
    pub(crate) uncertainty: Duration,
    /// Set as soon as this many events were emitted.
    pub(crate) stop_after: Option<usize>,
}

impl Default for Setup {
    fn default() -> Setup {
        Setup {
            deviates: Vec::new(),
            features: vec![Feature::SdoServer],
            permits: vec![Effect::Writes, Effect::Resets],
            uncertainty: Duration::ZERO,
            stop_after: None,
        }
    }
}

/// What a run gave.
pub(crate) struct Played {
    pub(crate) outcome: LaneOutcome,
    pub(crate) events: Vec<Event>,
}

struct StoppingSink<'a> {
    events: Vec<Event>,
    stop_after: Option<usize>,
    stop: &'a AtomicBool,
}

impl fieldproof_record::Sink for StoppingSink<'_> {
    fn emit(&mut self, event: Event) {
        self.events.push(event);
        if self
            .stop_after
            .is_some_and(|count| self.events.len() >= count)
        {
            self.stop.store(true, Ordering::Relaxed);
        }
    }
}

impl Setup {
    /// Plays the cases of a suite (the part after `cases:`) against a device.
    pub(crate) fn play(self, device: Scripted, cases: &str) -> Played {
        let head = "language: 1\nsuite: test\ntitle: A test\nprotocol: canopen\nsources:\n  book: {document: A book}\ncases:\n";
        let loaded = load(&[SourceFile {
            path: "test.yaml".into(),
            text: format!("{head}{cases}"),
        }]);
        assert!(loaded.diagnostics.is_empty(), "{:#?}", loaded.diagnostics);
        let description = self.description();
        let bench = Bench {
            fixed_rates: Default::default(),
            ports: ["can".to_owned()].into(),
            modbus_tcp: [].into(),
            streams: [].into(),
            stimuli: [].into(),
            permits: self.permits.iter().copied().collect(),
            depth: Depth::Default,
            node: Some(1),
            address: None,
        };
        let mut builder = sim::Builder::new();
        let can = builder.can_bus("can", BIT_RATE);
        builder.device(Box::new(device), &[can]);
        let mut lane = Uncertain::new(builder.build(), self.uncertainty);
        let stop = AtomicBool::new(false);
        let mut sink = StoppingSink {
            events: Vec::new(),
            stop_after: self.stop_after,
            stop: &stop,
        };
        let job = LaneJob {
            tool: "test",
            name: "scripted",
            device: &description,
            dictionary: None,
            bench: &bench,
            suites: &loaded.suites,
            selects: &|_| true,
            strict: false,
            inspects_device: false,
            explains: false,
            fault: None,
            variant: None,
            seed: 0,
        };
        let outcome = play_lane(&job, &mut lane, &mut sink, &stop);
        Played {
            outcome,
            events: sink.events,
        }
    }

    fn description(&self) -> DeviceDescription {
        DeviceDescription {
            language: 1,
            device: "scripted".into(),
            title: "A scripted device".into(),
            sources: BTreeMap::new(),
            identity: fieldproof_suite::identity::Identity::default(),
            ports: [(
                "can".to_owned(),
                PortDescription::Can { bit_rate: BIT_RATE },
            )]
            .into(),
            canopen: Some(CanopenDescription {
                node: 1,
                eds: String::new(),
            }),
            modbus: None,
            features: self.features.clone(),
            timing: Timing {
                sdo_response: Duration::from_millis(50),
                modbus_response: Duration::from_millis(50),
                boot_up: Duration::from_millis(500),
                lss_response: Duration::from_millis(50),
                nmt_transition: Duration::from_millis(10),
            },
            dangers: BTreeMap::new(),
            deviates: self.deviates.clone(),
        }
    }
}

impl Played {
    /// The only case's end.
    pub(crate) fn case(&self) -> &CaseFinished {
        let mut finished = self.events.iter().filter_map(|event| match event {
            Event::CaseFinished(case) => Some(case.as_ref()),
            _ => None,
        });
        let case = finished.next().expect("a case was played");
        assert!(finished.next().is_none(), "only one case was played");
        case
    }

    /// The only case's verdict and what its first failure says.
    pub(crate) fn verdict(&self) -> (Verdict, &str) {
        let case = self.case();
        (
            case.verdict,
            case.failures
                .first()
                .map_or("", |failure| failure.what.as_str()),
        )
    }
}
