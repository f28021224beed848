//! The state that a node is found in is no fault of it, and it is left in it.

use fieldproof_can::Frame;
use fieldproof_record::Verdict;
use fieldproof_suite::device::Feature;

use crate::scripted::{Answers, Memory, Scripted, Setup, soon};

const READ: &str = "
  - case: read
    title: An object is read
    cite: [book]
    steps:
      - sdo-read: {object: \"1000:00\", as: u32}
";

fn setup(features: &[Feature]) -> Setup {
    let of_every_node = [Feature::SdoServer, Feature::NmtSlave];
    Setup {
        features: [&of_every_node, features].concat(),
        ..Setup::default()
    }
}

/// A node that answers SDO but in Stopped, and tells its state when it is guarded. It was found in `state`.
fn node(state: u8, objects: &[((u16, u8), [u8; 4])]) -> Scripted {
    let mut memory = Memory::new(objects);
    let mut state = state;
    Scripted::new(move |request: &Frame| match request.bytes() {
        _ if request.is_remote() => vec![soon(&format!("701#{state:02X}"))],
        [command, 0 | 1] if request.id().raw() == 0 => {
            state = match command {
                0x01 => 0x05,
                0x02 => 0x04,
                _ => 0x7F,
            };
            Answers::new()
        }
        _ if state == 0x04 => Answers::new(),
        _ => memory.answer(request),
    })
}

/// NMT commands that the node saw.
fn commands(seen: &[String]) -> Vec<&str> {
    let seen = seen.iter().map(String::as_str);
    seen.filter(|frame| frame.starts_with("000#")).collect()
}

const NO_GUARD_TIME: [((u16, u8), [u8; 4]); 2] = [((0x100C, 0), [0; 4]), ((0x100D, 0), [0; 4])];

#[test]
fn a_node_that_was_operational_is_again_in_the_end() {
    let device = node(0x05, &NO_GUARD_TIME);
    let seen = device.seen.clone();
    let played = setup(&[Feature::NodeGuarding]).play(device, READ);
    assert_eq!(played.verdict(), (Verdict::Pass, ""));
    assert_eq!(commands(&seen.lock().unwrap()), ["000#8001", "000#0101"]);
}

#[test]
fn a_node_that_was_stopped_is_woken_and_stopped_in_the_end() {
    let device = node(0x04, &[]);
    let seen = device.seen.clone();
    let played = setup(&[]).play(device, READ);
    assert_eq!(played.verdict(), (Verdict::Pass, ""));
    assert_eq!(commands(&seen.lock().unwrap()), ["000#8001", "000#0201"]);
}

#[test]
fn a_node_in_pre_operational_is_told_nothing() {
    let device = node(0x7F, &NO_GUARD_TIME);
    let seen = device.seen.clone();
    let played = setup(&[Feature::NodeGuarding]).play(device, READ);
    assert_eq!(played.verdict(), (Verdict::Pass, ""));
    assert_eq!(commands(&seen.lock().unwrap()), [""; 0]);
}

#[test]
fn a_node_that_watches_for_its_master_is_not_guarded() {
    let watching = [((0x100C, 0), [100, 0, 0, 0]), ((0x100D, 0), [3, 0, 0, 0])];
    let device = node(0x7F, &watching);
    let seen = device.seen.clone();
    let played = setup(&[Feature::NodeGuarding]).play(device, READ);
    assert_eq!(played.verdict(), (Verdict::Pass, ""));
    let seen = seen.lock().unwrap();
    assert!(seen.iter().all(|frame| !frame.starts_with("701#R")));
    // Nobody knows where it was.
    assert_eq!(commands(&seen), ["000#8001"]);
}

#[test]
fn cases_that_rest_on_an_identifier_that_was_changed_are_skipped() {
    let needing = READ.replace("    steps:", "    needs: [emergency]\n    steps:");
    let reason = |held: [u8; 4], features: &[Feature]| {
        let device = node(0x7F, &[((0x1014, 0), held)]);
        let played = setup(features).play(device, &needing);
        played.case().reason.clone()
    };
    let moved = "1014h:00 was found to hold 00000691h: EMCY is not under its predefined identifier";
    let moved_to = [0x91, 0x06, 0, 0];
    assert_eq!(
        reason(moved_to, &[Feature::Emergency]).as_deref(),
        Some(moved)
    );
    let never_configured = [Feature::Emergency, Feature::FactorySettings];
    assert_eq!(reason(moved_to, &never_configured), None);
    assert_eq!(reason([0x81, 0, 0, 0x40], &[Feature::Emergency]), None);
}

#[test]
fn a_node_that_boots_later_than_promised_was_not_stopped() {
    // It hears the probes, and boots by the last of them.
    let mut memory = Memory::new(&[]);
    let mut probes = 0;
    let device = Scripted::new(move |request: &Frame| {
        if request.id().raw() != 0x601 {
            return Answers::new();
        }
        probes += 1;
        match probes {
            1..4 => Answers::new(),
            4 => vec![soon("701#00")],
            _ => memory.answer(request),
        }
    });
    let seen = device.seen.clone();
    let played = setup(&[]).play(device, READ);
    assert_eq!(played.verdict(), (Verdict::Pass, ""));
    assert_eq!(commands(&seen.lock().unwrap()), ["000#8001"]);
}
