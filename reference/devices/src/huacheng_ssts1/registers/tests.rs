use fieldproof_dictionary::Access;
use fieldproof_dictionary::registers::Table;

use super::*;
use crate::modbus::script::{Script, register_map};

fn drive(address: u8) -> Script<DriveRegisters> {
    Script::new(DriveRegisters::new(address, LINE), DOCUMENTED)
}

#[test]
fn read_of_the_manual() {
    let mut drive = drive(2);
    let registers = drive.slave.registers_mut();
    registers.set_process_value("P212", 500).unwrap();
    registers.set_process_value("register 00D5", 1_000).unwrap();
    drive.play("02 03 00 D4 00 02 84 00", "02 03 04 01 F4 03 E8 89 83");
}

#[test]
fn writes_of_the_manual() {
    let mut drive = drive(1);
    drive.play("01 06 01 45 03 E8 99 5D", "01 06 01 45 03 E8 99 5D");
    drive.play_body("01 03 01 45 00 02", "01 03 04 03 E8 00 00");
    // The CRC as the manual's text has it, then the right one.
    drive.play("01 10 01 45 00 02 04 03 E8 07 D0 89 EC", "");
    drive.play_body("01 03 01 46 00 01", "01 03 02 00 00");
    drive.play(
        "01 10 01 45 00 02 04 03 E8 07 D0 B9 EC",
        "01 10 01 45 00 02 51 E1",
    );
    drive.play_body("01 03 01 45 00 02", "01 03 04 03 E8 07 D0");
}

#[test]
fn refusal_of_the_manual() {
    let mut drive = drive(1);
    // The CRC as printed, which is that of another frame, then the right one.
    drive.play("01 06 01 45 27 10 99 5D", "");
    drive.play("01 06 01 45 27 10 83 DF", "01 86 02 C3 A1");
    drive.play_body("01 03 01 45 00 01", "01 03 02 00 00");
}

#[test]
fn range_is_signed_and_inclusive() {
    let mut drive = drive(1);
    for (value, accepted) in [
        ("17 70", true),
        ("17 71", false),
        ("E8 90", true),
        ("E8 8F", false),
    ] {
        let write = format!("01 06 01 45 {value}");
        let answer = if accepted {
            write.clone()
        } else {
            "01 86 02".to_owned()
        };
        drive.play_body(&write, &answer);
    }
    drive.play_body("01 03 01 45 00 01", "01 03 02 E8 90");
}

#[test]
fn unknown_and_read_only_registers_are_an_address_problem() {
    let mut drive = drive(1);
    for (request, answer) in [
        ("01 03 00 2D 00 01", "01 83 03"),
        ("01 03 01 86 00 01", "01 83 03"),
        ("01 03 00 D4 00 03", "01 83 03"),
        ("01 06 00 D4 00 01", "01 86 03"),
        ("01 10 01 63 00 02 04 00 00 00 00", "01 90 03"),
    ] {
        drive.play_body(request, answer);
    }
}

#[test]
fn codes_are_the_standard_ones_when_told_so() {
    let registers = DriveRegisters::default();
    let mut drive = Script::new(registers, Behaviour::CONFORMING);
    drive.play_body("01 06 01 45 27 10", "01 86 03");
    drive.play_body("01 03 00 2D 00 01", "01 83 02");
}

#[test]
fn one_bad_value_leaves_all_unwritten() {
    let mut drive = drive(1);
    drive.play_body("01 10 01 45 00 02 04 03 E8 27 10", "01 90 02");
    assert_eq!(drive.slave.registers(), &DriveRegisters::default());
}

#[test]
fn banks_are_whole() {
    let mut drive = drive(1);
    drive.play_body("01 06 01 85 0D AC", "01 06 01 85 0D AC");
    drive.play_body("01 06 01 85 0D AD", "01 86 02");
    drive.play_body("01 06 01 41 FF FF", "01 06 01 41 FF FF");
    for reserved in ["42", "43", "64", "65"] {
        drive.play_body(&format!("01 06 01 {reserved} 00 00"), "01 86 03");
    }
}

#[test]
fn power_loses_what_was_written() {
    let mut registers = DriveRegisters::default();
    registers.write(325, 1_000);
    assert_eq!(registers.state().get("P325").as_deref(), Some("1000"));
    registers.power_on();
    assert_eq!(registers.state(), DriveRegisters::default().state());
    assert_eq!(registers.state().get("P325").as_deref(), Some("0"));
}

#[test]
fn defaults_are_in_range_and_groups_in_order() {
    for group in GROUPS {
        if let Between(low, high) = group.takes {
            assert!((low..=high).contains(&group.default), "{group:?}");
        }
        assert!((46..=389).contains(&group.first) && group.first <= group.last);
    }
    assert!(GROUPS.windows(2).all(|pair| pair[0].last < pair[1].first));
}

#[test]
fn process_values_and_settings_that_do_not_exist() {
    let mut registers = DriveRegisters::default();
    for (name, value) in [("P045", 0), ("P212", 65_536), ("P212", -32_769), ("212", 0)] {
        assert_eq!(registers.set_process_value(name, value), Err(NotOffered));
    }
    assert_eq!(registers.set_address(0), Err(NotOffered));
    assert_eq!(registers.set_baud(0), Err(NotOffered));
    assert_eq!(registers, DriveRegisters::default());
    registers.set_process_value("P221", -1_500).unwrap();
    assert_eq!(registers.read(221, &DOCUMENTED), Ok(0xFA24));
}

/// The drive and its description come from the same manual by two hands.
#[test]
fn drive_is_what_its_description_claims() {
    let registers = DriveRegisters::default();
    let map = register_map("huacheng-ssts1");
    for claimed in map.table(Table::Holding).unwrap().registers() {
        let number = claimed.address;
        for word in 0..claimed.kind.words() {
            let read = registers.read(number + word, &DOCUMENTED);
            assert!(read.is_ok(), "P{number}");
            let writable = registers.check_write(number + word, read.unwrap());
            assert_eq!(
                writable.is_ok(),
                claimed.access == Access::ReadWrite,
                "P{number}"
            );
        }
        if claimed.kind.words() == 2 || claimed.access != Access::ReadWrite {
            continue;
        }
        if let Some(default) = claimed.default {
            let read = registers.read(number, &DOCUMENTED).unwrap();
            assert_eq!(i64::from(read), default, "P{number}");
        }
        for (value, allowed) in [
            (claimed.lowest() - 1, false),
            (claimed.lowest(), true),
            (claimed.highest(), true),
            (claimed.highest() + 1, false),
        ] {
            // What the type cannot hold cannot be written.
            if (claimed.kind.lowest()..=claimed.kind.highest()).contains(&value) {
                let word = u16::try_from(value & 0xFFFF).unwrap();
                let written = registers.check_write(number, word);
                assert_eq!(written.is_ok(), allowed, "P{number} = {value}");
            }
        }
    }
}
