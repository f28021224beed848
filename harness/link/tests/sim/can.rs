//! CAN: instants, arbitration, acknowledge.

use std::time::Duration;

use fieldproof_link::sim::{Builder, SimLane};
use fieldproof_link::{Instant, Lane, Line, LinkError, PortIndex, Sent, Stimulus};

use crate::actor::{Actor, CAN_500K, Do, frame, ms, received, seen, transmission, us};

const CAN: PortIndex = PortIndex(0);

/// The tester and the `others` at 500 kbit/s (2 us a bit), the first of which is the device.
fn lane(others: Vec<Actor>) -> SimLane {
    let mut builder = Builder::new();
    let can = builder.can_bus("can", 500_000);
    assert_eq!(can, CAN);
    for (index, other) in others.into_iter().enumerate() {
        if index == 0 {
            builder.device(other.boxed(), &[can]);
        } else {
            builder.participant(other.boxed(), &[can]);
        }
    }
    builder.build()
}

/// Everything that arrives by `until`.
fn arrivals(lane: &mut SimLane, until: Instant) -> Vec<(Instant, String)> {
    let mut all = Vec::new();
    while let Some((at, what)) = seen(lane.receive(until).unwrap()) {
        let fieldproof_link::Reception::Frame(frame) = what else {
            panic!("a character on a CAN bus");
        };
        all.push((at, frame.to_string()));
    }
    assert_eq!(lane.now(), until);
    all
}

fn script(expected: &[(Instant, &str)]) -> Vec<(Instant, String)> {
    let own = |(at, text): &(Instant, &str)| (*at, frame(text).to_string());
    expected.iter().map(own).collect()
}

#[test]
fn a_frame_takes_its_bits_and_the_answer_waits_for_the_intermission() {
    let device = Actor::new(CAN_500K).answer("000#", "000#");
    let heard = device.heard();
    let mut lane = lane(vec![device]);
    let sent = lane.send(CAN, ms(1), transmission("000#")).unwrap();
    // 34 zeros with a stuff bit after every five of them, and 10 bits: 34 + 6 + 10 = 50 bits of 2 us.
    let expected = Sent {
        start: us(1_000),
        end: us(1_100),
    };
    assert_eq!(sent, expected);
    assert_eq!(lane.now(), us(1_100));
    assert_eq!(*heard.lock().unwrap(), [(us(1_100), 0, received("000#"))]);
    // 3 bits of intermission, then 50 bits.
    let answer = lane.receive(ms(10)).unwrap();
    assert_eq!(seen(answer), Some((us(1_206), received("000#"))));
    assert_eq!(lane.receive(ms(10)), Ok(None));
    assert_eq!(lane.now(), ms(10));
}

#[test]
fn all_who_wait_for_the_bus_arbitrate_by_identifier() {
    // While 000# is on the bus (1000 to 1100 us) five nodes queue the same first eleven bits and a higher one.
    let others = vec![
        Actor::new(CAN_500K).send(us(1_000), "000#"),
        Actor::new(CAN_500K).send(us(1_010), "124#"),
        Actor::new(CAN_500K).send(us(1_020), "048C0000#R"),
        Actor::new(CAN_500K).send(us(1_030), "048C0000#"),
        Actor::new(CAN_500K).send(us(1_040), "123#R"),
        Actor::new(CAN_500K).send(us(1_050), "123#"),
    ];
    // Bits with stuff bits: 123#, 123#R and 124# 44 + 1, 048C0000# and its remote frame 64 + 5. Each starts 3 bits
    // after the end of the one before: 1106 + 90 = 1196, 1202 + 90 = 1292, 1298 + 138 = 1436, 1442 + 138 = 1580,
    // 1586 + 90 = 1676.
    let expected = script(&[
        (us(1_100), "000#"),
        (us(1_196), "123#"),
        (us(1_292), "123#R"),
        (us(1_436), "048C0000#"),
        (us(1_580), "048C0000#R"),
        (us(1_676), "124#"),
    ]);
    assert_eq!(arrivals(&mut lane(others), ms(2)), expected);
}

