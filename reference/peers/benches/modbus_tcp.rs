//! Reads of one register a second over Modbus TCP on the loopback, by four clients against the same server, all on one
//! processor: a bare pair of sockets, which is the limit; our engine, each event written to a journal; tokio-modbus; and
//! libmodbus, where a C compiler and `libmodbus-dev` are installed. The server is a process of its own.
//!
//! Only the ratios within one run mean something.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // A bench that cannot go on has nothing to report.

use std::io::{BufRead, BufReader, BufWriter, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use fieldproof_link::Framing;
use fieldproof_link::real::{NoStimuli, RealLane, Tcp};
use fieldproof_record::Journal;
use fieldproof_run::{Bench, LaneJob, play_lane};
use fieldproof_suite::{SourceFile, Suite, load, load_device};
use nix::sched::{CpuSet, sched_setaffinity};
use nix::unistd::Pid;
use tempfile::TempPath;
use tokio_modbus::Slave;
use tokio_modbus::client::{Reader as _, tcp};

/// Reads in one measurement.
const READS: u32 = 20_000;

/// How often each client is measured, in turn.
const ROUNDS: usize = 7;

const REQUEST: [u8; 12] = [0, 1, 0, 0, 0, 6, 1, 3, 0, 0, 0, 1];

fn main() {
    if std::env::args().nth(1).as_deref() == Some("serve") {
        answer_everything();
        return;
    }
    pin();
    let mut server = start_server();
    let address = server.address;
    let libmodbus = libmodbus_client();
    let suites = suites();
    let mut clients: Vec<Client<'_>> = vec![
        ("bare sockets", Box::new(|| bare(address))),
        (
            "fieldproof, with a journal",
            Box::new(|| engine(address, &suites)),
        ),
        ("tokio-modbus", Box::new(|| tokio_modbus(address))),
    ];
    match &libmodbus {
        Ok(program) => {
            clients.push(("libmodbus", Box::new(|| libmodbus_reads(program, address))));
        }
        Err(why) => println!("libmodbus is left out: {why}"),
    }
    measure(&mut clients);
    drop(clients);
    let _ = server.process.kill();
    let _ = server.process.wait();
}

/// A name, and what makes [`READS`] reads and says how long they took.
type Client<'a> = (&'static str, Box<dyn FnMut() -> Duration + 'a>);

