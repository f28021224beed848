//! The section `[DeviceComissioning]` of a DCF.

use super::{Finding, field};
use crate::ini::Sections;

/// How one device is set up in its network; `None` where the file says nothing.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Commissioning {
    /// `NodeID`, for which `$NODEID` stands in this file.
    pub node_id: Option<u8>,
    /// `NodeName`
    pub node_name: Option<String>,
    /// `Baudrate`, in kbit/s.
    pub bit_rate_kbit_per_s: Option<u32>,
    /// `NetNumber`
    pub net_number: Option<u32>,
    /// `NetworkName`
    pub network_name: Option<String>,
    /// `CANopenManager`
    pub canopen_manager: Option<bool>,
    /// `LSS_SerialNumber`, as 1018h:04 should read.
    pub lss_serial_number: Option<u32>,
    /// The line of the section, from 1.
    pub line: usize,
}

pub(super) fn read(sections: &Sections, findings: &mut Vec<Finding>) -> Option<Commissioning> {
    // CiA 306 spells it with one m; many files do not.
    let section = sections
        .named("DeviceComissioning")
        .or_else(|| sections.named("DeviceCommissioning"))?;
    let key = |name: &str| section.filled(name);
    Some(Commissioning {
        node_id: field::unsigned(key("NodeID"), findings),
        node_name: field::text(key("NodeName")),
        bit_rate_kbit_per_s: field::unsigned(key("Baudrate"), findings),
        net_number: field::unsigned(key("NetNumber"), findings),
        network_name: field::text(key("NetworkName")),
        canopen_manager: field::flag(key("CANopenManager"), findings),
        lss_serial_number: field::unsigned(key("LSS_SerialNumber"), findings),
        line: section.line,
    })
}
