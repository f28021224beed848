//! Register tables: what a line says, and what is refused.

use fieldproof_dictionary::Access;
use fieldproof_dictionary::registers::RegisterMap;

const SPEED: &str = "325 | rw | i16 | -6000..6000 | 0 | rpm | no | speed command 1 # as printed";

#[test]
fn a_line_says_everything() {
    let map = RegisterMap::parse(&format!(
        "# head\r\n\r\n{SPEED}\r\n0x0010|r|u32|-|-|-|yes|counter"
    ))
    .unwrap();
    let speed = map.register(325).unwrap();
    assert_eq!(
        (speed.name.as_str(), speed.unit.as_str(), speed.line),
        ("speed command 1", "rpm", 3)
    );
    assert_eq!(
        (speed.low, speed.high, speed.default),
        (-6000, 6000, Some(0))
    );
    assert_eq!(
        (speed.signed, speed.words, speed.persists),
        (true, 1, Some(false))
    );
    assert_eq!(speed.access, Access::ReadWrite);
    let counter = map.containing(0x11).unwrap();
    assert_eq!(
        (counter.address, counter.words, counter.high),
        (0x10, 2, 0xFFFF_FFFF)
    );
    assert_eq!(
        (counter.default, counter.persists, counter.unit.as_str()),
        (None, Some(true), "")
    );
    let addresses: Vec<u16> = map.registers().map(|register| register.address).collect();
    assert_eq!(addresses, [0x10, 325]);
}

#[test]
fn what_is_no_register_is_refused_with_its_line() {
    for (row, why) in [
        ("1 | r | u16", "3 columns instead of 8"),
        ("x | r | u16 | - | - | - | - | n", "`x` is no number"),
        (
            "65536 | r | u16 | - | - | - | - | n",
            "`65536` is no register address",
        ),
        (
            "65535 | r | u32 | - | - | - | - | n",
            "`65535` is no register address",
        ),
        (
            "1 | ro | u16 | - | - | - | - | n",
            "`ro` is no access: r, w, rw",
        ),
        (
            "1 | r | u8 | - | - | - | - | n",
            "`u8` is no type: u16, i16, u32, i32",
        ),
        (
            "1 | r | u16 | 5 | - | - | - | n",
            "`5` is no range: low..high",
        ),
        (
            "1 | r | u16 | 5..4 | - | - | - | n",
            "the range 5..4 does not fit the type",
        ),
        (
            "1 | r | i16 | 0..40000 | - | - | - | n",
            "the range 0..40000 does not fit the type",
        ),
        (
            "1 | r | u16 | 0..9 | 10 | - | - | n",
            "the default 10 is outside 0..9",
        ),
        (
            "1 | r | u16 | - | - | - | maybe | n",
            "`maybe` is neither yes, no nor -",
        ),
    ] {
        let error = RegisterMap::parse(&format!("{SPEED}\n{row}")).unwrap_err();
        assert_eq!(error.to_string(), format!("line 2: {why}"));
    }
}

#[test]
fn overlapping_registers_are_refused() {
    for rows in [
        "7 | r | u16 | - | - | - | - | a\n7 | r | u16 | - | - | - | - | b",
        "6 | r | u32 | - | - | - | - | a\n7 | r | u16 | - | - | - | - | b",
        "7 | r | u16 | - | - | - | - | a\n6 | r | u32 | - | - | - | - | b",
    ] {
        let error = RegisterMap::parse(rows).unwrap_err();
        assert_eq!(error.to_string(), "line 2: overlaps the register of line 1");
    }
}
