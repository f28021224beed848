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
    faults: &[block_faults::BLOCK],
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
        consumes_heartbeats: false,
        transmit_event: TransmitEvent::TimerOnly,
        lowest_transmit_type: 0,
        lss: None,
        saved_on_write: &[],
        node_object: None,
        bit_rate_object: None,
        complete: false,
        clock_object: None,
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

    fn state(&self) -> fieldproof_link::State {
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

/// 20 bytes are three segments, the last with one byte that is not data; their CRC is 9033h.
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
    < 581#C533900000000000
    > 601#A100000000000000
    > 601#4000100000000000
    < 581#4300100092010200
";

#[test]
fn an_upload_ends_with_unused_bytes_and_crc() {
    conforms(&KIND, UPLOAD);
    departs(
        &KIND,
        "block-crc-wrong",
        UPLOAD,
        &[("< 581#C533900000000000", "< 581#C58B660000000000")],
    );
    departs(
        &KIND,
        "block-unused-wrong",
        UPLOAD,
        &[("< 581#C533900000000000", "< 581#C133900000000000")],
    );
    departs(
        &KIND,
        "block-upload-size-wrong",
        UPLOAD,
        &[("< 581#C608100014000000", "< 581#C608100015000000")],
    );
}

/// Blocks of two; of the first only segment 1 came, so that the next begins with segment 2 under number 1.
const RESENT: &str = "
    wait 10 ms
    < 701#00
    > 601#A008100002000000
    < 581#C608100014000000
    > 601#A300000000000000
    < 581#0161206E616D6520
    < 581#026F66203230206C
    > 601#A201010000000000
    < 581#016F66203230206C
    > 601#A2017F0000000000
    < 581#8165747465727300
    > 601#A2017F0000000000
    < 581#C500000000000000
    > 601#A100000000000000
";

#[test]
fn what_was_not_acknowledged_is_sent_again_and_the_block_size_may_change() {
    conforms(&KIND, RESENT);
    departs(
        &KIND,
        "block-size-ignored",
        RESENT,
        &[(
            "< 581#026F66203230206C",
            "< 581#026F66203230206C\n< 581#8365747465727300",
        )],
    );
}

#[test]
fn wrong_uploads_are_refused() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 701#00
        > 601#A408100000000000
        < 581#8008100002000405
        > 601#A408100080000000
        < 581#8008100002000405
        > 601#A40810007F000000
        < 581#C608100014000000
        > 601#A300000000000000
        < 581#0161206E616D6520
        < 581#026F66203230206C
        < 581#8365747465727300
        > 601#A2807F0000000000
        < 581#8008100003000405
        > 601#A300000000000000
        < 581#8000000001000405
        > 601#A4FF5F007F000000
        < 581#80FF5F0000000206
        > 601#A40810007F140000
        < 581#4108100014000000
        > 601#A40810007F130000
        < 581#C608100014000000
        > 601#8008100000000008
        ",
    );
}

/// 15 bytes of which the last segment has one; their CRC is that of the bytes 61h to 6Fh.
const DOWNLOAD: &str = "
    wait 10 ms
    < 701#00
    > 601#C60F20000F000000
    < 581#A40F20007F000000
    > 601#0161626364656667
    > 601#0268696A6B6C6D6E
    > 601#836F000000000000
    < 581#A2037F0000000000
    > 601#D9CRCCRC00000000
    < 581#A100000000000000
    > 601#400F200000000000
    < 581#410F20000F000000
    > 601#8000000000000008
";

fn crc_of(text: &[u8]) -> String {
    let [low, high] = super::crc::crc(0, text).to_le_bytes();
    format!("{low:02X}{high:02X}00")
}

#[test]
fn a_download_is_written_at_its_end() {
    let download = DOWNLOAD.replace("CRCCRC", &crc_of(b"abcdefghijklmno"));
    conforms(&KIND, &download);
    let wrong = DOWNLOAD
        .replace("CRCCRC", "FFFF00")
        .replace("< 581#A100000000000000", "< 581#800F200004000405")
        .replace("< 581#410F20000F000000", "< 581#410F200000000000");
    conforms(&KIND, &wrong);
    departs(
        &KIND,
        "block-crc-unchecked",
        &wrong,
        &[
            ("< 581#800F200004000405", "< 581#A100000000000000"),
            ("< 581#410F200000000000", "< 581#410F20000F000000"),
        ],
    );
}

#[test]
fn a_lost_segment_is_asked_for_again() {
    // Segment 2 of three is lost, then it comes under number 1.
    let script = "
        wait 10 ms
        < 701#00
        > 601#C20F20000F000000
        < 581#A40F20007F000000
        > 601#0161626364656667
        > 601#836F000000000000
        < 581#A2017F0000000000
        > 601#0168696A6B6C6D6E
        > 601#826F000000000000
        < 581#A2027F0000000000
        > 601#D900000000000000
        < 581#A100000000000000
    ";
    conforms(&KIND, script);
}

#[test]
fn a_block_whose_end_is_lost_is_acknowledged_after_a_pause_and_given_up_later() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 701#00
        > 601#C20F20000F000000
        < 581#A40F20007F000000
        > 601#0161626364656667
        wait 101 ms
        < 581#A2017F0000000000
        wait 2001 ms
        < 581#800F200000000405
        > 601#A40810007F000000
        < 581#C608100014000000
        wait 2001 ms
        < 581#8008100000000405
        ",
    );
}

#[test]
fn wrong_downloads_are_refused() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 701#00
        > 601#C200100004000000
        < 581#8000100002000106
        > 601#C217100003000000
        < 581#8017100012000706
        > 601#C20F20000F000000
        < 581#A40F20007F000000
        > 601#0061626364656667
        < 581#800F200003000405
        > 601#C20F200007000000
        < 581#A40F20007F000000
        > 601#8161626364656667
        < 581#A2017F0000000000
        > 601#C500000000000000
        < 581#800F200010000706
        > 601#C100000000000000
        < 581#8000000001000405
        ",
    );
}

#[test]
fn small_blocks_no_crc_and_no_blocks_at_all() {
    variant(
        "two-a-block",
        "
        wait 10 ms
        < 701#00
        > 601#C20F20000F000000
        < 581#A40F200002000000
        > 601#0161626364656667
        > 601#0268696A6B6C6D6E
        < 581#A202020000000000
        > 601#816F000000000000
        < 581#A201020000000000
        > 601#D900000000000000
        < 581#A100000000000000
        ",
    );
    variant(
        "no-crc",
        "
        wait 10 ms
        < 701#00
        > 601#A40810007F000000
        < 581#C008100000000000
        > 601#A300000000000000
        < 581#0161206E616D6520
        < 581#026F66203230206C
        < 581#8365747465727300
        > 601#A2037F0000000000
        < 581#C500000000000000
        > 601#A100000000000000
        ",
    );
    variant(
        "no-blocks",
        "
        wait 10 ms
        < 701#00
        > 601#A40810007F000000
        < 581#8008100001000405
        > 601#C60F20000F000000
        < 581#800F200001000405
        ",
    );
}
