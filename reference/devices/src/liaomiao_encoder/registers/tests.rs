use fieldproof_dictionary::Access;
use fieldproof_dictionary::registers::Table;

use super::*;
use crate::modbus::script::{Script, register_map};
use crate::modbus::{FAULTS, Registers};

fn encoder() -> Script<EncoderRegisters> {
    Script::new(EncoderRegisters::default(), Behaviour::CONFORMING)
}

fn with_fault(name: &str) -> Script<EncoderRegisters> {
    let fault = FAULTS.iter().find(|fault| fault.name == name).unwrap();
    let mut behaviour = crate::Behaviour::default();
    (fault.apply)(&mut behaviour);
    Script::new(EncoderRegisters::default(), behaviour.modbus)
}

/// Process values and what they are set to.
type Measured = &'static [(&'static str, i64)];

/// What is measured, the request, the answer. In the order of the manual's operations.
const READS: &[(Measured, &str, &str)] = &[
    (&[], "20 03 00 00 00 01 82 BB", "20 03 02 0F B4 01 C4"),
    (&[], "20 03 00 01 00 01 D3 7B", "20 03 02 00 20 05 9B"),
    (
        &[("register 0002", 2_256)],
        "20 03 00 02 00 01 23 7B",
        "20 03 02 08 D0 02 1F",
    ),
    (
        &[("register 0003", 0x100B)],
        "20 03 00 03 00 01 72 BB",
        "20 03 02 10 0B 48 44",
    ),
    (
        &[("position", 147_853_323)],
        "20 03 00 02 00 01 23 7B",
        "20 03 02 08 D0 02 1F",
    ),
    (
        &[("position", 147_853_323)],
        "20 03 00 03 00 01 72 BB",
        "20 03 02 10 0B 48 44",
    ),
    (
        &[("register 0004", 3_232)],
        "20 03 00 04 00 01 C3 7A",
        "20 03 02 0C A0 01 3B",
    ),
    (&[], "20 03 00 05 00 01 92 BA", "20 03 02 25 80 1F 73"),
    (&[], "20 03 00 06 00 01 62 BA", "20 03 02 00 00 04 43"),
    (
        &[("register 0008", 1_944)],
        "20 03 00 08 00 01 03 79",
        "20 03 02 07 98 07 D9",
    ),
    (&[], "20 03 00 09 00 01 52 B9", "20 03 02 00 00 04 43"),
    (
        &[("register 000B", 363)],
        "20 03 00 0B 00 01 F3 79",
        "20 03 02 01 6B 44 3C",
    ),
    (
        &[("register 000C", 12)],
        "20 03 00 0C 00 01 42 B8",
        "20 03 02 00 0C 04 46",
    ),
    (
        &[("register 000C", -144)],
        "20 03 00 0C 00 01 42 B8",
        "20 03 02 FF 70 44 57",
    ),
    (
        &[("register 000D", 470)],
        "20 03 00 0D 00 01 13 78",
        "20 03 02 01 D6 84 4D",
    ),
    (
        &[("register 000C", 209), ("register 000D", 2_220)],
        "20 03 00 0C 00 02 02 B9",
        "20 03 04 00 D1 08 AC 9C B5",
    ),
    (
        &[("speed", -362_115)],
        "20 03 00 0C 00 02 02 B9",
        "20 03 04 FF DC F7 BD BC 9E",
    ),
    (
        &[("register 000C", -36), ("register 000D", -2_115)],
        "20 03 00 0C 00 02 02 B9",
        "20 03 04 FF DC F7 BD BC 9E",
    ),
    (&[], "20 03 00 0E 00 01 E3 78", "20 03 02 00 0A 84 44"),
];

#[test]
fn reads_of_the_manual() {
    for (measured, request, answer) in READS {
        let mut encoder = encoder();
        for (name, value) in *measured {
            let registers = encoder.slave.registers_mut();
            registers.set_process_value(name, *value).unwrap();
        }
        encoder.play(request, answer);
    }
}

#[test]
fn every_read_of_the_manual_also_from_one_encoder_that_lives_through_all() {
    let mut encoder = encoder();
    for (measured, request, answer) in READS {
        encoder
            .slave
            .registers_mut()
            .set_process_value("speed", 0)
            .unwrap();
        for (name, value) in *measured {
            let registers = encoder.slave.registers_mut();
            registers.set_process_value(name, *value).unwrap();
        }
        encoder.play(request, answer);
    }
}

