//! The tester's view of a lane while a case is played: what was sent, what came and was not yet expected.

mod connections;

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use fieldproof_can::Frame;
use fieldproof_link::{
    Arrival, Character, Instant, Lane, Line, Origin, PortIndex, Reception, Sent, SerialSettings,
    Transmission,
};
use fieldproof_record::{BusErrorEvent, Direction, Event, FrameEvent, SerialEvent, Sink};

use crate::serial::Assembler;
use crate::stop::Stop;

/// How many of the last frames are kept for the excerpt of a failure.
const TRACE_LENGTH: usize = 48;

/// The longest wait without a look at whether the run is to stop.
const SLICE: Duration = Duration::from_millis(100);

/// Something that came, whole.
#[derive(Debug, Clone)]
pub(crate) struct Received {
    /// The end of its last bit.
    pub(crate) at: Instant,
    /// The start of its first bit; on CAN the same as `at`, for only the end is stamped.
    pub(crate) start: Instant,
    pub(crate) port: PortIndex,
    pub(crate) origin: Origin,
    pub(crate) message: Message,
}

/// A CAN frame, or the bytes of a frame on a serial port.
#[derive(Debug, Clone)]
pub(crate) enum Message {
    Can(Frame),
    Serial { bytes: Vec<u8>, spoilt: bool },
}

/// A frame of the case's traffic, as it goes into the record.
#[derive(Debug, Clone)]
pub(crate) enum Traffic {
    Can(FrameEvent),
    Serial(Box<SerialEvent>),
}

/// A frame that was handed over and has not been told to have left.
#[derive(Debug, Clone, Copy)]
struct Leaving {
    port: PortIndex,
    frame: Frame,
}

/// The tester's view of a lane.
pub(crate) struct Session<'a> {
    lane: &'a mut dyn Lane,
    sink: &'a mut dyn Sink,
    stop: &'a AtomicBool,
    /// Set while a device is put back: then nothing interrupts.
    pub(crate) uninterruptible: bool,
    /// What came since the last send and was not expected yet.
    inbox: VecDeque<Received>,
    assemblers: Vec<Option<Assembler>>,
    trace: VecDeque<Traffic>,
    /// The last transmission, or the last stimulus; what an expectation looks back to.
    last_sent: Sent,
    /// Frames of the tester's that have not been told to have left, oldest first.
    leaving: VecDeque<Leaving>,
    /// Whether [`Session::last_sent`] is when the last of them was handed over.
    last_is_leaving: bool,
    /// The last activity on each port, for the silence before a serial frame.
    last_activity: Vec<Instant>,
    /// The last transaction identifier of Modbus TCP.
    transaction: u16,
    /// Connections that the case has opened, and the port that each leads to.
    connections: Vec<(PortIndex, PortIndex)>,
    /// Connections that the device has ended.
    closed: Vec<PortIndex>,
    /// How many ports there were from the beginning; those behind them are connections that were opened.
    lasting: usize,
}

