//! What a Modbus RTU request and its answer cost over a pseudo-terminal, beside a bare write and read on the same one;
//! no silences. On one processor, for a wake-up across two would drown what is measured:
//!
//! ```text
//! cargo bench -p fieldproof-link --bench serial
//! ```
//!
//! Absolute figures drift with the machine; the difference comes from rounds in which both take their turn.

#![allow(clippy::unwrap_used)] // A bench that cannot go on has nothing to report.
#![allow(clippy::print_stdout)]

use std::fs::{self, File, OpenOptions};
use std::io::{Read, Write};
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use fieldproof_link::real::{NoStimuli, RealLane, Serial, SerialOptions};
use fieldproof_link::{Lane, Parity, PortIndex, SerialSettings, StopBits, Transmission};
use nix::pty::openpty;
use nix::sys::termios::{SetArg, cfmakeraw, tcgetattr, tcsetattr};
use nix::unistd::ttyname;

const ROUNDS: usize = 20;
const PAIRS: usize = 1_000;

const SETTINGS: SerialSettings = SerialSettings {
    baud: 115_200,
    parity: Parity::Even,
    stop_bits: StopBits::One,
};

/// Read of register 0000h of slave 20h, and its answer.
const REQUEST: [u8; 8] = [0x20, 0x03, 0x00, 0x00, 0x00, 0x01, 0x82, 0xBB];
const ANSWER: [u8; 7] = [0x20, 0x03, 0x02, 0x0F, 0xB4, 0x01, 0xC4];

fn main() {
    pin();
    let pair = openpty(None, None).unwrap();
    let mut attributes = tcgetattr(&pair.slave).unwrap();
    cfmakeraw(&mut attributes);
    tcsetattr(&pair.slave, SetArg::TCSANOW, &attributes).unwrap();
    let path = ttyname(&pair.slave).unwrap();
    let mut bare = OpenOptions::new()
        .read(true)
        .write(true)
        .open(&path)
        .unwrap();
    let path = path.to_str().unwrap();
    let serial = Serial::open("serial", path, SETTINGS, SerialOptions::default()).unwrap();
    let mut lane = RealLane::new(vec![Box::new(serial)], Box::new(NoStimuli));
    serve(File::from(pair.master));

    let mut bare_times = Vec::new();
    let mut lane_times = Vec::new();
    for _ in 0..ROUNDS {
        measure(&mut bare_times, || bare_pair(&mut bare));
        measure(&mut lane_times, || lane_pair(&mut lane));
    }
    let bare = show("bare write and read", bare_times);
    let lane = show("lane", lane_times);
    let difference_us = lane.as_secs_f64().mul_add(1e6, -bare.as_secs_f64() * 1e6);
    println!("{:<20} {difference_us:8.1} us at p50", "difference");
}

/// Answers every request at once, until the process ends.
fn serve(mut other: File) {
    thread::spawn(move || {
        let mut request = [0; REQUEST.len()];
        while other.read_exact(&mut request).is_ok() && other.write_all(&ANSWER).is_ok() {}
    });
}

fn measure(times: &mut Vec<Duration>, mut pair: impl FnMut()) {
    for _ in 0..PAIRS {
        let start = Instant::now();
        pair();
        times.push(start.elapsed());
    }
}

fn bare_pair(port: &mut File) {
    port.write_all(&REQUEST).unwrap();
    let mut answer = [0; ANSWER.len()];
    port.read_exact(&mut answer).unwrap();
    assert_eq!(answer, ANSWER);
}

fn lane_pair(lane: &mut RealLane) {
    let now = lane.now();
    let request = Transmission::bytes(&REQUEST);
    let sent = lane.send(PortIndex(0), now, request).unwrap();
    let until = sent.end + Duration::from_secs(1);
    for _ in ANSWER {
        lane.receive(until).unwrap().unwrap();
    }
}

fn show(name: &str, mut times: Vec<Duration>) -> Duration {
    times.sort_unstable();
    let percentile = |percent: usize| times[times.len() * percent / 100];
    let us = |time: Duration| time.as_secs_f64() * 1e6;
    let (p50, p99) = (percentile(50), percentile(99));
    println!("{name:<20} {:8.1} us p50 {:8.1} us p99", us(p50), us(p99));
    p50
}

/// On the last processor that is allowed.
fn pin() {
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let allowed = status
        .lines()
        .find(|it| it.starts_with("Cpus_allowed_list"))
        .unwrap();
    let last = allowed.rsplit(['\t', ',', '-']).next().unwrap();
    let mut taskset = Command::new("taskset");
    let me = std::process::id().to_string();
    taskset.args(["-cp", last, &me]).stdout(Stdio::null());
    assert!(taskset.status().unwrap().success());
}
