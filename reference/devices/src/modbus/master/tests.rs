use fieldproof_link::{Parity, StopBits};
use proptest::prelude::*;

use super::*;
use crate::inverter::InverterRegisters;
use crate::modbus::script::{hex, text};
use crate::modbus::{Behaviour, ModbusSlave};

const LINE: SerialSettings = SerialSettings {
    baud: 19_200,
    parity: Parity::None,
    stop_bits: StopBits::One,
};
const TIMEOUT: Duration = Duration::from_millis(100);

/// A master, what it sent and when, and the clock.
struct Tester {
    master: ModbusMaster,
    sent: Vec<(Instant, String)>,
    now: Instant,
}

impl Tester {
    fn new() -> Tester {
        Tester {
            master: ModbusMaster::new(LINE, TIMEOUT),
            sent: Vec::new(),
            now: Instant::from_nanos(1_000_000),
        }
    }

    /// Wakes the master once, when it asks.
    fn wake(&mut self) {
        let at = self.master.wake_at().unwrap();
        self.now = self.now.max(at);
        if let Some(characters) = self.master.wake(self.now) {
            let bytes: Vec<u8> = characters.iter().map(|character| character.byte).collect();
            self.sent.push((self.now, text(&bytes)));
            self.now = self.now + LINE.character_time() * u32::try_from(bytes.len()).unwrap();
        }
    }

    /// Wakes the master until it has a result.
    fn result(&mut self) -> Result<Reply, Failure> {
        loop {
            if let Some((_, result)) = self.master.take_result() {
                return result;
            }
            self.wake();
        }
    }

    /// Something answers 5 ms after the request.
    fn answer(&mut self, frame: &str) {
        self.now = self.now + Duration::from_millis(5);
        for byte in hex(frame) {
            self.now = self.now + LINE.character_time();
            self.master.receive(self.now, Character::new(byte));
        }
    }

    fn sent(&self) -> Vec<&str> {
        self.sent.iter().map(|(_, frame)| frame.as_str()).collect()
    }
}

/// Asks, lets it send, answers; what comes of it.
fn outcome(ask: fn(&mut ModbusMaster, Instant), answer: &str) -> Result<Reply, Failure> {
    let mut tester = Tester::new();
    ask(&mut tester.master, tester.now);
    tester.wake();
    tester.answer(answer);
    tester.result()
}

fn write_run(master: &mut ModbusMaster, now: Instant) {
    master.write_single(now, 1, 0x2501, 1);
}

fn read_state(master: &mut ModbusMaster, now: Instant) {
    master.read_holding(now, 1, 0x2520, 1);
}

#[test]
fn requests_of_the_gateway() {
    let mut tester = Tester::new();
    tester.master.write_single(tester.now, 1, 0x2501, 1);
    tester.master.write_single(tester.now, 1, 0x2501, 3);
    tester.master.write_single(tester.now, 1, 0x2502, 0x48A4);
    tester.master.read_holding(tester.now, 1, 0x2520, 1);
    tester.master.read_holding(tester.now, 1, 0x2523, 2);
    for _ in 0..5 {
        assert_eq!(tester.result(), Err(Failure::NoAnswer));
    }
    let sent = [
        "01 06 25 01 00 01 12 C6",
        "01 06 25 01 00 03 93 07",
        "01 06 25 02 48 A4 14 BD",
        "01 03 25 20 00 01 8E CC",
        "01 03 25 23 00 02 3E CD",
    ];
    assert_eq!(tester.sent(), sent);
    assert_eq!(tester.master.wake_at(), None);
}

#[test]
fn answers_and_what_they_are_taken_for() {
    let read = |answer| outcome(read_state, answer);
    assert_eq!(read("01 03 02 00 05 78 47"), Ok(Reply::Registers(vec![5])));
    assert_eq!(read("01 83 02 C0 F1"), Err(Failure::Exception(2)));
    for malformed in [
        // Another CRC, another function, another number of registers, a byte count that is not one, too short.
        "01 03 02 00 05 78 48",
        "01 04 02 00 05 79 33",
        "01 03 04 00 05 00 00 EA 32",
        "01 03 01 00 05 88 47",
        "01 03 40 21",
        "01",
    ] {
        assert_eq!(read(malformed), Err(Failure::Malformed), "{malformed}");
    }
    let write = |answer| outcome(write_run, answer);
    assert_eq!(write("01 06 25 01 00 01 12 C6"), Ok(Reply::Written));
    assert_eq!(write("01 86 03 02 61"), Err(Failure::Exception(3)));
    assert_eq!(write("01 06 25 01 00 03 93 07"), Err(Failure::Malformed));
}

#[test]
fn spoilt_answer_is_malformed() {
    let mut tester = Tester::new();
    read_state(&mut tester.master, tester.now);
    tester.wake();
    for byte in hex("01 03 02 00 05 78 47") {
        tester.now = tester.now + LINE.character_time();
        let character = Character {
            byte,
            spoilt: byte == 0x05,
        };
        tester.master.receive(tester.now, character);
    }
    assert_eq!(tester.result(), Err(Failure::Malformed));
}

