//! Every kind with every fault and variant: it can be built, it is named well, and what it does follows from its seed.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeSet;
use std::time::Duration;

use fieldproof_can::{Frame, StandardId};
use fieldproof_devices::{DeviceKind, Medium, PortKind, Settings, kind, kinds};
use fieldproof_link::{Instant, Outbox, Participant, Reception, Stimulus, Transmission};

const SUITES: [&str; 16] = [
    "boot-up",
    "cia402",
    "cia406",
    "cob-id",
    "emergency",
    "error-control",
    "gateway",
    "lss",
    "modbus",
    "nmt",
    "pdo",
    "robustness",
    "sdo",
    "store",
    "sync",
    "time",
];

/// Every way to build a device of a kind: as it is, with each fault, as each variant.
fn ways(kind: &DeviceKind) -> Vec<Settings> {
    let faults = kind.faults().map(|fault| Settings {
        fault: Some(fault.name.to_owned()),
        ..Settings::default()
    });
    let variants = kind.variants.iter().map(|variant| Settings {
        variant: Some(variant.name.to_owned()),
        ..Settings::default()
    });
    [Settings::default()]
        .into_iter()
        .chain(faults)
        .chain(variants)
        .collect()
}

#[test]
fn names_are_unique_and_every_fault_says_what_it_breaks() {
    let names: Vec<&str> = kinds().iter().map(|kind| kind.name).collect();
    assert_eq!(
        names,
        [
            "canopen-complete",
            "huacheng-ssts1",
            "kinco-servo",
            "liaomiao-encoder",
            "modbus-complete",
            "teco-inverter",
            "teco-jn5-cm-can"
        ]
    );
    for kind in kinds() {
        let mut seen = BTreeSet::new();
        for fault in kind.faults() {
            assert!(seen.insert(fault.name), "{} twice", fault.name);
            assert!(SUITES.contains(&fault.caught_by), "{}", fault.caught_by);
            assert!(!fault.breaks.is_empty() && !fault.words.is_empty());
        }
        for variant in kind.variants {
            assert!(seen.insert(variant.name), "{} twice", variant.name);
        }
    }
}

#[test]
fn every_fault_and_variant_can_be_built_and_no_other() {
    for kind in kinds() {
        for settings in ways(kind) {
            assert!((kind.build)(&settings).is_ok(), "{settings:?}");
        }
        for (fault, variant) in [(Some("none"), None), (None, Some("none"))] {
            let settings = Settings {
                fault: fault.map(str::to_owned),
                variant: variant.map(str::to_owned),
                ..Settings::default()
            };
            let error = (kind.build)(&settings).err().unwrap();
            assert_eq!((error.device, error.name.as_str()), (kind.name, "none"));
        }
    }
    assert!(kind("no-such-device").is_none());
}

/// When what was sent to CAN in the first second, with a read in between.
fn first_second(kind: &DeviceKind, seed: u64) -> Vec<(Instant, Frame)> {
    let settings = Settings {
        node: Some(5),
        seed,
        ..Settings::default()
    };
    let mut device = (kind.build)(&settings).unwrap();
    let mut sent = run(device.as_mut(), 500);
    let read = Frame::of_eight(
        StandardId::new(0x605).unwrap(),
        [0x40, 0, 0x10, 0, 0, 0, 0, 0],
    );
    let now = Instant::from_nanos(500_000_000);
    device.receive(now, 0, Reception::Frame(read), &mut Outbox::default());
    sent.extend(run(device.as_mut(), 1_000));
    sent
}

fn run(device: &mut dyn Participant, until_milliseconds: u64) -> Vec<(Instant, Frame)> {
    let until = Instant::START + Duration::from_millis(until_milliseconds);
    let mut sent = Vec::new();
    while let Some(now) = device.wake_at().filter(|at| *at <= until) {
        let mut out = Outbox::default();
        device.wake(now, &mut out);
        for (_, what) in out.drain() {
            if let Transmission::Frame(frame) = what {
                sent.push((now, frame));
            }
        }
    }
    sent
}

/// Those with a CAN port.
fn on_can() -> impl Iterator<Item = &'static DeviceKind> {
    let is_can = |port: &PortKind| matches!(port.medium, Medium::Can { .. });
    kinds()
        .iter()
        .filter(move |kind| kind.ports.iter().any(is_can))
}

#[test]
fn the_seed_fixes_every_instant() {
    for kind in on_can() {
        let sent = first_second(kind, 1);
        let identifiers: Vec<u32> = sent.iter().map(|(_, frame)| frame.id().raw()).collect();
        assert_eq!(identifiers, [0x705, 0x585], "{}", kind.name);
        assert_eq!(sent, first_second(kind, 1));
        assert_ne!(sent, first_second(kind, 2));
    }
}

#[test]
fn power_off_and_on_leaves_every_can_device_as_it_was() {
    for kind in on_can() {
        for settings in ways(kind) {
            let mut device = (kind.build)(&settings).unwrap();
            run(device.as_mut(), 100);
            let before = device.state();
            assert!(before.clone().into_iter().count() > 20, "{}", kind.name);
            for (milliseconds, on) in [(100, false), (200, true)] {
                let now = Instant::START + Duration::from_millis(milliseconds);
                let power = Stimulus::Power { on };
                device
                    .stimulate(now, &power, &mut Outbox::default())
                    .unwrap();
            }
            run(device.as_mut(), 300);
            assert_eq!(device.state(), before, "{} {settings:?}", kind.name);
        }
    }
}
