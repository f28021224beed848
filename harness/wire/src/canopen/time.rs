//! TIME.

use std::fmt;

use fieldproof_can::{Frame, Id};

use super::data_frame::broadcast;
use super::identifier_entry::RawIdentifierEntry;
use super::{Service, cob_id};
use crate::Violation;
use crate::violation::{exactly, reserved_is_zero};

bounded! {
    /// Milliseconds after midnight, `0..=86_399_999`.
    pub struct Milliseconds(u32) in 0..=86_399_999
}

/// A time stamp.
///
/// | bits of the 6 bytes, low byte first | content |
/// | --- | --- |
/// | 0..=27 | milliseconds after midnight |
/// | 28..=31 | reserved |
/// | 32..=47 | days since 1 January 1984 |
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TimeOfDay {
    /// Days since 1 January 1984.
    pub days: u16,
    /// Milliseconds after midnight.
    pub milliseconds: Milliseconds,
}

impl TimeOfDay {
    /// The 6 bytes.
    pub fn encode_bytes(&self) -> [u8; 6] {
        let [a, b, c, d] = self.milliseconds.raw().to_le_bytes();
        let [e, f] = self.days.to_le_bytes();
        [a, b, c, d, e, f]
    }

    /// Reads the 6 bytes; the reserved bits are passed over.
    ///
    /// # Errors
    /// [`Violation`]: another length, or a day of more than 24 hours.
    pub fn parse_bytes(bytes: &[u8]) -> Result<TimeOfDay, Violation> {
        let [a, b, c, d, e, f] = exactly(bytes)?;
        let milliseconds = u32::from_le_bytes([a, b, c, d]) & 0x0FFF_FFFF;
        Ok(TimeOfDay {
            days: u16::from_le_bytes([e, f]),
            milliseconds: Milliseconds::parse(milliseconds, 0)?,
        })
    }

    /// Whether the reserved bits of `bytes` are zero.
    ///
    /// # Errors
    /// [`Violation`]: they are not, or what [`TimeOfDay::parse_bytes`] says.
    pub fn check_reserved(bytes: &[u8]) -> Result<(), Violation> {
        reserved_is_zero(bytes, &TimeOfDay::parse_bytes(bytes)?.encode_bytes())
    }

    /// The frame on its predefined identifier.
    pub fn encode(&self) -> Frame {
        Frame::of(cob_id(Service::Time, None), self.encode_bytes())
    }

    /// Reads a frame on its predefined identifier.
    ///
    /// # Errors
    /// [`Violation`]: not on 100h, a remote frame, or what [`TimeOfDay::parse_bytes`] says.
    pub fn parse(frame: &Frame) -> Result<TimeOfDay, Violation> {
        TimeOfDay::parse_bytes(broadcast(frame, Service::Time)?)
    }
}

impl fmt::Display for TimeOfDay {
    /// `day 14000, 12:34:56.789`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let milliseconds = self.milliseconds.raw();
        let seconds = milliseconds / 1000;
        write!(
            f,
            "day {}, {:02}:{:02}:{:02}.{:03}",
            self.days,
            seconds / 3600,
            seconds / 60 % 60,
            seconds % 60,
            milliseconds % 1000
        )
    }
}

/// The value of object 1012h: which identifier TIME has, and what the device does with it.
///
/// | bits | content |
/// | --- | --- |
/// | 31 | 1: consumes TIME |
/// | 30 | 1: produces TIME |
/// | 29 | 1: 29-bit identifier |
/// | 28..0 | identifier |
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct TimeIdentifier {
    /// Whether the device consumes TIME.
    pub consumes: bool,
    /// Whether the device produces TIME.
    pub produces: bool,
    /// The identifier.
    pub id: Id,
}

impl TimeIdentifier {
    /// The value.
    pub fn encode(&self) -> u32 {
        RawIdentifierEntry::new(self.consumes, self.produces, self.id).0
    }

    /// Reads the value.
    ///
    /// # Errors
    /// [`Violation`]: bits above an 11-bit identifier.
    pub fn parse(value: u32) -> Result<TimeIdentifier, Violation> {
        let raw = RawIdentifierEntry(value);
        Ok(TimeIdentifier {
            consumes: raw.bit_31(),
            produces: raw.bit_30(),
            id: raw.id()?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_message_is_this_frame() {
        // 45_296_789 ms = 2B32C95h are 12:34:56.789; 14_000 days = 36B0h.
        let frame: Frame = "100#952CB302B036".parse().unwrap();
        let time = TimeOfDay {
            days: 14_000,
            milliseconds: Milliseconds::new(45_296_789).unwrap(),
        };
        assert_eq!(TimeOfDay::parse(&frame), Ok(time));
        assert_eq!(time.encode(), frame);
        assert_eq!(time.to_string(), "day 14000, 12:34:56.789");
    }

    #[test]
    fn what_is_not_a_message_says_why() {
        let cases = [
            ("100#0000", "length: found 2 bytes, expected 6 bytes"),
            (
                "100#005C26050000",
                "range: found 86400000 at byte 0, expected 0 to 86399999",
            ),
        ];
        for (text, message) in cases {
            let violation = TimeOfDay::parse(&text.parse().unwrap()).unwrap_err();
            assert_eq!(violation.to_string(), message);
        }
    }

    #[test]
    fn reserved_bits_are_read_over_and_reported() {
        let bytes = [0, 0, 0, 0x10, 0, 0];
        assert_eq!(
            TimeOfDay::parse_bytes(&bytes).unwrap().milliseconds.raw(),
            0
        );
        assert_eq!(
            TimeOfDay::check_reserved(&bytes).unwrap_err().to_string(),
            "reserved: found 10h at byte 3, expected 00h"
        );
    }

    #[test]
    fn the_identifier_entry_is_this_value() {
        let entry = TimeIdentifier {
            consumes: true,
            produces: false,
            id: Id::standard(0x100).unwrap(),
        };
        assert_eq!(entry.encode(), 0x8000_0100);
        assert_eq!(TimeIdentifier::parse(0x8000_0100), Ok(entry));
    }

    proptest! {
        #[test]
        fn any_time_is_read_as_it_was_written(days: u16, milliseconds in 0..=86_399_999u32) {
            let milliseconds = Milliseconds::new(milliseconds).unwrap();
            let time = TimeOfDay { days, milliseconds };
            prop_assert_eq!(TimeOfDay::parse(&time.encode()), Ok(time));
            prop_assert_eq!(TimeOfDay::check_reserved(&time.encode_bytes()), Ok(()));
        }

        #[test]
        fn any_bytes_are_read_or_refused(bytes in proptest::collection::vec(any::<u8>(), 0..9)) {
            if let Ok(time) = TimeOfDay::parse_bytes(&bytes) {
                let written = time.encode_bytes();
                prop_assert_eq!(&written[..3], &bytes[..3]);
                prop_assert_eq!(&written[4..], &bytes[4..]);
            }
        }
    }
}
