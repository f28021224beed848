//! Modules that can be plugged into the device, and gaps in PDOs.

use super::super::{Eds, Finding, Section, rules};
use crate::DataType;
use crate::integer::Integer;

pub(super) fn check(eds: &Eds, findings: &mut Vec<Finding>) {
    if let Some(section) = eds.section("SupportedModules") {
        modules(eds, section, findings);
    }
    if let Some(section) = eds.section("DummyUsage") {
        dummies(section, findings);
    }
}

fn modules(eds: &Eds, section: Section<'_>, findings: &mut Vec<Finding>) {
    let key = section.filled("NrOfEntries");
    let count = key.and_then(|key| u16::try_from(Integer::parse(key.value)?.value).ok());
    let missing = match count {
        Some(count) => (1..=count)
            .map(|number| format!("M{number}ModuleInfo"))
            .find(|name| eds.section(name).is_none()),
        None => Some("a number of modules".to_owned()),
    };
    if let Some(missing) = missing {
        findings.push(Finding::new(
            &rules::MODULE,
            key.map_or(section.line, |key| key.line),
            format!("[SupportedModules] lacks {missing}"),
            "write in NrOfEntries how many modules there are, and describe each in [MxModuleInfo]",
        ));
    }
}

fn dummies(section: Section<'_>, findings: &mut Vec<Finding>) {
    for key in section.keys() {
        let index = key
            .name
            .get(..5)
            .filter(|word| word.eq_ignore_ascii_case("Dummy"))
            .and_then(|_| key.name.get(5..).filter(|digits| digits.len() == 4))
            .and_then(|digits| u16::from_str_radix(digits, 16).ok());
        let sized = index.is_some_and(|index| DataType::from_code(index).bits().is_some());
        let flag = Integer::parse(key.value).is_some_and(|flag| matches!(flag.value, 0 | 1));
        if !sized || !flag {
            findings.push(Finding::new(
                &rules::DUMMY_USAGE,
                key.line,
                format!("`{}={}` says nothing of a dummy", key.name, key.value),
                "write Dummy and the four digits of a data type with a fixed size, and 0 or 1",
            ));
        }
    }
}
