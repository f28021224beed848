//! Register maps: what a file says, and those of the devices.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;

use fieldproof_dictionary::registers::{
    Holes, Kind, Register, RegisterMap, Scale, Table, WordOrder, WriteEffect,
};
use fieldproof_dictionary::{Access, eds};
use fieldproof_suite::{SourceFile, load_registers};

fn read(text: &str) -> RegisterMap {
    let file = SourceFile {
        path: "registers.yaml".to_owned(),
        text: text.to_owned(),
    };
    load_registers(&file).unwrap()
}

macro_rules! fixture {
    ($path:literal) => {
        include_str!(concat!(
            env!("CARGO_MANIFEST_DIR"),
            "/../../fixtures/devices/",
            $path
        ))
    };
}

#[test]
fn a_range_says_everything() {
    let map = read(
        "language: 1\nregisters: a\ntitle: A\nword-order: low-first\nholding:\n  holes: refused\n  ranges:\n\
         \x20   - {address: 145h, name: speed command, type: i16, access: rw, low: -6000, high: 6000, default: 0, unit: rpm, scale: 1/10, persists: false, effect: [moves, persists], codes: {-1: back}, bits: {0: a, 15: b}}\n\
         \x20   - {address: 0x10, count: 2, numbered-from: 7, name: counter, type: u32, access: r}\n\
         \x20   - {address: 0x20, name: gain, type: f32, word-order: high-first, access: rw}\n\
         coils:\n  holes: unknown\n  ranges:\n    - {address: 3, name: lamp, access: rw, default: 1, effect: writes}\n",
    );
    let holding = map.table(Table::Holding).unwrap();
    assert_eq!((holding.holes, holding.len()), (Holes::Refused, 4));
    let speed = holding.register(325).unwrap();
    assert_eq!((speed.low, speed.high), (Some(-6000), Some(6000)));
    assert_eq!((speed.default, speed.kind), (Some(0), Kind::I16));
    assert_eq!(speed.access, Access::ReadWrite);
    assert_eq!(
        (speed.name.as_str(), speed.unit.as_str()),
        ("speed command", "rpm")
    );
    assert_eq!(
        speed.scale,
        Some(Scale {
            multiply: 1,
            divide: 10
        })
    );
    assert_eq!(
        (speed.persists, speed.word_order, speed.line),
        (Some(false), None, 8)
    );
    let effects = BTreeSet::from([WriteEffect::Moves, WriteEffect::Persists]);
    assert_eq!(speed.effects, Some(effects));
    assert_eq!(speed.codes[&-1], "back");
    assert_eq!(speed.bits.keys().collect::<Vec<_>>(), [&0, &15]);
    let counters: Vec<&Register> = holding.registers().take(2).collect();
    let names: Vec<&str> = counters
        .iter()
        .map(|counter| counter.name.as_str())
        .collect();
    assert_eq!(names, ["counter 7", "counter 8"]);
    assert_eq!(
        (counters[1].address, counters[1].highest()),
        (0x12, 0xFFFF_FFFF)
    );
    assert_eq!(counters[1].word_order, Some(WordOrder::LowFirst));
    let gain = holding.containing(0x21).unwrap();
    assert_eq!(
        (gain.word_order, gain.effects.as_ref()),
        (Some(WordOrder::HighFirst), None)
    );
    let lamp = map.table(Table::Coils).unwrap().register(3).unwrap();
    assert_eq!(
        (lamp.kind, lamp.highest(), lamp.default),
        (Kind::Bit, 1, Some(1))
    );
    assert!(map.table(Table::Input).is_none());
}

#[test]
fn what_writing_does_is_not_known_where_nothing_is_said() {
    for effect in ["", ", effect: unknown", ", effect: [writes, unknown]"] {
        let map = read(&format!(
            "language: 1\nregisters: a\ntitle: A\nholding: {{holes: unknown, ranges: [{{address: 0, name: a, access: w{effect}}}]}}\n"
        ));
        let register = map.table(Table::Holding).unwrap().register(0).unwrap();
        assert_eq!(register.effects, None, "{effect}");
    }
}

