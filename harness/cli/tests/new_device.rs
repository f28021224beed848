//! A description to start from: what an EDS says is in it, and nothing else.

#![allow(clippy::unwrap_used)]

mod support;

use support::Folder;

#[test]
fn description_says_what_is_taken_from_where() {
    let folder = Folder::new();
    folder.write(
        "a.eds",
        "[DeviceInfo]\nVendorName=M\u{fc}ller \"A\"\nProductName=Drive: 5\nVendorNumber=0x12\nBaudRate_125=1\nBaudRate_500=1\nLSS_Supported=1\n\
         [1008]\nParameterName=Name\nObjectType=7\nDataType=9\nAccessType=const\nDefaultValue=A drive\n\
         [1017]\nParameterName=Heartbeat\nObjectType=7\nDataType=6\nAccessType=rw\n\
         [100C]\nParameterName=Guard time\nObjectType=7\nDataType=6\nAccessType=rw\n"
            .replace('\u{fc}', "ue"),
    );
    let ran = folder.run(&["new-device", "My_Drive 5", "--eds", "a.eds"]);
    assert_eq!(ran.exit(), Some(0), "{}", ran.error());
    let text = folder.read("My_Drive 5/device.yaml");
    for part in [
        "device: my-drive-5\n",
        "title: \"Mueller \\\"A\\\" Drive: 5\"\n",
        "18 (0x00000012) as vendor number",
        "can: {can: 500 kbit/s}",
        "  # 1017h\n  - heartbeat-producer\n",
        "  # 1008h:00 is longer than 4 bytes\n  - sdo-segmented\n",
        "  # LSS_Supported\n  - lss\n",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    // Guarding needs 100Dh too; the others are not in the EDS.
    for part in [
        "node-guarding",
        "- tpdo",
        "- rpdo",
        "emergency",
        "dynamic-mapping",
        "sync-consumer",
        "modbus",
    ] {
        assert!(!text.contains(part), "{part}\n{text}");
    }
}

#[test]
fn description_from_each_eds_is_clean_and_can_be_previewed() {
    let folder = Folder::new();
    assert_eq!(folder.run(&["export", "all"]).exit(), Some(0));
    for eds in [
        "huacheng-ssts1/huacheng-ssts1.eds",
        "kinco-servo/kinco-servo.eds",
        "liaomiao-encoder/liaomiao-encoder.eds",
        "teco-jn5-cm-can/TECO_510_CAN.eds",
    ] {
        let path = format!("all/devices/{eds}");
        let mine = format!(
            "mine/{}",
            eds.split('/').next().unwrap().replace('-', "_x_")
        );
        let ran = folder.run(&["new-device", &mine, "--eds", &path]);
        assert_eq!(ran.exit(), Some(0), "{eds}\n{}", ran.error());
        let copy = format!("{mine}/{}", eds.split('/').next_back().unwrap());
        assert_eq!(folder.read(&copy), folder.read(&path));
        let checked = folder.run(&["check", &mine]);
        assert_eq!(checked.exit(), Some(0), "{eds}\n{}", checked.error());
        assert!(!checked.error().contains(".yaml"), "{}", checked.error());
        let bench = format!("{mine}/bench.yaml");
        let ran = folder.run(&["run", "canopen", "--dry-run", "--bench", &bench]);
        assert_eq!(ran.exit(), Some(0), "{eds}\n{}", ran.error());
        let ran = folder.run(&["run", "canopen", "--dry-run", "--device", &mine]);
        assert!(ran.out().contains(" to play"), "{}", ran.out());
        assert!(ran.out().contains("canopen.nmt on"), "{}", ran.out());
    }
}

#[test]
fn eds_in_latin_1_can_be_used() {
    let folder = Folder::new();
    folder.run(&["export", "all"]);
    let eds = folder.read("all/devices/kinco-servo/kinco-servo.eds");
    let mut bytes = eds.into_bytes();
    // A degree sign as ISO 8859-1 has it, which is no UTF-8.
    bytes.extend(b"\n; \xB0C\n");
    folder.write("a.eds", bytes);
    assert_eq!(
        folder.run(&["new-device", "mine", "--eds", "a.eds"]).exit(),
        Some(0)
    );
    let ran = folder.run(&["check", "mine"]);
    assert_eq!(ran.exit(), Some(0), "{}", ran.error());
}
