//! Expedited and segmented transfers of a slave that has everything, as frames see them.

use crate::Settings;
use crate::canopen_complete::KIND;
use crate::script::{Script, assert_same, conforms, departs};

/// 1008h is `canopen-complete`.
const UPLOAD: &str = "
    wait 10 ms
    < 70A#00
    > 60A#4008100000000000
    < 58A#4108100010000000
    > 60A#6000000000000000
    < 58A#0063616E6F70656E
    > 60A#7000000000000000
    < 58A#102D636F6D706C65
    > 60A#6000000000000000
    < 58A#0B74650000000000
    > 60A#7000000000000000
    < 58A#8000000001000405
";

#[test]
fn an_upload_in_segments() {
    let last = "< 58A#0B74650000000000";
    let after = "< 58A#8000000001000405";
    departs(
        &KIND,
        "segment-last-not-marked",
        UPLOAD,
        &[(last, "< 58A#0A74650000000000")],
    );
    departs(
        &KIND,
        "segment-unused-wrong",
        UPLOAD,
        &[(last, "< 58A#0174650000000000")],
    );
    departs(
        &KIND,
        "segmented-size-wrong",
        UPLOAD,
        &[("< 58A#4108100010000000", "< 58A#4108100011000000")],
    );
    departs(
        &KIND,
        "stray-segment-answered",
        UPLOAD,
        &[(after, "< 58A#1100000000000000")],
    );
}

/// A wrong toggle bit, and what is left of the transfer.
const TOGGLE: &str = "
    wait 10 ms
    < 70A#00
    > 60A#4008100000000000
    < 58A#4108100010000000
    > 60A#7000000000000000
    < 58A#8008100000000305
    > 60A#6000000000000000
    < 58A#8000000001000405
";

#[test]
fn the_toggle_bit_of_an_upload() {
    departs(
        &KIND,
        "upload-toggle-unchecked",
        TOGGLE,
        &[
            ("< 58A#8008100000000305", "< 58A#1063616E6F70656E"),
            ("< 58A#8000000001000405", "< 58A#002D636F6D706C65"),
        ],
    );
    departs(
        &KIND,
        "own-abort-not-final",
        TOGGLE,
        &[("< 58A#8000000001000405", "< 58A#0063616E6F70656E")],
    );
    departs(
        &KIND,
        "abort-names-request-bytes",
        TOGGLE,
        &[("< 58A#8008100000000305", "< 58A#8000000000000305")],
    );
}

/// 200Fh gets nine bytes; the first segment comes twice in the second transfer.
const DOWNLOAD: &str = "
    wait 10 ms
    < 70A#00
    > 60A#210F200009000000
    < 58A#600F200000000000
    > 60A#0011223344556677
    < 58A#2000000000000000
    > 60A#1B88990000000000
    < 58A#3000000000000000
    > 60A#210F200015000000
    < 58A#600F200000000000
    > 60A#0011223344556677
    < 58A#2000000000000000
    > 60A#0011223344556677
    < 58A#800F200000000305
    > 60A#400F200000000000
    < 58A#410F200009000000
    > 60A#800F200000000008
";

#[test]
fn a_download_in_segments() {
    departs(
        &KIND,
        "segment-answer-dirty",
        DOWNLOAD,
        &[
            ("< 58A#2000000000000000", "< 58A#2011223344556677"),
            ("< 58A#3000000000000000", "< 58A#3088990000000000"),
            ("< 58A#2000000000000000", "< 58A#2011223344556677"),
        ],
    );
    departs(
        &KIND,
        "download-toggle-unchecked",
        DOWNLOAD,
        &[("< 58A#800F200000000305", "< 58A#2000000000000000")],
    );
    departs(
        &KIND,
        "download-unused-ignored",
        DOWNLOAD,
        &[("< 58A#410F200009000000", "< 58A#410F20000E000000")],
    );
    departs(
        &KIND,
        "client-abort-refused",
        DOWNLOAD,
        &[(
            "> 60A#800F200000000008",
            "> 60A#800F200000000008\n< 58A#800F200001000405",
        )],
    );
}

/// Fewer bytes than were said, more, an empty value, and one without its size.
const SIZES: &str = "
    wait 10 ms
    < 70A#00
    > 60A#210F20000A000000
    < 58A#600F200000000000
    > 60A#0111223344556677
    < 58A#800F200010000706
    > 60A#210F200005000000
    < 58A#600F200000000000
    > 60A#0111223344556677
    < 58A#800F200012000706
    > 60A#200F200000000000
    < 58A#600F200000000000
    > 60A#0F00000000000000
    < 58A#2000000000000000
    > 60A#400F200000000000
    < 58A#410F200000000000
    > 60A#6000000000000000
    < 58A#0F00000000000000
";

#[test]
fn sizes_that_are_wrong_or_not_given() {
    departs(
        &KIND,
        "download-size-unchecked",
        SIZES,
        &[
            ("< 58A#800F200010000706", "< 58A#2000000000000000"),
            ("< 58A#800F200012000706", "< 58A#2000000000000000"),
        ],
    );
    departs(
        &KIND,
        "unsized-download-refused",
        SIZES,
        &[
            ("< 58A#600F200000000000", "< 58A#600F200000000000"),
            ("< 58A#600F200000000000", "< 58A#600F200000000000"),
            ("< 58A#600F200000000000", "< 58A#800F200001000405"),
            ("< 58A#2000000000000000", "< 58A#8000000001000405"),
        ],
    );
    departs(
        &KIND,
        "empty-value-padded",
        SIZES,
        &[
            ("< 58A#410F200000000000", "< 58A#430F200000000000"),
            ("< 58A#0F00000000000000", "< 58A#8000000001000405"),
        ],
    );
}

