//! Object dictionary tables: what a row says, what is refused, and what is found when one is held against an EDS.

use fieldproof_dictionary::eds::manual::{Size, Status, Table, compare};
use fieldproof_dictionary::eds::{self};
use fieldproof_dictionary::{Access, DataType};

const CYCLE: &str = "1006:00 | u32 | rw | 0 | - | cycle # as printed";

#[test]
fn a_row_says_everything() {
    let table = Table::parse(&format!(
        "# head\r\n\r\n{CYCLE}\r\n6040:0A|16 bits|-|-|reserved|control|\r\n"
    ));
    let errors = table.unwrap_err();
    assert_eq!(errors[0].to_string(), "line 4: 7 columns instead of 6");

    let table = Table::parse(&format!("\n{CYCLE}\n6040:0a|16 bits|-|-|reserved|control")).unwrap();
    assert_eq!((table.len(), table.is_empty()), (2, false));
    let cycle = table.row(0x1006, 0).unwrap();
    assert_eq!(
        (cycle.name.as_str(), cycle.line, cycle.status),
        ("cycle", 2, Status::Described)
    );
    assert_eq!(cycle.size, Some(Size::Type(DataType::Unsigned32)));
    assert_eq!(cycle.access, Some(Access::ReadWrite));
    assert_eq!(cycle.default.as_deref(), Some("0"));
    let control = table.row(0x6040, 10).unwrap();
    assert_eq!(control.size, Some(Size::Bits(16)));
    assert_eq!((control.access, &control.default), (None, &None));
    assert_eq!(control.status, Status::Reserved);
}

#[test]
fn every_line_that_is_no_row_is_refused_with_its_line() {
    let rows = [
        (
            "1006 | u32 | rw | 0 | - | n",
            "`1006` is no index and sub-index: 1018:01, in hexadecimal",
        ),
        (
            "1006:0 | u32 | rw | 0 | - | n",
            "`1006:0` is no index and sub-index: 1018:01, in hexadecimal",
        ),
        (
            "+006:01 | u32 | rw | 0 | - | n",
            "`+006:01` is no index and sub-index: 1018:01, in hexadecimal",
        ),
        (
            "1006:01 | U32 | rw | 0 | - | n",
            "`U32` is no type: u8, i16, string, 16 bits, …",
        ),
        (
            "1006:01 | x bits | rw | 0 | - | n",
            "`x bits` is no size: 16 bits",
        ),
        (
            "1006:01 | u32 | RW | 0 | - | n",
            "`RW` is no access: ro, wo, rw, const, -",
        ),
        (
            "1006:01 | u32 | rw | 0 | no | n",
            "`no` is neither unsupported, reserved nor -",
        ),
        (
            "1006:00 | u8 | ro | 0 | - | n",
            "a second row for the entry of line 1",
        ),
    ];
    let text: String = rows.iter().map(|(row, _)| format!("{row}\n")).collect();
    let errors = Table::parse(&format!("{CYCLE}\n{text}")).unwrap_err();
    let shown: Vec<String> = errors.iter().map(ToString::to_string).collect();
    let expected: Vec<String> = rows
        .iter()
        .enumerate()
        .map(|(at, (_, why))| format!("line {}: {why}", at + 2))
        .collect();
    assert_eq!(shown, expected);
}

#[test]
fn every_word_for_a_type_is_known() {
    for (words, types) in [
        ("bool", DataType::Boolean),
        ("i8", DataType::Integer8),
        ("i16", DataType::Integer16),
        ("i24", DataType::Integer24),
        ("i32", DataType::Integer32),
        ("i40", DataType::Integer40),
        ("i48", DataType::Integer48),
        ("i56", DataType::Integer56),
        ("i64", DataType::Integer64),
        ("u8", DataType::Unsigned8),
        ("u16", DataType::Unsigned16),
        ("u24", DataType::Unsigned24),
        ("u32", DataType::Unsigned32),
        ("u40", DataType::Unsigned40),
        ("u48", DataType::Unsigned48),
        ("u56", DataType::Unsigned56),
        ("u64", DataType::Unsigned64),
        ("real32", DataType::Real32),
        ("real64", DataType::Real64),
        ("string", DataType::VisibleString),
        ("octets", DataType::OctetString),
        ("unicode", DataType::UnicodeString),
        ("time", DataType::TimeOfDay),
        ("difference", DataType::TimeDifference),
        ("domain", DataType::Domain),
    ] {
        let table = Table::parse(&format!("2000:00 | {words} | - | - | - | n")).unwrap();
        assert_eq!(table.row(0x2000, 0).unwrap().size, Some(Size::Type(types)));
    }
}

