//! What is played, and on what.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use fieldproof_devices::{Settings, kind};
use fieldproof_link::real::serve::serve;
use fieldproof_link::real::{NoStimuli, Port, RealLane, Tcp, TcpServer};
use fieldproof_link::{Connected, Framing, Participant};
use fieldproof_record::{CaseFinished, Event};
use fieldproof_run::{Bench, Known, LaneJob, LaneOutcome, fill, play_lane};
use fieldproof_suite::device::DeviceDescription;
use fieldproof_suite::model::{Depth, Effect};
use fieldproof_suite::{SourceFile, Suite, load, load_device, load_registers};

/// What a run gave.
pub(crate) struct Played {
    pub(crate) outcome: LaneOutcome,
    pub(crate) events: Vec<Event>,
}

impl Played {
    pub(crate) fn cases(&self) -> Vec<&CaseFinished> {
        let finished = self.events.iter().filter_map(|event| match event {
            Event::CaseFinished(case) => Some(case.as_ref()),
            _ => None,
        });
        finished.collect()
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn source(path: &str) -> SourceFile {
    SourceFile {
        path: path.to_owned(),
        text: std::fs::read_to_string(root().join(path)).unwrap(),
    }
}

/// The description of a device that is shipped.
pub(crate) fn description(device: &str) -> DeviceDescription {
    load_device(&source(&format!("fixtures/devices/{device}/device.yaml"))).unwrap()
}

/// The suite of Modbus TCP.
pub(crate) fn tcp_suite() -> Vec<Suite> {
    let loaded = load(&[source("suites/modbus/tcp.yaml")]);
    assert!(loaded.diagnostics.is_empty(), "{:#?}", loaded.diagnostics);
    let device = "modbus-complete";
    let path = format!("fixtures/devices/{device}/registers.yaml");
    let registers = load_registers(&source(&path)).unwrap();
    let known = Known {
        registers: Some(&registers),
        ..Known::default()
    };
    let device = description(device);
    let filled = |suite| fill(suite, &device, known);
    loaded.suites.iter().map(filled).collect()
}

/// Every Modbus suite for a device that is shipped.
pub(crate) fn modbus_suites(device: &str) -> Vec<Suite> {
    let files = [
        source("suites/modbus/crc.yaml"),
        source("suites/modbus/exceptions.yaml"),
        source("suites/modbus/framing.yaml"),
        source(&format!("suites/devices/{device}/modbus.yaml")),
    ];
    let loaded = load(&files);
    assert!(loaded.diagnostics.is_empty(), "{:#?}", loaded.diagnostics);
    let path = format!("fixtures/devices/{device}/registers.yaml");
    let registers = load_registers(&source(&path)).unwrap();
    let known = Known {
        registers: Some(&registers),
        ..Known::default()
    };
    let device = description(device);
    let filled = |suite| fill(suite, &device, known);
    loaded.suites.iter().map(filled).collect()
}

/// The cases of a suite in words.
pub(crate) fn suites_of(cases: &str) -> Vec<Suite> {
    let head = "language: 1\nsuite: test\ntitle: A test\nprotocol: modbus\nsources:\n  book: {document: A book}\ncases:\n";
    let loaded = load(&[SourceFile {
        path: "test.yaml".into(),
        text: format!("{head}{cases}"),
    }]);
    assert!(loaded.diagnostics.is_empty(), "{:#?}", loaded.diagnostics);
    loaded.suites
}

/// A reference device on a TCP port of its own, until it is dropped.
pub(crate) struct Served {
    pub(crate) host_port: String,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Served {
    /// Serves the serial port of a device.
    pub(crate) fn start(device: &str, framing: Framing) -> Served {
        let kind = kind(device).unwrap();
        let settings = Settings {
            framing: Some(framing),
            ..Settings::default()
        };
        let participant = (kind.build)(&settings).unwrap();
        let serial = kind.ports.iter().position(|port| port.role == "serial");
        let server = TcpServer::listen("serial", "127.0.0.1:0", framing).unwrap();
        let ports: Vec<Box<dyn Port>> = Vec::new();
        Served::serve(participant, server, ports, vec![serial.unwrap()])
    }

    /// Serves the port of Modbus TCP that a device has, on several connections at once.
    pub(crate) fn start_with_connections(device: &str) -> Served {
        let kind = kind(device).unwrap();
        let participant = (kind.build)(&Settings::default()).unwrap();
        let tcp = kind.ports.iter().position(|port| port.role == "tcp");
        let server = TcpServer::listen("tcp", "127.0.0.1:0", Framing::ModbusTcp).unwrap();
        let further = (0..7).map(|_| Box::new(server.beside().unwrap()) as Box<dyn Port>);
        let further: Vec<Box<dyn Port>> = further.collect();
        let behind = kind.ports.len();
        let numbers = std::iter::once(tcp.unwrap()).chain(behind..behind + further.len());
        Served::serve(participant, server, further, numbers.collect())
    }

    fn serve(
        participant: Box<dyn Participant>,
        server: TcpServer,
        further: Vec<Box<dyn Port>>,
        numbers: Vec<usize>,
    ) -> Served {
        let connected = Connected::new(participant, numbers);
        let host_port = server.address().to_string();
        let stop = Arc::new(AtomicBool::new(false));
        let told = Arc::clone(&stop);
        let thread = thread::spawn(move || {
            let first: Box<dyn Port> = Box::new(server);
            let ports = std::iter::once(first).chain(further).collect();
            serve(Box::new(connected), ports, &mut (), &told).unwrap();
        });
        Served {
            host_port,
            stop,
            thread: Some(thread),
        }
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let ended = thread.join();
            assert!(ended.is_ok() || thread::panicking(), "the server failed");
        }
    }
}

/// Plays suites on whatever listens there; everything is permitted.
pub(crate) fn play(
    host_port: &str,
    framing: Framing,
    device: &DeviceDescription,
    suites: &[Suite],
) -> Played {
    let port = Tcp::open("serial", host_port, framing, Duration::from_secs(2), None).unwrap();
    let mut lane = RealLane::new(vec![Box::new(port)], Box::new(NoStimuli));
    let is_tcp = framing == Framing::ModbusTcp;
    let bench = Bench {
        fixed_rates: ["serial".to_owned()].into(),
        ports: ["serial".to_owned()].into(),
        modbus_tcp: is_tcp.then(|| "serial".to_owned()).into_iter().collect(),
        streams: ["serial".to_owned()].into(),
        stimuli: [].into(),
        depth: Depth::Default,
        permits: [
            Effect::Writes,
            Effect::Persists,
            Effect::Readdresses,
            Effect::Moves,
            Effect::Resets,
            Effect::DisturbsBus,
        ]
        .into(),
        node: None,
        address: device.modbus.as_ref().map(|modbus| modbus.address),
    };
    let job = LaneJob {
        tool: "test",
        name: "served",
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
    let mut events = Vec::new();
    let outcome = play_lane(&job, &mut lane, &mut events, &AtomicBool::new(false));
    Played { outcome, events }
}
