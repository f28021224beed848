use fieldproof_dictionary::Access;
use fieldproof_dictionary::registers::{Holes, Register, Table};

use super::tables::{ADDRESS, CompleteRegisters};
use crate::modbus::script::{Script, register_map, text};
use crate::modbus::{Behaviour, Registers};

fn slave() -> Script<CompleteRegisters> {
    Script::new(CompleteRegisters::new(ADDRESS), Behaviour::CONFORMING)
}

/// Plays requests and answers, both without CRC; an empty answer is silence.
fn play(slave: &mut Script<CompleteRegisters>, script: &[(&str, &str)]) {
    for (request, answer) in script {
        slave.play_body(request, answer);
    }
}

#[test]
fn bits() {
    let mut slave = slave();
    play(
        &mut slave,
        &[
            ("01 02 00 00 00 0A", "01 02 02 49 02"),
            ("01 02 00 01 00 01", "01 02 01 00"),
            ("01 05 00 0A FF 00", "01 05 00 0A FF 00"),
            ("01 01 00 08 00 03", "01 01 01 04"),
            ("01 05 00 0A 00 00", "01 05 00 0A 00 00"),
            ("01 0F 00 13 00 0A 02 CD 01", "01 0F 00 13 00 0A"),
            ("01 01 00 13 00 0A", "01 01 02 CD 01"),
            ("01 01 FF F8 00 08", "01 01 01 00"),
            // Neither on nor off; no coil; too many; none; beyond the last; counts that lie.
            ("01 05 00 0A 00 01", "01 85 03"),
            ("01 05 08 00 FF 00", "01 85 02"),
            ("01 01 00 00 07 D1", "01 81 03"),
            ("01 01 00 00 00 00", "01 81 03"),
            ("01 01 FF F8 00 09", "01 81 02"),
            ("01 02 07 FF 00 02", "01 82 02"),
            ("01 0F 00 13 00 0A 01 CD", "01 8F 03"),
            ("01 0F 00 13 00 08 02 CD 01", "01 8F 03"),
            ("01 0F 07 FF 00 02 01 03", "01 8F 02"),
            ("01 01 07 FF 00 01", "01 01 01 00"),
        ],
    );
    let most = slave.ask("01 01 00 00 07 D0").unwrap();
    assert_eq!(most.bytes.len(), 3 + 250 + 2);
    let ones = "FF ".repeat(246);
    slave.play_body(&format!("01 0F 00 00 07 B0 F6 {ones}"), "01 0F 00 00 07 B0");
    slave.play_body(&format!("01 0F 00 00 07 B1 F7 {ones} 01"), "01 8F 03");
}

#[test]
fn registers() {
    play(
        &mut slave(),
        &[
            ("01 04 00 05 00 02", "01 04 04 05 FA 06 F9"),
            ("01 04 01 00 00 01", "01 84 02"),
            ("01 06 00 C8 00 65", "01 86 03"),
            ("01 06 00 C8 00 64", "01 06 00 C8 00 64"),
            ("01 06 00 C9 FE 0C", "01 06 00 C9 FE 0C"),
            ("01 06 00 C9 FE 0B", "01 86 03"),
            ("01 06 00 D2 00 00", "01 86 02"),
            ("01 06 00 D3 00 07", "01 06 00 D3 00 07"),
            ("01 03 00 D3 00 01", "01 83 02"),
            (
                "01 10 FF FC 00 04 08 00 01 00 02 00 03 00 04",
                "01 10 FF FC 00 04",
            ),
            ("01 03 FF FC 00 04", "01 03 08 00 01 00 02 00 03 00 04"),
            ("01 03 FF FC 00 05", "01 83 02"),
            // One of two is not allowed, so none is written.
            ("01 10 00 C7 00 02 04 00 09 00 65", "01 90 03"),
            ("01 03 00 C7 00 02", "01 03 04 00 00 00 64"),
            ("01 06 00 04 00 12", "01 06 00 04 00 12"),
            ("01 16 00 04 00 F2 00 25", "01 16 00 04 00 F2 00 25"),
            ("01 03 00 04 00 01", "01 03 02 00 17"),
            ("01 16 00 C8 00 00 00 65", "01 96 03"),
            ("01 16 00 D2 FF FF 00 00", "01 96 02"),
            (
                "01 17 00 03 00 03 00 03 00 02 04 00 0A 00 0B",
                "01 17 06 00 0A 00 0B 00 00",
            ),
            ("01 17 00 03 00 7E 00 03 00 01 02 00 0A", "01 97 03"),
            ("01 17 00 03 00 01 00 03 00 7A F4", "01 97 03"),
            ("01 17 00 D3 00 01 00 03 00 01 02 00 0C", "01 97 02"),
            ("01 03 00 03 00 01", "01 03 02 00 0A"),
        ],
    );
}

