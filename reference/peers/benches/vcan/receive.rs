//! Whether frames are lost at full rate.

use std::time::Duration;

use fieldproof_link::real::{NoStimuli, Port, RealLane, SocketCan};
use fieldproof_link::{Lane, Reception};

/// How long nothing may come before the rest is given up.
const PATIENCE: Duration = Duration::from_secs(5);

/// What came on an interface.
#[derive(Default)]
struct Counted {
    came: u32,
    missing: u32,
    next: u32,
}

/// Prints what came on each interface until each has brought the frame before number `frames`.
pub(crate) fn count(frames: u32, interfaces: &[&str]) {
    let open = |name: &&str| -> Box<dyn Port> {
        Box::new(SocketCan::open(name, name, 1_000_000, None).unwrap())
    };
    let mut lane = RealLane::new(interfaces.iter().map(open).collect(), Box::new(NoStimuli));
    let mut counted: Vec<Counted> = interfaces.iter().map(|_| Counted::default()).collect();
    println!("ready");
    while counted.iter().any(|it| it.next < frames) {
        // What overflowed is an error here.
        let Some(arrival) = lane.receive(lane.now() + PATIENCE).unwrap() else {
            break;
        };
        if let Reception::Frame(frame) = arrival.what
            && let Some(number) = frame.bytes().first_chunk()
        {
            let number = u32::from_le_bytes(*number);
            let counted = &mut counted[arrival.port.0];
            counted.came += 1;
            counted.missing += number.wrapping_sub(counted.next);
            counted.next = number + 1;
        }
    }
    for (name, counted) in interfaces.iter().zip(counted) {
        let missing = counted.missing + (frames - counted.next);
        println!("{name} {} frames, {missing} missing", counted.came);
    }
}
