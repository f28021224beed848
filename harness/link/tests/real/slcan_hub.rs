//! A hub in a thread of its own, and what it does as an adapter: byte by byte.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::Arc;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

use fieldproof_link::real::{Hub, HubOptions};

/// Carries frames until it is dropped.
pub(crate) struct RunningHub {
    addresses: Vec<String>,
    stop: Arc<AtomicBool>,
    notices: Arc<Mutex<Vec<String>>>,
    thread: Option<JoinHandle<()>>,
}

impl RunningHub {
    pub(crate) fn start(terminals: usize, paced: bool) -> RunningHub {
        let mut hub = Hub::listen(&HubOptions {
            tcp: Some("127.0.0.1:0".parse().unwrap()),
            terminals,
            bit_rate: 125_000,
            paced,
        })
        .unwrap();
        let addresses = hub.addresses().to_vec();
        let stop = Arc::new(AtomicBool::new(false));
        let notices = Arc::new(Mutex::new(Vec::new()));
        let (stopped, told) = (stop.clone(), notices.clone());
        let thread = std::thread::spawn(move || {
            hub.run(&stopped, |notice| {
                told.lock().unwrap().push(notice.to_owned());
            })
            .unwrap();
        });
        RunningHub {
            addresses,
            stop,
            notices,
            thread: Some(thread),
        }
    }

    /// The TCP address, `tcp://127.0.0.1:29536`.
    pub(crate) fn tcp(&self) -> &str {
        &self.addresses[0]
    }

    /// The path of a pseudo-terminal.
    pub(crate) fn terminal(&self, number: usize) -> &str {
        &self.addresses[1 + number]
    }

    /// A client that says exactly what the test says.
    pub(crate) fn host(&self) -> Host {
        let address = self.tcp().trim_start_matches("tcp://");
        let stream = TcpStream::connect(address).unwrap();
        stream.set_nodelay(true).unwrap();
        stream
            .set_read_timeout(Some(Duration::from_secs(10)))
            .unwrap();
        Host(stream)
    }
}

impl Drop for RunningHub {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        let joined = self.thread.take().unwrap().join();
        assert!(joined.is_ok() || std::thread::panicking());
    }
}

pub(crate) struct Host(TcpStream);

impl Host {
    fn say(&mut self, bytes: &[u8]) {
        self.0.write_all(bytes).unwrap();
    }

    /// Expects exactly these bytes next.
    fn hear(&mut self, expected: &str) {
        let mut came = vec![0; expected.len()];
        self.0.read_exact(&mut came).unwrap();
        assert_eq!(String::from_utf8_lossy(&came), expected);
    }

    fn ask(&mut self, bytes: &[u8], expected: &str) {
        self.say(bytes);
        self.hear(expected);
    }
}

#[test]
fn it_answers_as_an_adapter() {
    let hub = RunningHub::start(0, false);
    let mut host = hub.host();
    host.ask(b"\r\r", "\r\r");
    host.ask(b"C\r", "\x07");
    host.ask(b"V\r", "V1013\r");
    host.ask(b"N\r", "NFPB0\r");
    // Only an open channel has a status and sends frames.
    host.ask(b"F\r", "\x07");
    host.ask(b"t1230\r", "\x07");
    host.ask(b"S6\rO\r", "\r\r");
    host.ask(b"S6\r", "\x07");
    host.ask(b"O\r", "\x07");
    host.ask(b"F\r", "F00\r");
    host.ask(b"t1230\r", "z\r");
    host.ask(b"T000001232AABB\r", "Z\r");
    host.ask(b"r1238\r", "z\r");
    host.ask(b"C\r", "\r");
    host.ask(b"L\r", "\r");
    host.ask(b"t1230\r", "\x07");
}

#[test]
fn garbage_is_refused_and_does_no_harm() {
    let hub = RunningHub::start(0, false);
    let mut host = hub.host();
    host.ask(b"O\r", "\r");
    host.ask(b"t12\xFF0\r", "\x07");
    host.ask(b"t1239\r", "\x07");
    host.ask(b"\x00\x01\xFE\r", "\x07");
    host.say(&[b'z'; 100_000]);
    host.ask(b"\r", "\x07");
    host.ask(b"t1230\r", "z\r");
}

#[test]
fn a_frame_goes_to_all_others_of_the_same_bit_rate() {
    let hub = RunningHub::start(0, false);
    let [mut sender, mut same, mut listener, mut other, mut closed] =
        [hub.host(), hub.host(), hub.host(), hub.host(), hub.host()];
    sender.ask(b"S6\rO\r", "\r\r");
    same.ask(b"s001C\rO\r", "\r\r");
    listener.ask(b"S6\rL\r", "\r\r");
    other.ask(b"S4\rO\r", "\r\r");
    closed.ask(b"S6\r", "\r");
    sender.ask(b"t6012AABB\r", "z\r");
    same.hear("t6012AABB\r");
    listener.hear("t6012AABB\r");
    // Nothing came before the answer.
    other.ask(b"V\r", "V1013\r");
    closed.ask(b"V\r", "V1013\r");
}

