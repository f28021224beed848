//! What the reader read can be written back as a file that reads to the same dictionary.

use fieldproof_dictionary::eds::{self, Eds};
use fieldproof_dictionary::{
    Access, DataType, Default, Dictionary, Entries, Entry, Number, Object, ObjectKind,
};
use proptest::prelude::*;

const FILES: [&str; 5] = [
    include_str!("../../../fixtures/devices/teco-jn5-cm-can/TECO_510_CAN.eds"),
    include_str!("../../../fixtures/devices/liaomiao-encoder/liaomiao-encoder.eds"),
    include_str!("../../../fixtures/devices/kinco-servo/kinco-servo.eds"),
    include_str!("../../../fixtures/devices/huacheng-ssts1/huacheng-ssts1.eds"),
    include_str!("../../../fixtures/devices/canopen-complete/canopen-complete.eds"),
];

/// The objects without the lines they stand in.
fn objects(dictionary: &Dictionary) -> Vec<Object> {
    let mut objects: Vec<Object> = dictionary.objects().cloned().collect();
    for object in &mut objects {
        object.line = 0;
        object.entries.values_mut().for_each(|entry| entry.line = 0);
    }
    objects
}

#[test]
fn every_file_reads_to_the_same_after_it_is_written() {
    for text in FILES {
        let first = eds::read(text);
        let written = eds::write(&first);
        let again = eds::read(&written);
        assert_eq!(objects(&first.dictionary), objects(&again.dictionary));
        assert_eq!(first.device_info, again.device_info);
        assert_eq!(again.findings, []);
        assert_eq!(eds::write(&again), written);
    }
}

#[test]
fn what_nobody_knows_is_written_too() {
    let eds = eds::read(
        "[Tools]\nItems=1\n[M1ModuleInfo]\nProductName=x\n[2000]\nParameterName=a\nDataType=5\nAccessType=ro\nColour=blue\n\
         [2001]\nObjectType=9\nSubNumber=1\nObjFlags=1\n[2001sub1]\nDataType=5\nAccessType=ro\nParameterValue=7\n",
    );
    let written = eds::write(&eds);
    for part in [
        "[Tools]\nItems=1\n",
        "[M1ModuleInfo]\nProductName=x\n",
        "Colour=blue\n",
        "ObjFlags=1\n",
        "ParameterValue=0x7\n",
    ] {
        assert_eq!(written.matches(part).count(), 1, "{part} in\n{written}");
    }
}

#[test]
fn a_variable_with_a_section_for_its_value_keeps_both() {
    let eds = eds::read(
        "[2000]\nParameterName=a\nDataType=5\nAccessType=ro\nColour=blue\n\
         [2000sub0]\nParameterName=a\nDataType=6\nAccessType=rw\nShape=round\n",
    );
    let written = eds::write(&eds);
    let again = eds::read(&written);
    assert_eq!(objects(&eds.dictionary), objects(&again.dictionary));
    assert_eq!(again.findings, []);
    assert_eq!(eds::write(&again), written);
    assert!(written.contains("Colour=blue\n") && written.contains("Shape=round\n"));
}

#[test]
fn the_lists_are_made_anew() {
    let eds = eds::read(
        "[1000]\nDataType=7\nAccessType=ro\n[2000]\nDataType=7\nAccessType=ro\n[6000]\nDataType=7\nAccessType=ro\n",
    );
    let findings = eds::check(&eds::read(&eds::write(&eds)));
    assert!(
        findings
            .iter()
            .all(|finding| !("E021".."E028").contains(&finding.rule.code)),
        "{findings:#?}"
    );
}

const TYPES: [DataType; 12] = [
    DataType::Boolean,
    DataType::Integer8,
    DataType::Integer16,
    DataType::Integer64,
    DataType::Unsigned8,
    DataType::Unsigned24,
    DataType::Unsigned32,
    DataType::Unsigned64,
    DataType::Real32,
    DataType::VisibleString,
    DataType::OctetString,
    DataType::Unknown(0x23),
];

fn number(data_type: DataType) -> impl Strategy<Value = Number> {
    let bits = data_type.bits().unwrap_or(32);
    let (low, high) = match data_type.is_signed() {
        true => (-(1_i128 << (bits - 1)), (1_i128 << (bits - 1)) - 1),
        false => (0, (1_i128 << bits) - 1),
    };
    (low..=high, any::<bool>()).prop_map(move |(value, relative)| Number {
        offset: value,
        // The bit pattern of a real number is never relative.
        relative_to_node: relative && !data_type.is_real(),
    })
}

fn entry() -> impl Strategy<Value = Entry> {
    let access = prop::sample::select(vec![
        Access::ReadOnly,
        Access::WriteOnly,
        Access::ReadWrite,
        Access::ReadWriteOnRead,
        Access::ReadWriteOnWrite,
        Access::Constant,
    ]);
    let name = "[A-Za-z;][A-Za-z 0-9;=.]{0,8}[a-z;]";
    prop::sample::select(TYPES.to_vec())
        .prop_flat_map(move |data_type| {
            let default = match data_type.is_text() {
                true => "[!-~]{1,8}".prop_map(Default::Text).boxed(),
                false => number(data_type).prop_map(Default::Number).boxed(),
            };
            let limit = || prop::option::of(number(data_type));
            (
                Just(data_type),
                access.clone(),
                name,
                limit(),
                limit(),
                prop::option::of(default),
                any::<bool>(),
            )
        })
        .prop_map(
            |(data_type, access, name, low_limit, high_limit, default, pdo_mapping)| Entry {
                name,
                data_type,
                access,
                low_limit,
                high_limit,
                parameter_value: default.clone().filter(|_| pdo_mapping),
                denotation: pdo_mapping.then(|| "here".to_owned()),
                default,
                pdo_mapping,
                line: 0,
            },
        )
}

fn object() -> impl Strategy<Value = Object> {
    let kinds = vec![
        ObjectKind::Variable,
        ObjectKind::Array,
        ObjectKind::Record,
        ObjectKind::DefStruct,
    ];
    (
        any::<u16>(),
        prop::sample::select(kinds),
        prop::collection::vec((any::<u8>(), entry()), 0..4)
            .prop_map(|entries| entries.into_iter().collect::<Entries>()),
        entry(),
    )
        .prop_map(|(index, kind, mut entries, first)| {
            let name = first.name.clone();
            if kind == ObjectKind::Variable {
                entries.insert(0, first);
            }
            Object {
                index,
                name,
                kind,
                entries,
                line: 0,
            }
        })
}

proptest! {
    #[test]
    fn any_dictionary_is_written_and_read_again(made in prop::collection::vec(object(), 0..8)) {
        let mut eds = Eds::default();
        eds.dictionary = made.into_iter().collect();
        let again = eds::read(&eds::write(&eds));
        prop_assert_eq!(objects(&eds.dictionary), objects(&again.dictionary));
    }
}
