use std::time::Duration;

use fieldproof_link::{Character, Instant};
use proptest::prelude::*;

use super::script::{Script, hex, text};
use super::*;
use crate::huacheng_ssts1::registers::{DOCUMENTED, DriveRegisters};

fn drive() -> Script<DriveRegisters> {
    Script::new(DriveRegisters::default(), DOCUMENTED)
}

fn with_fault(name: &str) -> Script<DriveRegisters> {
    let fault = FAULTS.iter().find(|fault| fault.name == name).unwrap();
    let mut behaviour = crate::Behaviour {
        modbus: DOCUMENTED,
        ..crate::Behaviour::default()
    };
    (fault.apply)(&mut behaviour);
    assert_ne!(behaviour.modbus, DOCUMENTED, "{name} does nothing");
    Script::new(DriveRegisters::default(), behaviour.modbus)
}

#[test]
fn requests_that_are_not_built_right() {
    let mut drive = drive();
    for (request, answer) in [
        // No registers, and one more than fits.
        ("01 03 01 45 00 00", "01 83 02"),
        ("01 03 01 45 00 7E", "01 83 02"),
        ("01 10 01 45 00 00 00", "01 90 02"),
        // The byte count is not twice the quantity, or not what follows.
        ("01 10 01 45 00 02 03 00 01 00", "01 90 02"),
        ("01 10 01 45 00 02 04 00 01 00", "01 90 02"),
        ("01 10 01 45 00 01 02 00 01 00", "01 90 02"),
        ("01 10 01 45 00", "01 90 02"),
        // Too short, too long.
        ("01 03 01 45 00", "01 83 02"),
        ("01 06 01 45 00 01 00", "01 86 02"),
        // Beyond the last register there is.
        ("01 03 FF FF 00 02", "01 83 03"),
        ("01 10 FF FF 00 02 04 00 00 00 00", "01 90 03"),
        // Functions it does not have.
        ("01 01 00 00 00 01", "01 81 01"),
        ("01 2B 0E 01 00", "01 AB 01"),
        ("01 00", "01 80 01"),
        // Others' addresses, and no function at all.
        ("02 03 01 45 00 01", ""),
        ("FF 03 01 45 00 01", ""),
        ("01", ""),
        ("", ""),
    ] {
        drive.play_body(request, answer);
    }
    assert_eq!(drive.slave.registers(), &DriveRegisters::default());
}

#[test]
fn most_registers_in_one_request() {
    let mut drive = drive();
    // P324 to P355 are the longest row of registers there is: too many of them is an address problem, not a length one.
    drive.play_body("01 03 01 44 00 7D", "01 83 03");
    let answer = drive.ask("01 03 01 44 00 20").unwrap();
    assert_eq!(answer.bytes.len(), 3 + 64 + 2);
    let most = format!("01 10 01 44 00 7B F6 {}", "00 ".repeat(246));
    drive.play_body(&most, "01 90 03");
    let too_many = format!("01 10 01 44 00 7C F6 {}", "00 ".repeat(246));
    drive.play_body(&too_many, "01 90 02");
}

#[test]
fn broadcast_is_obeyed_in_silence() {
    let mut drive = drive();
    drive.play_body("00 06 01 45 03 E8", "");
    drive.play_body("01 03 01 45 00 01", "01 03 02 03 E8");
    drive.play_body("00 10 01 45 00 01 02 00 05", "");
    drive.play_body("01 03 01 45 00 01", "01 03 02 00 05");
    drive.play_body("00 06 01 45 27 10", "");
    drive.play_body("00 03 01 45 00 01", "");
}

/// The characters of a good request with `gap` before the sixth.
fn interrupted_request(gap: Duration) -> Vec<(Duration, Character)> {
    let gaps = [0, 0, 0, 0, 0, 1, 0, 0].map(|times| gap * times);
    let characters = hex("01 06 01 45 03 E8 99 5D")
        .into_iter()
        .map(Character::new);
    gaps.into_iter().zip(characters).collect()
}

#[test]
fn request_with_a_gap() {
    let mut drive = drive();
    let character = drive.line().character_time();
    for (tenths, answered) in [(0, true), (14, true), (16, false), (34, false), (36, false)] {
        let answers = drive.send_characters(&interrupted_request(character * tenths / 10));
        assert_eq!(
            !answers.is_empty(),
            answered,
            "gap of {tenths}/10 characters"
        );
        drive.play("01 06 01 45 00 00 99 E3", "01 06 01 45 00 00 99 E3");
    }
}