/// A variable 2000h of `code` with `keys`, after four lines.
fn found(keys: &str, row: &str) -> Vec<String> {
    let text = format!(
        "[OptionalObjects]\nSupportedObjects=0\n[ManufacturerObjects]\n[2000]\nParameterName=n\n{keys}"
    );
    let table = Table::parse(&format!("# the manual\n{row}")).unwrap_or_default();
    compare(&eds::read(&text), &table)
        .iter()
        .map(|difference| {
            let finding = &difference.finding;
            format!(
                "{} {} {:?}",
                finding.rule.code, finding.line, difference.row
            )
        })
        .collect()
}

const U16: &str = "DataType=6\nAccessType=rw\nDefaultValue=0x0A\n";

#[test]
fn what_agrees_is_not_reported() {
    for (keys, row) in [
        (U16, "2000:00 | u16 | rw | 10 | - | n"),
        (U16, "2000:00 | 16 bits | - | - | - | n"),
        (
            "DataType=1\nAccessType=rww",
            "2000:00 | 8 bits | rw | - | - | n",
        ),
        (
            "DataType=6\nAccessType=const",
            "2000:00 | u16 | ro | - | - | n",
        ),
        (
            "DataType=3\nAccessType=ro\nDefaultValue=-1",
            "2000:00 | i16 | const | 0xFFFF | - | n",
        ),
        (
            "DataType=8\nAccessType=ro\nDefaultValue=0x3FC00000",
            "2000:00 | real32 | ro | 1.5 | - | n",
        ),
        (
            "DataType=9\nAccessType=ro\nDefaultValue=V10",
            "2000:00 | string | ro | V10 | - | n",
        ),
        (
            "DataType=10\nAccessType=ro\nDefaultValue=0A FF",
            "2000:00 | octets | ro | 0aff | - | n",
        ),
        (
            "DataType=7\nAccessType=ro\nDefaultValue=0x80+$NodeID",
            "2000:00 | u32 | ro | $NODEID+128 | - | n",
        ),
        (
            U16,
            "2000:00 | u16 | rw | 10 | - | n\n2001:00 | u8 | ro | - | reserved | -",
        ),
        (
            U16,
            "2000:00 | u16 | rw | 10 | - | n\n2001:00 | u8 | ro | - | unsupported | -",
        ),
    ] {
        assert_eq!(found(keys, row), [""; 0], "{keys} {row}");
    }
}

#[test]
fn what_differs_is_reported_with_both_places() {
    for (keys, row, expected) in [
        (U16, "2000:00 | i16 | rw | 10 | - | n", "E092 6 Some(2)"),
        (U16, "2000:00 | 32 bits | rw | 10 | - | n", "E092 6 Some(2)"),
        (U16, "2000:00 | u16 | ro | 10 | - | n", "E093 7 Some(2)"),
        (U16, "2000:00 | u16 | wo | 10 | - | n", "E093 7 Some(2)"),
        (U16, "2000:00 | u16 | rw | 0x10 | - | n", "E094 8 Some(2)"),
        (
            U16,
            "2000:00 | u16 | rw | $NODEID+9 | - | n",
            "E094 8 Some(2)",
        ),
        (U16, "2000:00 | u16 | rw | ten | - | n", "E094 8 Some(2)"),
        (
            U16,
            "2000:00 | u16 | rw | 10 | unsupported | n",
            "E096 5 Some(2)",
        ),
        (
            U16,
            "2000:00 | u16 | rw | 10 | reserved | n",
            "E096 5 Some(2)",
        ),
        (
            "DataType=6\nAccessType=rw",
            "2000:00 | u16 | rw | 0 | - | n",
            "E095 4 Some(2)",
        ),
    ] {
        assert_eq!(found(keys, row), [expected], "{keys} {row}");
    }
}

#[test]
fn entries_that_one_of_the_two_lacks_are_reported() {
    let agreed = "2000:00 | u16 | rw | 10 | - | n";
    assert_eq!(
        found(U16, &format!("{agreed}\n2001:00 | u8 | ro | - | - | more")),
        ["E090 3 Some(3)"]
    );
    assert_eq!(
        found(U16, &format!("{agreed}\n1005:00 | u8 | ro | - | - | more")),
        ["E090 1 Some(3)"]
    );
    assert_eq!(
        found(U16, &format!("{agreed}\n1018:00 | u8 | ro | - | - | more")),
        ["E090 1 Some(3)"]
    );
    assert_eq!(
        found(U16, &format!("{agreed}\n2000:01 | u8 | ro | - | - | more")),
        ["E090 4 Some(3)"]
    );
    assert_eq!(found(U16, ""), ["E091 4 None"]);
}
