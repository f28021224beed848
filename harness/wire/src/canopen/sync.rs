//! SYNC.

use fieldproof_can::{Frame, Id};

use super::data_frame::broadcast;
use super::identifier_entry::RawIdentifierEntry;
use super::{Service, cob_id};
use crate::Violation;
use crate::violation::exactly;

bounded! {
    /// The counter of a SYNC, `1..=240`.
    pub struct SyncCounter(u8) in 1..=240
}

/// A SYNC: no data, or one byte with a counter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Sync {
    /// The counter, if SYNCs are counted (1019h is not 0).
    pub counter: Option<SyncCounter>,
}

impl Sync {
    /// The frame on its predefined identifier.
    pub fn encode(&self) -> Frame {
        let id = cob_id(Service::Sync, None);
        match self.counter {
            Some(counter) => Frame::of(id, [counter.raw()]),
            None => Frame::of(id, []),
        }
    }

    /// Reads a frame on its predefined identifier.
    ///
    /// # Errors
    /// [`Violation`]: not on 080h, a remote frame, more than 1 byte, or a counter outside `1..=240`.
    pub fn parse(frame: &Frame) -> Result<Sync, Violation> {
        let counter = match broadcast(frame, Service::Sync)? {
            [] => None,
            bytes => {
                let [counter] = exactly(bytes)?;
                Some(SyncCounter::parse(counter, 0)?)
            }
        };
        Ok(Sync { counter })
    }
}

/// The value of object 1005h: which identifier SYNC has, and who makes it.
///
/// | bits | content |
/// | --- | --- |
/// | 30 | 1: this device generates SYNC |
/// | 29 | 1: 29-bit identifier |
/// | 28..0 | identifier |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct SyncIdentifier {
    /// Whether this device generates SYNC.
    pub generates: bool,
    /// The identifier.
    pub id: Id,
}

impl SyncIdentifier {
    /// The value.
    pub fn encode(&self) -> u32 {
        RawIdentifierEntry::new(false, self.generates, self.id).0
    }

    /// Reads the value; bit 31 is passed over.
    ///
    /// # Errors
    /// [`Violation`]: bits above an 11-bit identifier.
    pub fn parse(value: u32) -> Result<SyncIdentifier, Violation> {
        let raw = RawIdentifierEntry(value);
        Ok(SyncIdentifier {
            generates: raw.bit_30(),
            id: raw.id()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn frame(text: &str) -> Frame {
        text.parse().unwrap()
    }

    #[test]
    fn messages_are_these_frames() {
        for (text, counter) in [("080#", None), ("080#01", Some(1)), ("080#F0", Some(240))] {
            let sync = Sync {
                counter: counter.and_then(SyncCounter::new),
            };
            assert_eq!(Sync::parse(&frame(text)), Ok(sync));
            assert_eq!(sync.encode(), frame(text));
        }
    }

    #[test]
    fn what_is_not_a_message_says_why() {
        let cases = [
            ("080#00", "range: found 0 at byte 0, expected 1 to 240"),
            ("080#F1", "range: found 241 at byte 0, expected 1 to 240"),
            ("080#0102", "length: found 2 bytes, expected 1 byte"),
            (
                "081#",
                "identifier: found 081h, expected an identifier of SYNC",
            ),
        ];
        for (text, message) in cases {
            assert_eq!(Sync::parse(&frame(text)).unwrap_err().to_string(), message);
        }
    }

    proptest! {
        #[test]
        fn any_identifier_entry_is_read_again_from_what_is_written(value: u32) {
            if let Ok(entry) = SyncIdentifier::parse(value) {
                prop_assert_eq!(entry.encode(), value & 0x7FFF_FFFF);
            } else {
                prop_assert!(value >> 29 & 1 == 0 && value & 0x1FFF_F800 != 0);
            }
        }
    }
}