#[test]
fn only_the_head_of_a_queue_competes() {
    let first = Actor::new(CAN_500K)
        .send(us(1_000), "300#")
        .send(us(1_000), "100#");
    let second = Actor::new(CAN_500K).send(us(1_000), "200#");
    // All of them 44 + 4 bits, 96 us: 1096, 1102 + 96 = 1198, 1204 + 96 = 1300.
    let expected = script(&[
        (us(1_096), "200#"),
        (us(1_198), "300#"),
        (us(1_300), "100#"),
    ]);
    assert_eq!(arrivals(&mut lane(vec![first, second]), ms(2)), expected);
}

#[test]
fn of_equal_identifiers_the_one_that_joined_first_goes_first() {
    let first = Actor::new(CAN_500K).send(us(1_000), "123#");
    let second = Actor::new(CAN_500K).send(us(1_000), "123#00");
    let order: Vec<_> = arrivals(&mut lane(vec![first, second]), ms(2))
        .into_iter()
        .map(|(_, text)| text)
        .collect();
    assert_eq!(order, ["123#", "123#00"]);
}

#[test]
fn the_tester_arbitrates_like_any_other() {
    // The device wants to send at the same instant; the lower identifier goes first, whoever asked first.
    let cases = [("100#", us(1_000)), ("300#", us(1_102))];
    for (own, start) in cases {
        let mut lane = lane(vec![Actor::new(CAN_500K).send(ms(1), "200#")]);
        assert_eq!(lane.receive(ms(1)), Ok(None));
        let sent = lane.send(CAN, ms(1), transmission(own)).unwrap();
        assert_eq!(sent.start, start);
        assert_eq!(sent.end.since(sent.start), Duration::from_micros(96));
        let other = lane.receive(ms(2)).unwrap().unwrap();
        let other_first = start > us(1_000);
        let at = if other_first { us(1_096) } else { us(1_198) };
        assert_eq!((other.at, other.what), (at, received("200#")));
    }
}

#[test]
fn a_frame_that_nobody_acknowledges_is_given_up_and_not_sent_later() {
    let mut lane = lane(vec![Actor::new(CAN_500K).off()]);
    let error = lane.send(CAN, ms(1), transmission("000#")).unwrap_err();
    assert_eq!(error, LinkError::NotAcknowledged { port: "can".into() });
    assert_eq!(lane.now(), ms(101));
    lane.stimulate(&Stimulus::Power { on: true }).unwrap();
    // Its boot-up, 52 + 4 bits, is alone on the bus: 101 ms + 112 us.
    let expected = script(&[(us(101_112), "701#00")]);
    assert_eq!(arrivals(&mut lane, ms(200)), expected);
}

#[test]
fn the_tester_gives_up_on_a_bus_that_is_never_free_for_it() {
    let mut babbler = Actor::new(CAN_500K);
    for _ in 0..2_000 {
        babbler = babbler.send(ms(1), "000#");
    }
    let mut lane = lane(vec![babbler]);
    let sent = lane.send(CAN, us(1_001), transmission("7FF#"));
    assert_eq!(sent, Err(LinkError::NotAcknowledged { port: "can".into() }));
    // 2000 frames every 106 us from 1 ms on.
    let all = arrivals(&mut lane, ms(300));
    assert_eq!(all.len(), 2_000);
    assert_eq!(all[1_999].0, us(1_000 + 1_999 * 106 + 100));
}

#[test]
fn a_frame_that_has_started_is_not_given_up() {
    let mut babbler = Actor::new(CAN_500K);
    for _ in 0..943 {
        babbler = babbler.send(ms(1), "000#");
    }
    let mut lane = lane(vec![babbler]);
    // 943 frames every 106 us from 1 ms on; it starts before 101.001 ms and ends after that.
    let sent = lane.send(CAN, us(1_001), transmission("7FF#")).unwrap();
    assert_eq!(sent.start, us(1_000 + 943 * 106));
    assert!(sent.end > us(101_001));
}

