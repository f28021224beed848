//! The sections about the file and about the device as a whole.

use super::super::{Eds, Finding, Key, Section, place::place, rules};
use crate::integer::Integer;

const FILE_KEYS: [&str; 11] = [
    "FileName",
    "FileVersion",
    "FileRevision",
    "EDSVersion",
    "Description",
    "CreationTime",
    "CreationDate",
    "CreatedBy",
    "ModificationTime",
    "ModificationDate",
    "ModifiedBy",
];

const DEVICE_KEYS: [&str; 13] = [
    "VendorName",
    "VendorNumber",
    "ProductName",
    "ProductNumber",
    "RevisionNumber",
    "OrderCode",
    "SimpleBootUpMaster",
    "SimpleBootUpSlave",
    "Granularity",
    "GroupMessaging",
    "NrOfRXPDO",
    "NrOfTXPDO",
    "LSS_Supported",
];

const COMMISSIONING_KEYS: [&str; 3] = ["NodeID", "NodeName", "Baudrate"];

const BIT_RATES: [&str; 8] = ["10", "20", "50", "125", "250", "500", "800", "1000"];

const SECTIONS: [&str; 13] = [
    "FileInfo",
    "DeviceInfo",
    "DummyUsage",
    "Comments",
    "MandatoryObjects",
    "OptionalObjects",
    "ManufacturerObjects",
    "StandardDataTypes",
    "DynamicChannels",
    "Tools",
    "SupportedModules",
    "ConnectedModules",
    "DeviceComissioning",
];

pub(super) fn check(eds: &Eds, findings: &mut Vec<Finding>) {
    mandatory(eds, "FileInfo", &FILE_KEYS, findings);
    mandatory(eds, "DeviceInfo", &DEVICE_KEYS, findings);
    if let Some(section) = eds.section("FileInfo") {
        dates_and_times(section, findings);
        order_of_dates(section, findings);
    }
    for name in ["DeviceComissioning", "DeviceCommissioning"] {
        if eds.section(name).is_some() {
            mandatory(eds, name, &COMMISSIONING_KEYS, findings);
        }
    }
    if let Some(section) = eds.section("DeviceInfo") {
        bit_rates(eds, section, findings);
        identity(eds, section, findings);
        dynamic_channels(eds, section, findings);
    }
    for section in eds.sections() {
        names(section, findings);
    }
}

fn mandatory(eds: &Eds, name: &str, keys: &[&str], findings: &mut Vec<Finding>) {
    let Some(section) = eds.section(name) else {
        findings.push(Finding::new(
            &rules::MISSING_SECTION,
            1,
            format!("[{name}] is missing"),
            format!("add [{name}]"),
        ));
        return;
    };
    for key in keys {
        if section.key(key).is_none() {
            findings.push(Finding::new(
                &rules::MISSING_KEY,
                section.line,
                format!("[{name}] has no {key}"),
                format!("add {key}"),
            ));
        }
    }
}

fn dates_and_times(section: Section<'_>, findings: &mut Vec<Finding>) {
    for key in section.keys().filter(|key| !key.value.is_empty()) {
        let (rule, right, wanted) = if key.is("CreationDate") || key.is("ModificationDate") {
            (
                &rules::DATE,
                date(key.value).is_some(),
                "mm-dd-yyyy, as in 10-23-2012",
            )
        } else if key.is("CreationTime") || key.is("ModificationTime") {
            (
                &rules::TIME,
                is_time(key.value),
                "hh:mm and AM or PM without a blank, as in 11:04AM",
            )
        } else {
            continue;
        };
        if !right {
            findings.push(Finding::new(
                rule,
                key.line,
                format!("`{}={}` is written otherwise", key.name, key.value),
                format!("write {wanted}"),
            ));
        }
    }
}

fn order_of_dates(section: Section<'_>, findings: &mut Vec<Finding>) {
    let date = |name: &str| {
        let key = section.filled(name)?;
        Some((date(key.value)?, key))
    };
    if let (Some((made, _)), Some((changed, key))) =
        (date("CreationDate"), date("ModificationDate"))
        && changed < made
    {
        findings.push(Finding::new(
            &rules::CHANGED_BEFORE_MADE,
            key.line,
            format!("`{}={}` is before CreationDate", key.name, key.value),
            "write month, day and year in both",
        ));
    }
}

/// Year, month and day.
fn date(text: &str) -> Option<(u32, u32, u32)> {
    let parts: Vec<Option<u32>> = text.split('-').map(digits).collect();
    let lengths: Vec<usize> = text.split('-').map(str::len).collect();
    let [Some(month @ 1..=12), Some(day), Some(year)] = parts[..] else {
        return None;
    };
    let leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    let last = match month {
        2 if leap => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    };
    (lengths == [2, 2, 4] && (1..=last).contains(&day)).then_some((year, month, day))
}