#[test]
fn request_with_a_spoilt_character() {
    let mut drive = drive();
    let mut characters = interrupted_request(Duration::ZERO);
    characters[4].1.spoilt = true;
    assert_eq!(drive.send_characters(&characters), []);
    assert_eq!(drive.slave.registers(), &DriveRegisters::default());
}

#[test]
fn every_single_bit_error_gets_silence() {
    let mut drive = drive();
    let good = hex("01 06 01 45 03 E8 99 5D");
    for bit in 0..8 * good.len() {
        let mut frame = good.clone();
        frame[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(drive.send_bytes(&frame), None, "bit {bit}");
    }
    assert_eq!(drive.slave.registers(), &DriveRegisters::default());
}

#[test]
fn answer_keeps_the_silence_even_from_the_fastest_device() {
    let behaviour = Behaviour {
        processing_delay: Duration::ZERO,
        processing_jitter: Duration::ZERO,
        ..DOCUMENTED
    };
    let mut drive = Script::new(DriveRegisters::default(), behaviour);
    let answer = drive.ask("01 03 01 45 00 01").unwrap();
    assert!(answer.after >= drive.line().silence_3_5());
    assert!(answer.after < drive.line().silence_3_5() * 2);
}

#[test]
fn same_seed_same_times() {
    let times = |seed| {
        let mut drive = Script::new(DriveRegisters::default(), DOCUMENTED);
        drive.slave = ModbusSlave::new(DriveRegisters::default(), DOCUMENTED, seed);
        let ask = |_| drive.ask("01 03 01 45 00 01").unwrap().after;
        (0..10).map(ask).collect::<Vec<_>>()
    };
    assert_eq!(times(5), times(5));
    assert_ne!(times(5), times(6));
    assert!(times(5).windows(2).any(|pair| pair[0] != pair[1]));
}

#[test]
fn what_it_did_not_hear_the_start_of_is_no_frame() {
    let mut drive = drive();
    let character = drive.line().character_time();
    let good = hex("01 06 01 45 03 E8 99 5D");
    let mut characters: Vec<_> = good.iter().map(|byte| (Duration::ZERO, *byte)).collect();
    // Noise while it is busy with the first frame, and a frame right after the noise.
    characters.extend((0..40).map(|count| (character * 5 * u32::from(count == 0), 0)));
    characters.extend(good.iter().map(|byte| (Duration::ZERO, *byte)));
    let characters: Vec<_> = characters
        .into_iter()
        .map(|(gap, byte)| (gap, Character::new(byte)))
        .collect();
    assert_eq!(drive.send_characters(&characters).len(), 1);
}

#[test]
fn request_while_it_is_busy_is_not_heard() {
    let mut drive = drive();
    let mut characters = interrupted_request(Duration::ZERO);
    let mut second = interrupted_request(Duration::ZERO);
    second[0].0 = drive.line().character_time() * 5;
    characters.extend(second);
    assert_eq!(drive.send_characters(&characters).len(), 1);
}

#[test]
fn restart_forgets_a_half_done_exchange() {
    let line = drive().line();
    for woken in 0..3 {
        let mut slave = drive().slave;
        for (count, byte) in (1..).zip(hex("01 06 01 45 03 E8 99 5D")) {
            let end = Instant::START + line.character_time() * count;
            slave.receive(end, Character::new(byte));
        }
        // Still receiving, about to answer, answering.
        for _ in 0..woken {
            slave.wake(slave.wake_at().unwrap());
        }
        assert!(slave.wake_at().is_some());
        slave.restart();
        assert_eq!(slave.wake_at(), None);
    }
}

/// Requests, and what a device without faults answers, CRC and all.
const CONFORMING: &[(&str, &str)] = &[
    ("01 03 01 45 00 02 D4 22", "01 03 04 00 00 00 00 FA 33"),
    ("01 06 01 45 03 E8 99 5D", "01 06 01 45 03 E8 99 5D"),
    ("01 06 01 45 27 10 83 DF", "01 86 02 C3 A1"),
    ("01 06 01 45 27 10 99 5D", ""),
    ("00 06 01 45 03 E8 98 8C", ""),
    (
        "01 10 01 45 00 02 04 03 E8 07 D0 B9 EC",
        "01 10 01 45 00 02 51 E1",
    ),
];

/// Plays every exchange on a fresh device: the answers that are not those of a device without faults.
fn departures(name: &str) -> Vec<(&'static str, String)> {
    let mut departures = Vec::new();
    for (request, expected) in CONFORMING {
        let answer = with_fault(name).send(request);
        let came = answer.map(|answer| text(&answer.bytes)).unwrap_or_default();
        if came != *expected {
            departures.push((*request, came));
        }
    }
    departures
}

fn departure(request: &'static str, answer: &str) -> (&'static str, String) {
    (request, answer.to_owned())
}

#[test]
fn without_a_fault_nothing_departs() {
    for (request, answer) in CONFORMING {
        drive().play(request, answer);
    }
}

#[test]
fn fault_crc_bytes_swapped() {
    assert_eq!(
        departures("crc-bytes-swapped"),
        [
            departure("01 03 01 45 00 02 D4 22", "01 03 04 00 00 00 00 33 FA"),
            departure("01 06 01 45 03 E8 99 5D", "01 06 01 45 03 E8 5D 99"),
            departure("01 06 01 45 27 10 83 DF", "01 86 02 A1 C3"),
            departure(
                "01 10 01 45 00 02 04 03 E8 07 D0 B9 EC",
                "01 10 01 45 00 02 E1 51"
            ),
        ]
    );
}

#[test]
fn fault_stale_crc_accepted() {
    assert_eq!(
        departures("stale-crc-accepted"),
        [departure("01 06 01 45 27 10 99 5D", "01 86 02 C3 A1")]
    );
    let mut drive = with_fault("stale-crc-accepted");
    drive.play("01 06 01 45 00 07 99 5D", "01 06 01 45 00 07 D8 21");
    let mut spoilt = interrupted_request(Duration::ZERO);
    spoilt[0].1.spoilt = true;
    assert_eq!(drive.send_characters(&spoilt), []);
}

#[test]
fn fault_exception_without_80h() {
    assert_eq!(
        departures("exception-without-80h"),
        [departure("01 06 01 45 27 10 83 DF", "01 06 02 A2 61")]
    );
}

#[test]
fn fault_exception_03_for_02() {
    assert_eq!(
        departures("exception-03-for-02"),
        [departure("01 06 01 45 27 10 83 DF", "01 86 03 02 61")]
    );
}

#[test]
fn fault_wrong_byte_count() {
    assert_eq!(
        departures("wrong-byte-count"),
        [departure(
            "01 03 01 45 00 02 D4 22",
            "01 03 02 00 00 00 00 72 33"
        )]
    );
}

#[test]
fn fault_write_echo_wrong_value() {
    assert_eq!(
        departures("write-echo-wrong-value"),
        [departure(
            "01 06 01 45 03 E8 99 5D",
            "01 06 01 45 03 E9 58 9D"
        )]
    );
    let mut drive = with_fault("write-echo-wrong-value");
    drive.ask("01 06 01 45 03 E8").unwrap();
    drive.play_body("01 03 01 45 00 01", "01 03 02 03 E8");
}

#[test]
fn fault_broadcast_answered() {
    assert_eq!(
        departures("broadcast-answered"),
        [departure(
            "00 06 01 45 03 E8 98 8C",
            "01 06 01 45 03 E8 99 5D"
        )]
    );
}

#[test]
fn fault_reply_too_early() {
    assert_eq!(departures("reply-too-early"), []);
    let mut drive = with_fault("reply-too-early");
    let answer = drive.ask("01 03 01 45 00 01").unwrap();
    assert!(answer.after < drive.line().silence_3_5(), "{answer:?}");
    assert!(answer.after > drive.line().silence_1_5(), "{answer:?}");
}

#[test]
fn faults_have_names_of_their_own() {
    let mut names: Vec<&str> = FAULTS.iter().map(|fault| fault.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), FAULTS.len());
}

