//! Serial ports, with the test on the other side of a pseudo-terminal.

use std::fs::File;
use std::io::{Read, Write};
use std::path::PathBuf;
use std::thread;
use std::time::Duration;

use fieldproof_link::real::{
    Clock, Departure, LocalEcho, News, NoStimuli, Port, RealLane, SendError, Serial, SerialOptions,
};
use fieldproof_link::{
    Character, Lane, Line, LinkError, Parity, PortIndex, Reception, SerialSettings, StopBits,
    Transmission,
};
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::pty::openpty;
use nix::sys::termios::{SetArg, cfmakeraw, tcgetattr, tcsetattr};

const SETTINGS: SerialSettings = SerialSettings {
    baud: 19_200,
    parity: Parity::Even,
    stop_bits: StopBits::One,
};

const SERIAL: PortIndex = PortIndex(0);

/// Longer than any of this takes.
const LONG: Duration = Duration::from_secs(10);

/// Read of register 0000h of slave 20h, and the answer 0FB4h.
const REQUEST: [u8; 8] = [0x20, 0x03, 0x00, 0x00, 0x00, 0x01, 0x82, 0xBB];
const ANSWER: [u8; 7] = [0x20, 0x03, 0x02, 0x0F, 0xB4, 0x01, 0xC4];

/// The other side of a pseudo-terminal, and the path of this side. Until this side is open the other reads an error.
fn pair() -> (File, PathBuf) {
    let pair = openpty(None, None).unwrap();
    let path = nix::unistd::ttyname(&pair.slave).unwrap();
    // Nothing of a terminal's ways, from the first byte on.
    let mut attributes = tcgetattr(&pair.slave).unwrap();
    cfmakeraw(&mut attributes);
    tcsetattr(&pair.slave, SetArg::TCSANOW, &attributes).unwrap();
    (File::from(pair.master), path)
}

fn open(path: &std::path::Path, echo: LocalEcho) -> Serial {
    let options = SerialOptions {
        echo,
        ..SerialOptions::default()
    };
    Serial::open("serial", path.to_str().unwrap(), SETTINGS, options).unwrap()
}

fn opened(echo: LocalEcho) -> (File, Serial, Clock) {
    let (other, path) = pair();
    let serial = open(&path, echo);
    (other, serial, Clock::start())
}

fn lane(serial: Serial) -> RealLane {
    RealLane::new(vec![Box::new(serial)], Box::new(NoStimuli))
}

fn wait(serial: &Serial) {
    let mut ports = [PollFd::new(serial.readable(), PollFlags::POLLIN)];
    let timeout = PollTimeout::try_from(LONG).unwrap();
    assert_eq!(poll(&mut ports, timeout), Ok(1), "nothing came");
}

/// Waits for `count` characters.
fn hear(serial: &mut Serial, clock: &mut Clock, count: usize) -> Result<Vec<News>, LinkError> {
    let mut news = Vec::new();
    while news.len() < count {
        wait(serial);
        serial.take(clock, &mut news)?;
    }
    Ok(news)
}

fn bytes(news: &[News]) -> Vec<u8> {
    let byte = |news: &News| match news {
        News::Arrived {
            what: Reception::Character(it),
            ..
        } => it.byte,
        other => panic!("{other:?}"),
    };
    news.iter().map(byte).collect()
}

fn hear_on(lane: &mut RealLane, count: usize) -> Vec<u8> {
    let until = lane.now() + LONG;
    let mut bytes = Vec::new();
    while bytes.len() < count {
        match lane.receive(until).unwrap().expect("no answer came").what {
            Reception::Character(character) => bytes.push(character.byte),
            other => panic!("{other:?}"),
        }
    }
    bytes
}

#[test]
fn a_pseudo_terminal_says_what_it_is() {
    let (_other, serial, _) = opened(LocalEcho::Auto);
    let properties = serial.properties();
    assert_eq!(properties.name, "serial");
    assert!(
        properties.link.starts_with("serial:/dev/pts/"),
        "{}",
        properties.link
    );
    assert_eq!(properties.line, Line::Serial(SETTINGS));
    assert_eq!(properties.timestamps, "user space (pseudo-terminal)");
    // Without bits, only this machine makes instants uncertain.
    assert_eq!(properties.uncertainty, Duration::from_millis(1));
    assert!(!properties.sets_bit_rate);
}

