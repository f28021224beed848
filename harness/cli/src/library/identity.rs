//! What a description claims of the identity, against what the EDS beside it says.

use std::sync::Arc;

use fieldproof_dictionary::Default;
use fieldproof_dictionary::eds::Eds;
use fieldproof_report::{Problem, Severity};
use fieldproof_suite::SourceFile;
use fieldproof_suite::device::DeviceDescription;
use fieldproof_suite::identity::Claim;
use fieldproof_suite::scalar::Value;

use crate::problems;

/// Something that an EDS says of the identity.
struct Said {
    value: Value,
    line: usize,
    place: String,
}

/// The claims of `description`, read from `file`, that the EDS at `eds_path` contradicts. Warnings, for it is the
/// description that a device is compared with.
pub(super) fn contradictions(
    description: &DeviceDescription,
    file: &SourceFile,
    eds: &Eds,
    eds_path: &str,
) -> Vec<Problem> {
    let text: Arc<str> = Arc::from(file.text.as_str());
    let contradicted = Claim::ALL.into_iter().filter_map(|claim| {
        let claimed = description.identity.claimed(claim)?;
        let said = said(eds, claim)?;
        if said.value == claimed.value {
            return None;
        }
        let message = format!(
            "the description claims the {} {}, and its EDS says {}",
            claim.name(),
            shown(&claimed.value),
            shown(&said.value)
        );
        let problem = Problem::new(Severity::Warning, message)
            .in_file(&file.path)
            .note(format!("{eds_path}:{}: {} says so", said.line, said.place))
            .note("a device is compared with what the description claims");
        Some(problems::placed(problem, claimed.at, "claimed here", &text))
    });
    contradicted.collect()
}

/// What the object holds; where the EDS does not say that, what `[DeviceInfo]` has.
fn said(eds: &Eds, claim: Claim) -> Option<Said> {
    let object = claim.object();
    let entry = eds.dictionary.entry(object.index, object.sub);
    let default = entry.and_then(|entry| Some((entry, entry.default.as_ref()?)));
    if let Some((entry, default)) = default {
        let value = match default {
            Default::Number(number) => Value::Number(number.value(0)),
            Default::Text(text) => Value::Text(text.clone()),
        };
        return Some(Said {
            value,
            line: entry.line,
            place: format!("{:04X}h:{:02X}", object.index, object.sub),
        });
    }
    let info = &eds.device_info;
    let (key, number) = match claim {
        Claim::VendorId => ("VendorNumber", info.vendor_number?),
        Claim::ProductCode => ("ProductNumber", info.product_number?),
        Claim::RevisionNumber => ("RevisionNumber", info.revision_number?),
        _ => return None,
    };
    let section = eds.section("DeviceInfo")?;
    Some(Said {
        value: Value::Number(number.into()),
        line: section.key(key).map_or(section.line, |key| key.line),
        place: format!("{key} of [DeviceInfo]"),
    })
}

fn shown(value: &Value) -> String {
    match value {
        Value::Number(number) => format!("{number:#010X}"),
        Value::Text(text) => format!("{text:?}"),
        Value::Saved(_) | Value::Duration(_) | Value::Bytes(_) => String::new(),
    }
}
