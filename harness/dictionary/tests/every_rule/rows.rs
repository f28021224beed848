//! One row a rule.

use fieldproof_dictionary::eds::Severity;

use Edit::{Append, Manual, Remove, Rename, Replace};
use Severity::{Error, Note, Warning};

/// A change to the base.
pub(crate) enum Edit {
    /// The first text stands there once, and becomes the second.
    Replace(&'static str, &'static str),
    /// The section of that name goes.
    Remove(&'static str),
    /// The text comes at the end.
    Append(&'static str),
    /// As `Replace`, in the table of the manual.
    Manual(&'static str, &'static str),
    /// The file is called so.
    Rename(&'static str),
}

/// What breaks a rule.
pub(crate) struct Row {
    /// The code of the rule.
    pub(crate) code: &'static str,
    /// How bad it is.
    pub(crate) severity: Severity,
    /// What is changed in the base.
    pub(crate) edits: &'static [Edit],
    /// Where it must be found: a whole line that is there once, or `[section] key=value`.
    pub(crate) at: &'static str,
    /// Rules that cannot be kept while this one is broken, each with its severity and line.
    pub(crate) implied: &'static [(&'static str, Severity, &'static str)],
}

const fn row(
    code: &'static str,
    severity: Severity,
    edits: &'static [Edit],
    at: &'static str,
) -> Row {
    Row {
        code,
        severity,
        edits,
        at,
        implied: &[],
    }
}

#[rustfmt::skip]
pub(crate) const ROWS: &[Row] = &[
    row("E001", Warning, &[Replace("Lines=0", "Lines=0\nlost")], "lost"),
    row("E002", Warning, &[Replace("Lines=0", "Lines=0\nLINES=0")], "LINES=0"),
    row("E003", Warning, &[Append("[COMMENTS]\nLines=0\n")], "[COMMENTS]"),
    row("E004", Error, &[Replace("Granularity=8", "Granularity=many")], "Granularity=many"),
    row("E005", Error, &[Replace("DefaultValue=17", "DefaultValue=300")], "DefaultValue=300"),
    row("E006", Error, &[Remove("2002")], "[2002sub0]"),
    row("E007", Warning, &[Replace("GroupMessaging=0", "GroupMessaging=2")], "GroupMessaging=2"),
    row("E008", Warning, &[Replace("GroupMessaging=0", "Group Messaging=0")], "Group Messaging=0"),
    row("E009", Warning, &[Replace("2=Middle", "4=Middle")], "4=Middle"),

    row("E010", Error, &[Remove("FileInfo")], "[DeviceInfo]"),
    row("E011", Note, &[Append("[Colours]\n")], "[Colours]"),
    row("E012", Warning, &[Replace("OrderCode=X-1\n", "")], "[DeviceInfo]"),
    row("E013", Warning, &[Replace("CreationDate=10-23-2012", "CreationDate=23-10-2012")], "CreationDate=23-10-2012"),
    row("E014", Warning, &[Replace("11:04AM", "11:04 AM")], "CreationTime=11:04 AM"),
    row("E015", Warning, &[Replace("BaudRate_250=1", "BaudRate_250=1\nBaudRate_100=0")], "BaudRate_100=0"),
    row("E016", Error, &[Replace("BaudRate_250=1", "BaudRate_250=0")], "[DeviceInfo]"),
    row("E017", Error, &[Replace("ChannelsSupported=0", "ChannelsSupported=1")], "DynamicChannelsSupported=1"),
    row("E018", Error, &[Replace("ProductNumber=5", "ProductNumber=6")], "ProductNumber=6"),
    row("E019", Note, &[Replace("[DeviceComissioning]", "[DeviceCommissioning]")], "[DeviceCommissioning]"),

    row("E020", Error, &[
        Remove("1001"),
        Replace("=3\n1=0x1000\n2=0x1001\n3=0x1018", "=2\n1=0x1000\n2=0x1018"),
        Manual("1001:00 | - | ro | - | - | it\n", ""),
    ], "[MandatoryObjects]"),
    row("E021", Error, &[Replace("SupportedObjects=3", "SupportedObjects=4")], "SupportedObjects=4"),
    row("E022", Error, &[Replace("SupportedObjects=3", "SupportedObjects=4\n4=none")], "4=none"),
    row("E023", Error, &[
        Replace("SupportedObjects=3", "SupportedObjects=4\n4=0x2005"),
        Replace("SupportedObjects=6", "SupportedObjects=5"),
        Replace("6=0x2005\n", ""),
    ], "4=0x2005"),
    row("E024", Error, &[Replace("SupportedObjects=6", "SupportedObjects=7\n7=0x2006")], "7=0x2006"),
    row("E025", Error, &[Replace("SupportedObjects=6", "SupportedObjects=5"), Replace("6=0x2005\n", "")], "[2005]"),
    row("E026", Error, &[Remove("ManufacturerObjects")], "[2000]"),
    row("E027", Warning, &[Replace("SupportedObjects=6", "SupportedObjects=7"), Replace("6=0x2005", "6=0x2005\n7=0x2004")], "7=0x2004"),
    row("E028", Warning, &[Replace("[SupportedModules]\nNrOfEntries=1", "[SupportedModules]\nNrOfEntries=02")], "NrOfEntries=02"),
    row("E029", Warning, &[Replace("10-24-2012", "10-24-2011")], "ModificationDate=10-24-2011"),

    row("E030", Error, &[Replace("ParameterName=Temperature\n", "")], "[2003]"),
    row("E031", Warning, &[Replace("ParameterName=Temperature", "ParameterName=Temperature;")], "ParameterName=Temperature;"),
    row("E032", Note, &[Replace("ParameterName=Error register", "ParameterName=Error  register")], "ParameterName=Error  register"),
    row("E033", Error, &[
        Replace("Temperature\nObjectType=0x7", "Temperature\nObjectType=0x4"),
        Manual("2003:00 | - | ro | - | - | it\n", ""),
    ], "ObjectType=0x4"),
    row("E034", Error, &[Replace("DataType=0x0003\n", "")], "[2003]"),
    row("E035", Error, &[Replace("DataType=0x0007\nAccessType=rw\nDefaultValue=0x80\n", "DataType=0x0007\nAccessType=wr\nDefaultValue=0x80\n")], "AccessType=wr"),
    row("E036", Error, &[Replace("SubNumber=5", "SubNumber=6")], "SubNumber=6"),
    row("E037", Error, &[Replace("DataType=0x0005\nAccessType=ro\nDefaultValue=4", "DataType=0x0006\nAccessType=ro\nDefaultValue=4")], "[1018sub0] DataType=0x0006"),
    row("E038", Error, &[Replace("AccessType=ro\nDefaultValue=4", "AccessType=ro\nDefaultValue=3")], "[1018sub0] DefaultValue=3"),
    row("E039", Warning, &[Replace("CompactSubObj=3", "CompactSubObj=3\nSubNumber=04")], "SubNumber=04"),
    row("E040", Error, &[Replace("DataType=0x0006\nAccessType=rw\nDefaultValue=0x0\n", "DataType=0x0005\nAccessType=rw\nDefaultValue=0x0\n")], "[1017] DataType=0x0005"),
    row("E041", Warning, &[Replace("1=0x6000", "1=0x2FFF")], "1=0x2FFF"),
    row("E042", Warning, &[
        Replace("RPDO parameter\nObjectType=0x9\nSubNumber=4", "RPDO parameter\nObjectType=0x9\nSubNumber=5"),
        Append("[1400sub4]\nParameterName=Reserved\nDataType=5\nAccessType=ro\n"),
        Manual("1400:05 |", "1400:04 | - | ro | - | - | it\n1400:05 |"),
    ], "[1400sub4]"),
    row("E043", Warning, &[Replace("ObjFlags=1", "ObjFlags=4")], "ObjFlags=4"),
    row("E044", Error, &[Replace("ObjFlags=1", "CompactSubObj=1")], "CompactSubObj=1"),
    row("E045", Warning, &[Replace("NrOfEntries=1\n2=Middle", "NrOfEntries=2\n2=Middle")], "NrOfEntries=2"),
    row("E046", Error, &[Replace("Shape\nObjectType=0x7\nDataType=0x0007", "Shape\nObjectType=0x7\nDataType=0x0006")], "[2002subFF]"),
    row("E047", Warning, &[
        Remove("1018sub4"),
        Replace("SubNumber=5", "SubNumber=4"),
        Replace("AccessType=ro\nDefaultValue=4", "AccessType=ro\nDefaultValue=3"),
        Manual("1018:04 | - | ro | - | - | it\n", ""),
    ], "[1018]"),

    row("E050", Error, &[Replace("HighLimit=100", "HighLimit=300")], "HighLimit=300"),
    row("E051", Error, &[Replace("LowLimit=1", "LowLimit=101")], "LowLimit=101"),
    row("E052", Error, &[Replace("DefaultValue=50", "DefaultValue=101")], "DefaultValue=101"),
    row("E053", Warning, &[Replace("HighLimit=100", "HighLimit=0X64")], "HighLimit=0X64"),
    row("E054", Warning, &[Replace("$NODEID+0x80\n", "0x80+$NODEID\n")], "DefaultValue=0x80+$NODEID"),
    row("E055", Note, &[Replace("DefaultValue=254", "DefaultValue=254\nLowLimit=1\nHighLimit=255")], "HighLimit=255"),
    row("E056", Error, &[Replace("DefaultValue=254", "DefaultValue=245")], "DefaultValue=245"),
    row("E057", Warning, &[Replace("DefaultValue=10000", "DefaultValue=10")], "DefaultValue=10"),
    row("E058", Warning, &[Replace("DefaultValue=abcd", "DefaultValue=abcd\nLowLimit=0x0")], "LowLimit=0x0"),
    row("E059", Warning, &[Replace("DefaultValue=Example", "DefaultValue=Exämple")], "DefaultValue=Exämple"),

    row("E060", Error, &[Replace("0x62000008", "0x62010008")], "DefaultValue=0x62010008"),
    row("E061", Error, &[Replace("DefaultValue=18\nPDOMapping=1", "DefaultValue=18\nPDOMapping=0")], "DefaultValue=0x62000008"),
    row("E062", Error, &[Replace("AccessType=rww", "AccessType=rwr")], "DefaultValue=0x62000008"),
    row("E063", Error, &[Replace("0x62000008", "0x62000010")], "DefaultValue=0x62000010"),
    row("E064", Error, &[Replace("DefaultValue=2\n\n[1A00sub1]", "DefaultValue=3\n\n[1A00sub1]")], "[1A00]"),
    row("E065", Warning, &[Replace("AccessType=rww", "AccessType=RW")], "AccessType=RW"),
    Row {
        code: "E066",
        severity: Warning,
        edits: &[Replace("AccessType=rww", "AccessType=RW"), Replace("0x60000008", "0x62000008\nDenotation=")],
        at: "[1A00sub1] DefaultValue=0x62000008",
        // Only of what may go either way this is asked.
        implied: &[("E065", Warning, "AccessType=RW")],
    },
    row("E067", Warning, &[Replace("Granularity=8", "Granularity=0")], "[1A00sub0] DefaultValue=2"),
    row("E068", Error, &[Replace("Granularity=8", "Granularity=65")], "Granularity=65"),
    row("E069", Error, &[
        Remove("1600"), Remove("1600sub0"), Remove("1600sub1"),
        Replace("SupportedObjects=14", "SupportedObjects=13"),
        Replace("10=0x1600\n11=0x1800\n12=0x1A00\n13=0x6000\n14=0x6200", "10=0x1800\n11=0x1A00\n12=0x6000\n13=0x6200"),
        Manual("1600:00 | - | ro | - | - | it\n1600:01 | - | ro | - | - | it\n", ""),
    ], "[1400]"),
    row("E070", Error, &[Replace("NrOfRXPDO=1", "NrOfRXPDO=2")], "NrOfRXPDO=2"),
    row("E071", Warning, &[Replace("DefaultValue=abcd", "DefaultValue=abcde")], "DefaultValue=0x20010020"),
    row("E072", Warning, &[Replace("Dummy0005=1", "Dummy0009=1")], "Dummy0009=1"),

    row("E080", Error, &[Replace("$NODEID+0x180", "$NODEID+0x700")], "DefaultValue=$NODEID+0x700"),
    row("E081", Warning, &[Replace("$NODEID+0x80\n", "0x0085\n")], "DefaultValue=0x0085"),
    row("E082", Warning, &[Replace("$NODEID+0x180", "$NODEID+0x080")], "DefaultValue=$NODEID+0x080"),
    row("E083", Error, &[Replace("$NODEID+0x580", "$NODEID+0x480")], "DefaultValue=$NODEID+0x480"),
    row("E084", Error, &[Replace("DefaultValue=0x80000002", "DefaultValue=0x582")], "DefaultValue=0x582"),
    row("E085", Warning, &[Rename("other.dcf")], "FileName=base.dcf"),
    row("E086", Note, &[Replace("ParameterName=Inputs", "ParameterName=Intput")], "ParameterName=Intput"),
    row("E087", Error, &[Replace("ParameterName=Server\nObjectType=0x7\nDataType=0x0005\nAccessType=rw\nDefaultValue=0", "ParameterName=Server\nObjectType=0x7\nDataType=0x0005\nAccessType=rw\nDefaultValue=200")], "DefaultValue=200"),
    row("E088", Warning, &[Replace("DefaultValue=0x00030064", "DefaultValue=0x000200C8")], "DefaultValue=0x000200C8"),

    row("E090", Warning, &[Manual("1018:01 |", "1018:05 | - | ro | - | - | more\n1018:01 |")], "[1018]"),
    row("E091", Note, &[Manual("2003:00 | - | ro | - | - | it\n", "")], "[2003]"),
    row("E092", Warning, &[Manual("2003:00 | -", "2003:00 | i8")], "[2003] DataType=0x0003"),
    row("E093", Warning, &[Manual("2003:00 | - | ro", "2003:00 | - | rw")], "[2003] AccessType=ro"),
    row("E094", Warning, &[Manual("2004:00 | - | rw | -", "2004:00 | - | rw | 51")], "DefaultValue=50"),
    row("E095", Note, &[Manual("2003:00 | - | ro | -", "2003:00 | - | ro | 5")], "[2003]"),
    row("E096", Warning, &[Manual("2003:00 | - | ro | - | -", "2003:00 | - | ro | - | reserved")], "ParameterName=Temperature"),

    row("E100", Error, &[Replace("NodeID=5", "NodeID=200")], "NodeID=200"),
    row("E101", Error, &[Replace("Baudrate=250", "Baudrate=500")], "Baudrate=500"),
    row("E102", Warning, &[Replace("NodeName=pump", "NodeName=")], "NodeName="),
    row("E103", Error, &[Replace("1=7", "1=10")], "1=10"),
];
