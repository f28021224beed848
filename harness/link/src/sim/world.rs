//! The discrete-event clock: media and participants, and what happens next among them.

use std::collections::VecDeque;

use super::medium::{Delivery, Medium, Source};
use super::stream::Stream;
use crate::{
    Arrival, CompanionIndex, Farewell, Instant, Line, Origin, Outbox, Participant, PortIndex,
    Reception, Sent, Transmission,
};

/// How often participants may be woken without the clock moving on.
const WAKES_AT_ONE_INSTANT: u32 = 1_000_000;

/// The tester's node on every medium.
pub(super) const TESTER: usize = 0;

/// Participants that ask to be woken now, again and again: the clock cannot move on.
pub(super) struct Hung {
    /// The medium that port 0 of the last one is on.
    pub(super) bus: usize,
}

/// Everything that lives on the clock.
#[derive(Default)]
pub(super) struct World {
    now: Instant,
    buses: Vec<Bus>,
    /// Those with nodes of their own first, then the tester's companions.
    members: Vec<Member>,
    inbox: VecDeque<Arrival>,
    /// What participants send while they are called; empty in between.
    outbox: Outbox,
    outgoing: Outgoing,
    wakes_now: u32,
}

struct Bus {
    medium: Medium,
    /// Who has which node; [`TESTER`] has none.
    owners: Vec<Option<Owner>>,
}

#[derive(Clone, Copy)]
struct Owner {
    member: usize,
    port: usize,
}

struct Member {
    participant: Box<dyn Participant>,
    /// Where its ports are; `None` is nowhere.
    seats: Vec<Option<Seat>>,
    source: Source,
    wake_at: Instant,
}

#[derive(Clone, Copy)]
struct Seat {
    bus: usize,
    node: usize,
}

/// What [`World::send`] waits for.
#[derive(Default)]
struct Outgoing {
    /// Frames or characters still to go.
    left: usize,
    start: Option<Instant>,
}

#[derive(Clone, Copy)]
enum Event {
    End(usize),
    Wake(usize),
    Start(usize),
}

impl World {
    pub(super) fn now(&self) -> Instant {
        self.now
    }

    /// A further medium with the tester's node on it.
    pub(super) fn add_bus(&mut self, mut medium: Medium, line: Line) -> usize {
        medium.join();
        medium.set_line(TESTER, line, self.now);
        let owners = vec![None];
        self.buses.push(Bus { medium, owners });
        self.buses.len() - 1
    }

    /// A further participant with a node of its own on each of `buses`; one that is not there is left out.
    pub(super) fn add_member(
        &mut self,
        participant: Box<dyn Participant>,
        buses: &[usize],
    ) -> usize {
        let member = self.members.len();
        let mut seats = Vec::with_capacity(buses.len());
        for (port, &index) in buses.iter().enumerate() {
            seats.push(self.buses.get_mut(index).map(|bus| {
                bus.owners.push(Some(Owner { member, port }));
                let node = bus.medium.join();
                Seat { bus: index, node }
            }));
        }
        self.seat(participant, seats, Source::Bus);
        member
    }

    /// A further connection of the tester's to a participant, at a further port of that.
    pub(super) fn add_connection(&mut self, member: usize, line: Line) -> usize {
        let bus = self.add_bus(Medium::Stream(Stream::default()), line);
        let port = self.members[member].seats.len();
        self.buses[bus].owners.push(Some(Owner { member, port }));
        let node = self.buses[bus].medium.join();
        self.members[member].seats.push(Some(Seat { bus, node }));
        bus
    }

    /// The participant at the other end is told that there is a connection, if it is on.
    pub(super) fn open_connection(&mut self, bus: usize) {
        if let Medium::Stream(stream) = &mut self.buses[bus].medium {
            stream.open();
        }
        let owner = self.buses[bus].owners.get(1).copied().flatten();
        let Some(Owner { member, port }) = owner else {
            return;
        };
        self.settle(member);
        if self.members[member].participant.line(port) != Line::Off {
            self.call(member, |participant, now, out| {
                participant.receive(now, port, Reception::Connected, out);
            });
        }
    }

    pub(super) fn close_connection(&mut self, bus: usize, how: Farewell) {
        if let Medium::Stream(stream) = &mut self.buses[bus].medium {
            stream.close(how, self.now);
        }
        self.inbox.retain(|arrival| arrival.port.0 != bus);
    }

    pub(super) fn add_companion(
        &mut self,
        companion: CompanionIndex,
        bus: usize,
        participant: Box<dyn Participant>,
    ) {
        let seat = (bus < self.buses.len()).then_some(Seat { bus, node: TESTER });
        self.seat(participant, vec![seat], Source::Companion(companion));
    }

