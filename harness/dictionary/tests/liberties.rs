//! One small file per liberty that an EDS may take.

use fieldproof_dictionary::eds::{self, Eds};
use fieldproof_dictionary::{Access, DataType, Default, Number, ObjectKind};

/// A variable with the lines `keys` in its section.
fn variable(keys: &str) -> Eds {
    eds::read(&format!(
        "[2000]\nParameterName=it\nObjectType=7\nAccessType=rw\n{keys}\n"
    ))
}

fn default_of(data_type: &str, value: &str) -> Option<Vec<u8>> {
    let eds = variable(&format!("DataType={data_type}\nDefaultValue={value}"));
    eds.dictionary.entry(0x2000, 0)?.default_bytes(2)
}

#[test]
fn line_ends() {
    for end in ["\n", "\r\n"] {
        let eds = eds::read(&["[1000]", "DataType=7", "AccessType=ro", ""].join(end));
        assert_eq!(eds.findings, []);
        let entry = eds.dictionary.entry(0x1000, 0).unwrap();
        assert_eq!((entry.data_type, entry.line), (DataType::Unsigned32, 1));
    }
}

#[test]
fn case_of_keys_words_and_sections() {
    let eds = eds::read("[1a00SUB0a]\nDATATYPE=0x5\naccesstype=CONST\n[1A00]\nobjecttype=9\n");
    assert_eq!(eds.findings, []);
    let entry = eds.dictionary.entry(0x1A00, 10).unwrap();
    assert_eq!(entry.access, Access::Constant);
    assert_eq!(entry.data_type, DataType::Unsigned8);
}

#[test]
fn every_access_word() {
    let words = [
        ("ro", Access::ReadOnly, true, false),
        ("wo", Access::WriteOnly, false, true),
        ("RW", Access::ReadWrite, true, true),
        ("rwr", Access::ReadWriteOnRead, true, true),
        ("rww", Access::ReadWriteOnWrite, true, true),
        ("Const", Access::Constant, true, false),
    ];
    for (word, access, readable, writable) in words {
        let eds = eds::read(&format!("[2000]\nDataType=5\nAccessType={word}"));
        let read = eds.dictionary.entry(0x2000, 0).unwrap().access;
        assert_eq!(read, access);
        assert_eq!((read.readable(), read.writable()), (readable, writable));
    }
}

#[test]
fn blanks() {
    let eds = variable("  DataType =  0x0007 \n DefaultValue\t=  12  \n");
    assert_eq!(eds.findings, []);
    assert_eq!(
        eds.dictionary.entry(0x2000, 0).unwrap().default_bytes(1),
        Some(vec![12, 0, 0, 0])
    );
}

#[test]
fn bases_of_numbers() {
    for text in ["26", "0x1A", "0X1a", "032", "0x0000001A"] {
        assert_eq!(default_of("6", text), Some(vec![26, 0]), "{text}");
    }
    assert_eq!(default_of("0006", "26"), Some(vec![26, 0]));
    assert_eq!(default_of("0X6", "26"), Some(vec![26, 0]));
}

#[test]
fn node_in_any_order_and_case() {
    for text in [
        "$NODEID+0x180",
        "$NodeID + 0x180",
        "0x180+$nodeid",
        " 384 + $NODEID ",
        "$NodeID+0X00000180",
    ] {
        assert_eq!(default_of("7", text), Some(vec![0x82, 1, 0, 0]), "{text}");
    }
    assert_eq!(default_of("5", "$NODEID"), Some(vec![2]));
}

#[test]
fn what_is_no_sum_with_a_node_is_found() {
    for text in [
        "$NODEID+",
        "$NODEID+$NODEID",
        "1+2",
        "NODEID+1",
        "$NODEID-1",
        "$NODEID 1",
        "$NODEID+0xFFFFFFFFFFFFFFFF+1",
    ] {
        let eds = variable(&format!("DataType=7\nDefaultValue={text}"));
        let entry = eds.dictionary.entry(0x2000, 0).unwrap();
        assert_eq!(entry.default, None, "{text}");
        assert_eq!(eds.findings.len(), 1, "{text}");
        assert!(eds.findings[0].lost && eds.findings[0].line == 6);
    }
}

#[test]
fn sub_indices_are_hexadecimal() {
    let eds = eds::read(
        "[2025]\nObjectType=9\nSubNumber=2\n[2025sub11]\nDataType=6\nAccessType=rw\n\
         [2025sub2A]\nDataType=6\nAccessType=ro\n",
    );
    let subs: Vec<u8> = eds
        .dictionary
        .object(0x2025)
        .unwrap()
        .entries
        .keys()
        .copied()
        .collect();
    assert_eq!(subs, [0x11, 0x2A]);
}

