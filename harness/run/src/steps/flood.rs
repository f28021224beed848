//! `flood`: many frames, drawn by chance.

use fieldproof_can::{Frame, Id};
use fieldproof_link::Origin;
use fieldproof_suite::model::{Flood, IdRange};

use crate::session::{Message, Received};
use crate::stop::Stop;
use crate::tester::Tester;

/// So many frames may wait to leave; a link has room for them.
const MOST_WAITING: u32 = 8;

impl Tester<'_> {
    pub(super) fn flood(&mut self, flood: &Flood) -> Result<(), Stop> {
        let port = self.can_port()?;
        let mut chance = fastrand::Rng::with_seed(flood.seed);
        let mut at = self.session.now();
        for number in 1..=flood.frames {
            let Some(frame) = draw(flood, number, &mut chance) else {
                return Err(Stop::Bench("the flood has a frame that is none".into()));
            };
            match flood.period {
                Some(period) => {
                    self.session.send_frame_at(port, at, frame)?;
                    at = at + period;
                }
                None => self.session.send_frame(port, frame).map(drop)?,
            }
            if number % MOST_WAITING == 0 {
                self.session.settle()?;
            }
        }
        self.session.settle()?;
        let answered = self.session.now() + self.device.timing.sdo_response;
        self.session.collect_until(answered)?;
        self.session.forget(|received| is_answer(flood, received));
        self.history
            .add(format!("a flood of {} frames", flood.frames));
        Ok(())
    }
}

fn is_answer(flood: &Flood, received: &Received) -> bool {
    match &received.message {
        Message::Can(frame) => {
            let fits = flood.answers.iter().any(|answer| answer.0.matches(frame));
            received.origin == Origin::Bus && fits
        }
        Message::Serial { .. } => false,
    }
}

/// The next frame; `None` if there is no such frame, which the loader has seen to. Chance might never come to some values of
/// the first byte, where most services have their command: these have their turns.
fn draw(flood: &Flood, number: u32, chance: &mut fastrand::Rng) -> Option<Frame> {
    let id = draw_id(&flood.ids, chance)?;
    if flood.remote {
        return Frame::remote(id, chance.u8(0..=8));
    }
    let mut bytes = [0_u8; 8];
    bytes.fill_with(|| chance.u8(..));
    bytes[0] = number.to_le_bytes()[0];
    let len = match flood.data.len() {
        0 => chance.usize(0..=8),
        patterns => {
            let pattern = flood.data.get(chance.usize(0..patterns))?;
            for (byte, masked) in bytes.iter_mut().zip(pattern.0.bytes()) {
                *byte = *byte & !masked.mask() | masked.value();
            }
            pattern.0.len()
        }
    };
    Frame::data(id, bytes.get(..len)?)
}

/// Each identifier of each range has the same chance.
fn draw_id(ranges: &[IdRange], chance: &mut fastrand::Rng) -> Option<Id> {
    let all: u32 = ranges.iter().map(|range| range.count()).sum();
    let mut place = chance.u32(0..all.max(1));
    for range in ranges {
        if place < range.count() {
            let raw = range.from + place;
            return match range.extended {
                true => Id::extended(raw),
                false => u16::try_from(raw).ok().and_then(Id::standard),
            };
        }
        place -= range.count();
    }
    None
}