/// A CRC by long division, bit by bit, as another would write it.
fn crc_by_division(bytes: &[u8]) -> u16 {
    let mut remainder: u32 = 0xFFFF;
    for byte in bytes {
        remainder ^= u32::from(byte.reverse_bits()) << 8;
        for _ in 0..8 {
            remainder <<= 1;
            if remainder & 0x1_0000 != 0 {
                remainder ^= 0x1_8005;
            }
        }
    }
    u16::try_from(remainder).unwrap().reverse_bits()
}

/// A gap in quarters of a character, mostly none.
fn gap() -> impl Strategy<Value = u32> {
    prop_oneof![9 => Just(0_u32), 1 => 0..40_u32]
}

/// A character: any, or one that often occurs in requests; rarely spoilt.
fn character() -> impl Strategy<Value = Character> {
    let byte = prop_oneof![any::<u8>(), Just(0), Just(1), Just(3), Just(6)];
    (byte, prop::bool::weighted(0.01)).prop_map(|(byte, spoilt)| Character { byte, spoilt })
}

/// Characters with the gap before each: noise, and frames whose CRC is right.
fn traffic() -> impl Strategy<Value = Vec<(u32, Character)>> {
    let noise = prop::collection::vec((gap(), character()), 0..20);
    let frame = (
        prop::collection::vec(any::<u8>(), 0..9),
        prop_oneof![Just(0_u8), Just(1)],
        prop_oneof![Just(3_u8), Just(6), Just(16), any::<u8>()],
        0..40_u32,
    )
        .prop_map(|(data, address, function, gap)| {
            let body = [vec![address, function], data].concat();
            let frame = crc::with_crc(body, CrcOrder::LowByteFirst);
            let gaps = std::iter::once(gap).chain(std::iter::repeat(0));
            gaps.zip(frame.into_iter().map(Character::new)).collect()
        });
    prop::collection::vec(prop_oneof![noise, frame], 0..8).prop_map(|parts| parts.concat())
}

