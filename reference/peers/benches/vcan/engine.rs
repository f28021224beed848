//! What the whole engine does: a case that repeats `sdo-read`, each frame evidence, each response time judged.

use std::io::{BufWriter, Write};
use std::sync::atomic::AtomicBool;

use fieldproof_link::real::{NoStimuli, RealLane, SocketCan};
use fieldproof_record::{Event, Journal, Sink};
use fieldproof_run::{Bench, LaneJob, play_lane};
use fieldproof_suite::{SourceFile, load, load_device};

/// What server and client are: nothing that makes the engine do more than the case says.
const DEVICE: &str = "\
language: 1
device: bench-server
title: A server that answers at once
sources:
  none: {document: None}
ports:
  can: {can: 1 Mbit/s}
canopen: {node: 1, eds: none.eds}
features: [sdo-server, sdo-segmented, sdo-block]
";

/// How large the large object is, in bytes.
const LARGE_SIZE: f64 = 10_000.0;

/// A read, how many of them take about a second, and what each is worth.
struct Read {
    name: &'static str,
    step: &'static str,
    times_a_second: f64,
    worth: f64,
}

const READS: [Read; 3] = [
    Read {
        name: "fieldproof",
        step: "{object: \"1000:00\", as: u32, expect: 0x000F0191}",
        times_a_second: 10_000.0,
        worth: 1.0,
    },
    Read {
        name: "fieldproof-segmented",
        step: "{object: \"2000:00\", as: text}",
        times_a_second: 8.0,
        worth: LARGE_SIZE,
    },
    Read {
        name: "fieldproof-block",
        step: "{object: \"2000:00\", as: bytes, transfer: block}",
        times_a_second: 20.0,
        worth: LARGE_SIZE,
    },
];

/// Prints the rate of each.
pub(crate) fn measure(interface: &str, seconds: f64) {
    for read in READS {
        let times = (read.times_a_second * seconds).max(1.0);
        let took = play(interface, &read, times as u32);
        println!("{} {:.0}", read.name, times.floor() * read.worth / took);
    }
}

/// Plays the case; how many seconds passed between the first frame and the last.
fn play(interface: &str, read: &Read, times: u32) -> f64 {
    let text = format!(
        "language: 1\nsuite: bench\ntitle: Reads\nprotocol: canopen\nsources:\n  none: {{document: None}}\ncases:\n\
         \x20 - case: read\n    title: Reads\n    cite: none\n    steps:\n\
         \x20     - repeat: {{times: {times}, steps: [{{sdo-read: {}}}]}}\n",
        read.step
    );
    let file = |path: &str, text: &str| SourceFile {
        path: path.into(),
        text: text.into(),
    };
    let loaded = load(&[file("bench.yaml", &text)]);
    assert!(loaded.diagnostics.is_empty(), "{:#?}", loaded.diagnostics);
    let device = load_device(&file("device.yaml", DEVICE)).unwrap();
    let bench = Bench {
        depth: fieldproof_suite::model::Depth::Default,
        fixed_rates: Default::default(),
        ports: ["can".to_owned()].into(),
        modbus_tcp: [].into(),
        streams: [].into(),
        stimuli: [].into(),
        permits: [].into(),
        node: Some(1),
        address: None,
    };
    let job = LaneJob {
        tool: "bench",
        name: "bench",
        device: &device,
        dictionary: None,
        bench: &bench,
        suites: &loaded.suites,
        selects: &|_| true,
        strict: false,
        inspects_device: false,
        explains: false,
        fault: None,
        variant: None,
        seed: 0,
    };
    let port = SocketCan::open("can", interface, 1_000_000, None).unwrap();
    let mut lane = RealLane::new(vec![Box::new(port)], Box::new(NoStimuli));
    let mut sink = Timed {
        journal: Journal::new(BufWriter::new(tempfile::tempfile().unwrap()), 0),
        first_ns: None,
        last_ns: 0,
    };
    let outcome = play_lane(&job, &mut lane, &mut sink, &AtomicBool::new(false));
    assert_eq!(outcome.counts.pass, 1);
    let first_ns = sink.first_ns.unwrap();
    let took = (sink.last_ns - first_ns) as f64 * 1e-9;
    sink.journal.finish().unwrap();
    took
}

/// A journal, and the instants of the first frame and the last: the end of a case waits for answers too many, which is
/// no part of a read.
struct Timed<W: Write> {
    journal: Journal<W>,
    first_ns: Option<u64>,
    last_ns: u64,
}

impl<W: Write> Sink for Timed<W> {
    fn emit(&mut self, event: Event) {
        if let Event::Frame(frame) = &event {
            self.first_ns.get_or_insert(frame.at_ns);
            self.last_ns = frame.at_ns;
        }
        self.journal.emit(event);
    }
}
