//! What an EDS says of the identity.

use fieldproof_dictionary::Default;
use fieldproof_dictionary::eds::Eds;
use fieldproof_suite::identity::Claim;

/// A part of the identity.
pub(in super::super) struct Part {
    /// The key of the description.
    pub(in super::super) name: &'static str,
    /// As YAML has it.
    pub(in super::super) value: String,
    /// Where it is taken from.
    pub(in super::super) why: String,
    /// Whether it is that of every unit.
    pub(in super::super) is_claimed: bool,
}

pub(super) fn parts(eds: &Eds) -> Vec<Part> {
    let parts = Claim::ALL.into_iter().filter_map(|claim| {
        if claim.is_text() {
            return text(eds, claim);
        }
        number(eds, claim)
    });
    parts.collect()
}

/// A number of 1018h, or else of `[DeviceInfo]`; 0 is what a template has.
fn number(eds: &Eds, claim: Claim) -> Option<Part> {
    let info = &eds.device_info;
    let object = claim.object();
    let place = format!("{:04X}h:{:02X}", object.index, object.sub);
    let in_object = default(eds, claim)
        .and_then(|default| default.value(0))
        .and_then(|number| u32::try_from(number).ok())
        .filter(|number| *number != 0);
    let (key, in_info) = match claim {
        Claim::VendorId => ("VendorNumber", info.vendor_number),
        Claim::ProductCode => ("ProductNumber", info.product_number),
        Claim::RevisionNumber => ("RevisionNumber", info.revision_number),
        _ => (
            "LSS_SerialNumber",
            eds.commissioning
                .as_ref()
                .and_then(|it| it.lss_serial_number),
        ),
    };
    let in_info = in_info.filter(|number| *number != 0);
    let (number, why) = match (in_object, in_info) {
        (Some(number), Some(other)) if number != other => {
            (number, format!("{place}; but {key} is {other:#010X}"))
        }
        (Some(number), _) => (number, place),
        (None, Some(number)) => (number, key.to_owned()),
        (None, None) => return None,
    };
    let is_claimed = claim != Claim::SerialNumber;
    Some(Part {
        name: claim.name(),
        value: format!("{number:#010X}"),
        why: match is_claimed {
            true => why,
            false => format!("{why}, the number of one unit"),
        },
        is_claimed,
    })
}

/// A text; a version changes with the device where the file does not.
fn text(eds: &Eds, claim: Claim) -> Option<Part> {
    let Default::Text(text) = default(eds, claim)? else {
        return None;
    };
    let text = text.trim();
    let index = claim.object().index;
    let is_claimed = claim == Claim::DeviceName;
    (!text.is_empty()).then(|| Part {
        name: claim.name(),
        value: serde_json::Value::from(text).to_string(),
        why: match is_claimed {
            true => format!("{index:04X}h"),
            false => format!("{index:04X}h, the version when the file was made"),
        },
        is_claimed,
    })
}

fn default(eds: &Eds, claim: Claim) -> Option<&Default> {
    let object = claim.object();
    let entry = eds.dictionary.entry(object.index, object.sub)?;
    entry.default.as_ref()
}
