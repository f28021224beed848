//! How busy a CAN bus was.

use fieldproof_record::FrameEvent;

/// The time of a run is cut into at most so many slices.
const SLICES: usize = 240;
const FIRST_WIDTH_NS: u64 = 1_000_000;

/// The bits of each slice of time. As the run goes on, slices are joined two by two.
#[derive(Debug)]
pub(super) struct BusLoad {
    pub(super) bits_per_second: u64,
    pub(super) width_ns: u64,
    pub(super) bits: Vec<u64>,
    pub(super) frames: u64,
}

impl BusLoad {
    /// For a port that is set as `line` says; `None` if that is no CAN port.
    pub(super) fn new(line: &str) -> Option<BusLoad> {
        let (number, unit) = line.split_once(' ')?;
        let factor = match unit {
            "kbit/s" => 1_000,
            "Mbit/s" => 1_000_000,
            _ => return None,
        };
        Some(BusLoad {
            bits_per_second: number.parse::<u64>().ok()?.checked_mul(factor)?,
            width_ns: FIRST_WIDTH_NS,
            bits: Vec::new(),
            frames: 0,
        })
    }

    pub(super) fn frame(&mut self, frame: &FrameEvent) {
        self.frames += 1;
        let slice = loop {
            match usize::try_from(frame.at_ns / self.width_ns) {
                Ok(slice) if slice < SLICES => break slice,
                _ => self.join(),
            }
        };
        if self.bits.len() <= slice {
            self.bits.resize(slice + 1, 0);
        }
        self.bits[slice] += bits(frame);
    }

    fn join(&mut self) {
        self.bits = self.bits.chunks(2).map(|two| two.iter().sum()).collect();
        self.width_ns = self.width_ns.saturating_mul(2);
    }

    /// The load of each slice, 1 for a bus that is never idle.
    pub(super) fn loads(&self) -> impl Iterator<Item = f64> {
        let possible = self.bits_per_second as f64 * self.width_ns as f64 / 1e9;
        let bits = self.bits.iter();
        bits.map(move |bits| (*bits as f64 / possible).min(1.0))
    }
}

/// The bits of a frame with the space after it, stuff bits left out.
fn bits(frame: &FrameEvent) -> u64 {
    let head = if frame.extended { 67 } else { 47 };
    let data = if frame.remote {
        0
    } else {
        u64::from(frame.len.min(8))
    };
    head + 8 * data
}

#[cfg(test)]
mod tests {
    use fieldproof_record::Direction;

    use super::*;

    fn frame(at_ns: u64) -> FrameEvent {
        FrameEvent {
            at_ns,
            port: 0,
            direction: Direction::Sent,
            id: 1,
            extended: false,
            remote: false,
            len: 8,
            data: [0; 8],
            decoded: None,
        }
    }

    #[test]
    fn nine_frames_in_ten_milliseconds_are_a_tenth_of_a_bus() {
        let mut load = BusLoad::new("100 kbit/s").unwrap();
        (0..9).for_each(|n| load.frame(&frame(n * 1_000_000)));
        let loads: Vec<f64> = load.loads().collect();
        assert_eq!(loads.len(), 9);
        assert!(loads.iter().all(|load| (load - 1.0).abs() < 1e-9));
        // 111 bits a frame are more than 1 ms has at 100 kbit/s; over a long time it is next to nothing.
        load.frame(&frame(3_600_000_000_000));
        assert!(load.bits.len() <= SLICES);
        assert_eq!(load.bits.iter().sum::<u64>(), 10 * 111);
    }

    #[test]
    fn serial_port_has_no_bus_load() {
        assert!(BusLoad::new("9600 8N1").is_none());
        assert!(BusLoad::new("off").is_none());
        assert_eq!(BusLoad::new("1 Mbit/s").unwrap().bits_per_second, 1_000_000);
    }
}
