//! A slave with two large objects, as frames see it.

use std::sync::LazyLock;
use std::time::Duration;

use fieldproof_dictionary::{Dictionary, eds};
use fieldproof_link::{Instant, Line, NotOffered, Outbox, Participant, Reception, Stimulus};

use super::BlockTransfer;
use crate::canopen::{
    Application, Behaviour, Factory, Profile, Slave, TransmitEvent, block_faults,
};
use crate::script::{assert_same, conforms, departs};
use crate::{DeviceKind, Medium, PortKind, Settings, UnknownFault, Variant};

static DICTIONARY: LazyLock<Dictionary> = LazyLock::new(|| {
    eds::read(
        "[1000]
ParameterName=Device type
DataType=0x0007
AccessType=ro
DefaultValue=0x00020192

[1008]
ParameterName=Device name
DataType=0x0009
AccessType=const
DefaultValue=a name of 20 letters

[1017]
ParameterName=Producer heartbeat time
DataType=0x0006
AccessType=rw
DefaultValue=0

[200F]
ParameterName=Any bytes
DataType=0x000F
AccessType=rw
",
    )
    .dictionary
});

const KIND: DeviceKind = DeviceKind {
    name: "blocks",
    title: "A slave with block transfer",
    ports: &[PortKind {
        role: "can",
        medium: Medium::Can { bit_rate: 500_000 },
    }],
    faults: block_faults::BLOCK,
    variants: &[
        Variant {
            name: "two-a-block",
            words: "takes two segments a block",
            apply: |behaviour| behaviour.canopen.block.block_size = 2,
        },
        Variant {
            name: "no-crc",
            words: "does no CRC and gives no size",
            apply: |behaviour| {
                behaviour.canopen.block.crc = false;
                behaviour.canopen.block.size_given = false;
            },
        },
        Variant {
            name: "no-blocks",
            words: "does no block transfers",
            apply: |behaviour| behaviour.canopen.block.offered = false,
        },
    ],
    build,
};

fn build(settings: &Settings) -> Result<Box<dyn Participant>, UnknownFault> {
    let offered = Behaviour {
        block: BlockTransfer {
            offered: true,
            ..BlockTransfer::default()
        },
        ..Behaviour::default()
    };
    let documented = crate::Behaviour {
        canopen: offered,
        ..crate::Behaviour::default()
    };
    let behaviour = KIND.behaviour(documented, settings)?;
    let profile = Profile {
        dictionary: &DICTIONARY,
        boot_time: Duration::from_millis(8),
        produces_sync: false,
        guarding: false,
        transmit_event: TransmitEvent::TimerOnly,
        lowest_transmit_type: 0,
        lss: None,
        saved_on_write: &[],
        node_object: None,
        bit_rate_object: None,
        twins: &[],
    };
    let factory = Factory {
        node: 1,
        bit_rate: 500_000,
        seed: settings.seed,
    };
    let slave = Slave::new(profile, behaviour.canopen, factory, &mut Nothing);
    Ok(Box::new(Blocks { slave }))
}

/// Its objects mean nothing.
#[derive(Debug)]
struct Nothing;

impl Application for Nothing {}

#[derive(Debug)]
struct Blocks {
    slave: Slave,
}

impl Participant for Blocks {
    fn line(&self, _: usize) -> Line {
        self.slave.line()
    }

    fn receive(&mut self, now: Instant, _: usize, reception: Reception, _: &mut Outbox) {
        if let Reception::Frame(frame) = reception {
            self.slave.receive(now, &frame, &mut Nothing);
        }
    }

    fn wake_at(&self) -> Option<Instant> {
        self.slave.wake_at()
    }

    fn wake(&mut self, now: Instant, out: &mut Outbox) {
        self.slave.wake(now, 0, &mut Nothing, out);
    }

    fn stimulate(&mut self, _: Instant, _: &Stimulus, _: &mut Outbox) -> Result<(), NotOffered> {
        Err(NotOffered)
    }

    fn state(&self) -> std::collections::BTreeMap<String, String> {
        self.slave.state()
    }
}

fn variant(name: &str, script: &str) {
    let settings = Settings {
        variant: Some(name.to_owned()),
        ..Settings::default()
    };
    let told = crate::script::Script::new(&KIND, &settings).play(script);
    assert_same(&told, script);
}

/// 20 bytes are three segments, the last with one byte that is not data; the CRC of `a name of 20 letters` is 4E2Dh.
const UPLOAD: &str = "
    wait 10 ms
    < 701#00
    > 601#A40810007F000000
    < 581#C608100014000000
    > 601#A300000000000000
    < 581#0161206E616D6520
    < 581#026F66203230206C
    < 581#8365747465727300
    > 601#A2037F0000000000
    < 581#C5CRC0000000000
    > 601#A100000000000000
    > 601#4000100000000000
    < 581#4300100092010200
";

fn upload() -> String {
    let [low, high] = super::crc::crc(0, b"a name of 20 letters").to_le_bytes();
    UPLOAD.replace("CRC00", &format!("{low:02X}{high:02X}00"))
}

#[test]
fn uploads() {
    conforms(&KIND, &upload());
}