    fn seat(
        &mut self,
        participant: Box<dyn Participant>,
        seats: Vec<Option<Seat>>,
        source: Source,
    ) {
        self.members.push(Member {
            participant,
            seats,
            source,
            wake_at: Instant::NEVER,
        });
        self.settle(self.members.len() - 1);
    }

    pub(super) fn remove_companion(&mut self, companion: CompanionIndex) {
        let source = Source::Companion(companion);
        let Some(index) = self
            .members
            .iter()
            .position(|member| member.source == source)
        else {
            return;
        };
        let member = self.members.remove(index);
        for seat in member.seats.into_iter().flatten() {
            self.buses[seat.bus].medium.withdraw(seat.node, source);
        }
    }

    /// The places of the companions that sit on `bus`.
    pub(super) fn companions_on(&self, bus: usize) -> Vec<usize> {
        let sits = |member: &Member| {
            let mut seats = member.seats.iter().flatten();
            member.source != Source::Bus && seats.any(|seat| seat.bus == bus)
        };
        let places = self.members.iter().enumerate();
        places
            .filter(|(_, member)| sits(member))
            .map(|(place, _)| place)
            .collect()
    }

    pub(super) fn medium(&self, bus: usize) -> Option<&Medium> {
        self.buses.get(bus).map(|bus| &bus.medium)
    }

    pub(super) fn set_tester_line(&mut self, bus: usize, line: Line) {
        self.buses[bus].medium.set_line(TESTER, line, self.now);
    }

    pub(super) fn participant(&self, member: usize) -> Option<&dyn Participant> {
        self.members.get(member).map(|member| &*member.participant)
    }

    /// Calls a participant and takes from it what follows.
    pub(super) fn call<R>(
        &mut self,
        member: usize,
        call: impl FnOnce(&mut dyn Participant, Instant, &mut Outbox) -> R,
    ) -> R {
        let participant = &mut *self.members[member].participant;
        let result = call(participant, self.now, &mut self.outbox);
        self.settle(member);
        result
    }

    /// Asks a participant how it is set and when to wake it, and passes on what it sends.
    fn settle(&mut self, member: usize) {
        let World {
            now,
            buses,
            members,
            outbox,
            ..
        } = self;
        let member = &mut members[member];
        member.wake_at = member.participant.wake_at().unwrap_or(Instant::NEVER);
        if member.source == Source::Bus {
            for (port, seat) in member.seats.iter().enumerate() {
                if let Some(seat) = seat {
                    let line = member.participant.line(port);
                    buses[seat.bus].medium.set_line(seat.node, line, *now);
                }
            }
        }
        for (port, what) in outbox.drain() {
            if let Some(Some(seat)) = member.seats.get(port)
                && member.takes_part()
            {
                let medium = &mut buses[seat.bus].medium;
                medium.push(seat.node, member.source, what, *now);
            }
        }
    }

    /// The next thing that arrived by `until`; moves the clock no further than that.
    pub(super) fn receive(&mut self, until: Instant) -> Result<Option<Arrival>, Hung> {
        loop {
            if let Some(arrival) = self.inbox.front() {
                let in_time = arrival.at <= until;
                return Ok(if in_time {
                    self.inbox.pop_front()
                } else {
                    None
                });
            }
            if !self.step(until)? {
                self.advance(until);
                return Ok(None);
            }
        }
    }

    /// Lets everything happen that happens by `at`.
    pub(super) fn run_to(&mut self, at: Instant) -> Result<(), Hung> {
        while self.step(at)? {}
        self.advance(at);
        Ok(())
    }

    /// Sends from the tester's node and waits until it has left; `None` if it has not even started by `give_up`, and
    /// is taken back.
    pub(super) fn send(
        &mut self,
        bus: usize,
        what: Transmission,
        mut give_up: Instant,
    ) -> Result<Option<Sent>, Hung> {
        let left = match &what {
            Transmission::Frame(_) => 1,
            Transmission::Characters(characters) => characters.len(),
            Transmission::Close => 0,
        };
        self.outgoing = Outgoing { left, start: None };
        self.buses[bus]
            .medium
            .push(TESTER, Source::Tester, what, self.now);
        while self.outgoing.left > 0 {
            if self.step(give_up)? {
                continue;
            }
            self.advance(give_up);
            let medium = &mut self.buses[bus].medium;
            if medium.is_sending(TESTER) {
                give_up = medium.ends_at();
                continue;
            }
            medium.withdraw(TESTER, Source::Tester);
            return Ok(None);
        }
        Ok(Some(Sent {
            start: self.outgoing.start.unwrap_or(self.now),
            end: self.now,
        }))
    }

