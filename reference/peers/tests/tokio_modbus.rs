//! tokio-modbus: its server against our engine, its client against our reference device.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a test may fail this way"
)]

use std::collections::BTreeMap;
use std::fs::File;
use std::future::{Ready, ready};
use std::net::SocketAddr;
use std::os::fd::OwnedFd;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use fieldproof_devices::{Settings, kind};
use fieldproof_link::real::serve::serve;
use fieldproof_link::real::{NoStimuli, Port, RealLane, Serial, SerialOptions, Tcp, TcpServer};
use fieldproof_link::{Connected, Framing, Line, Parity, SerialSettings, StopBits};
use fieldproof_record::{Event, Verdict, VerdictCounts};
use fieldproof_run::{Bench, Known, LaneJob, fill, play_lane};
use fieldproof_suite::device::{Deviation, DeviceDescription, Feature};
use fieldproof_suite::model::{Depth, Effect};
use fieldproof_suite::{SourceFile, Suite, load, load_device};
use nix::pty::openpty;
use nix::sys::termios::{SetArg, cfmakeraw, tcgetattr, tcsetattr};
use nix::unistd::ttyname;
use tokio::net::TcpListener;
use tokio_modbus::client::{Reader as _, Writer as _, tcp};
use tokio_modbus::server::tcp::{Server, accept_tcp_connection};
use tokio_modbus::server::{Service, rtu};
use tokio_modbus::{ExceptionCode, Request, Response, Slave};

/// Sixteen registers that can be read and written.
#[derive(Clone)]
struct Registers(Arc<Mutex<BTreeMap<u16, u16>>>);

impl Registers {
    fn new() -> Registers {
        Registers(Arc::new(Mutex::new(
            (0..16).map(|it| (it, 100 + it)).collect(),
        )))
    }

    fn answer(&self, request: Request<'static>) -> Result<Response, ExceptionCode> {
        let mut registers = self.0.lock().unwrap();
        match request {
            Request::ReadHoldingRegisters(_, count) if !(1..=125).contains(&count) => {
                Err(ExceptionCode::IllegalDataValue)
            }
            Request::ReadHoldingRegisters(first, count) => {
                let read = (0..count).map(|it| registers.get(&first.checked_add(it)?).copied());
                let read: Option<Vec<u16>> = read.collect();
                let read = read.ok_or(ExceptionCode::IllegalDataAddress)?;
                Ok(Response::ReadHoldingRegisters(read))
            }
            Request::WriteSingleRegister(register, value) => {
                let held = registers.get_mut(&register);
                *held.ok_or(ExceptionCode::IllegalDataAddress)? = value;
                Ok(Response::WriteSingleRegister(register, value))
            }
            Request::WriteMultipleRegisters(_, values) if !(1..=123).contains(&values.len()) => {
                Err(ExceptionCode::IllegalDataValue)
            }
            Request::WriteMultipleRegisters(first, values) => {
                let last = usize::from(first) + values.len() - 1;
                if last > usize::from(u16::MAX) {
                    return Err(ExceptionCode::IllegalDataAddress);
                }
                for (register, value) in (first..=u16::MAX).zip(values.iter()) {
                    let held = registers.get_mut(&register);
                    *held.ok_or(ExceptionCode::IllegalDataAddress)? = *value;
                }
                Ok(Response::WriteMultipleRegisters(first, values.len() as u16))
            }
            _ => Err(ExceptionCode::IllegalFunction),
        }
    }
}

impl Service for Registers {
    type Request = Request<'static>;
    type Response = Response;
    type Exception = ExceptionCode;
    type Future = Ready<Result<Response, ExceptionCode>>;

    fn call(&self, request: Request<'static>) -> Self::Future {
        ready(self.answer(request))
    }
}

fn runtime() -> tokio::runtime::Runtime {
    let mut builder = tokio::runtime::Builder::new_current_thread();
    builder.enable_all().build().unwrap()
}

/// Starts a server of tokio-modbus in a thread that ends with the test program.
fn start_server() -> SocketAddr {
    let (tell, told) = std::sync::mpsc::channel();
    thread::spawn(move || {
        runtime().block_on(async move {
            let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
            tell.send(listener.local_addr().unwrap()).unwrap();
            let registers = Registers::new();
            let connected = |stream, address| {
                let registers = registers.clone();
                async move { accept_tcp_connection(stream, address, |_| Ok(Some(registers.clone()))) }
            };
            let server = Server::new(listener);
            server.serve(&connected, |_| {}).await.unwrap();
        });
    });
    told.recv().unwrap()
}

fn source(path: &str) -> SourceFile {
    let root: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    SourceFile {
        path: path.to_owned(),
        text: std::fs::read_to_string(root.join(path)).unwrap(),
    }
}

