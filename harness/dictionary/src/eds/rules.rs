//! The rules that an EDS file is held against, by code.

use super::Severity;

/// One rule.
#[derive(Debug, PartialEq, Eq)]
pub struct Rule {
    /// Its code, `E001`: a section of docs/eds-findings.md.
    pub code: &'static str,
    /// How bad it is to break it.
    pub severity: Severity,
    /// What it asks for, in a few words.
    pub title: &'static str,
}

macro_rules! rules {
    ($($name:ident $code:literal $severity:ident $title:literal;)*) => {
        $(pub(super) static $name: Rule = Rule {
            code: $code,
            severity: Severity::$severity,
            title: $title,
        };)*

        /// Every rule, in the order of the codes.
        pub static RULES: &[&Rule] = &[$(&$name),*];
    };
}

rules! {
    STRAY_LINE "E001" Warning "a line is a section, a key, a comment or blank";
    REPEATED_KEY "E002" Warning "a key is once in its section";
    REPEATED_SECTION "E003" Warning "a section is once in the file";
    UNREADABLE_VALUE "E004" Error "a value is of the type of its key";
    DEFAULT_NOT_OF_TYPE "E005" Error "a default fits its data type";
    ORPHAN "E006" Error "a sub-index belongs to an object with a section";
    FLAG "E007" Warning "a flag is 0 or 1";
    KEY_WITH_BLANKS "E008" Warning "the name of a key has no blanks";
    COMPACT_LIST "E009" Warning "a list of names or values is about compact sub-indices";

    MISSING_SECTION "E010" Error "the file has its mandatory sections";
    UNKNOWN_SECTION "E011" Note "a section is one of CiA 306";
    MISSING_KEY "E012" Warning "a section has its mandatory keys";
    DATE "E013" Warning "a date is mm-dd-yyyy";
    TIME "E014" Warning "a time is hh:mm and AM or PM";
    BIT_RATE_KEY "E015" Warning "a bit rate is one of CiA 306";
    NO_BIT_RATE "E016" Error "the device has a bit rate";
    DYNAMIC_CHANNELS "E017" Error "dynamic channels are described if there are any";
    IDENTITY "E018" Error "the identity is that of 1018h";
    SPELLING "E019" Note "a section is spelt as in CiA 306";

    MANDATORY_OBJECT "E020" Error "1000h, 1001h and 1018h are there";
    LIST_COUNT "E021" Error "a list has as many entries as it says";
    LIST_ENTRY "E022" Error "an entry of a list is the index of an object";
    WRONG_LIST "E023" Error "an object is in the list of its area";
    LISTED_WITHOUT_SECTION "E024" Error "a listed object has a section";
    NOT_LISTED "E025" Error "an object is listed";
    MISSING_LIST "E026" Error "there is a list for every area with objects";
    LISTED_TWICE "E027" Warning "an object is listed once";
    MODULE "E028" Warning "a supported module is described";
    CHANGED_BEFORE_MADE "E029" Warning "a file is not changed before it is made";

    NAME_MISSING "E030" Error "an object has a name";
    NAME_SEMICOLON "E031" Warning "a name does not end in a semicolon";
    NAME_BLANKS "E032" Note "the words of a name have one blank between them";
    OBJECT_TYPE "E033" Error "the object type is one of CiA 301";
    DATA_TYPE "E034" Error "the data type is there and legal";
    ACCESS_TYPE "E035" Error "the access type is there and legal";
    SUB_NUMBER "E036" Error "SubNumber counts the sub-indices";
    SUB_0 "E037" Error "sub-index 0 is there and UNSIGNED8";
    HIGHEST_SUB "E038" Error "sub-index 0 holds the highest sub-index";
    COMPACT_AND_SUB_NUMBER "E039" Warning "an object has SubNumber or CompactSubObj";
    STANDARD_TYPE "E040" Error "an object of a standard has the data type of that standard";
    OBJECT_LINK "E041" Warning "an object link names an object";
    RESERVED_SUB "E042" Warning "a reserved sub-index is not described";
    OBJ_FLAGS "E043" Warning "ObjFlags has two bits";
    COMPACT_KIND "E044" Error "only arrays and records are compact";
    LIST_OF_OBJECT "E045" Warning "a list about an object has as many entries as it says";
    SUB_FF "E046" Error "sub-index FFh is UNSIGNED32 and read only";
    LSS_ADDRESS "E047" Warning "a device with LSS has all four numbers of 1018h";

    LIMIT_NOT_OF_TYPE "E050" Error "a limit fits its data type";
    LIMITS_CROSSED "E051" Error "the low limit is not above the high limit";
    DEFAULT_OUTSIDE "E052" Error "a default is inside its limits";
    UPPER_CASE_PREFIX "E053" Warning "a hexadecimal number starts with 0x";
    NODE_ID "E054" Warning "a number for each node is $NODEID+number";
    TRANSMISSION_LIMITS "E055" Note "limits of a transmission type leave out what is reserved";
    TRANSMISSION_TYPE "E056" Error "a transmission type is not a reserved one";
    CYCLE_PERIOD "E057" Warning "a communication cycle is longer than a SYNC message";
    LIMIT_OF_TEXT "E058" Warning "only numbers have limits";
    CHARACTERS "E059" Warning "a default has the characters of its type";

    MAPPED_MISSING "E060" Error "a mapped object exists";
    NOT_MAPPABLE "E061" Error "a mapped object has PDOMapping=1";
    MAPPED_DIRECTION "E062" Error "a mapped object may go in that direction";
    MAPPED_LENGTH "E063" Error "a mapping has the length of its object";
    PDO_TOO_LONG "E064" Error "a PDO has at most 64 bits";
    DIRECTION_UNCLEAR "E065" Warning "a mappable object says in which direction";
    MAPPED_BOTH_WAYS "E066" Warning "an object is mapped in one direction";
    FIXED_MAPPING_UNUSED "E067" Warning "a fixed mapping uses its entries";
    GRANULARITY "E068" Error "Granularity is 0 where mappings are fixed";
    PDO_PAIR "E069" Error "a PDO has communication and mapping parameters";
    PDO_COUNT "E070" Error "the number of PDOs is that of their sections";
    MAPPED_STRING "E071" Warning "a mapped string is not longer than its mapping";
    DUMMY_USAGE "E072" Warning "a dummy is a data type and 0 or 1";

    RESTRICTED_COB_ID "E080" Error "a COB-ID is not a restricted CAN-ID";
    SAME_FOR_EVERY_NODE "E081" Warning "a COB-ID of one node has $NODEID";
    COB_ID_TWICE "E082" Warning "a COB-ID is used once in a device";
    DEFAULT_SDO "E083" Error "the default SDO has 600h and 580h plus the node-ID";
    SDO_CHANNEL "E084" Error "an SDO has two COB-IDs";

    FILE_NAME "E085" Warning "the file is called as it says";
    MISSPELT "E086" Note "the words of a name are free of slips";

    SDO_NODE "E087" Error "the node at the other end of an SDO is 1 to 127";
    HEARTBEAT_TWICE "E088" Warning "the heartbeat of a node is monitored once";

    NOT_IN_EDS "E090" Warning "an object of the manual is in the EDS";
    NOT_IN_MANUAL "E091" Note "an object of the EDS is in the manual";
    MANUAL_TYPE "E092" Warning "a data type is that of the manual";
    MANUAL_ACCESS "E093" Warning "an access type is that of the manual";
    MANUAL_DEFAULT "E094" Warning "a default is that of the manual";
    DEFAULT_IN_MANUAL_ALONE "E095" Note "a default of the manual is in the EDS";
    NOT_SUPPORTED "E096" Warning "the manual says that the device has what the EDS describes";

    NODE_OF_DEVICE "E100" Error "the node-ID of a device is 1 to 127";
    BIT_RATE_OF_DEVICE "E101" Error "the bit rate of a device is one that it has";
    NAME_OF_NODE "E102" Warning "a node has a name of at most 246 characters";
    VALUE_OUTSIDE "E103" Error "a parameter value is inside its limits";
}