#[test]
fn encoder() {
    let map = read(fixture!("liaomiao-encoder/registers.yaml"));
    let holding = map.table(Table::Holding).unwrap();
    assert_eq!(holding.len(), 19);
    assert_eq!(map.tables().count(), 1);
    assert!(holding.register(0x000A).is_none());
    let speed = holding.register(4).unwrap();
    assert_eq!(
        (speed.kind, speed.lowest(), speed.highest()),
        (Kind::I16, -15000, 15000)
    );
    assert_eq!(holding.register(1).unwrap().default, Some(32));
    assert_eq!(holding.register(7).unwrap().access, Access::WriteOnly);
    let baud = holding.register(5).unwrap();
    assert_eq!(
        (baud.codes.len(), baud.codes[&11520].as_str()),
        (8, "115200 bit/s")
    );
    let filter = holding.register(14).unwrap();
    assert_eq!(
        filter.codes.keys().copied().collect::<Vec<_>>(),
        Vec::from_iter(0..=10)
    );
    // What the manual hardly shows is never written by a walk.
    let unknown = holding
        .registers()
        .filter(|it| it.access.writable() && it.effects.is_none());
    assert_eq!(
        unknown.map(|it| it.address).collect::<Vec<_>>(),
        [0x12, 0x13, 0x16]
    );
}

#[test]
fn servo() {
    let map = read(fixture!("huacheng-ssts1/registers.yaml"));
    let holding = map.table(Table::Holding).unwrap();
    let speed = holding.register(325).unwrap();
    assert_eq!((speed.low, speed.high), (Some(-6000), Some(6000)));
    assert_eq!(
        (speed.name.as_str(), speed.kind),
        ("internal speed command 1", Kind::I16)
    );
    assert_eq!(holding.containing(321).unwrap().address, 320);
    assert!(holding.containing(322).is_none());
    let long: Vec<&Register> = holding
        .registers()
        .filter(|register| register.kind == Kind::I32)
        .collect();
    assert_eq!(long.len(), 20);
    assert!(long.iter().all(|register| register.word_order.is_none()));
    assert_eq!(holding.register(149).unwrap().name, "alarm 10");
    assert_eq!(
        holding.register(389).unwrap().name,
        "internal torque command 31"
    );
    assert!(
        holding
            .registers()
            .all(|register| (46..=389).contains(&register.address))
    );
}

#[test]
fn inverter_is_what_the_eds_of_its_gateway_says() {
    let map = read(fixture!("teco-inverter/registers.yaml"));
    let holding = map.table(Table::Holding).unwrap();
    assert_eq!(holding.len(), 21);
    let module = eds::read(fixture!("teco-jn5-cm-can/TECO_510_CAN.eds"));
    for register in holding.registers() {
        let sub = u8::try_from(register.address - 0x2500 + 1).unwrap();
        let entry = module.dictionary.entry(0x2025, sub).unwrap();
        let address = register.address;
        assert_eq!(
            entry.access.writable(),
            register.access.writable(),
            "{address:04X}"
        );
        let high = i128::from(register.highest());
        assert_eq!(entry.high_limit.unwrap().value(1), high, "{address:04X}");
    }
}

#[test]
fn families_of_the_inverter() {
    let maps = [
        read(fixture!("teco-inverter/registers.yaml")),
        read(fixture!("teco-inverter/registers-f510.yaml")),
        read(fixture!("teco-inverter/registers-e510.yaml")),
    ];
    let holding = maps
        .each_ref()
        .map(|map| map.table(Table::Holding).unwrap());
    let names = |address: u16| {
        holding.map(|table| {
            let bits = table.register(address).unwrap().bits.values();
            bits.cloned().collect::<Vec<_>>().join(", ")
        })
    };
    let operation = names(0x2501);
    assert!(
        operation[0].ends_with("S6, S7, S8, drive mode"),
        "{operation:?}"
    );
    assert!(operation[1].ends_with("S6, drive mode"), "{operation:?}");
    assert!(
        operation[2].ends_with("S6, relay R1, relay R2"),
        "{operation:?}"
    );
    let state = holding.map(|table| table.register(0x2520).unwrap().bits.len());
    assert_eq!(state, [16, 16, 5]);
    let codes = |address: u16| {
        holding.map(|table| {
            table
                .register(address)
                .map_or(0, |register| register.codes.len())
        })
    };
    assert_eq!(codes(0x2521), [54, 32, 0]);
    let error = |table: usize, code| &holding[table].register(0x2521).unwrap().codes[&code];
    assert_eq!(
        (error(0, 53), error(1, 27)),
        (
            &"Modbus External Fault".to_owned(),
            &"Modbus External Fault".to_owned()
        )
    );
    assert_eq!(codes(0x2528), [51, 53, 0]);
}
