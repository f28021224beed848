//! Expedited SDO reads through the whole engine: a case that repeats `sdo-read`, against a reference device on the
//! simulated bus; every request and answer is evidence, every response time is measured and judged.
//!
//! Targets: 1,000,000 reads a second with the evidence in memory, 300,000 with every event written to a journal.

#![allow(clippy::panic, reason = "a benchmark may fail this way")]

use std::io::BufWriter;
use std::sync::atomic::AtomicBool;

use divan::Bencher;
use divan::counter::ItemsCount;
use fieldproof_devices::{Settings, kind};
use fieldproof_link::sim::{Builder, SimLane};
use fieldproof_record::{Event, Journal, Sink};
use fieldproof_run::{Bench, LaneJob, play_lane};
use fieldproof_suite::device::DeviceDescription;
use fieldproof_suite::model::Depth;
use fieldproof_suite::{SourceFile, Suite, load, load_device};

const READS: usize = 20_000;
const DEVICE: &str = "kinco-servo";
const DESCRIPTION: &str = include_str!("../../../fixtures/devices/kinco-servo/device.yaml");

fn main() {
    divan::main();
}

fn suites() -> Vec<Suite> {
    let text = format!(
        "language: 1\nsuite: bench\ntitle: Reads\nprotocol: canopen\nsources:\n  none: {{document: None}}\ncases:\n\
         \x20 - case: read\n    title: Reads 1000h\n    cite: none\n    steps:\n\
         \x20     - repeat: {{times: {READS}, steps: [{{sdo-read: {{object: \"1000:00\", as: u32}}}}]}}\n"
    );
    let loaded = load(&[SourceFile {
        path: "bench.yaml".into(),
        text,
    }]);
    assert!(loaded.diagnostics.is_empty(), "{:?}", loaded.diagnostics);
    loaded.suites
}

fn description() -> DeviceDescription {
    let file = SourceFile {
        path: "device.yaml".into(),
        text: DESCRIPTION.into(),
    };
    match load_device(&file) {
        Ok(description) => description,
        Err(diagnostics) => panic!("{diagnostics:?}"),
    }
}

fn lane() -> SimLane {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    match kind(DEVICE).map(|kind| (kind.build)(&Settings::default())) {
        Some(Ok(device)) => builder.device(device, &[can]),
        _ => panic!("there is no {DEVICE}"),
    }
    builder.build()
}

/// Plays the case; gives back the sink.
fn play<S: Sink>(suites: &[Suite], device: &DeviceDescription, mut sink: S) -> S {
    let bench = Bench {
        fixed_rates: Default::default(),
        ports: ["can".to_owned()].into(),
        modbus_tcp: [].into(),
        streams: [].into(),
        stimuli: [].into(),
        permits: [].into(),
        depth: Depth::Default,
        node: Some(1),
        address: None,
    };
    let job = LaneJob {
        tool: "bench",
        name: DEVICE,
        device,
        dictionary: None,
        bench: &bench,
        suites,
        selects: &|_| true,
        strict: false,
        inspects_device: false,
        explains: false,
        fault: None,
        variant: None,
        seed: 0,
    };
    let outcome = play_lane(&job, &mut lane(), &mut sink, &AtomicBool::new(false));
    assert_eq!(outcome.counts.pass, 1);
    sink
}

#[divan::bench]
fn evidence_in_memory(bencher: Bencher) {
    let (suites, device) = (suites(), description());
    bencher
        .counter(ItemsCount::new(READS))
        .bench_local(|| play(&suites, &device, Vec::<Event>::new()));
}

#[divan::bench]
fn every_event_written_to_a_journal(bencher: Bencher) {
    let (suites, device) = (suites(), description());
    bencher.counter(ItemsCount::new(READS)).bench_local(|| {
        let Ok(file) = tempfile::tempfile() else {
            panic!("no temporary file")
        };
        play(&suites, &device, Journal::new(BufWriter::new(file), 0))
    });
}