    fn advance(&mut self, to: Instant) {
        if to > self.now && to != Instant::NEVER {
            self.now = to;
            self.wakes_now = 0;
        }
    }

    /// Lets the next thing happen if it happens by `until`.
    ///
    /// Arbitration at `until` itself is left for later: whoever drives the clock may still join in at that instant.
    fn step(&mut self, until: Instant) -> Result<bool, Hung> {
        let Some((at, event)) = self.next() else {
            return Ok(false);
        };
        if at > until || (at == until && matches!(event, Event::Start(_))) {
            return Ok(false);
        }
        self.advance(at);
        match event {
            Event::End(bus) => {
                if let Some(delivery) = self.buses[bus].medium.end() {
                    self.deliver(bus, delivery);
                }
            }
            Event::Wake(member) => self.wake(member)?,
            Event::Start(bus) => self.buses[bus].medium.start(at),
        }
        Ok(true)
    }

    /// What happens next. At one instant: ends before wakes before starts, so that all who are to send then take part
    /// in the arbitration; and each of them by index.
    fn next(&self) -> Option<(Instant, Event)> {
        let mut at = Instant::NEVER;
        let mut next = None;
        let mut offer = |when: Instant, event: Event| {
            if when < at {
                at = when;
                next = Some((when, event));
            }
        };
        for (index, bus) in self.buses.iter().enumerate() {
            offer(bus.medium.ends_at(), Event::End(index));
        }
        for (index, member) in self.members.iter().enumerate() {
            offer(member.wake_at.max(self.now), Event::Wake(index));
        }
        for (index, bus) in self.buses.iter().enumerate() {
            offer(bus.medium.starts_at(self.now), Event::Start(index));
        }
        next
    }

    fn wake(&mut self, member: usize) -> Result<(), Hung> {
        self.wakes_now += 1;
        if self.wakes_now > WAKES_AT_ONE_INSTANT {
            self.wakes_now = 0;
            let seat = self.members[member].seats.first().copied().flatten();
            return Err(Hung {
                bus: seat.map_or(0, |seat| seat.bus),
            });
        }
        self.call(member, |participant, now, out| participant.wake(now, out));
        Ok(())
    }

    /// Gives what was sent to everybody on the medium who hears it, in the order they joined.
    fn deliver(&mut self, bus: usize, delivery: Delivery) {
        if delivery.node == TESTER {
            self.sent(bus, delivery);
        }
        for node in 0..self.buses[bus].owners.len() {
            if node == delivery.node {
                continue;
            }
            let Some(reception) = self.buses[bus].medium.hears(node, &delivery) else {
                continue;
            };
            match self.buses[bus].owners[node] {
                Some(Owner { member, port }) => self.call(member, |participant, now, out| {
                    participant.receive(now, port, reception, out);
                }),
                None => self.arrive(bus, reception),
            }
        }
    }

    /// Something has left through the tester's node.
    fn sent(&mut self, bus: usize, delivery: Delivery) {
        match delivery.from {
            Source::Tester if delivery.what == Reception::Closed => {}
            Source::Tester => {
                self.outgoing.left = self.outgoing.left.saturating_sub(1);
                self.outgoing.start.get_or_insert(delivery.start);
            }
            Source::Companion(companion) => self.inbox.push_back(Arrival {
                port: PortIndex(bus),
                at: delivery.end,
                origin: Origin::Companion(companion),
                what: delivery.what,
            }),
            Source::Bus => {}
        }
    }

    /// Something has come to the tester's node: for the lane, and for the companions there.
    fn arrive(&mut self, bus: usize, what: Reception) {
        self.inbox.push_back(Arrival {
            port: PortIndex(bus),
            at: self.now,
            origin: Origin::Bus,
            what,
        });
        for member in 0..self.members.len() {
            if self.members[member].listens_at_tester_of(bus) {
                self.call(member, |participant, now, out| {
                    participant.receive(now, 0, what, out);
                });
            }
        }
    }
}

impl Member {
    /// A companion is set as the tester's port is, whatever it says, but it may be off.
    fn takes_part(&self) -> bool {
        self.source == Source::Bus || self.participant.line(0) != Line::Off
    }

    fn listens_at_tester_of(&self, bus: usize) -> bool {
        let at_tester = |seat: Seat| seat.bus == bus && seat.node == TESTER;
        let first = self.seats.first().copied().flatten();
        first.is_some_and(at_tester) && self.takes_part()
    }
}
