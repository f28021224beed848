//! The objects of the device identification: basic, regular, and so long ones beyond that they do not fit one answer.

/// Every object, in order.
pub(super) const OBJECTS: &[(u8, &str)] = &[
    (0x00, "fieldproof"),
    (0x01, "modbus-complete"),
    (0x02, "1.0"),
    (0x03, "https://modbus.org"),
    (0x04, "Complete slave"),
    (0x05, "MC-1"),
    (0x06, "reference"),
    (0x80, LONG),
    (0x81, LONG),
    (0x90, "the last object"),
];

/// Two of these and what is before them do not fit 253 bytes.
const LONG: &str = "a long object, for what a device says of itself may be long, and then it takes more than one answer to say all of it";
