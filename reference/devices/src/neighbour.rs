//! Another node on the bus, which has nothing to do with the device under test.

use std::time::Duration;

use fieldproof_can::{Frame, Id};
use fieldproof_link::{Instant, Line, Outbox, Participant, Reception, Transmission};

/// Its node-ID: none that a suite gives a device.
const NODE: u16 = 92;

/// What it sends, each at its period: a TPDO, a heartbeat of an operational node, an SDO answer to somebody, an EMCY.
const TRAFFIC: [(u16, Duration, &[u8]); 4] = [
    (0x180, Duration::from_millis(10), &[1, 2, 3, 4, 5, 6, 7, 8]),
    (0x700, Duration::from_millis(50), &[0x05]),
    (
        0x580,
        Duration::from_millis(70),
        &[0x43, 0x00, 0x10, 0, 0x92, 0x01, 0x02, 0],
    ),
    (
        0x080,
        Duration::from_millis(200),
        &[0x00, 0x10, 0x01, 0, 0, 0, 0, 0],
    ),
];

/// An operational node 92, busy with others.
#[derive(Debug)]
pub struct Neighbour {
    bit_rate: u32,
    due: [Instant; TRAFFIC.len()],
}

impl Neighbour {
    /// One on a bus of this bit rate.
    pub fn new(bit_rate: u32) -> Neighbour {
        Neighbour {
            bit_rate,
            due: TRAFFIC.map(|(_, period, _)| Instant::START + period),
        }
    }
}

impl Participant for Neighbour {
    fn line(&self, _port: usize) -> Line {
        Line::Can {
            bit_rate: self.bit_rate,
        }
    }

    fn receive(&mut self, _now: Instant, _port: usize, _what: Reception, _out: &mut Outbox) {}

    fn wake_at(&self) -> Option<Instant> {
        self.due.iter().min().copied()
    }

    fn wake(&mut self, now: Instant, out: &mut Outbox) {
        for ((identifier, period, data), due) in TRAFFIC.into_iter().zip(&mut self.due) {
            if *due > now {
                continue;
            }
            *due = *due + period;
            let frame = Id::standard(identifier + NODE).and_then(|id| Frame::data(id, data));
            if let Some(frame) = frame {
                out.send(0, Transmission::Frame(frame));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_sends_its_own_frames_at_their_periods() {
        let mut neighbour = Neighbour::new(500_000);
        let mut sent = Vec::new();
        while let Some(now) = neighbour.wake_at()
            && now <= Instant::START + Duration::from_millis(70)
        {
            let mut out = Outbox::default();
            neighbour.wake(now, &mut out);
            let milliseconds = now.as_nanos() / 1_000_000;
            sent.extend(out.drain().map(|(_, what)| match what {
                Transmission::Frame(frame) => format!("{milliseconds} {frame}"),
                other => unreachable!("{other:?} on CAN"),
            }));
        }
        let others: Vec<&String> = sent.iter().filter(|it| !it.contains("1DC#")).collect();
        assert_eq!(sent.len() - others.len(), 7);
        assert_eq!(others, ["50 75C#05", "70 5DC#4300100092010200"]);
    }
}