#[test]
fn writes_of_the_manual_are_echoed() {
    for request in [
        "20 06 00 06 00 01 AE BA",
        "20 06 00 07 01 6C 3F 07",
        "20 06 00 0E 00 05 2E BB",
        "20 06 00 0F 00 01 7E B8",
        "20 06 00 10 00 10 8F 72",
        "20 06 00 12 00 01 EE BE",
        "20 06 00 13 00 00 7E BE",
        "20 06 00 16 00 01 AF 7F",
        "20 06 00 05 96 00 F0 DA",
    ] {
        encoder().play(request, request);
    }
}

#[test]
fn what_was_written_is_read_back() {
    let mut encoder = encoder();
    for (write, read, value) in [
        ("20 06 00 06 00 01", "20 03 00 06 00 01", "20 03 02 00 01"),
        ("20 06 00 0E 00 05", "20 03 00 0E 00 01", "20 03 02 00 05"),
        ("20 06 00 10 00 08", "20 03 00 10 00 01", "20 03 02 00 08"),
        ("20 06 00 10 00 10", "20 03 00 10 00 01", "20 03 02 00 10"),
        ("20 06 00 07 01 6C", "20 03 00 0B 00 01", "20 03 02 01 6C"),
        ("20 06 00 12 00 01", "20 03 00 02 00 01", "20 03 02 00 01"),
        ("20 06 00 13 12 34", "20 03 00 03 00 01", "20 03 02 12 34"),
    ] {
        encoder.play_body(write, write);
        encoder.play_body(read, value);
    }
    encoder.play("20 06 00 0F 00 01 7E B8", "20 06 00 0F 00 01 7E B8");
    encoder.play("20 03 00 0F 00 01 B2 B8", "20 03 02 00 01 C5 83");
    encoder.play("20 06 00 16 00 01 AF 7F", "20 06 00 16 00 01 AF 7F");
    assert_eq!(
        encoder.slave.registers().state(),
        EncoderRegisters::default().state()
    );
}

#[test]
fn zero_restores_nothing() {
    let mut encoder = encoder();
    encoder.play_body("20 06 00 0E 00 05", "20 06 00 0E 00 05");
    encoder.play_body("20 06 00 16 00 00", "20 06 00 16 00 00");
    encoder.play_body("20 03 00 0E 00 01", "20 03 02 00 05");
}

#[test]
fn preset_of_the_manual_is_one_turn() {
    let mut encoder = encoder();
    encoder.slave.registers_mut().model.position = 0xFFFF_FFFF;
    encoder.play_body("20 06 00 12 00 01", "20 06 00 12 00 01");
    encoder.play_body("20 06 00 13 00 00", "20 06 00 13 00 00");
    assert_eq!(encoder.slave.registers().model.position, 0x0001_0000);
}

#[test]
fn angle_is_set_within_the_turn() {
    let mut encoder = encoder();
    encoder.slave.registers_mut().model.position = 0x08D0_100B;
    encoder.play("20 06 00 07 01 6C 3F 07", "20 06 00 07 01 6C 3F 07");
    assert_eq!(encoder.slave.registers().model.position, 0x08D0_016C);
}

#[test]
fn direction_turns_the_sign_of_the_speed() {
    let mut encoder = encoder();
    let registers = encoder.slave.registers_mut();
    registers.set_process_value("speed", 120_470).unwrap();
    encoder.play_body("20 06 00 06 00 01", "20 06 00 06 00 01");
    encoder.play_body("20 03 00 04 00 01", "20 03 02 FF F4");
    encoder.play_body("20 03 00 0C 00 02", "20 03 04 FF F4 FE 2A");
}

#[test]
fn speed_beyond_a_register_stays_at_its_limit() {
    let mut encoder = encoder();
    let registers = encoder.slave.registers_mut();
    registers
        .set_process_value("speed", -2_000_000_000)
        .unwrap();
    encoder.play_body("20 03 00 04 00 01", "20 03 02 C5 68");
    encoder.play_body("20 03 00 0C 00 01", "20 03 02 80 00");
}

#[test]
fn address_change_is_answered_from_the_new_address() {
    let mut encoder = encoder();
    encoder.play(
        "FF 10 00 01 00 03 06 61 64 64 72 3A 03 75 09",
        "03 10 00 01 00 03 D0 2A",
    );
    encoder.play("20 03 00 01 00 01 D3 7B", "");
    encoder.play_body("03 03 00 01 00 03", "03 03 06 00 03 00 00 00 00");
    encoder.play_body(
        "FF 10 00 01 00 03 06 61 64 64 72 3A 20",
        "20 10 00 01 00 03",
    );
    encoder.play("20 03 00 01 00 01 D3 7B", "20 03 02 00 20 05 9B");
}

