//! LSS, and what each of its faults makes of it. The identity: vendor 0, product 1, revision 10000h, serial number 1.

use super::KIND;
use crate::Settings;
use crate::script::Script;

const CONFIGURE: &str = "7E5#0401000000000000";
const WAIT: &str = "7E5#0400000000000000";
const NODE: &str = "7E5#5E00000000000000";
const VENDOR: &str = "7E5#4000000000000000";
const PRODUCT: &str = "7E5#4101000000000000";
const REVISION: &str = "7E5#4200000100000000";
const SERIAL: &str = "7E5#4301000000000000";
const NO_NODE: &str = "7E5#11FF000000000000";
const RESET_COMMUNICATION: &str = "000#820A";
const SCAN: &str = "7E5#5100000000800000";

/// What a slave answers to `frames`, its boot-up left aside. A number is milliseconds that pass.
pub(super) fn answers(fault: Option<&str>, frames: &[&str]) -> String {
    let settings = Settings {
        fault: fault.map(str::to_owned),
        ..Settings::default()
    };
    let mut script = Script::new(&KIND, &settings);
    script.play("wait 10 ms");
    let mut told = String::new();
    for frame in frames {
        let line = match frame.parse::<u32>() {
            Ok(milliseconds) => format!("wait {milliseconds} ms"),
            Err(_) => format!("> {frame}"),
        };
        told += &script.play(&line);
    }
    let sent = told.lines().filter_map(|line| line.strip_prefix("< "));
    sent.collect::<Vec<_>>().join(" ")
}

/// Each row: a fault, what is sent, what a right slave answers, and what one with the fault does.
pub(super) fn each_departs(rows: &[(&str, &[&str], &str, &str)]) {
    for (fault, frames, right, wrong) in rows {
        assert_eq!(answers(None, frames), *right, "without {fault}");
        assert_eq!(answers(Some(fault), frames), *wrong, "with {fault}");
    }
}

#[test]
fn states() {
    let node = "7E4#5E0A000000000000";
    each_departs(&[
        (
            "lss-any-mode-configures",
            &["7E5#0402000000000000", NODE],
            "",
            node,
        ),
        (
            "lss-stays-in-configuration",
            &[CONFIGURE, WAIT, NODE],
            "",
            node,
        ),
        (
            "lss-configuration-survives-reset",
            &[CONFIGURE, RESET_COMMUNICATION, "10", NODE],
            "70A#00",
            "70A#00 7E4#5E0A000000000000",
        ),
        ("lss-inquired-in-waiting", &[NODE], "", node),
        (
            "lss-configured-in-waiting",
            &["7E5#110B000000000000"],
            "",
            "7E4#1100000000000000",
        ),
        (
            "lss-not-in-operational",
            &[CONFIGURE, "000#010A", "1", NODE],
            "18A#E803A0860100 38A#FFFDFFFFFF 7E4#5E0A000000000000",
            "18A#E803A0860100 38A#FFFDFFFFFF",
        ),
        (
            "lss-not-in-stopped",
            &[CONFIGURE, "000#020A", NODE],
            node,
            "",
        ),
        ("lss-short-requests-taken", &["7E5#0401", NODE], "", node),
        (
            "lss-unknown-answered",
            &[CONFIGURE, "7E5#1200000000000000"],
            "",
            "7E4#1201000000000000",
        ),
        (
            "lss-answers-cut-short",
            &[CONFIGURE, NODE],
            node,
            "7E4#5E0A",
        ),
        (
            "lss-answers-twice",
            &[CONFIGURE, NODE],
            node,
            "7E4#5E0A000000000000 7E4#5E0A000000000000",
        ),
        (
            "lss-reserved-bytes-stale",
            &[CONFIGURE, "7E5#5C00000000000000", NODE],
            "7E4#5C00000100000000 7E4#5E0A000000000000",
            "7E4#5C00000100000000 7E4#5E0A000100000000",
        ),
    ]);
    let mut many = vec![CONFIGURE];
    many.extend([NODE; 130]);
    let count = |fault| answers(fault, &many).split(' ').count();
    assert_eq!(count(None), 130);
    assert_eq!(count(Some("lss-silent-after-127-answers")), 127);
}