#[test]
fn an_uncertainty_that_is_known_better_is_taken() {
    let (_other, path) = pair();
    let uncertainty = Some(Duration::from_millis(5));
    let options = SerialOptions {
        uncertainty,
        ..SerialOptions::default()
    };
    let serial = Serial::open("serial", path.to_str().unwrap(), SETTINGS, options).unwrap();
    assert_eq!(Some(serial.properties().uncertainty), uncertainty);
}

#[test]
fn every_byte_goes_both_ways_as_it_is() {
    let (mut other, mut serial, mut clock) = opened(LocalEcho::Auto);
    let all: Vec<u8> = (0..=255).collect();
    serial.send(&mut clock, &Transmission::bytes(&all)).unwrap();
    let mut came = vec![0; all.len()];
    other.read_exact(&mut came).unwrap();
    assert_eq!(came, all);
    other.write_all(&all).unwrap();
    let news = hear(&mut serial, &mut clock, all.len()).unwrap();
    assert_eq!(bytes(&news), all);
}

#[test]
fn without_bit_times_a_transmission_leaves_at_once_and_all_that_is_read_together_came_together() {
    let (mut other, mut serial, mut clock) = opened(LocalEcho::Auto);
    let before = clock.now();
    let sent = serial.send(&mut clock, &Transmission::bytes(&REQUEST));
    let Ok(Departure::At(sent)) = sent else {
        panic!("{sent:?}");
    };
    assert!(before <= sent.start && sent.start <= sent.end && sent.end <= clock.now());
    other.write_all(&ANSWER).unwrap();
    wait(&serial);
    let mut news = Vec::new();
    serial.take(&mut clock, &mut news).unwrap();
    let instants = news.iter().map(|news| match news {
        News::Arrived { at, .. } => *at,
        News::Left(sent) => panic!("{sent:?}"),
    });
    let instants: Vec<_> = instants.collect();
    assert!(instants[0] > sent.end);
    assert!(instants.iter().all(|at| *at == instants[0]), "{instants:?}");
}

#[test]
fn a_slave_answers_on_a_lane_again_and_again() {
    let (mut other, path) = pair();
    let mut lane = lane(open(&path, LocalEcho::Auto));
    let slave = thread::spawn(move || {
        for _ in 0..3 {
            let mut request = [0; 8];
            other.read_exact(&mut request).unwrap();
            assert_eq!(request, REQUEST);
            other.write_all(&ANSWER).unwrap();
        }
        // Closing it would take back what has not been read.
        other
    });
    for _ in 0..3 {
        let now = lane.now();
        let sent = lane
            .send(SERIAL, now, Transmission::bytes(&REQUEST))
            .unwrap();
        assert!(sent.start >= now);
        assert_eq!(hear_on(&mut lane, ANSWER.len()), ANSWER);
    }
    slave.join().unwrap();
}

#[test]
fn an_echo_is_taken_out() {
    let (mut other, path) = pair();
    let mut lane = lane(open(&path, LocalEcho::Yes));
    let slave = thread::spawn(move || {
        for _ in 0..2 {
            let mut request = [0; 8];
            other.read_exact(&mut request).unwrap();
            other.write_all(&request).unwrap();
            other.write_all(&ANSWER).unwrap();
        }
        // Closing it would take back what has not been read.
        other
    });
    for _ in 0..2 {
        let now = lane.now();
        lane.send(SERIAL, now, Transmission::bytes(&REQUEST))
            .unwrap();
        assert_eq!(hear_on(&mut lane, ANSWER.len()), ANSWER);
    }
    slave.join().unwrap();
}

#[test]
fn an_answer_that_is_the_request_is_heard_where_nothing_echoes() {
    let (mut other, mut serial, mut clock) = opened(LocalEcho::Auto);
    serial
        .send(&mut clock, &Transmission::bytes(&REQUEST))
        .unwrap();
    other.write_all(&REQUEST).unwrap();
    let news = hear(&mut serial, &mut clock, REQUEST.len()).unwrap();
    assert_eq!(bytes(&news), REQUEST);
}

