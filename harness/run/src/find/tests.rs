//! What is found in a small dictionary.

#![allow(clippy::unwrap_used)]

use fieldproof_dictionary::registers::RegisterMap;
use std::collections::BTreeSet;

use fieldproof_dictionary::{Dictionary, eds};
use fieldproof_suite::device::DeviceDescription;
use fieldproof_suite::{Columns, SourceFile, load, load_device, load_registers};

use super::{Known, fill, spread};

const EDS: &str = "[DeviceInfo]
[1000]
ParameterName=Device type
ObjectType=7
DataType=7
AccessType=ro
DefaultValue=0x192
[1017]
ParameterName=Heartbeat
ObjectType=7
DataType=6
AccessType=rw
DefaultValue=0
HighLimit=1000
[1018]
ParameterName=Identity
ObjectType=9
SubNumber=2
[1018sub0]
ParameterName=Number
ObjectType=7
DataType=5
AccessType=const
DefaultValue=2
[1018sub2]
ParameterName=Product
ObjectType=7
DataType=7
AccessType=ro
[1800]
ParameterName=TPDO
ObjectType=9
SubNumber=2
[1800sub0]
ParameterName=Number
ObjectType=7
DataType=5
AccessType=ro
DefaultValue=1
[1800sub1]
ParameterName=COB-ID
ObjectType=7
DataType=7
AccessType=rw
DefaultValue=$NODEID+0x180
[1A00]
ParameterName=Mapping
ObjectType=9
SubNumber=2
[1A00sub0]
ParameterName=Number
ObjectType=7
DataType=5
AccessType=rw
DefaultValue=1
[1A00sub1]
ParameterName=First
ObjectType=7
DataType=7
AccessType=rw
DefaultValue=0x60000010
[2000]
ParameterName=Angle
ObjectType=7
DataType=3
AccessType=rww
DefaultValue=0xFFFE
LowLimit=-10
HighLimit=32767
PDOMapping=1
[2001]
ParameterName=Long
ObjectType=7
DataType=0x13
AccessType=rw
DefaultValue=1
LowLimit=0
HighLimit=0x100
";

fn dictionary() -> Dictionary {
    eds::read(EDS).dictionary
}

fn file(text: &str) -> SourceFile {
    SourceFile {
        path: "a.yaml".to_owned(),
        text: text.to_owned(),
    }
}

fn device() -> DeviceDescription {
    let text = "language: 1
device: a
title: A
ports: {can: {can: 125 kbit/s}, serial: {serial: 9600}}
canopen: {node: 5, eds: a.eds}
modbus: {address: 1, functions: [3, 6, 8/0, 0x2B/0x0E]}
features: []
";
    load_device(&file(text)).unwrap()
}

fn registers() -> RegisterMap {
    let text = "language: 1
registers: a
title: A
holding:
  holes: refused
  ranges:
    - {address: 4, count: 3, name: word, access: rw, low: 0, high: 65535, effect: writes}
    - {address: 7, name: speed, type: i16, access: rw, low: -5, high: 5, default: -1, persists: false, effect: [writes, moves]}
    - {address: 8, name: angle, type: u32, access: rw, high: 5, effect: writes}
    - {address: 11, name: state, access: r, bits: {0: on}}
    - {address: 12, name: trigger, access: w, high: 1}
input:
  holes: unknown
  ranges: [{address: 7, name: voltage, access: r, codes: {0: none}}]
coils:
  holes: refused
  ranges: [{address: 65535, name: lamp, access: rw, default: 1, effect: writes}]
";
    load_registers(&file(text)).unwrap()
}

/// The ids and titles of the cases that a table with `query` makes.
fn cases(head: &str, title: &str) -> Vec<String> {
    let text = format!(
        "language: 1\nsuite: s\ntitle: S\nprotocol: canopen\nsources: {{a: {{document: A}}}}\ncases:\n  \
         - case: c\n    title: \"{title}\"\n    cite: a\n    {head}\n    steps:\n      - sdo-read: {{object: \"1000:00\", as: u32}}\n"
    );
    let loaded = load(&[SourceFile {
        path: "s.yaml".into(),
        text,
    }]);
    assert_eq!(loaded.diagnostics, []);
    let known = Known {
        dictionary: Some(&dictionary()),
        registers: Some(&registers()),
        bit_rates_kbit_per_s: Some(&BTreeSet::from([20, 100, 125, 1000])),
    };
    let suite = fill(&loaded.suites[0], &device(), known);
    let environment = fieldproof_suite::Environment::default();
    suite
        .cases()
        .map(|case| match case.absent() {
            Some(absent) => format!("{}: {absent}", case.id()),
            None => format!("{} {}", case.id(), case.lower(&environment).unwrap().title),
        })
        .collect()
}