#[test]
fn any_order_of_sections_and_no_trust_in_counts() {
    let eds = eds::read(
        "[1018sub1]\nDataType=7\nAccessType=ro\n[2000]\nDataType=5\nAccessType=ro\n\
         [1018]\nObjectType=9\nSubNumber=0x1\n[1018sub0]\nDataType=5\nAccessType=ro\n\
         [MandatoryObjects]\nSupportedObjects=7\n",
    );
    assert_eq!(eds.findings, []);
    let indices: Vec<u16> = eds
        .dictionary
        .objects()
        .map(|object| object.index)
        .collect();
    assert_eq!(indices, [0x1018, 0x2000]);
    let entries: Vec<(u16, u8)> = eds
        .dictionary
        .entries()
        .map(|(index, sub, _)| (index, sub))
        .collect();
    assert_eq!(entries, [(0x1018, 0), (0x1018, 1), (0x2000, 0)]);
}

#[test]
fn comments_and_semicolons_in_values() {
    let eds = eds::read(
        "; a comment\n[6040]\n ;DataType=5\nParameterName=Control word;\nDataType=6\nAccessType=rw\n",
    );
    assert_eq!(eds.findings, []);
    let entry = eds.dictionary.entry(0x6040, 0).unwrap();
    assert_eq!(
        (entry.name.as_str(), entry.data_type),
        ("Control word;", DataType::Unsigned16)
    );
}

#[test]
fn unknown_sections_and_keys() {
    let eds = eds::read(
        "[DynamicChannels]\n[Tools]\nItems=1\n[2000Valu]\n1=2\n[20001]\nA=1\n[2000subG]\nA=1\n\
         [2000]\nDataType=5\nAccessType=ro\nObjFlags=1\nColour=blue\n",
    );
    assert_eq!(eds.findings, []);
    assert_eq!(eds.dictionary.entries().count(), 1);
}

#[test]
fn unknown_types_and_kinds_are_kept() {
    let eds =
        eds::read("[2000]\nObjectType=4\n[2001]\nDataType=0x23\nAccessType=ro\nDefaultValue=any\n");
    assert_eq!(
        eds.dictionary.object(0x2000).unwrap().kind,
        ObjectKind::Unknown(4)
    );
    let entry = eds.dictionary.entry(0x2001, 0).unwrap();
    assert_eq!(entry.data_type, DataType::Unknown(0x23));
    assert_eq!(entry.default, Some(Default::Text("any".to_owned())));
    assert_eq!(entry.default_bytes(1), None);
}

#[test]
fn an_object_without_object_type_is_a_variable() {
    let eds = eds::read("[2000]\nDataType=5\nAccessType=ro\n");
    assert_eq!(
        eds.dictionary.object(0x2000).unwrap().kind,
        ObjectKind::Variable
    );
}

#[test]
fn a_domain_needs_no_data_type() {
    let eds = eds::read("[1021]\nObjectType=0x2\nAccessType=ro\n");
    assert_eq!(eds.findings, []);
    assert_eq!(
        eds.dictionary.entry(0x1021, 0).unwrap().data_type,
        DataType::Domain
    );
}

#[test]
fn entries_without_an_object_make_one() {
    let one = "[2000sub1]\nDataType=5\nAccessType=ro\n";
    let eds = eds::read(&format!("{one}[2000SUB2]\nDataType=6\nAccessType=ro\n"));
    assert_eq!(eds.dictionary.object(0x2000).unwrap().entries.len(), 2);
    assert_eq!(eds.findings.len(), 1);
    assert!(!eds.findings[0].lost);
    let again = eds::read(&format!("{one}[2000SUB1]\nDataType=6\nAccessType=ro\n"));
    let entry = again.dictionary.entry(0x2000, 1).unwrap();
    assert_eq!(entry.data_type, DataType::Unsigned8);
    assert_eq!(again.findings.len(), 2);
    assert!(again.findings[1].lost && again.findings[1].line == 4);
}

#[test]
fn compact_arrays() {
    let eds = eds::read(
        "[2000]\nParameterName=Step\nObjectType=8\nCompactSubObj=3\nDataType=6\nAccessType=rw\nDefaultValue=7\n\
         [2000sub2]\nParameterName=Special\nDataType=6\nAccessType=ro\n",
    );
    assert_eq!(eds.findings, []);
    let dictionary = &eds.dictionary;
    assert_eq!(
        dictionary.entry(0x2000, 0).unwrap().default_bytes(1),
        Some(vec![3])
    );
    assert_eq!(
        dictionary.entry(0x2000, 1).unwrap().default_bytes(1),
        Some(vec![7, 0])
    );
    assert_eq!(dictionary.entry(0x2000, 2).unwrap().name, "Special");
    assert_eq!(dictionary.entry(0x2000, 3).unwrap().name, "Step3");
    assert!(dictionary.entry(0x2000, 4).is_none());
}

