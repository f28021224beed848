//! No text makes a reader panic, and what comes out keeps its promises.

use fieldproof_dictionary::eds;
use proptest::prelude::*;

/// Lines that reach deep into the reader.
fn line() -> impl Strategy<Value = String> {
    let section = prop_oneof![
        "\\[[0-9A-F]{4}\\]",
        "\\[[12][0-9]{3}sub[0-9A-Fa-f]{0,3}\\]",
        "\\[DeviceInfo\\]",
        "\\[(Mandatory|Optional|Manufacturer)Objects\\]",
        "\\[(1400|1600|1800|1A00)(sub[0-2])?\\]"
    ];
    let key = prop::sample::select(vec![
        "ParameterName",
        "ObjectType",
        "DataType",
        "AccessType",
        "LowLimit",
        "HighLimit",
        "DefaultValue",
        "PDOMapping",
        "SubNumber",
        "CompactSubObj",
        "SupportedObjects",
        "1",
        "NrOfRXPDO",
        "Granularity",
        "CreationDate",
        "ModificationTime",
        "VendorNumber",
        "BaudRate_50",
        "BaudRate_99999999999",
    ]);
    let value = prop_oneof![
        "-?(0x|0X|0)?[0-9A-Fa-f]{1,20}",
        "\\$NODEID ?\\+ ?0x[0-9A-F]{1,16}",
        "(ro|rw|wo|const|2|7|8|9|0x1B|0x15)",
        "\\PC{0,12}",
    ];
    prop_oneof![
        section,
        (key, value).prop_map(|(key, value)| format!("{key}={value}")),
        "\\PC{0,20}"
    ]
}

fn check(text: &str) {
    let lines = text.lines().count();
    let eds = eds::read(text);
    for finding in &eds.findings {
        assert!((1..=lines).contains(&finding.line), "{finding:?}");
    }
    for finding in eds::check(&eds) {
        assert!((1..=lines.max(1)).contains(&finding.line), "{finding:?}");
        assert!(!finding.text.is_empty() && !finding.help.is_empty());
    }
    let again = eds::read(&eds::write(&eds));
    let shape = |eds: &eds::Eds| -> Vec<(u16, u8)> {
        eds.dictionary
            .entries()
            .map(|(index, sub, _)| (index, sub))
            .collect()
    };
    assert_eq!(shape(&eds), shape(&again));
    for (_, _, entry) in eds.dictionary.entries() {
        assert!((1..=lines).contains(&entry.line));
        if let (Some(bytes), Some(size)) = (entry.default_bytes(127), entry.data_type.bytes()) {
            assert_eq!(bytes.len(), size);
        }
        for limit in [entry.low_limit, entry.high_limit].into_iter().flatten() {
            assert!(limit.value(0) <= limit.value(127));
        }
    }
}

proptest! {
    #[test]
    fn eds_of_any_bytes(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        check(&eds::decode(&bytes));
    }

    #[test]
    fn eds_of_likely_lines(lines in prop::collection::vec(line(), 0..60)) {
        check(&lines.join("\n"));
    }
}
