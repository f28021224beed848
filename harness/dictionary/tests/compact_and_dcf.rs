//! What a file says in short, what a DCF adds to an EDS, and the sections of modular devices.

use fieldproof_dictionary::eds::{self, Eds};
use fieldproof_dictionary::{Access, DataType, Default, Number, Object, ObjectKind};

const COMPACT: &str = "\
[2000]
ParameterName=Step
ObjectType=8
CompactSubObj=3
DataType=6
AccessType=rw
DefaultValue=$NODEID+7
[2000Name]
NrOfEntries=1
2=Middle
[2000Value]
NrOfEntries=2
1=0x10
3=$NODEID+1
[2000Denotation]
NrOfEntries=1
3=tail lift
";

/// The objects without the lines they stand in.
fn objects(eds: &Eds) -> Vec<Object> {
    let mut objects: Vec<Object> = eds.dictionary.objects().cloned().collect();
    for object in &mut objects {
        object.line = 0;
        object.entries.values_mut().for_each(|entry| entry.line = 0);
    }
    objects
}

fn assert_written_back(eds: &Eds) -> String {
    let written = eds::write(eds);
    let again = eds::read(&written);
    assert_eq!(objects(eds), objects(&again));
    assert_eq!(eds.device_info, again.device_info);
    assert_eq!(eds::write(&again), written);
    written
}

#[test]
fn lists_of_a_compact_object() {
    let eds = eds::read(COMPACT);
    assert_eq!(eds.findings, []);
    let said: Vec<_> = (1..=3)
        .map(|sub| {
            let entry = eds.dictionary.entry(0x2000, sub).unwrap();
            (
                entry.name.as_str(),
                entry.default_bytes(2).unwrap(),
                entry.configured_bytes(2).unwrap(),
                entry.denotation.as_deref(),
            )
        })
        .collect();
    assert_eq!(
        said,
        [
            ("Step1", vec![9, 0], vec![0x10, 0], None),
            ("Middle", vec![9, 0], vec![9, 0], None),
            ("Step3", vec![9, 0], vec![3, 0], Some("tail lift")),
        ]
    );
    let written = assert_written_back(&eds);
    assert!(written.contains("[2000sub3]\n") && written.contains("Denotation=tail lift\n"));
}

#[test]
fn what_a_list_says_of_another_entry_is_found() {
    for (list, key) in [
        ("Name", "4=beyond"),
        ("Name", "0=count"),
        ("Name", "x=y"),
        ("Value", "4=1"),
        ("Denotation", "256=far"),
    ] {
        let text = format!(
            "[2000]\nObjectType=8\nCompactSubObj=3\nDataType=6\nAccessType=rw\n[2000{list}]\n{key}\n"
        );
        let eds = eds::read(&text);
        let found: Vec<_> = eds
            .findings
            .iter()
            .map(|finding| (finding.rule.code, finding.line, finding.lost))
            .collect();
        assert_eq!(found, [("E009", 7, true)], "[2000{list}] {key}");
    }
    // An entry with a section of its own is not compact.
    let own = format!("{COMPACT}[2000sub2]\nParameterName=Own\nDataType=6\nAccessType=ro\n");
    let eds = eds::read(&own);
    assert_eq!(eds.dictionary.entry(0x2000, 2).unwrap().name, "Own");
    assert_eq!(eds.findings.len(), 1);
    assert_eq!(eds.findings[0].line, 10);
}

#[test]
fn a_value_of_a_list_is_of_the_type_of_its_entry() {
    let eds = eds::read(&COMPACT.replace("1=0x10", "1=0x10000"));
    let found: Vec<_> = eds
        .findings
        .iter()
        .map(|finding| (finding.rule.code, finding.line))
        .collect();
    assert_eq!(found, [("E005", 13)]);
}

#[test]
fn compact_pdos() {
    let eds = eds::read(
        "[DeviceInfo]\nNrOfRXPDO=2\nNrOfTXPDO=1\nCompactPDO=0x13\nGranularity=16\n\
         [1401]\nParameterName=Mine\nObjectType=9\nSubNumber=1\n[1401sub0]\nDataType=5\nAccessType=ro\n",
    );
    assert_eq!(eds.findings, []);
    let subs = |index: u16| -> Vec<u8> {
        let object = eds.dictionary.object(index).unwrap();
        assert_eq!(object.kind, ObjectKind::Record);
        object.entries.keys().copied().collect()
    };
    assert_eq!(subs(0x1400), [0, 1, 2, 5]);
    assert_eq!(subs(0x1401), [0], "a section says more than CompactPDO");
    assert_eq!(subs(0x1800), [0, 1, 2, 5]);
    for mapping in [0x1600, 0x1601, 0x1A00] {
        assert_eq!(subs(mapping), [0, 1, 2, 3, 4]);
    }
    assert_eq!(eds.dictionary.objects().count(), 6);
    let cob_id = eds.dictionary.entry(0x1400, 1).unwrap();
    assert_eq!(
        (cob_id.data_type, cob_id.access, &cob_id.default),
        (DataType::Unsigned32, Access::ReadWrite, &None)
    );
    assert_written_back(&eds);
    // Of what has no section nothing is asked: these are about [MandatoryObjects] and [1401].
    let found: Vec<(&str, usize)> = eds::check(&eds)
        .iter()
        .map(|finding| (finding.rule.code, finding.line))
        .filter(|(code, _)| ("E021".."E030").contains(code))
        .collect();
    assert_eq!(found, [("E026", 1), ("E026", 6)]);
}

