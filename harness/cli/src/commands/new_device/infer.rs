//! What an EDS says of a device, as far as it says it.

use fieldproof_dictionary::eds::Eds;
use fieldproof_dictionary::{Access, DataType, Dictionary, Entry};
use fieldproof_run::feature_name;
use fieldproof_suite::device::Feature;

/// What is taken from an EDS.
pub(super) struct Claims {
    pub(super) vendor: Option<String>,
    pub(super) product: Option<String>,
    /// Name, value: as 1018h should read.
    pub(super) identity: Vec<(&'static str, u32)>,
    /// The highest that is supported, in kbit/s.
    pub(super) bit_rate: Option<u32>,
    /// Each feature with why it is taken to be there.
    pub(super) features: Vec<(&'static str, String)>,
}

impl Claims {
    pub(super) fn of(eds: &Eds) -> Claims {
        let info = &eds.device_info;
        let identity = [
            ("vendor", info.vendor_number),
            ("product", info.product_number),
            ("revision", info.revision_number),
        ];
        Claims {
            vendor: info.vendor_name.clone(),
            product: info.product_name.clone(),
            identity: identity
                .into_iter()
                .filter_map(|(name, number)| Some((name, number?)))
                .collect(),
            bit_rate: info.bit_rates_kbit_per_s.last().copied(),
            features: features(&eds.dictionary, info.lss_supported == Some(true)),
        }
    }
}

fn features(dictionary: &Dictionary, lss: bool) -> Vec<(&'static str, String)> {
    let mut found = Vec::new();
    let mut add = |feature: Feature, why: Option<String>| {
        found.extend(why.map(|why| (feature_name(feature), why)));
    };
    let has = |index: u16| dictionary.object(index).map(|_| format!("{index:04X}h"));
    let within = |low: u16, high: u16| {
        let mut objects = dictionary.objects().map(|object| object.index);
        let first = objects.find(|index| (low..=high).contains(index));
        first.map(|index| format!("{index:04X}h"))
    };
    add(Feature::NmtSlave, Some("every CANopen device".to_owned()));
    add(Feature::SdoServer, Some("every CANopen device".to_owned()));
    add(Feature::SdoSegmented, long_text(dictionary));
    add(Feature::HeartbeatProducer, has(0x1017));
    add(
        Feature::NodeGuarding,
        has(0x100C)
            .zip(has(0x100D))
            .map(|(guard_time, factor)| format!("{guard_time}, {factor}")),
    );
    add(Feature::Tpdo, within(0x1800, 0x19FF));
    add(Feature::Rpdo, within(0x1400, 0x15FF));
    add(Feature::DynamicMapping, writable_mapping(dictionary));
    add(Feature::SyncConsumer, has(0x1005));
    add(Feature::Emergency, has(0x1014));
    add(Feature::Lss, lss.then(|| "LSS_Supported".to_owned()));
    found
}

/// A text that does not fit into an expedited transfer.
fn long_text(dictionary: &Dictionary) -> Option<String> {
    let long = |entry: &Entry| {
        entry.data_type == DataType::VisibleString
            && entry.default_bytes(1).is_some_and(|bytes| bytes.len() > 4)
    };
    let (index, sub, _) = dictionary.entries().find(|(_, _, entry)| long(entry))?;
    Some(format!("{index:04X}h:{sub:02X} is longer than 4 bytes"))
}

fn writable_mapping(dictionary: &Dictionary) -> Option<String> {
    let is_mapping = |index: u16| matches!(index, 0x1600..=0x17FF | 0x1A00..=0x1BFF);
    let writable = |access: Access| !matches!(access, Access::ReadOnly | Access::Constant);
    let (index, sub, _) = dictionary
        .entries()
        .find(|(index, sub, entry)| is_mapping(*index) && *sub > 0 && writable(entry.access))?;
    Some(format!("{index:04X}h:{sub:02X} can be written"))
}