#[test]
fn something_else_in_the_place_of_an_echo_is_an_error_that_tells_what() {
    let (mut other, path) = pair();
    let mut lane = lane(open(&path, LocalEcho::Yes));
    let now = lane.now();
    lane.send(SERIAL, now, Transmission::bytes(&REQUEST))
        .unwrap();
    other.write_all(&ANSWER).unwrap();
    let until = lane.now() + LONG;
    let error = lane.receive(until).unwrap_err().to_string();
    let expected = "port serial is down: it sent 00 and heard 02 in its place";
    assert!(error.starts_with(expected), "{error}");
}

#[test]
fn the_other_side_closing_ends_the_lane() {
    let (mut other, path) = pair();
    let mut lane = lane(open(&path, LocalEcho::Auto));
    other.write_all(&ANSWER).unwrap();
    assert_eq!(hear_on(&mut lane, ANSWER.len()), ANSWER);
    drop(other);
    let until = lane.now() + LONG;
    let error = lane.receive(until).unwrap_err();
    let expected = "port serial is down: the other side of the pseudo-terminal has closed \
                    (EIO: I/O error)";
    assert_eq!(error.to_string(), expected);
    assert!(lane.now() < until, "it was waited for in vain");
    assert_eq!(lane.receive(until), Err(error));
    let now = lane.now();
    let sent = lane.send(SERIAL, now, Transmission::bytes(&REQUEST));
    assert!(matches!(sent, Err(LinkError::Down { .. })), "{sent:?}");
}

#[test]
fn nobody_reading_is_an_error_and_no_endless_wait() {
    let (_other, path) = pair();
    let mut lane = lane(open(&path, LocalEcho::Auto));
    let much = Transmission::bytes(&[0x55; 4096]);
    let failed = (0..1_000).find_map(|_| {
        let now = lane.now();
        lane.send(SERIAL, now, much.clone()).err()
    });
    let failed = failed.expect("it all went somewhere");
    assert!(
        matches!(
            failed,
            LinkError::Down { .. } | LinkError::NotAcknowledged { .. }
        ),
        "{failed}"
    );
}

#[test]
fn what_a_pseudo_terminal_cannot_carry_is_refused() {
    let (_other, mut serial, mut clock) = opened(LocalEcho::Auto);
    let wrong = LinkError::WrongKind {
        port: "serial".to_owned(),
    };
    let spoilt = Transmission::Characters(vec![Character {
        byte: 0x20,
        spoilt: true,
    }]);
    assert_eq!(
        serial.send(&mut clock, &spoilt),
        Err(SendError::Link(wrong.clone()))
    );
    let can = Line::Can { bit_rate: 500_000 };
    assert_eq!(serial.set_line(can), Err(wrong));
    let other_rate = SerialSettings {
        baud: 9_600,
        ..SETTINGS
    };
    let error = serial.set_line(Line::Serial(other_rate)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "port serial is down: a pseudo-terminal has no bit rate"
    );
}

#[test]
fn what_came_before_the_port_was_opened_is_forgotten() {
    let (mut other, path) = pair();
    other.write_all(&[0x99; 20]).unwrap();
    let mut serial = open(&path, LocalEcho::Auto);
    let mut clock = Clock::start();
    other.write_all(&ANSWER).unwrap();
    let news = hear(&mut serial, &mut clock, ANSWER.len()).unwrap();
    assert_eq!(bytes(&news), ANSWER);
}

#[test]
fn what_is_no_serial_port_cannot_be_opened() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let path = file.path().to_str().unwrap();
    for (path, baud, reason) in [
        (
            "/dev/pts/none",
            19_200,
            "No such file or directory (os error 2)",
        ),
        (path, 19_200, "it is not a serial port"),
        (path, 0, "a baud rate of 0 is none"),
    ] {
        let settings = SerialSettings { baud, ..SETTINGS };
        let opened = Serial::open("serial", path, settings, SerialOptions::default());
        let error = opened.map(|_| ()).unwrap_err();
        assert_eq!(error.link, format!("serial:{path}"));
        assert_eq!(error.reason, reason);
    }
}
