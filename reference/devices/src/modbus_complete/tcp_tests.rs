//! The slave over connections: bytes in at their instants, bytes out.

use std::time::Duration;

use fieldproof_link::{Character, Instant, Outbox, Participant, Reception, Transmission};

use super::KIND;
use crate::catalogue::Settings;
use crate::modbus::script::{hex, text};

/// A read of no registers, and its refusal, without transaction.
const READ: &str = "00 00 00 06 01 03 00 00 00 00";
const REFUSED: &str = "00 00 00 03 01 83 03";

struct Client {
    device: Box<dyn Participant>,
    now: Instant,
}

impl Client {
    fn new(fault: Option<&str>, variant: Option<&str>) -> Client {
        let settings = Settings {
            fault: fault.map(str::to_owned),
            variant: variant.map(str::to_owned),
            ..Settings::default()
        };
        let device = (KIND.build)(&settings).unwrap();
        let now = Instant::START;
        Client { device, now }
    }

    fn give(&mut self, port: usize, what: Reception) {
        self.device
            .receive(self.now, port, what, &mut Outbox::default());
    }

    /// Bytes that come at one instant, `milliseconds` after what was before.
    fn send(&mut self, port: usize, milliseconds: u64, bytes: &str) {
        self.now = self.now + Duration::from_millis(milliseconds);
        for byte in hex(bytes) {
            self.give(port, Reception::Character(Character::new(byte)));
        }
    }

    /// What it sends in the next hundred milliseconds: the port, and the bytes or the end.
    fn sent(&mut self) -> Vec<(usize, String)> {
        let until = self.now + Duration::from_millis(100);
        let mut sent = Vec::new();
        let mut out = Outbox::default();
        while let Some(at) = self.device.wake_at().filter(|at| *at <= until) {
            self.now = self.now.max(at);
            self.device.wake(self.now, &mut out);
            sent.extend(out.drain().map(|(port, what)| match what {
                Transmission::Characters(characters) => {
                    let bytes: Vec<u8> = characters.iter().map(|it| it.byte).collect();
                    (port, text(&bytes))
                }
                _ => (port, "end".to_owned()),
            }));
        }
        self.now = until;
        sent
    }
}

fn answer(port: usize, transaction: &str) -> (usize, String) {
    (port, format!("{transaction} {REFUSED}"))
}

#[test]
fn a_header_is_answered_with_its_like() {
    let mut client = Client::new(None, None);
    client.send(1, 1, &format!("12 34 {READ}"));
    assert_eq!(client.sent(), [answer(1, "12 34")]);
    client.send(1, 1, "00 01 00 00 00 06 FF 03 00 00 00 00");
    assert_eq!(
        client.sent(),
        [(1, "00 01 00 00 00 03 FF 83 03".to_owned())]
    );
}

#[test]
fn requests_come_in_pieces_and_together() {
    let mut client = Client::new(None, None);
    client.send(1, 1, "00 01 00 00 00 06 01");
    assert_eq!(client.sent(), []);
    client.send(1, 2_000, "03 00 00 00 00");
    assert_eq!(client.sent(), [answer(1, "00 01")]);
    client.send(1, 1, &format!("00 02 {READ} 00 03 {READ} 00 04"));
    assert_eq!(client.sent(), [answer(1, "00 02"), answer(1, "00 03")]);
    client.send(1, 1, READ);
    assert_eq!(client.sent(), [answer(1, "00 04")]);
}

#[test]
fn the_last_of_several_may_come_first() {
    let mut client = Client::new(None, Some("last-request-first"));
    client.send(1, 1, &format!("00 02 {READ} 00 03 {READ}"));
    assert_eq!(client.sent(), [answer(1, "00 03"), answer(1, "00 02")]);
}

#[test]
fn each_connection_has_its_own_beginning() {
    let mut client = Client::new(None, None);
    client.give(2, Reception::Connected);
    client.send(1, 1, "00 01 00 00");
    client.send(2, 1, &format!("00 02 {READ}"));
    assert_eq!(client.sent(), [answer(2, "00 02")]);
    client.send(1, 1, "00 06 01 03 00 00 00 00");
    client.send(2, 0, "00 03 00 00 00 06");
    client.give(2, Reception::Closed);
    assert_eq!(client.sent(), [answer(1, "00 01")]);
    client.give(2, Reception::Connected);
    client.send(2, 1, &format!("00 04 {READ}"));
    assert_eq!(client.sent(), [answer(2, "00 04")]);
    // Who has gone is not answered.
    client.send(2, 1, &format!("00 05 {READ}"));
    client.give(2, Reception::Closed);
    assert_eq!(client.sent(), []);
}

#[test]
fn a_header_that_is_none_is_thrown_away_or_ends_the_connection() {
    for header in [
        "00 01 00 01 00 06 01 03 00 00 00 00",
        "00 01 00 00 00 01 01",
        "00 01 00 00 00 FF 01 03",
    ] {
        let mut client = Client::new(None, None);
        client.send(1, 1, header);
        assert_eq!(client.sent(), [], "{header}");
        client.send(1, 1, &format!("00 02 {READ}"));
        assert_eq!(client.sent(), [answer(1, "00 02")], "{header}");
        let mut client = Client::new(None, Some("bad-header-closes"));
        client.send(1, 1, header);
        assert_eq!(client.sent(), [(1, "end".to_owned())], "{header}");
    }
}

#[test]
fn faults_show() {
    let twice = format!("00 01 {READ} 00 02 {READ}");
    let cases: [(&str, &str, &[&str]); 6] = [
        (
            "tcp-transaction-zero",
            &twice,
            &["00 00 00 00 00 03 01 83 03"; 2],
        ),
        (
            "tcp-length-without-unit",
            &format!("00 01 {READ}"),
            &["00 01 00 00 00 02 01 83 03"],
        ),
        (
            "tcp-unit-replaced",
            &format!("00 01 {READ}"),
            &["00 01 00 00 00 03 FF 83 03"],
        ),
        (
            "tcp-first-of-piece",
            &twice,
            &["00 01 00 00 00 03 01 83 03"],
        ),
        (
            "tcp-unit-0-unanswered",
            "00 01 00 00 00 06 00 03 00 00 00 00",
            &[],
        ),
        (
            "tcp-other-protocols",
            "00 01 00 07 00 06 01 03 00 00 00 00",
            &["00 01 00 00 00 03 01 83 03"],
        ),
    ];
    for (fault, request, answers) in cases {
        let mut client = Client::new(Some(fault), None);
        client.send(1, 1, request);
        let sent: Vec<String> = client.sent().into_iter().map(|(_, bytes)| bytes).collect();
        assert_eq!(sent, answers, "{fault}");
    }
}