#[test]
fn diagnostics() {
    let mut slave = slave();
    play(
        &mut slave,
        &[
            ("01 08 00 00 A5 37", "01 08 00 00 A5 37"),
            ("01 08 00 00 A5 37 01 02", "01 08 00 00 A5 37 01 02"),
            ("01 08 00 02 00 00", "01 08 00 02 00 00"),
            ("01 08 00 0A 00 00", "01 08 00 0A 00 00"),
            ("01 08 00 0B 00 00", "01 08 00 0B 00 01"),
            ("02 03 00 00 00 01", ""),
            ("00 06 00 00 00 01", ""),
            ("01 03 FF 00 00 01", "01 83 02"),
            ("01 08 00 0B 00 00", "01 08 00 0B 00 05"),
            ("01 08 00 0E 00 00", "01 08 00 0E 00 05"),
            ("01 08 00 0D 00 00", "01 08 00 0D 00 01"),
            ("01 08 00 0F 00 00", "01 08 00 0F 00 01"),
            ("01 08 00 0C 00 00", "01 08 00 0C 00 00"),
        ],
    );
    slave.play("01 03 00 00 00 01 00 00", "");
    play(
        &mut slave,
        &[
            ("01 08 00 0C 00 00", "01 08 00 0C 00 01"),
            ("01 08 00 03 00 00", "01 88 01"),
            ("01 08 00 0B 00 01", "01 88 03"),
            ("01 08 00", "01 88 03"),
            ("01 07", "01 07 6D"),
            ("01 07 00", "01 87 03"),
            (
                "01 11",
                "01 11 11 4D FF 6D 6F 64 62 75 73 2D 63 6F 6D 70 6C 65 74 65",
            ),
        ],
    );
}

#[test]
fn event_counter_and_log() {
    play(
        &mut slave(),
        &[
            ("01 08 00 01 FF 00", "01 08 00 01 FF 00"),
            // The restart itself was done after the counters began anew.
            ("01 0B", "01 0B 00 00 00 01"),
            ("01 06 00 00 00 01", "01 06 00 00 00 01"),
            ("01 0B", "01 0B 00 00 00 02"),
            ("01 06 00 D2 00 01", "01 86 02"),
            ("01 0B", "01 0B 00 00 00 02"),
            // Received, refused, received, answered and so on; the restart is the oldest.
            (
                "01 0C",
                "01 0C 13 00 00 00 02 00 06 80 40 80 41 80 40 80 40 80 40 80 40 00",
            ),
        ],
    );
}

#[test]
fn listen_only_ends_with_a_restart() {
    let mut slave = slave();
    play(
        &mut slave,
        &[
            ("01 08 00 04 00 00", ""),
            ("01 03 00 00 00 01", ""),
            ("01 06 00 00 00 01", ""),
            ("01 08 00 00 A5 37", ""),
        ],
    );
    assert_eq!(
        slave.slave.state().get("modbus listens only").as_deref(),
        Some("true")
    );
    play(
        &mut slave,
        &[
            ("01 08 00 01 00 00", ""),
            ("01 03 00 00 00 01", "01 03 02 00 00"),
        ],
    );
    assert_eq!(
        slave.slave.state().get("modbus listens only").as_deref(),
        Some("false")
    );
}

#[test]
fn files_and_queues() {
    play(
        &mut slave(),
        &[
            (
                "01 14 0E 06 00 01 00 01 00 02 06 00 02 00 09 00 01",
                "01 14 0A 05 06 10 01 10 02 03 06 20 09",
            ),
            (
                "01 15 0D 06 00 01 00 07 00 03 06 AF 04 BE 10 0D",
                "01 15 0D 06 00 01 00 07 00 03 06 AF 04 BE 10 0D",
            ),
            (
                "01 14 07 06 00 01 00 07 00 03",
                "01 14 08 07 06 06 AF 04 BE 10 0D",
            ),
            // Another kind of reference, no file, beyond its end, too short.
            ("01 14 07 05 00 01 00 01 00 02", "01 94 02"),
            ("01 14 07 06 00 03 00 01 00 02", "01 94 02"),
            ("01 14 07 06 00 01 00 09 00 02", "01 94 02"),
            ("01 14 06 06 00 01 00 01 00", "01 94 03"),
            ("01 15 09 06 00 01 00 0A 00 01 00 00", "01 95 02"),
            ("01 15 0B 06 00 01 00 09 00 01 00 00 00 00", "01 95 03"),
            ("01 18 03 00", "01 18 00 08 00 03 01 B8 01 B9 01 BA"),
            ("01 18 03 01", "01 18 00 02 00 00"),
            ("01 18 03 02", "01 98 03"),
            ("01 18 03 03", "01 98 02"),
        ],
    );
}