#[test]
fn another_stations_answer_is_not_the_answer() {
    let mut tester = Tester::new();
    read_state(&mut tester.master, tester.now);
    tester.wake();
    tester.now = tester.now + Duration::from_millis(60);
    tester.answer("20 03 02 00 00 04 43");
    tester.wake();
    tester.answer("01 03 02 00 05 78 47");
    assert_eq!(tester.result(), Ok(Reply::Registers(vec![5])));
}

#[test]
fn silence_ends_in_no_answer_and_the_next_request() {
    let mut tester = Tester::new();
    write_run(&mut tester.master, tester.now);
    read_state(&mut tester.master, tester.now);
    assert_eq!(tester.result(), Err(Failure::NoAnswer));
    tester.answer("01 03 02 00 05 78 47");
    assert_eq!(tester.result(), Ok(Reply::Registers(vec![5])));
    let (first, second) = (tester.sent[0].0, tester.sent[1].0);
    assert_eq!(second.since(first), LINE.character_time() * 8 + TIMEOUT);
}

#[test]
fn answer_that_comes_too_late_is_not_that_to_the_next_request() {
    let mut tester = Tester::new();
    write_run(&mut tester.master, tester.now);
    read_state(&mut tester.master, tester.now);
    tester.wake();
    tester.now = tester.now + TIMEOUT - Duration::from_micros(5_600);
    tester.answer("01");
    let end = tester.now;
    assert_eq!(tester.result(), Err(Failure::NoAnswer));
    tester.wake();
    assert_eq!(tester.sent[1].0.since(end), LINE.silence_3_5());
    tester.answer("01 03 02 00 05 78 47");
    assert_eq!(tester.result(), Ok(Reply::Registers(vec![5])));
}

#[test]
fn line_is_silent_for_3_5_characters_before_a_request() {
    let mut tester = Tester::new();
    write_run(&mut tester.master, tester.now);
    tester.wake();
    tester.answer("01 06 25 01 00 01 12 C6");
    let end = tester.now;
    read_state(&mut tester.master, tester.now);
    assert_eq!(tester.result(), Ok(Reply::Written));
    tester.wake();
    assert_eq!(tester.sent.len(), 2);
    assert!(tester.sent[1].0.since(end) >= LINE.silence_3_5());
}

#[test]
fn results_carry_the_name_of_their_request() {
    let mut tester = Tester::new();
    let first = tester.master.write_single(tester.now, 1, 0x2501, 1);
    let second = tester.master.read_holding(tester.now, 1, 0x2520, 1);
    assert_ne!(first, second);
    let mut named = Vec::new();
    while tester.master.wake_at().is_some() {
        tester.wake();
        named.extend(tester.master.take_result().map(|(id, _)| id));
    }
    assert_eq!(named, [first, second]);
}

#[test]
fn clear_forgets_everything() {
    let mut tester = Tester::new();
    write_run(&mut tester.master, tester.now);
    read_state(&mut tester.master, tester.now);
    tester.wake();
    tester.master.clear();
    assert_eq!(tester.master.wake_at(), None);
    assert_eq!(tester.master.take_result(), None);
}

#[test]
fn master_and_slave_understand_each_other() {
    let mut tester = Tester::new();
    let registers = InverterRegisters::default();
    let mut slave = ModbusSlave::new(registers, Behaviour::CONFORMING, 3);
    tester.master.write_single(tester.now, 1, 0x2501, 1);
    tester.master.read_holding(tester.now, 1, 0x2520, 5);
    tester.master.write_single(tester.now, 1, 0x2502, 40_001);
    let mut results = Vec::new();
    while results.len() < 3 {
        let sent = tester.sent.len();
        tester.wake();
        if tester.sent.len() > sent {
            let (start, frame) = tester.sent[sent].clone();
            for (count, byte) in (1..).zip(hex(&frame)) {
                slave.receive(start + LINE.character_time() * count, Character::new(byte));
            }
        }
        while let Some(at) = slave.wake_at() {
            tester.now = tester.now.max(at);
            for character in slave.wake(tester.now).unwrap_or_default() {
                tester.now = tester.now + LINE.character_time();
                tester.master.receive(tester.now, character);
            }
        }
        results.extend(tester.master.take_result().map(|(_, result)| result));
    }
    let expected = [
        Ok(Reply::Written),
        Ok(Reply::Registers(vec![5, 0, 0, 500, 500])),
        Err(Failure::Exception(3)),
    ];
    assert_eq!(results, expected);
}

proptest! {
    #[test]
    fn any_answer_is_survived(answer in prop::collection::vec(any::<u8>(), 0..300), whole in any::<bool>()) {
        let mut tester = Tester::new();
        read_state(&mut tester.master, tester.now);
        tester.wake();
        let answer = if whole { crc::with_crc(answer, CrcOrder::LowByteFirst) } else { answer };
        tester.answer(&text(&answer));
        let result = tester.result();
        if !whole {
            prop_assert!(!matches!(result, Ok(Reply::Written)));
        }
    }
}
