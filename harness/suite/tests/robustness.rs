//! Whatever stands in a file, it is read or refused.

use fieldproof_suite::{Environment, SourceFile, load, load_device, load_registers};
use proptest::prelude::*;

const SUITE: &str = r##"language: 1
suite: canopen.sample
title: A sample
protocol: gateway
sources:
  cia301: {document: CiA 301 4.2.0, section: 7.3.2}
cases:
  - case: one
    title: "{command} {node}"
    cite: [cia301, {cia301: "7.2"}]
    needs: [sdo-server, stimulus: power]
    effects: [writes, resets]
    written-for: {node: 1}
    key: [command]
    each:
      - {command: start, data: "00.{node}", limit: 100 ms ± 5 %, number: 64h}
      - {command: stop, data: "01", limit: 1 s +- 2 ms, number: -5}
    control:
      - sdo-read: {object: "1000:00", as: u32, save: kept}
    steps:
      - nmt: "{command}"
      - send: "{600+node}#40.{data}{number:i16le}"
      - expect: {frame: "581#43??????13D1FFFF", within: 5 ms, decode: {as: i32, scale: 1/50, equals: -12.5}}
      - sdo-read: {object: "1000:00", as: u32, expect: "{kept}"}
      - sdo-write: {object: "1017:00", as: i16, value: "{number}", expect: {abort: [0x06010002]}}
      - expect-heartbeat: {period: "{limit}", state: operational}
      - modbus: {read-holding: {address: 0, count: 1}, expect: {exception: illegal-function}}
      - send-bytes: {bytes: "{address} 03", crc: {flip-bit: 3}}
      - stop-sync:
"##;

fn file(text: String) -> SourceFile {
    SourceFile {
        path: "any.yaml".to_owned(),
        text,
    }
}

/// Reads it every way; what is read without an error must be playable with the environment it was checked for.
fn read(text: String) -> Result<(), TestCaseError> {
    let file = file(text);
    let loaded = load(std::slice::from_ref(&file));
    for diagnostic in &loaded.diagnostics {
        prop_assert!(!diagnostic.message.is_empty());
        prop_assert!(diagnostic.at.line as usize <= file.text.lines().count() + 1);
        prop_assert!(diagnostic.at.end_column >= diagnostic.at.column);
    }
    for suite in &loaded.suites {
        for case in suite.cases() {
            prop_assert!(case.id().starts_with(&case.written_id()));
            prop_assert!(!suite.line_text(case.at().line).is_empty());
            for node in [1, 127] {
                let environment = Environment {
                    node: Some(node),
                    address: Some(node),
                    ..Environment::default()
                };
                // Another node-ID may push an identifier out of its range.
                prop_assert!(case.lower(&environment).is_ok() || node > 1);
            }
        }
    }
    let _ = load_device(&file);
    Ok(())
}

#[test]
fn the_sample_itself_is_right() {
    let loaded = load(&[file(SUITE.to_owned())]);
    assert_eq!(loaded.diagnostics, []);
    assert_eq!(loaded.suites.len(), 1);
}

const REGISTERS: &str = "language: 1
registers: sample
title: A sample
word-order: high-first
holding:
  holes: unknown
  ranges:
    - {address: 65530, count: 3, name: a, type: i32, access: rw, low: -5, high: 5, default: 0, effect: writes}
    - {address: 0, count: 65530, name: b, access: r, codes: {0: off, 0x10: on}, bits: {0: a, 15: b}}
coils:
  holes: refused
  ranges:
    - {address: 65535, name: c, access: w, default: 1, persists: true, effect: [moves, unknown]}
";

/// What is read without an error keeps its promises.
fn read_registers(text: String) -> Result<(), TestCaseError> {
    let map = match load_registers(&file(text)) {
        Ok(map) => map,
        Err(diagnostics) => {
            prop_assert!(!diagnostics.is_empty());
            return Ok(());
        }
    };
    for (_, table) in map.tables() {
        let mut next = 0_u32;
        for register in table.registers() {
            prop_assert!(u32::from(register.address) >= next);
            next = u32::from(register.address) + u32::from(register.kind.words());
            prop_assert!(next <= 0x1_0000 && register.lowest() <= register.highest());
            let range = register.lowest()..=register.highest();
            prop_assert!(
                register
                    .default
                    .is_none_or(|default| range.contains(&default))
            );
        }
    }
    Ok(())
}

#[test]
fn too_many_registers_of_the_sample_are_refused() {
    let refused = load_registers(&file(REGISTERS.to_owned())).unwrap_err();
    let codes: Vec<&str> = refused.iter().map(|one| one.code).collect();
    assert_eq!(codes, ["S022"]);
    read_registers(REGISTERS.replace("65530, name: b", "10000, name: b")).unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn any_text_is_read_or_refused(text in "\\PC{0,200}|[\\[\\]{}:,#&*!|>'\"%@` \n\t\r-]{0,80}") {
        read(text)?;
    }

    #[test]
    fn a_damaged_suite_is_read_or_refused(
        cuts in proptest::collection::vec((0..SUITE.len(), 0..12usize, "[ -~\n]{0,6}|\\PC{0,2}"), 1..4)
    ) {
        let mut text: Vec<char> = SUITE.chars().collect();
        for (at, length, put) in cuts {
            let start = at.min(text.len());
            let end = (start + length).min(text.len());
            text.splice(start..end, put.chars());
        }
        read(text.into_iter().collect())?;
    }

    #[test]
    fn a_damaged_register_map_is_read_or_refused(
        cuts in proptest::collection::vec((0..REGISTERS.len(), 0..8usize, "[0-9a-z:, ]{0,4}|\\PC{0,2}"), 1..3)
    ) {
        let mut text: Vec<char> = REGISTERS.replace("65530, name: b", "10000, name: b").chars().collect();
        for (at, length, put) in cuts {
            let start = at.min(text.len());
            let end = (start + length).min(text.len());
            text.splice(start..end, put.chars());
        }
        read_registers(text.into_iter().collect())?;
    }

    #[test]
    fn lines_in_any_order_are_read_or_refused(
        picks in proptest::collection::vec(0..SUITE.lines().count(), 0..40)
    ) {
        let lines: Vec<&str> = SUITE.lines().collect();
        let text: String = picks.iter().map(|pick| format!("{}\n", lines[*pick])).collect();
        read(text)?;
    }

    #[test]
    fn any_value_of_any_key_is_read_or_refused(
        line in 0..SUITE.lines().count(),
        value in "[ -~]{0,20}|\\{[a-z+:0-9]{0,8}\\}|\\[[a-z, ]{0,8}\\]|-?[0-9]{1,25}( ms| s)?",
    ) {
        let lines = SUITE.lines().enumerate().map(|(number, text)| match text.split_once(": ") {
            Some((key, _)) if number == line => format!("{key}: {value}\n"),
            _ => format!("{text}\n"),
        });
        read(lines.collect())?;
    }
}
