//! The 11-bit and the 29-bit identifier.

/// An 11-bit identifier, `000h..=7FFh` (ISO 11898-1, base format).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct StandardId(u16);

impl StandardId {
    /// The highest 11-bit identifier.
    pub const MAX: StandardId = StandardId(0x7FF);

    /// The identifier `raw`, unless it needs more than 11 bits.
    pub const fn new(raw: u16) -> Option<StandardId> {
        if raw <= 0x7FF {
            Some(StandardId(raw))
        } else {
            None
        }
    }

    /// The identifier as a number, `0..=7FFh`.
    pub const fn raw(self) -> u16 {
        self.0
    }
}

/// A 29-bit identifier, `0..=1FFF_FFFFh` (ISO 11898-1, extended format).
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ExtendedId(u32);

impl ExtendedId {
    /// The highest 29-bit identifier.
    pub const MAX: ExtendedId = ExtendedId(0x1FFF_FFFF);

    /// The identifier `raw`, unless it needs more than 29 bits.
    pub const fn new(raw: u32) -> Option<ExtendedId> {
        if raw <= 0x1FFF_FFFF {
            Some(ExtendedId(raw))
        } else {
            None
        }
    }

    /// The identifier as a number, `0..=1FFF_FFFFh`.
    pub const fn raw(self) -> u32 {
        self.0
    }
}

/// An identifier of either format.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Id {
    /// 11 bits.
    Standard(StandardId),
    /// 29 bits.
    Extended(ExtendedId),
}

impl Id {
    /// The 11-bit identifier `raw`, unless it needs more than 11 bits.
    pub const fn standard(raw: u16) -> Option<Id> {
        match StandardId::new(raw) {
            Some(id) => Some(Id::Standard(id)),
            None => None,
        }
    }

    /// The 29-bit identifier `raw`, unless it needs more than 29 bits.
    pub const fn extended(raw: u32) -> Option<Id> {
        match ExtendedId::new(raw) {
            Some(id) => Some(Id::Extended(id)),
            None => None,
        }
    }

    /// The identifier as a number.
    pub const fn raw(self) -> u32 {
        match self {
            Id::Standard(id) => id.raw() as u32,
            Id::Extended(id) => id.raw(),
        }
    }

    /// Whether this is a 29-bit identifier.
    pub const fn is_extended(self) -> bool {
        matches!(self, Id::Extended(_))
    }
}

impl From<StandardId> for Id {
    fn from(id: StandardId) -> Id {
        Id::Standard(id)
    }
}

impl From<ExtendedId> for Id {
    fn from(id: ExtendedId) -> Id {
        Id::Extended(id)
    }
}