#[test]
fn selection() {
    let selected = "7E4#4400000000000000";
    let right = [VENDOR, PRODUCT, REVISION, SERIAL];
    assert_eq!(answers(None, &right), selected);
    each_departs(&[
        (
            "lss-vendor-ignored",
            &["7E5#4007000000000000", PRODUCT, REVISION, SERIAL],
            "",
            selected,
        ),
        (
            "lss-product-ignored",
            &[VENDOR, "7E5#4107000000000000", REVISION, SERIAL],
            "",
            selected,
        ),
        (
            "lss-revision-ignored",
            &[VENDOR, PRODUCT, "7E5#4207000000000000", SERIAL],
            "",
            selected,
        ),
        (
            "lss-low-words-compared",
            &[VENDOR, PRODUCT, REVISION, "7E5#4301000080000000"],
            "",
            selected,
        ),
        (
            "lss-order-ignored",
            &[SERIAL, REVISION, PRODUCT, VENDOR],
            "",
            selected,
        ),
        ("lss-serial-selects-alone", &[SERIAL], "", selected),
        (
            "lss-selection-goes-on",
            &[VENDOR, PRODUCT, REVISION, WAIT, SERIAL],
            "",
            selected,
        ),
        (
            "lss-every-number-confirmed",
            &[VENDOR, PRODUCT],
            "",
            "7E4#4400000000000000 7E4#4400000000000000",
        ),
    ]);
}

#[test]
fn an_address_may_be_compared_at_the_end() {
    let settings = Settings {
        variant: Some("lss-address-compared-at-the-end".to_owned()),
        ..Settings::default()
    };
    for (frames, selected) in [
        ([VENDOR, PRODUCT, REVISION, SERIAL], true),
        ([SERIAL, REVISION, PRODUCT, VENDOR], false),
        ([REVISION, VENDOR, PRODUCT, SERIAL], true),
        ([VENDOR, PRODUCT, "7E5#4207000000000000", SERIAL], false),
    ] {
        let mut script = Script::new(&KIND, &settings);
        let lines: Vec<String> = frames.iter().map(|frame| format!("> {frame}")).collect();
        let told = script.play(&format!("wait 10 ms\n{}", lines.join("\n")));
        assert_eq!(told.contains("< 7E4#44"), selected, "{told}");
    }
}

#[test]
fn configuration() {
    let done = "7E4#1100000000000000";
    let refused = "7E4#1101000000000000";
    let seen = |answers: &[&str]| answers.join(" ");
    let boots = seen(&[refused, "70A#00"]);
    let at_63 = seen(&[done, "73F#00"]);
    let at_127 = seen(&[done, "77F#00"]);
    let at_10 = seen(&[done, "70A#00"]);
    let told = seen(&[done, "7E4#5E0A000000000000"]);
    let told_early = seen(&[done, "7E4#5E55000000000000"]);
    each_departs(&[
        (
            "lss-node-127-refused",
            &[CONFIGURE, "7E5#117F000000000000"],
            done,
            refused,
        ),
        ("lss-node-255-refused", &[CONFIGURE, NO_NODE], done, refused),
        (
            "lss-node-0-taken",
            &[CONFIGURE, "7E5#1100000000000000"],
            refused,
            done,
        ),
        (
            "lss-node-128-taken",
            &[CONFIGURE, "7E5#1180000000000000"],
            refused,
            done,
        ),
        (
            "lss-refused-node-kept",
            &[CONFIGURE, "7E5#1180000000000000", RESET_COMMUNICATION, "10"],
            &boots,
            refused,
        ),
        (
            "lss-node-of-six-bits",
            &[CONFIGURE, "7E5#117F000000000000", RESET_COMMUNICATION, "10"],
            &at_127,
            &at_63,
        ),
        (
            "lss-node-waits-for-reset-node",
            &[CONFIGURE, "7E5#117F000000000000", RESET_COMMUNICATION, "10"],
            &at_127,
            &at_10,
        ),
        (
            "lss-pending-node-told",
            &[CONFIGURE, "7E5#1155000000000000", NODE],
            &told,
            &told_early,
        ),
        (
            "lss-stored-unasked",
            &[CONFIGURE, "7E5#117F000000000000", "000#810A", "10"],
            &at_10,
            &at_127,
        ),
        (
            "lss-store-unanswered",
            &[CONFIGURE, "7E5#1700000000000000"],
            "7E4#1700000000000000",
            "",
        ),
        (
            "lss-table-ignored",
            &[CONFIGURE, "7E5#1301020000000000"],
            "7E4#1301000000000000",
            "7E4#1300000000000000",
        ),
        (
            "lss-last-index-for-all",
            &[CONFIGURE, "7E5#1300FF0000000000"],
            "7E4#1301000000000000",
            "7E4#1300000000000000",
        ),
    ]);
}

