//! Who a device claims to be.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::model::Located;
use crate::scalar::{ObjectAddress, Value};

/// Who a device claims to be. What is not claimed is not asserted.
#[derive(Debug, Clone, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct Identity {
    /// 1018h:01, the number that CiA gave the vendor.
    pub vendor_id: Option<Located<u32>>,
    /// 1018h:02.
    pub product_code: Option<Located<u32>>,
    /// 1018h:03.
    pub revision_number: Option<Located<u32>>,
    /// 1018h:04; only where it is that of all units.
    pub serial_number: Option<Located<u32>>,
    /// 1008h.
    pub device_name: Option<Located<String>>,
    /// 1009h.
    pub hardware_version: Option<Located<String>>,
    /// 100Ah.
    pub software_version: Option<Located<String>>,
    /// The device identification of Modbus (function 43, MEI type 14), which no suite reads yet.
    pub modbus: Option<ModbusIdentity>,
}

/// The device identification of Modbus, its basic objects.
#[derive(Debug, Clone, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields, default)]
pub struct ModbusIdentity {
    /// Object 00h, VendorName.
    pub vendor_name: Option<String>,
    /// Object 01h, ProductCode.
    pub product_code: Option<String>,
    /// Object 02h, MajorMinorRevision.
    pub revision: Option<String>,
}

/// A part of the identity that is an object of CANopen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Claim {
    /// 1018h:01.
    VendorId,
    /// 1018h:02.
    ProductCode,
    /// 1018h:03.
    RevisionNumber,
    /// 1018h:04.
    SerialNumber,
    /// 1008h.
    DeviceName,
    /// 1009h.
    HardwareVersion,
    /// 100Ah.
    SoftwareVersion,
}

impl Claim {
    /// Those that are numbers, in the order of 1018h.
    pub const NUMBERS: [Claim; 4] = [
        Claim::VendorId,
        Claim::ProductCode,
        Claim::RevisionNumber,
        Claim::SerialNumber,
    ];

    /// All of them, in the order of a description.
    pub const ALL: [Claim; 7] = [
        Claim::VendorId,
        Claim::ProductCode,
        Claim::RevisionNumber,
        Claim::SerialNumber,
        Claim::DeviceName,
        Claim::HardwareVersion,
        Claim::SoftwareVersion,
    ];

    /// The word of the language.
    pub const fn name(self) -> &'static str {
        match self {
            Claim::VendorId => "vendor-id",
            Claim::ProductCode => "product-code",
            Claim::RevisionNumber => "revision-number",
            Claim::SerialNumber => "serial-number",
            Claim::DeviceName => "device-name",
            Claim::HardwareVersion => "hardware-version",
            Claim::SoftwareVersion => "software-version",
        }
    }

    /// The object that holds it.
    pub const fn object(self) -> ObjectAddress {
        let (index, sub) = match self {
            Claim::VendorId => (0x1018, 1),
            Claim::ProductCode => (0x1018, 2),
            Claim::RevisionNumber => (0x1018, 3),
            Claim::SerialNumber => (0x1018, 4),
            Claim::DeviceName => (0x1008, 0),
            Claim::HardwareVersion => (0x1009, 0),
            Claim::SoftwareVersion => (0x100A, 0),
        };
        ObjectAddress { index, sub }
    }

    /// Whether it is a text; else a number of 32 bits.
    pub const fn is_text(self) -> bool {
        matches!(
            self,
            Claim::DeviceName | Claim::HardwareVersion | Claim::SoftwareVersion
        )
    }
}

impl Identity {
    /// The numbers that are claimed, as [`Claim::NUMBERS`] has them.
    pub fn numbers(&self) -> [Option<u32>; 4] {
        let numbers = [
            &self.vendor_id,
            &self.product_code,
            &self.revision_number,
            &self.serial_number,
        ];
        numbers.map(|number| number.as_ref().map(|it| it.value))
    }

    /// What is claimed, and where; `None` where nothing is.
    pub fn claimed(&self, claim: Claim) -> Option<Located<Value>> {
        let number = |claimed: &Option<Located<u32>>| {
            claimed.as_ref().map(|it| Located {
                value: Value::Number(it.value.into()),
                at: it.at,
            })
        };
        let text = |claimed: &Option<Located<String>>| {
            claimed.as_ref().map(|it| Located {
                value: Value::Text(it.value.clone()),
                at: it.at,
            })
        };
        match claim {
            Claim::VendorId => number(&self.vendor_id),
            Claim::ProductCode => number(&self.product_code),
            Claim::RevisionNumber => number(&self.revision_number),
            Claim::SerialNumber => number(&self.serial_number),
            Claim::DeviceName => text(&self.device_name),
            Claim::HardwareVersion => text(&self.hardware_version),
            Claim::SoftwareVersion => text(&self.software_version),
        }
    }
}
