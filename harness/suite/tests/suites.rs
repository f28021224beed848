//! Suites into cases.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::time::Duration;

use fieldproof_suite::device::PortDescription;
use fieldproof_suite::model::{
    CompanionStimulus, Crc, OtherBytes, PauseLength, PowerAction, ReadExpectation, Step, Stimulate,
};
use fieldproof_suite::scalar::{BytePatternText, Bytes, Number, Value};
use fieldproof_suite::{Diagnostic, Environment, Loaded, SourceFile, load, load_device};

const NODE_1: Environment = Environment {
    node: Some(1),
    address: None,
    identity: [None; 4],
};

fn load_text(text: &str) -> Loaded {
    load(&[SourceFile {
        path: "suite.yaml".to_owned(),
        text: text.to_owned(),
    }])
}

fn shown(diagnostics: &[Diagnostic]) -> Vec<String> {
    let show = |one: &Diagnostic| {
        format!(
            "{}:{} {} {} | {} | {:?} {:?}",
            one.at.line, one.at.column, one.code, one.message, one.label, one.help, one.also
        )
    };
    diagnostics.iter().map(show).collect()
}

fn suite(cases: &str) -> String {
    format!(
        "language: 1
suite: canopen.sample
title: A sample
protocol: gateway
sources:
  cia301: {{document: CiA 301 4.2.0, section: 7.3.2}}
  manual: {{document: A manual}}
cases:
{cases}"
    )
}

/// The case of a suite with one case.
fn steps(text: &str) -> Vec<Step> {
    let indented: String = text.lines().map(|line| format!("      {line}\n")).collect();
    let text = suite(&format!(
        "  - case: one
    title: One
    cite: cia301
    effects: [writes, resets, disturbs-bus]
    steps:
{indented}"
    ));
    let loaded = load_text(&text);
    assert_eq!(shown(&loaded.diagnostics), Vec::<String>::new(), "{text}");
    let environment = Environment {
        node: Some(0x0A),
        address: Some(0x20),
        ..Environment::default()
    };
    let case = loaded.suites[0].cases().next().unwrap();
    let case = case.lower(&environment).unwrap();
    case.steps.into_iter().map(|step| step.value).collect()
}

