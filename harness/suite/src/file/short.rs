//! The short forms of the verbs.

use crate::forms::TwoForms;
use crate::model::{
    Connect, Crc, Disconnect, Expect, ExpectBootUp, ExpectBytes, ExpectSilence, Judge, Nmt,
    NmtAddress, NmtCommand, Send, SendBytes, Sync,
};
use crate::scalar::{BytePatternText, Bytes, FrameText, PatternText, Time};

macro_rules! short_form {
    ($($type:ident from $short:ty: $from_short:expr;)+) => {
        $(impl TwoForms for $type {
            type Short = $short;
            type Full = $type;

            fn from_short(short: $short) -> $type {
                let from_short: fn($short) -> $type = $from_short;
                from_short(short)
            }

            fn from_full(full: $type) -> $type {
                full
            }
        })+
    };
}

short_form! {
    Send from FrameText: |frame| Send { frame };
    Expect from PatternText: |frame| Expect {
        frame,
        or: Vec::new(),
        within: None,
        decode: Vec::new(),
        period: None,
        count: 0,
        judge: Judge::default(),
        check: None,
    };
    ExpectSilence from Time: |time| ExpectSilence {
        lasting: time.0,
        of: Vec::new(),
        port: None,
        check: None,
    };
    Nmt from NmtCommand: |command| Nmt { command, node: NmtAddress::This };
    ExpectBootUp from Option<Time>: |within| ExpectBootUp {
        within: within.map(|time| time.0),
        node: None,
    };
    Sync from (): |()| Sync { count: 1, period: std::time::Duration::ZERO };
    SendBytes from Bytes: |bytes| SendBytes {
        bytes,
        crc: Crc::Given,
        then: Vec::new(),
        pause: None,
        spoil: None,
        port: None,
    };
    Connect from String: |name| Connect { name };
    Disconnect from String: |name| Disconnect { name, reset: false };
    ExpectBytes from BytePatternText: |bytes| ExpectBytes {
        bytes,
        or: Vec::new(),
        within: None,
        port: None,
        decode: Vec::new(),
        check: None,
    };
}
