//! `expect-mapping`: what a PDO's mapping names is in the dictionary, with that length.

use fieldproof_suite::model::ExpectMapping;
use fieldproof_wire::canopen::Multiplexer;

use crate::sdo::{Outcome, show_abort};
use crate::stop::{Came, Stop};
use crate::tester::{Tester, multiplexer};

/// The bits of a PDO.
const MOST_BITS: u32 = 64;
/// The highest number of mapped objects: one bit each.
const MOST_ENTRIES: u32 = 64;

/// What an entry of a mapping says: bits 31 to 16 the index, 15 to 8 the sub-index, 7 to 0 the length in bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Mapped {
    object: Multiplexer,
    bits: u32,
}

impl Mapped {
    fn of(entry: u32) -> Mapped {
        let [bits, sub, low, high] = entry.to_le_bytes();
        Mapped {
            object: Multiplexer::new(u16::from_le_bytes([low, high]), sub),
            bits: u32::from(bits),
        }
    }

    /// The length of the data type that a dummy stands for (CiA 301: BOOLEAN to UNSIGNED32).
    fn dummy_bits(self) -> Option<u32> {
        match (self.object.index, self.object.sub) {
            (1, 0) => Some(1),
            (2 | 5, 0) => Some(8),
            (3 | 6, 0) => Some(16),
            (4 | 7, 0) => Some(32),
            _ => None,
        }
    }
}

impl Tester<'_> {
    pub(super) fn expect_mapping(&mut self, step: &ExpectMapping) -> Result<(), Stop> {
        let of = multiplexer(step.of);
        let count = self.mapping_number(Multiplexer::new(of.index, 0), 1)?;
        if count > MOST_ENTRIES {
            return Err(Stop::mismatch(
                format!("{:04X}h maps more objects than a PDO has bits", of.index),
                format!("at most {MOST_ENTRIES}"),
                count.to_string(),
                Came::Value(i128::from(count)),
            ));
        }
        let mut bits = 0;
        for sub in 1..=count.to_le_bytes()[0] {
            let entry = self.mapping_number(Multiplexer::new(of.index, sub), 4)?;
            bits += self.check_mapped(Multiplexer::new(of.index, sub), entry)?;
        }
        if bits > MOST_BITS {
            return Err(Stop::mismatch(
                format!("{:04X}h maps more than fits a PDO", of.index),
                format!("at most {MOST_BITS} bits"),
                format!("{bits} bits"),
                Came::Other,
            ));
        }
        Ok(())
    }

    /// Reads a number of a mapping.
    fn mapping_number(&mut self, object: Multiplexer, size: usize) -> Result<u32, Stop> {
        let within = self.device.timing.sdo_response;
        match self.sdo_upload(object, within)? {
            Outcome::Done(value) => {
                let bytes = value.of_size(Some(size)).iter().take(4).rev();
                Ok(bytes.fold(0, |number, byte| number << 8 | u32::from(*byte)))
            }
            Outcome::Refused(code) => Err(Stop::mismatch(
                format!("reading {object} is refused"),
                "a value",
                show_abort(code),
                Came::Abort(code.0),
            )),
        }
    }

    /// The bits that an entry takes, if the dictionary has its object with that length and lets a PDO carry it.
    fn check_mapped(&self, at: Multiplexer, entry: u32) -> Result<u32, Stop> {
        let mapped = Mapped::of(entry);
        let known = self
            .dictionary
            .and_then(|dictionary| dictionary.entry(mapped.object.index, mapped.object.sub));
        let expected = match known {
            Some(known) if known.pdo_mapping => known.data_type.bits(),
            Some(_) => None,
            None => mapped.dummy_bits(),
        };
        if expected == Some(mapped.bits) {
            return Ok(mapped.bits);
        }
        let object = mapped.object;
        let expected = match (known, expected) {
            (_, Some(bits)) => format!("{object} with {bits} bits"),
            (Some(_), None) => format!("an object that a PDO may carry, which {object} is not"),
            (None, None) => format!("an object of the dictionary, which {object} is not"),
        };
        Err(Stop::mismatch(
            format!("{at} maps something else than the dictionary has"),
            expected,
            format!("{entry:08X}h: {object} with {} bits", mapped.bits),
            Came::Value(i128::from(entry)),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_is_index_sub_index_and_length() {
        let mapped = Mapped::of(0x6041_0010);
        assert_eq!(mapped.object, Multiplexer::new(0x6041, 0));
        assert_eq!(mapped.bits, 16);
        assert_eq!(mapped.dummy_bits(), None);
        assert_eq!(Mapped::of(0x0005_0008).dummy_bits(), Some(8));
        assert_eq!(Mapped::of(0x0005_0108).dummy_bits(), None);
    }
}