/// What lies between silences of 3.5 characters, and whether it is a frame: worked out from the whole recording.
fn frames(traffic: &[(u32, Character)]) -> Vec<(Vec<u8>, bool)> {
    let mut frames: Vec<(Vec<u8>, bool)> = Vec::new();
    for (quarters, character) in traffic {
        match frames.last_mut() {
            Some((bytes, intact)) if *quarters < 14 => {
                bytes.push(character.byte);
                *intact &= *quarters <= 6 && !character.spoilt;
            }
            _ => frames.push((vec![character.byte], !character.spoilt)),
        }
    }
    frames
}

proptest! {
    #[test]
    fn only_frames_with_a_right_crc_are_answered(traffic in traffic()) {
        let mut drive = Script::new(DriveRegisters::default(), DOCUMENTED);
        let quarter = drive.line().character_time() / 4;
        let timed: Vec<_> = traffic
            .iter()
            .map(|(quarters, character)| (quarter * *quarters, *character))
            .collect();
        let answers = drive.send_characters(&timed);
        let answerable = frames(&traffic)
            .iter()
            .filter(|(bytes, intact)| {
                *intact && bytes.split_last_chunk::<2>().is_some_and(|(body, check)| {
                    crc_by_division(body) == u16::from_le_bytes(*check) && body.first() == Some(&1)
                })
            })
            .count();
        prop_assert!(answers.len() <= answerable, "{answers:?}");
        for answer in answers {
            let (body, right) = crc::split(&answer.bytes).unwrap();
            prop_assert!(right && body.first() == Some(&1));
        }
    }

    #[test]
    fn every_fault_survives_any_traffic(traffic in traffic(), fault in 0..FAULTS.len()) {
        let mut drive = with_fault_number(fault);
        let timed: Vec<_> = traffic
            .iter()
            .map(|(quarters, character)| (Duration::from_micros(130) * *quarters, *character))
            .collect();
        drive.send_characters(&timed);
    }

    #[test]
    fn crc_is_that_of_the_long_division(bytes in prop::collection::vec(any::<u8>(), 0..40)) {
        prop_assert_eq!(crc::crc16(&bytes), crc_by_division(&bytes));
    }
}

fn with_fault_number(number: usize) -> Script<DriveRegisters> {
    let mut behaviour = crate::Behaviour::default();
    (FAULTS[number].apply)(&mut behaviour);
    Script::new(DriveRegisters::default(), behaviour.modbus)
}
