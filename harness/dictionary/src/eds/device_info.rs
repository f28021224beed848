//! The section `[DeviceInfo]`.

use std::collections::BTreeSet;

use super::{Finding, Section, field};
use crate::ini::Sections;

/// What the file says about the device as a whole; `None` where it says nothing.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct DeviceInfo {
    /// `VendorName`
    pub vendor_name: Option<String>,
    /// `VendorNumber`, as 1018h:01 should read.
    pub vendor_number: Option<u32>,
    /// `ProductName`
    pub product_name: Option<String>,
    /// `ProductNumber`, as 1018h:02 should read.
    pub product_number: Option<u32>,
    /// `RevisionNumber`, as 1018h:03 should read.
    pub revision_number: Option<u32>,
    /// `OrderCode`
    pub order_code: Option<String>,
    /// The bit rates whose `BaudRate_N` is 1, in kbit/s.
    pub bit_rates_kbit_per_s: BTreeSet<u32>,
    /// `SimpleBootUpMaster`
    pub simple_boot_up_master: Option<bool>,
    /// `SimpleBootUpSlave`
    pub simple_boot_up_slave: Option<bool>,
    /// `Granularity` of the PDO mapping in bits; 0 means that the mapping is fixed.
    pub granularity_bits: Option<u8>,
    /// `DynamicChannelsSupported`
    pub dynamic_channels_supported: Option<u32>,
    /// `GroupMessaging`
    pub group_messaging: Option<bool>,
    /// `NrOfRXPDO`
    pub receive_pdos: Option<u16>,
    /// `NrOfTXPDO`
    pub transmit_pdos: Option<u16>,
    /// `LSS_Supported`
    pub lss_supported: Option<bool>,
    /// `CompactPDO`: bit n is set if the communication parameters that have no sections have sub-index n + 1.
    pub compact_pdo: Option<u8>,
}

pub(super) fn read(sections: &Sections, findings: &mut Vec<Finding>) -> DeviceInfo {
    let Some(section) = sections.named("DeviceInfo") else {
        return DeviceInfo::default();
    };
    let key = |name: &str| section.filled(name);
    DeviceInfo {
        vendor_name: field::text(key("VendorName")),
        vendor_number: field::unsigned(key("VendorNumber"), findings),
        product_name: field::text(key("ProductName")),
        product_number: field::unsigned(key("ProductNumber"), findings),
        revision_number: field::unsigned(key("RevisionNumber"), findings),
        order_code: field::text(key("OrderCode")),
        bit_rates_kbit_per_s: bit_rates(section, findings),
        simple_boot_up_master: field::flag(key("SimpleBootUpMaster"), findings),
        simple_boot_up_slave: field::flag(key("SimpleBootUpSlave"), findings),
        granularity_bits: field::unsigned(key("Granularity"), findings),
        dynamic_channels_supported: field::unsigned(key("DynamicChannelsSupported"), findings),
        group_messaging: field::flag(key("GroupMessaging"), findings),
        receive_pdos: field::unsigned(key("NrOfRXPDO"), findings),
        transmit_pdos: field::unsigned(key("NrOfTXPDO"), findings),
        lss_supported: field::flag(key("LSS_Supported"), findings),
        compact_pdo: field::unsigned(key("CompactPDO"), findings),
    }
}

fn bit_rates(section: Section<'_>, findings: &mut Vec<Finding>) -> BTreeSet<u32> {
    let mut rates = BTreeSet::new();
    for key in section.keys() {
        let name = key.name.to_ascii_lowercase();
        let rate = name.strip_prefix("baudrate_").map(str::parse);
        if let Some(Ok(rate)) = rate
            && field::flag(section.filled(key.name), findings) == Some(true)
        {
            rates.insert(rate);
        }
    }
    rates
}