fn is_time(text: &str) -> bool {
    let upper = text.to_ascii_uppercase();
    let Some(clock) = upper
        .strip_suffix("AM")
        .or_else(|| upper.strip_suffix("PM"))
    else {
        return false;
    };
    let Some((hours, minutes)) = clock.split_once(':') else {
        return false;
    };
    hours.len() == 2
        && minutes.len() == 2
        && matches!(digits(hours), Some(0..=12))
        && matches!(digits(minutes), Some(0..=59))
}

fn digits(text: &str) -> Option<u32> {
    let all = text.bytes().all(|byte| byte.is_ascii_digit());
    all.then(|| text.parse().ok())?
}

fn bit_rates(eds: &Eds, section: Section<'_>, findings: &mut Vec<Finding>) {
    const PREFIX: &str = "BaudRate_";
    for key in section.keys() {
        let Some(prefix) = key.name.get(..PREFIX.len()) else {
            continue;
        };
        let rate = key.name.get(PREFIX.len()..).unwrap_or_default();
        if prefix.eq_ignore_ascii_case(PREFIX) && !BIT_RATES.contains(&rate) {
            findings.push(Finding::new(
                &rules::BIT_RATE_KEY,
                key.line,
                format!("`{}` is no key of CiA 306", key.name),
                format!(
                    "remove it; the bit rates are {} kbit/s",
                    BIT_RATES.join(", ")
                ),
            ));
        }
    }
    if eds.device_info.bit_rates_kbit_per_s.is_empty() {
        findings.push(Finding::new(
            &rules::NO_BIT_RATE,
            section.line,
            "no BaudRate_N is 1: the device has no bit rate",
            "write 1 for each bit rate that the device has",
        ));
    }
}

fn identity(eds: &Eds, section: Section<'_>, findings: &mut Vec<Finding>) {
    let info = &eds.device_info;
    for (sub, name, said) in [
        (1, "VendorNumber", info.vendor_number),
        (2, "ProductNumber", info.product_number),
        (3, "RevisionNumber", info.revision_number),
    ] {
        let (Some(said), Some(held)) = (said, super::number(&eds.dictionary, 0x1018, sub)) else {
            continue;
        };
        if i128::from(said) != held {
            findings.push(Finding::new(
                &rules::IDENTITY,
                section.key(name).map_or(section.line, |key| key.line),
                format!(
                    "{name} is {said:#010X}, but the default of 1018:{sub:02X} is {held:#010X}"
                ),
                "write the number that the device has in both places",
            ));
        }
    }
}

fn dynamic_channels(eds: &Eds, section: Section<'_>, findings: &mut Vec<Finding>) {
    let claimed = eds.device_info.dynamic_channels_supported.unwrap_or(0);
    let described = eds
        .section("DynamicChannels")
        .and_then(|section| section.key("NrOfSeg"))
        .and_then(|key| Integer::parse(key.value))
        .map_or(0, |count| count.value);
    let key = section.key("DynamicChannelsSupported");
    let line = key.map_or(section.line, |key| key.line);
    if claimed > 0 && described == 0 {
        findings.push(Finding::new(
            &rules::DYNAMIC_CHANNELS,
            line,
            format!("DynamicChannelsSupported is {claimed}, but no segment is described"),
            "describe the segments in [DynamicChannels], NrOfSeg first, or write 0 if the device is not programmable",
        ));
    } else if claimed == 0 && described > 0 {
        findings.push(Finding::new(
            &rules::DYNAMIC_CHANNELS,
            line,
            format!(
                "[DynamicChannels] has {described} segments, but DynamicChannelsSupported is 0"
            ),
            "write how the device supports them",
        ));
    }
}

fn names(section: Section<'_>, findings: &mut Vec<Finding>) {
    if section.is("DeviceCommissioning") {
        findings.push(Finding::new(
            &rules::SPELLING,
            section.line,
            "[DeviceCommissioning] has one m in CiA 306",
            "write [DeviceComissioning]",
        ));
    } else if !is_known(section.name) {
        findings.push(Finding::new(
            &rules::UNKNOWN_SECTION,
            section.line,
            format!("[{}] is no section of CiA 306", section.name),
            "it is kept and not looked into",
        ));
    }
    for key in section.keys() {
        blanks(section, key, findings);
    }
}

fn is_known(name: &str) -> bool {
    let lower = name.to_ascii_lowercase();
    let numbered = |prefix: &str| {
        let rest = lower.strip_prefix(prefix).unwrap_or_default();
        rest.starts_with(|first: char| first.is_ascii_digit())
    };
    place(name).is_some()
        || SECTIONS
            .iter()
            .any(|known| known.eq_ignore_ascii_case(name))
        || numbered("tool")
        || numbered("m")
}

fn blanks(section: Section<'_>, key: Key<'_>, findings: &mut Vec<Finding>) {
    if key.has_blanks() {
        findings.push(Finding::new(
            &rules::KEY_WITH_BLANKS,
            key.line,
            format!("`{}` in [{}] has blanks", key.name, section.name),
            "write it without; other readers do not find the key",
        ));
    }
}