#[test]
fn a_dcf() {
    let eds = eds::read(
        "[DeviceComissioning]\nNodeID=0x0A\nNodeName=pump\nBaudrate=250\nNetNumber=1\nNetworkName=plant\n\
         CANopenManager=0\nLSS_SerialNumber=0x1234\n\
         [1800]\nParameterName=TPDO\nObjectType=9\nSubNumber=2\n[1800sub0]\nDataType=5\nAccessType=ro\n\
         [1800sub1]\nParameterName=COB-ID\nDataType=7\nAccessType=rw\nDefaultValue=$NODEID+0x180\n\
         ParameterValue=$NODEID+0x280\nDenotation=speed\nUploadFile=x.bin\n",
    );
    assert_eq!(eds.findings, []);
    let it = eds.commissioning.clone().unwrap();
    assert_eq!(
        (it.node_id, it.node_name.as_deref(), it.bit_rate_kbit_per_s),
        (Some(10), Some("pump"), Some(250))
    );
    assert_eq!(
        (
            it.net_number,
            it.network_name.as_deref(),
            it.canopen_manager
        ),
        (Some(1), Some("plant"), Some(false))
    );
    assert_eq!((it.lss_serial_number, it.line), (Some(0x1234), 1));
    let node = eds.node_id().unwrap();
    let entry = eds.dictionary.entry(0x1800, 1).unwrap();
    assert_eq!(entry.default_bytes(node), Some(vec![0x8A, 1, 0, 0]));
    assert_eq!(entry.configured_bytes(node), Some(vec![0x8A, 2, 0, 0]));
    assert_eq!(
        entry.parameter_value,
        Some(Default::Number(Number::relative(0x280)))
    );
    let written = assert_written_back(&eds);
    assert_eq!(eds::read(&written).commissioning, eds.commissioning);
    for kept in [
        "NodeName=pump\n",
        "Denotation=speed\n",
        "UploadFile=x.bin\n",
    ] {
        assert!(written.contains(kept), "{kept} in\n{written}");
    }
}

#[test]
fn an_eds_has_no_node() {
    let eds = eds::read("[DeviceInfo]\nVendorNumber=1\n");
    assert_eq!((&eds.commissioning, eds.node_id()), (&None, None));
    let spelt = eds::read("[DeviceCommissioning]\nNodeID=3\n");
    assert_eq!(spelt.node_id(), Some(3));
}

const MODULES: &str = "\
[SupportedModules]
NrOfEntries=1
[M1ModuleInfo]
ProductName=Digital out
ProductVersion=1
ProductRevision=0
OrderCode=DO8
[M1FixedObjects]
NrOfEntries=1
1=0x6423
[M1Fixed6423]
ParameterName=Enable
ObjectType=7
DataType=1
AccessType=rw
[M1SubExtends]
NrOfEntries=1
1=0x6200
[M1SubExt6200]
ParameterName=Write output
DataType=5
AccessType=rww
PDOMapping=1
Count=1
[M1SubExt1027]
Count=1
[M1Comments]
Lines=0
[ConnectedModules]
NrOfEntries=1
1=1
";

#[test]
fn sections_of_modules_are_kept_and_are_no_objects() {
    let eds = eds::read(MODULES);
    assert_eq!(eds.findings, []);
    assert_eq!(eds.dictionary.objects().count(), 0);
    let unknown = eds::check(&eds);
    assert!(unknown.iter().all(|finding| finding.rule.code != "E011"));
    let written = assert_written_back(&eds);
    for line in MODULES.lines() {
        assert_eq!(
            written.lines().filter(|it| *it == line).count(),
            MODULES.lines().filter(|it| *it == line).count(),
            "{line}"
        );
    }
}

#[test]
fn object_links_and_heads_of_records_are_kept() {
    let eds = eds::read(
        "[2000]\nParameterName=a\nObjectType=9\nSubNumber=1\nDataType=6\nLowLimit=3\nDenotation=group\n\
         [2000sub0]\nDataType=5\nAccessType=ro\n[2000ObjectLinks]\nObjectLinks=1\n1=0x2000\n",
    );
    let written = assert_written_back(&eds);
    for kept in [
        "DataType=6\nLowLimit=3\nDenotation=group\n",
        "[2000ObjectLinks]\nObjectLinks=1\n1=0x2000\n",
    ] {
        assert!(written.contains(kept), "{kept} in\n{written}");
    }
}
