use std::time::Duration;

use super::*;
use crate::modbus::script::Script;

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
        let character = fieldproof_link::Character::new(*byte);
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
    assert_eq!(state["register 2520"], "261");
    assert_eq!(state["register 2524"], "500");
    assert_eq!(state.len(), 48);
    let wrong = Stimulus::Power { on: false };
    let refused = inverter.stimulate(now, &wrong, &mut out);
    assert_eq!(refused, Err(NotOffered));
}