#[test]
fn identification() {
    let mut slave = slave();
    play(
        &mut slave,
        &[
            ("01 2B 0E 04 02", "01 2B 0E 04 83 00 00 01 02 03 31 2E 30"),
            ("01 2B 0E 04 07", "01 AB 02"),
            ("01 2B 0E 05 00", "01 AB 03"),
            ("01 2B 0E 00 00", "01 AB 03"),
            ("01 2B 0D 00 00 00 00 00 00", "01 AB 01"),
            ("01 2B", "01 AB 01"),
        ],
    );
    let basic = slave.ask("01 2B 0E 01 00").unwrap().bytes;
    assert_eq!(text(&basic[..8]), "01 2B 0E 01 83 00 00 03");
    let regular = slave.ask("01 2B 0E 02 00").unwrap().bytes;
    assert_eq!(text(&regular[..8]), "01 2B 0E 02 83 00 00 07");
    let first = slave.ask("01 2B 0E 03 00").unwrap().bytes;
    assert_eq!(text(&first[3..8]), "03 83 FF 81 08");
    assert!(first.len() <= 256);
    let second = slave.ask("01 2B 0E 03 81").unwrap().bytes;
    assert_eq!(text(&second[3..8]), "03 83 00 00 02");
}

#[test]
fn conditions_bring_it_to_every_exception() {
    let mut slave = slave();
    for (condition, request, answer) in [
        ("hardware-fault", "01 03 00 00 00 01", "01 83 04"),
        ("long-work", "01 06 00 00 00 01", "01 86 05"),
        ("long-work", "01 03 00 00 00 01", "01 03 02 00 00"),
        ("busy", "01 05 00 00 FF 00", "01 85 06"),
        ("memory-fault", "01 14 07 06 00 01 00 07 00 03", "01 94 08"),
        ("no-path", "01 04 00 00 00 01", "01 84 0A"),
        ("target-silent", "01 04 00 00 00 01", "01 84 0B"),
    ] {
        let registers = slave.slave.registers_mut();
        registers.set_condition(condition, true).unwrap();
        slave.play_body(request, answer);
        // What there is not is no question of conditions.
        slave.play_body("01 63", "01 E3 01");
        let registers = slave.slave.registers_mut();
        registers.set_condition(condition, false).unwrap();
        assert!(registers.set_condition("rain", true).is_err());
    }
    slave.play_body("01 03 00 00 00 01", "01 03 02 00 00");
}

#[test]
fn power_off_loses_what_does_not_persist() {
    let mut registers = CompleteRegisters::new(ADDRESS);
    let fresh = registers.state();
    registers.write(0, 1);
    registers.write(212, 7);
    registers.write_coil(3, true);
    registers.power_on();
    assert_eq!(registers.read(212, &Behaviour::CONFORMING), Ok(7));
    registers.write(212, 0);
    assert_eq!(registers.state(), fresh);
}

/// The slave and its description are of two hands.
#[test]
fn slave_is_what_its_description_claims() {
    let registers = CompleteRegisters::new(ADDRESS);
    let map = register_map("modbus-complete");
    assert_eq!(map.tables().count(), 4);
    for (table, values) in map.tables() {
        assert_eq!(values.holes, Holes::Refused);
        let read = |address: u16| match table {
            Table::Coils => registers.read_coil(address).map(u16::from),
            Table::DiscreteInputs => registers.read_discrete_input(address).map(u16::from),
            Table::Holding => registers.read(address, &Behaviour::CONFORMING),
            Table::Input => registers.read_input(address),
        };
        for address in 0..=u16::MAX {
            let claimed = values.containing(address);
            let readable = claimed.is_some_and(|it| it.access.readable());
            assert_eq!(read(address).is_ok(), readable, "{table:?} {address}");
            if table != Table::Holding {
                continue;
            }
            let writable = claimed.is_some_and(|it| it.access.writable());
            let held = read(address).unwrap_or(0);
            assert_eq!(
                registers.check_write(address, held).is_ok(),
                writable,
                "{address}"
            );
        }
        for claimed in values.registers() {
            if let Some(default) = claimed.default.filter(|_| claimed.kind.words() == 1) {
                let held = read(claimed.address).unwrap();
                assert_eq!(i64::from(held), default, "{}", claimed.name);
            }
            if claimed.access == Access::ReadWrite && table == Table::Holding {
                limits(&registers, claimed);
            }
        }
    }
}

fn limits(registers: &CompleteRegisters, claimed: &Register) {
    let word = |value: i64| u16::try_from(value & 0xFFFF).unwrap();
    for (limit, beyond) in [
        (claimed.low, claimed.lowest() - 1),
        (claimed.high, claimed.highest() + 1),
    ] {
        let Some(limit) = limit else { continue };
        assert!(registers.check_write(claimed.address, word(limit)).is_ok());
        // What the type cannot hold cannot be written.
        if (claimed.kind.lowest()..=claimed.kind.highest()).contains(&beyond) {
            assert!(
                registers
                    .check_write(claimed.address, word(beyond))
                    .is_err()
            );
        }
    }
}
