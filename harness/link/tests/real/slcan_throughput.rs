//! Many frames both ways at once: none is lost, none overtakes another.

#![allow(clippy::print_stdout)] // The rate, for whoever asks for it with --nocapture.

use std::time::Duration;

use fieldproof_can::{Frame, StandardId};
use fieldproof_link::real::RealLane;
use fieldproof_link::{Lane, Origin, Reception};

use crate::slcan::{lane_on, send};
use crate::slcan_hub::RunningHub;

const FRAMES: u32 = 20_000;

/// How far one may be ahead of the other; without bit times, nothing else keeps one from flooding the other.
const AHEAD: u32 = 100;

#[test]
fn twenty_thousand_frames_both_ways() {
    let hub = RunningHub::start(1, false);
    for (first, second) in [(hub.tcp(), hub.tcp()), (hub.tcp(), hub.terminal(0))] {
        let (mut first, mut second) = (lane_on(first, 1_000_000), lane_on(second, 1_000_000));
        let began = std::time::Instant::now();
        std::thread::scope(|scope| {
            scope.spawn(|| exchange(&mut first, 0x181));
            scope.spawn(|| exchange(&mut second, 0x182));
        });
        let rate = f64::from(2 * FRAMES) / began.elapsed().as_secs_f64();
        println!("{rate:.0} frames a second through the hub");
    }
}

/// Sends all of them, takes what comes meanwhile, and counts on both sides.
fn exchange(lane: &mut RealLane, id: u16) {
    let id = StandardId::new(id).unwrap();
    let (mut sent, mut left, mut received) = (0, 0, 0);
    while left < FRAMES || received < FRAMES {
        let may_send = sent < FRAMES && sent < received + AHEAD;
        if may_send {
            send(lane, Frame::of(id, sent.to_le_bytes()));
            sent += 1;
        }
        // While there is something to send, only what has come already is taken.
        let wait = Duration::from_secs(if may_send { 0 } else { 10 });
        while left < FRAMES || received < FRAMES {
            let until = lane.now() + wait;
            let Some(arrival) = lane.receive(until).unwrap() else {
                assert!(may_send, "{left} left, {received} received");
                break;
            };
            let Reception::Frame(frame) = arrival.what else {
                panic!("{arrival:?}");
            };
            let counter = match arrival.origin {
                Origin::Tester => &mut left,
                _ => &mut received,
            };
            assert_eq!(frame.bytes(), counter.to_le_bytes());
            assert_eq!(
                frame.standard_id() == Some(id),
                arrival.origin == Origin::Tester
            );
            *counter += 1;
            if !may_send {
                break;
            }
        }
    }
}
