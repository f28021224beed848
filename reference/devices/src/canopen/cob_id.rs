//! COB-IDs that a service may be given.

use super::{Abort, Departures};

/// Bits 0 to 28.
const IDENTIFIER: u32 = 0x1FFF_FFFF;

/// Whether no service may be given `identifier`: it belongs to NMT, the default SDO, error control or LSS, or has 29
/// bits, which no device here takes.
pub(super) const fn is_restricted(identifier: u32, departs: &Departures) -> bool {
    if departs.restricted_identifiers_taken
        || (departs.high_identifiers_taken && identifier > 0x580)
    {
        return identifier > 0x7FF;
    }
    matches!(
        identifier,
        0x000..=0x07F | 0x101..=0x180 | 0x581..=0x5FF | 0x601..=0x67F | 0x6E0..=0x6FF | 0x701..
    )
}

/// Whether `value` may be written over `present`, a COB-ID that is in use while `in_use` says so and then `protected`.
///
/// # Errors
/// The identifier is restricted, or changes while it is in use.
pub(super) fn check(
    (present, value): (u32, u32),
    in_use: fn(u32) -> bool,
    protected: bool,
    departs: &Departures,
) -> Result<(), Abort> {
    if in_use(value) && is_restricted(value & IDENTIFIER, departs) {
        return Err(Abort::INVALID_VALUE);
    }
    let changes = present & IDENTIFIER != value & IDENTIFIER;
    if protected && in_use(present) && in_use(value) && changes {
        return Err(Abort::DEVICE_STATE);
    }
    Ok(())
}