#[test]
fn the_frames_of_a_host_keep_their_order() {
    let hub = RunningHub::start(0, false);
    let (mut sender, mut receiver) = (hub.host(), hub.host());
    receiver.ask(b"O\r", "\r");
    // Lower identifiers do not overtake the frames of their own host, nor do other commands.
    sender.ask(b"O\rt7000\rt0800\rC\rt0810\r", "\rz\rz\r\r\x07");
    receiver.hear("t7000\rt0800\r");
}

#[test]
fn stamps_are_given_if_they_are_asked_for() {
    let hub = RunningHub::start(0, false);
    let (mut sender, mut receiver) = (hub.host(), hub.host());
    sender.ask(b"O\r", "\r");
    for (command, digits) in [(b"Z1\r", 4), (b"Z2\r", 8), (b"Z0\r", 0)] {
        receiver.ask(command, "\r");
        receiver.ask(b"O\r", "\r");
        sender.ask(b"t1231AA\r", "z\r");
        receiver.hear("t1231AA");
        let mut stamp = vec![0; digits + 1];
        receiver.0.read_exact(&mut stamp).unwrap();
        assert_eq!(stamp.pop(), Some(b'\r'));
        assert!(stamp.iter().all(u8::is_ascii_hexdigit), "{stamp:?}");
        receiver.ask(b"C\r", "\r");
    }
}

#[test]
fn frames_that_wait_go_by_their_identifier() {
    let hub = RunningHub::start(0, true);
    let (mut first, mut second, mut third) = (hub.host(), hub.host(), hub.host());
    for host in [&mut first, &mut second, &mut third] {
        host.ask(b"S0\rO\r", "\r\r");
    }
    // At 10 kbit/s these take a quarter of a second: time for the others to wait.
    let long = "t00081122334455667788\r".repeat(20);
    first.say(format!("{long}t3000\r").as_bytes());
    second.say(b"t2000\r");
    third.say(b"t1000\r");
    first.hear(&format!("{}t1000\rt2000\rz\r", "z\r".repeat(20)));
    second.hear(&format!("{long}t1000\rz\rt3000\r"));
    third.hear(&format!("{long}z\rt2000\rt3000\r"));
}

#[test]
fn paced_frames_take_their_bit_times() {
    let hub = RunningHub::start(0, true);
    let (mut sender, mut receiver) = (hub.host(), hub.host());
    sender.ask(b"S4\rO\r", "\r\r");
    receiver.ask(b"S4\rZ2\rO\r", "\r\r\r");
    sender.say(&b"t55585555555555555555\r".repeat(20));
    let mut stamps = Vec::new();
    for _ in 0..20 {
        receiver.hear("t55585555555555555555");
        let mut stamp = [0; 9];
        receiver.0.read_exact(&mut stamp).unwrap();
        let stamp = str::from_utf8(&stamp[..8]).unwrap();
        stamps.push(u32::from_str_radix(stamp, 16).unwrap());
    }
    let frame: fieldproof_can::Frame = "555#5555555555555555".parse().unwrap();
    let bits = frame.bits() + fieldproof_can::INTERMISSION_BITS;
    for pair in stamps.windows(2) {
        // 8 us a bit; the stamps are whole microseconds.
        assert!((pair[1] - pair[0]).abs_diff(8 * bits) <= 1, "{pair:?}");
    }
}

#[test]
fn a_client_that_disappears_takes_only_itself_along() {
    let hub = RunningHub::start(0, false);
    let (mut stays, mut leaves, mut sender) = (hub.host(), hub.host(), hub.host());
    for host in [&mut stays, &mut leaves, &mut sender] {
        host.ask(b"O\r", "\r");
    }
    leaves.say(b"t1110\r");
    drop(leaves);
    // What it said before still goes out.
    stays.hear("t1110\r");
    sender.hear("t1110\r");
    for _ in 0..100 {
        sender.ask(b"t2220\r", "z\r");
        stays.hear("t2220\r");
    }
}

#[test]
fn a_client_that_does_not_read_is_dropped() {
    let hub = RunningHub::start(0, false);
    let (mut sleeps, mut sender) = (hub.host(), hub.host());
    sleeps.ask(b"O\r", "\r");
    sender.ask(b"O\r", "\r");
    // What the system holds for a connection is some megabytes; then the hub holds one more.
    let burst = b"T1FFFFFFF81122334455667788\r".repeat(1000);
    let acknowledged = "Z\r".repeat(1000);
    let dropped = (0..1000).any(|_| {
        sender.ask(&burst, &acknowledged);
        !hub.notices.lock().unwrap().is_empty()
    });
    assert!(dropped);
    let notices = hub.notices.lock().unwrap().clone();
    assert_eq!(notices.len(), 1);
    assert!(
        notices[0].ends_with("is dropped: it does not read"),
        "{notices:?}"
    );
}
