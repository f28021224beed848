//! Our client on SocketCAN; `benches/vcan/run` builds it and runs it beside others:
//!
//!   vcan IFACE SECONDS               reads of node 1 through the whole engine, every event written to a journal: prints
//!                                    expedited reads a second, then bytes a second of what is longer
//!   vcan receive FRAMES IFACE...     takes numbered frames from all interfaces at once, through one lane, until each
//!                                    has brought so many: prints how many came and how many numbers were missing

#![allow(clippy::unwrap_used, clippy::print_stdout)] // A bench that cannot go on has nothing to report.

mod engine;
mod receive;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments.as_slice() {
        ["receive", frames, interfaces @ ..] => receive::count(frames.parse().unwrap(), interfaces),
        [interface, seconds] => engine::measure(interface, seconds.parse().unwrap()),
        // `cargo bench` alone: there is no bus.
        _ => println!("run by benches/vcan/run"),
    }
}