#[test]
fn each_object_is_a_case() {
    assert_eq!(
        cases(
            "each: {o: {index: 1000-1FFF, access: readable, sub: 0}}",
            "{o-name} {o-type} {o-size} {o-mapping}"
        ),
        [
            "s/c[o=1000:00] Device type u32 4 0x10000020",
            "s/c[o=1017:00] Heartbeat u16 2 0x10170010",
            "s/c[o=1018:00] Number u8 1 0x10180008",
            "s/c[o=1800:00] Number u8 1 0x18000008",
            "s/c[o=1A00:00] Number u8 1 0x1A000008",
        ]
    );
}

#[test]
fn the_first_is_chosen_beside_a_table() {
    assert_eq!(
        cases(
            "choose: {t: {access: rw, has: above}, u: {type: i16, has: [default, low, below]}}\n    each: [{n: 1}, {n: 2}]",
            "{n} {t} {t-above} {u} {u-default} {u-low} {u-below}"
        ),
        [
            "s/c[n=1] 1 1017:00 1001 2000:00 -2 -10 -11",
            "s/c[n=2] 2 1017:00 1001 2000:00 -2 -10 -11",
        ]
    );
}

#[test]
fn what_is_not_there_is_said() {
    assert_eq!(
        cases(
            "each: {o: {access: wo, type: [u8, u16], index: 1000-1FFF}}",
            "{o}"
        ),
        ["s/c: the device has no object that is wo, of type u8 or u16, at 1000h to 1FFFh"]
    );
    // The highest value of the type has none above it, and one without limits neither.
    assert_eq!(
        cases("choose: {o: {index: [1000, 2000], has: above}}", "{o}"),
        ["s/c: the device has no object with a value above its highest, at 1000h or 2000h"]
    );
}

#[test]
fn numbers_without_a_word_are_bytes() {
    assert_eq!(
        cases(
            "choose: {o: {type: i48, has: [default, above, below]}}",
            "{o-default}/{o-above}/{o-below}"
        ),
        ["s/c 01 00 00 00 00 00/01 01 00 00 00 00/FF FF FF FF FF FF"]
    );
}

#[test]
fn mappable_by_direction() {
    assert_eq!(
        cases("each: {o: {pdo: rpdo}}", "{o}"),
        ["s/c[o=2000:00] 2000:00"]
    );
    assert_eq!(
        cases("each: {o: {pdo: tpdo}}", "{o}"),
        ["s/c: the device has no object that a TPDO may carry"]
    );
    assert_eq!(
        cases("each: {o: {pdo: no, index: 2000-2FFF}}", "{o}"),
        ["s/c[o=2001:00] 2001:00"]
    );
}

#[test]
fn pdos_have_parameters() {
    assert_eq!(
        cases(
            "choose: {p: {is: tpdo}}",
            "{p} {p-communication} {p-mapping} {p-identifier} {p-length}"
        ),
        ["s/c 1 1800 1A00 185 2"]
    );
    assert_eq!(
        cases("choose: {p: {is: rpdo}}", "{p}"),
        ["s/c: the device has no RPDO"]
    );
}

#[test]
fn the_gaps_are_between_and_beside() {
    assert_eq!(
        cases(
            "each: {o: {is: absent-sub-index, index: [1017, 1018]}}",
            "{o-sub}"
        ),
        ["s/c[o=1017:01] 1", "s/c[o=1018:01] 1", "s/c[o=1018:03] 3"]
    );
    assert_eq!(
        cases(
            "each: {o: {is: absent-object, index: 1000-1018}}",
            "{o-index}"
        ),
        [
            "s/c[o=1001:00] 0x1001",
            "s/c[o=100B:00] 0x100B",
            "s/c[o=1016:00] 0x1016"
        ]
    );
    let alone = "each: {o: {is: absent-object, index: [1017, 1F80]}}";
    assert_eq!(cases(alone, "{o-index}"), ["s/c[o=1F80:00] 0x1F80"]);
    assert_eq!(
        cases(
            "each: {o: {is: absent-object, index: 1280-12FF}}",
            "{o-index}"
        ),
        ["s/c[o=1280:00] 0x1280", "s/c[o=12FF:00] 0x12FF"]
    );
}

