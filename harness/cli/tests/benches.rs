//! Benches: what stands on one is played as it says, and what is wrong with one is said.

#![allow(clippy::unwrap_used)]

mod support;

use support::Folder;

const DEVICES: [(&str, &str); 5] = [
    ("canopen-complete", "slave"),
    ("huacheng-ssts1", "drive"),
    ("kinco-servo", "drive"),
    ("liaomiao-encoder", "encoder"),
    ("teco-jn5-cm-can", "gateway"),
];

/// A bench of one simulated servo drive.
fn bench(extra: &str) -> String {
    format!(
        "language: 1
bench: mine
devices:
  - {{name: left, device: kinco-servo, ports: {{can: \"sim:\"}}, {extra}}}
"
    )
}

fn refused(folder: &Folder, arguments: &[&str], parts: &[&str]) {
    let ran = folder.run(arguments);
    assert_eq!(ran.exit(), Some(2), "{arguments:?}\n{}", ran.error());
    for part in parts {
        assert!(ran.error().contains(part), "{part}\n{}", ran.error());
    }
}

#[test]
fn example_benches_are_played_whole() {
    let folder = Folder::new();
    assert_eq!(folder.run(&["export", "mine"]).exit(), Some(0));
    for (device, name) in DEVICES {
        let bench = format!("mine/devices/{device}/bench.yaml");
        let ran = folder.run(&["run", "--bench", &bench]);
        assert_eq!(ran.exit(), Some(0), "{device}\n{}", ran.out());
        assert!(
            ran.out().contains(&format!("{name}  canopen.nmt")),
            "{}",
            ran.out()
        );
        assert!(!ran.out().contains("does not permit"), "{}", ran.out());
        let checked = folder.run(&["check", &format!("mine/devices/{device}")]);
        assert_eq!(checked.exit(), Some(0));
        assert!(
            checked.out().contains("1 bench: no mistakes"),
            "{}",
            checked.out()
        );
    }
}

#[test]
fn only_what_is_listed_is_permitted_and_offered() {
    let folder = Folder::new();
    let dry = |extra: &str, more: &[&str]| {
        folder.write("bench.yaml", bench(extra));
        let mut arguments = vec!["run", "--bench", "bench.yaml", "--dry-run"];
        arguments.extend(more);
        folder.run(&arguments).out()
    };
    let nothing = dry("stimuli: []", &[]);
    for word in ["writes", "resets"] {
        let reason = format!("does not permit {word}");
        assert!(nothing.contains(&reason), "{reason}\n{nothing}");
    }
    assert!(nothing.contains("does not offer the stimulus"), "{nothing}");
    let all = dry(
        "permits: [writes, persists, readdresses, moves, resets, disturbs-bus]",
        &[],
    );
    assert!(!all.contains("does not permit"), "{all}");
    assert!(!all.contains("does not offer"), "{all}");
    let some = dry("permits: [writes]", &["--allow", "writes,resets"]);
    assert!(some.contains("does not permit resets"), "{some}");
    assert!(!some.contains("does not permit writes"), "{some}");
    let none = dry("permits: [writes]", &["--deny", "writes"]);
    assert!(none.contains("does not permit writes"), "{none}");
}

#[test]
fn device_has_the_node_of_the_bench() {
    let folder = Folder::new();
    folder.write("bench.yaml", bench("node: 9, permits: [resets]"));
    folder.write(
        "suite.yaml",
        support::suite("mine", "expect-boot-up:").replace(
            "    steps:\n",
            "    effects: [resets]\n    steps:\n      - nmt: reset-node\n",
        ),
    );
    let ran = folder.run(&["run", "suite.yaml", "--bench", "bench.yaml"]);
    assert_eq!(ran.exit(), Some(0), "{}{}", ran.out(), ran.error());
    let journal = folder
        .files()
        .into_iter()
        .find(|file| file.ends_with("run.jsonl"))
        .map(|file| folder.read(&file))
        .unwrap();
    assert!(journal.contains("\"id\":1801"), "{journal}");
    assert!(!journal.contains("\"id\":1793"), "{journal}");
}

#[test]
fn two_devices_of_one_kind_stand_side_by_side() {
    let folder = Folder::new();
    let two = bench("permits: []")
        + "  - {name: right, device: kinco-servo, ports: {can: \"sim:\"}, node: 2}\n";
    folder.write("bench.yaml", two);
    let ran = folder.run(&["run", "canopen.nmt", "--bench", "bench.yaml"]);
    assert!(
        ran.out().contains("left") && ran.out().contains("right"),
        "{}",
        ran.out()
    );
    let ran = folder.run(&[
        "run",
        "--bench",
        "bench.yaml",
        "--device",
        "right",
        "--dry-run",
    ]);
    assert!(!ran.out().contains(" on left"), "{}", ran.out());
    refused(
        &folder,
        &["run", "--bench", "bench.yaml", "--device", "rihgt"],
        &["no device is called \"rihgt\"", "\"right\"?"],
    );
}

#[test]
fn bench_that_does_not_fit_is_refused_with_its_place() {
    let folder = Folder::new();
    for (wrong, parts) in [
        (
            bench("permits: []").replace("kinco-servo", "kinko-servo"),
            [
                "no device is called \"kinko-servo\"",
                "did you mean \"kinco-servo\"?",
                "bench.yaml:4:26",
            ],
        ),
        (
            bench("permits: []").replace("kinco-servo", "./nowhere"),
            [
                "no description of a device is in \"./nowhere\"",
                "device.yaml",
                "bench.yaml:4:26",
            ],
        ),
        (
            bench("permits: []").replace("can:", "cann:"),
            [
                "the device has no port \"cann\"",
                "\"can\"?",
                "bench.yaml:4:53",
            ],
        ),
        (
            bench("permits: []").replace("sim:", "serial:/dev/ttyUSB0"),
            [
                "the port \"can\" is a CAN port",
                "`serial:` carries no CAN port",
                "bench.yaml:4:52",
            ],
        ),
        (
            bench("permits: []").replace("sim:", "socketcan:can0?baud=9600"),
            [
                "`socketcan:` has no parameter `baud`",
                "it has uncertainty",
                "bench.yaml:4:52",
            ],
        ),
        (
            bench("permits: []").replace(
                "kinco-servo, ports: {can: \"sim:\"}",
                "liaomiao-encoder, ports: {can: \"sim:\", serial: \"serial:/dev/ttyS0\"}",
            ),
            [
                "one device is both simulated and real",
                "`sim:` beside a real link",
                "bench.yaml:4:57",
            ],
        ),
        (
            bench("address: 3"),
            ["no Modbus side", "expected no `address`", "bench.yaml:4:"],
        ),
        (
            bench("permit: []"),
            ["unknown key `permit`", "did you mean `permits`?", "S010"],
        ),
    ] {
        folder.write("bench.yaml", wrong);
        refused(&folder, &["run", "--bench", "bench.yaml"], &parts);
    }
    refused(
        &folder,
        &["run", "--bench", "none.yaml"],
        &["cannot be read", "none.yaml"],
    );
}

#[test]
fn real_links_are_checked_without_being_opened() {
    let folder = Folder::new();
    folder.write(
        "lab.yaml",
        bench("permits: []").replace("sim:", "slcan:/dev/ttyACM0@250000"),
    );
    let ran = folder.run(&["check", "lab.yaml"]);
    assert_eq!(ran.exit(), Some(0), "{}", ran.error());
    assert!(ran.out().contains("1 bench: no mistakes"), "{}", ran.out());
    let ran = folder.run(&["run", "canopen.nmt", "--bench", "lab.yaml", "--dry-run"]);
    assert_eq!(ran.exit(), Some(0), "{}", ran.error());
}

#[test]
fn link_that_cannot_be_opened_breaks_the_run() {
    let folder = Folder::new();
    let bench = bench("permits: []").replace("sim:", "socketcan:no-such-if");
    folder.write("lab.yaml", bench);
    let ran = folder.run(&["run", "canopen.nmt", "--bench", "lab.yaml"]);
    assert_eq!(ran.exit(), Some(3), "{}", ran.error());
    let why = "socketcan:no-such-if: there is no interface no-such-if";
    assert!(ran.error().contains(why), "{}", ran.error());
}

#[test]
fn fault_cannot_be_switched_on_in_a_real_device() {
    let folder = Folder::new();
    let bench = bench("permits: []").replace("sim:", "socketcan:can0");
    folder.write("lab.yaml", bench);
    refused(
        &folder,
        &["run", "--bench", "lab.yaml", "--fault", "abort-code-wrong"],
        &["abort-code-wrong"],
    );
}

/// The description of the servo drive under another name, which nothing simulates.
fn unknown_drive(folder: &Folder) {
    assert_eq!(folder.run(&["export", "all"]).exit(), Some(0));
    for file in ["device.yaml", "kinco-servo.eds"] {
        let text = folder.read(&format!("all/devices/kinco-servo/{file}"));
        let text = text.replace("device: kinco-servo", "device: my-drive");
        folder.write(&format!("drive/{file}"), text);
    }
}

#[test]
fn device_is_given_by_its_folder() {
    let folder = Folder::new();
    unknown_drive(&folder);
    for path in [
        "all/devices/kinco-servo",
        "all/devices/kinco-servo/device.yaml",
    ] {
        let ran = folder.run(&["run", "canopen.nmt", "--device", path]);
        assert_eq!(ran.exit(), Some(0), "{path}\n{}", ran.error());
        assert!(ran.out().contains("kinco-servo"), "{}", ran.out());
        assert!(!ran.out().contains("teco"), "{}", ran.out());
    }
    refused(
        &folder,
        &["run", "--device", "./none"],
        &["cannot be read", "none"],
    );
}

#[test]
fn device_without_a_reference_device_is_checked_and_not_simulated() {
    let folder = Folder::new();
    unknown_drive(&folder);
    let parts = [
        "no reference device \"my-drive\"",
        "a bench says which link it is connected to",
    ];
    refused(&folder, &["run", "--device", "drive"], &parts);
    refused(&folder, &["prove", "--device", "drive"], &parts);
    let ran = folder.run(&["check", "drive"]);
    assert_eq!(ran.exit(), Some(0), "{}", ran.error());
    assert!(
        ran.out().contains("8 devices: no mistakes"),
        "{}",
        ran.out()
    );
    let ran = folder.run(&["run", "--device", "drive", "--dry-run"]);
    assert_eq!(ran.exit(), Some(0), "{}", ran.error());
    assert!(
        ran.out().contains("canopen.nmt on my-drive"),
        "{}",
        ran.out()
    );
}

#[test]
fn deviation_from_a_check_that_is_nowhere_is_a_warning() {
    let folder = Folder::new();
    unknown_drive(&folder);
    let text = folder.read("drive/device.yaml");
    folder.write(
        "drive/device.yaml",
        text.replace("od.target-can-be-read", "od.target-can-be-raed"),
    );
    let ran = folder.run(&["check", "drive"]);
    assert_eq!(ran.exit(), Some(0), "{}", ran.error());
    for part in [
        "warning[S051]",
        "`od.target-can-be-raed`",
        "did you mean `od.target-can-be-read`?",
    ] {
        assert!(ran.error().contains(part), "{part}\n{}", ran.error());
    }
}

#[test]
fn documented_examples_are_what_they_say() {
    let document = include_str!("../../../docs/devices-and-benches.md");
    let blocks: Vec<&str> = document
        .split("```yaml\n")
        .skip(1)
        .map(|block| block.split("```").next().unwrap())
        .collect();
    assert_eq!(blocks.len(), 4, "a device, a register map and two benches");
    let folder = Folder::new();
    unknown_drive(&folder);
    folder.write("my-drive/device.yaml", blocks[0]);
    folder.write(
        "my-drive/my-drive.eds",
        folder.read("drive/kinco-servo.eds"),
    );
    folder.write("my-drive/lab.yaml", blocks[2]);
    folder.write("my-drive/rack.yaml", blocks[3]);
    let checked = folder.run(&["check", "my-drive"]);
    assert!(
        checked.out().contains("2 benches: no mistakes"),
        "{}{}",
        checked.out(),
        checked.error()
    );
    let ran = folder.run(&["run", "--bench", "my-drive/lab.yaml"]);
    assert_eq!(ran.exit(), Some(0), "{}{}", ran.out(), ran.error());
}

/// A bench of two servo drives and what else there is, on these links.
fn two(left: &str, right: &str) -> String {
    format!(
        "language: 1
bench: mine
devices:
  - {{name: left, device: kinco-servo, ports: {{can: \"{left}\"}}, node: 1}}
  - {{name: right, device: kinco-servo, ports: {{can: \"{right}\"}}}}
"
    )
}

#[test]
fn two_devices_of_one_bus_have_two_numbers() {
    let folder = Folder::new();
    let check = ["check", "bench.yaml"];
    folder.write("bench.yaml", two("socketcan:can0", "socketcan:can0"));
    let parts = [
        "a second device with the node-ID 1 on `socketcan:can0`",
        "bench.yaml:5:12",
        "here again",
        "first here",
        "give each its own `node`",
    ];
    refused(&folder, &check, &parts);
    for text in [
        two("socketcan:can0", "socketcan:can1"),
        two("sim:", "sim:"),
        two("socketcan:can0", "socketcan:can0").replace("node: 1", "node: 2"),
    ] {
        folder.write("bench.yaml", text);
        let ran = folder.run(&check);
        assert_eq!(ran.exit(), Some(0), "{}", ran.error());
    }
    folder.write(
        "bench.yaml",
        "language: 1
bench: mine
devices:
  - {name: drive, device: huacheng-ssts1, ports: {serial: \"tcp:10.0.0.1:502\"}, address: 7}
  - {name: encoder, device: liaomiao-encoder, ports: {serial: \"tcp:10.0.0.1:502\"}, address: 7}
",
    );
    let parts = ["a second device with the address 7 on `tcp:10.0.0.1:502`"];
    refused(&folder, &check, &parts);
}

#[test]
fn real_links_are_previewed_without_being_opened() {
    let folder = Folder::new();
    folder.write("bench.yaml", two("socketcan:no-such-bus", "sim:"));
    let ran = folder.run(&["run", "canopen", "--bench", "bench.yaml", "--dry-run"]);
    assert_eq!(ran.exit(), Some(0), "{}", ran.error());
    for part in [
        "canopen.nmt on left",
        "canopen.nmt on right",
        " would be played",
    ] {
        assert!(ran.out().contains(part), "{part}\n{}", ran.out());
    }
}
