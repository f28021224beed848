use std::time::Duration;

use fieldproof_dictionary::Access;
use fieldproof_dictionary::registers::Table;
use fieldproof_link::sim::Builder;
use fieldproof_link::{Character, Lane};

use super::*;
use crate::modbus::script::{Script, register_map};

fn inverter() -> Script<InverterRegisters> {
    Script::new(InverterRegisters::default(), Behaviour::CONFORMING)
}

#[test]
fn frames_between_gateway_and_inverter() {
    let mut inverter = inverter();
    inverter.play("01 06 25 01 00 01 12 C6", "01 06 25 01 00 01 12 C6");
    inverter.play("01 03 25 20 00 01 8E CC", "01 03 02 00 05 78 47");
    inverter.play("01 06 25 02 48 A4 14 BD", "01 06 25 02 48 A4 14 BD");
    inverter.play_body("01 03 25 23 00 02", "01 03 04 48 A4 48 A4");
    inverter.play("01 06 25 01 00 03 93 07", "01 06 25 01 00 03 93 07");
    inverter.play_body("01 03 25 20 00 01", "01 03 02 00 07");
    inverter.play_body("01 06 25 01 00 00", "01 06 25 01 00 00");
    inverter.play("01 03 25 23 00 02 3E CD", "01 03 04 48 A4 00 00 AC 70");
    inverter.play_body("01 03 25 2F 00 01", "01 03 02 01 2C");
}

#[test]
fn frequency_is_not_put_out_before_it_runs() {
    let mut inverter = inverter();
    inverter.play_body("01 06 25 02 10 04", "01 06 25 02 10 04");
    inverter.play_body("01 03 25 23 00 02", "01 03 04 10 04 00 00");
    inverter.play_body("01 06 25 01 00 01", "01 06 25 01 00 01");
    inverter.play_body("01 03 25 23 00 02", "01 03 04 10 04 10 04");
}

#[test]
fn external_fault_stops_it_until_reset() {
    let mut inverter = inverter();
    inverter.play_body("01 06 25 01 00 05", "01 06 25 01 00 05");
    inverter.play_body("01 03 25 20 00 02", "01 03 04 00 08 00 35");
    inverter.play_body("01 06 25 01 00 01", "01 06 25 01 00 01");
    inverter.play_body(
        "01 03 25 20 00 05",
        "01 03 0A 00 08 00 35 00 00 01 F4 00 00",
    );
    inverter.play_body("01 06 25 01 00 08", "01 06 25 01 00 08");
    inverter.play_body("01 03 25 20 00 02", "01 03 04 00 04 00 00");
}

#[test]
fn refusals() {
    let mut inverter = inverter();
    for (request, answer) in [
        ("01 06 25 20 00 01", "01 86 02"),
        ("01 03 24 FF 00 01", "01 83 02"),
        ("01 03 25 30 00 01", "01 83 02"),
        ("01 03 25 2F 00 02", "01 83 02"),
        ("01 06 25 02 9C 41", "01 86 03"),
        ("01 06 25 02 9C 40", "01 06 25 02 9C 40"),
    ] {
        inverter.play_body(request, answer);
    }
}

#[test]
fn plays_as_a_participant() {
    let mut inverter = Inverter::new(7);
    let mut out = Outbox::default();
    let stimulus = Stimulus::ProcessValue {
        name: "register 2520".to_owned(),
        value: 0x0105,
    };
    inverter
        .stimulate(Instant::START, &stimulus, &mut out)
        .unwrap();
    let mut now = Instant::START;
    for byte in b"\x01\x03\x25\x20\x00\x01\x8E\xCC" {
        now = now + Duration::from_nanos(520_833);
        let character = Character::new(*byte);
        inverter.receive(now, 0, Reception::Character(character), &mut out);
    }
    while let Some(at) = inverter.wake_at() {
        inverter.wake(at, &mut out);
    }
    let sent: Vec<_> = out.drain().collect();
    let expected = Transmission::bytes(b"\x01\x03\x02\x01\x05\x79\xD7");
    assert_eq!(sent, [(0, expected)]);
    assert_eq!(inverter.line(0), Line::Serial(LINE));
    let state = inverter.state();
    assert_eq!(state.get("register 2520").as_deref(), Some("261"));
    assert_eq!(state.get("register 2524").as_deref(), Some("500"));
    assert_eq!(state.into_iter().count(), 49);
    let wrong = Stimulus::Condition {
        name: "rain".to_owned(),
        active: true,
    };
    let refused = inverter.stimulate(now, &wrong, &mut out);
    assert_eq!(refused, Err(NotOffered));
}