/// What is refused in one frame: lengths, limits, access, what does not exist; short requests are not answered.
const REFUSALS: &str = "
    wait 10 ms
    < 70A#00
    > 60A#2306200034120000
    < 58A#8006200012000706
    > 60A#2F06200034000000
    < 58A#8006200013000706
    > 60A#2B06200061EA0000
    < 58A#8006200031000906
    > 60A#2B06200000000000
    < 58A#8006200032000906
    > 60A#2B062000E8030000
    < 58A#6006200000000000
    > 60A#2300100000000000
    < 58A#8000100002000106
    > 60A#4000220000000000
    < 58A#8000220001000106
    > 60A#4004220300000000
    < 58A#8004220311000906
    > 60A#4005220000000000
    < 58A#8005220000000206
    > 60A#40001000
    > 60B#4000100000000000
    > 60A#4000100000000000
    < 58A#4300100000000000
";

#[test]
fn what_is_refused() {
    let departs = |fault, changes: &[(&str, &str)]| departs(&KIND, fault, REFUSALS, changes);
    let written = "< 58A#6006200000000000";
    departs(
        "length-unchecked",
        &[
            ("< 58A#8006200012000706", written),
            ("< 58A#8006200013000706", written),
        ],
    );
    departs(
        "high-limit-unchecked",
        &[("< 58A#8006200031000906", written)],
    );
    departs(
        "low-limit-unchecked",
        &[("< 58A#8006200032000906", written)],
    );
    departs("same-value-refused", &[(written, "< 58A#8006200022000008")]);
    departs(
        "read-only-confirmed",
        &[("< 58A#8000100002000106", "< 58A#6000100000000000")],
    );
    departs(
        "write-only-read",
        &[("< 58A#8000220001000106", "< 58A#4300220000000000")],
    );
    departs(
        "gap-read",
        &[("< 58A#8004220311000906", "< 58A#4304220300000000")],
    );
    departs(
        "unknown-object-read",
        &[("< 58A#8005220000000206", "< 58A#4305220000000000")],
    );
    departs(
        "short-request-executed",
        &[("> 60A#40001000", "> 60A#40001000\n< 58A#4300100000000000")],
    );
    departs(
        "sdo-of-the-next-node-answered",
        &[(
            "> 60B#4000100000000000",
            "> 60B#4000100000000000\n< 58A#4300100000000000",
        )],
    );
}

/// With the fault the upload times out, and the reset is all that helps.
const ABANDONED: &str = "
    wait 10 ms
    < 70A#00
    > 60A#4008100000000000
    < 58A#4108100010000000
    wait 1100 ms
    > 60A#4000100000000000
    < 58A#4300100000000000
    > 000#820A
    wait 10 ms
    < 70A#00
    > 60A#4000100000000000
    < 58A#4300100000000000
";

#[test]
fn a_transfer_is_abandoned() {
    departs(
        &KIND,
        "stuck-after-time-out",
        ABANDONED,
        &[
            ("wait 1100 ms", "wait 1100 ms\n< 58A#8008100000000405"),
            ("< 58A#4300100000000000", ""),
        ],
    );
}

#[test]
fn a_variant_is_careful() {
    let settings = Settings {
        variant: Some("careful-sdo".to_owned()),
        ..Settings::default()
    };
    let script = "
        wait 10 ms
        < 70A#00
        > 60A#4008100000000000
        < 58A#4108100010000000
        > 60A#4000100000000000
        < 58A#8000100001000405
        > 60A#4008100000000000
        < 58A#4108100010000000
        wait 600 ms
        < 58A#8008100000000405
        > 60A#40001000
        < 58A#8000100001000405
    ";
    assert_same(&Script::new(&KIND, &settings).play(script), script);
}

/// 1201h answers on 6A1h; both servers are in an upload at the same time.
const SERVERS: &str = "
    wait 10 ms
    < 70A#00
    > 6A0#4000100000000000
    > 60A#23011201A0060000
    < 58A#6001120100000000
    > 60A#23011202A1060000
    < 58A#6001120200000000
    > 60A#4008100000000000
    < 58A#4108100010000000
    > 6A0#4008100000000000
    < 6A1#4108100010000000
    > 60A#6000000000000000
    < 58A#0063616E6F70656E
    > 6A0#6000000000000000
    < 6A1#0063616E6F70656E
    > 6A0#8008100000000008
    > 60A#7000000000000000
    < 58A#102D636F6D706C65
";

#[test]
fn servers_are_apart() {
    departs(
        &KIND,
        "servers-share-a-transfer",
        SERVERS,
        &[
            ("< 6A1#0063616E6F70656E", "< 6A1#8008100000000305"),
            ("< 58A#102D636F6D706C65", "< 58A#8000000001000405"),
        ],
    );
}

#[test]
fn every_condition_refuses_with_its_code() {
    let code = |condition: &str, code: &str| {
        conforms(
            &KIND,
            &format!(
                "
                wait 10 ms
                < 70A#00
                begin {condition}
                > 60A#2B062000E8030000
                < 58A#80062000{code}
                end {condition}
                > 60A#2B062000E8030000
                < 58A#6006200000000000
                "
            ),
        );
    };
    code("local-control", "21000008");
    code("wrong-device-state", "22000008");
    code("storage-refused", "20000008");
    code("out-of-memory", "05000405");
    code("internal-incompatibility", "47000406");
    code("general-error", "00000008");
    code("no-connection-left", "23000A06");
    code("no-dictionary", "23000008");
    conforms(
        &KIND,
        "
        wait 10 ms
        < 70A#00
        begin no-data
        > 60A#4006200000000000
        < 58A#8006200024000008
        end no-data
        > 60A#4006200000000000
        < 58A#4B062000E8030000
        ",
    );
}
