//! `fieldproof bus`: two programs share a bus, and Ctrl-C ends it.

#![allow(clippy::unwrap_used)]

mod support;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, ChildStdout, Command, Stdio};

use fieldproof_link::real::Slcan;
use support::Folder;

/// Interrupted when the test is over, however it ends.
struct RunningBus(Child);

impl Drop for RunningBus {
    fn drop(&mut self) {
        let _ = self.0.kill();
    }
}

fn start(arguments: &[&str]) -> (RunningBus, BufReader<ChildStdout>) {
    let mut command = Folder::new().command(arguments);
    let mut child = command
        .current_dir("/")
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let out = BufReader::new(child.stdout.take().unwrap());
    (RunningBus(child), out)
}

/// What follows `slcan:` in the next line.
fn target(out: &mut impl BufRead) -> String {
    let mut line = String::new();
    out.read_line(&mut line).unwrap();
    line.trim_end().strip_prefix("slcan:").unwrap().to_owned()
}

#[test]
fn programs_share_it_until_it_is_interrupted() {
    let (mut bus, mut out) = start(&["bus", "--tcp", "127.0.0.1:0", "--pty", "1"]);
    let address = target(&mut out);
    let terminal = target(&mut out);
    // Both are links of ours.
    for target in [&address, &terminal] {
        Slcan::open("can", target, 125_000, None).unwrap();
    }
    let address = address.strip_prefix("tcp://").unwrap();
    let [mut first, mut second] = [(); 2].map(|()| TcpStream::connect(address).unwrap());
    second.write_all(b"O\r").unwrap();
    let mut came = [0];
    second.read_exact(&mut came).unwrap();
    first.write_all(b"O\rt60A140\r").unwrap();
    let mut came = [0; 8];
    second.read_exact(&mut came).unwrap();
    assert_eq!(came, *b"t60A140\r");

    let interrupted = Command::new("kill")
        .args(["-INT", &bus.0.id().to_string()])
        .status();
    assert!(interrupted.unwrap().success());
    assert_eq!(bus.0.wait().unwrap().code(), Some(0));
    let mut rest = String::new();
    out.read_to_string(&mut rest).unwrap();
    assert_eq!(rest, "");
}

#[test]
fn an_address_that_is_taken_is_a_broken_bench() {
    let (_bus, mut out) = start(&["bus", "--tcp", "127.0.0.1:0"]);
    let target = target(&mut out);
    let address = target.strip_prefix("tcp://").unwrap();
    let ran = Folder::new().run(&["bus", "--tcp", address]);
    assert_eq!(ran.exit(), Some(3));
    let error = ran.error();
    assert!(
        error.contains(&format!("{target}: Address already in use")),
        "{error}"
    );
}
