//! What an EDS says of a device, as far as it says it.

mod features;
mod identity;

use fieldproof_dictionary::eds::Eds;

pub(super) use features::Inferred;
pub(super) use identity::Part;

/// What is taken from an EDS.
pub(super) struct Claims {
    pub(super) vendor: Option<String>,
    pub(super) product: Option<String>,
    /// The node-ID that a DCF was made for.
    pub(super) node: Option<u8>,
    /// What is said of the identity.
    pub(super) identity: Vec<Part>,
    /// In kbit/s.
    pub(super) bit_rate: Option<BitRate>,
    /// What is said of each feature of which something is said.
    pub(super) features: Vec<Inferred>,
}

/// A bit rate in kbit/s, and how much is known of it.
pub(super) enum BitRate {
    /// The one that a DCF was made for.
    Set(u32),
    /// The highest that is supported.
    Highest(u32),
}

impl Claims {
    pub(super) fn of(eds: &Eds) -> Claims {
        let info = &eds.device_info;
        let set = eds.commissioning.as_ref();
        let set = set.and_then(|it| it.bit_rate_kbit_per_s).map(BitRate::Set);
        let highest = info.bit_rates_kbit_per_s.last().copied();
        Claims {
            vendor: info.vendor_name.clone(),
            product: info.product_name.clone(),
            node: eds.node_id().filter(|node| (1..=127).contains(node)),
            identity: identity::parts(eds),
            bit_rate: set.or(highest.map(BitRate::Highest)),
            features: features::inferred(eds),
        }
    }
}