#[test]
fn a_table_makes_cases() {
    let loaded = load_text(&suite(
        "  - case: transition
    title: \"{command} moves the node from {from} to {to}\"
    cite: [cia301, {manual: 4.10}]
    key: [from, command]
    each:
      - {from: pre-operational, command: start, to: operational}
      - {from: operational,     command: stop,  to: stopped}
    steps:
      - nmt-enter: \"{from}\"
      - nmt: \"{command}\"
      - expect-state: {is: \"{to}\", within: 100 ms}
",
    ));
    assert_eq!(shown(&loaded.diagnostics), Vec::<String>::new());
    let suite = &loaded.suites[0];
    let ids: Vec<String> = suite.cases().map(|case| case.id()).collect();
    assert_eq!(
        ids,
        [
            "canopen.sample/transition[from=pre-operational,command=start]",
            "canopen.sample/transition[from=operational,command=stop]"
        ]
    );
    let case = suite.cases().nth(1).unwrap();
    assert_eq!(case.written_id(), "canopen.sample/transition");
    assert_eq!(
        suite.line_text(case.at().line).trim_start(),
        "- {from: operational,     command: stop,  to: stopped}"
    );
    let case = case.lower(&NODE_1).unwrap();
    assert_eq!(
        case.title,
        "stop moves the node from operational to stopped"
    );
    assert_eq!(case.cites[0].section.as_deref(), Some("7.3.2"));
    assert_eq!(case.cites[1].section.as_deref(), Some("4.10"));
    assert_eq!(
        suite.line_text(case.steps[1].at.line),
        "      - nmt: \"{command}\""
    );
}

#[test]
fn what_the_tester_plays_is_no_stimulus_that_a_bench_must_offer() {
    let steps = steps(
        "- stimulate: {companion: inverter, power: off}
- stimulate: {companion: inverter, process-value: register 2523, to: 500}
- sdo-read: {object: \"2025:24\", as: u16, expect: 500}",
    );
    let on_inverter = |stimulus| {
        Step::Stimulate(Stimulate::Companion {
            port: "inverter".to_owned(),
            stimulus,
        })
    };
    let off = CompanionStimulus::Power(PowerAction::Off);
    let value = CompanionStimulus::ProcessValue {
        name: "register 2523".to_owned(),
        to: 500,
    };
    assert_eq!(steps[..2], [on_inverter(off), on_inverter(value)]);
}

#[test]
fn the_bench_gives_node_and_address() {
    let steps = steps(
        "- send: \"{600+node}#40.0010.00.{node}000000\"
- expect-silence: {lasting: 50 ms, of: [\"{580+node}\", 701]}
- send-bytes: {bytes: \"{address} 03 00 00\", crc: append}
- sdo-read: {object: \"1014:00\", as: u32, expect: \"{80+node}\"}",
    );
    let Step::Send(send) = &steps[0] else {
        panic!("{steps:?}")
    };
    assert_eq!(send.frame.0, "60A#400010000A000000".parse().unwrap());
    let Step::ExpectSilence(silence) = &steps[1] else {
        panic!("{steps:?}")
    };
    assert_eq!(silence.of, [0x58A, 0x701]);
    assert_eq!(silence.lasting, Duration::from_millis(50));
    let Step::SendBytes(send) = &steps[2] else {
        panic!("{steps:?}")
    };
    assert_eq!(send.bytes, Bytes(vec![0x20, 3, 0, 0]));
    let Step::SdoRead(read) = &steps[3] else {
        panic!("{steps:?}")
    };
    assert_eq!(read.expect, ReadExpectation::Value(Value::Number(0x8A)));
}

#[test]
fn bytes_have_pauses_followers_and_alternatives_and_connections_names() {
    let steps = steps(
        "- connect: one
- send-bytes: {port: one, bytes: \"00 01\", pause: {after: 1, again: true, lasting: 20 ms}}
- expect-bytes: {port: one, bytes: \"?? 01\", or: [silence, \"02\"]}
- disconnect: {name: one, reset: true}
- send-bytes: {bytes: \"{address}\", crc: append, spoil: 2, then: {bytes: 55, crc: append}}",
    );
    let [
        Step::Connect(connect),
        Step::SendBytes(slow),
        Step::ExpectBytes(expect),
        Step::Disconnect(disconnect),
        Step::SendBytes(followed),
    ] = steps.as_slice()
    else {
        panic!("{steps:?}");
    };
    assert_eq!(
        (connect.name.as_str(), disconnect.name.as_str()),
        ("one", "one")
    );
    assert!(disconnect.reset);
    let pause = slow.pause.unwrap();
    assert_eq!((pause.after.get(), pause.again), (1, true));
    assert_eq!(pause.lasting, PauseLength::Time(Duration::from_millis(20)));
    assert_eq!(slow.port.as_deref(), Some("one"));
    let other = OtherBytes::Bytes(BytePatternText("02".parse().unwrap()));
    assert_eq!(expect.or, [OtherBytes::Silence, other]);
    assert_eq!(
        (followed.spoil, followed.bytes.0.as_slice()),
        (Some(2), &[0x20][..])
    );
    let after: Vec<_> = followed
        .then
        .iter()
        .map(|it| (it.bytes.0.clone(), it.crc))
        .collect();
    assert_eq!(after, [(vec![0x55], Crc::Append)]);
}

#[test]
fn a_port_of_modbus_tcp_is_a_port_of_its_own() {
    let load = |ports: &str| {
        let text = format!(
            "language: 1\ndevice: one\ntitle: One\nports: {ports}\nmodbus: {{address: 1}}\nfeatures: [modbus-tcp]\n"
        );
        load_device(&SourceFile {
            path: "device.yaml".to_owned(),
            text,
        })
    };
    let device = load("{tcp: {tcp: 502}}").unwrap();
    assert_eq!(device.ports["tcp"], PortDescription::Tcp { port: 502 });
    let both = load("{serial: {serial: 9600}, tcp: {tcp: 1502}}").unwrap();
    assert_eq!(both.ports.len(), 2);
    for wrong in [
        "{tcp: {tcp: 502, parity: even}}",
        "{tcp: {tcp: 502, serial: 9600}}",
        "{tcp: {serial: 9600}}",
        "{other: {tcp: 502}}",
    ] {
        assert!(load(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn a_saved_value_stands_where_a_value_stands() {
    let steps = steps(
        "- sdo-read: {object: \"1000:00\", as: u32, save: device_type}
- sdo-read: {object: \"1000:00\", as: u32, expect: \"{device_type}\"}
- modbus: {read-holding: {address: 0, count: 1}, expect: {registers: [\"{device_type}\"]}}
- stop-sync:
- sync:",
    );
    let Step::SdoRead(read) = &steps[1] else {
        panic!("{steps:?}")
    };
    let saved = Value::Saved("device_type".to_owned());
    assert_eq!(read.expect, ReadExpectation::Value(saved));
    let Step::Modbus(modbus) = &steps[2] else {
        panic!("{steps:?}")
    };
    let registers = vec![Number::Saved("device_type".to_owned())];
    assert_eq!(
        modbus.expect,
        fieldproof_suite::model::ModbusExpectation::Registers(registers)
    );
    assert_eq!(steps[3], Step::StopSync);
}

#[test]
fn a_mistake_in_one_row_is_shown_there_and_one_in_all_rows_in_the_case() {
    let loaded = load_text(&suite(
        "  - case: rows
    title: Rows
    cite: cia301
    each:
      - {word: start, data: '00'}
      - {word: strat, data: '01'}
    steps:
      - nmt: \"{word}\"
      - send: \"60#{data}\"
      - sdo-read: {object: \"{data}\", as: u8}
      - sdo-raed: {object: \"1000:00\", as: u8}
",
    ));
    let found: Vec<_> = loaded
        .diagnostics
        .iter()
        .map(|one| {
            (
                one.code,
                one.at.line,
                one.also.first().map(|also| also.0.line),
            )
        })
        .collect();
    assert_eq!(
        found,
        [
            ("S015", 14, Some(16)),
            ("S024", 17, Some(13)),
            ("S023", 18, Some(13)),
            ("S013", 19, None),
        ]
    );
    assert!(loaded.suites.is_empty());
}

#[test]
fn tables_that_explode_are_refused() {
    let table = |cell: &str, steps: &str| {
        load_text(&suite(&format!(
            "  - case: bomb
    title: Bomb
    cite: cia301
    each:
      - {{n: 1, cell: {cell}}}
    steps:
{steps}"
        )))
    };
    let long = table(
        &"0".repeat(10_000),
        &format!("      - send: \"{}\"\n", "{cell}".repeat(10_000)),
    );
    assert_eq!(long.diagnostics[0].code, "S006");
    let step = "      - sdo-read: {object: \"1000:00\", as: u32, expect: {one-of: \"{cell}\"}}\n";
    let many = table(&format!("[{}1]", "1,".repeat(10_000)), &step.repeat(200));
    assert!(many.diagnostics.iter().any(|one| one.code == "S006"));
    let text = "x".repeat(10_000);
    let rows = (0..100).map(|number| format!("      - {{n: {number}, text: {text}}}\n"));
    let rows: String = rows.collect();
    let step = "      - sdo-read: {object: \"1000:00\", as: u32, observe: \"{n} {text}\"}\n";
    let all = load_text(&suite(&format!(
        "  - case: bomb\n    title: Bomb\n    cite: cia301\n    each:\n{rows}    steps:\n{}",
        step.repeat(200)
    )));
    assert!(all.diagnostics.iter().any(|one| one.code == "S006"));
}

#[test]
fn what_depends_on_the_bench_is_found_when_the_case_is_asked_for() {
    let text = suite(
        "  - case: high
    title: An identifier near the end
    cite: cia301
    steps:
      - send: \"{780+node}#00\"
      - expect-silence: 10 ms
",
    );
    let loaded = load_text(&text);
    assert_eq!(shown(&loaded.diagnostics), Vec::<String>::new());
    let case = loaded.suites[0].cases().next().unwrap();
    assert!(case.lower(&NODE_1).is_ok());
    let last = Environment {
        node: Some(127),
        address: None,
        ..Environment::default()
    };
    assert!(case.lower(&last).is_ok());
    let none = case.lower(&Environment::default()).unwrap_err();
    assert_eq!((none[0].code, none[0].at.line), ("S034", 13));
}
