//! PDOs frame by frame: what the slave does, and what it does with a fault.

use super::KIND;
use crate::script::{conforms, departs};

/// RPDO1 is mapped to 2006h alone (16 bits); its type is written where `TYPE` stands.
const MAP_RPDO1: &str = "
    wait 10 ms
    < 70A#00
    > 60A#230014010A020080
    < 58A#6000140100000000
    > 60A#2F00160000000000
    < 58A#6000160000000000
    > 60A#2300160110000620
    < 58A#6000160100000000
    > 60A#2F00160001000000
    < 58A#6000160000000000
    > 60A#2F001402TYPE000000
    < 58A#6000140200000000
    > 60A#230014010A020000
    < 58A#6000140100000000
    > 000#010A
    < 18A#E803A0860100
    < 38A#FFFDFFFFFF
";

fn with_type(kind: &str, then: &str) -> String {
    MAP_RPDO1.replace("TYPE", kind) + then
}

fn departs_once(fault: &str, right: &str, from: &str, to: &str) {
    departs(&KIND, fault, right, &[(from, to)]);
}

#[test]
fn an_rpdo_takes_effect_at_once_or_with_sync() {
    let read = "
    > 60A#4006200000000000
    < 58A#4B0620000600VALUE
    ";
    let at_once = with_type("FF", "> 20A#0600") + &read.replace("VALUE", "0000");
    // The value that is set is shown in TPDO1, which sends it as it changes.
    let at_once = at_once.replace("> 20A#0600", "> 20A#0600\n    < 18A#0600A0860100");
    conforms(&KIND, &at_once);
    let waits = with_type(
        "00",
        "> 20A#0600
    > 60A#4006200000000000
    < 58A#4B062000E8030000
    > 20A#0700
    > 080#
    < 28A#0500000000000000
    < 18A#0700A0860100
    > 60A#4006200000000000
    < 58A#4B06200007000000
    ",
    );
    conforms(&KIND, &waits);
    let first = [
        ("< 18A#0700A0860100", "< 18A#0600A0860100"),
        ("< 58A#4B06200007000000", "< 58A#4B06200006000000"),
    ];
    departs(&KIND, "first-rpdo-counts", &waits, &first);
}

#[test]
fn an_rpdo_that_is_too_short_is_reported_and_not_taken() {
    let short = with_type(
        "FF",
        "> 20A#06
    < 08A#1082000000000000
    > 20A#
    < 08A#1082000000000000
    > 60A#4006200000000000
    < 58A#4B062000E8030000
    > 20A#060099
    < 08A#2082000000000000
    < 18A#0600A0860100
    ",
    );
    conforms(&KIND, &short);
}

#[test]
fn what_exists_stays_as_it_is() {
    conforms(
        &KIND,
        "
        wait 10 ms
        < 70A#00
        > 60A#2300180180060000
        < 58A#8000180122000008
        > 60A#230018018A010040
        < 58A#6000180100000000
        > 60A#2B00180364000000
        < 58A#8000180322000008
        > 60A#2F00180603000000
        < 58A#8000180622000008
        > 60A#2F001A0000000000
        < 58A#80001A0022000008
        > 60A#23001801672345E1
        < 58A#8000180130000906
        ",
    );
}

#[test]
fn what_cannot_be_mapped_is_refused_and_leaves_what_was_there() {
    let refused = "
        wait 10 ms
        < 70A#00
        > 60A#230018018A0100C0
        < 58A#6000180100000000
        > 60A#23001A0110000321
        < 58A#80001A0122000008
        > 60A#2F001A0000000000
        < 58A#60001A0000000000
        > 60A#23001A0110000620
        < 58A#80001A0141000406
        > 60A#23001A0110000222
        < 58A#80001A0141000406
        > 60A#23001A0120000621
        < 58A#80001A0141000406
        > 60A#23001A0120000030
        < 58A#80001A0100000206
        > 60A#40001A0100000000
        < 58A#43001A0110000621
        > 60A#23001A014000001B
        < 58A#80001A0100000206
        > 60A#23001A0140001B21
        < 58A#60001A0100000000
        > 60A#2F001A0002000000
        < 58A#80001A0042000406
        > 60A#2F001A0009000000
        < 58A#80001A0031000906
        ";
    conforms(&KIND, refused);
    departs_once(
        "refused-entry-clears",
        refused,
        "< 58A#43001A0110000621",
        "< 58A#43001A0100000000",
    );
    departs_once(
        "mapping-length-unchecked",
        refused,
        "< 58A#80001A0042000406",
        "< 58A#60001A0000000000",
    );
}

#[test]
fn a_tpdo_of_type_0_is_sent_with_the_sync_after_a_change() {
    let acyclic = "
        wait 10 ms
        < 70A#00
        > 60A#2F00180200000000
        < 58A#6000180200000000
        > 000#010A
        < 38A#FFFDFFFFFF
        > 080#
        < 28A#0500000000000000
        > 60A#2B06200034120000
        < 58A#6006200000000000
        > 080#
        < 18A#3412A0860100
        < 28A#0500000000000000
        > 080#
        < 28A#0500000000000000
        ";
    conforms(&KIND, acyclic);
    // TPDO4 is of type 0 as well.
    let also = |first: &str| format!("{first}< 28A#0500000000000000\n< 48A#0000C03FFEFF");
    let (first, others) = (also("< 18A#E803A0860100\n"), also("< 18A#3412A0860100\n"));
    let second = also("");
    let always = [
        ("< 28A#0500000000000000", first.as_str()),
        ("< 28A#0500000000000000", second.as_str()),
        ("< 28A#0500000000000000", others.as_str()),
    ];
    departs(&KIND, "acyclic-tpdo-every-sync", acyclic, &always);
}
