//! How long a large EDS file takes.

use std::fmt::Write;

use fieldproof_dictionary::eds;

fn main() {
    divan::main();
}

/// A file of `objects` objects of the manufacturer, each listed.
fn file(objects: u16) -> String {
    let mut text =
        String::from("[DeviceInfo]\nVendorNumber=1\nBaudRate_500=1\n[ManufacturerObjects]\n");
    let _ = writeln!(text, "SupportedObjects={objects}");
    for number in 0..objects {
        let _ = writeln!(text, "{}=0x{:04X}", number + 1, 0x2000 + number);
    }
    for number in 0..objects {
        let _ = writeln!(
            text,
            "[{:04X}]\nParameterName=Object {number}\nObjectType=0x7\nDataType=0x0007\nAccessType=rw\n\
             DefaultValue=0x{number:08X}\nPDOMapping=0\nLowLimit=0\nHighLimit=0xFFFFFFFF\nObjFlags=0x0",
            0x2000 + number
        );
    }
    text
}

#[divan::bench(args = [100, 1_000, 10_000])]
fn read_and_check(bencher: divan::Bencher<'_, '_>, objects: u16) {
    let text = file(objects);
    bencher.bench(|| eds::check(&eds::read(divan::black_box(&text))).len());
}

#[divan::bench]
fn read_10_000(bencher: divan::Bencher<'_, '_>) {
    let text = file(10_000);
    bencher.bench(|| eds::read(divan::black_box(&text)));
}

#[divan::bench]
fn check_10_000(bencher: divan::Bencher<'_, '_>) {
    let eds = eds::read(&file(10_000));
    bencher.bench(|| eds::check(divan::black_box(&eds)).len());
}

#[divan::bench]
fn write_10_000(bencher: divan::Bencher<'_, '_>) {
    let eds = eds::read(&file(10_000));
    bencher.bench(|| eds::write(divan::black_box(&eds)).len());
}
