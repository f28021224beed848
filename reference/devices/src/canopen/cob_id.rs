//! COB-IDs that a service may be given.

use super::Abort;

/// Bits 0 to 28.
const IDENTIFIER: u32 = 0x1FFF_FFFF;

/// Whether `identifier` belongs to NMT, the default SDO, error control or LSS, or has 29 bits, which no device here
/// takes.
pub(super) const fn is_restricted(identifier: u32) -> bool {
    matches!(
        identifier,
        0x000..=0x07F | 0x101..=0x180 | 0x581..=0x5FF | 0x601..=0x67F | 0x6E0..=0x6FF | 0x701..
    )
}

/// Whether `value` may be written over `present`, a COB-ID that is in use while `in_use` says so.
///
/// # Errors
/// The identifier is restricted, or changes while it is in use.
pub(super) fn check(present: u32, value: u32, in_use: fn(u32) -> bool) -> Result<(), Abort> {
    if in_use(value) && is_restricted(value & IDENTIFIER) {
        return Err(Abort::INVALID_VALUE);
    }
    if in_use(present) && in_use(value) && present & IDENTIFIER != value & IDENTIFIER {
        return Err(Abort::DEVICE_STATE);
    }
    Ok(())
}