#[test]
fn address_change_to_no_slave_address_is_ignored() {
    let mut encoder = encoder();
    for address in ["00", "F8", "FF"] {
        encoder.play_body(
            &format!("FF 10 00 01 00 03 06 61 64 64 72 3A {address}"),
            "",
        );
        assert_eq!(encoder.slave.registers().address(), 0x20);
    }
}

#[test]
fn all_address_is_for_the_address_change_alone() {
    let mut encoder = encoder();
    encoder.play_body("FF 03 00 01 00 01", "");
    encoder.play_body("FF 06 00 0E 00 05", "");
    encoder.play_body("FF 10 00 01 00 03 06 61 64 64 72 3B 03", "");
    encoder.play_body("FF 10 00 01 00 03 06 61 64 64 72 3A 03 00", "");
    assert_eq!(encoder.slave.registers(), &EncoderRegisters::default());
}

#[test]
fn address_written_like_any_register_is_in_effect_after_the_echo() {
    let mut encoder = encoder();
    encoder.play_body("20 06 00 01 00 05", "20 06 00 01 00 05");
    encoder.play_body("05 03 00 01 00 01", "05 03 02 00 05");
    encoder.play_body("05 06 00 01 00 00", "05 86 03");
    encoder.play_body("05 06 00 01 00 F8", "05 86 03");
}

#[test]
fn new_rate_is_in_effect_after_the_echo() {
    for (code, baud) in BAUD_CODES {
        let mut encoder = encoder();
        let [high, low] = code.to_be_bytes();
        let write = format!("20 06 00 05 {high:02X} {low:02X}");
        encoder.play_body(&write, &write);
        assert_eq!(encoder.line(), line(baud));
        encoder.play_body(
            "20 03 00 05 00 01",
            &format!("20 03 02 {high:02X} {low:02X}"),
        );
    }
    assert!(BAUD_CODES.contains(&(0x2D00, 115_200)));
}

#[test]
fn echo_of_a_new_rate_still_goes_out_at_the_old_one() {
    use fieldproof_link::{Character, Instant, Line};
    let mut slave =
        crate::modbus::ModbusSlave::new(EncoderRegisters::default(), Behaviour::CONFORMING, 1);
    for (count, byte) in (1..).zip(b"\x20\x06\x00\x05\x96\x00\xF0\xDA") {
        let end = Instant::START + LINE.character_time() * count;
        slave.receive(end, Character::new(*byte));
    }
    let sent_at = loop {
        let at = slave.wake_at().unwrap();
        if slave.wake(at).is_some() {
            break at;
        }
    };
    // Noise wakes it while the echo is still on its way.
    let noise_end = sent_at + LINE.character_time();
    slave.receive(noise_end, Character::new(0));
    while slave.line() == Line::Serial(LINE) {
        let at = slave.wake_at().unwrap();
        slave.wake(at);
        let old = at < sent_at + LINE.character_time() * 8;
        assert_eq!(slave.line() == Line::Serial(LINE), old);
    }
    assert_eq!(slave.line(), Line::Serial(line(38_400)));
}

#[test]
fn low_latency_answers_sooner() {
    let behaviour = Behaviour {
        processing_jitter: Duration::ZERO,
        ..Behaviour::CONFORMING
    };
    let mut encoder = Script::new(EncoderRegisters::default(), behaviour);
    let usual = encoder.ask("20 03 00 0F 00 01").unwrap().after;
    encoder.play_body("20 06 00 0F 00 01", "20 06 00 0F 00 01");
    let low = encoder.ask("20 03 00 0F 00 01").unwrap().after;
    assert_eq!(usual - low, Duration::from_micros(1_500));
}

#[test]
fn refusals() {
    let mut encoder = encoder();
    for (request, answer) in [
        ("20 03 00 0A 00 01", "20 83 02"),
        ("20 03 00 11 00 01", "20 83 02"),
        ("20 03 00 07 00 01", "20 83 02"),
        ("20 03 00 00 00 08", "20 83 02"),
        ("20 06 00 02 00 01", "20 86 02"),
        ("20 06 00 17 00 01", "20 86 02"),
        ("20 06 00 05 25 81", "20 86 03"),
        ("20 06 00 06 00 02", "20 86 03"),
        ("20 06 00 0E 00 0B", "20 86 03"),
        ("20 06 00 10 00 07", "20 86 03"),
        ("20 06 00 10 00 11", "20 86 03"),
        ("20 10 00 0E 00 02 04 00 05 00 02", "20 90 03"),
        ("20 10 00 01 00 03 06 61 64 64 72 3A 03", "20 90 03"),
        ("20 04 00 00 00 01", "20 84 01"),
    ] {
        encoder.play_body(request, answer);
    }
    assert_eq!(encoder.slave.registers(), &EncoderRegisters::default());
}