fn loaded(files: &[SourceFile]) -> Vec<Suite> {
    let loaded = load(files);
    assert!(loaded.diagnostics.is_empty(), "{:#?}", loaded.diagnostics);
    let device = plain_device(Feature::ModbusTcp);
    let filled = |suite| fill(suite, &device, Known::default());
    loaded.suites.iter().map(filled).collect()
}

/// A device that has this and promises nothing more.
fn plain_device(feature: Feature) -> DeviceDescription {
    let encoder = source("fixtures/devices/liaomiao-encoder/device.yaml");
    let mut device = load_device(&encoder).unwrap();
    device.device = "plain".into();
    device.deviates.clear();
    device.features = [feature].into_iter().collect();
    if let Some(modbus) = &mut device.modbus {
        modbus.connections = Some(16);
    }
    device
}

const READ_AND_WRITE: &str = "
language: 1
suite: plain
title: Reads and writes
protocol: modbus
sources:
  modbus: {document: MODBUS application protocol V1.1b3}
cases:
  - case: read
    title: Reads registers
    cite: [modbus]
    steps:
      - modbus: {read-holding: {address: 0, count: 16}}
      - modbus: {read-holding: {address: 3, count: 2}, expect: {registers: [103, 104]}}
  - case: write
    title: Writes registers, which are put back
    cite: [modbus]
    effects: [writes]
    steps:
      - modbus: {write-single: {address: 2, value: 7}}
      - modbus: {write-multiple: {address: 4, values: [8, 9]}}
      - modbus: {read-holding: {address: 2, count: 4}, expect: {registers: [7, 103, 8, 9]}}
  - case: put-back
    title: They are what they were
    cite: [modbus]
    steps:
      - modbus: {read-holding: {address: 2, count: 4}, expect: {registers: [102, 103, 104, 105]}}
  - case: no-such-register
    title: A register that is not there
    cite: [modbus]
    steps:
      - modbus: {read-holding: {address: 15, count: 2}, expect: {exception: illegal-data-address}}
";

#[test]
fn our_engine_and_its_server() {
    let address = start_server();
    let wait = Duration::from_secs(2);
    let port = Tcp::open(
        "serial",
        &address.to_string(),
        Framing::ModbusTcp,
        wait,
        None,
    )
    .unwrap();
    let counts = play_on(
        Box::new(port),
        plain_device(Feature::ModbusTcp),
        &["exceptions", "framing", "crc", "tcp"],
    );
    // The four above, and the exceptions.
    assert!(counts.pass >= 4 + 5, "{counts:?}");
}

/// One line of two pseudo-terminals with a wire between them: what the one name is written, the other reads.
fn line() -> (PathBuf, PathBuf) {
    let [one, two] = [(); 2].map(|()| {
        let pair = openpty(None, None).unwrap();
        let mut settings = tcgetattr(&pair.slave).unwrap();
        cfmakeraw(&mut settings);
        tcsetattr(&pair.slave, SetArg::TCSANOW, &settings).unwrap();
        pair
    });
    let names = (ttyname(&one.slave).unwrap(), ttyname(&two.slave).unwrap());
    let wire = |from: &OwnedFd, to: &OwnedFd| {
        let mut from = File::from(from.try_clone().unwrap());
        let mut to = File::from(to.try_clone().unwrap());
        thread::spawn(move || std::io::copy(&mut from, &mut to));
    };
    wire(&one.master, &two.master);
    wire(&two.master, &one.master);
    // Open at both ends until the test program ends, so that neither reads as closed.
    std::mem::forget((one, two));
    names
}

#[test]
fn our_engine_and_its_rtu_server_on_a_pseudo_terminal() {
    let (ours, its) = line();
    let (tell, told) = std::sync::mpsc::channel();
    thread::spawn(move || {
        runtime().block_on(async move {
            let server = rtu::Server::new_from_path(its, 9_600).unwrap();
            tell.send(()).unwrap();
            let _ = server.serve_forever(Registers::new()).await;
        });
    });
    told.recv().unwrap();
    let settings = SerialSettings {
        baud: 9_600,
        parity: Parity::None,
        stop_bits: StopBits::One,
    };
    let path = ours.to_str().unwrap();
    let port = Serial::open("serial", path, settings, SerialOptions::default()).unwrap();
    let mut device = plain_device(Feature::ModbusRtu);
    device.deviates = its_deviation();
    let counts = play_on(Box::new(port), device, &["exceptions"]);
    assert!(counts.pass >= 4 + 3, "{counts:?}");
    assert!(counts.deviation >= 1, "{counts:?}");
}

