//! `fieldproof scan`: devices in other processes are found, and the bench that it writes is one.

#![allow(clippy::unwrap_used)]

mod support;

use std::io::{BufRead, BufReader};
use std::net::TcpListener;
use std::process::{Child, Stdio};

use support::Folder;

/// Ended when the test is over, however it ends.
struct Running {
    child: Child,
    /// What it printed so far, up to the line that was waited for.
    line: String,
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Starts the program and waits for a line that `is_it`.
fn start(folder: &Folder, arguments: &[&str], is_it: fn(&str) -> bool) -> Running {
    let mut command = folder.command(arguments);
    let mut child = command.stdout(Stdio::piped()).spawn().unwrap();
    let lines = BufReader::new(child.stdout.take().unwrap()).lines();
    let line = lines.map(Result::unwrap).find(|line| is_it(line));
    let line = line.unwrap_or_default();
    assert!(is_it(&line), "{arguments:?} ended");
    Running { child, line }
}

fn serve(folder: &Folder, device: &str, link: &str, more: &[&str]) -> Running {
    let arguments = [&["serve", device, "--on", link], more].concat();
    start(folder, &arguments, |line| line == "ready")
}

/// A bus, and its link at 500 kbit/s.
fn bus(folder: &Folder) -> (Running, String) {
    let bus = start(folder, &["bus", "--tcp", "127.0.0.1:0"], |_| true);
    let link = format!("{}@500000", bus.line);
    (bus, link)
}

#[test]
fn nodes_on_a_bus_are_found_and_put_on_a_bench() {
    let folder = Folder::new();
    let (_bus, link) = bus(&folder);
    let _gateway = serve(&folder, "teco-jn5-cm-can", &link, &["--node", "7"]);
    let _slave = serve(&folder, "canopen-complete", &link, &["--node", "10"]);
    let _drive = serve(&folder, "kinco-servo", &link, &["--node", "5"]);

    let ran = folder.run(&[
        "scan", "--on", &link, "--listen", "0", "--bench", "lab.yaml",
    ]);
    assert_eq!(ran.exit(), Some(0), "{}", ran.error());
    let out = ran.out();
    let rows: Vec<&str> = out.lines().skip(1).take(4).collect();
    let expected = [
        "node  device            vendor      product     revision    serial      name               heard",
        "5     -                 0x00000000  0x00000001  0x00010000  0x00000001  Kinco servo drive",
        "7     teco-jn5-cm-can   0x00000373  0x00000100  0x00010000  -           JN5-CM-CAN",
        "10    canopen-complete  0x00000000  0x00000001  0x00010000  0x00000001  canopen-complete",
    ];
    assert_eq!(rows, expected);

    let checked = folder.run(&["check", "lab.yaml"]);
    assert_eq!(checked.exit(), Some(0), "{}", checked.error());
    let bench = folder.read("lab.yaml");
    assert!(bench.contains("  # Node 5 is not described.\n"), "{bench}");
    assert!(!bench.contains("permits: [writes"), "{bench}");

    // It is played on as it stands.
    let played = ["run", "canopen.sdo", "--bench", "lab.yaml", "--quiet"];
    let played = [&played[..], &["--device", "teco-jn5-cm-can-7"]].concat();
    let played = folder.run(&[&played[..], &["--case", "canopen.sdo/claimed-identity*"]].concat());
    assert_eq!(played.exit(), Some(0), "{}{}", played.out(), played.error());

    // The link carries one device at a time, so the second is there as a comment.
    assert!(
        bench.contains("\n  # - name: canopen-complete-10\n"),
        "{bench}"
    );

    // Who knows what the third is, says so.
    let again = [
        "scan",
        "--on",
        &link,
        "--listen",
        "0",
        "--device",
        "kinco-servo",
    ];
    let kept = folder.run(&[&again[..], &["--bench", "lab.yaml"]].concat());
    assert_eq!(kept.exit(), Some(2));
    assert_eq!(folder.read("lab.yaml"), bench);
    let overwritten = folder.run(&[&again[..], &["--bench", "lab.yaml", "--force"]].concat());
    assert_eq!(overwritten.exit(), Some(0), "{}", overwritten.error());
    assert!(folder.read("lab.yaml").contains("name: kinco-servo-5"));
    assert_eq!(folder.run(&["check", "lab.yaml"]).exit(), Some(0));
}

#[test]
fn nothing_on_a_bus_is_exit_code_1() {
    let folder = Folder::new();
    let (_bus, link) = bus(&folder);
    let on = ["scan", "--on", &link, "--listen", "0", "--timeout", "50"];
    let ran = folder.run(&[&on[..], &["--bench", "lab.yaml"]].concat());
    assert_eq!(ran.exit(), Some(1));
    assert_eq!(ran.out(), format!("{link}\nnothing found\n"));
    assert!(ran.error().contains("no bench is written"));
    assert!(folder.files().is_empty());
}

#[test]
fn server_behind_a_port_is_found_and_put_on_a_bench() {
    let folder = Folder::new();
    let free = TcpListener::bind("127.0.0.1:0")
        .unwrap()
        .local_addr()
        .unwrap();
    let link = &format!("tcp:{free}");
    let _encoder = serve(&folder, "liaomiao-encoder", link, &[]);

    let on = [
        "scan",
        "--on",
        link,
        "--addresses",
        "30-33",
        "--timeout",
        "100",
    ];
    let unknown = folder.run(&[&on[..], &["--bench", "lab.yaml"]].concat());
    assert_eq!(unknown.exit(), Some(1), "{}", unknown.error());
    let out = unknown.out();
    let rows: Vec<&str> = out.lines().skip(1).take(2).collect();
    let expected = [
        "address  device  identification  answer",
        "30       -       -               register 0000h: 0FB4h",
    ];
    assert_eq!(rows, expected);

    let device = ["--device", "liaomiao-encoder", "--bench", "lab.yaml"];
    let known = folder.run(&[&on[..], &device].concat());
    assert_eq!(known.exit(), Some(0), "{}", known.error());
    let checked = folder.run(&["check", "lab.yaml"]);
    assert_eq!(checked.exit(), Some(0), "{}", checked.error());
    let json = folder.run(&[&on[..], &["--format", "json"]].concat());
    let json: serde_json::Value = serde_json::from_str(&json.out()).unwrap();
    // One device that answers every unit is told once.
    assert_eq!(json["devices"].as_array().map(Vec::len), Some(1));
    assert_eq!(json["devices"][0]["address"], 30);
    assert_eq!(json["notes"][0], "it answers whatever the unit is");
    assert_eq!(json["bench"], serde_json::Value::Null);
}
