//! What a description claims of the identity is compared with the EDS beside it, and with the device.

#![allow(clippy::unwrap_used)]

mod support;

use support::Folder;

/// The folder of the TECO module's description, in which `from` is `to`.
fn teco_with(from: &str, to: &str) -> Folder {
    let folder = Folder::new();
    assert_eq!(folder.run(&["export", "mine"]).exit(), Some(0));
    let path = "mine/devices/teco-jn5-cm-can/device.yaml";
    let text = folder.read(path);
    assert!(text.contains(from), "{text}");
    folder.write(path, text.replace(from, to));
    folder
}

const TECO: &str = "mine/devices/teco-jn5-cm-can";

fn run(folder: &Folder) -> (Option<i32>, String) {
    let ran = folder.run(&[
        "run",
        "canopen.sdo",
        "--case",
        "canopen.sdo/claimed-identity*",
        "--device",
        TECO,
    ]);
    (ran.exit(), ran.out())
}

#[test]
fn another_vendor_than_in_the_eds_is_told_with_both_places() {
    let folder = teco_with("vendor-id: 0x00000373", "vendor-id: 0xEE");
    let checked = folder.run(&["check", TECO]);
    assert_eq!(checked.exit(), Some(0));
    for part in [
        "the description claims the vendor-id 0x000000EE, and its EDS says 0x00000373",
        "device.yaml:9:14",
        "TECO_510_CAN.eds:224: 1018h:01 says so",
    ] {
        assert!(
            checked.error().contains(part),
            "{part}\n{}",
            checked.error()
        );
    }
    let times = checked.error().matches("claims the vendor-id").count();
    assert_eq!(times, 1, "{}", checked.error());
    let (exit, out) = run(&folder);
    assert_eq!(exit, Some(1), "{out}");
    assert!(
        out.contains("EEh), the vendor-id that the device claims"),
        "{out}"
    );
}

#[test]
fn device_info_counts_where_the_object_says_nothing() {
    let folder = teco_with("vendor-id: 0x00000373", "vendor-id: 0x00000373");
    let eds = format!("{TECO}/TECO_510_CAN.eds");
    let text = folder.read(&eds);
    folder.write(
        &eds,
        text.replace("DefaultValue=0x00000373", "DefaultValue="),
    );
    let checked = folder.run(&["check", TECO]);
    for part in ["its EDS says 0x000000EE", "VendorNumber of [DeviceInfo]"] {
        assert!(
            checked.error().contains(part),
            "{part}\n{}",
            checked.error()
        );
    }
}

#[test]
fn what_is_not_claimed_is_not_asserted() {
    let folder = teco_with("revision-number: 0x00010000", "revision-number:");
    let (exit, out) = run(&folder);
    assert_eq!(exit, Some(0), "{out}");
    assert!(
        out.contains("does not claim this part of its identity"),
        "{out}"
    );
    let (exit, out) = run(&teco_with("JN5-CM-CAN\n  hard", "JN5\n  hard"));
    assert_eq!(exit, Some(1), "{out}");
    assert!(out.contains("\"JN5-CM-CAN\""), "{out}");
}