impl<'a> Session<'a> {
    pub(crate) fn new(
        lane: &'a mut dyn Lane,
        sink: &'a mut dyn Sink,
        stop: &'a AtomicBool,
    ) -> Session<'a> {
        let now = lane.now();
        let assemblers: Vec<Option<Assembler>> = lane
            .ports()
            .iter()
            .map(|port| Assembler::new(port.line, port.has_bit_times()))
            .collect();
        let lasting = assemblers.len();
        let last_activity = vec![now; lasting];
        Session {
            lane,
            sink,
            stop,
            uninterruptible: false,
            inbox: VecDeque::new(),
            assemblers,
            trace: VecDeque::with_capacity(TRACE_LENGTH),
            last_sent: Sent {
                start: now,
                end: now,
            },
            leaving: VecDeque::new(),
            last_is_leaving: false,
            last_activity,
            transaction: 0,
            connections: Vec::new(),
            closed: Vec::new(),
            lasting,
        }
    }

    pub(crate) fn now(&self) -> Instant {
        self.lane.now()
    }

    pub(crate) fn lane(&mut self) -> &mut dyn Lane {
        self.lane
    }

    pub(crate) fn port(&self, role: &str) -> Option<PortIndex> {
        let ports = self.lane.ports();
        let is_called = |port: &PortIndex| ports.get(port.0).is_some_and(|it| it.name == role);
        let connections = self.connections.iter().map(|(port, _)| *port);
        let lasting = (0..self.lasting).map(PortIndex);
        connections.chain(lasting).find(is_called)
    }

    pub(crate) fn port_name(&self, port: PortIndex) -> &str {
        self.lane
            .ports()
            .get(port.0)
            .map_or("?", |port| port.name.as_str())
    }

    pub(crate) fn uncertainty(&self, port: PortIndex) -> Duration {
        self.lane
            .ports()
            .get(port.0)
            .map_or(Duration::ZERO, |port| port.uncertainty)
    }

    /// How the tester is set on a port.
    pub(crate) fn line(&self, port: PortIndex) -> Line {
        self.lane
            .ports()
            .get(port.0)
            .map_or(Line::Off, |port| port.line)
    }

    pub(crate) fn serial_settings(&self, port: PortIndex) -> Option<SerialSettings> {
        self.assemblers
            .get(port.0)?
            .as_ref()
            .and_then(Assembler::settings)
    }

    /// The next transaction identifier of Modbus TCP.
    pub(crate) fn next_transaction(&mut self) -> u16 {
        self.transaction = self.transaction.wrapping_add(1);
        self.transaction
    }

    /// The least silence between two frames on a serial port, if it says something of whoever kept it.
    pub(crate) fn least_silence(&self, port: PortIndex) -> Option<Duration> {
        let properties = self.lane.ports().get(port.0)?;
        let settings = self.serial_settings(port)?;
        properties.has_bit_times().then(|| settings.silence_3_5())
    }

    pub(crate) fn emit(&mut self, event: Event) {
        self.sink.emit(event);
    }

    pub(crate) fn last_sent(&self) -> Sent {
        self.last_sent
    }

    pub(crate) fn trace(&self) -> impl Iterator<Item = &Traffic> {
        self.trace.iter()
    }

    /// Forgets the case before: its frames are not this case's.
    pub(crate) fn begin_case(&mut self) {
        self.inbox.clear();
        self.trace.clear();
        self.mark_sent();
    }

    /// From now on expectations look back to this instant and no further.
    pub(crate) fn mark_sent(&mut self) {
        let now = self.lane.now();
        self.note_sent(Sent {
            start: now,
            end: now,
        });
    }

    fn note_sent(&mut self, sent: Sent) {
        self.last_sent = sent;
        self.last_is_leaving = false;
    }

    /// Sends a frame at once.
    pub(crate) fn send_frame(&mut self, port: PortIndex, frame: Frame) -> Result<Sent, Stop> {
        self.send_frame_at(port, self.lane.now(), frame)
    }

    /// Sends a frame at an instant.
    pub(crate) fn send_frame_at(
        &mut self,
        port: PortIndex,
        at: Instant,
        frame: Frame,
    ) -> Result<Sent, Stop> {
        let sent = self.lane.send(port, at, Transmission::Frame(frame))?;
        if self.tells_departure(port) {
            self.note_sent(sent);
            self.leaving.push_back(Leaving { port, frame });
            self.last_is_leaving = true;
        } else {
            self.take_earlier(sent.end)?;
            self.note_sent(sent);
            self.record_frame(sent.end, port, Direction::Sent, frame);
        }
        Ok(sent)
    }

    fn tells_departure(&self, port: PortIndex) -> bool {
        let port = self.lane.ports().get(port.0);
        port.is_some_and(|port| port.tells_departure)
    }

    /// Waits until everything that was sent has left, so that it stands in the record.
    pub(crate) fn settle(&mut self) -> Result<(), Stop> {
        while !self.leaving.is_empty() {
            let until = self.lane.now() + SLICE;
            if let Some(arrival) = self.lane.receive(until)?
                && let Some(received) = self.arrived(arrival)
            {
                self.inbox.push_back(received);
            }
        }
        Ok(())
    }

    /// The oldest frame that was handed over left at `at`. If that is what expectations look back to, they may all be
    /// met as much later as is given back.
    fn departed(&mut self, at: Instant) -> Duration {
        let Some(Leaving { port, frame }) = self.leaving.pop_front() else {
            return Duration::ZERO;
        };
        self.record_frame(at, port, Direction::Sent, frame);
        if !self.last_is_leaving || !self.leaving.is_empty() {
            return Duration::ZERO;
        }
        let handed_over = self.last_sent.end;
        self.note_sent(Sent { start: at, end: at });
        at.since(handed_over)
    }

    /// Sends bytes without a gap, after the silence that ends whatever was on the line before.
    pub(crate) fn send_bytes(&mut self, port: PortIndex, bytes: &[u8]) -> Result<Sent, Stop> {
        let characters = bytes.iter().copied().map(Character::new).collect();
        self.send_characters(port, characters, None)
    }

    /// Sends characters without a gap: `after` the end of those before them, or else after the silence that ends whatever
    /// was on the line.
    pub(crate) fn send_characters(
        &mut self,
        port: PortIndex,
        characters: Vec<Character>,
        after: Option<Duration>,
    ) -> Result<Sent, Stop> {
        let silence = self
            .serial_settings(port)
            .map_or(Duration::ZERO, SerialSettings::silence_3_5);
        let quiet_since = self
            .last_activity
            .get(port.0)
            .copied()
            .unwrap_or(Instant::START);
        let at = match after {
            Some(pause) => self.last_sent.end + pause,
            None => self.lane.now().max(quiet_since + silence),
        };
        let bytes = characters.iter().map(|it| it.byte).collect();
        let spoilt = characters.iter().any(|it| it.spoilt);
        let sent = self
            .lane
            .send(port, at, Transmission::Characters(characters))?;
        self.take_earlier(sent.end)?;
        self.note_sent(sent);
        self.note_activity(port, sent.end);
        self.record_serial(SerialEvent {
            at_ns: sent.end.as_nanos(),
            start_ns: sent.start.as_nanos(),
            port: self.recorded_port(port),
            direction: Direction::Sent,
            bytes,
            spoilt,
            decoded: None,
        });
        Ok(sent)
    }

    /// What came since the last send and nothing expected, oldest first; the inbox is empty afterwards.
    pub(crate) fn take_unexpected(&mut self) -> VecDeque<Received> {
        std::mem::take(&mut self.inbox)
    }

    /// Forgets what came and was not expected yet, where `which` says so.
    pub(crate) fn forget(&mut self, which: impl Fn(&Received) -> bool) {
        self.inbox.retain(|received| !which(received));
    }

    /// The first thing since the last send that `wanted` accepts, now or until `deadline`. What it does not accept
    /// stays for later expectations.
    pub(crate) fn first(
        &mut self,
        mut deadline: Instant,
        mut wanted: impl FnMut(&Received) -> bool,
    ) -> Result<Option<Received>, Stop> {
        let since = self.last_sent.end;
        let is_there = |received: &Received| received.at > since && wanted(received);
        if let Some(index) = self.inbox.iter().position(is_there) {
            return Ok(self.inbox.remove(index));
        }
        while let Some(received) = self.next(&mut deadline)? {
            // What comes before the last transmission has left is no answer to it.
            let is_later = !self.is_leaving() && received.at > self.last_sent.end;
            if is_later && wanted(&received) {
                return Ok(Some(received));
            }
            self.inbox.push_back(received);
        }
        Ok(None)
    }

    fn is_leaving(&self) -> bool {
        self.last_is_leaving && !self.leaving.is_empty()
    }

    /// Whether something like this has come since the last send and was not expected yet; it stays where it is.
    pub(crate) fn has_come(&self, wanted: impl Fn(&Received) -> bool) -> bool {
        self.inbox
            .iter()
            .any(|received| received.at > self.last_sent.end && wanted(received))
    }

    /// The first of the things that have come since the last send, and were not expected, that `look` makes something of.
    pub(crate) fn look_for<T>(&self, look: impl Fn(&Received) -> Option<T>) -> Option<T> {
        let later = |received: &&Received| received.at > self.last_sent.end;
        self.inbox.iter().filter(later).find_map(look)
    }

    /// Whether the device has ended the connection.
    pub(crate) fn is_closed(&self, port: PortIndex) -> bool {
        self.closed.contains(&port)
    }

    /// How many of the things that have come and were not expected are like this.
    pub(crate) fn count(&self, wanted: impl Fn(&Received) -> bool) -> usize {
        self.inbox
            .iter()
            .filter(|received| wanted(received))
            .count()
    }

    /// Lets time pass until `instant`; what comes is kept.
    pub(crate) fn collect_until(&mut self, mut instant: Instant) -> Result<(), Stop> {
        while let Some(received) = self.next(&mut instant)? {
            self.inbox.push_back(received);
        }
        Ok(())
    }

    /// Takes what came while something was being sent, so that the record stays in the order of time.
    fn take_earlier(&mut self, sent: Instant) -> Result<(), Stop> {
        while let Some(arrival) = self.lane.receive(sent)? {
            if let Some(received) = self.arrived(arrival) {
                self.inbox.push_back(received);
            }
        }
        Ok(())
    }

    /// The next whole thing that comes on any port, not later than `deadline`. A serial frame that has begun by then
    /// is waited for.
    fn next(&mut self, deadline: &mut Instant) -> Result<Option<Received>, Stop> {
        let mut is_over = false;
        loop {
            if !self.uninterruptible && self.stop.load(Ordering::Relaxed) {
                return Err(Stop::Interrupted);
            }
            let until = match self.earliest_frame_end() {
                None if is_over => return Ok(None),
                None => *deadline,
                Some(frame_ends) if is_over => frame_ends,
                Some(frame_ends) => frame_ends.min(*deadline),
            };
            let until = until.min(self.lane.now() + SLICE);
            let received = match self.lane.receive(until)? {
                Some(arrival) if arrival.origin == Origin::Tester => {
                    *deadline = *deadline + self.departed(arrival.at);
                    None
                }
                Some(arrival) => self.arrived(arrival),
                None => {
                    is_over |= until >= *deadline;
                    self.finish_frames(until)
                }
            };
            match received {
                // It began only after the deadline, while a frame that had begun before was waited for.
                Some(late) if late.start > *deadline => self.inbox.push_back(late),
                Some(received) => return Ok(Some(received)),
                None => {}
            }
        }
    }

    /// Records an arrival; gives it back if it is a whole thing or completes one.
    fn arrived(&mut self, arrival: Arrival) -> Option<Received> {
        if arrival.origin == Origin::Tester {
            self.departed(arrival.at);
            return None;
        }
        match arrival.what {
            Reception::BusError(error) => {
                self.sink.emit(Event::BusError(Box::new(BusErrorEvent {
                    at_ns: arrival.at.as_nanos(),
                    port: arrival.port.0 as u8,
                    what: error.to_string(),
                    bus_off: error.is_bus_off(),
                    counters: error.counters(),
                })));
                None
            }
            Reception::Frame(frame) => {
                let direction = direction_of(arrival.origin);
                self.record_frame(arrival.at, arrival.port, direction, frame);
                Some(Received {
                    at: arrival.at,
                    start: arrival.at,
                    port: arrival.port,
                    origin: arrival.origin,
                    message: Message::Can(frame),
                })
            }
            // Whoever still expects something there will miss it.
            Reception::Connected => {
                self.closed.retain(|port| *port != arrival.port);
                None
            }
            Reception::Closed => {
                self.closed.push(arrival.port);
                None
            }
            Reception::Character(character) => {
                self.note_activity(arrival.port, arrival.at);
                let assembler = self.assemblers.get_mut(arrival.port.0)?.as_mut()?;
                let frame = assembler.take(arrival.at, arrival.origin, character)?;
                Some(self.serial_received(arrival.port, frame))
            }
        }
    }

    fn earliest_frame_end(&self) -> Option<Instant> {
        self.assemblers
            .iter()
            .flatten()
            .filter_map(Assembler::ends_at)
            .min()
    }

    fn finish_frames(&mut self, now: Instant) -> Option<Received> {
        for index in 0..self.assemblers.len() {
            let finished = self
                .assemblers
                .get_mut(index)
                .and_then(Option::as_mut)
                .and_then(|a| a.finish(now));
            if let Some(frame) = finished {
                return Some(self.serial_received(PortIndex(index), frame));
            }
        }
        None
    }

    fn serial_received(&mut self, port: PortIndex, frame: crate::serial::SerialFrame) -> Received {
        let direction = direction_of(frame.origin);
        self.record_serial(SerialEvent {
            at_ns: frame.end.as_nanos(),
            start_ns: frame.start.as_nanos(),
            port: self.recorded_port(port),
            direction,
            bytes: frame.bytes.clone(),
            spoilt: frame.spoilt,
            decoded: None,
        });
        Received {
            at: frame.end,
            start: frame.start,
            port,
            origin: frame.origin,
            message: Message::Serial {
                bytes: frame.bytes,
                spoilt: frame.spoilt,
            },
        }
    }

    fn note_activity(&mut self, port: PortIndex, at: Instant) {
        if let Some(last) = self.last_activity.get_mut(port.0) {
            *last = at;
        }
    }

    fn record_frame(&mut self, at: Instant, port: PortIndex, direction: Direction, frame: Frame) {
        let mut data = [0; 8];
        data[..frame.bytes().len()].copy_from_slice(frame.bytes());
        let event = FrameEvent {
            at_ns: at.as_nanos(),
            port: port.0 as u8,
            direction,
            id: frame.id().raw(),
            extended: frame.id().is_extended(),
            remote: frame.is_remote(),
            len: frame.len() as u8,
            data,
            decoded: None,
        };
        self.remember(Traffic::Can(event.clone()));
        self.sink.emit(Event::Frame(event));
    }

    fn record_serial(&mut self, event: SerialEvent) {
        self.remember(Traffic::Serial(Box::new(event.clone())));
        self.sink.emit(Event::Serial(Box::new(event)));
    }

    fn remember(&mut self, traffic: Traffic) {
        if self.trace.len() == TRACE_LENGTH {
            self.trace.pop_front();
        }
        self.trace.push_back(traffic);
    }
}

const fn direction_of(origin: Origin) -> Direction {
    match origin {
        Origin::Bus => Direction::Received,
        Origin::Companion(_) => Direction::Companion,
        Origin::Tester => Direction::Sent,
    }
}