#[test]
fn every_register_of_the_manual_and_no_other_exists() {
    let registers = EncoderRegisters::default();
    let exists = |register: &u16| {
        let read = registers.read(*register, &Behaviour::CONFORMING).is_ok();
        read || registers.check_write(*register, 1) != Err(Exception::IllegalDataAddress)
    };
    let existing: Vec<u16> = (0..=u16::MAX).filter(exists).collect();
    let expected: Vec<u16> = (0..=0x0016)
        .filter(|register| ![0x000A, 0x0011, 0x0014, 0x0015].contains(register))
        .collect();
    assert_eq!(existing, expected);
    assert_eq!(existing.len(), 19);
}

#[test]
fn process_values_are_those_that_can_be_measured() {
    let mut registers = EncoderRegisters::default();
    for (name, value) in [
        ("register 0005", 9_600),
        ("register 000A", 0),
        ("register 0002", 65_536),
        ("register 0002", -1),
        ("register", 0),
        ("temperature", 40_000),
        ("position", 1 << 32),
        ("colour", 0),
    ] {
        assert_eq!(registers.set_process_value(name, value), Err(NotOffered));
    }
    assert_eq!(registers, EncoderRegisters::default());
    assert_eq!(registers.set_address(248), Err(NotOffered));
    assert_eq!(registers.set_baud(9_601), Err(NotOffered));
    assert_eq!(registers.set_baud(115_200), Ok(()));
    assert_eq!(registers.serial(), line(115_200));
}

#[test]
fn fault_address_change_not_answered() {
    let mut encoder = with_fault("address-change-not-answered");
    encoder.play("FF 10 00 01 00 03 06 61 64 64 72 3A 03 75 09", "");
    encoder.play_body("03 03 00 01 00 01", "03 03 02 00 03");
}

#[test]
fn fault_address_change_answered_from_old() {
    let mut encoder = with_fault("address-change-answered-from-old");
    encoder.play_body(
        "FF 10 00 01 00 03 06 61 64 64 72 3A 03",
        "20 10 00 01 00 03",
    );
    encoder.play_body("03 03 00 01 00 01", "03 03 02 00 03");
}

#[test]
fn fault_speed_sign_lost() {
    let mut encoder = with_fault("speed-sign-lost");
    let registers = encoder.slave.registers_mut();
    registers.set_process_value("speed", -362_115).unwrap();
    encoder.play_body("20 03 00 04 00 01", "20 03 02 00 24");
    encoder.play_body("20 03 00 0C 00 02", "20 03 04 00 24 08 43");
    let registers = encoder.slave.registers_mut();
    registers.set_process_value("speed", 362_115).unwrap();
    encoder.play_body("20 03 00 0C 00 02", "20 03 04 00 24 08 43");
}

/// The encoder and its description come from the same manual by two hands.
#[test]
fn encoder_is_what_its_description_claims() {
    let registers = EncoderRegisters::default();
    let map = register_map("liaomiao-encoder");
    let holding = map.table(Table::Holding).unwrap();
    assert_eq!(holding.len(), 19);
    for claimed in holding.registers() {
        let register = claimed.address;
        let read = registers.read(register, &Behaviour::CONFORMING);
        assert_eq!(
            read.is_ok(),
            claimed.access != Access::WriteOnly,
            "{register:04X}"
        );
        if let Some(default) = claimed.default {
            assert_eq!(read.map(i64::from), Ok(default), "{register:04X}");
        }
        for value in [claimed.lowest(), claimed.highest()] {
            let word = u16::try_from(value & 0xFFFF).unwrap();
            let written = registers.check_write(register, word);
            if claimed.access == Access::ReadOnly {
                assert_eq!(
                    written,
                    Err(Exception::IllegalDataAddress),
                    "{register:04X}"
                );
            } else if register != SLAVE_ADDRESS {
                assert_eq!(written, Ok(()), "{register:04X} = {value}");
            }
        }
    }
}