/// Its RTU server finds the end of a request by the function code (`codec/rtu.rs`, `get_request_pdu_len`), so that one with
/// a code it does not know never ends, and stays unanswered. The encoder has the same deviation.
fn its_deviation() -> Vec<Deviation> {
    let encoder = source("fixtures/devices/liaomiao-encoder/device.yaml");
    let mut deviates = load_device(&encoder).unwrap().deviates;
    deviates.retain(|it| it.check == "modbus.exception.unknown-function");
    assert_eq!(deviates.len(), 1);
    deviates
}

/// A byte count that does not fit the number of registers is an error of its codec: it ends the connection, or never answers
/// again on a line, where exception 03 is due.
const HANGS: [&str; 2] = [
    "modbus.exceptions/too-many-registers-to-write",
    "modbus.exceptions/quantity-comes-first[function=10]",
];

/// Plays the suite above and these of our Modbus suites; nothing may fail.
fn play_on(port: Box<dyn Port>, device: DeviceDescription, chapters: &[&str]) -> VerdictCounts {
    let is_tcp = matches!(port.properties().line, Line::Stream(_));
    let mut lane = RealLane::new(vec![port], Box::new(NoStimuli));
    let bench = Bench {
        depth: Depth::Default,
        // Bits take no time on either.
        fixed_rates: ["serial".to_owned()].into(),
        ports: ["serial".to_owned()].into(),
        modbus_tcp: is_tcp.then(|| "serial".to_owned()).into_iter().collect(),
        streams: is_tcp.then(|| "serial".to_owned()).into_iter().collect(),
        stimuli: [].into(),
        permits: [Effect::Writes, Effect::DisturbsBus].into(),
        node: None,
        address: Some(1),
    };
    let chapters = chapters
        .iter()
        .map(|it| source(&format!("suites/modbus/{it}.yaml")));
    let plain = SourceFile {
        path: "plain.yaml".into(),
        text: READ_AND_WRITE.to_owned(),
    };
    let suites = loaded(&std::iter::once(plain).chain(chapters).collect::<Vec<_>>());
    let job = LaneJob {
        tool: "test",
        name: "tokio-modbus",
        device: &device,
        dictionary: None,
        bench: &bench,
        suites: &suites,
        selects: &|id| !HANGS.iter().any(|case| id.starts_with(case)),
        strict: false,
        inspects_device: false,
        explains: false,
        fault: None,
        variant: None,
        seed: 0,
    };
    let mut events = Vec::new();
    let outcome = play_lane(&job, &mut lane, &mut events, &AtomicBool::new(false));
    let finished = events.iter().filter_map(|event| match event {
        Event::CaseFinished(case) => Some(case),
        _ => None,
    });
    let is_fine = |verdict| {
        matches!(
            verdict,
            Verdict::Pass | Verdict::Skipped | Verdict::Deviation
        )
    };
    let wrong: Vec<_> = finished
        .filter(|case| !is_fine(case.verdict))
        .map(|case| (&case.id, &case.failures))
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert_eq!(outcome.stopped, None);
    outcome.counts
}

#[test]
fn its_client_and_our_encoder() {
    let settings = Settings {
        framing: Some(Framing::ModbusTcp),
        ..Settings::default()
    };
    let encoder = kind("liaomiao-encoder").unwrap();
    let connected = Connected::new((encoder.build)(&settings).unwrap(), vec![1]);
    let server = TcpServer::listen("serial", "127.0.0.1:0", Framing::ModbusTcp).unwrap();
    let address = server.address();
    let stop = AtomicBool::new(false);
    thread::scope(|scope| {
        let served =
            scope.spawn(|| serve(Box::new(connected), vec![Box::new(server)], &mut (), &stop));
        let asked = scope.spawn(move || runtime().block_on(ask_encoder(address)));
        let asked = asked.join();
        stop.store(true, Ordering::Relaxed);
        served.join().unwrap().unwrap();
        asked.unwrap();
    });
}

async fn ask_encoder(address: SocketAddr) {
    let mut client = tcp::connect_slave(address, Slave(32)).await.unwrap();
    let own_address = client.read_holding_registers(1, 1).await.unwrap();
    assert_eq!(own_address, Ok(vec![32]));
    let before = client.read_holding_registers(14, 1).await.unwrap().unwrap();
    client.write_single_register(14, 5).await.unwrap().unwrap();
    assert_eq!(
        client.read_holding_registers(14, 1).await.unwrap(),
        Ok(vec![5])
    );
    client
        .write_multiple_registers(14, &before)
        .await
        .unwrap()
        .unwrap();
    assert_eq!(
        client.read_holding_registers(14, 1).await.unwrap(),
        Ok(before)
    );
    let hole = client.read_holding_registers(0xFFF0, 1).await.unwrap();
    assert_eq!(hole, Err(ExceptionCode::IllegalDataAddress));
}