#[test]
fn limits_of_signed_types_in_either_notation() {
    for (low, high) in [("-32768", "32767"), ("0x8000", "0x7FFF")] {
        let eds = variable(&format!("DataType=3\nLowLimit={low}\nHighLimit={high}"));
        let entry = eds.dictionary.entry(0x2000, 0).unwrap();
        assert_eq!(entry.low_limit, Some(Number::absolute(-32768)));
        assert_eq!(entry.high_limit.unwrap().value(1), 32767);
    }
}

#[test]
fn empty_values_are_no_values() {
    let eds = variable("DataType=6\nLowLimit=\nHighLimit=\nDefaultValue=\nPDOMapping=");
    assert_eq!(eds.findings, []);
    let entry = eds.dictionary.entry(0x2000, 0).unwrap();
    assert_eq!(
        (entry.low_limit, entry.high_limit, &entry.default),
        (None, None, &None)
    );
    assert!(!entry.pdo_mapping);
}

#[test]
fn strings_and_reals() {
    assert_eq!(default_of("9", "JN5-CM-CAN"), Some(b"JN5-CM-CAN".to_vec()));
    assert_eq!(default_of("9", "10"), Some(b"10".to_vec()));
    assert_eq!(
        default_of("8", "0x3FC00000"),
        Some(1.5_f32.to_le_bytes().to_vec())
    );
    assert_eq!(default_of("8", "2"), Some(2.0_f32.to_le_bytes().to_vec()));
    assert_eq!(
        default_of("0x11", "-0.5"),
        Some((-0.5_f64).to_le_bytes().to_vec())
    );
}

#[test]
fn limits_of_reals_are_bit_patterns() {
    let eds = variable("DataType=8\nLowLimit=-0.5\nHighLimit=0x3FC00000\nDefaultValue=1.25");
    assert_eq!(eds.findings, []);
    let entry = eds.dictionary.entry(0x2000, 0).unwrap();
    let bits = |value: f32| Some(Number::absolute(i128::from(value.to_bits())));
    assert_eq!((entry.low_limit, entry.high_limit), (bits(-0.5), bits(1.5)));
}

#[test]
fn repeated_keys_and_sections_are_found() {
    let eds = eds::read(
        "[2000]\nDataType=5\nDataType=6\nAccessType=ro\n[2000]\nDataType=7\nAccessType=rw\n\
         [2001]\nObjectType=9\n[2001sub1]\nDataType=5\nAccessType=ro\n[2001sub01]\nDataType=6\nAccessType=ro\n",
    );
    assert_eq!(
        eds.dictionary.entry(0x2000, 0).unwrap().data_type,
        DataType::Unsigned8
    );
    assert_eq!(
        eds.dictionary.entry(0x2001, 1).unwrap().data_type,
        DataType::Unsigned8
    );
    let lines: Vec<(usize, bool)> = eds
        .findings
        .iter()
        .map(|finding| (finding.line, finding.lost))
        .collect();
    assert_eq!(lines, [(3, true), (5, true), (13, true)]);
}

#[test]
fn what_does_not_fit_is_found() {
    let eds = variable("DataType=5\nDefaultValue=256\nLowLimit=low\nPDOMapping=maybe");
    let lines: Vec<(usize, bool)> = eds
        .findings
        .iter()
        .map(|finding| (finding.line, finding.lost))
        .collect();
    assert_eq!(lines, [(6, false), (7, true), (8, true)]);
    assert!(eds.findings[0].text.contains("DefaultValue=256"));
}

#[test]
fn device_info() {
    let eds = eds::read(
        "[deviceinfo]\nVendorName=Someone\nVendorNumber=0x000000EE\nproductnumber=256\n\
         BaudRate_50=1\nBaudRate_100=0\nBaudRate_1000=1\nLSS_Supported=0\nNrOfRXPDO=2\nGranularity=0x08\n",
    );
    assert_eq!(eds.findings, []);
    let info = eds.device_info;
    assert_eq!(info.vendor_name.as_deref(), Some("Someone"));
    assert_eq!(
        (info.vendor_number, info.product_number),
        (Some(0xEE), Some(0x100))
    );
    assert_eq!(info.revision_number, None);
    assert_eq!(
        info.bit_rates_kbit_per_s.into_iter().collect::<Vec<_>>(),
        [50, 1000]
    );
    assert_eq!(
        (info.lss_supported, info.receive_pdos),
        (Some(false), Some(2))
    );
    assert_eq!(info.granularity_bits, Some(8));
}