/// Sends on a simulated line, long after what was before; the bytes that come back and the silence before them.
fn on_the_line(lane: &mut impl Lane, frame: &[u8]) -> (Vec<u8>, Duration) {
    let port = fieldproof_link::PortIndex(0);
    let at = lane.now() + Duration::from_millis(100);
    let sent = lane.send(port, at, Transmission::bytes(frame)).unwrap();
    let mut bytes = Vec::new();
    let mut silence = Duration::ZERO;
    while let Some(arrival) = lane.receive(sent.end + Duration::from_millis(100)).unwrap() {
        let Reception::Character(Character { byte, spoilt }) = arrival.what else {
            panic!("not a character: {arrival:?}");
        };
        assert!(!spoilt);
        if bytes.is_empty() {
            silence = arrival.at.since(sent.end + LINE.character_time());
        }
        bytes.push(byte);
    }
    (bytes, silence)
}

#[test]
fn plays_on_a_simulated_line() {
    let mut builder = Builder::new();
    let port = builder.serial_line("inverter", LINE);
    builder.device(Box::new(Inverter::new(1)), &[port]);
    let mut lane = builder.build();
    let (answer, silence) = on_the_line(&mut lane, b"\x01\x06\x25\x01\x00\x01\x12\xC6");
    assert_eq!(answer, b"\x01\x06\x25\x01\x00\x01\x12\xC6");
    assert!(silence >= LINE.silence_3_5() && silence < Duration::from_millis(5));
    let (answer, _) = on_the_line(&mut lane, b"\x01\x03\x25\x20\x00\x01\x8E\xCC");
    assert_eq!(answer, b"\x01\x03\x02\x00\x05\x78\x47");
    let (answer, _) = on_the_line(&mut lane, b"\x01\x03\x25\x20\x00\x01\x8E\xCD");
    assert_eq!(answer, b"");
}

/// The inverter and its description come from the same manual by two hands.
#[test]
fn inverter_is_what_its_description_claims() {
    let registers = InverterRegisters::default();
    let map = register_map("teco-inverter");
    for claimed in map.table(Table::Holding).unwrap().registers() {
        let register = claimed.address;
        let read = registers.read(register, &Behaviour::CONFORMING);
        assert!(read.is_ok(), "{register:04X}");
        let highest = u16::try_from(claimed.highest()).unwrap();
        let written = registers.check_write(register, highest).is_ok();
        assert_eq!(
            written,
            claimed.access == Access::ReadWrite,
            "{register:04X}"
        );
        if claimed.access == Access::ReadWrite {
            assert_eq!(read.ok().map(i64::from), claimed.default, "{register:04X}");
            let allowed = highest
                .checked_add(1)
                .map(|value| registers.check_write(register, value));
            assert_ne!(allowed, Some(Ok(())), "{register:04X}");
        }
    }
}

#[test]
fn without_power_it_is_silent_and_afterwards_as_new() {
    let mut inverter = Inverter::new(1);
    let mut out = Outbox::default();
    let mut give = |inverter: &mut Inverter, stimulus| {
        inverter
            .stimulate(Instant::START, &stimulus, &mut out)
            .unwrap();
    };
    let value = Stimulus::ProcessValue {
        name: "register 2505".to_owned(),
        value: 7,
    };
    give(&mut inverter, value);
    give(&mut inverter, Stimulus::Power { on: false });
    assert_eq!(inverter.line(0), Line::Off);
    let mut heard = Outbox::default();
    for byte in b"\x01\x03\x25\x20\x00\x01\x8E\xCC" {
        let character = Reception::Character(Character::new(*byte));
        inverter.receive(Instant::START, 0, character, &mut heard);
    }
    assert_eq!(inverter.wake_at(), None);
    give(&mut inverter, Stimulus::Power { on: true });
    assert_eq!(inverter.line(0), Line::Serial(LINE));
    assert_eq!(inverter.wake_at(), None, "what it did not hear is gone");
    assert_eq!(inverter.registers(), &InverterRegisters::default());
}
