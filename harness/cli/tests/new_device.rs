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
        "  # VendorNumber\n  vendor-id: 0x00000012\n",
        "  # 1008h\n  device-name: \"A drive\"\n",
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

/// What `new-device` makes of an EDS.
fn described(eds: &str) -> String {
    let folder = Folder::new();
    folder.write("a.eds", eds);
    let ran = folder.run(&["new-device", "mine", "--eds", "a.eds"]);
    assert_eq!(ran.exit(), Some(0), "{}", ran.error());
    let checked = folder.run(&["check", "mine"]);
    assert_eq!(checked.exit(), Some(0), "{}", checked.error());
    folder.read("mine/device.yaml")
}

fn object(index: &str, rest: &str) -> String {
    format!("[{index}]\nParameterName=A\nObjectType=7\nDataType=7\nAccessType=ro\n{rest}\n")
}

#[test]
fn only_what_the_eds_shows_is_claimed() {
    let record = |index: &str, access: &str| {
        format!("[{index}]\nParameterName=M\nObjectType=9\nSubNumber=2\n")
            + &["0", "1"]
                .map(|sub| {
                    format!("[{index}sub{sub}]\nParameterName=S\nDataType=7\nAccessType={access}\n")
                })
                .concat()
    };
    for (eds, shown, not_shown) in [
        (object("1000", ""), "- sdo-server", "\n  - sdo-segmented"),
        (
            object("1017", "DefaultValue=0"),
            "# - heartbeat-producer",
            "\n  - heartbeat",
        ),
        (
            object("1017", "DefaultValue=500"),
            "\n  - heartbeat-producer",
            "# - heartbeat",
        ),
        (
            object("1005", "DefaultValue=0x80"),
            "\n  - sync-consumer",
            "sync-producer",
        ),
        (
            object("1005", "DefaultValue=0x40000080"),
            "\n  - sync-producer",
            "sync-consumer",
        ),
        (
            object("1014", "DefaultValue=0x80000080"),
            "# - emergency",
            "\n  - emergency",
        ),
        (
            object("1014", "DefaultValue=0x80"),
            "\n  - emergency",
            "# - emergency",
        ),
        (
            object("2000", "").replace("DataType=7", "DataType=0x1B"),
            "\n  - sdo-segmented",
            "# - sdo-seg",
        ),
        (record("1A00", "rw"), "\n  - dynamic-mapping", "# - dynamic"),
        (record("1A00", "ro"), "- sdo-server", "dynamic-mapping"),
        (
            format!("[DeviceInfo]\nGranularity=0\n{}", record("1A00", "rw")),
            "# - dynamic-mapping",
            "\n  - dynamic",
        ),
        (
            format!("[DeviceInfo]\nNrOfTXPDO=2\n{}", object("1000", "")),
            "# - tpdo",
            "\n  - tpdo",
        ),
        (
            format!(
                "[DeviceInfo]\nNrOfTXPDO=2\nCompactPDO=1\n{}",
                object("1000", "")
            ),
            "- tpdo",
            "\n  - rpdo",
        ),
    ] {
        let text = described(&eds);
        assert!(text.contains(shown), "{shown}\n{eds}\n{text}");
        assert!(!text.contains(not_shown), "{not_shown}\n{eds}\n{text}");
    }
}

#[test]
fn identity_is_what_the_eds_says_of_every_unit() {
    let identity = "[1018]\nParameterName=I\nObjectType=9\nSubNumber=3\n\
        [1018sub0]\nParameterName=N\nDataType=5\nAccessType=ro\nDefaultValue=4\n\
        [1018sub1]\nParameterName=V\nDataType=7\nAccessType=ro\nDefaultValue=0x373\n\
        [1018sub4]\nParameterName=S\nDataType=7\nAccessType=ro\nDefaultValue=17\n";
    let text = described(&format!(
        "[DeviceInfo]\nVendorNumber=0xEE\nProductNumber=0\n{identity}"
    ));
    for part in [
        "  # 1018h:01; but VendorNumber is 0x000000EE\n  vendor-id: 0x00000373\n",
        "  # 1018h:04, the number of one unit\n  # serial-number: 0x00000011\n",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    assert!(!text.contains("product-code"), "{text}");
    // Neither 1018h nor [DeviceInfo].
    let text = described(&object("1000", ""));
    assert!(
        text.contains("# NOT KNOWN: who the device says it is"),
        "{text}"
    );
}

#[test]
fn dcf_says_the_node_and_the_bit_rate() {
    let dcf = "[DeviceInfo]\nBaudRate_1000=1\n[DeviceComissioning]\nNodeID=0x20\nBaudrate=250\n";
    let text = described(&format!("{dcf}{}", object("1000", "")));
    for part in ["canopen: {node: 32,", "can: {can: 250 kbit/s}"] {
        assert!(text.contains(part), "{part}\n{text}");
    }
    assert!(!text.contains("NOT KNOWN: the node-ID"), "{text}");
}

#[test]
fn what_is_no_eds_is_refused() {
    let folder = Folder::new();
    folder.write("picture.eds", [0x89, b'P', b'N', b'G', 0, 0xFF]);
    folder.write("empty.eds", "");
    folder.write("device.yaml", "language: 1\ndevice: a\n");
    for file in ["picture.eds", "empty.eds", "device.yaml"] {
        let ran = folder.run(&["new-device", "mine", "--eds", file]);
        assert_eq!(ran.exit(), Some(2), "{file}");
        assert!(
            ran.error().contains("no object is described in this file"),
            "{}",
            ran.error()
        );
    }
    assert!(!folder.files().iter().any(|file| file.starts_with("mine")));
}

#[test]
fn without_a_device_it_says_what_to_do() {
    let folder = Folder::new();
    folder.write("a.eds", object("1000", ""));
    folder.run(&["new-device", "mine", "--eds", "a.eds"]);
    for (arguments, part) in [
        (
            ["--device", "mine"],
            "- {name: mine, device: ., ports: {can: \"socketcan:can0\"}}",
        ),
        (
            ["--bench", "mine/bench.yaml"],
            "on this bench it stands on `sim:`",
        ),
    ] {
        let ran = folder.run(&["run", arguments[0], arguments[1]]);
        assert_eq!(ran.exit(), Some(2));
        for part in [part, "fieldproof run --bench"] {
            assert!(ran.error().contains(part), "{part}\n{}", ran.error());
        }
    }
    // The commented links of the bench are ones.
    let bench = folder.read("mine/bench.yaml");
    let real = bench.replace("    ports: {can: \"sim:\"}\n    # ports:", "    ports:");
    assert_ne!(real, bench);
    folder.write("mine/bench.yaml", real);
    let ran = folder.run(&["run", "--bench", "mine/bench.yaml", "--dry-run"]);
    assert_eq!(ran.exit(), Some(0), "{}", ran.error());
}