/// All of them take turns, so that what disturbs one disturbs the others.
fn measure(clients: &mut [Client<'_>]) {
    let mut rates: Vec<Vec<f64>> = vec![Vec::new(); clients.len()];
    for _ in 0..ROUNDS {
        for ((_, client), rates) in clients.iter_mut().zip(&mut rates) {
            rates.push(f64::from(READS) / client().as_secs_f64());
        }
    }
    let medians: Vec<f64> = rates.iter_mut().map(|rates| median(rates)).collect();
    println!("{:<28} {:>10} {:>8}", "client", "reads/s", "ratio");
    for ((name, _), rate) in clients.iter().zip(&medians) {
        println!("{name:<28} {rate:>10.0} {:>8.2}", rate / medians[0]);
    }
    if let [_, ours, _, libmodbus] = medians.as_slice() {
        println!("fieldproof is {:.2} times libmodbus", ours / libmodbus);
    }
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Keeps this process and its children on one processor, where the system lets it.
fn pin() {
    let mut processors = CpuSet::new();
    let pinned = processors
        .set(0)
        .and_then(|()| sched_setaffinity(Pid::from_raw(0), &processors));
    if let Err(error) = pinned {
        println!("not pinned to one processor: {error}");
    }
}

struct Server {
    process: Child,
    address: SocketAddr,
}

fn start_server() -> Server {
    let mut process = Command::new(std::env::current_exe().unwrap())
        .arg("serve")
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut line = String::new();
    let stdout = process.stdout.take().unwrap();
    BufReader::new(stdout).read_line(&mut line).unwrap();
    let address = line.trim().parse().unwrap();
    Server { process, address }
}

/// The server: one connection after the other, every request answered by one register.
fn answer_everything() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    println!("{}", listener.local_addr().unwrap());
    loop {
        let (mut stream, _) = listener.accept().unwrap();
        stream.set_nodelay(true).unwrap();
        let mut request = [0; 12];
        while stream.read_exact(&mut request).is_ok() {
            let [high, low, _, _, _, _, unit, function, ..] = request;
            let answer = [high, low, 0, 0, 0, 5, unit, function, 2, 0x0F, 0xB4];
            if stream.write_all(&answer).is_err() {
                break;
            }
        }
    }
}

fn bare(address: SocketAddr) -> Duration {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_nodelay(true).unwrap();
    let mut answer = [0; 11];
    let started = Instant::now();
    for _ in 0..READS {
        stream.write_all(&REQUEST).unwrap();
        stream.read_exact(&mut answer).unwrap();
    }
    started.elapsed()
}

fn tokio_modbus(address: SocketAddr) -> Duration {
    let mut builder = tokio::runtime::Builder::new_current_thread();
    builder.enable_all().build().unwrap().block_on(async move {
        let mut client = tcp::connect_slave(address, Slave(1)).await.unwrap();
        let started = Instant::now();
        for _ in 0..READS {
            client.read_holding_registers(0, 1).await.unwrap().unwrap();
        }
        started.elapsed()
    })
}

fn suites() -> Vec<Suite> {
    let text = format!(
        "language: 1\nsuite: bench\ntitle: Reads\nprotocol: modbus\nsources:\n  book: {{document: A book}}\ncases:\n\
         \x20 - case: reads\n    title: Reads one register\n    cite: [book]\n    steps:\n\
         \x20     - repeat:\n          times: {READS}\n          steps:\n\
         \x20           - modbus: {{read-holding: {{address: 0, count: 1}}, expect: {{registers: [0x0FB4]}}}}\n"
    );
    let loaded = load(&[SourceFile {
        path: "bench.yaml".into(),
        text,
    }]);
    assert!(loaded.diagnostics.is_empty(), "{:#?}", loaded.diagnostics);
    loaded.suites
}

fn engine(address: SocketAddr, suites: &[Suite]) -> Duration {
    let path = "fixtures/devices/liaomiao-encoder/device.yaml";
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let device = load_device(&SourceFile {
        path: path.into(),
        text: std::fs::read_to_string(root.join(path)).unwrap(),
    });
    let device = device.unwrap();
    let wait = Duration::from_secs(2);
    let port = Tcp::open(
        "serial",
        &address.to_string(),
        Framing::ModbusTcp,
        wait,
        None,
    )
    .unwrap();
    let mut lane = RealLane::new(vec![Box::new(port)], Box::new(NoStimuli));
    let bench = Bench {
        depth: fieldproof_suite::model::Depth::Default,
        fixed_rates: Default::default(),
        ports: ["serial".to_owned()].into(),
        modbus_tcp: ["serial".to_owned()].into(),
        streams: ["serial".to_owned()].into(),
        stimuli: [].into(),
        permits: [].into(),
        node: None,
        address: Some(1),
    };
    let job = LaneJob {
        tool: "bench",
        name: "bench",
        device: &device,
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
    let mut journal = Journal::new(BufWriter::new(tempfile::tempfile().unwrap()), 0);
    let started = Instant::now();
    let outcome = play_lane(&job, &mut lane, &mut journal, &AtomicBool::new(false));
    let took = started.elapsed();
    assert_eq!(outcome.counts.pass, 1);
    took
}

fn libmodbus_reads(program: &Path, address: SocketAddr) -> Duration {
    let output = Command::new(program)
        .args([
            address.ip().to_string(),
            address.port().to_string(),
            READS.to_string(),
        ])
        .output()
        .unwrap();
    let seconds = String::from_utf8_lossy(&output.stdout).trim().parse();
    Duration::from_secs_f64(seconds.unwrap())
}

/// Compiles the client in C.
fn libmodbus_client() -> Result<TempPath, String> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/libmodbus_client.c");
    let program = tempfile::NamedTempFile::new().unwrap().into_temp_path();
    let compiled = Command::new("cc")
        .arg("-O2")
        .arg("-o")
        .arg(&program)
        .arg(source)
        .arg("-lmodbus")
        .output();
    match compiled {
        Ok(output) if output.status.success() => Ok(program),
        Ok(_) => Err("it needs libmodbus-dev".into()),
        Err(error) => Err(format!("no C compiler: {error}")),
    }
}
