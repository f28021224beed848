//! The 32-bit values by which the dictionary gives a service its identifier: 1005h, 1012h, 1014h, 1400h:01, 1800h:01.

use fieldproof_can::Id;

use crate::{Rule, Violation};

/// Any value: the identifier in bits 28..0, whether it has 29 bits in bit 29, and two bits whose meaning depends on the
/// service.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct RawIdentifierEntry(pub(super) u32);

impl RawIdentifierEntry {
    pub(super) fn new(bit_31: bool, bit_30: bool, id: Id) -> RawIdentifierEntry {
        RawIdentifierEntry(
            u32::from(bit_31) << 31
                | u32::from(bit_30) << 30
                | u32::from(id.is_extended()) << 29
                | id.raw(),
        )
    }

    pub(super) const fn bit_31(self) -> bool {
        self.0 >> 31 & 1 == 1
    }

    pub(super) const fn bit_30(self) -> bool {
        self.0 >> 30 & 1 == 1
    }

    /// The identifier.
    pub(super) fn id(self) -> Result<Id, Violation> {
        let number = self.0 & 0x1FFF_FFFF;
        let id = if self.0 >> 29 & 1 == 1 {
            Id::extended(number)
        } else {
            u16::try_from(number).ok().and_then(Id::standard)
        };
        id.ok_or_else(|| {
            Violation::new(
                Rule::Range,
                0,
                format!("{number:08X}h in a value for 11-bit identifiers"),
                "at most 7FFh, or bit 29 set",
            )
        })
    }
}