#[test]
fn identification() {
    let found = "7E4#4F00000000000000";
    let identify = |vendor, low, high| {
        [
            vendor,
            "7E5#4701000000000000",
            "7E5#4800000100000000",
            high,
            low,
            "7E5#4B01000000000000",
        ]
    };
    let (own, high, low) = (
        "7E5#4600000000000000",
        "7E5#4900000100000000",
        "7E5#4A01000000000000",
    );
    let unconfigured = "7E5#4C00000000000000";
    each_departs(&[
        (
            "lss-identify-vendor-ignored",
            &identify("7E5#4607000000000000", low, high),
            "",
            found,
        ),
        (
            "lss-identify-revision-high-ignored",
            &identify(own, low, "7E5#49FFFF0000000000"),
            "",
            found,
        ),
        (
            "lss-identify-bounds-exclusive",
            &identify(own, low, high),
            found,
            "",
        ),
        (
            "lss-identify-begins-anywhere",
            &["7E5#4B01000000000000"],
            "",
            found,
        ),
        (
            "lss-unconfigured-with-node",
            &[unconfigured],
            "",
            "7E4#5000000000000000",
        ),
        (
            "lss-unconfigured-silent",
            &[CONFIGURE, NO_NODE, unconfigured],
            "7E4#1100000000000000 7E4#5000000000000000",
            "7E4#1100000000000000",
        ),
    ]);
}

#[test]
fn fastscan() {
    let start = [CONFIGURE, NO_NODE, RESET_COMMUNICATION, "10", SCAN];
    let begun = "7E4#1100000000000000 7E4#4F00000000000000";
    let found = |times: usize| format!("{begun}{}", " 7E4#4F00000000000000".repeat(times));
    let with = |frames: &[&'static str]| [&start[..], frames].concat();
    let vendor = "7E5#5100000000000001";
    let product = "7E5#5101000000000102";
    let revision = "7E5#5100000100000203";
    let serial = "7E5#5101000000000300";
    let all = with(&[vendor, product, revision, serial, NODE]);
    let selected = format!("{} 7E4#5EFF000000000000", found(4));
    each_departs(&[
        (
            "lss-fastscan-number-ignored",
            &with(&["7E5#51000000801F0000"]),
            begun,
            &found(1),
        ),
        (
            "lss-fastscan-low-bits-compared",
            &with(&["7E5#51FF000000080000"]),
            &found(1),
            begun,
        ),
        (
            "lss-fastscan-part-ignored",
            &with(&["7E5#51010000001F0303"]),
            begun,
            &found(1),
        ),
        (
            "lss-fastscan-goes-on",
            &with(&[vendor, SCAN, vendor]),
            &found(3),
            &found(2),
        ),
        ("lss-fastscan-does-not-select", &all, &selected, &found(4)),
        (
            "lss-fastscan-in-configuration",
            &with(&[CONFIGURE, SCAN]),
            begun,
            &found(1),
        ),
    ]);
}

/// The bit rate becomes 250 kbit/s 5 ms after the request.
#[test]
fn activation() {
    let line = |fault: Option<&str>, frames: &[&str], milliseconds: u32| {
        let settings = Settings {
            fault: fault.map(str::to_owned),
            ..Settings::default()
        };
        let mut script = Script::new(&KIND, &settings);
        let frames: Vec<String> = frames.iter().map(|frame| format!("> {frame}")).collect();
        script.play(&format!(
            "wait 10 ms\n{}\nwait {milliseconds} ms",
            frames.join("\n")
        ));
        format!("{:?}", script.device.line(0))
    };
    let (timing, activate) = ("7E5#1300030000000000", "7E5#1505000000000000");
    let old = line(None, &[], 0);
    let new = line(None, &[CONFIGURE, timing, activate], 6);
    assert_ne!(old, new);
    for (fault, frames, right, wrong) in [
        (
            "lss-bit-timing-at-once",
            &[CONFIGURE, timing][..],
            &old,
            &new,
        ),
        (
            "lss-activated-in-waiting",
            &[CONFIGURE, timing, WAIT, activate],
            &old,
            &new,
        ),
    ] {
        assert_eq!(line(None, frames, 20), *right, "without {fault}");
        assert_eq!(line(Some(fault), frames, 20), *wrong, "with {fault}");
    }
    let talks = ["60A#2B17100002000000", CONFIGURE, timing, activate, "8"];
    let heartbeats = |fault| answers(fault, &talks).matches("70A#7F").count();
    assert!(heartbeats(None) < heartbeats(Some("lss-talks-while-switching")));
}