#[test]
fn a_few_are_spread_over_all() {
    let all: Vec<Columns> = (0..10).map(|it: u8| vec![("", it.to_string())]).collect();
    let of = |most| {
        let taken = spread(all.clone(), most);
        taken
            .iter()
            .map(|columns| columns[0].1.clone())
            .collect::<String>()
    };
    assert_eq!(
        (of(1), of(2), of(4), of(10), of(99)),
        (
            "0".into(),
            "09".into(),
            "0369".into(),
            "0123456789".into(),
            "0123456789".into()
        )
    );
}

#[test]
fn registers_are_found_by_table_effect_and_limits() {
    assert_eq!(
        cases(
            "each: {r: {is: register, table: holding, access: rw, effect: writes, type: u16, has: [low, high]}}",
            "{r-name} {r-low} {r-high} {r-count} {r-last}"
        ),
        [
            "s/c[r=4] word 0 0 65535 1 4",
            "s/c[r=5] word 1 0 65535 1 5",
            "s/c[r=6] word 2 0 65535 1 6",
        ]
    );
    assert_eq!(
        cases(
            "choose: {r: {is: register, has: [below, above, low, high, default], effect: [writes, moves], persists: false}}",
            "{r} {r-type} {r-low} {r-high} {r-below} {r-above} {r-default} {r-access} {r-table}"
        ),
        ["s/c 7 i16 65531 5 65530 6 65535 rw holding"]
    );
    assert_eq!(
        cases("each: {r: {is: register, has: bits}}", "{r-name}"),
        ["s/c[r=11] state"]
    );
    assert_eq!(
        cases(
            "each: {r: {is: register, has: codes, table: [input, coils]}}",
            "{r-name}"
        ),
        ["s/c[r=7] voltage"]
    );
    assert_eq!(
        cases(
            "choose: {r: {is: register, type: boolean, has: default}}",
            "{r} {r-table} {r-default}"
        ),
        ["s/c 65535 coils 1"]
    );
    // What is not known is not done, whatever is permitted.
    assert_eq!(
        cases(
            "choose: {r: {is: register, access: wo, effect: [writes, persists, readdresses, moves, resets]}}",
            "{r}"
        ),
        [
            "s/c: the device has no register that is wo, that is known to do nothing but writes or persists or readdresses or moves or resets"
        ]
    );
}

#[test]
fn a_row_has_no_gap() {
    assert_eq!(
        cases(
            "each: {r: {is: register, access: readable, row: 2, table: holding}}",
            "{r-count} {r-last}"
        ),
        [
            "s/c[r=4] 2 5",
            "s/c[r=5] 2 6",
            "s/c[r=6] 2 7",
            "s/c[r=7] 3 9",
        ]
    );
    assert_eq!(
        cases("choose: {r: {is: register, row: 2, table: coils}}", "{r}"),
        ["s/c: the device has no register in the table coils, in a row of 2"]
    );
}

#[test]
fn holes_are_those_that_are_said_to_be_refused() {
    assert_eq!(
        cases(
            "each: {h: {is: hole, table: [holding, input]}}",
            "{h} {h-table}"
        ),
        [
            "s/c[h=3] 3 holding",
            "s/c[h=10] 10 holding",
            "s/c[h=13] 13 holding"
        ]
    );
    assert_eq!(
        cases("each: {h: {is: hole, table: coils}}", "{h}"),
        ["s/c[h=65534] 65534"]
    );
    assert_eq!(
        cases("each: {h: {is: hole, table: input}}", "{h}"),
        ["s/c: the device has no address that is said to be refused in the table input"]
    );
}

#[test]
fn functions_are_claimed_or_not() {
    assert_eq!(
        cases("each: {f: {is: function, claimed: true}}", "{f:u8be}"),
        ["s/c[f=3] 03", "s/c[f=6] 06", "s/c[f=8] 08", "s/c[f=43] 2B"]
    );
    assert_eq!(
        cases(
            "each: {f: {is: function, claimed: false, at-most: 3}}",
            "{f}"
        ),
        ["s/c[f=1] 1", "s/c[f=66] 66", "s/c[f=127] 127"]
    );
}

#[test]
fn bit_rates_are_those_of_the_eds_that_lss_can_name() {
    assert_eq!(
        cases("each: {r: {is: bit-rate}}", "{r}, {r-index}, {r-before}"),
        [
            "s/c[r=1000kbit_s] 1000 kbit/s, 0, 125 kbit/s",
            "s/c[r=125kbit_s] 125 kbit/s, 4, 125 kbit/s",
            "s/c[r=20kbit_s] 20 kbit/s, 7, 125 kbit/s",
        ]
    );
    assert_eq!(
        cases("each: {r: {is: other-bit-rate}}", "{r-index}"),
        ["s/c[r=1000kbit_s] 0", "s/c[r=20kbit_s] 7"]
    );
}