#[test]
fn what_the_device_sends_waits_until_the_bit_rates_agree() {
    let device = Actor::new(Line::Can { bit_rate: 125_000 })
        .send(ms(1), "701#00")
        .send(ms(2), "000#")
        .send(ms(3), "701#05");
    let mut lane = lane(vec![device]);
    assert_eq!(lane.receive(ms(10)), Ok(None));
    lane.set_line(CAN, Line::Can { bit_rate: 125_000 }).unwrap();
    // 8 us a bit. The second 701 took the place of the first: 52 + 3 bits, 440 us; after 24 us 50 bits.
    let expected = script(&[(us(10_440), "701#05"), (us(10_864), "000#")]);
    assert_eq!(arrivals(&mut lane, ms(20)), expected);
}

#[test]
fn a_node_at_another_bit_rate_hears_nothing_and_acknowledges_nothing() {
    let stranger = Actor::new(Line::Can { bit_rate: 125_000 });
    let heard = stranger.heard();
    let device = Actor::new(CAN_500K);
    let mut both = lane(vec![device, stranger]);
    both.send(CAN, ms(1), transmission("000#")).unwrap();
    assert!(heard.lock().unwrap().is_empty());

    let mut alone = lane(vec![Actor::new(Line::Can { bit_rate: 125_000 })]);
    let sent = alone.send(CAN, ms(1), transmission("000#"));
    assert_eq!(sent, Err(LinkError::NotAcknowledged { port: "can".into() }));
}

#[test]
fn a_frame_is_sent_again_if_the_bit_rate_changed_under_it() {
    let mut lane = lane(vec![Actor::new(CAN_500K).send(ms(1), "000#")]);
    assert_eq!(lane.receive(us(1_050)), Ok(None));
    lane.set_line(CAN, Line::Can { bit_rate: 125_000 }).unwrap();
    assert_eq!(lane.receive(ms(5)), Ok(None));
    lane.set_line(CAN, CAN_500K).unwrap();
    let expected = script(&[(us(5_100), "000#")]);
    assert_eq!(arrivals(&mut lane, ms(10)), expected);
}

#[test]
fn a_node_that_was_away_during_a_frame_has_not_heard_it() {
    let mut lane = lane(vec![Actor::new(CAN_500K).send(ms(1), "000#")]);
    assert_eq!(lane.receive(us(1_050)), Ok(None));
    lane.set_line(CAN, Line::Off).unwrap();
    lane.set_line(CAN, CAN_500K).unwrap();
    // From 1000 to 1100 in vain, and once more after the intermission.
    let expected = script(&[(us(1_206), "000#")]);
    assert_eq!(arrivals(&mut lane, ms(10)), expected);
}

#[test]
fn a_device_that_loses_power_loses_its_frames() {
    let device = Actor::new(CAN_500K).send(ms(1), "000#").send(ms(1), "100#");
    let mut lane = lane(vec![device]);
    assert_eq!(lane.receive(us(1_050)), Ok(None));
    lane.stimulate(&Stimulus::Power { on: false }).unwrap();
    assert_eq!(lane.receive(ms(5)), Ok(None));
    lane.stimulate(&Stimulus::Power { on: true }).unwrap();
    let expected = script(&[(us(5_112), "701#00")]);
    assert_eq!(arrivals(&mut lane, ms(10)), expected);
}

#[test]
fn the_device_follows_its_own_switch_of_the_bit_rate() {
    let fast = Line::Can {
        bit_rate: 1_000_000,
    };
    let device = Actor::new(CAN_500K)
        .then(ms(2), Do::SetLine(fast))
        .answer("000#", "000#");
    let mut lane = lane(vec![device]);
    lane.send(CAN, ms(1), transmission("000#")).unwrap();
    assert!(lane.receive(ms(3)).unwrap().is_some());
    lane.set_line(CAN, fast).unwrap();
    assert_eq!(lane.ports()[0].line, fast);
    // 1 us a bit.
    let sent = lane.send(CAN, ms(4), transmission("000#")).unwrap();
    assert_eq!(sent.end, us(4_050));
    let expected = script(&[(us(4_103), "000#")]);
    assert_eq!(arrivals(&mut lane, ms(5)), expected);
}
