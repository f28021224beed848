//! The SSI frame of an absolute encoder.
//!
//! | clock | bit |
//! | --- | --- |
//! | 1..=32 | position, highest bit first |
//! | 33 | status S1 |
//! | 34 | status S0 |

use crate::{Rule, Violation};

/// Bits of a frame, and so clocks that the master gives.
pub const FRAME_BITS: usize = 34;

/// A frame. What the status bits mean is the device's to say.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct SsiFrame {
    /// The position.
    pub position: u32,
    /// Status S1.
    pub s1: bool,
    /// Status S0, the last bit.
    pub s0: bool,
}

impl SsiFrame {
    /// The bits in the order of the clock.
    pub fn encode(&self) -> [bool; FRAME_BITS] {
        let number = u64::from(self.position) << 2 | u64::from(self.s1) << 1 | u64::from(self.s0);
        std::array::from_fn(|clock| number >> (FRAME_BITS - 1 - clock) & 1 == 1)
    }

    /// Reads the bits in the order of the clock.
    ///
    /// # Errors
    /// [`Violation`]: another number of bits; its offset counts bits.
    pub fn parse(bits: &[bool]) -> Result<SsiFrame, Violation> {
        let [position @ .., s1, s0] = bits else {
            return Err(wrong_length(bits.len()));
        };
        if bits.len() != FRAME_BITS {
            return Err(wrong_length(bits.len()));
        }
        let position = position
            .iter()
            .fold(0, |number, bit| number << 1 | u32::from(*bit));
        Ok(SsiFrame {
            position,
            s1: *s1,
            s0: *s0,
        })
    }
}

fn wrong_length(found: usize) -> Violation {
    Violation::new(
        Rule::Length,
        found.min(FRAME_BITS),
        format!("{found} bits"),
        format!("{FRAME_BITS} bits"),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn bits(text: &str) -> Vec<bool> {
        text.chars()
            .filter(|c| *c != ' ')
            .map(|c| c == '1')
            .collect()
    }

    #[test]
    fn a_frame_is_these_bits() {
        // 08D0_100Bh: 2256 turns and 4107 of 65536 steps.
        let text = "0000 1000 1101 0000 0001 0000 0000 1011 1 0";
        let frame = SsiFrame {
            position: 0x08D0_100B,
            s1: true,
            s0: false,
        };
        assert_eq!(SsiFrame::parse(&bits(text)), Ok(frame));
        assert_eq!(frame.encode().to_vec(), bits(text));
    }

    #[test]
    fn what_is_not_a_frame_says_why() {
        let cases = [
            (0, "length: found 0 bits, expected 34 bits"),
            (33, "length: found 33 bits, expected 34 bits"),
            (35, "length: found 35 bits, expected 34 bits"),
        ];
        for (len, message) in cases {
            let violation = SsiFrame::parse(&vec![true; len]).unwrap_err();
            assert_eq!(violation.to_string(), message);
        }
    }

    proptest! {
        #[test]
        fn any_bits_are_written_as_they_were_read(
            bits in proptest::collection::vec(any::<bool>(), FRAME_BITS),
        ) {
            prop_assert_eq!(SsiFrame::parse(&bits).unwrap().encode().to_vec(), bits);
        }
    }
}
